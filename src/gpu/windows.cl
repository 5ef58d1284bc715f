// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Windows of a Filter over pixels with parallel vectors, as filter_plan.cpp and filter_kernel.cpp.
// Compiled after numbers.cl, before slopes.cl. Planes have a margin of unusable pixels, so that
// kernels need no bounds checks.

// As the CPU's vector instructions: the second operand for equal values or NaN.
#define LARGER(a, b) ((a) > (b) ? (a) : (b))
#define SMALLER(a, b) ((a) < (b) ? (a) : (b))

Plane plane_of(const struct FilterParameters* p, global float* planes, int index) {
  return planes + (size_t)index * (size_t)p->plane_floats + (size_t)p->origin;
}

float weight_of(float difference, float inverse_max) {
  const float left =
      LARGER(product_plus(-(LARGER(difference, 0.0f)), inverse_max, 1.0f), 0.0f);
  const float square = left * left;
  return square * square;
}

// ---- Input.

/// out_j = sum_k matrix[j, k] in_k.
void mix(Floats matrix, const float* in, float* out) {
  for (int j = 0; j < MEASUREMENTS; ++j) {
    out[j] = 0.0f;
    for (int k = 0; k < MEASUREMENTS; ++k) out[j] += matrix[j * MEASUREMENTS + k] * in[k];
  }
}

float variance_of_coordinate(const struct FilterParameters* p, Floats tables,
                             const float* electrons) {
  float variance = p->floor_variance_e2;
  for (int k = 0; k < MEASUREMENTS; ++k)
    variance += tables[p->shot_share + k] * (electrons[k] < 0.0f ? 0.0f : electrons[k]);
  return variance;
}

/// Converts raw numbers to light, with usable flags and, optionally, variances.
kernel void read_light(const struct FilterParameters p, const struct TileParameters tile,
                       Floats tables, global const uchar* raw_numbers, Floats averaged,
                       global const uchar* left_out, global float* planes, const int light,
                       const int usable_plane, const int wants_variance) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x, pixel = y * p.width + x;
  bool usable = !averaged || averaged[pixel] > 0.0f;
  float electrons[MEASUREMENTS], coordinates[MEASUREMENTS];
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float value = raw_number(&tile, raw_numbers, pixel, k);
    usable = usable && value < p.highest && value > p.lowest;
    electrons[k] = value * tables[p.gain_e_per_raw + k] + tables[p.dark_e + k];
  }
  if (left_out && left_out[pixel] != 0) usable = false;
  if (!usable)
    for (int k = 0; k < MEASUREMENTS; ++k) electrons[k] = 0.0f;
  plane_of(&p, planes, usable_plane)[at] = usable ? 1.0f : 0.0f;
  if (wants_variance) {
    float variance = variance_of_coordinate(&p, tables, electrons);
    if (averaged && usable) variance /= averaged[pixel];
    plane_of(&p, planes, PLANE_VARIANCE)[at] = variance;
  }
  mix(tables + p.to_coordinates, electrons, coordinates);
  for (int j = 0; j < MEASUREMENTS; ++j) plane_of(&p, planes, light + j)[at] = coordinates[j];
}

/// As HiddenSignal::of().
float hidden_signal(const struct FilterParameters* p, float squares, float averaged) {
  const float per_mean = (float)RANK / averaged;
  const float m = per_mean * p->shot_per_signal;
  const float above = squares - per_mean * p->floor_variance_e2;
  const float beyond = 0.0f < above ? above : 0.0f;
  return (sqrt(m * m + 4.0f * p->mean_curve_square * beyond) - m) / (2.0f * p->mean_curve_square);
}

