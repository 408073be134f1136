// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double edge = 1e-9;        // radians and micrometres: angles that went through degrees are still inside
constexpr double resolution = 1e-7;  // of wavelengths in files, micrometres

/// NaN is larger than anything.
bool all_within(const std::vector<double>& numbers, double limit) {
  return std::ranges::all_of(numbers, [limit](double x) { return std::abs(x) <= limit; });
}

}  // namespace

void require_wavelength(double wavelength) {
  if (!(wavelength > 0))
    throw std::invalid_argument("wavelength " + shortest(in_nanometres(wavelength)) + " nm is not positive");
  if (!(wavelength <= max_wavelength))
    throw std::invalid_argument("wavelength " + shortest(in_nanometres(wavelength)) + " nm is more than a metre");
}

std::vector<double> ReflectanceTable::weights(double wavelength) const {
  std::vector<double> result(values.size());
  const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), wavelength);
  const std::size_t i = static_cast<std::size_t>(above - wavelengths.begin());
  if (values.empty()) return result;
  if (above == wavelengths.begin() || above == wavelengths.end()) {
    result[above == wavelengths.begin() ? 0 : values.size() - 1] = 1;
    return result;
  }
  result[i] = (wavelength - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
  result[i - 1] = 1 - result[i];
  return result;
}

double ReflectanceTable::at(double wavelength) const {  // weights(), without allocating
  if (values.empty()) return 1;
  const auto above = std::upper_bound(wavelengths.begin(), wavelengths.end(), wavelength);
  if (above == wavelengths.begin()) return values.front();
  if (above == wavelengths.end()) return values.back();
  const std::size_t i = static_cast<std::size_t>(above - wavelengths.begin());
  const double weight = (wavelength - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
  return (1 - weight) * values[i - 1] + weight * values[i];
}

void require_valid(const ReflectanceTable& table) {
  if (table.wavelengths.size() != table.values.size())
    throw std::invalid_argument("reflectance table: " + std::to_string(table.wavelengths.size()) + " wavelengths, " +
                                std::to_string(table.values.size()) + " values");
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    require_wavelength(table.wavelengths[i]);
    if (i > 0 && table.wavelengths[i] <= table.wavelengths[i - 1])
      throw std::invalid_argument("reflectance table: wavelength " + shortest(in_nanometres(table.wavelengths[i])) +
                                  " nm does not rise");
    if (!(table.values[i] > 0 && table.values[i] <= largest_coefficient))
      throw std::invalid_argument("reflectance table: value " + shortest(table.values[i]) + " is not " +
                                  (table.values[i] > 0 ? "at most " + shortest(largest_coefficient) : "positive"));
  }
  const std::size_t count = table.values.size();
  if (!table.covariance.empty() && table.covariance.size() != count * count && table.covariance.size() != count)
    throw std::invalid_argument("reflectance table: covariance of " + std::to_string(table.covariance.size()) +
                                " numbers, expected " + std::to_string(count * count));
  if (!table.certified_theta.empty() &&
      (table.certified_theta.size() != count || table.covariance.empty() ||
       !std::ranges::all_of(table.certified_theta, [](double theta) { return theta >= 0 && theta < pi / 2; })))
    throw std::invalid_argument(
        "reflectance table: certified polar angles must be in [0, 90) degrees, one for each value");
  if (table.covariance.empty() && !table.covariance_with_f11.empty())
    throw std::invalid_argument("reflectance table: a covariance with the coefficients, but none of its own");
  for (const auto* list : {&table.covariance, &table.covariance_with_f11})
    if (!all_within(*list, largest_variance))
      throw std::invalid_argument("reflectance table: a covariance is not a number up to " +
                                  shortest(largest_variance));
}

void require_reaches(const ReflectanceTable& table, double wavelength) {
  if (!table.values.empty() &&
      (wavelength < table.wavelengths.front() - resolution || wavelength > table.wavelengths.back() + resolution))
    throw std::invalid_argument("the reflectance table does not reach " + shortest(in_nanometres(wavelength)) + " nm");
}

std::string to_string(Outside outside) {
  std::string result;
  const auto append = [&](Outside reason, const char* name) {
    if (outside & reason) result.append(result.empty() ? "" : "+").append(name);
  };
  append(outside_theta_i, "theta_i");
  append(outside_theta_r, "theta_r");
  append(outside_wavelength, "wavelength");
  append(outside_directions, "directions");
  append(interpolated, "interpolated");
  append(unknown_range, "unknown");
  return result.empty() ? "ok" : result;
}

bool leaves_known_range(Outside outside) {
  return (outside & (outside_theta_i | outside_theta_r | outside_wavelength | outside_directions)) != 0;
}

