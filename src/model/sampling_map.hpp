// SPDX-License-Identifier: BSD-3-Clause
/// A map from the unit square to the reflected directions of each incident one, in tables, and its density (theory 5.3).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf {

/// A place on the projected hemisphere, in coordinates in which equal areas are equal projected solid angles.
struct ProjectedPlace {
  double v = 0;        ///< sin² theta_r
  double azimuth = 0;  ///< phi_r − phi_i, in [−π, π]
};

class SamplingMap {
 public:
  /// Steps in u1 and u2 and of the incident directions: powers of two, so that u < 1 stays within the last step.
  static constexpr std::size_t steps = 32, incident_steps = 32, incident_azimuths = 32;

  /// Throws std::invalid_argument if f11 is nowhere positive.
  explicit SamplingMap(const PreparedModel& model);

  /// The incident direction as the tables have it.
  struct Incidence {
    double rho = 0;  ///< √(1 − cos theta_i)
    double phi = 0;  ///< in [−π, π]; only where the sample is not isotropic
  };

  struct Mapped {
    ProjectedPlace place;
    double density;  ///< per projected solid angle times π: 1 for the perfect diffuser
  };

  /// Of a point of the unit square, u in [0, 1).
  Mapped map(const Incidence& incidence, const std::array<double, 2>& u) const;

  /// Of one u1: sin² theta_r, and at each step of u2 the azimuth as a share of its range.
  struct Row {
    double v;
    std::array<double, steps + 1> share;
  };
  using Table = std::array<Row, steps + 1>;

  /// The table of one incident direction, from which map() has the same numbers in less time.
  Table table(const Incidence& incidence) const;
  Mapped map(const Table& table, const std::array<double, 2>& u) const;

  /// What map() has there.
  double density(const Incidence& incidence, const ProjectedPlace& place) const;

  bool depends_on_incident_azimuth() const { return turns_ > 1; }

 private:
  template <std::size_t corners>
  class Blend;
  template <std::size_t corners>
  Mapped mapped(const Blend<corners>& blend, const std::array<double, 2>& u) const;

  /// With the largest f11, not |f11|, that was met.
  struct Made {
    Table table;
    double largest_f11;
  };
  Made made(const PreparedModel& model, const Direction& incident) const;
  template <class Ask>
  auto with_blend(const Incidence& incidence, Ask ask) const;

  std::size_t turns_;  ///< incident azimuths in the tables; 1: f11 depends on phi_r − phi_i alone, and not on its sign
  std::vector<Table> tables_;  ///< of all azimuths of the first rho, then of the second …
};

}  // namespace mmbrdf
