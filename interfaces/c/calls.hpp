// SPDX-License-Identifier: BSD-3-Clause
// What each call from C goes through: pointers become spans, numbers enumerators, exceptions codes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mmbrdf.h"
#include "mmbrdf/geometry/geometry.hpp"
#include "mmbrdf/polarization/mueller.hpp"
#include "mmbrdf/text/printable.hpp"
#include "numerics/threads.hpp"

namespace mmbrdf::c {

// Numbers of a caller are read as these where they stand.
static_assert(sizeof(Geometry) == 4 * sizeof(double) && sizeof(Direction) == 2 * sizeof(double) &&
              sizeof(Mueller) == 16 * sizeof(double));

inline int failed(mmbrdf_error* error, int code, std::string_view message) {
  if (error) {
    error->code = code;
    const std::string line = printable(message, sizeof error->message - sizeof "...");
    *std::copy(line.begin(), line.end(), error->message) = 0;
  }
  return code;
}

/// The one place where exceptions become codes. Of the text of an error no more is kept than there is memory for.
template <class Work>
int guarded(mmbrdf_error* error, Work work) noexcept {
  const auto told = [&](int code, const char* message) noexcept {
    try {
      return failed(error, code, message);
    } catch (...) {
      if (error) *error = {MMBRDF_OUT_OF_MEMORY, "out of memory"};
      return static_cast<int>(MMBRDF_OUT_OF_MEMORY);
    }
  };
  try {
    work();
    if (error) *error = {};
    return MMBRDF_OK;
  } catch (const std::invalid_argument& wrong) {
    return told(MMBRDF_INVALID_ARGUMENT, wrong.what());
  } catch (const std::runtime_error& wrong) {
    return told(MMBRDF_FAILED, wrong.what());
  } catch (const std::bad_alloc&) {
    return told(MMBRDF_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error&) {
    return told(MMBRDF_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& wrong) {
    return told(MMBRDF_INTERNAL, wrong.what());
  } catch (...) {
    return told(MMBRDF_INTERNAL, "unknown error");
  }
}

template <class T>
T& required(T* pointer, const char* name) {
  if (!pointer) throw std::invalid_argument(std::string(name) + " is null");
  return *pointer;
}

/// n things of `each` numbers, read as T where they stand.
template <class T, class Number>
std::span<T> list(Number* numbers, const char* name, int64_t n) {
  constexpr int64_t most = std::numeric_limits<std::ptrdiff_t>::max() / static_cast<int64_t>(sizeof(Mueller));
  if (n < 0 || n > most)
    throw std::invalid_argument("n = " + std::to_string(n) + ", must be from 0 to " + std::to_string(most));
  if (n > 0) required(numbers, name);
  return {reinterpret_cast<T*>(numbers), static_cast<std::size_t>(n)};
}

/// work(first, count) for pieces of a range on several threads; throws the first of what they throw.
template <class Work>
void in_pieces(std::size_t count, int threads, Work work) {
  std::exception_ptr thrown;
  std::mutex guard;
  in_parts(count, threads, [&](std::size_t first, std::size_t part) {
    try {
      work(first, part);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!thrown) thrown = std::current_exception();
    }
  });
  if (thrown) std::rethrow_exception(thrown);
}

/// The same for geometries, a few at a time that stay in the cache; of invalid ones the error names the first.
template <class Work>
void for_geometries(std::span<const Geometry> geometries, int threads, Work work) {
  constexpr std::size_t most = 512;
  try {
    in_pieces(geometries.size(), threads, [&](std::size_t first, std::size_t count) {
      for (const std::size_t end = first + count; first < end; first += most)
        work(first, geometries.subspan(first, std::min(most, end - first)));
    });
  } catch (const std::invalid_argument&) {
    for (std::size_t q = 0; q < geometries.size(); ++q)
      require_valid(geometries[q], ("geometry " + std::to_string(q + 1)).c_str());
    throw;
  }
}

/// A layout, checked.
struct Layout {
  Frame frame;
  StokesConvention convention;
  bool column_major;
  Mueller signs;  ///< of the elements, relative to the project's convention

  explicit Layout(const mmbrdf_layout* given) {
    const mmbrdf_layout asked = given ? *given : mmbrdf_layout{MMBRDF_XY, MMBRDF_GERMER2017, MMBRDF_ROW_MAJOR};
    require("frame", asked.frame, MMBRDF_SCATTERING_PLANE);
    require("convention", asked.convention, MMBRDF_P_FIRST_LEFT_HANDED_AXES_RIGHT);
    require("order", asked.order, MMBRDF_COLUMN_MAJOR);
    frame = static_cast<Frame>(asked.frame);
    convention = static_cast<StokesConvention>(asked.convention);
    column_major = asked.order == MMBRDF_COLUMN_MAJOR;
    signs.elements.fill(1);
    signs = convert(signs, StokesConvention::germer2017, convention);
  }

  static void require(const char* what, int value, int most) {
    if (value < 0 || value > most)
      throw std::invalid_argument(std::string(what) + " = " + std::to_string(value) + ", must be from 0 to " +
                                  std::to_string(most));
  }

  void apply(std::span<Mueller> matrices, bool with_signs) const {
    if (with_signs && convention != StokesConvention::germer2017) {
      const Mueller factors = signs;  // which no matrix is, so that they stay in registers
      for (Mueller& m : matrices)
        for (std::size_t e = 0; e < 16; ++e) m.elements[e] *= factors.elements[e];
    }
    if (column_major)
      for (Mueller& m : matrices) {
        const Mueller row_major = m;
        for (std::size_t e = 0; e < 16; ++e) m.elements[4 * (e % 4) + e / 4] = row_major.elements[e];
      }
  }
};

}  // namespace mmbrdf::c