/// Computes the noise of measurements in which light cancels.
kernel void find_hidden_noise(const struct FilterParameters p, Floats averaged,
                              global float* planes, const int light) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  float squares = 0.0f, count = 0.0f;
  for (int dy = -PATCH_REACH; dy <= PATCH_REACH; ++dy)
    for (int dx = -PATCH_REACH; dx <= PATCH_REACH; ++dx) {
      const int at = (y + dy) * p.stride + x + dx;
      count += plane_of(&p, planes, PLANE_USABLE)[at];
      for (int j = 0; j < RANK; ++j) {
        const float value = plane_of(&p, planes, light + j)[at];
        squares += value * value;
      }
    }
  if (!(count > 0.0f)) return;
  const float mean_of = averaged ? averaged[y * p.width + x] : 1.0f;
  const float n = mean_of > 0.0f ? mean_of : 1.0f;
  plane_of(&p, planes, PLANE_VARIANCE)[y * p.stride + x] =
      (p.floor_variance_e2 + hidden_signal(&p, squares / count, n) * p.shot_per_signal) / n;
}

// ---- Windows.

/// Computes |u|^2 / v and 1 / sqrt(v).
kernel void find_energy(const struct FilterParameters p, const struct SimilarParameters w,
                        global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  float squares = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const float value = plane_of(&p, planes, w.light + j)[at];
    squares = product_plus(value, value, squares);
  }
  const float least = plane_of(&p, planes, PLANE_VARIANCE)[at] * w.floor_share;
  const float variance = plane_of(&p, planes, w.variance_in)[at];
  const float either = LARGER(variance, least), v = LARGER(either, 1e-12f);
  const float inverse = 1.0f / v;
  plane_of(&p, planes, PLANE_ENERGY)[at] = squares * inverse;
  plane_of(&p, planes, PLANE_INVERSE_SIGMA)[at] = sqrt(inverse);
}

/// Lambda of two pixels; rank - 1 if one is not usable.
float lambda_of(const struct FilterParameters* p, global float* planes, int light, int at,
                int other) {
  const Plane usable = plane_of(p, planes, PLANE_USABLE);
  if (!(usable[at] * usable[other] > 0.5f)) return (float)(RANK - 1);
  float dot_product = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const Plane u = plane_of(p, planes, light + j);
    dot_product = product_plus(u[at], u[other], dot_product);
  }
  const Plane inverse_sigma = plane_of(p, planes, PLANE_INVERSE_SIGMA);
  const Plane energy = plane_of(p, planes, PLANE_ENERGY);
  const float c_any = dot_product * (inverse_sigma[at] * inverse_sigma[other]);
  const float c = LARGER(c_any, 0.0f), a = energy[at], b = energy[other];
  const float apart = a - b, sum = a + b;
  const float root = sqrt(product_plus(apart, apart, 4.0f * (c * c)));
  const float any_product = product_plus(-c, c, a * b);
  const float product = LARGER(any_product, 0.0f), both = sum + root;
  return (product + product) / LARGER(both, 1e-30f);
}

