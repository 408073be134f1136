// SPDX-License-Identifier: BSD-3-Clause
// Work on several threads is done as a whole, whatever becomes of the threads.
#include "numerics/threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

using namespace mmbrdf;

namespace {

/// How many allocations of this thread still find memory; the next one finds none, and those after it do again. −1: all do.
thread_local int allocations_left = -1;

bool each_is_done_once(const std::vector<std::atomic<int>>& done) {
  return std::all_of(done.begin(), done.end(), [](const std::atomic<int>& times) { return times == 1; });
}

}  // namespace

// Of this program alone: the only way to be without memory just where a thread is started. Inlined, g++ 12 warns of them.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (allocations_left >= 0 && allocations_left-- == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST(Parts, ThatFindNoMemoryForTheirThreadAreDoneByThoseThatThereAre) {
  int failed = 0;
  for (int left = 0; left < 12; ++left) {
    std::vector<std::atomic<int>> done(5 * smallest_part + 17);
    allocations_left = left;
    in_parts(done.size(), 4, [&](std::size_t first, std::size_t count) {
      for (std::size_t i = first; i < first + count; ++i) ++done[i];
    });
    failed += allocations_left < 0;
    allocations_left = -1;
    EXPECT_TRUE(each_is_done_once(done)) << "after " << left << " allocations";
  }
  EXPECT_GE(failed, 4);  // three threads, and room for them
}

TEST(WorkInAnyOrder, IsDoneByThoseThatThereAreWhereNoMemoryIsFoundForAThread) {
  for (int left = 0; left < 12; ++left) {
    std::vector<std::atomic<int>> done(50);
    allocations_left = left;
    in_any_order(
        done.size(), [&](std::size_t i) { ++done[i]; }, 4);
    allocations_left = -1;
    EXPECT_TRUE(each_is_done_once(done)) << "after " << left << " allocations";
  }
}

TEST(Parts, AreAllDoneOnceOnAnyNumberOfThreads) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, smallest_part - 1, 2 * smallest_part, 9 * smallest_part + 5})
    for (const int threads : {0, 1, 2, 7}) {
      std::vector<std::atomic<int>> done(count);
      in_parts(count, threads, [&](std::size_t first, std::size_t part) {
        for (std::size_t i = first; i < first + part; ++i) ++done[i];
      });
      EXPECT_TRUE(each_is_done_once(done)) << count << " on " << threads;
    }
  EXPECT_THROW(in_parts(1, -1, [](std::size_t, std::size_t) {}), std::invalid_argument);
}

TEST(WorkInAnyOrder, IsDoneOnceOrThrowsWhatOneThrew) {
  for (const int threads : {0, 1, 3}) {
    std::vector<std::atomic<int>> done(100);
    in_any_order(
        done.size(), [&](std::size_t i) { ++done[i]; }, threads);
    EXPECT_TRUE(each_is_done_once(done));
    EXPECT_THROW(in_any_order(
                     done.size(),
                     [](std::size_t i) {
                       if (i == 41) throw std::out_of_range("41");
                     },
                     threads),
                 std::out_of_range);
  }
}

TEST(FirstFound, IsTheFirstOfAllPartsAndTheEndWhereThereIsNone) {
  const std::size_t count = 6 * smallest_part;
  for (const std::size_t wanted : {std::size_t{0}, smallest_part + 3, count - 1, count}) {
    const auto find = [&](std::size_t first, std::size_t part) {
      std::size_t at = first;
      while (at < first + part && at < wanted) ++at;
      return at;
    };
    EXPECT_EQ(first_found(count, 4, find), wanted);
  }
}
