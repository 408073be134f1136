// SPDX-License-Identifier: BSD-3-Clause
/// How a model becomes the numbers that a kernel reads: a change of basis, from modes to the coefficients of a form.
#pragma once

#include <span>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "model/kernel/kernel.hpp"

namespace mmbrdf {

/// How the coefficients of a model become those of its form.
struct Plan {
  struct Share {
    int coefficient;
    double weight;
  };
  Form form = Form::pairs;
  bool projected = false, turned = false;
  int count = 0;                           ///< coefficients of the form
  std::vector<Share> shares;               ///< what each mode gives to them, mode after mode
  std::vector<std::size_t> shares_end{0};  ///< shares of mode q: shares_end[q] … shares_end[q + 1]
  int order = 0;                           ///< highest radial order
  std::vector<KernelPair> pairs;
  std::vector<PairRun> runs;

  /// Coefficients of the form from those of the modes, which are as many as modes.
  std::vector<double> coefficients(std::span<const double> of_modes) const;
};

/// Of a valid model.
Plan plan(const Model& model);

/// K without its norm is what Form::pairs and Form::functions have; the norm by the position in the table.
double table_norm(int index);

/// The coefficients of the modes for each power of the wavelength, power after power.
std::vector<double> by_powers(const Model& model);

/// All of a prepared model that does not depend on the wavelength.
struct PreparedPattern {
  Plan plan;
  std::vector<double> by_powers;          ///< coefficients of the modes, power after power
  std::vector<double> form_by_powers;     ///< those of the form
  int powers = 0;                         ///< highest power of the wavelength
  std::vector<Term> terms;                ///< of the modes, mode after mode
  std::vector<std::size_t> terms_end{0};  ///< terms of mode q: terms_end[q] … terms_end[q + 1]
  std::vector<double> table_norms;        ///< of K, which the kernel's table does not have
  DiscMapping mapping;
  Family family;
  ReflectanceTable reflectance;
  Validity validity;
  Elements unknown;            ///< in the frame xy
  bool isotropic_f11 = false;  ///< it depends on phi_r − phi_i alone, and not on its sign

  std::size_t modes() const { return terms_end.size() - 1; }
};

/// The form for one incident direction, and its coefficients from those of the modes.
Form incidence_form(const Plan& plan);
std::vector<double> incidence_coefficients(const PreparedPattern& pattern, std::span<const double> of_modes,
                                           const Direction& incident);

/// Throws std::invalid_argument for a number that is no frame.
KernelFrame kernel_frame(Frame frame);

/// For the kernel; refers to `plan` and `coefficients`. All powers: not folded.
template <class T>
KernelModel<T> kernel_model(const Plan& plan, std::span<const T> coefficients, int powers, T scale) {
  return {.form = plan.form,
          .projected = plan.projected,
          .turned = plan.turned,
          .frame = KernelFrame::xy,
          .turned_by = {1, 0},
          .incident = {},
          .list = {plan.order, plan.pairs.data(), plan.runs.data(), static_cast<int>(plan.runs.size())},
          .coefficients = coefficients.data(),
          .powers = powers,
          .count = plan.count,
          .scale = scale};
}

struct PreparedModel::Pattern : PreparedPattern {};

/// What the kernel is asked for a prepared model, in double precision. For batch.cpp; for moments.cpp what it is made
/// of.
struct Evaluation {
  static KernelModel<double> model(const PreparedModel& prepared);
  static KernelModel<double> model(const PreparedIncidence& prepared);
  static const PreparedPattern& pattern(const PreparedModel& prepared);
  static const PreparedPattern& pattern(const PreparedIncidence& prepared);
};

}  // namespace mmbrdf
