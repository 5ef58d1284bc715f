// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tap_arguments.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith::apps {

/// What a decoder decodes with.
struct DecodingSource {
  std::string name;  ///< of the code or of the measured table
  DecodingTable table;
  std::string range_source;        ///< what the range is taken from, for people
  bool tell_range = false;         ///< the range could be another than the user thinks
  std::vector<std::string> notes;  ///< what the user should know of it

  /// "range 9.993 m (of the default camera ..)".
  std::string range_line() const;
};

/// What a measured table's file does not say: `--range-m`, `--ambient`, `--table-axes`,
/// `--keep-end-point`.
class TableArguments {
 public:
  void add_to(CLI::App& command);
  /// The table of a family, a code's file, or measured correlation functions.
  /// @throws IoError as load_code() and read_measured_table(), or naming the file whose table tells
  ///         no depths apart; UsageError if a code is given what only measured tables need
  /// @param default_camera  nobody chose the camera
  DecodingSource load(const std::string& code, const Camera& camera, bool default_camera,
                      const TapArguments& taps) const;

 private:
  DecodingSource load_measured(const std::string& path, const Camera& camera,
                               const TapArguments& taps) const;

  std::optional<double> range_m_;
  std::string ambient_, axes_;
  bool keep_end_point_ = false;
};

/// Which depths look the same, the farthest apart first; nothing if all can be told apart.
std::optional<std::string> ambiguity_note(const DecodingTable& table);

}  // namespace tofsmith::apps
