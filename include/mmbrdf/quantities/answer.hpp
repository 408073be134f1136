// SPDX-License-Identifier: BSD-3-Clause
/// A model asked at a geometry: its matrix with all quantities, their uncertainties, and where these come from.
///
///   const Answers answers(model, {.terms = {{"plaque", ErrorOf::scale, 0.003}}});
///   const PreparedAnswers here = answers.at(0.532);
///   for (const Answered& q : here.at(geometry).quantities) q.quantity->name, q.value, q.uncertainty, q.parts …
///
/// Many geometries are many times faster at once, and without parts faster still:
///
///   for (const Answer& a : Answers(model, {.draws = 1000, .parts = false}).at(0.532).at(geometries)) a.quantities …
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/quantities.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/uncertainty/budget.hpp"

namespace mmbrdf {

struct AnswerOptions {
  Frame frame = Frame::xy;  ///< of the elements, and of `light`
  std::vector<TypeBTerm> terms = {};
  std::optional<Stokes> light = {};  ///< incident; with it come the quantities that take light
  int draws = 0;                     ///< 0: uncertainties in first order
  unsigned long seed = 0;
  bool parts = true;  ///< false: no budgets and no parts of uncertainties, only what all of it gives, in the same bits
};

/// A quantity: no value where it has no meaning or an element that it needs was not measured, no uncertainty where it is not known.
struct Answered {
  const Quantity* quantity = nullptr;
  std::optional<double> value = {}, uncertainty = {};  ///< standard (k = 1)
  std::optional<double> low = {}, high = {};           ///< of 95 % coverage, from draws
  /// Standard uncertainties in first order from each term of the budget alone, then from all. What is left of a
  /// cancellation, such as of a scale in a ratio, is 0. None if there is no budget.
  std::vector<double> parts = {};
  bool known = true;  ///< the elements that it needs were measured
};

/// The quantities of a measured matrix but for those that take light, with uncertainties from those of its elements, whose
/// errors count as uncorrelated; none where one that counts is not known.
std::vector<Answered> quantities_of(const Sample& sample);

struct Answer {
  Mueller elements;                      ///< in sr⁻¹; NaN: not measured
  std::optional<Mueller> uncertainties;  ///< of the elements; NaN as they are
  std::vector<Answered> quantities;      ///< at each geometry the same ones, in their order
  std::optional<Budget> budget;          ///< in the frame sp; none where theta_r has no limit (budget.hpp), or no parts
  std::optional<bool> estimable;         ///< nothing outside of the fitted range is
  std::optional<bool> realizable;        ///< f11 > 0, and no coherency eigenvalue below 0; none: not all was measured
  Outside outside = inside;
};

/// The answers of a model at one wavelength. May be asked in many threads at once.
class PreparedAnswers {
 public:
  /// Throws std::invalid_argument for an invalid geometry, and as budget() does.
  Answer at(const Geometry& geometry) const;

  /// Of many geometries, with the same bits.
  std::vector<Answer> at(std::span<const Geometry> geometries) const;

 private:
  friend class Answers;
  struct Prepared;
  class Block;
  explicit PreparedAnswers(std::shared_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
  std::shared_ptr<const Prepared> prepared_;
};

class Answers {
 public:
  /// Throws std::invalid_argument for a covariance that is not positive semidefinite, light that cannot exist, or as
  /// Draws does.
  explicit Answers(const Model& model, AnswerOptions options = {});

  /// At a wavelength in micrometres. Throws std::invalid_argument as prepare() does.
  PreparedAnswers at(double wavelength) const;

  /// Whether its uncertainty is from draws, with an interval.
  bool has_interval(const Quantity& quantity) const { return options().draws > 0 && !quantity.first_order; }

  /// Of Answered::parts but for the last: those of names_of_parts(model), then the terms.
  std::vector<std::string> names_of_parts() const;

  /// Why there are no uncertainties; empty if there are.
  const std::string& unknown_uncertainty() const;

  const AnswerOptions& options() const;
  const Model& model() const;

 private:
  friend class PreparedAnswers;
  struct Asked;
  std::shared_ptr<const Asked> asked_;
};

}  // namespace mmbrdf
