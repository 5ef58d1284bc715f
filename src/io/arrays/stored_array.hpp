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

/// An array in a file, which is read in parts. Thread-safe.
struct StoredArray {
  NpyType type = NpyType::float64;
  NpyShape shape;
  /// Reads items from index `first` on, in native byte order and C order. Throws IoError if the
  /// file cannot be read.
  std::function<void(std::size_t first, std::span<std::byte> into)> read_items;
  std::size_t bytes_in_memory = 0;  ///< memory of the reader, in addition to requested items
};

/// @param reader  must be in C order
StoredArray stored_array(NpyReader reader);

/// Opens a data set of an HDF5 file: integers of 8 to 64 bits or floats of 16 (read as float32), 32
/// or 64 bits, in any byte order and chunking, with the filters of the HDF5 library.
/// @param dataset    name with groups ("/camera/raw"); empty: the data set named "raw", or the only
///         numeric one
/// @param max_bytes  maximum memory for a chunk, which is unpacked as a whole
/// @throws IoError if the file is damaged or not HDF5, if there is no such data set (lists the
///         existing ones), or if it is not numeric, was never written or refers to other files
StoredArray open_hdf5(const std::filesystem::path& path, const std::string& dataset,
                      std::uint64_t max_bytes);

}  // namespace tofsmith
