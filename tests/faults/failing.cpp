// SPDX-License-Identifier: BSD-3-Clause
// Preloaded, makes one call to the system fail, be cut short or be interrupted: FAIL=write:7:error is the seventh
// write(). FAIL_COUNT is a file that gets the number of calls of the kind. What runs before main() is left alone.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
}

namespace {

enum class How { well, error, cut, interrupted };

struct Plan {
  char call[16] = "";
  long at = 0;
  How how = How::well;
  std::atomic<long> count{0};
  bool ready = false;
};

Plan plan;

void read_plan() {
  const char* const text = std::getenv("FAIL");
  char how[16] = "";
  if (text == nullptr || std::sscanf(text, "%15[a-z_]:%ld:%15s", plan.call, &plan.at, how) != 3) return;
  plan.how = how[0] == 'e' ? How::error : how[0] == 'c' ? How::cut : How::interrupted;
  plan.ready = true;
}

__attribute__((destructor)) void tell_count() {
  const char* const path = std::getenv("FAIL_COUNT");
  if (path == nullptr) return;
  plan.ready = false;
  if (std::FILE* const file = std::fopen(path, "w")) {
    std::fprintf(file, "%ld\n", plan.count.load());
    std::fclose(file);
  }
}

/// How this call is to end.
How how(const char* call) {
  if (!plan.ready || std::strcmp(call, plan.call) != 0) return How::well;
  return ++plan.count == plan.at ? plan.how : How::well;
}

bool has_memory() {
  const bool well = how("malloc") == How::well;
  if (!well) errno = ENOMEM;
  return well;
}

using Main = int(int, char**, char**);
Main* program_main = nullptr;

int main_with_plan(int count, char** words, char** environment) {
  read_plan();
  return program_main(count, words, environment);
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

template <class Call>
ssize_t transfer(const char* name, int error, std::size_t size, Call call) {
  const How end = how(name);
  if (end == How::error || end == How::interrupted) {
    errno = end == How::error ? error : EINTR;
    return -1;
  }
  return call(end == How::cut && size > 1 ? size / 2 : size);
}

}  // namespace

extern "C" {

int __libc_start_main(Main* main, int count, char** words, void (*init)(), void (*fini)(), void (*end)(), void* stack) {
  const auto next = real<int (*)(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*)>("__libc_start_main");
  program_main = main;
  return next(main_with_plan, count, words, init, fini, end, stack);
}

ssize_t write(int file, const void* bytes, std::size_t size) {
  static const auto next = real<ssize_t (*)(int, const void*, std::size_t)>("write");
  return transfer("write", ENOSPC, size, [&](std::size_t some) { return next(file, bytes, some); });
}

ssize_t writev(int file, const iovec* parts, int count) {
  static const auto next = real<ssize_t (*)(int, const iovec*, int)>("writev");
  return transfer("write", ENOSPC, static_cast<std::size_t>(count),
                  [&](std::size_t some) { return next(file, parts, static_cast<int>(some)); });
}

ssize_t read(int file, void* bytes, std::size_t size) {
  static const auto next = real<ssize_t (*)(int, void*, std::size_t)>("read");
  return transfer("read", EIO, size, [&](std::size_t some) { return next(file, bytes, some); });
}

int close(int file) {
  static const auto next = real<int (*)(int)>("close");
  const int result = next(file);  // which is closed in any case
  return static_cast<int>(transfer("close", EIO, 0, [&](std::size_t) { return result; }));
}

int fsync(int file) {
  static const auto next = real<int (*)(int)>("fsync");
  return static_cast<int>(transfer("fsync", EIO, 0, [&](std::size_t) { return next(file); }));
}

int renameat(int from, const char* old, int to, const char* name) {
  static const auto next = real<int (*)(int, const char*, int, const char*)>("renameat");
  return static_cast<int>(transfer("rename", EACCES, 0, [&](std::size_t) { return next(from, old, to, name); }));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
  static const auto next = real<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  return how("pthread_create") == How::well ? next(thread, attributes, run, argument) : EAGAIN;
}

void* dlopen(const char* name, int mode) {
  static const auto next = real<void* (*)(const char*, int)>("dlopen");
  return how("dlopen") == How::well ? next(name, mode) : nullptr;
}

void* malloc(std::size_t size) { return has_memory() ? __libc_malloc(size) : nullptr; }

void* calloc(std::size_t count, std::size_t size) { return has_memory() ? __libc_calloc(count, size) : nullptr; }

void* realloc(void* old, std::size_t size) { return has_memory() ? __libc_realloc(old, size) : nullptr; }

}  // extern "C"
