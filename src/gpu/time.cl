// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Steps of a TimeFilter without look_ahead, as time_kernel.cpp and time_filter_state.cpp. Compiled
// after numbers.cl. Products are not fused, as on the CPU.

// As std::max and std::min, also for NaN.
#define LARGER(a, b) ((a) < (b) ? (b) : (a))
#define SMALLER(a, b) ((b) < (a) ? (b) : (a))
#define PATCH_PIXELS ((2 * PATCH_REACH + 1) * (2 * PATCH_REACH + 1))

Plane time_plane(const struct TimeParameters* p, global float* planes, int index) {
  return planes + (size_t)index * (size_t)p->height * (size_t)p->width;
}

float mean_of(const struct TimeParameters* p, Floats means, int pixel, int k) {
  return means[(size_t)k * (size_t)p->height * (size_t)p->width + (size_t)pixel];
}

float averaged_of(Floats averaged, int pixel) { return averaged ? averaged[pixel] : 1.0f; }

// ---- Comparison of a frame with the running mean.

/// Estimates the signal for the noise of measurements in which light cancels.
float signal_in_both(const struct TimeParameters* p, Floats tables, const float* both, float n) {
  float squares = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    float along = 0.0f;
    for (int k = 0; k < MEASUREMENTS; ++k)
      along += tables[p->to_plane + j * MEASUREMENTS + k] * (both[k] - tables[p->dark_raw + k]);
    squares += along * along;
  }
  const float per_mean = (float)RANK / n;
  const float m = per_mean * p->hidden_shot_per_signal;
  const float above = squares - per_mean * p->hidden_floor_e2;
  const float beyond = LARGER(0.0f, above);
  return (sqrt(m * m + 4.0f * p->mean_curve_square * beyond) - m) / (2.0f * p->mean_curve_square);
}

kernel void compare_frames(const struct TimeParameters p, const struct TileParameters tile,
                           Floats tables, global const uchar* raw_numbers, Floats averaged,
                           Floats means, Floats averaged_before, global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int pixel = y * p.width + x;
  const float n = averaged_of(averaged, pixel), past = averaged_before[pixel];
  bool usable = n > 0.0f && past > 0.0f;
  float now[MEASUREMENTS], before[MEASUREMENTS], both[MEASUREMENTS];
  for (int k = 0; k < MEASUREMENTS; ++k) {
    now[k] = raw_number(&tile, raw_numbers, pixel, k);
    before[k] = mean_of(&p, means, pixel, k);
    usable = usable && now[k] > p.lowest && before[k] > p.lowest && now[k] < p.highest &&
             before[k] < p.highest;
    both[k] = (before[k] * past + now[k] * n) / (past + n);
  }
  const float signal =
      p.has_own_shot_noise ? signal_in_both(&p, tables, both, past + n) : 0.0f;
  float chi2 = 0.0f;
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float gain = tables[p.gain + k], floor_e2 = tables[p.floor_variance_e2 + k];
    const float electrons = (both[k] - tables[p.dark_raw + k]) * gain;
    const float light = p.has_own_shot_noise ? signal * tables[p.shot_per_signal + k]
                                             : LARGER(0.0f, electrons);
    const float sigma = sqrt((floor_e2 + light) * (1.0f / past + 1.0f / n));
    const float d = (now[k] - before[k]) * gain / sigma;
    const float difference = usable ? d : 0.0f;
    time_plane(&p, planes, time_difference + k)[pixel] = difference;
    chi2 += difference * difference;
  }
  time_plane(&p, planes, time_usable)[pixel] = usable ? 1.0f : 0.0f;
  time_plane(&p, planes, time_chi2)[pixel] = usable ? chi2 : (float)MEASUREMENTS;
}

// ---- Weight of the past.

