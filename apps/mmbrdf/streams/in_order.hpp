// SPDX-License-Identifier: BSD-3-Clause
// Reading, computing and writing at the same time, in the order of the input.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace mmbrdf::program {

/// What happens to each piece of a stream.
template <class Piece>
struct Stages {
  std::function<bool(Piece&)> read;                     ///< false at the end. One at a time, in order
  std::function<std::function<void(Piece&)>()> worker;  ///< computes; one for each thread, any number at a time
  std::function<bool(Piece&)> write;     ///< false if no more can be written. One at a time, in the order of reading
  std::function<void()> end_input = {};  ///< if there is any: makes a read that waits return. From any thread
};

namespace in_order {

template <class Piece>
class Line {
 public:
  Line(const Stages<Piece>& stages, int threads) : stages_(stages), more_threads_(std::max(threads, 1) - 1) {
    others_.reserve(static_cast<std::size_t>(more_threads_));
  }

  /// Until the end, also of the other threads.
  void run() {
    work();
    std::vector<std::jthread> others;
    const std::lock_guard lock(reading_);  // who has it from now on starts no more threads
    others.swap(others_);
  }

  void throw_error() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void work() {
    std::function<void(Piece&)> compute;
    while (!stopped_) {
      Piece piece;
      std::exception_ptr error;
      bool there = false;
      const long number = next(piece, there, error);
      try {
        if (there && !stopped_) {
          if (!compute) compute = stages_.worker();
          compute(piece);
        }
      } catch (...) {
        error = std::current_exception();
      }
      finish(number, piece, there, error);
    }
  }

  long next(Piece& piece, bool& there, std::exception_ptr& error) {
    const std::lock_guard lock(reading_);
    try {
      there = !stopped_ && stages_.read(piece);
    } catch (...) {
      error = std::current_exception();
    }
    if (there && more_threads_ > 0 && !stopped_) add_thread();
    return next_++;
  }

  /// For the next piece, so that there are no more threads than pieces but one.
  void add_thread() {
    try {
      others_.emplace_back([this] { work(); });
      --more_threads_;
    } catch (const std::exception&) {  // no more to be had, or no memory for one: those that there are do the work
      more_threads_ = 0;
    }
  }

  /// What went wrong with a piece counts only if nothing did before it.
  void finish(long number, Piece& piece, bool there, const std::exception_ptr& error) {
    std::unique_lock lock(writing_);
    turn_.wait(lock, [&] { return stopped_ || written_ == number; });
    if (stopped_) return;
    try {
      if (error) std::rethrow_exception(error);
      stopped_ = !there || !stages_.write(piece);
    } catch (...) {
      error_ = std::current_exception();
      stopped_ = true;
    }
    ++written_;
    turn_.notify_all();
    if (stopped_ && stages_.end_input) stages_.end_input();
  }

  const Stages<Piece>& stages_;
  std::mutex reading_, writing_;
  std::condition_variable turn_;
  int more_threads_;  // that may be started
  std::vector<std::jthread> others_;
  long next_ = 0, written_ = 0;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr error_;
};

}  // namespace in_order

/// Runs the stages in at most so many threads, each of which holds one piece. Throws what a stage throws, the first in
/// the order of the input; what was read before that is written.
template <class Piece>
void run_in_order(const Stages<Piece>& stages, int threads) {
  in_order::Line<Piece> line(stages, threads);
  line.run();
  line.throw_error();
}

}  // namespace mmbrdf::program
