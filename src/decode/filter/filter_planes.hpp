// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/filter/filter_kernel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Estimates the signal from its contrast if subtracted buckets hide the light. A signal S with
/// variance f + S m in each of `rank` coordinates yields <|u|^2> = S^2 <p^2> + rank (f + S m). For
/// averages of n measurements, f and m are n times smaller.
struct HiddenSignal {
  HiddenSignal(const ExpectedNoise& noise, const AmbientProjection& projection)
      : rank(static_cast<float>(projection.rank())),
        mean_curve_square(static_cast<float>(projection.curve.rowwise().squaredNorm().mean())) {
    const Eigen::VectorXd share =
        projection.basis.rowwise().squaredNorm() / static_cast<double>(projection.rank());
    shot_share.assign(share.begin(), share.end());
    floor_variance_e2 =
        static_cast<float>(std::max(min_variance_e2, share.dot(noise.floor_variance_e2)));
    shot_per_signal = static_cast<float>((noise.shot_gated * share).mean());
  }

  /// Returns S [e/s] for |u|^2 = `squares` [e^2].
  float of(float squares, float averaged) const {
    const float per_mean = rank / averaged;
    const float m = per_mean * shot_per_signal;
    const float beyond = std::max(0.0f, squares - per_mean * floor_variance_e2);
    return (std::sqrt(m * m + 4 * mean_curve_square * beyond) - m) / (2 * mean_curve_square);
  }

  float rank = 0.0f;
  std::vector<float> shot_share;   ///< mean share of a measurement in a coordinate's variance (K)
  float floor_variance_e2 = 0.0f;  ///< f
  float shot_per_signal = 0.0f;    ///< m, averaged over all depths
  float mean_curve_square = 0.0f;  ///< <p^2>, averaged over all depths
};

struct StripBuffers {
  std::vector<float> weight, shifted, scratch;

  PairWeights weights(const FilterGrid& grid, const FilterStrip& strip, bool with_shifts);
};

class StripBufferPool {
 public:
  std::unique_ptr<StripBuffers> take();
  void give_back(std::unique_ptr<StripBuffers> buffers);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<StripBuffers>> free_;
};

/// Pixels of a frame during filtering. `light` has two sets of K planes with coordinates of the
/// measurements without dark electrons [e]; the first `rank` coordinates span the decoding
/// subspace. The original measurements are read again from the raw frame.
struct FilterPlanes {
  enum Scalar {
    usable,    ///< 1 if neighbours may use a pixel's light (along slopes, if it has a depth)
    variance,  ///< of a coordinate [e^2]; later of intermediate results
    variance_next,
    variance_last,
    energy,         ///< of SimilarityTest; then slope_x
    inverse_sigma,  ///< of SimilarityTest; then slope_y
    depth,          ///< from the previous pass [bin]
    depth_variance,
    signal,       ///< along the previous depth [e/s]; at the end, from find_own_light()
    signal_next,  ///< at the end, from find_own_amplitude()
    shift,        ///< of signal_next beyond the slope [e/s bin]; at the end, from find_lit_share()
    rejected,     ///< share of the nearest neighbours, in the last pass along slopes
    scalars
  };

  static constexpr int light_sets = 2;

  FilterGrid grid;
  int measurements = 0;
  std::vector<float> storage;
  Image<float>
      averaged;  ///< along slopes: variance of a coordinate that determined the depth [e^2]
  Image<float> deviation_factor;           ///< empty without passes along slopes
  std::vector<std::ptrdiff_t> lit_points;  ///< lit_bar_points() as offsets [floats]
  NoiseRatios noise;
  const std::uint8_t* left_out = nullptr;  ///< (H, W), or null
  int result = 0;                          ///< set of `light` with the result
  StripBufferPool buffers;

  static FilterGrid grid_of(int height, int width, int largest_step);
  static std::size_t floats(const FilterGrid& grid, int measurements);
  void resize(int height, int width, int measurements_, int largest_step);
  void reserve_deviation_factors(bool are_wanted);
  float* plane(int index) { return storage.data() + index * grid.plane_floats() + grid.origin(); }
  const float* plane(int index) const { return const_cast<FilterPlanes*>(this)->plane(index); }
  float* scalar(Scalar which) { return plane(which); }
  float* light(int set, int k) { return plane(scalars + set * measurements + k); }
  const float* light(int set, int k) const { return plane(scalars + set * measurements + k); }
  /// Lists the first `count` planes of a set of light from offset `at` on.
  template <typename List>
  void list_light(int set, int count, List& planes, std::ptrdiff_t at = 0) {
    for (int k = 0; k < count; ++k) planes[static_cast<std::size_t>(k)] = light(set, k) + at;
  }
};

}  // namespace tofsmith
