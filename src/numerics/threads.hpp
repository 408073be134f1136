// SPDX-License-Identifier: BSD-3-Clause
/// A range of work in parts, one on each thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace mmbrdf {

/// Starting a thread takes as long as some thousand matrices: fewer are not worth one.
inline constexpr std::size_t smallest_part = 4096;

/// Starts one more thread; false where no more can be had, or no memory for one: whoever asks then works alone.
template <class Work>
bool started(std::vector<std::jthread>& threads, Work work) {
  try {
    threads.emplace_back(std::move(work));
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

/// Calls part(first, count) for consecutive parts of a range, the first of them on this thread. part must not throw.
/// threads 0: as many as there are cores. Throws std::invalid_argument for negative numbers of threads.
template <class Part>
void in_parts(std::size_t count, int threads, Part part) {
  if (threads < 0) throw std::invalid_argument("threads = " + std::to_string(threads) + ", must be 0 or more");
  const unsigned wanted = threads == 0 ? std::thread::hardware_concurrency() : static_cast<unsigned>(threads);
  const std::size_t parts = std::clamp<std::size_t>(count / smallest_part, 1, std::max(1u, wanted));
  const std::size_t each = (count / parts + 63) / 64 * 64;  // no two threads write to one cache line
  std::vector<std::jthread> others;
  std::size_t first = each;
  while (first < count && started(others, [=] { part(first, std::min(each, count - first)); })) first += each;
  part(std::size_t{0}, std::min(each, count));
  if (first < count) part(first, count - first);
}

/// The first index at which a part finds something: find(first, count) returns it, or first + count.
template <class Find>
std::size_t first_found(std::size_t count, int threads, Find find) {
  std::atomic<std::size_t> found = count;
  in_parts(count, threads, [&](std::size_t first, std::size_t part) {
    const std::size_t at = find(first, part);
    if (at == first + part) return;
    for (std::size_t before = found; at < before && !found.compare_exchange_weak(before, at);) continue;
  });
  return found;
}

/// Calls work(i) for each i below count, in any order; throws the first of what they throw, and then begins no other.
/// threads as for in_parts().
template <class Work>
void in_any_order(std::size_t count, Work work, int threads = 0) {
  if (threads < 0) throw std::invalid_argument("threads = " + std::to_string(threads) + ", must be 0 or more");
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex guard;
  const auto some = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        const std::scoped_lock lock(guard);
        if (!thrown) thrown = std::current_exception();
        next = count;
      }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t most = threads == 0 ? std::thread::hardware_concurrency() : static_cast<std::size_t>(threads);
    for (std::size_t t = 1; t < std::min(count, most) && started(others, some);) ++t;
    some();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace mmbrdf
