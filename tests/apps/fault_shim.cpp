// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
//
// A library for LD_PRELOAD that makes system calls of main() fail, as with a full or broken disk or
// too little memory. Environment variables:
//
//   TOFSMITH_FAULT_CALL    write, sync, rename, open (for writing), mkdir, mmap or malloc
//   TOFSMITH_FAULT_AT      number of the failing call, from 1; 0: calls are only counted
//   TOFSMITH_FAULT_ERRNO   errno of the failure; 0: kills the process instead
//   TOFSMITH_FAULT_STAYS   1: all later calls of this kind fail, too
//   TOFSMITH_FAULT_CLOCK   seconds by which the time of day is alternately later and earlier
//   TOFSMITH_FAULT_COUNTS  file for the number of calls of each kind, written after main()
//
// Calls on terminals and pipes never fail.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

enum Kind { write_call, sync_call, rename_call, open_call, mkdir_call, mmap_call, malloc_call };
constexpr const char* names[] = {"write", "sync", "rename", "open", "mkdir", "mmap", "malloc"};
constexpr int kinds = 7;

std::atomic<bool> is_active{false};
std::atomic<long> counts[kinds];
int failing_kind = -1, failing_errno = 0;
long failing_at = 0, clock_jump_s = 0;
bool stays = false;

long number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? 0 : std::atol(text);
}

void read_settings() {
  const char* const call = std::getenv("TOFSMITH_FAULT_CALL");
  for (int kind = 0; kind < kinds; ++kind)
    if (call != nullptr && std::strcmp(call, names[kind]) == 0) failing_kind = kind;
  failing_at = number_of("TOFSMITH_FAULT_AT");
  failing_errno = static_cast<int>(number_of("TOFSMITH_FAULT_ERRNO"));
  stays = number_of("TOFSMITH_FAULT_STAYS") != 0;
  clock_jump_s = number_of("TOFSMITH_FAULT_CLOCK");
}

/// Counts a call; returns whether it must fail, after setting errno.
bool fails(Kind kind) {
  if (!is_active.load(std::memory_order_relaxed)) return false;
  const long at = counts[kind].fetch_add(1) + 1;
  if (kind != failing_kind || failing_at == 0) return false;
  if (at != failing_at && !(stays && at > failing_at)) return false;
  if (failing_errno == 0) {
    ::kill(::getpid(), SIGKILL);
    for (;;) ::pause();
  }
  errno = failing_errno;
  return true;
}

time_t clock_error_s() {
  static std::atomic<unsigned> asked{0};
  return is_active && clock_jump_s != 0 ? (asked++ % 2 == 0 ? clock_jump_s : -clock_jump_s) : 0;
}

bool is_file(int descriptor) {
  struct stat found {};
  const int before = errno;
  const bool file = ::fstat(descriptor, &found) == 0 && S_ISREG(found.st_mode);
  errno = before;
  return file;
}

bool writes(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0; }
bool writes(const char* mode) { return std::strpbrk(mode, "wa+") != nullptr; }

template <typename Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

void write_counts() {
  const char* const path = std::getenv("TOFSMITH_FAULT_COUNTS");
  if (path == nullptr) return;
  if (std::FILE* const file = std::fopen(path, "w")) {
    for (int kind = 0; kind < kinds; ++kind)
      std::fprintf(file, "%s %ld\n", names[kind], counts[kind].load());
    std::fclose(file);
  }
}

using Main = int (*)(int, char**, char**);
Main real_main = nullptr;

int counted_main(int argc, char** argv, char** environment) {
  read_settings();
  is_active = true;
  const int code = real_main(argc, argv, environment);
  is_active = false;
  write_counts();
  return code;
}

}  // namespace

