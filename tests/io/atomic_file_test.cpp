// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

constexpr auto refuse = OutputPolicy::refuse_existing;
constexpr auto overwrite = OutputPolicy::overwrite;

TEST(AtomicFile, WritesTheGivenBytes) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", std::string_view("first"), refuse);
  EXPECT_EQ(read_text_file(directory / "a.txt"), "first");
  write_file_atomically(directory / "a.txt", std::string_view("second"), overwrite);
  EXPECT_EQ(read_text_file(directory / "a.txt"), "second");
  EXPECT_EQ(directory.files(), 1);
}

TEST(AtomicFile, OverwritesBytesAlsoPastTheEndAndContinuesAtTheEnd) {
  const TemporaryDirectory directory;
  AtomicFile file(directory / "a.txt", refuse);
  file.write("_____, w");
  file.write_at(7, std::as_bytes(std::span("Mars", 4)));
  file.write_at(0, std::as_bytes(std::span("Hello", 5)));
  file.write("!");
  file.commit();
  EXPECT_EQ(read_text_file(directory / "a.txt"), "Hello, Mars!");
}

TEST(AtomicFile, RefusesAnExistingFileAndSuggestsForce) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", std::string_view("old"), refuse);
  const std::string message = io_error_of(
      [&] { write_file_atomically(directory / "a.txt", std::string_view("new"), refuse); });
  EXPECT_THAT(message, HasSubstr("--force"));
  EXPECT_THAT(message, HasSubstr((directory / "a.txt").string()));
  EXPECT_EQ(read_text_file(directory / "a.txt"), "old");
}

TEST(AtomicFile, RefusesAFileThatAppearsWhileItIsWritten) {
  const TemporaryDirectory directory;
  {
    AtomicFile file(directory / "a.txt", refuse);
    file.write("late");
    std::ofstream(directory / "a.txt") << "early";
    EXPECT_THROW(file.commit(), IoError);
  }
  EXPECT_EQ(read_text_file(directory / "a.txt"), "early");
  EXPECT_EQ(directory.files(), 1);
}

TEST(AtomicFile, AcceptsIdenticalContentButRejectsOther) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.txt";
  write_file_atomically(path, std::string_view("same"), refuse);
  write_file_atomically(path, std::string_view("same"), OutputPolicy::refuse_other);
  for (const std::string_view other : {"sam", "same!", "SAME"})
    EXPECT_THAT(
        io_error_of([&] { write_file_atomically(path, other, OutputPolicy::refuse_other); }),
        HasSubstr("already exists"));
  EXPECT_EQ(read_text_file(path), "same");
  EXPECT_EQ(directory.files(), 1);
}

TEST(AtomicFile, LeadingOutputsMeanThatARunWasStopped) {
  const TemporaryDirectory directory;
  const std::vector<std::filesystem::path> outputs{directory / "a.txt", directory / "b.txt"};
  EXPECT_EQ(policy_to_go_on(outputs, refuse), refuse);
  write_file_atomically(outputs[0], std::string_view("a"), refuse);
  EXPECT_EQ(policy_to_go_on(outputs, refuse), OutputPolicy::refuse_other);
  EXPECT_EQ(policy_to_go_on(outputs, overwrite), overwrite);
  const std::vector<std::filesystem::path> last_there{directory / "b.txt", directory / "a.txt"};
  EXPECT_EQ(policy_to_go_on(last_there, refuse), refuse) << "of another run";
  write_file_atomically(outputs[1], std::string_view("b"), refuse);
  EXPECT_EQ(policy_to_go_on(outputs, refuse), refuse);
}

TEST(AtomicFile, AnExceptionKeepsTheOldFileOnly) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", std::string_view("old"), refuse);
  try {
    AtomicFile file(directory / "a.txt", overwrite);
    file.write("half of the new");
    throw std::runtime_error("stop");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(read_text_file(directory / "a.txt"), "old");
  EXPECT_EQ(directory.files(), 1);
}

