// SPDX-License-Identifier: BSD-3-Clause
// Everything that analyze tells about a model at one geometry.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/uncertainty/budget.hpp"
#include "mmbrdf/uncertainty/draws.hpp"
#include "streams/evaluate_file.hpp"
#include "streams/recent_wavelengths.hpp"

namespace mmbrdf::program {

struct AnalysisOptions {
  Frame frame = Frame::xy;  ///< of the elements, and of `light`
  std::vector<TypeBTerm> terms;
  std::optional<Stokes> light;  ///< that can exist; with it, the degree of polarization of what becomes of it
  int draws = 0;                ///< 0: uncertainties in first order
  unsigned long seed = 0;
  bool strict = false;  ///< refuse what is not known to be inside the fitted range
};

/// No value where it has no meaning, no uncertainty where it is not known.
struct Quantity {
  std::string name;
  std::optional<double> value = {}, uncertainty = {};
  bool has_interval = false;                  ///< here or elsewhere
  std::optional<double> low = {}, high = {};  ///< of 95 % coverage, from draws
};

struct Analysis {
  Mueller elements;     ///< in sr⁻¹
  Mueller elements_sp;  ///< the same in the sp frame
  std::optional<Mueller> uncertainties;
  std::vector<Quantity> quantities;  ///< at each geometry the same ones
  std::optional<Budget> budget;      ///< in the sp frame
  std::optional<bool> estimable;
  bool realizable = false;  ///< f11 > 0, and no coherency eigenvalue below 0
  Outside outside = inside;
};

class Analyzer {
 public:
  /// Throws std::invalid_argument for a covariance that is not positive semidefinite, or as Draws does.
  Analyzer(const Model& model, AnalysisOptions options);

  Analyzer(const Analyzer&) = delete;
  Analyzer& operator=(const Analyzer&) = delete;

  /// Throws std::invalid_argument for an invalid wavelength (micrometres) or geometry, and for what is not strict.
  Analysis at(double wavelength, const Geometry& geometry);

  /// Why there are no uncertainties; empty if there are.
  const std::string& unknown_uncertainty() const { return unknown_uncertainty_; }

  const AnalysisOptions& options() const { return options_; }
  const Model& model() const { return model_; }

  /// ",f11,…,f44,validity,u_f11,…,u_f44,depolarization,u_depolarization,…,estimable"
  std::string columns() const;

 private:
  struct AtWavelength {
    PreparedModel model;
    std::optional<PreparedUncertainty> uncertainty;
    std::vector<PreparedModel> draws;
  };
  AtWavelength prepared(double wavelength) const;
  std::vector<Quantity> quantities(const AtWavelength& at, const Geometry& geometry, const Analysis& analysis) const;
  Stokes light_sp(const Geometry& geometry) const;
  std::optional<Budget> budget_of(const AtWavelength& at, const Geometry& geometry) const;

  Model model_;
  AnalysisOptions options_;
  std::string unknown_uncertainty_;
  std::optional<Draws> draws_;
  RecentWavelengths<AtWavelength> wavelengths_;
};

/// The same for rows of a file. The analyzer must outlive it.
AddedColumns analyzed_columns(Analyzer& analyzer);

}  // namespace mmbrdf::program
