// SPDX-License-Identifier: BSD-3-Clause
// Rows counted on a terminal while they are written.
#pragma once

#include <chrono>

namespace mmbrdf::program {

/// Counts rows on standard error, if that is a terminal. The line is gone at the end, whatever ends it.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(long rows);

 private:
  using Clock = std::chrono::steady_clock;
  const bool terminal_;
  Clock::time_point shown_ = Clock::now();
  long rows_ = 0;
};

/// Removes the line, if there is one. Safe in a handler of a signal.
void end_progress() noexcept;

}  // namespace mmbrdf::program
