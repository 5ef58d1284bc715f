// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Means of frames in doubles, as MeanOfRows. Compiled after numbers.cl.

double exact_number(const struct TileParameters* tile, global const uchar* raw, int pixel, int k) {
  if (tile->number != raw_double) return raw_number(tile, raw, pixel, k);
  return ((global const double*)raw)[(size_t)pixel * (size_t)tile->pixel_stride +
                                     (size_t)k * (size_t)tile->measurement_stride];
}

/// As SaturationLevels::mean().
double mean_of(double sum, double frames, float lowest, float highest) {
  return isinf(sum) ? (double)(sum > 0.0 ? highest : lowest) : sum / frames;
}

/// As SaturationLevels::added().
double added(double sum, double value, float lowest, float highest) {
  if (!isfinite(value) || isnan(sum)) return (double)NAN;
  if (isinf(sum)) return sum;
  return value >= (double)highest ? (double)INFINITY
         : value <= (double)lowest ? -(double)INFINITY
                                   : sum + value;
}

kernel void add_to_sums(const struct TileParameters tile, global const uchar* raw_numbers,
                        const int measurements, const float lowest, const float highest,
                        const int is_first, global double* sums) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= tile.pixels) return;
  for (int k = 0; k < measurements; ++k) {
    const size_t at = (size_t)k * (size_t)tile.pixels + (size_t)pixel;
    const double value = exact_number(&tile, raw_numbers, pixel, k);
    const double sum = is_first ? 0.0 : sums[at];
    sums[at] = added(sum, value, lowest, highest);
  }
}

kernel void write_means(const int pixels, const int measurements, const int frames,
                        const float lowest, const float highest, const float averaged_now,
                        global const double* sums, global float* means, global float* averaged) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= pixels) return;
  for (int k = 0; k < measurements; ++k) {
    const size_t at = (size_t)k * (size_t)pixels + (size_t)pixel;
    means[at] = (float)mean_of(sums[at], (double)frames, lowest, highest);
  }
  averaged[pixel] = averaged_now;
}

kernel void gather_means(const int pixels, const int measurements, const int frames,
                         const float lowest, const float highest, global const double* sums,
                         Ints wanted, const int count, global double* means) {
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  for (int k = 0; k < measurements; ++k)
    means[(size_t)i * (size_t)measurements + (size_t)k] =
        mean_of(sums[(size_t)k * (size_t)pixels + (size_t)wanted[i]], (double)frames, lowest,
                highest);
}
