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
