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

/// Converts a name to a file name: bytes other than ASCII letters, digits, "-", "_" and dots after
/// the first byte become %XX. Different names give different file names, and no name leaves its
/// directory.
std::string file_name_of(std::string_view name);

/// Creates an output directory and its missing parents.
/// @throws IoError naming the directory if it cannot be created or is a file
void make_output_directory(const std::filesystem::path& directory);

/// Checks that an output does not overwrite an input file of the run.
/// @param inputs  paths; names that are not files are ignored
/// @throws IoError naming the output
void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

/// Treatment of an output file that exists. refuse_other keeps a file with the same content, which
/// an interrupted run may have written, and rejects any other file.
enum class OutputPolicy { refuse_existing, refuse_other, overwrite };

/// Returns the policy for several outputs that one run writes in sequence. If only the first
/// outputs exist, an earlier run was interrupted and can be resumed: refuse_existing becomes
/// refuse_other.
/// @param outputs  in the order in which they are written
OutputPolicy policy_to_go_on(const std::vector<std::filesystem::path>& outputs,
                             OutputPolicy policy);

/// Output file that is either written completely or not at all. Data goes to a hidden file in the
/// same directory, which commit() renames. Without commit(), the destructor removes the hidden file
/// and an existing target stays unchanged. The next process that writes to the directory removes
/// the hidden files of killed processes, provided that they ran on the same machine since it was
/// booted and in the same container. Symbolic links are followed. A file that is overwritten keeps
/// its permissions.
class AtomicFile {
 public:
  /// @throws IoError naming `target` if it exists and must not be replaced, is not a regular file,
  ///         or if its directory is missing or not writable
  AtomicFile(std::filesystem::path target, OutputPolicy policy);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the path of the hidden file, for libraries that open files by path. Its extension is
  /// that of the target.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Appends bytes. @throws IoError if the disk is full or fails
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Overwrites bytes from position `offset` on, extending the file if necessary.
  /// @throws IoError as write()
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes);

  /// Flushes the file to disk and renames it. Must be called once, last.
  /// @throws IoError on failure, or if the target has appeared meanwhile and must not be replaced
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

/// Writes a whole file. If writing fails, `path` keeps its previous content.
/// @throws IoError as AtomicFile
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> content,
                           OutputPolicy policy);
void write_file_atomically(const std::filesystem::path& path, std::string_view content,
                           OutputPolicy policy);

}  // namespace tofsmith
