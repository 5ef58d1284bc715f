// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Pixels to bins as src/decode/search does it, a work item each. Compiled behind decode_parameters.h
// and numbers.cl and ahead of planes.cl, with what PixelStatus means and where the fields of records
// stand.
//
// `match` finds the bins that single precision proves. Pixels that it leaves open, or whose second
// peak hangs on rounding, go into a list, and the host decodes them.
#define NO_VALUE as_float(0x7fc00000)  // the not-a-number of the host
#define UNPROVEN (-2)
#define BLOCK 16       // lanes of ArcTable
#define HALF_BLOCK 8   // rows from one of its windows to the next
#define TO_WHOLE 12582912.0f  // 1.5 * 2^23, as cell_place-inl.hpp

// ---- The vector of a pixel, as tile_projection.cpp, where outputs follow without FUSES_PRODUCTS.

float project(const struct ProjectionParameters* p, int number, Floats tables, const float* raw,
              float* q) {
  const float reference = raw[p->reference];
  float error = product_plus(fabs(reference), p->error_of_reference, p->error_of_offset);
  for (int j = 0; j < RANK; ++j) q[j] = tables[p->offsets + j];
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float difference = product_plus(-reference, tables[p->ratios + k], raw[k]);
    error = product_plus(fabs(difference), tables[p->errors_of_difference + k], error);
    for (int j = 0; j < RANK; ++j)
      q[j] = product_plus(difference, tables[p->weights + j * MEASUREMENTS + k], q[j]);
  }
  if (number == raw_rounded)
    for (int k = 0; k < MEASUREMENTS; ++k)
      error += tables[p->errors_of_rounding + k] * fabs(raw[k]);
  return error;
}

/// Reads the numbers of a pixel, and its vector. @return what that may be off by
float vector_of(const struct ProjectionParameters* p, const struct TileParameters* tile,
                Floats tables, global const uchar* raw_numbers, int pixel, float* raw, float* q) {
  if (tile->number == raw_plane) {
    for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = 0.0f;
    for (int j = 0; j < RANK; ++j) raw[j] = q[j] = raw_number(tile, raw_numbers, pixel, j);
    return 0.0f;
  }
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = raw_number(tile, raw_numbers, pixel, k);
  return project(p, tile->number, tables, raw, q);
}

float largest_of(const float* q) {
  float largest = 0.0f;
  for (int j = 0; j < RANK; ++j) largest = fmax(largest, fabs(q[j]));
  return largest;
}

// ---- By arcs, as arc_search.cpp, but that all rows are looked at.

float score_of(const float* q, Floats block, int lane) {
  float score = block[lane];
  for (int j = 0; j < RANK; ++j) score += q[j] * block[(j + 1) * BLOCK + lane];
  return score;
}

int search_arcs(const struct MatchParameters* p, Floats tables, const float* q, float error) {
  float square = 0.0f;
  for (int j = 0; j < RANK; ++j) square += q[j] * q[j];
  const float length = sqrt(square);
  if (!(error < 1e-5f * largest_of(q))) return UNPROVEN;

  // The three best halves of blocks: a window has two, and the third bounds all others.
  float best[3] = {-INFINITY, -INFINITY, -INFINITY};
  int half_of[3] = {-1, -1, -1};
  int row = 0;
  for (int half_block = 0; half_block < 2 * p->row_blocks; ++half_block) {
    Floats block = tables + p->rows + half_block / 2 * (RANK + 1) * BLOCK;
    float here = -INFINITY;
    int lane = 0;
    for (int i = 0; i < HALF_BLOCK; ++i) {
      const float score = score_of(q, block, half_block % 2 * HALF_BLOCK + i);
      lane = score > here ? i : lane;
      here = fmax(score, here);
    }
    if (here > best[0]) row = half_block * HALF_BLOCK + lane;
    int h = half_block;
    for (int i = 0; i < 3; ++i)
      if (here > best[i]) {
        const float passed = best[i];
        const int passed_half = half_of[i];
        best[i] = here;
        half_of[i] = h;
        here = passed;
        h = passed_half;
      }
  }
  const int window = clamp((row - HALF_BLOCK / 2) / HALF_BLOCK, 0, p->window_count - 1);
  float outside = -INFINITY;
  for (int i = 2; i >= 0; --i)
    if (half_of[i] != window && half_of[i] != window + 1) outside = best[i];
  const float lead = p->lead * length + 2.0f * error, tie = p->tie * length;
  if (!(outside < best[0] - (lead + tie))) return UNPROVEN;

  Floats block = tables + p->windows + window * (RANK + 1) * BLOCK;
  float most = -INFINITY;
  for (int i = 0; i < BLOCK; ++i) most = fmax(most, score_of(q, block, i));
  const float least = most - (lead * tables[p->window_radii + window] + tie);
  int reached = 0, found = 0;
  for (int i = 0; i < BLOCK; ++i)
    if (score_of(q, block, i) >= least) {
      ++reached;
      found = i;
    }
  if (reached != 1) return UNPROVEN;
  return ints_at(tables, p->bins_of_rows)[window * HALF_BLOCK + found];
}

