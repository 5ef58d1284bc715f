// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/decode/measured_table.hpp"
#include "tofsmith/io/code_npz.hpp"

namespace tofsmith {

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

/// Whether a file can only be a measured table: .csv, .txt, .npy, or an .npz archive with `corrfs`
/// but neither `modfs` nor `demodfs`, which make it a code. @throws IoError if it cannot be read
bool is_measured_table(const std::filesystem::path& path);

/// Reads correlation functions of any N from 8 to 65536 and K up to 64, from text (.csv, .txt), a
/// NumPy array (.npy), or the array `corrfs` of an archive (.npz). An archive may also hold lists
/// of one number per column:
///   ambient        kappa, what constant light adds, up to the same factor as corrfs
///   exposure_s     [s]
///   offset_dn      raw number without light
///   gain_e_per_dn  electrons per raw number
/// and `corrfs_se`, standard errors that decoding does not need.
/// corrfs itself is without offset, gain and exposure. A last sample that repeats the first is
/// dropped with a note, unless the table is flat there. Columns come out exposure by exposure, the
/// taps of each side by side, as decoders take measurements.
/// @throws IoError naming file and array for shapes that do not fit or could mean either
///         orientation, values that are not finite, or several taps without an order
MeasuredTableFile read_measured_table(const std::filesystem::path& path,
                                      const MeasuredTableOptions& options = {});

}  // namespace tofsmith
