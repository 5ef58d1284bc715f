// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/simulate/multipath_capture.hpp"

namespace tofsmith {

/// Later returns of a scene from an NPZ: `first` (H W + 1), integers; `distance_m` and `ratio`, one
/// number per return. See LaterReturns; they are checked against the scene by its validate().
/// @throws IoError naming file and array
LaterReturns read_later_returns(const std::filesystem::path& path, int height, int width);

/// Where the zero of a measured transient's time is.
enum class TransientOrigin {
  first,  ///< its first bin begins at the pixel's depth
  peak,   ///< its brightest bin (of all pixels together) is at the pixel's depth
};

/// How a file of transients is to be read.
struct TransientFileOptions {
  double bin_s = 0.0;  ///< time that one bin takes [s], > 0
  TransientOrigin origin = TransientOrigin::first;
  /// Takes the median of each histogram off as constant background; what falls below 0 is 0.
  bool subtract_median = false;
};

/// Transients from an NPY: one histogram (T) for all pixels, or (H, W, T).
/// @throws IoError naming file, what was found and what is expected; a bin that is negative or not
///         finite is named by its index
std::vector<Transient> read_transients(const std::filesystem::path& path, int height, int width,
                                       const TransientFileOptions& options);

/// The truth of every return as an NPZ: `depth_m` and `direct_e_per_s` (H, W), `first` (H W + 1),
/// `distance_m`, `signal_e_per_s` and `ratio` of later returns, as
/// read_later_returns() takes them; `tail` (mean delay [m], ratio) if there is
/// one; `transient` (T) or (H W, T), of unit sum, with `transient_bin_m` and `transient_first_m`.
/// @throws IoError as AtomicFile does
void write_returns_truth(const std::filesystem::path& path, const ReturnsTruth& truth,
                         const SceneLight& light, OutputPolicy policy);

}  // namespace tofsmith