/// Best bin in [begin, end), modulo N, for the vector of a pixel: BinMatcher::second_peak_of().
int best_bin_within(const struct MatchParameters* p, Floats tables, const float* q, int begin,
                    int end) {
  float square = 0.0f, unit[RANK];
  for (int j = 0; j < RANK; ++j) square += q[j] * q[j];
  const float scale = square > 0.0f ? 1.0f / sqrt(square) : 0.0f;
  for (int j = 0; j < RANK; ++j) unit[j] = q[j] * scale;
  float best = -INFINITY;
  int found = -1;
  for (int position = begin; position < end; ++position) {
    const int row = position < p->samples ? position : position - p->samples;
    Floats direction = tables + p->rows + row / BLOCK * (RANK + 1) * BLOCK + row % BLOCK;
    float score = unit[0] * direction[BLOCK];
    for (int j = 1; j < RANK; ++j) score = score + unit[j] * direction[(j + 1) * BLOCK];
    found = score > best ? row : found;
    best = fmax(score, best);
  }
  return found;
}

// ---- By angle, as circle_search.cpp.

#if RANK == 2
int search_circle(const struct MatchParameters* p, Floats tables, const float* q, float error) {
  const bool is_steep = fabs(q[1]) > fabs(q[0]);
  const float larger = is_steep ? q[1] : q[0];
  const float c = (is_steep ? q[0] : q[1]) / fabs(larger);
  const float middle = 0.5f * (float)p->resolution;
  const int within = clamp((int)(c * middle + middle), 0, p->resolution - 1);
  const int side = (is_steep ? 2 : 0) + (larger < 0.0f ? 1 : 0);
  Floats piece = tables + p->pieces + 2 * (side * p->resolution + within);
  const float excess = c - piece[0];
  const uint bins = as_uint(piece[1]);
  const float least = p->margin + (error + error) / fabs(larger);
  if (!(fabs(excess) > least && least < p->overlap)) return UNPROVEN;
  return (int)(excess > 0.0f ? bins >> 16 : bins & 0xffffu);
}
#endif

// ---- By cells, as cell_place-inl.hpp and cell_search.cpp.

#if RANK == 3 || RANK == 4
#define SIDES (RANK - 1)
#define ROW 4  // floats of a step or a direction

float low_number(int word) { return (float)(word << 16 >> 16); }
float high_number(int word) { return (float)(word >> 16); }

float along(const float* q, Floats row) {
  float sum = q[0] * row[0];
  for (int j = 1; j < RANK; ++j) sum = sum + q[j] * row[j];
  return sum;
}

/// The winner of a run, all counted twice around, by the signs beside it.
int settle(const struct MatchParameters* p, Floats tables, const float* q, float margin, int first,
           int last, int at) {
  for (bool is_guess = true;; is_guess = false) {
    Floats steps = tables + p->steps + ROW * at;
    if (at < last) {
      const float after = along(q, steps + ROW);
      if (!(fabs(after) > margin)) return UNPROVEN;
      if (after > 0.0f) {
        first = at + 1;
        at = is_guess ? first : (first + last) / 2;
        continue;
      }
    }
    if (at > first) {
      const float before = along(q, steps);
      if (!(fabs(before) > margin)) return UNPROVEN;
      if (before < 0.0f) {
        last = at - 1;
        at = is_guess ? last : (first + last) / 2;
        continue;
      }
    }
    return at;
  }
}

