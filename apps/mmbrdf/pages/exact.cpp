// SPDX-License-Identifier: BSD-3-Clause
#include "pages/exact.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

// x = m 2^−s with 53 bits of m. Its 17 digits are the integer D next to x 10^k, k = 16 − ⌊log10 x⌋. For k ≤ 38 the
// power fits into 128 bits, so m 10^k is exact in 192, and so are the shift by s and the comparison with one half.

namespace mmbrdf::program {

namespace {

constexpr std::size_t longest = 48;  // sign, 17 digits, point and exponent are 24 at most; write_general needs more

char* written(char* to, double value) {
  return std::to_chars(to, to + longest, value, std::chars_format::general, 17).ptr;
}

#ifdef __SIZEOF_INT128__

__extension__ typedef unsigned __int128 Wide;
using Word = std::uint64_t;

constexpr int digits = 17, powers = 39;
constexpr Word one_digit_more = 100'000'000'000'000'000;  // 10^17

constexpr std::array<Wide, powers> powers_of_ten = [] {
  std::array<Wide, powers> result{1};
  for (std::size_t k = 1; k < powers; ++k) result[k] = 10 * result[k - 1];
  return result;
}();

constexpr std::array<char, 200> pairs_of_digits = [] {
  std::array<char, 200> result{};
  for (std::size_t i = 0; i < 100; ++i) {
    result[2 * i] = static_cast<char>('0' + i / 10);
    result[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return result;
}();

/// m 10^k 2^−s, rounded to nearest, ties to even. 0 < s < 128, and the result has less than 64 bits.
Word scaled(Word m, int k, int s) {
  const Wide power = powers_of_ten[static_cast<std::size_t>(k)];
  const Wide low = Wide{m} * static_cast<Word>(power), high = Wide{m} * static_cast<Word>(power >> 64) + (low >> 64);
  const Word last = static_cast<Word>(low);  // the product is high 2^64 + last
  if (s <= 64) {
    const Wide rest = s == 64 ? Wide{last} : Wide{last} & ((Wide{1} << s) - 1);
    const Word whole = static_cast<Word>(s == 64 ? high : (high << (64 - s)) | (last >> s));
    const Wide half = Wide{1} << (s - 1);
    return whole + (rest > half || (rest == half && whole % 2 == 1) ? 1 : 0);
  }
  const Wide rest = high & ((Wide{1} << (s - 64)) - 1), half = Wide{1} << (s - 65);
  const Word whole = static_cast<Word>(high >> (s - 64));
  const bool above = rest > half || (rest == half && last != 0), tie = rest == half && last == 0;
  return whole + (above || (tie && whole % 2 == 1) ? 1 : 0);
}

/// Eight digits, halved again and again: no division waits for more than two others.
void write_eight(char* to, std::uint32_t number) {
  const std::uint32_t high = number / 10000, low = number % 10000;
  for (const auto& [four, at] : {std::pair(high, 0), {low, 4}}) {
    std::memcpy(to + at, &pairs_of_digits[2 * (four / 100)], 2);
    std::memcpy(to + at + 2, &pairs_of_digits[2 * (four % 100)], 2);
  }
}

void write_digits(char* to, Word number) {
  constexpr Word eight = 100'000'000;
  const Word high = number / eight;
  to[0] = static_cast<char>('0' + high / eight);
  write_eight(to + 1, static_cast<std::uint32_t>(high % eight));
  write_eight(to + 9, static_cast<std::uint32_t>(number % eight));
}

/// d.ddd 10^exponent as %g has it: without zeros at the end, and with an exponent only below 1e-4. Writes beyond the
/// end that it returns.
char* write_general(char* to, const char* d, int exponent) {
  int count = digits;
  while (count > 1 && d[count - 1] == '0') --count;
  if (exponent >= -4 && exponent < 0) {
    std::memcpy(to, "0.0000", 6);
    to += 1 - exponent;
    std::memcpy(to, d, digits);
    return to + count;
  }
  const int before_point = exponent < 0 ? 1 : exponent + 1;
  std::memcpy(to, d, digits);  // zeros at the end of a whole number among them
  to[before_point] = '.';
  std::memcpy(to + before_point + 1, d + before_point, digits - 1);
  to += count > before_point ? count + 1 : before_point;
  if (exponent < 0) {
    *to++ = 'e';
    *to++ = '-';
    std::memcpy(to, &pairs_of_digits[static_cast<std::size_t>(-2 * exponent)], 2);
    to += 2;
  }
  return to;
}

char* write(char* to, double value) {
  constexpr double smallest = 1.1e-22, end = 4503599627370496.0;  // 2^52
  const double x = std::abs(value);
  if (!(x >= smallest && x < end)) return written(to, value);
  const auto bits = std::bit_cast<Word>(x);
  const int power = static_cast<int>(bits >> 52) - 1023;  // 2^power ≤ x < 2^(power + 1)
  const Word m = (bits & ((Word{1} << 52) - 1)) | (Word{1} << 52);
  // The exponent, or sometimes one less, as log2(1 + f) is f to f + 0.09. Truncated from above 0, and 1e-12 for
  // rounding.
  const double log2 = power + (static_cast<double>(m) * 0x1p-52 - 1);
  int exponent = static_cast<int>(log2 * 0.30102999566398120 + (100 - 1e-12)) - 100;
  Word number = scaled(m, digits - 1 - exponent, 52 - power);
  if (number >= one_digit_more) {
    ++exponent;
    number = scaled(m, digits - 1 - exponent, 52 - power);
  }
  std::array<char, 2 * digits> d;  // write_general reads behind the digits
  write_digits(d.data(), number);
  *to = '-';
  return write_general(to + (value < 0 ? 1 : 0), d.data(), exponent);
}

#else

char* write(char* to, double value) { return written(to, value); }

#endif

}  // namespace

void append_exact(std::string& text, double value) {
  std::array<char, longest> buffer;
  text.append(buffer.data(), write(buffer.data(), value));
}

}  // namespace mmbrdf::program
