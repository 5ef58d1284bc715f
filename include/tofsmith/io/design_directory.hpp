// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// What a directory of `tofsmith design` holds.
struct DesignRecord {
  Camera camera;
  DesignResult result;
};

/// The output of a design as files:
///   camera.toml              the camera, defaults filled in, measured responses as samples
///   design.json              the design document
///   details.json             targets and iteration histories, for reports
///   codes/NAME.code.json     every candidate
///   finished/NAME.json       designed codes as they are finished; a later run with the same
///                            camera, target, options and seed takes them from here; one that is
///                            damaged is designed again
/// NAME is file_name_of() the code's name.
class DesignDirectory {
 public:
  explicit DesignDirectory(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  bool holds_design() const;

  /// Keeps finished codes of one design, whose inputs `camera` and `options` are. Creates the
  /// directory if need be. @throws IoError
  DesignStore store(const Camera& camera, const DesignOptions& options) const;
  /// @throws IoError if files exist and may not be replaced, or cannot be written
  void write(const Camera& camera, const DesignResult& result, const DesignOptions& options,
             OutputPolicy policy) const;
  /// @throws IoError naming the file and what is wrong with it
  DesignRecord read() const;

 private:
  std::filesystem::path path_;
};

/// What requirements found as files:
///   as_it_is.code.json    the code that the camera does best with as it is
///   QUANTITY.code.json    of bandwidth, power and exposure: the code that suffices,
///   QUANTITY.camera.toml  and the camera with as much of it; neither where nothing suffices
///   requirements.json     requirements_document(), last
/// @throws IoError if files exist and may not be replaced, or cannot be written
void write_requirements(const std::filesystem::path& directory, const Camera& camera,
                        const Requirements& found, const RequirementOptions& options,
                        OutputPolicy policy);

}  // namespace tofsmith
