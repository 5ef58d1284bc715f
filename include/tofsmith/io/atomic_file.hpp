// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// A file name for something named freely: bytes other than ASCII letters, digits, "-", "_", and
/// dots after the first byte, become %XX. Different names stay different; none leaves its
/// directory.
std::string file_name_of(std::string_view name);

/// Makes a directory for output, with those above it, where it is missing.
/// @throws IoError naming it if it cannot be made, or a file is in the way
void make_output_directory(const std::filesystem::path& directory);

/// Fails if an output is one of the files that the work reads: writing would destroy it.
/// @param inputs  paths, or names that are no files
/// @throws IoError naming the output
void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// What happens when the output file is already there. refuse_other leaves a file that holds the
/// same bytes as it is, as a run that was stopped has written it, and refuses any other.
enum class OutputPolicy { refuse_existing, refuse_other, overwrite };

/// The policy for outputs that one run writes one after the other. Where the first of them are
/// there and the others are not, a run was stopped, and the same work may go on: refuse_existing
/// becomes refuse_other.
/// @param outputs  in the order in which they are written
OutputPolicy policy_to_go_on(const std::vector<std::filesystem::path>& outputs,
                             OutputPolicy policy);

/// An output file that appears whole or not at all: everything goes to a hidden file in the same
/// directory, and commit() renames it. Without commit(), the destructor removes the hidden file
/// and what was there before stays as it was. The next process that writes there removes the hidden
/// files of processes that were killed, if it can know: on the same machine since it started, and
/// in the same container. A symbolic link as target is followed; a file that is overwritten keeps
/// its permissions.
class AtomicFile {
 public:
  /// @throws IoError naming `target` if it exists and must not be replaced, is no regular file, or
  ///         if its directory is missing or cannot be written
  AtomicFile(std::filesystem::path target, OutputPolicy policy);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The hidden file, for libraries that open files by path. It ends as the target does.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Appends bytes. @throws IoError if the disk is full or fails
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Writes bytes over those `offset` bytes from the start, and on beyond the last of them.
  /// @throws IoError as write()
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes to disk and gives the file its name. Call it once, last.
  /// @throws IoError if that fails, or if the target has appeared meanwhile and may not be replaced
  void commit();

 private:
  void create_temporary();
  void rename_to_target();
  bool target_holds_the_same() const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  OutputPolicy policy_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// Writes a whole file: afterwards `path` holds either all of the content or what it held before.
/// @throws IoError as AtomicFile does
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content,
                           OutputPolicy policy);
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           OutputPolicy policy);

}  // namespace tofsmith
