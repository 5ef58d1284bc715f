// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/words.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Returns the extension of a depth image in lower case.
/// @throws IoError if read_depth() and write_depth() do not support it
std::string depth_extension(const std::filesystem::path& path);

/// Reads depth [m], (H, W), from .npy, .npz, .exr or .pfm (metres, see read_float_image()) or .png
/// (16-bit grey, millimetres). 0 and infinity become NaN (no return).
/// @throws IoError if the file is not such an image
Image<float> read_depth(const std::filesystem::path& path);

/// Returns the kind of distance that the file specifies: the array `depth_is_z` of .npz, the
/// attribute `depthKind` of .exr or the text "Depth kind" of .png; none in other files.
std::optional<DepthKind> stored_depth_kind(const std::filesystem::path& path);

/// Returns the kind that the file specifies, else the requested one, else `fallback`.
/// @throws IoError if the file specifies another kind than the requested one
DepthKind depth_kind_of(const std::filesystem::path& path, std::optional<DepthKind> requested,
                        DepthKind fallback);

/// Writes depth [m] by extension, with its kind if the format supports it. In .png, depth is
/// rounded to millimetres, and 0 if it is not finite.
/// @throws std::invalid_argument if the image is empty
/// @throws IoError also if a depth is outside the range of .png (-0.0005 m to 65.535 m)
void write_depth(const std::filesystem::path& path, const Image<float>& depth_m,
                 OutputPolicy policy, DepthKind kind = DepthKind::radial);

/// Reads multipath returns from an NPZ with the arrays `first` (H W + 1, integers), `distance_m`
/// and `ratio` (one number per return). They are not compared with a scene.
/// @throws IoError naming file and array
MultipathReturns read_multipath_returns(const std::filesystem::path& path, int height, int width);

/// Position of time zero in a measured transient.
enum class TransientOrigin {
  first,  ///< the first bin begins at the pixel's depth
  peak,   ///< the brightest bin of all pixels together is at the pixel's depth
};
constexpr auto words_of(TransientOrigin /*any*/) { return word_list("first", "peak"); }

/// Background that is subtracted from each histogram, which is clipped at 0.
enum class TransientBackground { none, median };
constexpr auto words_of(TransientBackground /*any*/) { return word_list("none", "median"); }

/// Interpretation of transients.
struct TransientFileOptions {
  double bin_s = 0.0;
  TransientOrigin origin = TransientOrigin::first;
  TransientBackground background = TransientBackground::none;
};
auto fields_of(ConstOrNot<TransientFileOptions> auto& o) {
  return std::tuple(
      Field("bin_s", o.bin_s, above(0), Help{"duration of one bin of the histograms"}),
      Field("origin", o.origin, Help{"bin at the depth of the pixel: the first one, or the peak"}),
      Field("background", o.background,
            Help{"constant background to subtract from each histogram before use"}));
}

/// Reads transients from an NPY: one histogram (T) for all pixels, or (H, W, T).
/// @throws IoError for another shape, or with the index of a bin that is negative or not finite
std::vector<Transient> read_transients(const std::filesystem::path& path, int height, int width,
                                       const TransientFileOptions& options);

/// Writes all returns as an NPZ: `depth_m` and `direct_e_per_s` (H, W); `first`, `distance_m`,
/// `signal_e_per_s` and `ratio` for read_multipath_returns(); optionally `tail` (mean delay [m],
/// ratio); and `transient` (T) or (H, W, T) with unit sum, `transient_bin_m` and
/// `transient_first_m`.
void write_multipath_truth(const std::filesystem::path& path, const MultipathTruth& truth,
                           const SceneLight& light, OutputPolicy policy);

}  // namespace tofsmith
