// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Finds the bins of pixels as src/decode/search, one work item each. Compiled after numbers.cl,
// before planes.cl. Pixels that single precision does not prove are listed and decoded on the host.
#define NO_VALUE as_float(0x7fc00000)  // the same bits as on the host
#define UNPROVEN (-2)
#define BLOCK 16       // lanes of ArcTable
#define HALF_BLOCK 8   // rows between windows
#define TO_WHOLE 12582912.0f  // 1.5 * 2^23, as cell_place-inl.hpp

// ---- Projection of a pixel, as tile_projection.cpp.

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

/// @return bound on the error of the projection
float vector_of(const struct ProjectionParameters* p, const struct TileParameters* tile,
                Floats tables, global const uchar* raw_numbers, int pixel, float* raw, float* q) {
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = raw_number(tile, raw_numbers, pixel, k);
  return project(p, tile->number, tables, raw, q);
}

float largest_of(const float* q) {
  float largest = 0.0f;
  for (int j = 0; j < RANK; ++j) largest = fmax(largest, fabs(q[j]));
  return largest;
}

// ---- Search by arcs, as arc_search.cpp, but over all rows.

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

  // Best three half blocks: a window consists of two, and the third bounds all others.
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

// ---- Search by angle, as circle_search.cpp.

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

// ---- Search by cells, as cell_place-inl.hpp and cell_search.cpp.

#if RANK == 3 || RANK == 4
#define SIDES (RANK - 1)
#define ROW 4

float low_number(int word) { return (float)(word << 16 >> 16); }
float high_number(int word) { return (float)(word >> 16); }

float along(const float* q, Floats row) {
  float sum = q[0] * row[0];
  for (int j = 1; j < RANK; ++j) sum = sum + q[j] * row[j];
  return sum;
}

/// As settle() in cell_search.cpp; UNPROVEN if a sign is not certain.
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

int search_cells(const struct MatchParameters* p, Floats tables, const float* q, float error) {
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
  for (int s = 0; s < SIDES; ++s) {
    const float shifted = (axis > s ? q[s] : q[s + 1]) * scale - 0.5f;
    const float index = clamp(shifted + middle, TO_WHOLE, TO_WHOLE + sides - 1.0f);
    const float within = shifted - (index - middle);
    place[s] = within + within;
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
    const float slack = high_number(record[2]);  // the fourth fit
#endif
    x *= p->fit_unit;
    const int length = record[0] >> 16, first = record[0] & 0xffff;
    const float after = clamp(rint(x), 0.0f, (float)length);
    at = first + (int)after;
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

// ---- From pixels to bins, as BinMatcher and ChordMatcher.

/// @param open    list of pixels that the host decodes
kernel void match(const struct MatchParameters p, const struct TileParameters tile, Floats tables,
                  global const uchar* raw_numbers, global int* bins, global int* opened,
                  global int* open) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= tile.pixels) return;
  float raw[MEASUREMENTS], q[RANK];
  const float error = vector_of(&p.projection, &tile, tables, raw_numbers, pixel, raw, q);
  bool is_number = true;
  for (int k = 0; k < MEASUREMENTS; ++k) is_number = is_number && isfinite(raw[k]);
  int bin = UNPROVEN;
  if (!is_number && tile.number != raw_rounded) bin = -1;
  const float largest = largest_of(q);
  if (is_number && largest > 1e-12f && largest < 1e12f) {
    if (p.way == by_arcs) bin = search_arcs(&p, tables, q, error);
#if RANK == 2
    if (p.way == by_angle) bin = search_circle(&p, tables, q, error);
#elif RANK == 3 || RANK == 4
    if (p.way == by_cells) bin = search_cells(&p, tables, q, error);
#endif
    if (bin >= 0 && p.bins_of_points >= 0) bin = ints_at(tables, p.bins_of_points)[bin];
  }
  bins[pixel] = bin;
  if (bin == UNPROVEN) open[atomic_inc(opened)] = pixel;
}
