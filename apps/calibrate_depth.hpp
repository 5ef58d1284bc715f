// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibrate_output.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::apps {

/// Arguments of `calibrate correlation --reference`.
struct DepthCalibrationArguments {
  std::vector<std::filesystem::path> frames;
  std::string raw_format;  ///< file; empty: .npy, .npz or .h5
  std::string dataset;     ///< dataset of .npz and .h5; empty: "raw", or the only one
  bool reference_is_z = false;
  std::string reference, table, camera_name;
  CalibrateOutput output;
  std::vector<std::string> codes;
  CodeFileOptions file;
  Camera camera;
};

/// Calibrates against reference depth, prints the result and writes the table.
/// @throws UsageError unless there is exactly one code; IoError for invalid files
void calibrate_by_reference(const DepthCalibrationArguments& arguments, const Session& session);

}  // namespace tofsmith::apps
