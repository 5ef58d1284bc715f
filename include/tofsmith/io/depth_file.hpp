// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Reads depth [m], shape (H, W), from .npy, .npz, .exr or .pfm (metres, see read_float_image()) or
/// .png (16-bit grey, millimetres). Pixels without a return are NaN: 0, NaN and infinity in any
/// format, as depth cameras write them. Other values are unchanged.
/// @throws IoError if the extension is unknown or the file does not contain a depth image
Image<float> read_depth(const std::filesystem::path& path);

/// Returns the kind of distance stated by the file: the array `depth_is_z` of .npz, the attribute
/// `depthKind` of .exr, the text "Depth kind" of .png. None for .npy, .pfm and files of other
/// programs.
/// @throws IoError if the file is damaged
std::optional<DepthKind> stored_depth_kind(const std::filesystem::path& path);

/// Returns the kind of distance of a depth image: as stated by the file, else as requested, else
/// `fallback`.
/// @throws IoError if the file states another kind than the requested one
DepthKind depth_kind_of(const std::filesystem::path& path, std::optional<DepthKind> requested,
                        DepthKind fallback);

/// Writes depth [m] by extension, with its kind if the format can state it. In .png, depth is
/// rounded to millimetres, and pixels that are not finite become 0; the other formats contain the
/// floats.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError as AtomicFile, if the extension is unknown, or if a depth is outside the range
///         of .png (-0.0005 m to 65.535 m)
void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy, DepthKind kind = DepthKind::radial);

/// Reads the multipath returns of a scene from an NPZ with the arrays `first` (H W + 1, integers),
/// `distance_m` and `ratio` (one number per return). MultipathReturns::validate() checks them
/// against the scene.
/// @throws IoError naming file and array
MultipathReturns read_multipath_returns(const std::filesystem::path& path, int height, int width);

/// Position of time zero in a measured transient.
enum class TransientOrigin {
  first,  ///< the first bin begins at the pixel's depth
  peak,   ///< the brightest bin of all pixels together is at the pixel's depth
};

/// Interpretation of a file of transients.
struct TransientFileOptions {
  double bin_s = 0.0;  ///< duration of one bin [s], > 0
  TransientOrigin origin = TransientOrigin::first;
  /// Subtracts the median of each histogram as constant background and clips at 0.
  bool subtract_median = false;
};

/// Reads transients from an NPY: one histogram (T) for all pixels, or (H, W, T).
/// @throws IoError naming the file, the value found and the value expected; with the index of a bin
///         that is negative or not finite
std::vector<Transient> read_transients(const std::filesystem::path& path, int height, int width,
                                       const TransientFileOptions& options);

/// Writes the ground truth of all returns as an NPZ: `depth_m` and `direct_e_per_s` (H, W); `first`
/// (H W + 1), `distance_m`, `signal_e_per_s` and `ratio` of the multipath returns, as read by
/// read_multipath_returns(); optionally `tail` (mean delay [m], ratio); and `transient` (T) or (H,
/// W, T) with unit sum, `transient_bin_m` and `transient_first_m`.
/// @throws IoError as AtomicFile
void write_multipath_truth(const std::filesystem::path& path, const MultipathTruth& truth,
                           const SceneLight& light, OutputPolicy policy);

}  // namespace tofsmith
