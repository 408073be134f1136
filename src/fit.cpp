// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fit.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mmbrdf/radiometry.hpp"
#include "numbers.hpp"

// For each wavelength and element there is one triangle (LeastSquares) over the modes of the element's block. The fit
// of a block over all wavelengths, with any powers and any reflectance table, is put together from them: a coefficient
// that is a polynomial of λ repeats the columns of each wavelength's triangle, multiplied by λ^p.

namespace mmbrdf {
namespace {

constexpr std::size_t samples_at_once = 128;
constexpr double involved = 1e-6;       // least part of a free combination for which a mode is named
constexpr std::size_t most_named = 24;  // modes in a message of one line

std::size_t size(int n) { return static_cast<std::size_t>(n); }

std::string nanometres(double wavelength) { return shortest(in_nanometres(wavelength)); }

/// "11(7,7,5,-5)", and the power of the wavelength where there are several.
std::string short_name(const Block& block, std::size_t coefficient, std::size_t count) {
  const Mode& mode = block.modes[coefficient % block.modes.size()];
  std::string name = to_string(mode.function);
  char separator = '(';
  for (const int order : {mode.n, mode.m, mode.k, mode.l}) {
    name += separator;
    name += std::to_string(order);
    separator = ',';
  }
  name += ')';
  if (count > block.modes.size()) name.append("p").append(std::to_string(coefficient / block.modes.size()));
  return name;
}

/// What the data leave free of a block, or nothing.
std::string undetermined(const Block& block, const Solution& solution) {
  const std::size_t n = solution.x.size(), free = n - size(solution.rank);
  if (free == 0) return "";
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double part = 0;
    for (std::size_t f = 0; f < free; ++f) part = std::max(part, std::abs(solution.null_space[f * n + i]));
    if (part > involved && ++count <= most_named) names.append(" ").append(short_name(block, i, n));
  }
  if (count > most_named) names.append(" and ").append(std::to_string(count - most_named)).append(" more");
  return "; block " + block.name + ": rank " + std::to_string(solution.rank) + " of " + std::to_string(n) + ", " +
         std::to_string(free) + " combinations are free of the modes (n,m,k,l)" + names;
}

void require_determined(const std::string& complaints) {
  if (!complaints.empty())
    throw std::invalid_argument("the data do not determine the model" + complaints +
                                "; choose lower orders, or ask for the solution of minimum norm");
}

void require_weights(std::span<const Mueller> weights, std::size_t samples) {
  if (!weights.empty() && weights.size() != samples)
    throw std::invalid_argument("fit: " + std::to_string(weights.size()) + " weights for " + std::to_string(samples) +
                                " samples");
  for (std::size_t s = 0; s < weights.size(); ++s)
    for (const double weight : weights[s].elements)
      if (!(weight >= 0) || !std::isfinite(weight))
        throw std::invalid_argument("fit: weight " + shortest(weight) + " of sample " + std::to_string(s + 1));
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

FitAccumulator::FitAccumulator(const Basis& basis) : basis_(basis), blocks_(blocks(basis.family, basis.orders)) {
  block_of_.fill(-1);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (blocks_[b].modes.size() > size(LeastSquares::max_unknowns))
      throw std::invalid_argument("block " + blocks_[b].name + " of the " + to_string(basis.family) + " family has " +
                                  std::to_string(blocks_[b].modes.size()) + " modes at these orders, more than " +
                                  std::to_string(LeastSquares::max_unknowns));
    for (const auto& [row, column] : blocks_[b].elements) block_of_[size(4 * row + column)] = static_cast<int>(b);
    for (std::size_t q = 0; q < blocks_[b].modes.size(); ++q)
      for (const Term& term : terms(blocks_[b].modes[q], basis.family))
        terms_[size(4 * term.row + term.column)].push_back({q, size(term.incident), size(term.reflected), term.weight});
  }
}

FitAccumulator::AtWavelength& FitAccumulator::slot(double wavelength) {
  const auto near = wavelengths_.lower_bound(wavelength - wavelength_resolution);
  if (near != wavelengths_.end() && near->first <= wavelength + wavelength_resolution) return near->second;
  AtWavelength& fresh = wavelengths_[wavelength];
  for (const int block : block_of_)
    fresh.elements.emplace_back(block < 0 ? 1 : static_cast<int>(blocks_[size(block)].modes.size()));
  return fresh;
}

void FitAccumulator::add(std::span<const Sample> samples, std::span<const Mueller> weights) {
  require_valid(samples);
  require_weights(weights, samples.size());
  std::map<AtWavelength*, std::vector<std::size_t>> groups;
  for (std::size_t s = 0; s < samples.size(); ++s) groups[&slot(samples[s].wavelength)].push_back(s);
  for (auto& [at, members] : groups)
    for (std::size_t first = 0; first < members.size(); first += samples_at_once)
      add_some(*at, samples, std::span(members).subspan(first, std::min(samples_at_once, members.size() - first)),
               weights);
  for (const Sample& sample : samples) {
    theta_i_max_ = std::max(theta_i_max_, sample.geometry.incident.theta);
    theta_r_max_ = std::max(theta_r_max_, sample.geometry.reflected.theta);
  }
  samples_ += static_cast<long>(samples.size());
}

void FitAccumulator::add_some(AtWavelength& at, std::span<const Sample> samples, std::span<const std::size_t> members,
                              std::span<const Mueller> weights) {
  std::vector<Sample> used;
  const int order = std::max(basis_.orders.f11, basis_.orders.other);
  const std::size_t functions = size(zernike_count(order));
  std::vector<double> k_i(members.size() * functions), k_r(members.size() * functions);
  for (std::size_t s = 0; s < members.size(); ++s) {
    used.push_back(turns() ? at_zero_azimuth(samples[members[s]]) : samples[members[s]]);
    zernike_table(order, disc_point(used[s].geometry.incident, basis_.mapping), &k_i[s * functions]);
    zernike_table(order, disc_point(used[s].geometry.reflected, basis_.mapping), &k_r[s * functions]);
  }
  std::vector<double> rows, values, row_weights;
  for (std::size_t e = 0; e < 16; ++e) {
    const std::size_t columns = size(at.elements[e].unknowns());
    rows.assign(members.size() * columns, 0);
    values.clear();
    row_weights.clear();
    for (std::size_t s = 0; s < members.size(); ++s) {
      for (const ColumnTerm& t : terms_[e])
        rows[s * columns + t.column] += t.weight * k_i[s * functions + t.incident] * k_r[s * functions + t.reflected];
      values.push_back(e == 0 ? used[s].f11 : used[s].normalized.elements[e]);
      row_weights.push_back(weights.empty() ? 1 : weights[members[s]].elements[e]);
      at.weight[e] += row_weights.back();
    }
    at.elements[e].add(rows, values, weights.empty() ? std::span<const double>{} : row_weights);
  }
}

void FitAccumulator::merge(const FitAccumulator& other) {
  if (!(basis_ == other.basis_)) throw std::invalid_argument("FitAccumulator: cannot merge fits of different bases");
  for (const auto& [wavelength, theirs] : other.wavelengths_) {
    AtWavelength& ours = slot(wavelength);
    for (std::size_t e = 0; e < 16; ++e) {
      ours.elements[e].merge(theirs.elements[e]);
      ours.weight[e] += theirs.weight[e];
    }
  }
  theta_i_max_ = std::max(theta_i_max_, other.theta_i_max_);
  theta_r_max_ = std::max(theta_r_max_, other.theta_r_max_);
  samples_ += other.samples_;
}

LeastSquares FitAccumulator::over_wavelengths(std::size_t element, int powers,
                                              const ReflectanceTable& reflectance) const {
  const int modes = wavelengths_.begin()->second.elements[element].unknowns();
  LeastSquares result(modes * (powers + 1));
  for (const auto& [wavelength, at] : wavelengths_) {
    std::vector<double> factors{1};
    for (int p = 1; p <= powers; ++p) factors.push_back(factors.back() * wavelength);
    result.merge(at.elements[element].repeated(factors, element == 0 ? 1 / reflectance.at(wavelength) : 1));
  }
  return result;
}

bool FitAccumulator::turns() const {
  return basis_.family == Family::germer2017 && basis_.rotation == Rotation::covariant;
}

bool FitAccumulator::takes_own_reflectance(const FitOptions& options) const {
  return !options.reflectance && wavelengths_.size() > 1;
}

ReflectanceTable FitAccumulator::own_reflectance(const FitOptions& options) const {
  ReflectanceTable table;
  for (const auto& [wavelength, at] : wavelengths_) {
    const Solution solution = at.elements[0].solve(options.rank_tolerance);
    if (const std::string free = undetermined(blocks_[0], solution); !free.empty() && !accepts_minimum_norm(options))
      throw std::invalid_argument("the data at " + nanometres(wavelength) + " nm alone do not determine f11, whose " +
                                  "reflectance it is to be divided by; give a reflectance table" + free);
    Model f11;
    f11.family = basis_.family;
    f11.mapping = basis_.mapping;
    f11.blocks.push_back({blocks_[0], solution.x, {}, 0, 0});
    const double dhr = directional_hemispherical_reflectance(f11, wavelength, {0, 0});
    if (!(dhr > 0))
      throw std::invalid_argument("fit: the normal-incidence reflectance at " + nanometres(wavelength) +
                                  " nm comes out as " + shortest(dhr) + "; give a reflectance table");
    table.wavelengths.push_back(wavelength);
    table.values.push_back(dhr);
  }
  return table;
}

bool FitAccumulator::accepts_minimum_norm(const FitOptions& options) const {
  return options.minimum_norm || basis_.family == Family::germer2017;
}

int FitAccumulator::chosen_powers(const FitOptions& options) const {
  const int powers = options.powers.value_or(wavelengths_.size() > 1 ? 1 : 0);
  if (powers < 0)
    throw std::invalid_argument("fit: highest power of the wavelength " + std::to_string(powers) + " is negative");
  if (powers > max_power)
    throw std::invalid_argument("fit: highest power of the wavelength " + std::to_string(powers) + " is more than " +
                                std::to_string(max_power));
  if (size(powers) >= wavelengths_.size())
    throw std::invalid_argument("fit: powers of the wavelength up to " + std::to_string(powers) + " need " +
                                std::to_string(powers + 1) + " wavelengths, the data have " +
                                std::to_string(wavelengths_.size()));
  return powers;
}

FitResult FitAccumulator::solve(const FitOptions& options) const {
  if (options.covariance == Covariance::sandwich)
    throw std::invalid_argument("fit: a sandwich covariance needs the samples again, and an accumulator keeps none");
  return solved(options);
}

FitResult FitAccumulator::solved(const FitOptions& options) const {
  if (samples_ == 0) throw std::invalid_argument("fit: no samples");
  const int powers = chosen_powers(options);
  std::string complaints;
  FitResult result;
  Model& model = result.model;
  model.family = basis_.family;
  model.mapping = basis_.mapping;
  model.powers = powers;
  model.validity = {{}, theta_i_max_, theta_r_max_};
  for (const auto& [wavelength, at] : wavelengths_) model.validity.wavelengths.push_back(wavelength);
  if (takes_own_reflectance(options)) model.reflectance = own_reflectance(options);
  if (options.reflectance) model.reflectance = {options.reflectance->wavelengths, options.reflectance->values};
  require_valid(model.reflectance);
  require_covered(model.reflectance);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::vector<std::pair<std::size_t, LeastSquares>> parts;
    for (const auto& [row, column] : blocks_[b].elements)
      parts.emplace_back(size(4 * row + column), over_wavelengths(size(4 * row + column), powers, model.reflectance));
    LeastSquares whole = parts.front().second;
    for (std::size_t i = 1; i < parts.size(); ++i) whole.merge(parts[i].second);
    Solution solution = whole.solve(options.rank_tolerance);
    if (!accepts_minimum_norm(options)) complaints += undetermined(blocks_[b], solution);
    for (const auto& [e, part] : parts) result.elements[e] = element_fit(e, part, solution.x);
    FittedBlock fitted{blocks_[b], solution.x, {}, solution.rank, solution.condition(), solution.null_space};
    if (solution.degrees_of_freedom() > 0) {
      fitted.covariance = solution.inverse;
      for (double& c : fitted.covariance) c *= solution.variance();
    }
    model.blocks.push_back(std::move(fitted));
    result.solutions.push_back(std::move(solution));
  }
  require_determined(complaints);
  for (std::size_t e = 0; e < 16; ++e)
    if (block_of_[e] < 0)  // no mode: the model's element is 0
      result.elements[e] = element_fit(e, over_wavelengths(e, 0, model.reflectance), std::array{0.0});
  if (takes_own_reflectance(options) && result.solutions.front().degrees_of_freedom() > 0)
    add_own_reflectance_covariance(result, options.rank_tolerance, nullptr);
  return result;
}

void FitAccumulator::require_covered(const ReflectanceTable& table) const {
  if (table.values.empty()) return;
  for (const auto& [wavelength, at] : wavelengths_)
    if (wavelength < table.wavelengths.front() - wavelength_resolution ||
        wavelength > table.wavelengths.back() + wavelength_resolution)
      throw std::invalid_argument("fit: the reflectance table does not reach " + nanometres(wavelength) + " nm");
}

ElementFit FitAccumulator::element_fit(std::size_t element, const LeastSquares& rows, std::span<const double> x) const {
  ElementFit fit;
  fit.rows = rows.rows();
  const double norm = rows.residual_norm(x);
  fit.chi_squared = norm * norm;
  double weight = 0;
  for (const auto& [wavelength, at] : wavelengths_) weight += at.weight[element];
  fit.weight = weight;
  fit.rms = weight > 0 ? norm / std::sqrt(weight) : 0;
  return fit;
}

}  // namespace mmbrdf
