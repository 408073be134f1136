// SPDX-License-Identifier: BSD-3-Clause
/// What C++20 has and the standard library of emscripten 3.1.6 has not, as far as this library uses it. Included before
/// every source that emscripten compiles, and by nothing else: no source knows of it, and with a complete standard
/// library this file goes away. Names are added to namespace std where a later standard library has them.
#pragma once

#include <algorithm>
#include <bit>
#include <charconv>
#include <functional>
#include <iterator>
#include <system_error>
#include <thread>
#include <utility>

namespace std {

// ---- <bit>, <thread> ------------------------------------------------------------------------------------------------

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// There are no threads here: starting one fails as it does where no more can be had.
class jthread {
 public:
  template <class Work>
  explicit jthread(Work&&) {
    throw system_error(make_error_code(errc::resource_unavailable_try_again));
  }
};

// ---- <charconv>: of double, independent of a locale -----------------------------------------------------------------

from_chars_result from_chars(const char* first, const char* last, double& value);
to_chars_result to_chars(char* first, char* last, double value);
to_chars_result to_chars(char* first, char* last, double value, chars_format format);
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);

// ---- <algorithm>: of ranges -----------------------------------------------------------------------------------------

namespace ranges {

template <class Range, class Is, class Projection = identity>
constexpr auto find_if(Range&& range, Is is, Projection of = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& x) { return std::invoke(is, std::invoke(of, x)); });
}
template <class Range, class Is, class Projection = identity>
constexpr auto find_if_not(Range&& range, Is is, Projection of = {}) {
  return ranges::find_if(
      range, [&](auto&& x) { return !std::invoke(is, x); }, of);
}
template <class Range, class T, class Projection = identity>
constexpr auto find(Range&& range, const T& value, Projection of = {}) {
  return ranges::find_if(
      range, [&](auto&& x) { return x == value; }, of);
}
template <class Range, class Is, class Projection = identity>
constexpr bool any_of(Range&& range, Is is, Projection of = {}) {
  return ranges::find_if(range, is, of) != std::end(range);
}
template <class Range, class Is, class Projection = identity>
constexpr bool none_of(Range&& range, Is is, Projection of = {}) {
  return !ranges::any_of(range, is, of);
}
template <class Range, class Is, class Projection = identity>
constexpr bool all_of(Range&& range, Is is, Projection of = {}) {
  return ranges::none_of(
      range, [&](auto&& x) { return !std::invoke(is, x); }, of);
}
template <class Range, class Is>
constexpr auto count_if(Range&& range, Is is) {
  return std::count_if(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(is, x); });
}
template <class Range, class T>
constexpr auto count(Range&& range, const T& value) {
  return std::count(std::begin(range), std::end(range), value);
}
template <class Range, class Do>
constexpr void for_each(Range&& range, Do what) {
  std::for_each(std::begin(range), std::end(range), what);
}
template <class A, class B, class Same = std::equal_to<>>
constexpr bool equal(const A& a, const B& b, Same same = {}) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), same);
}

template <class Range, class Less = std::less<>, class Projection = identity>
constexpr auto min_element(Range&& range, Less less = {}, Projection of = {}) {
  return std::min_element(std::begin(range), std::end(range),
                          [&](auto&& a, auto&& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class Range, class Less = std::less<>, class Projection = identity>
constexpr auto max_element(Range&& range, Less less = {}, Projection of = {}) {
  return std::max_element(std::begin(range), std::end(range),
                          [&](auto&& a, auto&& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class Range, class T, class Less = std::less<>, class Projection = identity>
constexpr auto lower_bound(Range&& range, const T& value, Less less = {}, Projection of = {}) {
  return std::lower_bound(std::begin(range), std::end(range), value,
                          [&](auto&& x, const T& v) { return less(std::invoke(of, x), v); });
}
template <class Range, class Is, class Projection = identity>
constexpr auto partition_point(Range&& range, Is is, Projection of = {}) {
  return std::partition_point(std::begin(range), std::end(range),
                              [&](auto&& x) { return std::invoke(is, std::invoke(of, x)); });
}
template <class Range, class Same = std::equal_to<>, class Projection = identity>
constexpr auto adjacent_find(Range&& range, Same same = {}, Projection of = {}) {
  return std::adjacent_find(std::begin(range), std::end(range), [&](auto&& a, auto&& b) {
    return std::invoke(same, std::invoke(of, a), std::invoke(of, b));
  });
}
template <class Range, class Less = std::less<>, class Projection = identity>
constexpr void sort(Range&& range, Less less = {}, Projection of = {}) {
  std::sort(std::begin(range), std::end(range),
            [&](auto&& a, auto&& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}
template <class Range, class Less = std::less<>, class Projection = identity>
void stable_sort(Range&& range, Less less = {}, Projection of = {}) {
  std::stable_sort(std::begin(range), std::end(range),
                   [&](auto&& a, auto&& b) { return less(std::invoke(of, a), std::invoke(of, b)); });
}

template <class Range, class Iterator>
constexpr void nth_element(Range&& range, Iterator nth) {
  std::nth_element(std::begin(range), nth, std::end(range));
}
template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}
template <class Range, class T>
constexpr void fill(Range&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Old, class New>
constexpr void replace(Range&& range, const Old& old_value, const New& new_value) {
  for (auto& x : range)
    if (x == old_value) x = new_value;
}
template <class Range, class Out>
constexpr void copy(Range&& range, Out out) {
  std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class Out, class Is>
constexpr void copy_if(Range&& range, Out out, Is is) {
  std::copy_if(std::begin(range), std::end(range), out, is);
}
template <class Range, class Out>
constexpr void move(Range&& range, Out out) {
  std::move(std::begin(range), std::end(range), out);
}
template <class Range, class Out, class Function>
constexpr void transform(Range&& range, Out out, Function function) {
  std::transform(std::begin(range), std::end(range), out, [&](auto&& x) { return std::invoke(function, x); });
}
template <class A, class B, class Out, class Function>
  requires requires(const B& b) { std::begin(b); }
constexpr void transform(A&& a, B&& b, Out out, Function function) {
  std::transform(std::begin(a), std::end(a), std::begin(b), out, function);
}

}  // namespace ranges
}  // namespace std
