// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tap_arguments.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/gpu.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::apps {

/// Table for a decoder, with the source of its range.
struct DecodingSource : LoadedDecodingTable {
  std::string range_source;  ///< source of the range, as text
  bool tell_range = false;   ///< print the range, because it may be unexpected
  std::vector<int> order;    ///< exposures of the code in the order of the table
};

/// Options for measured tables, `--range-m`, `--ambient`, `--table-axes` and `--keep-end-point`,
/// which files of tables do not contain, and for tables and codes, `--order` and `--reverse`.
class TableArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns the table of a family, a code file or measured correlation functions.
  /// @param default_camera  the user did not select a camera
  /// @throws IoError as load_decoding_table(); UsageError for a code with options of measured
  /// tables
  DecodingSource load(const std::string& code, const Camera& camera, bool default_camera,
                      const TapArguments& taps) const;

 private:
  DecodingTableOptions options_;
};

/// Option `--device`. OpenCL is loaded only if a device other than cpu is named.
class DeviceArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns the backend of the selected device.
  /// @throws UsageError if devices do not support the decoding method; IoError if the device does
  ///   not exist or fails
  std::unique_ptr<FrameBackend> backend(std::unique_ptr<const DepthDecoder> decoder) const;

 private:
  std::string name_ = "cpu";
};

/// Options for filtering raw measurements: `--filter`, `--filter-set`, `--time-filter`,
/// `--look-ahead`, `--time-filter-set`.
class FilterArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns none without `--filter`.
  /// @throws UsageError for invalid keys or values
  std::optional<FilterOptions> options() const;
  std::optional<TimeFilterOptions> time_options() const;
  std::string name() const { return std::string(strength_ ? name_of(*strength_) : "off"); }

 private:
  std::optional<FilterStrength> strength_;
  std::vector<std::string> settings_;
  int max_frames_ = 0;
  TimeFilterOptions time_options_;  ///< without max_frames
  std::vector<std::string> time_settings_;
};

}  // namespace tofsmith::apps
