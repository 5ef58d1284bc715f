// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// Returns the column of measurement exposure x taps + tap.
Eigen::Index column_of(int exposure, int tap, int exposures, int taps,
                       std::optional<TapOrder> order);

/// @throws IoError if the number of columns is not a multiple of the taps, or the order is required
///   but missing
int exposures_of(Eigen::Index columns, const TapLayout& layout, std::string_view file);

/// Recognizes the output of `tofsmith codes -o NAME.csv` by its column names.
bool holds_code_columns(const std::filesystem::path& path);

/// Reads one row per time sample: columns modulation_1 ... modulation_E and demodulation_1 ...
/// demodulation_K, with the taps of an exposure adjacent. Columns with two levels become binary, as
/// in parse_code_npz().
/// @throws IoError naming the file for other names or numbers of columns and for invalid values
CodeSet parse_code_csv(std::string_view text, std::string_view file, bool is_signed);

/// Per period, as for cameras.
inline constexpr Eigen::Index min_samples = 8;

/// Reads correlation functions without transposing them, from text (number_table.hpp), .npy, or the
/// array `corrfs` of an .npz.
/// @param notes  receives notes on the interpretation of a text
/// @throws IoError naming the position of a value that is not finite, or for other shapes
Eigen::MatrixXd correlation_matrix_of(const std::filesystem::path& path,
                                      std::vector<std::string>& notes);

/// Converts an array of shape (rows, columns).
/// @param place  name in error messages, such as "code.npz: modfs"
/// @throws IoError for other numbers of axes, empty axes, or values that are not finite
Eigen::MatrixXd matrix_of(const NpyArray& array, std::string_view place);
/// Accepts one axis (a single column) or two.
Eigen::MatrixXd columns_of(NpyArray array, std::string_view place);

/// @throws IoError if the file is not an array of one axis
std::vector<double> read_one_axis(const std::filesystem::path& path);

NpyArray array_of(const Eigen::MatrixXd& matrix);
NpyArray array_of(const Image<float>& image);

void add_correction(const DepthCorrection& correction, NpzArrays& arrays);

/// An array that is read in parts. Thread-safe.
struct StoredArray {
  NpyType type = NpyType::float64;
  NpyShape shape;
  /// Reads items from index `first` on, in native byte order and C order. Throws IoError.
  std::function<void(std::size_t first, std::span<std::byte> into)> read_items;
  std::size_t bytes_in_memory = 0;
};

/// @param reader  must be in C order
StoredArray stored_array(NpyReader reader);

/// Opens a data set of an HDF5 file: integers of 8 to 64 bits or floats of 16 (read as float32), 32
/// or 64 bits, in any byte order and chunking.
/// @param dataset  name with groups ("/camera/raw"); empty: "raw", or the only numeric one
/// @param max_bytes  maximum memory for a chunk, which is unpacked as a whole
/// @throws IoError if the file is damaged or not HDF5, or the data set is missing, not numeric,
///   never written or in other files
StoredArray open_hdf5(const std::filesystem::path& path, const std::string& dataset,
                      std::uint64_t max_bytes);

}  // namespace tofsmith
