// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "basis/spectral.hpp"
#include "fitting/fit_to_predict.hpp"
#include "fitting/mixed_fit.hpp"
#include "fitting/row_variance.hpp"
#include "fitting/undetermined.hpp"
#include "fitting/wavelength_slot.hpp"
#include "mmbrdf/fitting/weights.hpp"
#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "numerics/svd_cache.hpp"
#include "text/names.hpp"
#include "text/numbers.hpp"

// For each wavelength and element there is one triangle (LeastSquares) over the modes of the element's block. The fit
// of a block over all wavelengths, with any powers and any reflectance table, is put together from them: a coefficient
// that is a polynomial of λ repeats the columns of each wavelength's triangle, multiplied by λ^p. Where the wavelengths
// have the same geometries their triangles differ in the values alone, and the powers of λ are split off.

namespace mmbrdf {
namespace {

constexpr Named<Weights> weights_names[] = {
    {Weights::none, "none"}, {Weights::speckle, "speckle"}, {Weights::data, "data"}, {Weights::estimated, "estimated"}};
constexpr Named<Covariance> covariance_names[] = {
    {Covariance::residuals, "residuals"}, {Covariance::sandwich, "sandwich"}, {Covariance::given, "given"}};

constexpr Named<Uncertainty> uncertainty_names[] = {{Uncertainty::sample, "sample"}, {Uncertainty::noise, "noise"}};

std::size_t size(int n) { return static_cast<std::size_t>(n); }

std::string nanometre_number(double wavelength) { return shortest(in_nanometres(wavelength)); }

Mueller ones() {
  Mueller result;
  result.elements.fill(1);
  return result;
}

/// Of the rows of a fit, in the frames that they have; f11 over the reflectance.
std::vector<Mueller> residuals_of_rows(std::span<const Sample> samples, const FitResult& fitted) {
  const Model& model = fitted.model;
  const PreparedModel first = prepare(model, 1);
  AtWavelengths prepared([&](double wavelength) { return first.at(wavelength); });
  std::vector<Mueller> result = fitted.residuals;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto& [wavelength, geometry, f11, normalized, u, as_measured, given_in] = samples[s];
    if (as_measured && rows_turn(model.family)) {
      const Mueller m = prepared(wavelength).evaluate(geometry, as_measured->frame);
      for (std::size_t e = 1; e < 16; ++e)
        result[s].elements[e] = as_measured->normalized.elements[e] - m.elements[e] / m(0, 0);
    } else if (turns(model.family, model.rotation)) {
      result[s] = turned(result[s], -geometry.incident.phi);
    }
    result[s](0, 0) /= model.reflectance.at(wavelength);
  }
  return result;
}

/// The law at each fitted wavelength, from what a first fit leaves.
std::vector<NoiseEstimate> noise_at_wavelengths(const Model& first, std::span<const Sample> samples,
                                                std::span<const Mueller> left) {
  const std::size_t count = first.validity.wavelengths.size();
  std::vector<std::vector<Sample>> samples_at(count);
  std::vector<std::vector<Mueller>> left_at(count);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const std::size_t at = wavelength_index(first.validity.wavelengths, samples[s].wavelength);
    samples_at[at].push_back(samples[s]);
    left_at[at].push_back(left[s]);
  }
  std::vector<NoiseEstimate> laws;
  for (std::size_t at = 0; at < count; ++at) laws.push_back(estimate_noise(samples_at[at], left_at[at]));
  return laws;
}

}  // namespace

double polarization_rms(const FitResult& result) {
  double squares = 0, rows = 0;
  for (std::size_t e = 1; e < 16; ++e) {
    const auto rows_e = static_cast<double>(result.elements[e].rows);
    squares += rows_e * result.elements[e].rms * result.elements[e].rms;
    rows += rows_e;
  }
  return rows > 0 ? std::sqrt(squares / rows) : 0;
}

FitAccumulator::FitAccumulator(const Basis& basis)
    : basis_(basis), blocks_(blocks(basis.family, basis.orders)), designs_(designs(blocks_, basis.family)) {
  require_valid(basis.family, basis.rotation);
  block_of_.fill(-1);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b].modes.size() > size(LeastSquares::max_unknowns))
      throw std::invalid_argument("block " + blocks_[b].name + " of the " + to_string(basis.family) + " family has " +
                                  std::to_string(blocks_[b].modes.size()) + " modes at these orders, more than " +
                                  std::to_string(LeastSquares::max_unknowns));
    for (const Element& element : blocks_[b].elements) block_of_[element.index()] = static_cast<int>(b);
  }
}

