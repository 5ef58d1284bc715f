// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "tofsmith/io/npy.hpp"

namespace tofsmith {

/// An array that lies in a file and is read in parts, from many threads at once.
struct StoredArray {
  NpyType type = NpyType::float64;
  NpyShape shape;
  /// Fills `into` with items of this machine's byte order from item `first` on, in C order.
  /// Throws IoError if the file cannot be read.
  std::function<void(std::size_t first, std::span<std::byte> into)> read_items;
  std::size_t bytes_in_memory = 0;  ///< what the reader holds beside what it is asked for
};

/// @param reader  of a file in C order
StoredArray stored_array(NpyReader reader);

/// A data set of an HDF5 file: whole numbers of 8 to 64 bits or floats of 16 (read as float32), 32
/// or 64 bits, in any byte order and chunks, with the filters that the HDF5 library has.
/// @param dataset    its name, with groups ("/camera/raw"); empty: the one called "raw", or the
/// only
///                   one of numbers
/// @param max_bytes  most memory for a chunk, which is unpacked as a whole
/// @throws IoError if the file is no HDF5 or damaged, there is no such data set (says which there
///         are), it holds other things than numbers, was never written or lies in other files
StoredArray open_hdf5(const std::filesystem::path& path, const std::string& dataset,
                      std::uint64_t max_bytes);

}  // namespace tofsmith
