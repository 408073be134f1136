// SPDX-License-Identifier: BSD-3-Clause
#include "streams/progress.hpp"

#include <unistd.h>

#include <atomic>
#include <iostream>
#include <string_view>

namespace mmbrdf::program {

namespace {

std::atomic<bool> line_is_there = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { end_progress(); }

void Progress::add(long rows) {
  rows_ += rows;
  if (terminal_ && Clock::now() - shown_ > std::chrono::milliseconds(250)) {
    shown_ = Clock::now();
    line_is_there = true;
    std::cerr << "\rmmbrdf: " << rows_ << " rows" << std::flush;
  }
}

void end_progress() noexcept {
  constexpr std::string_view blank = "\r\033[K";
  if (line_is_there.exchange(false) && ::write(STDERR_FILENO, blank.data(), blank.size()) < 0) return;
}

}  // namespace mmbrdf::program
