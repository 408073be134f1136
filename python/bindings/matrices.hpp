// SPDX-License-Identifier: BSD-3-Clause
// Functions of arrays of Mueller matrices, (..., 4, 4), and what becomes of matrices that they refuse.
#pragma once

#include <atomic>
#include <limits>
#include <span>
#include <string>
#include <type_traits>

#include "arrays.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"

namespace mmbrdf::python {

/// Of the argument `invalid`: "raise" or "nan". Throws std::invalid_argument for another.
inline Refused refused_from(const std::string& invalid) {
  if (invalid == "raise") return Refused::error;
  if (invalid == "nan") return Refused::nan;
  throw std::invalid_argument("invalid = '" + invalid + "', must be 'raise' or 'nan'");
}
inline constexpr const char* invalid_doc =
    "\ninvalid='nan' makes NaN of what has no answer (False where the answer is a truth value), instead of an error.";

/// The answer for what has none.
template <class Result>
Result no_answer() {
  using Number = typename Layout<Result>::Scalar;
  Result result{};
  if constexpr (std::is_same_v<Result, Mueller>)
    result.elements.fill(std::numeric_limits<double>::quiet_NaN());
  else if constexpr (!std::is_same_v<Result, Number>)
    result.fill(std::numeric_limits<double>::quiet_NaN());
  else if constexpr (!std::is_same_v<Result, bool>)
    result = std::numeric_limits<double>::quiet_NaN();
  return result;
}

/// f(position) at each position, or no answer where that is refused.
template <class F>
py::object map(const Broadcast& broadcast, Refused refused, F f) {
  using Result = std::invoke_result_t<F, std::size_t>;
  if (refused == Refused::error) return map(broadcast, f);
  return map(broadcast, [&](std::size_t i) -> Result {
    try {
      return f(i);
    } catch (const std::invalid_argument&) {
      return no_answer<Result>();
    }
  });
}

/// one(Mueller) for an array of matrices.
template <class F>
py::object over_matrices(const Given& mueller, Refused refused, F one) {
  const Broadcast broadcast({{"mueller", mueller, {4, 4}}});
  return map(broadcast, refused, [&](std::size_t i) { return one(broadcast.mueller(0, i)); });
}

/// The same with what analysis_batch.hpp has, in blocks that stay in the cache. `core` is the shape of a result, of as
/// many numbers as Result has.
template <class Result>
using Many = std::size_t (*)(std::span<const Mueller>, std::span<Result>, const MatricesOptions&);
template <class Result, class One>
py::object over_matrices(const Given& mueller, Refused refused, One one, Many<Result> many,
                         const std::vector<py::ssize_t>& core) {
  using Number = std::conditional_t<std::is_same_v<Result, bool>, bool, double>;
  static_assert(sizeof(Result) % sizeof(Number) == 0);
  const Broadcast broadcast({{"mueller", mueller, {4, 4}}});
  auto result = new_array<Number>(broadcast, core);
  auto* const out = reinterpret_cast<Result*>(result.mutable_data());
  std::atomic<std::size_t> count = 0;
  without_gil([&] {
    in_parts(broadcast.size(), 0, 8192, [&](std::size_t begin, std::size_t end) {
      constexpr std::size_t block = 256;
      std::array<Mueller, block> matrices;
      for (std::size_t first = begin; first < end; first += block) {
        const std::size_t here = std::min(block, end - first);
        broadcast.gather(0, first, first + here, matrices[0].elements.data());
        count += many(std::span(matrices).first(here), {out + first, here}, {.refused = Refused::nan});
      }
    });
    for (std::size_t i = 0; count > 0 && refused == Refused::error && i < broadcast.size(); ++i) {
      try {
        one(broadcast.mueller(0, i));
      } catch (const std::invalid_argument& error) {
        const std::string others = count == 1 ? "" : "; " + std::to_string(count) + " matrices have no answer";
        throw std::invalid_argument(broadcast.at_place(error, i).what() + others);
      }
    }
  });
  return unwrapped(result);
}

}  // namespace mmbrdf::python
