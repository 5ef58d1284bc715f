// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <system_error>
#include <utility>

namespace tofsmith::apps {

/// Removes a newly created directory if the work fails before any file is written. Construct it
/// before the DesignDirectory.
class FreshDirectory {
 public:
  explicit FreshDirectory(std::filesystem::path path)
      : path_(std::move(path)), fresh_(!std::filesystem::exists(path_, ignored_)) {}
  ~FreshDirectory() {
    if (!fresh_) return;
    // Removes empty directories only.
    for (const auto& directory : {path_ / "finished", path_ / "codes", path_})
      std::filesystem::remove(directory, ignored_);
  }
  FreshDirectory(const FreshDirectory&) = delete;
  FreshDirectory& operator=(const FreshDirectory&) = delete;

 private:
  std::error_code ignored_;
  std::filesystem::path path_;
  bool fresh_;
};

}  // namespace tofsmith::apps
