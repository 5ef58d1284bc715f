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

/// Whether `code` names a file that holds correlation functions only.
bool names_measured_table(const std::string& code);

/// What decoding alone takes. @throws IoError if names_measured_table(code)
void require_no_measured_table(const std::string& code);

/// The code that the camera plays. One of another number of samples is sampled anew: switching
/// times stay, sampled waveforms become means over the new samples.
/// @throws IoError as load_code(), or for a measured table
CodeSet load_camera_code(const std::string& code, const Camera& camera,
                         const CodeFileOptions& options = {});

/// What the file of a code or of a measured table does not say.
struct DecodingTableOptions {
  CodeFileOptions file;                    ///< taps and their order
  std::optional<double> range_m;           ///< depth of a measured table [m]; none: the camera's
  std::optional<MeasuredAmbient> ambient;  ///< of a measured table; none: the file's, or equal
  std::optional<TableAxes> axes;           ///< of a measured table; none: (N, K) where it can be
  bool keep_end_point = false;             ///< of a measured table, though it equals the first one
  /// Exposures of the code or table as frames have them, as Playback::order; empty: no change.
  std::vector<int> order;
  bool reversed = false;  ///< delay runs against what code, camera or table say
};

/// What a decoder decodes with.
struct LoadedDecodingTable {
  std::string name;  ///< of the code or of the measured table
  DecodingTable table;
  bool is_measured = false;        ///< a measured table, not a code
  std::vector<std::string> notes;  ///< what the user should know of it
};

/// The table of a family, of a code's file, or of measured correlation functions.
/// @throws IoError as load_camera_code() and read_measured_table(), or naming the file whose table
///         distinguishes no depths
/// @throws std::invalid_argument if a code is given what only measured tables need
LoadedDecodingTable load_decoding_table(const std::string& code, const Camera& camera,
                                        const DecodingTableOptions& options = {});

/// Which depths look the same, the farthest apart first; nothing if all can be distinguished.
std::optional<std::string> ambiguity_note(const DecodingTable& table);

}  // namespace tofsmith