FitAccumulator::AtWavelength& FitAccumulator::slot(double wavelength) {
  AtWavelength& at = wavelength_slot(wavelengths_, wavelength);
  for (std::size_t e = at.elements.size(); e < 16; ++e)
    at.elements.emplace_back(block_of_[e] < 0 ? 1 : static_cast<int>(blocks_[size(block_of_[e])].modes.size()));
  return at;
}

void FitAccumulator::merge(const FitAccumulator& other) {
  if (!(basis_ == other.basis_)) throw std::invalid_argument("cannot merge fits of different bases");
  std::vector<LeastSquares*> folded;
  std::vector<const LeastSquares*> others;
  for (const auto& [wavelength, theirs] : other.wavelengths_) {
    AtWavelength& ours = slot(wavelength);
    for (std::size_t e = 0; e < 16; ++e) {
      folded.push_back(&ours.elements[e]);
      others.push_back(&theirs.elements[e]);
      ours.weight[e] += theirs.weight[e];
    }
    for (const auto& [elements, where] : theirs.measured) {
      Measured& measured = measured_of(ours, elements);
      measured.pairs.merge(where.pairs);
      measured.theta_i_max = std::max(measured.theta_i_max, where.theta_i_max);
      measured.theta_r_max = std::max(measured.theta_r_max, where.theta_r_max);
    }
  }
  LeastSquares::merge(folded, others);
  sides_ = static_cast<Sides>(sides_ | other.sides_);
  has_turned_rows_ = has_turned_rows_ || other.has_turned_rows_;
  samples_ += other.samples_;
}

Solution FitAccumulator::block_solution(std::size_t block, int powers, const ReflectanceTable& reflectance,
                                        double rank_tolerance, SvdCache& known) const {
  std::vector<double> divisors, factors;  // of each wavelength: one, and one for each power
  for (const auto& [wavelength, at] : wavelengths_) {
    divisors.push_back(block_of_[0] == static_cast<int>(block) ? reflectance.at(wavelength) : 1);
    const std::vector<double> of_wavelength = powers_of(wavelength, powers);
    factors.insert(factors.end(), of_wavelength.begin(), of_wavelength.end());
  }
  std::vector<std::vector<const LeastSquares*>> parts;  // for each element, of each wavelength
  long rows = 0;
  bool alike = true;
  for (const Element& element : blocks_[block].elements) {
    parts.emplace_back();
    for (const auto& [wavelength, at] : wavelengths_) {
      parts.back().push_back(&at.elements[element.index()]);
      rows += parts.back().back()->rows();
      alike = alike && parts.back().back()->has_rows_of(*parts.back().front());
    }
  }
  const int modes = parts[0][0]->unknowns(), width = powers + 1;
  LeastSquares all(alike ? modes : modes * width, alike ? static_cast<int>(divisors.size()) : 1);
  for (const std::vector<const LeastSquares*>& part : parts) {
    if (alike) all.merge(LeastSquares::beside(part, divisors));
    for (std::size_t w = 0; !alike && w < part.size(); ++w)
      all.merge_repeated(*part[w], std::span(factors).subspan(w * size(width), size(width)), 1 / divisors[w]);
  }
  return alike ? all.solve_over(factors, rows, rank_tolerance, &known) : all.solve(rank_tolerance, &known);
}

bool FitAccumulator::turns() const { return mmbrdf::turns(basis_); }

bool FitAccumulator::takes_own_reflectance(const FitOptions& options) const {
  return !options.reflectance && wavelengths_.size() > 1;
}

ReflectanceTable FitAccumulator::own_reflectance(const FitOptions& options, SvdCache& known) const {
  ReflectanceTable table;
  const std::vector<double> slopes =
      directional_hemispherical_slopes(blocks_.front(), basis_.family, basis_.mapping, {});
  for (const auto& [wavelength, at] : wavelengths_) {
    const Solution solution = at.elements[0].solve(options.rank_tolerance, &known);
    if (const std::string free = undetermined(blocks_[0], solution); !free.empty() && !accepts_minimum_norm(options))
      require_determined("the data at " + nanometre_number(wavelength) + " nm alone, one of " +
                             std::to_string(wavelengths_.size()) + " wavelengths, do not determine f11, whose " +
                             "reflectance it is to be divided by; give a reflectance table",
                         free, options);
    if (solution.rows == 0)
      throw std::invalid_argument("f11 is not measured at " + nanometre_number(wavelength) + " nm");
    const double dhr = std::inner_product(slopes.begin(), slopes.end(), solution.x.begin(), 0.0);
    if (!(dhr > 0))
      throw std::invalid_argument("the normal-incidence reflectance at " + nanometre_number(wavelength) +
                                  " nm comes out as " + rounded(dhr, 2) + "; give a reflectance table");
    table.wavelengths.push_back(wavelength);
    table.values.push_back(dhr);
  }
  return table;
}

