// SPDX-License-Identifier: BSD-3-Clause
#include "fitting/state_reader.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "text/numbers.hpp"

namespace mmbrdf {

std::span<const double> StateReader::next(std::size_t count) {
  if (count > rest_.size()) throw std::invalid_argument("a state of a fit that ends too soon");
  const std::span<const double> result = rest_.first(count);
  rest_ = rest_.subspan(count);
  return result;
}

double StateReader::next(const char* what, double highest) {
  const double number = next(1).front();
  if (!(number >= 0 && number <= highest))
    throw std::invalid_argument("a state of a fit with " + std::string(what) + " " + shortest(number));
  return number;
}

long StateReader::whole(const char* what, double highest) {
  const double number = next(what, highest);
  if (number != std::floor(number))
    throw std::invalid_argument("a state of a fit with " + std::string(what) + " " + shortest(number));
  return static_cast<long>(number);
}

std::vector<double> numbers_of(const Basis& basis) {
  return {static_cast<double>(basis.family), static_cast<double>(basis.orders.f11),
          static_cast<double>(basis.orders.other), static_cast<double>(basis.mapping),
          static_cast<double>(basis.rotation)};
}

void require_next(StateReader& reader, const Basis& basis) {
  const std::vector<double> ours = numbers_of(basis);
  if (!std::ranges::equal(reader.next(ours.size()), ours))
    throw std::invalid_argument("a state of a fit with another basis");
}

}  // namespace mmbrdf
