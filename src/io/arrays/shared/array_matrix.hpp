// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string_view>

#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Column of measurement exposure x taps + tap.
Eigen::Index column_of(int exposure, int tap, int exposures, int taps,
                       std::optional<TapOrder> order);

/// How many exposures the columns hold.
/// @throws IoError if they are no multiple of the taps, or hold several in an order that is not
/// given
int exposures_of(Eigen::Index columns, const TapLayout& layout, std::string_view file);

/// Whether a text has columns of waveforms in its first row, as `tofsmith codes -o NAME.csv`
/// writes them.
bool holds_code_columns(const std::filesystem::path& path);

/// A code from such a text: a row for every time sample, columns modulation_1 .. modulation_E and
/// demodulation_1 .. demodulation_K, all taps of an exposure one after another. Columns of two
/// levels become binary, as in parse_code_npz().
/// @throws IoError naming the file for columns of other names or numbers, and values that no code
///         can have
CodeSet parse_code_csv(std::string_view text, std::string_view file, bool is_signed);

/// Fewest samples of a period, as of a camera.
inline constexpr Eigen::Index min_samples = 8;

/// The matrix of correlation functions in a file as it stands there: text (number_table.hpp), a
/// NumPy array (.npy), or the array `corrfs` of an archive (.npz).
/// @param notes  receives how a text was interpreted
/// @throws IoError naming the place for another shape or a value that is not finite
Eigen::MatrixXd correlation_matrix_of(const std::filesystem::path& path,
                                      std::vector<std::string>& notes);

/// An array of shape (rows, columns) as a matrix.
/// @param place  what errors call it, such as "code.npz: modfs"
/// @throws IoError if it has another number of axes, an empty one, or a value that is not finite
Eigen::MatrixXd matrix_of(const NpyArray& array, std::string_view place);
/// The same of one or two axes; a single one is a column.
Eigen::MatrixXd columns_of(NpyArray array, std::string_view place);

/// The matrix as a float64 array of shape (rows, columns).
NpyArray array_of(const Eigen::MatrixXd& matrix);

}  // namespace tofsmith
