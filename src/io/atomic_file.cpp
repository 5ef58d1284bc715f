// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/atomic_file.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "core/shared/hash.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Unique among all processes that may share files.
struct ProcessIdentity {
  /// Boot of the machine and namespace of its process numbers (differs between containers); "" if
  /// unknown.
  std::string machine;
  std::int64_t number = 0;
  std::string start;  ///< in case a number is reused; "" if unknown

  static ProcessIdentity own();
};

/// Files of /proc have no size. Returns "" if the file is missing.
std::string content_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string target_of(const char* link) {
  std::error_code error;
  const auto target = std::filesystem::read_symlink(link, error);
  return error ? "" : target.string();
}

/// In ticks since boot (22nd field); "" if there is no such process.
std::string start_of(std::int64_t process) {
  const std::string stat = content_of(fmt::format("/proc/{}/stat", process));
  const std::size_t after_name = stat.rfind(')');  // the name may contain any character
  if (after_name == std::string::npos) return "";
  std::istringstream fields(stat.substr(after_name + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i)
    if (!(fields >> field)) return "";
  return field;
}

std::string own_machine() {
  // /proc may belong to another namespace, with other process numbers.
  if (target_of("/proc/self") != fmt::format("{}", ::getpid())) return "";
  const std::string numbers = target_of("/proc/self/ns/pid");
  std::string boot = content_of("/proc/sys/kernel/random/boot_id");
  if (numbers.empty() || boot.empty()) return "";
  boot.erase(boot.find_last_not_of('\n') + 1);
  return fmt::format("{} {}", boot, numbers);
}

ProcessIdentity ProcessIdentity::own() {
  const std::int64_t number = ::getpid();
  return {own_machine(), number, start_of(number)};
}

/// False for processes of other machines, boots and namespaces.
bool is_surely_gone(const ProcessIdentity& process, const ProcessIdentity& own) {
  if (own.machine.empty() || process.machine != own.machine) return false;
  if (::kill(static_cast<pid_t>(process.number), 0) != 0 && errno == ESRCH) return true;
  const std::string start = start_of(process.number);
  return !start.empty() && start != process.start;  // /proc may hide processes of other users
}

namespace fs = std::filesystem;

std::string system_message(int error) { return std::generic_category().message(error); }

fs::path follow_link(fs::path path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  const fs::path resolved = fs::weakly_canonical(path, ignored);
  return ignored ? path : resolved;
}

fs::path directory_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// Other machines and containers may share the directory.
std::string hidden_prefix(const std::string& machine) {
  return fmt::format(".tofsmith-{:016x}-", fnv1a_64(machine));
}

struct CloseDirectory {
  void operator()(DIR* directory) const { ::closedir(directory); }
};

/// Parses the owner of a hidden file, "PREFIX" "NUMBER-START-COUNTER"; none: another prefix or
/// form.
std::optional<ProcessIdentity> owner_of(std::string_view name, const std::string& machine) {
  const std::string prefix = hidden_prefix(machine);
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  ProcessIdentity owner{.machine = machine};
  const char* const end = name.data() + name.size();
  const auto [after, error] = std::from_chars(name.data(), name.data() + name.size(), owner.number);
  if (error != std::errc() || owner.number <= 0 || after == end || *after != '-')
    return std::nullopt;
  name.remove_prefix(static_cast<std::size_t>(after + 1 - name.data()));
  const std::size_t dash = name.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  owner.start = name.substr(0, dash);
  return owner;
}

/// Removes hidden files of killed processes. Each directory is searched only once.
void remove_leftovers(const fs::path& directory, const ProcessIdentity& own) {
  static std::mutex mutex;
  static std::set<fs::path> seen;
  std::error_code ignored;
  {
    const std::lock_guard lock(mutex);
    if (!seen.insert(fs::absolute(directory, ignored)).second) return;
  }
  // A directory_iterator would terminate the process if memory runs out during an increment.
  // Directories that cannot be listed are skipped.
  const std::unique_ptr<DIR, CloseDirectory> listing(::opendir(directory.c_str()));
  if (!listing) return;
  while (const dirent* const entry = ::readdir(listing.get())) {
    const std::optional<ProcessIdentity> owner = owner_of(entry->d_name, own.machine);
    if (owner && is_surely_gone(*owner, own)) fs::remove(directory / entry->d_name, ignored);
  }
}

[[noreturn]] void refuse_existing_file(const fs::path& target) {
  throw IoError(target.string(), "the file already exists; choose another name or use --force");
}

void check_target(const fs::path& target, OutputPolicy policy) {
  if (target.empty()) throw IoError("output", "found an empty file name; expected a path");
  std::error_code error;
  const fs::file_status there = fs::status(target, error);
  if (there.type() == fs::file_type::none)
    throw IoError(target.string(), fmt::format("cannot write: {}", error.message()));
  if (fs::is_directory(there))
    throw IoError(target.string(), "found a directory; expected the name of an output file");
  // Renaming would replace a device.
  if (fs::exists(there) && !fs::is_regular_file(there))
    throw IoError(target.string(), "found a device or pipe; expected the name of an output file");
  if (!target.has_filename())
    throw IoError(target.string(), "expected the name of an output file after the last slash");
  if (fs::exists(there) && policy == OutputPolicy::refuse_existing) refuse_existing_file(target);

  const fs::path directory = directory_of(target);
  const fs::file_status parent = fs::status(directory, error);
  if (parent.type() == fs::file_type::not_found)
    throw IoError(target.string(),
                  fmt::format("cannot write: the directory {} does not exist; create it first",
                              directory.string()));
  if (fs::exists(parent) && !fs::is_directory(parent))
    throw IoError(target.string(), fmt::format("cannot write: {} is a file; expected a directory",
                                               directory.string()));
}

}  // namespace

