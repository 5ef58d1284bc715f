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

/// Replaces bytes other than ASCII letters, digits, "-", "_" and dots after the first byte by %XX.
/// Different names give different file names without directories.
std::string file_name_of(std::string_view name);

/// Creates a directory and its missing parents.
/// @throws IoError naming the directory if it cannot be created or is a file
void make_output_directory(const std::filesystem::path& directory);

/// Rejects an output that is one of the input files. @throws IoError naming the output
void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Treatment of an existing file. refuse_other keeps a file with the same content and rejects
/// others.
enum class OutputPolicy { refuse_existing, refuse_other, overwrite };

/// Returns the policy for outputs that one run writes in this order: refuse_existing becomes
/// refuse_other if only the first outputs exist, which an interrupted run has written.
OutputPolicy policy_to_go_on(const std::vector<std::filesystem::path>& outputs,
                             OutputPolicy policy);

/// Output file that is written completely or not at all: commit() renames a hidden file in the same
/// directory, which the destructor removes otherwise. The next process that writes there removes
/// hidden files of killed processes of the same machine and container. Symbolic links are followed,
/// and permissions are kept.
class AtomicFile {
 public:
  /// @throws IoError naming `target` if it exists and must not be replaced, is not a regular file,
  ///         or if its directory is not writable
  AtomicFile(std::filesystem::path target, OutputPolicy policy);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Hidden file, with the extension of the target.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Appends bytes. @throws IoError if the disk is full or fails
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Overwrites bytes from `offset` on, or extends the file. @throws IoError as write()
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes and renames the file; must be called once, last.
  /// @throws IoError also if the target has appeared and must not be replaced
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

/// Writes a whole file. @throws IoError as AtomicFile; `path` then keeps its previous content
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content,
                           OutputPolicy policy);
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           OutputPolicy policy);

}  // namespace tofsmith
