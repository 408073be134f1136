// SPDX-License-Identifier: BSD-3-Clause
// All there is in an accumulator as numbers, to be saved or sent.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "mmbrdf/fitting/fit.hpp"
#include "text/numbers.hpp"

//   the basis: family, both orders, mapping, rotation
//   samples, sides (8 more with rows that are turned),   then for each wavelength, rising: λ, in how many ways it was measured,
//   for each: the bits of the elements, rising, largest θi, largest θr, the bits of the directions, six bytes in a number,
//   then for each element, row-major: the sum of its weights, and the state of its triangle

namespace mmbrdf {
namespace {

/// Reads numbers one after another, or several.
class Reader {
 public:
  explicit Reader(std::span<const double> numbers) : rest_(numbers) {}

  bool at_end() const { return rest_.empty(); }
  std::span<const double> next(std::size_t count) {
    if (count > rest_.size()) throw std::invalid_argument("a state of a fit that ends too soon");
    const std::span<const double> result = rest_.first(count);
    rest_ = rest_.subspan(count);
    return result;
  }
  /// In [0, highest].
  double next(const char* what, double highest) {
    const double number = next(1).front();
    if (!(number >= 0 && number <= highest))
      throw std::invalid_argument("a state of a fit with " + std::string(what) + " " + shortest(number));
    return number;
  }

 private:
  std::span<const double> rest_;
};

std::vector<double> numbers_of(const Basis& basis) {
  return {static_cast<double>(basis.family), static_cast<double>(basis.orders.f11),
          static_cast<double>(basis.orders.other), static_cast<double>(basis.mapping),
          static_cast<double>(basis.rotation)};
}

constexpr double turned_rows = 8;  // added to the sides, which are up to 7

constexpr std::size_t bytes_in_number = 6;  // whole numbers below 2⁴⁸ are exact

std::vector<double> numbers_of(const DirectionPairs& pairs) {
  std::vector<double> result((pairs.bytes().size() + bytes_in_number - 1) / bytes_in_number);
  for (std::size_t i = 0; i < pairs.bytes().size(); ++i)
    result[i / bytes_in_number] += std::ldexp(pairs.bytes()[i], static_cast<int>(8 * (i % bytes_in_number)));
  return result;
}

/// As many as `like` has, of the same grid.
DirectionPairs pairs_from(Reader& reader, const DirectionPairs& like) {
  std::vector<std::uint8_t> bytes(like.bytes().size());
  for (std::size_t first = 0; first < bytes.size(); first += bytes_in_number) {
    double rest = reader.next("directions", std::ldexp(1.0, 8 * bytes_in_number) - 1);
    for (std::size_t i = first; i < std::min(first + bytes_in_number, bytes.size()); ++i, rest = std::floor(rest / 256))
      bytes[i] = static_cast<std::uint8_t>(std::fmod(rest, 256));
  }
  return DirectionPairs(bytes);
}

}  // namespace

std::vector<double> FitAccumulator::state() const {
  std::vector<double> result = numbers_of(basis_);
  result.insert(result.end(),
                {static_cast<double>(samples_), static_cast<double>(sides_) + (has_turned_rows_ ? turned_rows : 0)});
  for (const auto& [wavelength, at] : wavelengths_) {
    result.push_back(wavelength);
    result.push_back(static_cast<double>(at.measured.size()));
    for (const auto& [elements, where] : at.measured) {
      result.insert(result.end(), {static_cast<double>(elements), where.theta_i_max, where.theta_r_max});
      for (const double number : numbers_of(where.pairs)) result.push_back(number);
    }
    for (std::size_t e = 0; e < 16; ++e) {
      result.push_back(at.weight[e]);
      const std::vector<double> triangle = at.elements[e].state();
      result.insert(result.end(), triangle.begin(), triangle.end());
    }
  }
  return result;
}

FitAccumulator FitAccumulator::from_state(const Basis& basis, std::span<const double> state) {
  constexpr double most = 9e15;  // whole numbers up to here are exact
  FitAccumulator result(basis);
  Reader reader(state);
  const std::vector<double> ours = numbers_of(basis);
  if (!std::ranges::equal(reader.next(ours.size()), ours))
    throw std::invalid_argument("a state of a fit with another basis");
  const double samples = reader.next("a number of samples", most);
  if (samples != std::floor(samples) || (samples == 0) != (state.size() == ours.size() + 2))
    throw std::invalid_argument("a state of a fit with a number of samples " + shortest(samples));
  result.samples_ = static_cast<long>(samples);
  const double sides = reader.next("sides of the plane of incidence", 2 * turned_rows - 1);
  result.has_turned_rows_ = sides >= turned_rows;
  result.sides_ = static_cast<Sides>(sides - (result.has_turned_rows_ ? turned_rows : 0));
  while (!reader.at_end()) {
    const double wavelength = reader.next(1).front();
    require_wavelength(wavelength);
    if (!result.wavelengths_.empty() && wavelength <= result.wavelengths_.rbegin()->first + wavelength_resolution)
      throw std::invalid_argument("a state of a fit whose wavelengths do not rise");
    AtWavelength& at = result.slot(wavelength);
    for (double ways = reader.next("ways of measuring", 65536); ways >= 1; --ways) {
      const auto elements = static_cast<unsigned long>(reader.next("elements", 65535));
      if (!at.measured.empty() && elements <= at.measured.rbegin()->first)
        throw std::invalid_argument("a state of a fit whose elements do not rise");
      const double theta_i = reader.next("a largest theta_i", std::numbers::pi / 2),
                   theta_r = reader.next("a largest theta_r", std::numbers::pi / 2);
      at.measured[elements] = {pairs_from(reader, DirectionPairs(result.grid())), theta_i, theta_r};
    }
    for (std::size_t e = 0; e < 16; ++e) {
      at.weight[e] = reader.next("a sum of weights", std::numeric_limits<double>::max());
      const int unknowns = at.elements[e].unknowns();
      at.elements[e] = LeastSquares::from_state(unknowns, reader.next(LeastSquares::state_size(unknowns)));
    }
  }
  return result;
}

}  // namespace mmbrdf
