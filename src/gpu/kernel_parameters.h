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
  float lowest, highest;         ///< see SaturationLevels
  int finds_confidence;

  int limits, limit_stride, off_plane, off_plane_count, residual_basis, ambient_direction;
  int shot_ambient, floor_noise;
  float least_shot, least_shot_ambient, least_floor_e2, half_quantile;
  int finds_residual;
};

// The spatial filter.

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

// The temporal filter.

enum TimePlane {
  time_usable,      ///< 1 if both are usable, else 0
  time_chi2,        ///< of a pixel
  time_unchanged,   ///< 1 if no test detects a change
  time_share,       ///< smallest remaining share of the past in the row
  time_difference,  ///< in standard deviations, one plane per measurement
};

/// A chi^2 test, see ChangeTest.
struct TimeTest {
  float certain, most;
};

/// See TimeFilter::State.
struct TimeParameters {
  int height, width;
  int cell_rows, cell_columns;

  int gain, dark_raw, floor_variance_e2, shot_per_signal;  ///< per measurement
  int to_plane;                                            ///< (RANK, K), includes the gain
  float lowest, highest;                                   ///< see SaturationLevels
  int has_own_shot_noise;
  float hidden_floor_e2, hidden_shot_per_signal, mean_curve_square;  ///< see HiddenSignal
  struct TimeTest pixel, patch, shared;
  float max_weight;  ///< of the past, relative to one measurement
  float none;        ///< weight of unusable pixels
  float telling_share;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
