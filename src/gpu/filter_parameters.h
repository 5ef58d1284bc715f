// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the kernels of filters are told, in C++ and in OpenCL C alike, as decode_parameters.h.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// Pixels that run together in kernels of rows and columns.
enum FilterTile { tile_columns = 32, tile_rows = 8 };

/// Planes of rows of a frame with a margin all round, as FilterPlanes; and what a filter knows.
struct FilterParameters {
  int height, width;
  int stride;        ///< from row to row [floats]
  int plane_floats;  ///< from plane to plane
  int origin;        ///< of a plane's first pixel in it

  int to_coordinates, to_measurements, curve;      ///< (K, K), (K, K), (samples, K)
  int squares;                                      ///< of LightBalance (samples, 2)
  int dark_e, gain_e_per_raw, dark_raw, raw_per_e;  ///< of every measurement, as the filter has them
  int shot_share;                                   ///< of every measurement
  int samples;
  float bins_per_m;
  float lowest, highest;  ///< as SaturationLevels
  float floor_variance_e2, shot_per_signal, mean_curve_square;  ///< as HiddenSignal
  int has_own_shot_noise;
  float inverse_max_difference, same_depth_sigma2, own_light_sigma;
};

/// The test of parallelism of one window.
struct SimilarParameters {
  int light;  ///< the first plane of the set that is compared and added
  int to;     ///< that of the set that the sum goes to
  int variance_in, variance_out;
  int step, patch_reach;
  float by, expected, noise_limit;  ///< as PatchScale
  float floor_share;
};

/// One window of a round along slopes.
struct SlopeParameters {
  int light, rest, to;  ///< the first planes of sets
  int variance_in, variance_out;
  int step;
  int is_last, is_balanced;
};

/// What the noise of slopes adds, as SlopeNoise, and whether near sums were kept.
struct SlopeNoiseParameters {
  int variance, near_variance;
  float sum, sum_offset, before, before_offset;
  int is_last, has_near_share;
};

/// Pixels that come out: rows of a frame, as a decoder reads them, measurement after measurement.
struct ResultParameters {
  int light;          ///< the first plane of the set that they are in
  int measured;       ///< that of light as it was measured
  int last_variance;
  int first_row, rows;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
