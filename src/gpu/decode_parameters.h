// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Parameters of kernels, shared by C++ and OpenCL C. All members have 4 bytes. An `int` with a
// plural name is an offset in the table memory, in words of 4 bytes; -1: no table.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

enum RawNumber {
  raw_float,
  raw_uint16,
  raw_uint8,
  raw_rounded,  ///< doubles rounded to floats
  raw_double    ///< only for means
};

/// Number k of pixel i is at i pixel_stride + k measurement_stride.
struct TileParameters {
  int pixels;
  int pixel_stride;
  int measurement_stride;
  int number;  ///< RawNumber
};

/// See ProjectionView.
struct ProjectionParameters {
  int ratios, weights, offsets, errors_of_difference;
  int errors_of_rounding;  ///< relative rounding error of doubles; multiplied by |raw|
  int reference;
  float error_of_reference, error_of_offset;
};

enum SearchWay { by_arcs, by_angle, by_cells };

/// See BinMatcher and its search classes.
struct MatchParameters {
  struct ProjectionParameters projection;
  int way;  ///< SearchWay
  int samples;

  int rows, row_blocks, windows, window_count, window_radii, bins_of_rows;  ///< see ArcTable
  float lead, tie;                                                          ///< see Margins

  int pieces, resolution;  ///< see CircleSearch
  float margin, overlap;

  int root_bits, cut_bits, roots, cells, lists, directions, steps, units, bins;  ///< CellSearchView
  float fit_unit, slack_unit, steepest_fit, rounding, reach;

  int bins_of_points;  ///< see ChordMatcher
};

/// See OutputConstants.
struct OutputParameters {
  struct ProjectionParameters projection;
  int samples;
  float bin_m, bin_high_m, bin_low_m, range_m;
  int sees_ambient;
  int ambient_weights;
  float typical_ambient, typical_floor_e2;
  float low_signal_sigma2, sure_lead;
  float lobe_noise, residual_noise;  ///< see NoiseRatios

  int records, record_stride;
  int chords, chord_blocks, chord_quarters;

  int dark_raw, gain_e_per_raw;  ///< two words per measurement: a double, or high and low float
  float lowest, highest;  ///< see SaturationLevels
  int finds_confidence;

  int limits, limit_stride, off_plane, off_plane_count, residual_basis, ambient_direction;
  int shot_ambient, floor_noise;
  float least_shot, least_shot_ambient, least_floor_e2, half_quantile;
  int finds_residual;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
