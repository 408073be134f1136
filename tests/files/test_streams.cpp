// SPDX-License-Identifier: BSD-3-Clause
// What the program's streams are made of: digits, and pieces that are worked on by many threads.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <atomic>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "pages/exact.hpp"
#include "streams/in_order.hpp"

namespace {

thread_local bool memory_is_out = false;  // for the next allocation

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  if (!std::exchange(memory_is_out, false))
    if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace mmbrdf::program {
namespace {

std::string found(double value) {
  std::string text;
  append_exact(text, value);
  return text;
}

std::string expected(double value) {
  std::array<char, 32> text;
  return {text.begin(), std::to_chars(text.begin(), text.end(), value, std::chars_format::general, 17).ptr};
}

// Of all numbers that there are, and of those that matrices have.
RC_GTEST_PROP(Digits, AreThoseOfTheStandardLibrary, (std::uint64_t bits, std::uint32_t fraction)) {
  const auto any = std::bit_cast<double>(bits);
  if (!std::isnan(any)) RC_ASSERT(found(any) == expected(any));
  const double exponent = *rc::gen::inRange(-24, 18);
  const double value = (fraction - 2147483648.0 + 1 / 3.0) / 2147483648.0 * std::pow(10, exponent);
  RC_ASSERT(found(value) == expected(value));
}

TEST(Digits, AreThoseOfTheStandardLibraryNextToPowersOfTenAndOfTwo) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int k = -25; k < 20; ++k)
    for (const double towards : {0.0, infinity}) {
      double value = std::pow(10, k);
      for (int step = 0; step < 40; ++step, value = std::nextafter(value, towards))
        for (const double x : {value, -value}) EXPECT_EQ(found(x), expected(x));
    }
  // Few bits: ties between two numbers of 17 digits.
  for (int k = -80; k < 60; ++k)
    for (int odd = 1; odd < 200; odd += 2) EXPECT_EQ(found(std::ldexp(odd, k)), expected(std::ldexp(odd, k)));
}

TEST(Digits, OfNumbersThatAreNoneOrNothingAreThoseOfTheStandardLibrary) {
  for (const double value : {0.0, -0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::min(),
                             std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()})
    EXPECT_EQ(found(value), expected(value));
}

/// A stream of the numbers below `count`, each of which becomes its square; what is written is the list of them.
struct Squares {
  int count = 100, read = 0;
  std::string written{};
  int refused = -1, broken = -1, full = 1000000,
      no_memory = 1000000;  // a number that cannot be read, computed, written; or
                            // behind which no thread can be started

  void run(int threads) {
    run_in_order<int>({.read =
                           [this](int& number) {
                             if (read == refused) throw std::runtime_error("read");
                             number = read++;
                             memory_is_out = read == no_memory;
                             return number < count;
                           },
                       .worker =
                           [this] {
                             return [this](int& number) {
                               for (int i = 0; i < number % 7; ++i) std::this_thread::yield();
                               if (number == broken) throw std::runtime_error("compute " + std::to_string(number));
                               number *= number;
                             };
                           },
                       .write =
                           [this](int& number) {
                             if (number >= full) return false;
                             written += std::to_string(number) + " ";
                             return true;
                           }},
                      threads);
  }

  static std::string list(int end) {
    std::string text;
    for (int i = 0; i < end; ++i) text += std::to_string(i * i) + " ";
    return text;
  }
};

TEST(Pieces, AreWrittenInTheOrderInWhichTheyWereReadByAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 8})
    for (const int count : {0, 1, 2, 500}) {
      Squares squares{.count = count};
      squares.run(threads);
      EXPECT_EQ(squares.written, Squares::list(count)) << threads;
    }
}

TEST(Pieces, BeforeTheFirstErrorAreWrittenAndThatErrorIsThrown) {
  for (const int threads : {1, 2, 8}) {
    Squares in_the_middle{.refused = 60, .broken = 40}, at_the_end{.refused = 40, .broken = 60};
    EXPECT_THROW(
        {
          try {
            in_the_middle.run(threads);
          } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "compute 40");
            throw;
          }
        },
        std::runtime_error);
    EXPECT_EQ(in_the_middle.written, Squares::list(40));
    EXPECT_THROW(at_the_end.run(threads), std::runtime_error);
    EXPECT_EQ(at_the_end.written, Squares::list(40));
  }
}

TEST(Pieces, ThatDoNotComeAreNotWaitedForAfterAnError) {
  for (const int threads : {1, 2, 8}) {
    std::atomic<bool> ended = false;
    int next = 0;
    const Stages<int> stages{.read =
                                 [&](int& number) {
                                   number = next++;
                                   if (number == 4) ended.wait(false);
                                   return number < 4;
                                 },
                             .worker =
                                 [] {
                                   return [](int& number) {
                                     if (number == 3) throw std::runtime_error("compute 3");
                                   };
                                 },
                             .write = [](int&) { return true; },
                             .end_input =
                                 [&] {
                                   ended = true;
                                   ended.notify_all();
                                 }};
    EXPECT_THROW(run_in_order(stages, threads), std::runtime_error);
  }
}

TEST(Pieces, AreNotWorkedOnByMoreThreadsThanThereArePiecesButOne) {
  std::mutex mutex;
  std::set<std::thread::id> readers;
  int read = 0;
  run_in_order<int>({.read =
                         [&](int&) {
                           const std::lock_guard lock(mutex);
                           readers.insert(std::this_thread::get_id());
                           return ++read <= 3;
                         },
                     .worker = [] { return [](int&) {}; },
                     .write = [](int&) { return true; }},
                    1000);
  EXPECT_LE(readers.size(), 4);
}

TEST(Pieces, AreWorkedOnByTheThreadsThatThereAreIfThereIsNoMemoryForMore) {
  for (const int first : {1, 2, 3}) {
    Squares squares{.no_memory = first};
    squares.run(8);
    EXPECT_EQ(squares.written, Squares::list(100));
  }
}

TEST(Pieces, EndWhereNoMoreCanBeWritten) {
  for (const int threads : {1, 2, 8}) {
    Squares squares{.full = 30 * 30};
    squares.run(threads);
    EXPECT_EQ(squares.written, Squares::list(30));
    EXPECT_LE(squares.read, 30 + 2 * threads);
  }
}

}  // namespace
}  // namespace mmbrdf::program
