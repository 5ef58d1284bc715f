// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paper/paper.hpp"

namespace tofsmith {

/// The output of `tofsmith reproduce`:
///   index.html                   every statement with its verdict, and the way to each page
///   NAME/index.html              one figure's page
///   NAME/data.npz, NAME/..       its numbers
///   NAME/findings.json           statements and verdicts; written last, so that where it is, the
///                                figure is finished and need not be made again
///   codes/NAME.code.json         the codes that figures share
class ReproductionDirectory {
 public:
  explicit ReproductionDirectory(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path shelf() const { return path_ / "codes"; }

  /// Refuses a directory whose pages were made by something else, or with other options, before
  /// they would be replaced. What another version made may be.
  /// @throws IoError naming the file
  void require_ours(const ReproduceOptions& options) const;

  /// The findings of an item that was finished with the same options by this version; none if it
  /// was not, or its file is damaged.
  std::optional<std::vector<CheckedStatement>> finished(const PaperItem& item,
                                                        const ReproduceOptions& options) const;

  /// Writes an item, its findings last. @throws IoError
  void write(const PaperItem& item, const Reproduction& reproduction,
             const ReproduceOptions& options) const;

  /// Writes the index over all items that are finished. @throws IoError
  void write_index(const ReproduceOptions& options) const;

 private:
  std::filesystem::path path_;
};

/// What became of one item of reproduce().
struct ReproducedItem {
  const PaperItem* item = nullptr;
  std::vector<CheckedStatement> findings;
  bool kept = false;  ///< it was finished before
};

/// The items of these names, in that order; "all" is every item of the paper.
/// @throws std::invalid_argument with the nearest name there is
std::vector<const PaperItem*> paper_items_named(std::span<const std::string> names);

/// Makes the items of the paper that are not finished in `directory`, and its index.
/// @param again  make those too that are finished, and replace pages that something else made
/// @throws IoError if the directory cannot be written, or holds pages of something else;
///         Interrupted, then finished items are kept
std::vector<ReproducedItem> reproduce(const ReproductionDirectory& directory,
                                      std::span<const PaperItem* const> items,
                                      const ReproduceOptions& options, bool again,
                                      const Progress& progress = {});

}  // namespace tofsmith
