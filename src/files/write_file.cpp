// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/files/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
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
    if (number_ >= 0 && ::close(number_) != 0 && errno != EINTR && error_ == 0) error_ = errno;
    number_ = -1;
  }

  /// What is written lies on the disk from then on, where the file system has one.
  void keep() {
    int result = 0;
    while ((result = ::fsync(number_)) != 0 && errno == EINTR) continue;
    if (result != 0 && errno != EINVAL && errno != ENOTSUP && error_ == 0) error_ = errno;
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

  /// To the beginning only, to write again what is known at the end: not where all that is written goes to the end.
  pos_type seekpos(pos_type position, std::ios_base::openmode) override {
    const bool fixed = (::fcntl(number_, F_GETFL) & O_APPEND) == 0;
    if (position != pos_type(0) || sync() != 0 || !fixed || ::lseek(number_, 0, SEEK_SET) != 0)
      return pos_type(off_type(-1));
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
void write_all(Descriptor& file, const std::string& path, const std::function<void(std::ostream&)>& write, bool keep) {
  std::ostream out(&file);
  write(out);
  out.flush();
  if (keep && file.error() == 0) file.keep();
  file.close();
  if (file.error() != 0) throw failure(path, file.error());
  if (!out) throw failure(path, "the output is incomplete");
}

/// ".mmbrdf-PROCESS-NUMBER", without memory from the heap: a handler of a signal may need it.
class TemporaryName {
 public:
  explicit TemporaryName(std::uint32_t number) {
    char* end = std::to_chars(std::copy_n(".mmbrdf-", 8, text_.data()), &text_.back(), ::getpid()).ptr;
    *end++ = '-';
    *std::to_chars(end, &text_.back(), number).ptr = '\0';
  }
  const char* text() const { return text_.data(); }

 private:
  std::array<char, 40> text_{};
};

/// The temporary files that there are, each as its folder's descriptor plus 1 and its number; 0 is a free place. Who
/// reads a place that changes in the meantime removes nothing of others: all such names are this process's.
using Place = std::atomic<std::uint64_t>;
static_assert(Place::is_always_lock_free);
std::array<Place, 64> temporary_files{};

Place* watch(std::uint64_t entry) {
  for (Place& place : temporary_files)
    if (std::uint64_t free = 0; place.compare_exchange_strong(free, entry)) return &place;
  return nullptr;
}

std::uint32_t next_number() {
  static std::atomic<std::uint32_t> count{0};
  return count++;
}

/// A file that waits in the folder of the one that it replaces. Unless kept, all is as before at the end.
class WaitingFile {
 public:
  WaitingFile(const fs::path& target, const std::string& path)
      : path_(path), name_(target.filename().string()), folder_(open_folder(target.parent_path(), path)) {}
  ~WaitingFile() {
    if (aside_)
      rename(aside_->text(), name_.c_str());
    else if (in_place_)
      ::unlinkat(folder_, name_.c_str(), 0);
    if (temporary_) ::unlinkat(folder_, temporary_->text(), 0);
    if (watched_ != nullptr) *watched_ = 0;
    ::close(folder_);
  }
  WaitingFile(const WaitingFile&) = delete;
  WaitingFile& operator=(const WaitingFile&) = delete;

  void write(const std::function<void(std::ostream&)>& write) {
    struct stat old {};
    const bool exists = ::fstatat(folder_, name_.c_str(), &old, 0) == 0;
    if (exists && ::faccessat(folder_, name_.c_str(), W_OK, 0) != 0 && errno != ENOENT)  // set aside by another writer
      throw failure(path_, errno);
    Descriptor file(create());
    if (exists && ::fchmod(file.number(), old.st_mode & 07777) != 0) throw failure(path_, errno);
    write_all(file, path_, write, true);
  }

  /// The old file, if there is one.
  void set_old_aside() {
    const TemporaryName aside(next_number());
    if (rename(name_.c_str(), aside.text()))
      aside_ = aside;
    else if (errno != ENOENT)
      throw failure(path_, errno);
  }

  void put_in_place() {
    if (!rename(temporary_->text(), name_.c_str())) throw failure(path_, errno);
    in_place_ = true;
    temporary_.reset();
  }

  /// The old one is gone from now on. A folder that cannot be synchronized is no error: the file is in it.
  void keep() {
    if (aside_) ::unlinkat(folder_, aside_->text(), 0);
    aside_.reset();
    in_place_ = false;
    ::fsync(folder_);
  }

 private:
  /// For reading, so that it can be synchronized; but a folder may allow new files only.
  static int open_folder(const fs::path& folder, const std::string& path) {
    const std::string name = folder.empty() ? "." : folder.string();
    int number = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (number < 0 && errno == EACCES) number = ::open(name.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (number < 0 && (errno == ENOENT || errno == ENOTDIR)) throw failure(path, "there is no folder " + name);
    if (number < 0) throw failure(path, errno);
    return number;
  }

  /// mkstemp() would do, but for the permissions: 0666 and the umask, as for any new file.
  int create() {
    while (true) {
      const std::uint32_t number = next_number();
      const TemporaryName name(number);
      const int file = ::openat(folder_, name.text(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file >= 0) {
        temporary_ = name;
        watched_ = watch(std::uint64_t(folder_ + 1) << 32 | number);
        return file;
      }
      if (errno != EEXIST && errno != EINTR) throw failure(path_, errno);
    }
  }

  bool rename(const char* from, const char* to) const { return ::renameat(folder_, from, folder_, to) == 0; }

  std::string path_, name_;
  int folder_;
  std::optional<TemporaryName> temporary_, aside_;
  Place* watched_ = nullptr;
  bool in_place_ = false;
};

/// A link to what a process holds open, as /dev/stdout leads to one.
bool is_descriptor(const fs::path& link) {
  std::error_code ignored;
  const fs::path folder = fs::canonical(link.has_parent_path() ? link.parent_path() : ".", ignored);
  return folder.string().starts_with("/proc/") && folder.filename() == "fd";
}

/// Where a chain of symbolic links ends, whether or not something is there. Nothing for what is written to directly.
std::optional<fs::path> replaced(const std::string& path) {
  constexpr int most_links = 40;
  std::error_code ignored;
  fs::path end = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(end, ignored)); ++links) {
    if (links == most_links) throw failure(path, ELOOP);
    if (is_descriptor(end)) return std::nullopt;
    const fs::path next = fs::read_symlink(end, ignored);
    end = next.is_absolute() ? next : end.parent_path() / next;
  }
  const fs::file_status status = fs::status(end, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) return std::nullopt;
  return end;
}

/// One for all names of a place. The file itself is not looked for: another writer may replace it at this moment.
fs::path place_of(const fs::path& file) {
  std::error_code ignored;  // of a folder that is not there it is said when it is opened
  return fs::weakly_canonical(file.has_parent_path() ? file.parent_path() : ".", ignored) / file.filename();
}

void write_directly(const NewFile& file) {
  Descriptor out(::open(file.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  if (out.number() < 0) throw failure(file.path, errno);
  write_all(out, file.path, file.write, false);
}

/// No signal ends the process on this thread in the meantime.
class Undisturbed {
 public:
  Undisturbed() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~Undisturbed() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  Undisturbed(const Undisturbed&) = delete;
  Undisturbed& operator=(const Undisturbed&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

void write_files(const std::vector<NewFile>& files) {
  std::vector<std::unique_ptr<WaitingFile>> waiting;
  std::set<fs::path> targets;
  for (const NewFile& file : files) {
    if (file.path.empty()) throw failure("output file", "it has no name");
    if (const std::optional<fs::path> target = replaced(file.path)) {
      if (!targets.insert(place_of(*target)).second)
        throw failure(file.path, "another of the files to be written has this place");
      waiting.push_back(std::make_unique<WaitingFile>(*target, file.path));
      waiting.back()->write(file.write);
    } else {
      write_directly(file);
    }
  }
  const Undisturbed undisturbed;
  if (waiting.size() > 1)
    for (const auto& file : waiting) file->set_old_aside();  // so that no new one ever stands beside an old one
  for (const auto& file : waiting) file->put_in_place();
  for (const auto& file : waiting) file->keep();
}

void write_file(const std::string& path, const std::function<void(std::ostream&)>& write) {
  write_files({{path, write}});
}

void remove_temporary_files() noexcept {
  for (const Place& place : temporary_files)
    if (const std::uint64_t entry = place; entry != 0)
      ::unlinkat(static_cast<int>(entry >> 32) - 1, TemporaryName(static_cast<std::uint32_t>(entry)).text(), 0);
}

}  // namespace mmbrdf