/// The best of the runs of a list.
int search_list(const struct MatchParameters* p, Floats tables, const float* q, float margin,
                Ints cell, const float* place) {
  Ints run = ints_at(tables, p->lists) + 4 * cell[1];
  const int length = cell[0] >> 16 & 0x7fff;
  float best = -INFINITY, second = -INFINITY;
  int leader = UNPROVEN;
  for (int e = 0; e < length; ++e, run += 4) {
    float after = low_number(run[1]) + high_number(run[1]) * place[0];
    after += low_number(run[2]) * place[1];
#if RANK == 4
    after += high_number(run[2]) * place[2];
#endif
    const int first = run[0] & 0xffff, steps = run[0] >> 16 & 0xffff;
    const float guess = fmin(fmax(after * p->fit_unit + 0.5f, 0.0f), (float)steps);
    const int at = settle(p, tables, q, margin, first, first + steps, first + (int)guess);
    if (at < 0) return UNPROVEN;
    const float score = along(q, tables + p->units + ROW * at);
    second = fmax(second, fmin(best, score));
    leader = score > best ? at : leader;
    best = fmax(score, best);
  }
  return best - second > 2.0f * margin ? leader : UNPROVEN;
}

/// @param second_peak  what the cell says of it; UNPROVEN where another cell is too near
int search_cells(const struct MatchParameters* p, Floats tables, const float* q, float error,
                 int* second_peak) {
  float largest = fabs(q[0]), signed_largest = q[0];
  int axis = 0;
  for (int j = 1; j < RANK; ++j)
    if (fabs(q[j]) > largest) {
      largest = fabs(q[j]);
      signed_largest = q[j];
      axis = j;
    }
  if (!(error < p->reach * largest)) return UNPROVEN;

  const int bits = p->root_bits + p->cut_bits;
  const float sides = (float)(1 << bits);
  const float half_side = 0.5f * sides, middle = TO_WHOLE + 0.5f * sides;
  const float rounding_of_place = 1e-6f * (sides + 2.0f);
  const float scale = half_side * (1.0f / largest);
  const float slip = error * scale * 4.1f + rounding_of_place;
  int cell = axis + axis + (signed_largest < 0.0f ? 1 : 0), cut = 0;
  float place[SIDES];
  bool is_near_border = false;
  for (int s = 0; s < SIDES; ++s) {
    const float shifted = (axis > s ? q[s] : q[s + 1]) * scale - 0.5f;
    const float index = clamp(shifted + middle, TO_WHOLE, TO_WHOLE + sides - 1.0f);
    const float within = shifted - (index - middle);
    place[s] = within + within;
    is_near_border = is_near_border || fabs(place[s]) > 1.0f - rounding_of_place;
    const int fine = as_int(index) & ((1 << bits) - 1);
    cut = (cut << p->cut_bits) + (fine & ((1 << p->cut_bits) - 1));
    cell = (cell << p->root_bits) + (fine >> p->cut_bits);
  }
#if RANK == 4
  const int root = ints_at(tables, p->roots)[cell];
  cell = root >> 1;
  if ((root & 1) != 0) {
    cell += cut;
  } else {
    const float shrink = 1.0f / (float)(1 << p->cut_bits);
    for (int s = 0; s < SIDES; ++s) {
      const int part = cut >> p->cut_bits * (SIDES - 1 - s) & ((1 << p->cut_bits) - 1);
      place[s] = (place[s] + (float)(part + part)) * shrink + (shrink - 1.0f);
    }
  }
#endif
  Ints record = ints_at(tables, p->cells) + 4 * cell;
  *second_peak = is_near_border ? UNPROVEN : record[3] & 0xffff;

  float size = 0.0f;
  for (int j = 0; j < RANK; ++j) size += fabs(q[j]);
  const float margin = error + p->rounding * size;
  int at;
  if (record[0] < 0) {
    at = search_list(p, tables, q, margin, record, place);
  } else {
    float x = high_number(record[1]) * place[0] + low_number(record[1]);
    x = low_number(record[2]) * place[1] + x;
#if RANK == 4
    x = high_number(record[2]) * place[2] + x;
    const float slack = high_number(record[3]);
#else
    const float slack = high_number(record[2]);  // in place of the fourth fit
#endif
    x *= p->fit_unit;
    const int length = record[0] >> 16, first = record[0] & 0xffff;
    const float after = clamp(rint(x), 0.0f, (float)length);
    at = first + (int)after;
    // x must be further from the borders of its direction than it may be off.
    const float rounding = slack * p->slack_unit + p->steepest_fit * slip;
    const float beside = x - after;
    const float above = (int)after == length ? 1e30f : 0.5f - beside;
    const float below = (int)after == 0 ? 1e30f : 0.5f + beside;
    if (!(fmin(above, below) > rounding))
      at = settle(p, tables, q, margin, first, first + length, at);
  }
  if (at < 0) return UNPROVEN;
  const int n = at < p->directions ? at : at - p->directions;
  return p->bins < 0 ? n : ints_at(tables, p->bins)[n];
}
#endif