/// Sum over the patch around a pixel, columns first.
float patch_sum(const struct TimeParameters* p, Plane plane, int x, int y, float outside) {
  float sum = 0.0f;
  for (int dx = -PATCH_REACH; dx <= PATCH_REACH; ++dx) {
    float column = 0.0f;
    for (int dy = -PATCH_REACH; dy <= PATCH_REACH; ++dy) {
      const int at_x = x + dx, at_y = y + dy;
      const bool is_pixel = at_x >= 0 && at_x < p->width && at_y >= 0 && at_y < p->height;
      const float value = is_pixel ? plane[at_y * p->width + at_x] : outside;
      column = dy == -PATCH_REACH ? value : column + value;
    }
    sum = dx == -PATCH_REACH ? column : sum + column;
  }
  return sum;
}

float share_by(const struct TimeTest* test, float chi2) {
  const float share = (test->most - chi2) / (test->most - test->certain);
  return share < 0.0f ? 0.0f : 1.0f < share ? 1.0f : share;
}

float beyond_by(const struct TimeTest* test, float chi2) {
  const float beyond = chi2 - test->certain;
  return LARGER(0.0f, beyond);
}

kernel void weigh_side(const struct TimeParameters p, Floats averaged, Floats averaged_before,
                       global float* planes, global float* weights) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int pixel = y * p.width + x;
  const float patch_chi2 =
      patch_sum(&p, time_plane(&p, planes, time_chi2), x, y, (float)MEASUREMENTS);
  const float count = patch_sum(&p, time_plane(&p, planes, time_usable), x, y, 0.0f);
  float shared = 0.0f;
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float sum = patch_sum(&p, time_plane(&p, planes, time_difference + k), x, y, 0.0f);
    shared += sum * sum;
  }
  const float n = averaged_of(averaged, pixel), past = averaged_before[pixel];
  const float own_chi2 = time_plane(&p, planes, time_chi2)[pixel];
  const float shared_chi2 = shared / LARGER(count, 1.0f);
  const float by_pixel = share_by(&p.pixel, own_chi2), by_patch = share_by(&p.patch, patch_chi2);
  const float by_shared = share_by(&p.shared, shared_chi2);
  const float by_both = SMALLER(by_pixel, by_patch), share = SMALLER(by_both, by_shared);
  const float of_pixel = beyond_by(&p.pixel, own_chi2);
  const float of_patch = beyond_by(&p.patch, patch_chi2) / (float)PATCH_PIXELS;
  const float of_shared = beyond_by(&p.shared, shared_chi2) / (float)PATCH_PIXELS;
  const float of_both = LARGER(of_pixel, of_patch), beyond = LARGER(of_both, of_shared);
  const float changed = (1.0f / past + 1.0f / n) / (float)MEASUREMENTS * beyond;
  const float stays = share * past / (1.0f + past * changed), most = p.max_weight * n;
  const float usable = time_plane(&p, planes, time_usable)[pixel];
  weights[pixel] = usable > 0.0f ? SMALLER(stays, most) : p.none;
  time_plane(&p, planes, time_unchanged)[pixel] = changed > 0.0f ? 0.0f : usable;
}

// ---- Changes that many pixels share.

/// Sums the differences of the unchanged pixels of each cell, and counts them: K + 1 numbers.
kernel void add_to_cells(const struct TimeParameters p, global float* planes, global float* cells) {
  const int column = (int)get_global_id(0), row = (int)get_global_id(1);
  if (column >= p.cell_columns || row >= p.cell_rows) return;
  const int left = column * CELL_SIDE, right = min(left + CELL_SIDE, p.width);
  const int top = row * CELL_SIDE, bottom = min(top + CELL_SIDE, p.height);
  const Plane unchanged = time_plane(&p, planes, time_unchanged);
  const Plane cell = cells + (size_t)(row * p.cell_columns + column) * (MEASUREMENTS + 1);
  for (int k = 0; k <= MEASUREMENTS; ++k) {
    const Plane difference = time_plane(&p, planes, time_difference + k);
    float sum = 0.0f;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const int pixel = y * p.width + x;
        sum += k < MEASUREMENTS ? unchanged[pixel] * difference[pixel] : unchanged[pixel];
      }
    cell[k] = sum;
  }
}