/// Work groups sum lambda of a tile and its patches in local memory, along rows, then along
/// columns.
kernel __attribute__((reqd_work_group_size(tile_columns, tile_rows, 1))) void weigh_similar(
    const struct FilterParameters p, const struct SimilarParameters w, global float* planes,
    global float* weights) {
  local float lambda[(tile_rows + 2 * PATCH_REACH) * (tile_columns + 2 * PATCH_REACH)];
  local float sums[(tile_rows + 2 * PATCH_REACH) * tile_columns];
  const int reach = w.patch_reach, side = 2 * reach + 1;
  const int rows = tile_rows + 2 * reach, columns = tile_columns + 2 * reach;
  const int column = (int)get_local_id(0), row = (int)get_local_id(1);
  const int left = (int)get_group_id(0) * tile_columns, top = (int)get_group_id(1) * tile_rows;
  const int item = row * tile_columns + column, items = tile_rows * tile_columns;
  const int x = left + column, y = top + row, at = y * p.stride + x;
  const bool is_pixel = x < p.width && y < p.height;
  for (int i = 0; i < HALF_WINDOW; ++i) {
    const int away = half_window_rows[i] * w.step * p.stride + half_window_columns[i] * w.step;
    for (int n = item; n < rows * columns; n += items) {
      const int from_y = top + n / columns - reach, from_x = left + n % columns - reach;
      const int from = from_y * p.stride + from_x;
      lambda[n] = from_x < p.width + reach && from_y < p.height + reach
                      ? lambda_of(&p, planes, w.light, from, from + away)
                      : (float)(RANK - 1);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int n = item; n < rows * tile_columns; n += items) {
      const local float* first = lambda + n / tile_columns * columns + n % tile_columns;
      float sum = first[0];
      for (int k = 1; k < side; ++k) sum += first[k];
      sums[n] = sum;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (is_pixel) {
      float sum = sums[row * tile_columns + column];
      for (int k = 1; k < side; ++k) sum += sums[(row + k) * tile_columns + column];
      const float own = lambda[(row + reach) * columns + column + reach];
      sum -= SMALLER(own, w.noise_limit);
      const Plane usable = plane_of(&p, planes, PLANE_USABLE);
      plane_of(&p, weights, i)[at] =
          weight_of(product_plus(sum, w.by, -w.expected), p.inverse_max_difference) *
          (usable[at] * usable[at + away]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

/// Returns the number of rows or columns of a window around `at` that are inside the frame.
int places_inside(int at, int size, int step) {
  int places = 1;
  for (int i = 1; i <= WINDOW_REACH; ++i)
    places += (at >= i * step ? 1 : 0) + (at < size - i * step ? 1 : 0);
  return places;
}

/// As rejected_share() on the CPU.
/// @param sum  of the weights of the neighbours
float rejected_share(const struct FilterParameters* p, int step, int x, int y, float sum) {
  const int places = places_inside(y, p->height, step) * places_inside(x, p->width, step);
  return 1.0f - sum / (float)(places > 1 ? places - 1 : 1);
}

/// Returns the variance of a window with the bound on the squared bias, as add_bias().
/// @param sum  of the weights of the neighbours
float variance_with_bias(const struct FilterParameters* p, const struct SimilarParameters* w, int x,
                         int y, float sum, float before, float variance) {
  const float any_rejected = rejected_share(p, w->step, x, y, sum) - w->bias_by_noise;
  const float rejected = LARGER(any_rejected, 0.0f);
  const float any_removed = before - variance, removed = LARGER(any_removed, 0.0f);
  return w->bias_share > 0.0f ? product_plus(rejected * w->bias_share, removed, variance)
                              : variance;
}

kernel void add_similar(const struct FilterParameters p, const struct SimilarParameters w,
                        global float* planes, global float* weights) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const Plane variances = plane_of(&p, planes, w.variance_in);
  float sum[MEASUREMENTS], weight = 1.0f, others = 0.0f, variance = variances[at];
  for (int k = 0; k < MEASUREMENTS; ++k) sum[k] = plane_of(&p, planes, w.light + k)[at];
  for (int i = 0; i < HALF_WINDOW; ++i) {
    const int away = half_window_rows[i] * w.step * p.stride + half_window_columns[i] * w.step;
    const Plane own = plane_of(&p, weights, i);
    const float ahead = own[at], behind = own[at - away];
    weight += ahead + behind;
    others += ahead + behind;
    variance = product_plus(ahead * ahead, variances[at + away], variance);
    variance = product_plus(behind * behind, variances[at - away], variance);
    for (int k = 0; k < MEASUREMENTS; ++k) {
      const Plane in = plane_of(&p, planes, w.light + k);
      sum[k] = product_plus(ahead, in[at + away], sum[k]);
      sum[k] = product_plus(behind, in[at - away], sum[k]);
    }
  }
  const float inverse = 1.0f / weight;
  plane_of(&p, planes, w.variance_out)[at] =
      variance_with_bias(&p, &w, x, y, others, variances[at], variance * (inverse * inverse));
  for (int k = 0; k < MEASUREMENTS; ++k) plane_of(&p, planes, w.to + k)[at] = sum[k] * inverse;
}

// ---- Output.

/// @return number of measurements averaged
float raw_of_light(const struct FilterParameters* p, const struct ResultParameters* r,
                   Floats tables, float averaged_before, global float* planes, int at,
                   float* numbers) {
  float coordinates[MEASUREMENTS], electrons[MEASUREMENTS];
  for (int j = 0; j < MEASUREMENTS; ++j)
    coordinates[j] = plane_of(p, planes, r->light + j)[at];
  mix(tables + p->to_measurements, coordinates, electrons);
  for (int k = 0; k < MEASUREMENTS; ++k)
    numbers[k] = electrons[k] * tables[p->raw_per_e + k] + tables[p->dark_raw + k];
  if (!(plane_of(p, planes, PLANE_USABLE)[at] > 0.0f)) return 1.0f;
  const float single = p->has_own_shot_noise
                           ? plane_of(p, planes, PLANE_VARIANCE)[at] * averaged_before
                           : variance_of_coordinate(p, tables, electrons);
  const float n = single / plane_of(p, planes, r->last_variance)[at];
  return n < 1e-3f ? 1e-3f : n;
}

/// As near_square().
float near_square(const struct FilterParameters* p, global float* planes, int near, int at) {
  float square = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const float u = plane_of(p, planes, near + j)[at];
    square = product_plus(u, u, square);
  }
  return square;
}

/// As keep_share().
void keep_share(const struct FilterParameters* p, global float* planes, int near, int far_light,
                int far_variance, int at, float kept, float share2, float near_variance) {
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const Plane light = plane_of(p, planes, far_light + k);
    const float far = light[at];
    light[at] = product_plus(kept, plane_of(p, planes, near + k)[at] - far, far);
  }
  const Plane variance = plane_of(p, planes, far_variance);
  const float far = variance[at], more = near_variance - far;
  const float beyond = LARGER(more, 0.0f);
  variance[at] = product_plus(share2, beyond, far);
}

/// As keep_bright().
kernel void keep_bright(const struct FilterParameters p, const struct SimilarParameters w,
                        global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const float square = near_square(&p, planes, w.light, at);
  const float variance = plane_of(&p, planes, w.variance_in)[at];
  const float near_variance = LARGER(variance, 1e-12f);
  const float beyond_least = product_plus(sqrt(square / near_variance), 1.0f / BRIGHT_SIGMA, -1.0f);
  const float above_none = LARGER(beyond_least, 0.0f), kept = SMALLER(above_none, 1.0f);
  if (kept > 0.0f)
    keep_share(&p, planes, w.light, w.to, w.variance_out, at, kept, kept * kept, near_variance);
}

/// Writes raw numbers and saves the variance for later steps.
kernel void write_raw(const struct FilterParameters p, const struct ResultParameters r,
                      Floats tables, Floats averaged_before, global float* planes,
                      global float* raw, global float* averaged) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x, pixel = y * p.width + x, pixels = p.width * p.height;
  float numbers[MEASUREMENTS];
  averaged[pixel] = raw_of_light(&p, &r, tables, averaged_before ? averaged_before[pixel] : 1.0f,
                                 planes, at, numbers);
  for (int k = 0; k < MEASUREMENTS; ++k) raw[(size_t)k * pixels + pixel] = numbers[k];
  plane_of(&p, planes, PLANE_BEFORE)[at] = plane_of(&p, planes, r.last_variance)[at];
}

/// <u, v> of the filtered light u of `added` and the measured light v of `measured`.
float along_added(const struct FilterParameters* p, const struct ResultParameters* r,
                  global float* planes, int added, int measured) {
  float sum = 0.0f;
  for (int j = 0; j < RANK; ++j)
    sum = product_plus(plane_of(p, planes, r->light + j)[added],
                       plane_of(p, planes, r->measured + j)[measured], sum);
  return sum;
}

float added_square(const struct FilterParameters* p, const struct ResultParameters* r,
                   global float* planes, int at) {
  float square = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const float u = plane_of(p, planes, r->light + j)[at];
    square = product_plus(u, u, square);
  }
  return square;
}