// Each function replaces that of the C library, which NEXT returns.
#define NEXT(name) next<decltype(&::name)>(#name)

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  real_main = main;
  return next<int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*)>(
      "__libc_start_main")(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

ssize_t write(int file, const void* bytes, std::size_t size) {
  static const auto real = NEXT(write);
  return is_file(file) && fails(write_call) ? -1 : real(file, bytes, size);
}
ssize_t writev(int file, const struct iovec* pieces, int count) {
  static const auto real = NEXT(writev);
  return is_file(file) && fails(write_call) ? -1 : real(file, pieces, count);
}
ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t offset) {
  static const auto real = NEXT(pwrite);
  return fails(write_call) ? -1 : real(file, bytes, size, offset);
}
ssize_t pwrite64(int file, const void* bytes, std::size_t size, off64_t offset) {
  static const auto real = NEXT(pwrite64);
  return fails(write_call) ? -1 : real(file, bytes, size, offset);
}
std::size_t fwrite(const void* bytes, std::size_t size, std::size_t count, std::FILE* file) {
  static const auto real = NEXT(fwrite);
  return is_file(::fileno(file)) && fails(write_call) ? 0 : real(bytes, size, count, file);
}
int ftruncate(int file, off_t size) {
  static const auto real = NEXT(ftruncate);
  return fails(write_call) ? -1 : real(file, size);
}
int ftruncate64(int file, off64_t size) {
  static const auto real = NEXT(ftruncate64);
  return fails(write_call) ? -1 : real(file, size);
}

int fsync(int file) {
  static const auto real = NEXT(fsync);
  return fails(sync_call) ? -1 : real(file);
}
int fdatasync(int file) {
  static const auto real = NEXT(fdatasync);
  return fails(sync_call) ? -1 : real(file);
}

int rename(const char* from, const char* to) {
  static const auto real = NEXT(rename);
  return fails(rename_call) ? -1 : real(from, to);
}
int renameat2(int from_place, const char* from, int to_place, const char* to, unsigned flags) {
  static const auto real = NEXT(renameat2);
  return fails(rename_call) ? -1 : real(from_place, from, to_place, to, flags);
}

int mkdir(const char* path, mode_t mode) {
  static const auto real = NEXT(mkdir);
  return fails(mkdir_call) ? -1 : real(path, mode);
}

#define OPEN(name)                                                           \
  int name(const char* path, int flags, ...) {                               \
    static const auto real = NEXT(name);                                     \
    va_list rest;                                                            \
    va_start(rest, flags);                                                   \
    const mode_t mode = writes(flags) ? va_arg(rest, mode_t) : 0;            \
    va_end(rest);                                                            \
    return writes(flags) && fails(open_call) ? -1 : real(path, flags, mode); \
  }
OPEN(open)
OPEN(open64)
#undef OPEN
std::FILE* fopen(const char* path, const char* mode) {
  static const auto real = NEXT(fopen);
  return writes(mode) && fails(open_call) ? nullptr : real(path, mode);
}
std::FILE* fopen64(const char* path, const char* mode) {
  static const auto real = NEXT(fopen64);
  return writes(mode) && fails(open_call) ? nullptr : real(path, mode);
}

int clock_gettime(clockid_t clock, struct timespec* now) noexcept {
  static const auto real = NEXT(clock_gettime);
  const int code = real(clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec += clock_error_s();
  return code;
}
int gettimeofday(struct timeval* now, void* zone) noexcept {
  static const auto real = NEXT(gettimeofday);
  const int code = real(now, zone);
  now->tv_sec += clock_error_s();
  return code;
}
time_t time(time_t* now) noexcept {
  static const auto real = NEXT(time);
  const time_t found = real(nullptr) + clock_error_s();
  if (now != nullptr) *now = found;
  return found;
}

void* mmap(void* at, std::size_t size, int protection, int flags, int file, off_t offset) {
  static const auto real = NEXT(mmap);
  return fails(mmap_call) ? MAP_FAILED : real(at, size, protection, flags, file, offset);
}
void* mmap64(void* at, std::size_t size, int protection, int flags, int file, off64_t offset) {
  static const auto real = NEXT(mmap64);
  return fails(mmap_call) ? MAP_FAILED : real(at, size, protection, flags, file, offset);
}

void* malloc(std::size_t size) { return fails(malloc_call) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return fails(malloc_call) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  return fails(malloc_call) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails(malloc_call) ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return fails(malloc_call) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
  if (fails(malloc_call)) return errno;
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}

}  // extern "C"