AtomicFile::AtomicFile(fs::path target, OutputPolicy policy)
    : target_(follow_link(std::move(target))), policy_(policy) {
  check_target(target_, policy_);
  create_temporary();
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  std::error_code ignored;
  if (!committed_) fs::remove(temporary_, ignored);
}

void AtomicFile::create_temporary() {
  static std::atomic<unsigned> counter{0};
  std::string extension = target_.extension().string();
  if (extension.size() > 32) extension.clear();  // a name has at most 255 bytes
  const ProcessIdentity own = ProcessIdentity::own();
  remove_leftovers(directory_of(target_), own);
  do {
    temporary_ = directory_of(target_) / fmt::format("{}{}-{}-{}{}", hidden_prefix(own.machine),
                                                     own.number, own.start, counter++, extension);
    descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);  // left behind by a killed process
  if (descriptor_ < 0)
    throw IoError(target_.string(),
                  fmt::format("cannot create a file in {}: {}", directory_of(target_).string(),
                              system_message(errno)));
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0) (void)::fchmod(descriptor_, old.st_mode & 07777);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0)
      throw IoError(target_.string(), fmt::format("cannot write: {}", system_message(errno)));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  const off_t end = ::lseek(descriptor_, 0, SEEK_CUR);
  if (end < 0 || ::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0)
    throw IoError(target_.string(), fmt::format("cannot seek: {}", system_message(errno)));
  write(bytes);
  ::lseek(descriptor_, std::max(end, static_cast<off_t>(offset + bytes.size())), SEEK_SET);
}

void AtomicFile::commit() {
  // A library that uses temporary_path() may have replaced the file, so flush the file that has the
  // name now.
  const int written = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = written >= 0 && ::fsync(written) == 0;
  const int error = errno;
  if (written >= 0) ::close(written);
  if (!flushed)
    throw IoError(target_.string(), fmt::format("cannot write: {}", system_message(error)));
  rename_to_target();
  committed_ = true;
  // The new name survives a power failure only once its directory is flushed, which some file
  // systems do not support.
  const int directory = ::open(directory_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    (void)::fsync(directory);
    ::close(directory);
  }
}

bool AtomicFile::target_holds_the_same() const {
  std::ifstream found(target_, std::ios::binary), expected(temporary_, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return found && expected && std::equal(Bytes(found), Bytes(), Bytes(expected), Bytes());
}

void AtomicFile::rename_to_target() {
  const bool replaces = policy_ == OutputPolicy::overwrite;
  const auto keep_or_refuse = [&] {
    if (policy_ != OutputPolicy::refuse_other || !target_holds_the_same())
      refuse_existing_file(target_);
    std::error_code ignored;
    fs::remove(temporary_, ignored);
  };
#ifdef RENAME_NOREPLACE
  if (!replaces) {
    if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0)
      return;
    if (errno == EEXIST) return keep_or_refuse();
    // Fallback for file systems without the flag: check, then rename.
  }
#endif
  if (!replaces && ::access(target_.c_str(), F_OK) == 0) return keep_or_refuse();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0)
    throw IoError(target_.string(), fmt::format("cannot write: {}", system_message(errno)));
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> content,
                           OutputPolicy policy) {
  AtomicFile file(path, policy);
  file.write(content);
  file.commit();
}

void write_file_atomically(const fs::path& path, std::string_view content, OutputPolicy policy) {
  write_file_atomically(path, std::as_bytes(std::span(content.data(), content.size())), policy);
}

void make_output_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error)
    throw IoError(directory.string(),
                  fmt::format("cannot create this directory ({}); expected a writable location",
                              error.message()));
  if (!std::filesystem::is_directory(directory, error))
    throw IoError(directory.string(), "is a file; expected a directory");
}

void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  for (const std::string& input : inputs)
    if (std::filesystem::equivalent(output, input, ignored))
      throw IoError(output.string(),
                    fmt::format("is the input {} of this command; choose another name, which "
                                "--force does not replace",
                                input));
}

OutputPolicy policy_to_go_on(const std::vector<std::filesystem::path>& outputs,
                             OutputPolicy policy) {
  const auto is_there = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored);
  };
  const auto missing = std::find_if_not(outputs.begin(), outputs.end(), is_there);
  const bool stopped = missing != outputs.begin() && missing != outputs.end() &&
                       std::none_of(missing, outputs.end(), is_there);
  return stopped && policy == OutputPolicy::refuse_existing ? OutputPolicy::refuse_other : policy;
}

}  // namespace tofsmith
