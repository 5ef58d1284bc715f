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
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith {

/// Reads a measured impulse response: a text (is_number_table()) of times and values or of values
/// only, or a one-dimensional NumPy array (.npy). Times must be equally spaced. The first time is
/// the start of the response and becomes 0.
/// @param time_step_s  required if the file has no times, and must agree with them otherwise
/// @throws IoError naming the file and the position of the error
ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s = std::nullopt);

/// Writes a response of kind "file" as text with the columns time_s and value, for
/// read_impulse_response().
/// @throws IoError as AtomicFile
void write_impulse_response(const std::filesystem::path& path, const ImpulseResponse& response,
                            OutputPolicy policy);

/// Order of the axes of an array of correlation functions.
enum class TableAxes {
  samples_first,       ///< (N, K)
  measurements_first,  ///< (K, N)
};

/// Parses "nk" or "kn". @throws std::invalid_argument for any other word
TableAxes parse_table_axes(std::string_view word);

/// Interpretation of a measured table, which the file does not contain.
struct MeasuredTableOptions {
  TapLayout layout;               ///< order of the taps in the K columns
  std::optional<TableAxes> axes;  ///< none: (N, K), or (K, N) if the shape cannot be (N, K)
  bool keep_end_point = false;    ///< keep a last sample that equals the first
};

/// Measured table, with notes for the user on its interpretation.
struct MeasuredTableFile {
  MeasuredTable table;
  std::vector<std::string> notes;
};

/// Returns true for files that can only be a measured table: a text, .npy, or an .npz archive with
/// `corrfs` but neither `modfs` nor `demodfs` (which would make it a code).
/// @throws IoError if the file cannot be read
bool is_measured_table(const std::filesystem::path& path);

/// Reads correlation functions with N from 8 to 65536 and K up to 64, from a text
/// (is_number_table()), a NumPy array (.npy), or the array `corrfs` of an archive (.npz), without
/// offset, gain and exposure. An archive may also contain lists of one number per column:
///   ambient        kappa, the response to constant light, in the same scale as corrfs
///   exposure_s     [s]
///   offset_dn      raw number without light
///   gain_e_per_dn  electrons per raw number
/// and `corrfs_se`, the standard errors, which decoding does not use. In files of calibrated
/// functions, `taps` is the number of adjacent columns that belong to one exposure, and
/// `differences` = 1 means that columns are differences of two taps; both override
/// `options.layout`. A last sample that equals the first is dropped with a note, unless the table
/// is flat there. Columns are returned exposure by exposure with the taps of each adjacent, the
/// order of measurements in decoders.
/// @throws IoError naming file and array for invalid or ambiguous shapes, values that are not
///         finite, or several taps without an order
MeasuredTableFile read_measured_table(const std::filesystem::path& path,
                                      const MeasuredTableOptions& options = {});

/// Reads correlation functions, sampled on one period without its end point, as (N, K): a text
/// (is_number_table()) with K columns, a NumPy array (.npy) of shape (N, K) or (N,), or the array
/// `corrfs` of an archive (.npz).
/// @throws IoError naming the position of values that are not finite, or if N < 8
Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path);

/// Returns true if read_correlation_functions() supports the extension of a target's name.
bool is_correlation_table(const std::string& name_or_path);

/// Loads the correlation functions for `--target`, resampled to the camera, as the target of a
/// factorization: a table (is_correlation_table()), or the ideal correlation functions
/// (ideal_camera()) of a family or code file.
/// @param normalize  rescale every column to [0, 1]; for tables only
/// @throws IoError as read_correlation_functions() and load_code()
/// @throws std::invalid_argument for normalization of a code, or a code with several taps
TargetSet load_target(const std::string& name_or_path, const Camera& camera,
                      bool normalize = false);

}  // namespace tofsmith
