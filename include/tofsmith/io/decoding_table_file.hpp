// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"

namespace tofsmith {

/// Returns true for a file with correlation functions only.
bool names_measured_table(const std::string& code);

/// Rejects a measured table. @throws IoError if names_measured_table(code)
void require_no_measured_table(const std::string& code);

/// Loads a code, resampled to the camera: switching times are kept, sampled waveforms are averaged
/// over the new samples. @throws IoError as load_code(), or for a measured table
CodeSet load_camera_code(const std::string& code, const Camera& camera,
                         const CodeFileOptions& options = {});

/// Interpretation of a code file or measured table.
struct DecodingTableOptions {
  CodeFileOptions file;
  std::optional<double> range_m;           ///< of a measured table [m]; none: the camera's
  std::optional<MeasuredAmbient> ambient;  ///< of a measured table; none: the file's, or equal
  std::optional<TableAxes> axes;
  bool keep_end_point = false;  ///< keep a last sample that equals the first (measured tables)
  /// Order of the exposures in the frames, as Playback::order; empty: as in the code or table.
  std::vector<int> order;
  bool reversed = false;  ///< delay increases in the opposite direction
};

/// A decoding table and its origin.
struct LoadedDecodingTable {
  std::string name;
  DecodingTable table;
  bool is_measured = false;
  std::vector<std::string> notes;  ///< warnings for the user
};

/// Loads the decoding table of a family, a code file or measured correlation functions.
/// @throws IoError as load_camera_code() and read_measured_table(), or if no depths can be
///         distinguished
/// @throws std::invalid_argument for options of measured tables with a code
LoadedDecodingTable load_decoding_table(const std::string& code, const Camera& camera,
                                        const DecodingTableOptions& options = {});

/// Describes the depths that cannot be distinguished, most distant pairs first.
std::optional<std::string> ambiguity_note(const DecodingTable& table);

}  // namespace tofsmith
