// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "decode/filter/filter_kernel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Work space of one strip at a time.
struct StripBuffers {
  std::vector<float> weight, shifted, scratch;

  PairWeights weights(const FilterGrid& grid, const FilterStrip& strip, bool with_shifts);
};

/// Buffers that strips take and give back, so that there are as many as strips at work.
class StripBufferPool {
 public:
  std::unique_ptr<StripBuffers> take();
  void give_back(std::unique_ptr<StripBuffers> buffers);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<StripBuffers>> free_;
};

/// All that is known of the pixels of a frame while it is filtered. `light` has two sets of K
/// planes: coordinates of the measurements without dark electrons [e], of which the first `rank`
/// are those of the decoding plane. Light as it was measured is read anew where it is asked for.
struct FilterPlanes {
  enum Scalar {
    usable,    ///< 1 where neighbours may take a pixel's light, along slopes if it has a depth
    variance,  ///< of a coordinate, as measured [e^2]; then of two steps of filtering
    variance_next,
    variance_last,
    energy,         ///< of SimilarityTest; then slope_x
    inverse_sigma,  ///< of SimilarityTest; then slope_y
    depth,          ///< found before [bin]
    depth_variance,
    signal,       ///< along the depth found before [e/s]; at the end, of find_own_light()
    signal_next,  ///< at the end, of find_own_amplitude()
    shift,        ///< of signal_next beyond the slope [e/s bin]; at the end, of find_lit_share()
    scalars
  };

  static constexpr int light_sets = 2;

  FilterGrid grid;
  int measurements = 0;
  std::vector<float> storage;
  Image<float>
      averaged;  ///< along slopes: variance of a coordinate that depth was found from [e^2]
  std::vector<std::ptrdiff_t> lit_points;  ///< lit_bar_points() as offsets in the grid [floats]
  NoiseRatios noise;                       ///< of the filtered numbers
  const std::uint8_t* left_out = nullptr;  ///< of the frame under way, (H, W), or null
  int result = 0;                          ///< the set of `light` that holds raw numbers at the end
  StripBufferPool buffers;

  static FilterGrid grid_of(int height, int width, int largest_step);
  static std::size_t floats(const FilterGrid& grid, int measurements);
  /// Makes room for a frame; keeps what there is if it fits.
  void resize(int height, int width, int measurements_, int largest_step);
  float* plane(int index) { return storage.data() + index * grid.plane_floats() + grid.origin(); }
  const float* plane(int index) const { return const_cast<FilterPlanes*>(this)->plane(index); }
  float* scalar(Scalar which) { return plane(which); }
  float* light(int set, int k) { return plane(scalars + set * measurements + k); }
  const float* light(int set, int k) const { return plane(scalars + set * measurements + k); }
};

}  // namespace tofsmith