// ---- Second peaks, as second_peak_search.hpp.

#define UNKNOWN (-3)

/// Out of the main lobe of `bin` where its edge has passed it; UNKNOWN where it is further inside.
int moved_out(const struct MatchParameters* p, Ints lobe, int second_peak) {
  const int length = lobe[1] - lobe[0];
  if (length >= p->samples) return -1;
  if (second_peak < 0) return UNKNOWN;
  int after = second_peak - lobe[0];
  if (after >= p->samples) after -= p->samples;
  if (after < 0) after += p->samples;
  if (after >= length) return second_peak;
  const int edge = p->samples / 120 + 1;
  if (length - after <= edge) return lobe[1] < p->samples ? lobe[1] : lobe[1] - p->samples;
  if (after < edge) return lobe[0] > 0 ? lobe[0] - 1 : lobe[0] - 1 + p->samples;
  return UNKNOWN;
}

// ---- From pixels to bins, as BinMatcher and ChordMatcher.

/// @param wants_second_peaks  whether second_peak is filled
/// @param open    pixels that the host decodes, one after another, `opened` of them
kernel void match(const struct MatchParameters p, const struct TileParameters tile, Floats tables,
                  global const uchar* raw_numbers, int wants_second_peaks, global int* bins,
                  global int* second_peaks, global int* opened, global int* open) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= tile.pixels) return;
  float raw[MEASUREMENTS], q[RANK];
  const float error = vector_of(&p.projection, &tile, tables, raw_numbers, pixel, raw, q);
  bool is_number = true;
  for (int k = 0; k < MEASUREMENTS; ++k) is_number = is_number && isfinite(raw[k]);
  int bin = UNPROVEN, second_peak = UNPROVEN;
  if (!is_number && tile.number != raw_rounded) bin = second_peak = -1;
  const float largest = largest_of(q);
  if (is_number && largest > 1e-12f && largest < 1e12f) {
    if (p.way == by_arcs) bin = search_arcs(&p, tables, q, error);
#if RANK == 2
    if (p.way == by_angle) bin = search_circle(&p, tables, q, error);
#elif RANK == 3 || RANK == 4
    if (p.way == by_cells) bin = search_cells(&p, tables, q, error, &second_peak);
#endif
    if (bin >= 0 && p.points_of_bins >= 0) bin = ints_at(tables, p.bins_of_points)[bin];
    if (bin >= 0 && wants_second_peaks) {
      const int point = p.points_of_bins >= 0 ? ints_at(tables, p.points_of_bins)[bin] : bin;
      Ints lobe = ints_at(tables, p.lobes) + 2 * point;
      if (p.way == by_angle)
        second_peak = ints_at(tables, p.second_peaks)[point];
      else if (p.way == by_arcs)
        second_peak = lobe[1] - lobe[0] < p.samples ? UNKNOWN : -1;
      else if (second_peak != UNPROVEN)
        second_peak = moved_out(&p, lobe, second_peak == 0xffff ? -1 : second_peak);
      if (second_peak == UNKNOWN)
        second_peak = best_bin_within(&p, tables, q, lobe[1], lobe[0] + p.samples);
      if (second_peak >= 0 && p.points_of_bins >= 0)
        second_peak = ints_at(tables, p.bins_of_points)[second_peak];
    }
  }
  bins[pixel] = bin;
  if (wants_second_peaks) second_peaks[pixel] = second_peak;
  if (bin == UNPROVEN || (wants_second_peaks && second_peak == UNPROVEN))
    open[atomic_inc(opened)] = pixel;
}
