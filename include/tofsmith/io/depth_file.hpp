// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Depth [m], shape (H, W), NaN where nothing came back, from .npy, .npz, .exr, .pfm (metres, see
/// read_float_image()) or .png (16-bit grey, millimetres). In every format 0 means that nothing
/// came back, as depth cameras write it; so do NaN and infinity. Other values stay as they are.
/// @throws IoError if the extension is unknown or the file holds no depth image
Image<float> read_depth(const std::filesystem::path& path);

/// Writes depth [m] by extension. In .png it is rounded to millimetres and pixels that are not
/// finite become 0; the other formats hold the floats.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError if the extension is unknown, a depth does not fit into a .png (-0.0005 m to
///         65.535 m), or as AtomicFile does
void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy);

/// Multipath returns of a scene from an NPZ: `first` (H W + 1), integers; `distance_m` and `ratio`,
/// one number per return. See MultipathReturns; they are checked against the scene by its
/// validate().
/// @throws IoError naming file and array
MultipathReturns read_multipath_returns(const std::filesystem::path& path, int height, int width);

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
/// `distance_m`, `signal_e_per_s` and `ratio` of multipath returns, as
/// read_multipath_returns() takes them; `tail` (mean delay [m], ratio) if there is
/// one; `transient` (T) or (H W, T), of unit sum, with `transient_bin_m` and `transient_first_m`.
/// @throws IoError as AtomicFile does
void write_multipath_truth(const std::filesystem::path& path, const MultipathTruth& truth,
                           const SceneLight& light, OutputPolicy policy);

}  // namespace tofsmith