kernel void find_cell_changes(const struct TimeParameters p, Floats cells, global float* changes) {
  const int column = (int)get_global_id(0), row = (int)get_global_id(1);
  if (column >= p.cell_columns || row >= p.cell_rows) return;
  float sums[MEASUREMENTS + 1];
  for (int k = 0; k <= MEASUREMENTS; ++k) sums[k] = 0.0f;
  const int last_row = min(row + CELL_REACH, p.cell_rows - 1);
  const int last_column = min(column + CELL_REACH, p.cell_columns - 1);
  for (int y = max(row - CELL_REACH, 0); y <= last_row; ++y)
    for (int x = max(column - CELL_REACH, 0); x <= last_column; ++x)
      for (int k = 0; k <= MEASUREMENTS; ++k)
        sums[k] += cells[(size_t)(y * p.cell_columns + x) * (MEASUREMENTS + 1) + (size_t)k];
  float squares = 0.0f;
  for (int k = 0; k < MEASUREMENTS; ++k) squares += sums[k] * sums[k];
  const float chi2 = squares / LARGER(sums[MEASUREMENTS], 1.0f);
  changes[row * p.cell_columns + column] = beyond_by(&p.shared, chi2) / (float)MEASUREMENTS;
}

kernel void weigh_by_cells(const struct TimeParameters p, Floats averaged, Floats averaged_before,
                           Floats changes, global float* weights) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int pixel = y * p.width + x;
  const float n = averaged_of(averaged, pixel);
  const float changed = changes[y / CELL_SIDE * p.cell_columns + x / CELL_SIDE] *
                        (1.0f / averaged_before[pixel] + 1.0f / n);
  const float weight = weights[pixel];
  if (weight > 0.0f) weights[pixel] = weight / (1.0f + weight * changed);
}

float most_weight(const struct TimeParameters* p, Floats averaged, Floats averaged_before,
                  int pixel) {
  const float past = averaged_before[pixel];
  const float most = p->max_weight * averaged_of(averaged, pixel);
  return SMALLER(past, most);
}

/// Finds the smallest remaining share of the past along the row.
kernel void find_shares(const struct TimeParameters p, Floats averaged, Floats averaged_before,
                        Floats weights, global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int last = min(x + PATCH_REACH, p.width - 1);
  float share = 1.0f;
  for (int i = max(x - PATCH_REACH, 0); i <= last; ++i) {
    const int other = y * p.width + i;
    const float most = most_weight(&p, averaged, averaged_before, other);
    if (weights[other] < 0.0f || most == 0.0f) continue;
    const float own = weights[other] / (p.telling_share * most);
    share = SMALLER(share, own);
  }
  time_plane(&p, planes, time_share)[y * p.width + x] = share;
}

/// Extends this minimum to the rows around and limits the weights, so that no pixel keeps much more
/// of its past than its neighbours.
kernel void weigh_by_shares(const struct TimeParameters p, Floats averaged, Floats averaged_before,
                            global float* planes, global float* weights) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int pixel = y * p.width + x, last = min(y + PATCH_REACH, p.height - 1);
  const float most = most_weight(&p, averaged, averaged_before, pixel);
  const Plane shares = time_plane(&p, planes, time_share);
  float weight = weights[pixel];
  for (int i = max(y - PATCH_REACH, 0); i <= last; ++i) {
    const float at_most = shares[i * p.width + x] * most;
    weight = SMALLER(weight, at_most);
  }
  weights[pixel] = LARGER(weight, 0.0f);
}

// ---- Update of the mean.

kernel void add_frame(const struct TimeParameters p, const struct TileParameters tile,
                      global const uchar* raw_numbers, Floats averaged, Floats weights,
                      global float* means, global float* averaged_before) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int pixel = y * p.width + x;
  const size_t pixels = (size_t)p.height * (size_t)p.width;
  const float w = weights[pixel], n = averaged_of(averaged, pixel);
  const float share = w / (w + n);
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float now = raw_number(&tile, raw_numbers, pixel, k);
    global float* mean = means + (size_t)k * pixels + (size_t)pixel;
    const float both = now + (*mean - now) * share;
    *mean = w > 0.0f ? both : now;
  }
  const float both = (w + n) * (w + n) / (w * w / averaged_before[pixel] + n);
  averaged_before[pixel] = w > 0.0f ? both : n;
}
