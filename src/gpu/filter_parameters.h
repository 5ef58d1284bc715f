// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Parameters of filter kernels, see decode_parameters.h.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// Work group of two-dimensional kernels [pixels].
enum FilterTile { tile_columns = 32, tile_rows = 8 };

struct FilterParameters {
  int height, width;
  int stride;        ///< between rows [floats]
  int plane_floats;  ///< between planes
  int origin;        ///< offset of the first pixel in a plane

  int to_coordinates, to_measurements, curve;       ///< (K, K), (K, K), (samples, K)
  int squares;                                      ///< of LightBalance (samples, 2)
  int dark_e, gain_e_per_raw, dark_raw, raw_per_e;  ///< per measurement, as in the filter
  int shot_share;                                   ///< per measurement
  int samples;
  float bins_per_m;
  float lowest, highest;                                        ///< see SaturationLevels
  float floor_variance_e2, shot_per_signal, mean_curve_square;  ///< see HiddenSignal
  int has_own_shot_noise;
  float inverse_max_difference, same_depth_sigma2, own_light_sigma;
};

/// One window of the parallelism test.
struct SimilarParameters {
  int light;  ///< first plane of the compared light set
  int to;     ///< first plane of the resulting light set
  int variance_in, variance_out;
  int step, patch_reach;
  float by, expected, noise_limit;  ///< see PatchScale
  float floor_share;
  float bias_share, bias_by_noise;  ///< see BiasBound
};

/// One window of a round along slopes.
struct SlopeParameters {
  int light, rest, to;  ///< first planes of light sets
  int variance_in, variance_out;
  int step;
  int is_last, is_balanced;
};

/// Variance added by the noise of slopes, see SlopeNoise.
struct SlopeNoiseParameters {
  int variance, near_variance;
  float sum, sum_offset, before, before_offset;
  int is_last, has_near_share;
};

struct ResultParameters {
  int light;     ///< first plane of the resulting light set
  int measured;  ///< first plane of the measured light set
  int last_variance;
  int first_row, rows;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
