// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/io/setting_value.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// One thing that varies.
struct SweepAxis {
  /// A key of the camera such as "light.peak_factor", or camera, code, exposures, method,
  /// signal_e_per_s, ambient_e_per_s, seed, trials.
  std::string key;
  std::vector<SettingValue> values;  ///< at least one
  std::string place;                 ///< where it was written, as errors name it
  bool crossed = false;              ///< with all others, even where those are zipped
};

/// How the values of several axes meet.
enum class SweepCombination {
  product,  ///< every value of one with every value of the others; the last axis varies fastest
  zip,      ///< first with first, second with second, ..; all axes are of one length
};

/// A list of depth errors to find: what stays, and what varies. As TOML:
///
///     camera = "paper-10f0"        # a built-in name, or a file beside this one
///     set = ["samples=120"]        # keys of the camera that are other than there
///     codes = ["hamiltonian-k4", "mine.code.json"]   # or code = "hamiltonian-k{exposures}"
///     method = "zncc"
///     trials = 20000               # or target_standard_error = 0.01, most_trials = 50000000
///     seed = 1
///     outlier_threshold_m = 0.5
///     combine = "product"
///
///     [[axis]]
///     key = "light.peak_factor"
///     values = [5, 10, 15]
///
///     [[axis]]
///     key = "signal_e_per_s"       # in place of the camera's operating.signal_e_per_s
///     from = 1e3
///     to = 1e5
///     count = 9                    # logarithmic; or step = 500
///
///     [[axis]]
///     key = "exposure_s"
///     file = "times.txt"           # a value a line
struct SweepSpec {
  std::string source_name;          ///< what errors call it
  std::filesystem::path directory;  ///< where relative names of cameras and codes start
  std::string camera = "paper-10f0";
  std::vector<std::string> settings;  ///< of the camera, as for load_camera()
  std::string code;                   ///< when there is no axis of that name
  EvaluateOptions options;
  SweepCombination combine = SweepCombination::product;
  std::vector<SweepAxis> axes;

  /// How many items there are; at most 2^62, beyond which they are not counted.
  std::int64_t items() const;
  /// Which value of each axis an item has.
  std::vector<std::size_t> value_indices(std::int64_t item) const;
};

/// @param source_name  the file's path, or what errors shall call the text
/// @throws IoError "file:line:column: .." for what is no TOML, unknown keys and axes (with the
///         nearest known one), empty axes, zipped axes of different lengths, ranges without end
SweepSpec parse_sweep_toml(std::string_view text, std::string_view source_name = "sweep.toml");
/// @throws IoError as parse_sweep_toml(), or if the file cannot be read
SweepSpec read_sweep_toml(const std::filesystem::path& path);

}  // namespace tofsmith