/// As find_own_light() on the CPU.
bool is_own_light(const struct FilterParameters* p, const struct ResultParameters* r,
                  global float* planes, int at) {
  const float mean_noise = OWN_LIGHT_NOISE / (float)(2 * OWN_LIGHT_REACH + 1);
  const float square = added_square(p, r, planes, at);
  const Plane usable = plane_of(p, planes, PLANE_USABLE);
  if (!(square > 0.0f && usable[at] > 0.5f)) return false;
  const float added = sqrt(square), sigma = sqrt(plane_of(p, planes, PLANE_VARIANCE)[at]);
  const float limit = p->own_light_sigma * mean_noise * sigma;
  const float evident = EVIDENT_SIGMA * sigma * added;
  if (added <= limit || along_added(p, r, planes, at, at) >= evident) return true;
  const float of_noise = OWN_LIGHT_LEAST_SIGMA * mean_noise * sigma;
  const float of_added = OWN_LIGHT_LEAST_SHARE * added, open = added - limit;
  const float share = LARGER(of_noise, of_added);
  const float least =
      product_plus(-OWN_LIGHT_BELOW_MEAN, sigma, SMALLER(share, open)) * added;
  float count = 0.0f, below = 0.0f;
  for (int dy = -OWN_LIGHT_REACH; dy <= OWN_LIGHT_REACH; ++dy)
    for (int dx = -OWN_LIGHT_REACH; dx <= OWN_LIGHT_REACH; ++dx) {
      const int pixel = at + dy * p->stride + dx;
      count += usable[pixel];
      below += along_added(p, r, planes, at, pixel) < least ? usable[pixel] : 0.0f;
    }
  return below <= OWN_LIGHT_SHARE * count;
}

