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
/// alone, or a one-dimensional NumPy array (.npy). Times must be equally spaced; the first
/// one is when the response starts and is taken for 0.
/// @param time_step_s  needed unless the file has times, with which it must agree
/// @throws IoError naming the file and the place for whatever does not fit
ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s = std::nullopt);

/// Writes a response of kind "file" as text with the columns time_s and value, as read above.
/// @throws IoError as AtomicFile does
void write_impulse_response(const std::filesystem::path& path, const ImpulseResponse& response,
                            OutputPolicy policy);

/// Which axis of an array of correlation functions is depth.
enum class TableAxes {
  samples_first,       ///< (N, K)
  measurements_first,  ///< (K, N)
};

/// "nk" or "kn". @throws std::invalid_argument for any other word
TableAxes parse_table_axes(std::string_view word);

/// What the file of a measured table does not say.
struct MeasuredTableOptions {
  TapLayout layout;               ///< how the K columns run through the taps
  std::optional<TableAxes> axes;  ///< none: (N, K), or (K, N) where it cannot be (N, K)
  bool keep_end_point = false;    ///< a last sample that equals the first is one of its own
};

/// What was read, and what the user should know of how.
struct MeasuredTableFile {
  MeasuredTable table;
  std::vector<std::string> notes;
};

/// Returns whether a file can only be a measured table: a text, .npy, or an .npz archive with
/// `corrfs` but neither `modfs` nor `demodfs`, which make it a code. @throws IoError if it cannot
/// be read
bool is_measured_table(const std::filesystem::path& path);

/// Reads correlation functions of any N from 8 to 65536 and K up to 64, from a text
/// (is_number_table()), a NumPy array (.npy), or the array `corrfs` of an archive (.npz). An
/// archive may also hold lists of one number per column:
///   ambient        kappa, what constant light adds, up to the same factor as corrfs
///   exposure_s     [s]
///   offset_dn      raw number without light
///   gain_e_per_dn  electrons per raw number
/// and `corrfs_se`, standard errors that decoding does not need. Of calibrated functions, it also
/// says what `taps` stand side by side in its columns, and by `differences` = 1 that they are
/// differences of two taps; what `options` say of taps then does not count.
/// corrfs itself is without offset, gain and exposure. A last sample that repeats the first is
/// dropped with a note, unless the table is flat there. Columns come out exposure by exposure, the
/// taps of each side by side, as decoders take measurements.
/// @throws IoError naming file and array for shapes that do not fit or could mean either
///         orientation, values that are not finite, or several taps without an order
MeasuredTableFile read_measured_table(const std::filesystem::path& path,
                                      const MeasuredTableOptions& options = {});

/// Reads correlation functions, sampled on one period with the end point left out, as (N, K):
/// text (is_number_table()) with K columns, a NumPy array (.npy) of shape (N, K) or (N,), or the
/// array `corrfs` of an archive (.npz).
/// @throws IoError naming the place for values that are not finite, or N < 8
Eigen::MatrixXd read_correlation_functions(const std::filesystem::path& path);

/// Whether a target is named by a file that read_correlation_functions() reads, by its extension.
bool is_correlation_table(const std::string& name_or_path);

/// What `--target` names, as correlation functions to factorize on the camera's samples: a table
/// (is_correlation_table()), else a family or a code file,
/// whose ideal correlation functions are meant (ideal_camera()).
/// @param normalize  of a table: rescale every column to [0, 1]
/// @throws IoError as read_correlation_functions() and load_code(); std::invalid_argument for a
///         code that is to be normalized, or one of several taps
TargetSet load_target(const std::string& name_or_path, const Camera& camera,
                      bool normalize = false);

}  // namespace tofsmith
