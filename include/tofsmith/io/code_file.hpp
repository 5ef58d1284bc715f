// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_json.hpp"
#include "tofsmith/io/code_npz.hpp"

namespace tofsmith {

/// What load_code() must be told about NPZ files with several taps.
struct CodeFileOptions {
  std::optional<int> taps;            ///< values read out of one exposure; none = as the camera's
  std::optional<TapOrder> tap_order;  ///< never guessed
};

/// Reads a code by extension: .json or .npz. `layout` is for .npz; .json says it itself.
/// @throws IoError as parse_code_json() and parse_code_npz(), or if the file cannot be read
CodeSet read_code(const std::filesystem::path& path, const TapLayout& layout = {});

/// Writes a code by extension: .json or .npz. `order` is for .npz.
/// @throws IoError as AtomicFile, std::invalid_argument as code_to_json(), serialize_code_npz()
void write_code(const std::filesystem::path& path, const CodeSet& code, OutputPolicy policy,
                std::optional<TapOrder> order = std::nullopt);

/// A built-in family, built for the camera, or a code from a file as it is there.
/// @throws IoError as read_code(), or if `name_or_path` is neither;
///         std::invalid_argument for a family that the camera cannot play
CodeSet load_code(const std::string& name_or_path, const Camera& camera,
                  const CodeFileOptions& options = {});

/// "blocked" or "interleaved". @throws std::invalid_argument for any other word
TapOrder parse_tap_order(std::string_view word);

}  // namespace tofsmith