namespace {

void require_valid(const Validity& validity) {
  double last = 0;
  for (const double wavelength : validity.wavelengths) {
    require_wavelength(wavelength);
    if (wavelength <= last)
      throw std::invalid_argument("validity: wavelength " + shortest(in_nanometres(wavelength)) + " nm does not rise");
    last = wavelength;
  }
  for (const std::optional<double>& theta : {validity.theta_i_max, validity.theta_r_max})
    if (theta && !(*theta >= 0 && *theta <= pi / 2 + edge))
      throw std::invalid_argument("validity: polar angle " + shortest(in_degrees(*theta)) +
                                  " degrees is not in [0, 90]");
  for (const SupportedPairs& one : validity.supported) {
    require_wavelength(one.wavelength);
    if (one.pairs.grid() != validity.supported.front().pairs.grid())
      throw std::invalid_argument("validity: the supported directions are of different grids");
  }
  const auto not_rising = [](const SupportedPairs& a, const SupportedPairs& b) {
    return !(a.wavelength < b.wavelength);
  };
  if (std::ranges::adjacent_find(validity.supported, not_rising) != validity.supported.end())
    throw std::invalid_argument("validity: wavelengths of the supported directions do not rise");
}

/// The numbers of a block, of which there are `count` coefficients.
void require_valid(const FittedBlock& fitted, std::size_t count) {
  const std::string where = "block " + fitted.block.name + ": ";
  const auto require_size = [&](const std::vector<double>& list, std::size_t expected, const std::string& what) {
    if (list.size() != expected)
      throw std::invalid_argument(where + what + std::to_string(list.size()) + " numbers, expected " +
                                  std::to_string(expected));
  };
  if (fitted.coefficients.size() != count)
    throw std::invalid_argument(where + std::to_string(fitted.coefficients.size()) + " coefficients, expected " +
                                std::to_string(count));
  if (fitted.rank < 0 || static_cast<std::size_t>(fitted.rank) > count)
    throw std::invalid_argument(where + "rank " + std::to_string(fitted.rank) + " of " + std::to_string(count));
  const std::size_t free = count - static_cast<std::size_t>(fitted.rank);
  if (!fitted.null_space.empty()) require_size(fitted.null_space, free * count, "null space of ");
  if (!fitted.covariance.empty()) require_size(fitted.covariance, count * count, "covariance of ");
  const auto require_within = [&](const std::vector<double>& list, double limit, const std::string& what) {
    if (!all_within(list, limit))
      throw std::invalid_argument(where + what + " is not a number up to " + shortest(limit));
  };
  require_within(fitted.coefficients, largest_coefficient, "a coefficient");
  require_within(fitted.covariance, largest_variance, "a covariance");
  require_within(fitted.null_space, largest_coefficient, "a part of a free combination");
  for (std::size_t i = 0; i < (fitted.covariance.empty() ? 0 : count); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (fitted.covariance[i * count + j] != fitted.covariance[j * count + i])
        throw std::invalid_argument(where + "covariance is not symmetric at " + std::to_string(i + 1) + ", " +
                                    std::to_string(j + 1));
}

/// The evaluated modes are among those of the posterior.
void require_posterior(const Model& model) {
  const auto refuse = [](const std::string& why) { throw std::invalid_argument("the posterior of the model " + why); };
  const std::vector<Block>& behind = model.posterior->blocks();
  if (model.family != Family::isotropic) refuse("is of the isotropic family, the model of " + to_string(model.family));
  if (model.mapping != model.posterior->mapping()) refuse("has another mapping to the disc");
  if (model.not_measured != model.posterior->not_measured()) refuse("is of other elements");
  if (model.blocks.size() != behind.size()) refuse("has " + std::to_string(behind.size()) + " blocks");
  for (std::size_t b = 0; b < behind.size(); ++b)
    for (const Mode& mode : model.blocks[b].block.modes)
      if (std::ranges::find(behind[b].modes, mode) == behind[b].modes.end())
        refuse("does not have the mode " + to_string(mode));
  if (std::ranges::any_of(model.blocks, [](const FittedBlock& fitted) { return !fitted.covariance.empty(); }))
    refuse("takes the place of a covariance, and there is one");
}

}  // namespace

void require_valid(const Model& model) {
  if (model.powers < 0 || model.powers > max_power)
    throw std::invalid_argument("highest power of the wavelength " + std::to_string(model.powers) + " is not in 0..." +
                                std::to_string(max_power));
  std::vector<Mode> modes;
  for (const FittedBlock& fitted : model.blocks)
    modes.insert(modes.end(), fitted.block.modes.begin(), fitted.block.modes.end());
  const std::vector<Block> expected = blocks(model.family, modes);
  if (expected.empty() || expected.front().name != "11")
    throw std::invalid_argument("model has no modes of element 11");
  if (expected.size() != model.blocks.size())
    throw std::invalid_argument("model: modes are not in the blocks of the family");
  for (std::size_t b = 0; b < expected.size(); ++b) {
    const FittedBlock& fitted = model.blocks[b];
    if (fitted.block.modes != expected[b].modes || fitted.block.elements != expected[b].elements)
      throw std::invalid_argument("block " + fitted.block.name + ": modes are not in canonical order");
    require_valid(fitted, fitted.block.modes.size() * (static_cast<std::size_t>(model.powers) + 1));
  }
  if (model.not_measured[0]) throw std::invalid_argument("model: f11 is said not to be measured");
  if (without(model.not_measured, expected).size() < expected.size())
    throw std::invalid_argument("model: elements are said not to be measured, but their block has modes");
  require_valid(model.reflectance);
  const std::size_t with_f11 = model.reflectance.covariance.empty()
                                   ? 0
                                   : model.reflectance.values.size() * model.blocks.front().coefficients.size();
  if (model.reflectance.covariance_with_f11.size() != with_f11)
    throw std::invalid_argument("reflectance table: covariance with the coefficients of " +
                                std::to_string(model.reflectance.covariance_with_f11.size()) + " numbers, expected " +
                                std::to_string(with_f11));
  require_valid(model.validity);
  if (!model.validity.supported.empty() && (model.validity.supported.front().pairs.grid() ==
                                            DirectionPairs::Grid::anisotropic) != (model.family == Family::anisotropic))
    throw std::invalid_argument("validity: the supported directions are on the grid of another family");
  if (model.posterior) require_posterior(model);
}

bool has_covariance(const Model& model) {
  return model.posterior ||
         std::ranges::any_of(model.blocks, [](const FittedBlock& b) { return !b.covariance.empty(); });
}

double degrees_of_freedom(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const FittedBlock& b : model.blocks)
    if (b.rows > 0) least = std::min(least, std::max(1.0, static_cast<double>(b.rows - b.rank)));
  return least;
}

