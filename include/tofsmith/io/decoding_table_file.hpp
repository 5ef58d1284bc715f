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
  std::optional<double> range_m;
  std::optional<MeasuredAmbient> ambient;
  std::optional<TableAxes> axes;
  bool keep_end_point = false;
  std::vector<int> order;  ///< as Playback::order
  bool reversed = false;
};
auto fields_of(ConstOrNot<DecodingTableOptions> auto& o) {
  return std::tuple(
      Field("file", o.file, FieldMark::apart),
      Field("range_m", o.range_m, left_open(0, 1e6), Help{"unambiguous range of a measured table"},
            IfAbsent{"the camera's"}),
      Field("ambient", o.ambient,
            Help{"ambient light in the columns of a measured table: equal in all columns, "
                 "proportional to the mean of each column, or none"},
            IfAbsent{"as in the file, otherwise equal"}),
      Field("axes", o.axes,
            Help{"axes of a measured table: samples x measurements (nk) or measurements x samples "
                 "(kn)"},
            IfAbsent{"nk, or kn if only kn fits; required if both fit and N <= K"}),
      Field("keep_end_point", o.keep_end_point,
            Help{"keep the last sample of a measured table even if it equals the first"}),
      Field("order", o.order, Help{"order of the code's exposures in the frames, such as 0,3,2,1"},
            IfAbsent{"the camera's playback.order, otherwise ascending"}),
      Field("reversed", o.reversed,
            Help{"reverse the direction of delay, for frames in which near and far are swapped"}));
}

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