TEST(AtomicFile, AFullDiskKeepsTheOldFileOnly) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", std::string_view("old"), refuse);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_file_atomically(directory / "a.txt", std::string(5000, 'x'), overwrite),
               IoError);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_EQ(read_text_file(directory / "a.txt"), "old");
  EXPECT_EQ(directory.files(), 1);
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a.txt", std::string_view("old"), refuse);
  ASSERT_EQ(chmod((directory / "a.txt").c_str(), 0640), 0);
  std::filesystem::create_symlink("a.txt", directory / "link.txt");
  write_file_atomically(directory / "link.txt", std::string_view("new"), overwrite);
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.txt"));
  EXPECT_EQ(read_text_file(directory / "a.txt"), "new");
  struct stat status {};
  ASSERT_EQ(stat((directory / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

/// Creates the temporary file of a killed process and renames it by `changed`.
template <typename Change>
std::filesystem::path leftover(const TemporaryDirectory& directory, const Change& change) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const AtomicFile file(directory / "a.txt", refuse);
    const std::string name = file.temporary_path().filename();
    EXPECT_EQ(write(ends[1], name.data(), name.size()), std::ssize(name));
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  char name[256];
  const ssize_t length = read(ends[0], name, sizeof(name));
  close(ends[0]);
  close(ends[1]);
  const std::string was(name, static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  const std::filesystem::path changed = directory / change(was);
  std::filesystem::rename(directory / was, changed);
  return changed;
}

TEST(AtomicFile, LeftoversOfAKilledProcessAreRemovedWithTheNextFile) {
  const TemporaryDirectory directory;
  leftover(directory, [](const std::string& name) { return name; });
  std::ofstream(directory / ".tofsmith-of-another-machine-1-0.txt") << "not ours";
  EXPECT_EQ(directory.files(), 2);
  AtomicFile running(directory / "b.txt", refuse);
  EXPECT_EQ(directory.files(), 2);  // ours, and that of another machine
  EXPECT_TRUE(std::filesystem::exists(directory / ".tofsmith-of-another-machine-1-0.txt"));
}

TEST(AtomicFile, FilesOfAnotherContainerAreKept) {
  const TemporaryDirectory directory;
  // The same process number in another PID namespace, on a machine with the same name.
  const std::filesystem::path other = leftover(directory, [](std::string name) {
    char& digit = name[std::string(".tofsmith-").size()];
    digit = digit == '0' ? '1' : '0';
    return name;
  });
  const AtomicFile running(directory / "b.txt", refuse);
  EXPECT_TRUE(std::filesystem::exists(other));
}

TEST(AtomicFile, LeftoversOfAnEarlierProcessWithTheSameNumberAreRemoved) {
  const TemporaryDirectory directory;
  const std::filesystem::path earlier = leftover(directory, [](const std::string& name) {
    const std::size_t number = name.find('-', std::string(".tofsmith-").size()) + 1;
    return name.substr(0, number) + std::to_string(getpid()) + name.substr(name.find('-', number));
  });
  const AtomicFile running(directory / "b.txt", refuse);
  EXPECT_FALSE(std::filesystem::exists(earlier));
}

/// Runs `body` as process `number` in a new PID namespace with its own /proc. Returns false if the
/// system does not allow this.
template <typename Body>
bool run_in_other_namespace(pid_t number, const Body& body) {
  const pid_t outer = fork();
  if (outer == 0) {
    if (unshare(CLONE_NEWPID | CLONE_NEWNS) != 0) _exit(77);
    const pid_t first = fork();
    if (first == 0) {
      if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
          mount("proc", "/proc", "proc", 0, nullptr) != 0)
        _exit(77);
      for (;;) {
        const pid_t child = fork();
        if (child == 0) {
          if (getpid() == number) body();
          _exit(0);
        }
        waitpid(child, nullptr, 0);
        if (child >= number) _exit(child == number ? 0 : 77);
      }
    }
    int status = 0;
    waitpid(first, &status, 0);
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
  }
  int status = 0;
  EXPECT_EQ(waitpid(outer, &status, 0), outer);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(AtomicFile, ProcessesOfTwoNamespacesKeepEachOthersFiles) {
  const TemporaryDirectory directory;
  pid_t unused = 2;  // a process number that does not exist here
  while (kill(unused, 0) == 0 || errno != ESRCH) ++unused;
  // Its file must stay, because this process cannot determine whether it is still in use.
  const bool allowed = run_in_other_namespace(unused, [&] {
    const AtomicFile writing(directory / "a.txt", refuse);
    kill(getpid(), SIGKILL);
  });
  if (!allowed) GTEST_SKIP() << "needs the right to make namespaces";
  EXPECT_EQ(directory.files(), 1);
  const AtomicFile here(directory / "b.txt", refuse);
  EXPECT_EQ(directory.files(), 2);
}

TEST(AtomicFile, ALibraryMayReplaceTheTemporaryFile) {
  const TemporaryDirectory directory;
  AtomicFile file(directory / "a.exr", refuse);
  EXPECT_EQ(file.temporary_path().extension(), ".exr");
  EXPECT_EQ(file.temporary_path().parent_path(), directory.path());
  std::filesystem::remove(file.temporary_path());
  std::ofstream(file.temporary_path()) << "by path";
  file.commit();
  EXPECT_EQ(read_text_file(directory / "a.exr"), "by path");
}

TEST(AtomicFile, ReportsProblemsWithTheTarget) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file") << "x";
  const auto message = [](const std::filesystem::path& path) {
    return io_error_of([&] { AtomicFile(path, overwrite); });
  };
  EXPECT_THAT(message(directory / "missing/a.txt"), HasSubstr("does not exist; create it first"));
  EXPECT_THAT(message(directory / "file/a.txt"), HasSubstr("is a file; expected a directory"));
  EXPECT_THAT(message(directory.path()), HasSubstr("found a directory"));
  EXPECT_THAT(message(directory / "new/"), HasSubstr("after the last slash"));
  EXPECT_THAT(message("/dev/null"), HasSubstr("found a device"));
  EXPECT_THAT(message("/proc/a.txt"), HasSubstr("cannot create a file in /proc"));
  EXPECT_THAT(message(directory / std::string(300, 'n')), HasSubstr(directory.path().string()));
  EXPECT_THAT(message(""), HasSubstr("empty file name"));
  EXPECT_EQ(directory.files(), 1);
}

TEST(ReadFile, ReturnsTheContentOfFilesWithAndWithoutReportedSize) {
  const TemporaryDirectory directory;
  const std::string long_text(100000, 'a');
  std::ofstream(directory / "a") << long_text;
  EXPECT_EQ(read_text_file(directory / "a"), long_text);
  EXPECT_EQ(read_binary_file(directory / "a"), bytes_of(long_text));
  std::ofstream(directory / "empty");
  EXPECT_EQ(read_text_file(directory / "empty"), "");
  EXPECT_THAT(read_text_file("/proc/self/status"), HasSubstr("Pid:"));
}

TEST(ReadFile, ReportsProblems) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a") << "12345";
  EXPECT_THAT(io_error_of([&] { read_text_file(directory / "none"); }), HasSubstr("no such file"));
  EXPECT_THAT(io_error_of([&] { read_text_file(directory.path()); }), HasSubstr("a directory"));
  EXPECT_THAT(io_error_of([&] { read_text_file(directory / "a/b"); }), HasSubstr("cannot read"));
  EXPECT_THAT(io_error_of([&] { read_text_file(directory / "a", 4); }),
              HasSubstr("found 5 bytes; expected at most 4"));
  EXPECT_THAT(io_error_of([&] { read_text_file("/proc/self/status", 10); }),
              HasSubstr("expected at most 10"));
  EXPECT_EQ(read_text_file(directory / "a", 5), "12345");
}

}  // namespace
}  // namespace tofsmith
