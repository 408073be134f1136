// SPDX-License-Identifier: BSD-3-Clause
// Input that may keep its reader waiting: pipes, terminals, standard input.
#pragma once

#include <array>
#include <atomic>
#include <streambuf>
#include <string>

namespace mmbrdf::program {

/// Whether a read of this path may have to wait for somebody who writes. "-" is standard input.
bool may_wait(const std::string& path);

/// Reads a descriptor of the system, until told not to. In a stream, an error of reading is badbit.
class WaitingInput : public std::streambuf {
 public:
  /// Throws std::runtime_error, naming the path, if it cannot be opened.
  explicit WaitingInput(const std::string& path);
  ~WaitingInput() override;
  WaitingInput(const WaitingInput&) = delete;
  WaitingInput& operator=(const WaitingInput&) = delete;

  /// From now on the input is at its end, also for a thread that waits for more. From any thread.
  void end() { ended_ = true; }

 protected:
  int_type underflow() override;

 private:
  int number_;
  std::atomic<bool> ended_ = false;
  std::array<char, 1 << 16> buffer_;
};

}  // namespace mmbrdf::program
