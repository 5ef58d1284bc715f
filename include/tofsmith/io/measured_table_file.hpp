// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {

/// Reads a measured impulse response: a text (is_number_table()) of times and values or of values
/// only, or an array (.npy). Times must be equally spaced; the first one becomes 0.
/// @param time_step_s  required if the file has no times
/// @throws IoError with the position of the error
ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s = std::nullopt);

/// Writes a response of kind "file" as text that read_impulse_response() reads.
void write_impulse_response(const std::filesystem::path& path, const ImpulseResponse& response,
                            OutputPolicy policy);

/// Order of the axes of an array of correlation functions.
enum class TableAxes {
  samples_first,       ///< (N, K)
  measurements_first,  ///< (K, N)
};
constexpr auto words_of(TableAxes /*any*/) { return word_list("nk", "kn"); }
/// @throws std::invalid_argument for any other word
inline TableAxes parse_table_axes(std::string_view word) {
  return parse_word<TableAxes>("axes of the table", word);
}

/// Interpretation of a measured table.
struct MeasuredTableOptions {
  TapLayout layout;               ///< of the K columns
  std::optional<TableAxes> axes;  ///< none: (N, K), or (K, N) if the shape cannot be (N, K)
  bool keep_end_point = false;    ///< keep a last sample that equals the first
};

/// Measured table, with notes for the user.
struct MeasuredTableFile {
  MeasuredTable table;
  std::vector<std::string> notes;
};

/// Returns true for a text, .npy, or an .npz with `corrfs` but neither `modfs` nor `demodfs` (which
/// would make it a code).
bool is_measured_table(const std::filesystem::path& path);

/// Reads correlation functions, N from 8 to 65536 and K up to 64, from a text (is_number_table()),
/// .npy, or `corrfs` of an .npz; see docs/measured_tables.md. An .npz may also contain `taps`, the
/// number of adjacent columns of one exposure, and `differences` = 1 for differences of two taps;
/// both override `options.layout`. A last sample that equals the first is dropped with a note,
/// unless the table is flat there. Columns are returned in the order of decoders, the taps of an
/// exposure adjacent.
/// @throws IoError for invalid or ambiguous shapes, values that are not finite, or several taps
///         without an order
MeasuredTableFile read_measured_table(const std::filesystem::path& path,
                                      const MeasuredTableOptions& options = {});

/// Reads correlation functions (N, K) from the same files; .npy may also be (N).
/// @throws IoError for values that are not finite, or if N < 8
Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path);

/// Returns true if read_correlation_functions() supports the extension.
bool is_correlation_table(const std::string& name_or_path);

/// Loads the target of a factorization, resampled to the camera: a table (is_correlation_table()),
/// or the correlation functions of a family or code file on ideal_camera().
/// @param normalize  rescale every column of a table to [0, 1]
/// @throws IoError as read_correlation_functions() and load_code()
/// @throws std::invalid_argument for normalization of a code, or a code with several taps
TargetSet load_target(const std::string& name_or_path, const Camera& camera,
                      bool normalize = false);

}  // namespace tofsmith
