// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <streambuf>
#include <system_error>

namespace mmbrdf {
namespace {

namespace fs = std::filesystem;

std::runtime_error failure(const std::string& path, const std::string& reason) {
  return std::runtime_error(path + ": cannot be written: " + reason);
}
std::runtime_error failure(const std::string& path, int error) {
  return failure(path, std::generic_category().message(error));
}

/// An open file that closes itself, and the stream's way to it. Unlike std::filebuf it keeps the reason of an error.
class Descriptor : public std::streambuf {
 public:
  explicit Descriptor(int number) : number_(number) { setp(buffer_.data(), buffer_.data() + buffer_.size()); }
  ~Descriptor() override { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  int error() const { return error_; }

  void close() {
    if (number_ >= 0 && ::close(number_) != 0 && error_ == 0) error_ = errno;
    number_ = -1;
  }

 protected:
  int_type overflow(int_type c) override {
    if (sync() != 0) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

  int sync() override {
    write_out(pbase(), pptr());
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return error_ == 0 ? 0 : -1;
  }

  /// What does not fit into the buffer goes past it.
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (size < epptr() - pptr()) return std::streambuf::xsputn(text, size);
    if (sync() != 0) return 0;
    write_out(text, text + size);
    return error_ == 0 ? size : 0;
  }

  /// To the beginning only, to write again what is known at the end.
  pos_type seekpos(pos_type position, std::ios_base::openmode) override {
    if (position != pos_type(0) || sync() != 0 || ::lseek(number_, 0, SEEK_SET) != 0) return pos_type(off_type(-1));
    return position;
  }

 private:
  void write_out(const char* next, const char* end) {
    while (next < end && error_ == 0) {
      const ssize_t written = ::write(number_, next, static_cast<std::size_t>(end - next));
      if (written > 0)
        next += written;
      else if (written == 0)
        error_ = EIO;
      else if (errno != EINTR)
        error_ = errno;
    }
  }

  int number_;
  int error_ = 0;
  std::array<char, 1 << 16> buffer_;
};

/// Writes all of it, and closes. Throws naming `path`.
void write_all(Descriptor& file, const std::string& path, const std::function<void(std::ostream&)>& write) {
  std::ostream out(&file);
  write(out);
  out.flush();
  file.close();
  if (file.error() != 0) throw failure(path, file.error());
  if (!out) throw failure(path, "the output is incomplete");
}

/// A new file under a name that nobody else has. Removed at the end of its life, unless renamed.
class TemporaryFile {
 public:
  TemporaryFile(const fs::path& target, const std::string& path) : file_(create(target, path)) {}
  ~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  Descriptor& file() { return file_; }

  void rename_to(const fs::path& target, const std::string& path) {
    if (std::rename(name_.c_str(), target.c_str()) != 0) throw failure(path, errno);
    name_.clear();
  }

 private:
  /// mkstemp() would do, but for the permissions: 0666 and the umask, as for any new file.
  int create(const fs::path& target, const std::string& path) {
    static std::atomic<unsigned> count{0};
    while (true) {
      name_ =
          (target.parent_path() / (".mmbrdf-" + std::to_string(::getpid()) + "-" + std::to_string(count++))).string();
      const int number = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (number >= 0) return number;
      if (const int error = errno; error != EEXIST) {
        name_.clear();
        throw failure(path, error);
      }
    }
  }

  std::string name_;
  Descriptor file_;
};

/// Where a chain of symbolic links ends, whether or not something is there.
fs::path followed(fs::path path) {
  std::error_code ignored;
  for (int links = 0; links < 40 && fs::is_symlink(fs::symlink_status(path, ignored)); ++links) {
    const fs::path next = fs::read_symlink(path, ignored);
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

/// What is under /dev and /proc may be a link to a regular file that somebody else holds open, as /dev/stdout is.
bool is_written_directly(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) &&
         (!fs::is_regular_file(status) || path.starts_with("/dev/") || path.starts_with("/proc/"));
}

void write_directly(const std::string& path, const std::function<void(std::ostream&)>& write) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (file.number() < 0) throw failure(path, errno);
  write_all(file, path, write);
}

}  // namespace

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (path.empty()) throw failure("output file", "it has no name");
  if (is_written_directly(path)) return write_directly(path, write);
  const fs::path target = followed(path);
  std::error_code ignored;
  if (const fs::path folder = target.parent_path(); !folder.empty() && !fs::is_directory(folder, ignored))
    throw failure(path, "there is no folder " + folder.string());
  struct stat old {};
  const bool exists = ::stat(target.c_str(), &old) == 0;
  if (exists && ::access(target.c_str(), W_OK) != 0) throw failure(path, errno);
  TemporaryFile temporary(target, path);
  if (exists && ::fchmod(temporary.file().number(), old.st_mode & 07777) != 0) throw failure(path, errno);
  write_all(temporary.file(), path, write);
  temporary.rename_to(target, path);
}

}  // namespace mmbrdf