bool FitAccumulator::accepts_minimum_norm(const FitOptions& options) const {
  return options.minimum_norm || traits(basis_.family).minimum_norm;
}

int FitAccumulator::chosen_powers(const FitOptions& options) const {
  const int powers = options.powers.value_or(wavelengths_.size() > 1 ? 1 : 0);
  if (powers < 0)
    throw std::invalid_argument("highest power of the wavelength " + std::to_string(powers) + " is negative");
  if (powers > max_power)
    throw std::invalid_argument("highest power of the wavelength " + std::to_string(powers) + " is more than " +
                                std::to_string(max_power));
  if (size(powers) >= wavelengths_.size())
    throw std::invalid_argument("powers of the wavelength up to " + std::to_string(powers) + " need " +
                                std::to_string(powers + 1) + " wavelengths, the data have " +
                                std::to_string(wavelengths_.size()));
  return powers;
}

FitResult FitAccumulator::solve(const FitOptions& options) const {
  if (options.covariance == Covariance::sandwich)
    throw std::invalid_argument("a sandwich covariance needs the samples again, and an accumulator keeps none");
  FitResult result = solved(options);
  result.model.validity.supported = support(result.model);
  return result;
}

FitResult FitAccumulator::solved(const FitOptions& options) const {
  SvdCache known;
  return solved(options, known, true);
}

FitResult fit_to_predict(const FitAccumulator& samples, const FitOptions& options, SvdCache& known) {
  return samples.solved(options, known, false);
}

/// Elements that the rows of a block leave open, and that have none, become unknown. Rows in another frame than xy determine
/// no element of xy by themselves; a block that they leave open is left out.
bool FitAccumulator::leave_out_undetermined(const Block& block, const Solution& solution, FitResult& result) const {
  Elements open, without_rows, all;
  for (const Element& element : block.elements) {
    const std::size_t e = element.index();
    all.set(e);
    without_rows[e] = result.elements[e].rows == 0;
    if ((without_rows[e] || has_turned_rows_) && !determines(solution, block, basis_, e)) open.set(e);
  }
  if (without_rows.none()) return false;
  if (!has_turned_rows_ || open.none()) {
    result.model.not_measured |= open;
    return false;
  }
  result.model.not_measured |= all;
  for (std::size_t e = 0; e < 16; ++e)
    if (all[e]) result.elements[e] = {};
  result.warnings.push_back("the elements " + block.name + " are unknown: " + element_names(all & ~without_rows) +
                            " alone, in the frame in which they were measured, leave combinations of their modes open");
  return true;
}

FitResult FitAccumulator::solved(const FitOptions& options, SvdCache& known, bool covariances) const {
  if (samples_ == 0) throw std::invalid_argument("no samples");
  const int powers = chosen_powers(options);
  std::string complaints;
  FitResult result;
  result.sides = sides_;
  Model& model = result.model;
  model.family = basis_.family;
  model.mapping = basis_.mapping;
  model.rotation = basis_.rotation;
  model.powers = powers;
  for (const auto& [wavelength, at] : wavelengths_) model.validity.wavelengths.push_back(wavelength);
  if (takes_own_reflectance(options)) model.reflectance = own_reflectance(options, known);
  if (options.reflectance) model.reflectance = {options.reflectance->wavelengths, options.reflectance->values};
  require_valid(model.reflectance);
  require_covered(model.reflectance);
  model.not_measured = not_measured();
  if (model.not_measured[0]) throw std::invalid_argument("f11 is not measured in any sample");
  set_angles(model.validity, model.not_measured);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (model.not_measured[blocks_[b].elements.front().index()]) continue;
    Solution solution = block_solution(b, powers, model.reflectance, options.rank_tolerance, known);
    for (const Element& element : blocks_[b].elements)
      result.elements[element.index()] = element_fit(element.index(), solution.x, model.reflectance);
    if (leave_out_undetermined(blocks_[b], solution, result)) continue;
    if (!accepts_minimum_norm(options)) complaints += undetermined(blocks_[b], solution);
    FittedBlock fitted{blocks_[b],           solution.x,          {},           solution.rank,
                       solution.condition(), solution.null_space, solution.rows};
    if (const std::optional<double> variance = row_variance(solution, options.covariance); covariances && variance) {
      fitted.covariance = solution.inverse;
      for (double& c : fitted.covariance) c *= *variance;
    }
    model.blocks.push_back(std::move(fitted));
    result.solutions.push_back(std::move(solution));
  }
  require_determined("the data do not determine the model", complaints, options);
  for (std::size_t e = 0; e < 16; ++e)
    if (block_of_[e] < 0 && !model.not_measured[e])  // no mode: the model's element is 0
      result.elements[e] = element_fit(e, std::array{0.0}, model.reflectance);
  if (covariances && takes_own_reflectance(options) && row_variance(result.solutions.front(), options.covariance))
    add_own_reflectance_covariance(result, options, known, nullptr);
  return result;
}