kernel void find_own_light(const struct FilterParameters p, const struct ResultParameters r,
                           global float* planes, const int to) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  plane_of(&p, planes, to)[at] = is_own_light(&p, &r, planes, at) ? 1.0f : 0.0f;
}

kernel void leave_dark(const struct FilterParameters p, global float* planes, const int is_own) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  plane_of(&p, planes, PLANE_USABLE)[at] = plane_of(&p, planes, is_own)[at];
}

/// As find_own_amplitude() on the CPU.
kernel void find_own_amplitude(const struct FilterParameters p, const struct ResultParameters r,
                               global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const float square = added_square(&p, &r, planes, at);
  const bool is_known = square > 0.0f && plane_of(&p, planes, PLANE_USABLE)[at] > 0.5f;
  const float length = sqrt(square) * sqrt(plane_of(&p, planes, PLANE_VARIANCE)[at]);
  const float along = product_plus(-(float)(RANK - 1), plane_of(&p, planes, r.last_variance)[at],
                                   along_added(&p, &r, planes, at, at));
  plane_of(&p, planes, PLANE_AMPLITUDE)[at] = is_known ? along / length : 0.0f;
}

/// As least_of_bars() on the CPU.
/// @param point, scale  first point and first scale of the bar
float least_of_bars(const struct FilterParameters* p, Plane amplitude, int at, int bar, int point,
                    int scale, float most) {
  float least = 1e30f;
  for (int direction = 0; direction < LIT_DIRECTIONS; ++direction) {
    float sum = 0.0f, shown = -1e30f;
    for (int row = 0; row < lit_depths[bar]; ++row) {
      for (int i = 0; i < lit_lengths[bar]; ++i, ++point) {
        const float light =
            amplitude[at + lit_point_rows[point] * p->stride + lit_point_columns[point]];
        sum += SMALLER(light, most);
      }
      const float of_rows = sum * lit_scales[scale + row];
      shown = LARGER(shown, of_rows);
    }
    least = SMALLER(least, shown);
  }
  return least;
}

/// As mean_around() on the CPU.
float mean_around(const struct FilterParameters* p, Plane amplitude, int at) {
  float sum = 0.0f;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum += amplitude[at + dy * p->stride + dx];
  return sum * (1.0f / 9.0f);
}

/// As brightest_around() on the CPU.
float brightest_around(const struct FilterParameters* p, Plane amplitude, int at) {
  float brightest = -1e30f;
  for (int dy = -LIT_BRIGHT_REACH; dy <= LIT_BRIGHT_REACH; ++dy)
    for (int dx = -LIT_BRIGHT_REACH; dx <= LIT_BRIGHT_REACH; ++dx) {
      const float mean = mean_around(p, amplitude, at + dy * p->stride + dx);
      brightest = LARGER(brightest, mean);
    }
  return brightest;
}

