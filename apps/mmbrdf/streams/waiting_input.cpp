// SPDX-License-Identifier: BSD-3-Clause
#include "streams/waiting_input.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace mmbrdf::program {

namespace {

constexpr int look_up_ms = 20;  // how long a reader may not see that it need not read

bool is_standard_input(const std::string& path) { return path == "-"; }

}  // namespace

bool may_wait(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  return is_standard_input(path) || (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
                                     !std::filesystem::is_directory(status));
}

WaitingInput::WaitingInput(const std::string& path)
    : number_(is_standard_input(path) ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (number_ < 0) throw std::runtime_error(path + ": cannot be opened: " + std::generic_category().message(errno));
}

WaitingInput::~WaitingInput() {
  if (number_ != STDIN_FILENO) ::close(number_);
}

WaitingInput::int_type WaitingInput::underflow() {
  while (!ended_) {
    pollfd one{.fd = number_, .events = POLLIN, .revents = 0};
    if (::poll(&one, 1, look_up_ms) == 0) continue;
    const ssize_t count = ::read(number_, buffer_.data(), buffer_.size());
    if (count > 0) {
      setg(buffer_.data(), buffer_.data(), buffer_.data() + count);
      return traits_type::to_int_type(buffer_.front());
    }
    if (count == 0) break;
    if (errno != EINTR && errno != EAGAIN) throw std::system_error(errno, std::generic_category());
  }
  return traits_type::eof();
}

}  // namespace mmbrdf::program
