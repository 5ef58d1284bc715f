// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tap_arguments.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::apps {

/// Table for a decoder, with the source of its range.
struct DecodingSource : LoadedDecodingTable {
  std::string range_source;  ///< source of the range, as text
  bool tell_range = false;   ///< the range may not be the one that the user expects
  std::vector<int> order;    ///< exposures of the code in the order of the table
};

/// What a measured table's file does not say: `--range-m`, `--ambient`, `--table-axes`,
/// `--keep-end-point`; and of codes, too, `--order` and `--reverse`.
class TableArguments {
 public:
  void add_to(CLI::App& command);
  /// The table of a family, a code's file, or measured correlation functions.
  /// @throws IoError as load_decoding_table(); UsageError if a code is given what only measured
  ///         tables need
  /// @param default_camera  nobody chose the camera
  DecodingSource load(const std::string& code, const Camera& camera, bool default_camera,
                      const TapArguments& taps) const;

 private:
  std::optional<double> range_m_;
  std::string ambient_, axes_;
  std::vector<int> order_;
  bool reversed_ = false;
  bool keep_end_point_ = false;
};

}  // namespace tofsmith::apps