/// As find_lit_share().
float lit_share(const struct FilterParameters* p, const struct ResultParameters* r,
                global float* planes, int at) {
  const Plane amplitude = plane_of(p, planes, PLANE_AMPLITUDE);
  if (!(plane_of(p, planes, PLANE_USABLE)[at] > 0.5f) || amplitude[at] >= LIT_PIXEL_SIGMA)
    return 1.0f;
  const float square = added_square(p, r, planes, at);
  const float added = sqrt(square) / sqrt(plane_of(p, planes, PLANE_VARIANCE)[at]);
  const float most = added + LIT_EXCESS_SIGMA;
  const float around = mean_around(p, amplitude, at);
  const bool is_alone = plane_of(p, planes, PLANE_REJECTED)[at] > LIT_ALONE_SHARE;
  bool can_be_lit =
      !is_alone && (added <= LIT_AROUND_SIGMA || around >= added * LIT_BAR_SHARE);
  int point = 0, scale = 0;
  for (int bar = 0; bar < LIT_BARS; ++bar) {
    if (bar == LIT_SMALL_BARS && can_be_lit) {
      const float above = brightest_around(p, amplitude, at) - LIT_BRIGHT_SIGMA;
      can_be_lit = around >= above * LIT_BRIGHT_SHARE;
    }
    if (can_be_lit && added <= lit_max_added[bar]) {
      const float of_added = added * (LIT_BAR_SHARE / lit_scales[scale]);
      const float least = least_of_bars(p, amplitude, at, bar, point, scale, most);
      const float enough = added * lit_enough[bar];
      const float of_bar = SMALLER(LIT_BAR_SIGMA, enough);
      if (least >= LARGER(of_bar, of_added)) return 1.0f;
    }
    point += LIT_DIRECTIONS * lit_depths[bar] * lit_lengths[bar];
    scale += lit_depths[bar];
  }
  const float variance = plane_of(p, planes, r->last_variance)[at];
  return variance / (variance + square);
}

/// As deviation_factor() on the CPU.
float deviation_factor(float rejected, float averaged) {
  const float near =
      clamp((rejected - EDGE_BIAS_FROM) / (EDGE_BIAS_FULL - EDGE_BIAS_FROM), 0.0f, 1.0f);
  const float any_beyond = rejected - EDGE_BIAS_FULL, any_more = averaged - 1.0f;
  const float alone = LARGER(any_beyond, 0.0f) * LARGER(any_more, 0.0f);
  return sqrt((1.0f + EDGE_BIAS_NEAR * near) + alone);
}

/// Pixels without additions keep their measured numbers.
/// @param factors  of the deviations; null: not written
kernel void write_filtered(const struct FilterParameters p, const struct ResultParameters r,
                           const struct TileParameters tile, Floats tables,
                           global const uchar* raw_numbers, Floats averaged_before,
                           global float* planes, global float* raw, global float* averaged,
                           global float* factors) {
  const int x = (int)get_global_id(0), row = (int)get_global_id(1), y = r.first_row + row;
  if (x >= p.width || row >= r.rows) return;
  const int at = y * p.stride + x, measured = y * p.width + x;
  const int pixel = row * p.width + x, pixels = p.width * r.rows;
  const float before = averaged_before ? averaged_before[measured] : 1.0f;
  float numbers[MEASUREMENTS];
  float n = raw_of_light(&p, &r, tables, before, planes, at, numbers), factor = 1.0f;
  if (is_own_light(&p, &r, planes, at)) {
    n *= lit_share(&p, &r, planes, at);
    const float single = plane_of(&p, planes, PLANE_VARIANCE)[at];
    if (factors)
      factor = deviation_factor(plane_of(&p, planes, PLANE_REJECTED)[at],
                                single / plane_of(&p, planes, r.last_variance)[at]);
  } else {
    n = before;
    for (int k = 0; k < MEASUREMENTS; ++k)
      numbers[k] = raw_number(&tile, raw_numbers, measured, k);
  }
  averaged[pixel] = n;
  if (factors) factors[pixel] = factor;
  for (int k = 0; k < MEASUREMENTS; ++k) raw[(size_t)k * pixels + pixel] = numbers[k];
}
