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

/// Returns true if `code` names a file that contains correlation functions only.
bool names_measured_table(const std::string& code);

/// Rejects measured tables where a code is required. @throws IoError if names_measured_table(code)
void require_no_measured_table(const std::string& code);

/// Loads a code for the camera. A code with a different number of samples is resampled: switching
/// times are kept, sampled waveforms are averaged over the new samples.
/// @throws IoError as load_code(), or for a measured table
CodeSet load_camera_code(const std::string& code, const Camera& camera,
                         const CodeFileOptions& options = {});

/// Interpretation of a code file or measured table, which the file does not contain.
struct DecodingTableOptions {
  CodeFileOptions file;           ///< taps and their order
  std::optional<double> range_m;  ///< unambiguous range of a measured table [m]; none: the camera's
  std::optional<MeasuredAmbient> ambient;  ///< of a measured table; none: the file's, or equal
  std::optional<TableAxes> axes;           ///< axes of a measured table; none: (N, K) if possible
  bool keep_end_point = false;  ///< keep a last sample of a measured table that equals the first
  /// Order of the exposures in the frames, as Playback::order; empty: as in the code or table.
  std::vector<int> order;
  bool reversed = false;  ///< delay runs in the opposite direction to code, camera or table
};

/// Decoding table and information about it.
struct LoadedDecodingTable {
  std::string name;  ///< of the code or of the measured table
  DecodingTable table;
  bool is_measured = false;        ///< true for a measured table, false for a code
  std::vector<std::string> notes;  ///< warnings for the user
};

/// Loads the decoding table of a family, of a code file, or of measured correlation functions.
/// @throws IoError as load_camera_code() and read_measured_table(), or naming the file if the table
///         does not distinguish any depths
/// @throws std::invalid_argument if options for measured tables are set for a code
LoadedDecodingTable load_decoding_table(const std::string& code, const Camera& camera,
                                        const DecodingTableOptions& options = {});

/// Describes which depths cannot be distinguished, most distant pairs first; none if all can be.
std::optional<std::string> ambiguity_note(const DecodingTable& table);

}  // namespace tofsmith
