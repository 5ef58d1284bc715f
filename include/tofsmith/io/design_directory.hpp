// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

struct DesignRecord {
  Camera camera;
  DesignResult result;
};

/// Directory with the output of a design, where NAME is file_name_of() of the code's name:
///   camera.toml           camera with defaults, measured responses as samples
///   design.json           design document
///   details.json          targets and iteration histories
///   codes/NAME.code.json  every candidate
///   finished/NAME.json    finished codes, reused by a run with the same inputs
class DesignDirectory {
 public:
  explicit DesignDirectory(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  bool holds_design() const;

  /// Returns a store of the finished codes of a design with these inputs. @throws IoError
  DesignStore store(const Camera& camera, const DesignOptions& options) const;
  /// @throws IoError if files exist and must not be replaced
  void write(const Camera& camera, const DesignResult& result, const DesignOptions& options,
             OutputPolicy policy) const;
  /// @throws IoError naming the file
  DesignRecord read() const;

 private:
  std::filesystem::path path_;
};

/// Writes the result of a requirement search into a directory:
///   as_it_is.code.json    best code for the unchanged camera
///   QUANTITY.code.json    for bandwidth, power and exposure: the code that meets the requirement,
///   QUANTITY.camera.toml  and the camera with the required value; omitted if not reachable
///   requirements.json     requirements_document(), written last
/// @throws IoError if files exist and must not be replaced
void write_requirements(const std::filesystem::path& directory, const Camera& camera,
                        const Requirements& found, const RequirementOptions& options,
                        OutputPolicy policy);

}  // namespace tofsmith