bool turns(const Model& model) { return turns(model.family, model.rotation); }

Elements unknown_elements(const Model& model, Frame frame) {
  return turns(model) || frame != Frame::xy ? turned_into(model.not_measured) : model.not_measured;
}

Model as_printed(Model model) {
  model.rotation = Rotation::as_printed;
  return model;
}

int mode_count(const Model& model) {
  std::size_t count = 0;
  for (const FittedBlock& fitted : model.blocks) count += fitted.block.modes.size();
  return static_cast<int>(count);
}

int coefficient_count(const Model& model) {
  std::size_t count = 0;
  for (const FittedBlock& fitted : model.blocks) count += fitted.coefficients.size();
  return static_cast<int>(count);
}

Orders orders(const Model& model) {
  std::vector<Block> list;
  for (const FittedBlock& fitted : model.blocks) list.push_back(fitted.block);
  return orders(list);
}

namespace {

bool supports(const std::vector<SupportedPairs>& list, double wavelength, const Geometry& geometry) {
  if (list.empty()) return true;
  const auto above = std::ranges::lower_bound(list, wavelength - resolution, {}, &SupportedPairs::wavelength);
  const auto below = above == list.end() || (above != list.begin() && above->wavelength > wavelength + resolution)
                         ? std::prev(above)
                         : above;
  return below->pairs.contains(geometry) && (above == list.end() || above->pairs.contains(geometry));
}

}  // namespace

Outside outside(const Validity& validity, double wavelength, const Geometry& geometry) {
  unsigned result = outside(validity, wavelength);
  if (geometry.incident.theta > validity.theta_i_max.value_or(pi / 2) + edge) result |= outside_theta_i;
  if (geometry.reflected.theta > validity.theta_r_max.value_or(pi / 2) + edge) result |= outside_theta_r;
  if (!(result & (outside_theta_i | outside_theta_r)) && !supports(validity.supported, wavelength, geometry))
    result |= outside_directions;
  return static_cast<Outside>(result);
}

Outside outside(const Validity& validity, double wavelength) {
  unsigned result = inside;
  const std::vector<double>& fitted = validity.wavelengths;
  if (!validity.theta_i_max || !validity.theta_r_max || fitted.empty()) result |= unknown_range;
  if (fitted.empty()) return static_cast<Outside>(result);
  const auto next = std::ranges::lower_bound(fitted, wavelength - resolution);
  if (wavelength < fitted.front() - edge || wavelength > fitted.back() + edge)
    result |= outside_wavelength;
  else if (next != fitted.end() && *next > wavelength + resolution)
    result |= interpolated;
  return static_cast<Outside>(result);
}

double only_wavelength(const Model& model) {
  const std::size_t known = model.validity.wavelengths.size();
  if (model.powers == 0 && known <= 1 && model.reflectance.values.size() <= 1)
    return known == 1 ? model.validity.wavelengths.front() : 1.0;
  std::string list;
  for (const double wavelength : model.validity.wavelengths)
    list += (list.empty() ? ", fitted at " : ", ") + shortest(in_nanometres(wavelength));
  throw std::invalid_argument("the model depends on the wavelength" + list + (list.empty() ? "" : " nm") +
                              ": give one");
}

std::vector<double> known_wavelengths(const Model& model) {
  if (!model.validity.wavelengths.empty()) return model.validity.wavelengths;
  if (!model.reflectance.wavelengths.empty()) return model.reflectance.wavelengths;
  return model.powers == 0 ? std::vector{1.0} : std::vector<double>{};
}

bool knows_wavelength(const Model& model) {
  return !model.validity.wavelengths.empty() || !model.reflectance.wavelengths.empty();
}

}  // namespace mmbrdf
