// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What kernels are told, in C++ and in OpenCL C alike: members of 4 bytes each. `int` beside a name
// in the plural says where a table stands in the memory of tables, in words of 4 bytes; -1: nowhere.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// What raw numbers on the device are.
enum RawNumber {
  raw_float,
  raw_uint16,
  raw_uint8,
  raw_rounded,  ///< floats that were doubles
  raw_double    ///< of which means are made, no more
};

/// The pixels of a tile: number k of pixel i stands at i pixel_stride + k measurement_stride.
struct TileParameters {
  int pixels;
  int pixel_stride;
  int measurement_stride;
  int number;  ///< RawNumber
};

/// As ProjectionView.
struct ProjectionParameters {
  int ratios, weights, offsets, errors_of_difference;
  int errors_of_rounding;  ///< of doubles: times |raw|
  int reference;
  float error_of_reference, error_of_offset;
};

/// How bins are searched.
enum SearchWay { by_arcs, by_angle, by_cells };

/// As BinMatcher and what it searches by.
struct MatchParameters {
  struct ProjectionParameters projection;
  int way;  ///< SearchWay
  int samples;

  int rows, row_blocks, windows, window_count, window_radii, bins_of_rows;  ///< as ArcTable
  float lead, tie;                                                          ///< as Margins

  int pieces, resolution;  ///< as CircleSearch
  float margin, overlap;

  int root_bits, cut_bits, roots, cells, lists, directions, steps, units, bins;  ///< CellSearchView
  float fit_unit, slack_unit, steepest_fit, rounding, reach;

  int bins_of_points;  ///< as ChordMatcher
};

/// As OutputConstants and the tables that go with them.
struct OutputParameters {
  struct ProjectionParameters projection;
  int samples;
  float bin_m, bin_high_m, bin_low_m, range_m;
  int sees_ambient;
  int ambient_weights;
  float typical_ambient, typical_floor_e2;
  float low_signal_sigma2, sure_lead;
  float lobe_noise, residual_noise;  ///< as NoiseRatios

  int records, record_stride;
  int chords, chord_blocks, chord_quarters;

  int dark_raw, gain_e_per_raw;  ///< of every measurement: pairs of words, a double or high and low
  float lowest, highest;  ///< as SaturationLevels
  int finds_confidence;

  int limits, limit_stride, off_plane, off_plane_count, residual_basis, ambient_direction;
  int shot_ambient, floor_noise;
  float least_shot, least_shot_ambient, least_floor_e2, half_quantile;
  int finds_residual;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