void FitAccumulator::require_covered(const ReflectanceTable& table) const {
  for (const auto& [wavelength, at] : wavelengths_) require_reaches(table, wavelength);
}

ElementFit FitAccumulator::element_fit(std::size_t element, std::span<const double> x,
                                       const ReflectanceTable& reflectance) const {
  ElementFit fit;
  for (const auto& [wavelength, at] : wavelengths_) {
    const LeastSquares& rows = at.elements[element];
    const double divisor = element == 0 ? reflectance.at(wavelength) : 1;
    std::vector<double> here = at_wavelength(x, size(rows.unknowns()), wavelength);
    for (double& coefficient : here) coefficient *= divisor;
    const double norm = rows.residual_norm(here) / divisor;
    fit.rows += rows.rows();
    fit.chi_squared += norm * norm;
    fit.weight += at.weight[element];
  }
  fit.rms = fit.weight > 0 ? std::sqrt(fit.chi_squared / fit.weight) : 0;
  return fit;
}

bool rows_turn(Family family) { return family == Family::isotropic; }

FitResult FitAccumulator::of_noise(std::span<const Sample> samples, const Basis& basis, const FitOptions& options,
                                   Weights weights) {
  FitAccumulator accumulator(basis);
  accumulator.add(samples);
  FitResult result = accumulator.solved(options);
  if (weights == Weights::estimated)
    result.noise = noise_at_wavelengths(result.model, samples, residuals(result.model, samples));
  std::vector<Mueller> list = fit_weights(samples, basis, result, weights);
  if (weights != Weights::none) {
    std::vector<NoiseEstimate> noise = std::move(result.noise);
    accumulator = FitAccumulator(basis);
    accumulator.add(samples, list);
    result = accumulator.solved(options);
    result.noise = std::move(noise);
  }
  result.model.validity.supported = accumulator.support(result.model);
  result.weights = weights;
  result.sample_weights = list;
  result.residuals = residuals(result.model, samples);
  if (options.covariance == Covariance::sandwich) {
    list.resize(samples.size(), ones());
    const std::vector<Mueller> left = residuals_of_rows(samples, result);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const Mueller& r = left[s];
      for (std::size_t e = 0; e < 16; ++e)
        list[s].elements[e] *= std::isnan(r.elements[e]) ? 0 : list[s].elements[e] * r.elements[e] * r.elements[e];
    }
    FitAccumulator squares(basis);
    squares.add(samples, list);
    accumulator.use_sandwich(result, options, squares);
  }
  return result;
}

FitResult fit(std::span<const Sample> samples, const Basis& basis, const FitOptions& options, Weights weights) {
  if (options.covariance == Covariance::given && weights != Weights::data)
    throw std::invalid_argument("covariance given is that of the samples' own uncertainties: it takes weights data");
  if (!samples.empty() && not_measured(samples)[0]) throw std::invalid_argument("f11 is not measured in any sample");
  if (options.uncertainty == Uncertainty::noise) return FitAccumulator::of_noise(samples, basis, options, weights);
  std::string reason;
  if (options.covariance != Covariance::residuals)
    reason = only_residuals(options.covariance);
  else if (weights == Weights::data)
    reason = "weights of the data have no law";
  else
    try {
      return sample_fit(samples, basis, options, weights);
    } catch (const MixedFailure& failure) {
      reason = failure.what();
    }
  FitResult result = FitAccumulator::of_noise(samples, basis, options, weights);
  result.warnings.push_back(only_noise(reason, options.declared));
  return result;
}

FitResult fit_sample(std::span<const Sample> samples, const Basis& basis, FitOptions options) {
  options.uncertainty = Uncertainty::sample;
  return fit(samples, basis, options, Weights::speckle);
}

std::string to_string(Uncertainty uncertainty) { return name_of(uncertainty_names, uncertainty); }
Uncertainty uncertainty_from(const std::string& name) { return value_of(uncertainty_names, name, "uncertainty"); }
std::string to_string(Weights weights) { return name_of(weights_names, weights); }
Weights weights_from(const std::string& name) { return value_of(weights_names, name, "weights"); }
std::string to_string(Covariance covariance) { return name_of(covariance_names, covariance); }
Covariance covariance_from(const std::string& name) { return value_of(covariance_names, name, "covariance"); }

}  // namespace mmbrdf
