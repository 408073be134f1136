// SPDX-License-Identifier: BSD-3-Clause
// All there is in an accumulator as numbers, to be saved or sent.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "fitting/state_reader.hpp"
#include "text/numbers.hpp"

//   the basis: family, both orders, mapping, rotation
//   samples, sides (8 more with rows that are turned),   then for each wavelength, rising: λ, in how many ways it was measured,
//   for each: the bits of the elements, rising, largest θi, largest θr, the bits of the directions, six bytes in a number,
//   then for each element, row-major: the sum of its weights, and the state of its triangle

namespace mmbrdf {
namespace {

constexpr double turned_rows = 8;  // added to the sides, which are up to 7

constexpr std::size_t bytes_in_number = 6;  // whole numbers below 2⁴⁸ are exact

std::vector<double> numbers_of(const DirectionPairs& pairs) {
  std::vector<double> result((pairs.bytes().size() + bytes_in_number - 1) / bytes_in_number);
  for (std::size_t i = 0; i < pairs.bytes().size(); ++i)
    result[i / bytes_in_number] += std::ldexp(pairs.bytes()[i], static_cast<int>(8 * (i % bytes_in_number)));
  return result;
}

/// As many as `like` has, of the same grid.
DirectionPairs pairs_from(StateReader& reader, const DirectionPairs& like) {
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
  FitAccumulator result(basis);
  StateReader reader(state);
  require_next(reader, basis);
  result.samples_ = reader.whole("a number of samples");
  const double sides = reader.next("sides of the plane of incidence", 2 * turned_rows - 1);
  if ((result.samples_ == 0) != reader.at_end())
    throw std::invalid_argument("a state of a fit with a number of samples " + std::to_string(result.samples_));
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
