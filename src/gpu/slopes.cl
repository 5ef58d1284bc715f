// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Rounds of a Filter along slopes, as slope_rounds.cpp and slope_kernel.cpp, which explain the
// steps. Compiled after windows.cl.

/// Pixels without depth become unusable.
kernel void take_depth(const struct FilterParameters p, Floats depth_m, Floats deviation_m,
                       global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x, pixel = y * p.width + x;
  const Plane usable = plane_of(&p, planes, PLANE_USABLE);
  const float depth = depth_m[pixel], deviation = deviation_m[pixel] * p.bins_per_m;
  const bool is_known = usable[at] > 0.0f && isfinite(depth) && isfinite(deviation);
  usable[at] = is_known ? 1.0f : 0.0f;
  plane_of(&p, planes, PLANE_DEPTH)[at] = is_known ? depth * p.bins_per_m : 0.0f;
  plane_of(&p, planes, PLANE_DEPTH_VARIANCE)[at] = is_known ? deviation * deviation : 1.0f;
}

float nearest(float difference, float samples, float per_sample) {
  return product_plus(-rint(difference * per_sample), samples, difference);
}

// ---- Slopes.

struct SlopeSums {
  float xx, xy, yy, xd, yd;
};

void add_slope(struct SlopeSums* s, float weight, float x, float y, float difference) {
  const float d = weight * difference;
  s->xx = product_plus(weight, x * x, s->xx);
  s->xy = product_plus(weight, x * y, s->xy);
  s->yy = product_plus(weight, y * y, s->yy);
  s->xd = product_plus(d, x, s->xd);
  s->yd = product_plus(d, y, s->yd);
}

float2 slopes_of(const struct SlopeSums* s) {
  const float little = product_plus(s->xx + s->yy, 1e-4f, 1e-20f);
  const float a = s->xx + little, b = s->yy + little;
  const float inverse = 1.0f / product_plus(-s->xy, s->xy, a * b);
  return (float2)(product_plus(-s->xy, s->yd, b * s->xd) * inverse,
                  product_plus(-s->xy, s->xd, a * s->yd) * inverse);
}

struct Neighbour {
  float difference, noise, usable;
};

struct Neighbour neighbour_of(const struct FilterParameters* p, global float* planes, int at,
                              int other) {
  const Plane depth = plane_of(p, planes, PLANE_DEPTH);
  const float samples = (float)p->samples;
  const float variance = plane_of(p, planes, PLANE_DEPTH_VARIANCE)[other];
  struct Neighbour n;
  n.difference = nearest(depth[other] - depth[at], samples, 1.0f / samples);
  n.noise = LARGER(variance, MIN_DEPTH_VARIANCE);
  n.usable = plane_of(p, planes, PLANE_USABLE)[other];
  return n;
}

kernel void find_slopes(const struct FilterParameters p, global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const float variance = plane_of(&p, planes, PLANE_DEPTH_VARIANCE)[at];
  const float inverse_max = 1.0f / (4.0f * p.same_depth_sigma2);
  const float inverse_max_pair = 1.0f / (2.0f * p.same_depth_sigma2);
  struct SlopeSums pairs = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  for (int i = 0; i < HALF_RINGS; ++i) {
    const int away = half_ring_rows[i] * p.stride + half_ring_columns[i];
    const struct Neighbour ahead = neighbour_of(&p, planes, at, at + away);
    const struct Neighbour behind = neighbour_of(&p, planes, at, at - away);
    const float both = ahead.usable * behind.usable;
    const float bend = ahead.difference + behind.difference, noise = ahead.noise + behind.noise;
    const float all_noise = product_plus(variance, 4.0f, noise);
    const float w = weight_of(bend * bend / all_noise, inverse_max_pair) * both / noise;
    add_slope(&pairs, w, (float)half_ring_columns[i], (float)half_ring_rows[i],
              (ahead.difference - behind.difference) * 0.5f);
  }
  float2 slopes = slopes_of(&pairs);
  struct SlopeSums singles = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  float chi2 = 0.0f, count = 0.0f;
  for (int i = 0; i < 2 * HALF_RINGS; ++i) {
    const int sign = i % 2 == 0 ? 1 : -1;
    const int rows = sign * half_ring_rows[i / 2], columns = sign * half_ring_columns[i / 2];
    const struct Neighbour n = neighbour_of(&p, planes, at, at + rows * p.stride + columns);
    const float expected =
        product_plus(slopes.x, (float)columns, slopes.y * (float)rows);
    const float beyond = n.difference - expected;
    const float squares = beyond * beyond / (n.noise + variance);
    const float w = weight_of(squares, inverse_max) * n.usable / n.noise;
    add_slope(&singles, w, (float)columns, (float)rows, n.difference);
    if (i < 2 * FIRST_FAR_RING) continue;
    const float robust_weight = weight_of(squares, inverse_max * 0.25f) * n.usable;
    chi2 = product_plus(robust_weight, squares, chi2);
    count += robust_weight;
  }
  slopes = slopes_of(&singles);
  // Scatter of far neighbours relative to its predicted variance.
  const float excess = chi2 / LARGER(count, 1e-6f);
  plane_of(&p, planes, PLANE_BEFORE)[at] *= LARGER(excess, 1.0f);
  const bool usable = plane_of(&p, planes, PLANE_USABLE)[at] > 0.0f;
  plane_of(&p, planes, PLANE_SLOPE_X)[at] = usable ? slopes.x : 0.0f;
  plane_of(&p, planes, PLANE_SLOPE_Y)[at] = usable ? slopes.y : 0.0f;
}

// ---- Light along the curve.

/// Position between two bins: offsets of their points, and weight of the second.
struct CurvePlace {
  int from, to;
  float share;
};

/// @param bin  in [-N, 2 N)
struct CurvePlace place_of(const struct FilterParameters* p, float bin) {
  const float samples = (float)p->samples;
  bin += bin < 0.0f ? samples : 0.0f;
  bin -= bin >= samples ? samples : 0.0f;
  const int at = clamp((int)bin, 0, p->samples - 1);
  struct CurvePlace place;
  place.share = bin - (float)at;
  place.from = p->curve + at * MEASUREMENTS;
  place.to = p->curve + (at < p->samples - 1 ? at + 1 : 0) * MEASUREMENTS;
  return place;
}

float on_curve(const struct CurvePlace* place, Floats tables, int k) {
  const float a = tables[place->from + k], b = tables[place->to + k];
  return product_plus(place->share, b - a, a);
}

float per_bin(const struct CurvePlace* place, Floats tables, int k) {
  return tables[place->to + k] - tables[place->from + k];
}

kernel void split(const struct FilterParameters p, const struct SlopeParameters w, Floats tables,
                  global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const struct CurvePlace place = place_of(&p, plane_of(&p, planes, PLANE_DEPTH)[at]);
  float along = 0.0f, own = 1e-30f;
  for (int k = 0; k < RANK; ++k) {
    const float point = on_curve(&place, tables, k);
    along = product_plus(point, plane_of(&p, planes, w.light + k)[at], along);
    own = product_plus(point, point, own);
  }
  const bool is_guided = plane_of(&p, planes, PLANE_USABLE)[at] > 0.0f;
  const float signal = is_guided ? along / own : 0.0f;
  plane_of(&p, planes, PLANE_SIGNAL)[at] = signal;
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float in = plane_of(&p, planes, w.light + k)[at];
    plane_of(&p, planes, w.rest + k)[at] =
        product_plus(-signal, on_curve(&place, tables, k), in);
  }
}

/// Weight of a pair, and its product with the depth deviation from the slope.
struct SlopePair {
  float weight, shifted;
};

struct SlopePair pair_of(const struct FilterParameters* p, global float* planes, int at, int away,
                         float half_down, float half_right) {
  const int other = at + away;
  const Plane slope_x = plane_of(p, planes, PLANE_SLOPE_X);
  const Plane slope_y = plane_of(p, planes, PLANE_SLOPE_Y);
  const Plane depth = plane_of(p, planes, PLANE_DEPTH);
  const Plane variances = plane_of(p, planes, PLANE_DEPTH_VARIANCE);
  const Plane usable = plane_of(p, planes, PLANE_USABLE);
  const float across = slope_x[at] + slope_x[other], along = slope_y[at] + slope_y[other];
  const float expected = product_plus(across, half_right, along * half_down);
  const float difference = (depth[other] - depth[at]) - expected;
  const float samples = (float)p->samples;
  const float beyond = nearest(difference, samples, 1.0f / samples);
  const float both = variances[at] + variances[other];
  const float variance = LARGER(both, MIN_DEPTH_VARIANCE);
  const float squares = beyond * beyond / (p->same_depth_sigma2 * variance);
  struct SlopePair pair;
  pair.weight =
      weight_of(squares - 1.0f, p->inverse_max_difference) * (usable[at] * usable[other]);
  pair.shifted = pair.weight * beyond;
  return pair;
}

/// Adds the signal to the remaining light, at the depth plus shift / signal.
void join(const struct FilterParameters* p, Floats tables, global float* planes, int light, int at,
          float signal, float shift) {
  const float beyond = signal > fabs(shift) * 0.25f ? shift / signal : 0.0f;
  const struct CurvePlace place = place_of(p, plane_of(p, planes, PLANE_DEPTH)[at] + beyond);
  const float added = plane_of(p, planes, PLANE_USABLE)[at] > 0.0f ? signal : 0.0f;
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const Plane plane = plane_of(p, planes, light + k);
    plane[at] = product_plus(added, on_curve(&place, tables, k), plane[at]);
  }
}

/// As share_of_light().
float share_of_light(float light, float opposite) {
  const float share = BALANCED_LIGHT * opposite / LARGER(light, 1e-30f);
  return SMALLER(share, 1.0f);
}

/// Fractions of a pair's weights that remain after balancing.
struct BalancedPair {
  float ahead, behind;
};

struct BalancedPair balanced_pair(float light_ahead, float light_behind) {
  const float ahead = LARGER(light_ahead, 0.0f), behind = LARGER(light_behind, 0.0f);
  struct BalancedPair shares;
  shares.ahead = share_of_light(ahead, behind);
  shares.behind = share_of_light(behind, ahead);
  return shares;
}

/// As balance_row().
float balanced_part(const struct FilterParameters* p, const struct SlopeParameters* w,
                    Floats tables, global float* planes, int at) {
  const Plane variances = plane_of(p, planes, w->variance_in);
  const Plane signals = plane_of(p, planes, PLANE_SIGNAL);
  float light = signals[at], noise = variances[at], light_balanced = light, noise_balanced = noise;
  float across = 0.0f, along = 0.0f;
  for (int i = 0; i < HALF_WINDOW; ++i) {
    const int down = half_window_rows[i] * w->step, right = half_window_columns[i] * w->step;
    const int away = down * p->stride + right;
    const float half_down = 0.5f * (float)down, half_right = 0.5f * (float)right;
    const float ahead = pair_of(p, planes, at, away, half_down, half_right).weight;
    const float behind = pair_of(p, planes, at - away, away, half_down, half_right).weight;
    const float light_ahead = ahead * signals[at + away];
    const float light_behind = behind * signals[at - away];
    const struct BalancedPair shares = balanced_pair(light_ahead, light_behind);
    const float apart = light_ahead - light_behind;
    light += light_ahead + light_behind;
    light_balanced = product_plus(shares.ahead, light_ahead, light_balanced);
    light_balanced = product_plus(shares.behind, light_behind, light_balanced);
    across = product_plus(apart, (float)half_window_columns[i], across);
    along = product_plus(apart, (float)half_window_rows[i], along);
    const float noise_ahead = ahead * ahead * variances[at + away];
    const float noise_behind = behind * behind * variances[at - away];
    noise += noise_ahead + noise_behind;
    noise_balanced = product_plus(shares.ahead * shares.ahead, noise_ahead, noise_balanced);
    noise_balanced = product_plus(shares.behind * shares.behind, noise_behind, noise_balanced);
  }
  const float light_square = light * light, balanced_square = light_balanced * light_balanced;
  const float light2 = LARGER(light_square, 1e-30f), balanced2 = LARGER(balanced_square, 1e-30f);
  const float squares = product_plus(across, across, along * along);
  const float most = light2 * (float)(WINDOW_REACH * WINDOW_REACH);
  const float offset2 = SMALLER(squares, most) / light2;
  const float slope_x = plane_of(p, planes, PLANE_SLOPE_X)[at];
  const float slope_y = plane_of(p, planes, PLANE_SLOPE_Y)[at];
  const float slope2 = product_plus(slope_x, slope_x, slope_y * slope_y);
  const int bin = clamp((int)plane_of(p, planes, PLANE_DEPTH)[at], 0, p->samples - 1);
  const float step = (float)w->step;
  const float by = SLOPE_ERROR_SHARE * SLOPE_ERROR_SHARE * step * step;
  const float error2 = by * offset2 * slope2 * tables[p->squares + 2 * bin];
  const bool is_seen = light2 * tables[p->squares + 2 * bin + 1] > BALANCED_ENERGY * noise;
  const float any_more = noise_balanced / balanced2 - noise / light2;
  const float either = error2 + LARGER(any_more, 0.0f);
  const float wanted = error2 / LARGER(either, 1e-30f);
  const float of_balanced = wanted * light, of_all = (1.0f - wanted) * light_balanced;
  const float of_both = of_balanced + of_all;
  const bool is_lit = is_seen && light > 0.0f && light_balanced > 0.0f;
  return is_lit ? of_balanced / LARGER(of_both, 1e-30f) : 0.0f;
}

/// Averages one window along slopes. After the last window, PLANE_SIGNAL_NEXT contains the squared
/// distance of the centroid of the added light.
kernel void add_along_slopes(const struct FilterParameters p, const struct SlopeParameters w,
                             Floats tables, global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const Plane variances = plane_of(&p, planes, w.variance_in);
  const Plane signals = plane_of(&p, planes, PLANE_SIGNAL);
  float sum[MEASUREMENTS];
  for (int k = 0; k < MEASUREMENTS; ++k) sum[k] = plane_of(&p, planes, w.rest + k)[at];
  const float part = w.is_balanced ? balanced_part(&p, &w, tables, planes, at) : 0.0f;
  float signal = signals[at], variance = variances[at], weight = 1.0f, shift = 0.0f;
  float others = 0.0f;
  float middle = signal, across = 0.0f, along = 0.0f;
  for (int i = 0; i < HALF_WINDOW; ++i) {
    const int down = half_window_rows[i] * w.step, right = half_window_columns[i] * w.step;
    const int away = down * p.stride + right;
    const float half_down = 0.5f * (float)down, half_right = 0.5f * (float)right;
    struct SlopePair ahead = pair_of(&p, planes, at, away, half_down, half_right);
    struct SlopePair behind = pair_of(&p, planes, at - away, away, half_down, half_right);
    if (w.is_balanced) {
      const struct BalancedPair shares = balanced_pair(ahead.weight * signals[at + away],
                                                       behind.weight * signals[at - away]);
      const float left_ahead = product_plus(-part, 1.0f - shares.ahead, 1.0f);
      const float left_behind = product_plus(-part, 1.0f - shares.behind, 1.0f);
      ahead.weight *= left_ahead;
      ahead.shifted *= left_ahead;
      behind.weight *= left_behind;
      behind.shifted *= left_behind;
    }
    weight += ahead.weight + behind.weight;
    others += ahead.weight + behind.weight;
    variance = product_plus(ahead.weight * ahead.weight, variances[at + away], variance);
    variance = product_plus(behind.weight * behind.weight, variances[at - away], variance);
    const float signal_ahead = signals[at + away], signal_behind = signals[at - away];
    signal = product_plus(ahead.weight, signal_ahead, signal);
    signal = product_plus(behind.weight, signal_behind, signal);
    shift = product_plus(ahead.shifted, signal_ahead, shift);
    shift = product_plus(-behind.shifted, signal_behind, shift);
    const float of_ahead = ahead.weight * signal_ahead, of_behind = behind.weight * signal_behind;
    const float apart = of_ahead - of_behind;
    middle += of_ahead + of_behind;
    across = product_plus(apart, (float)half_window_columns[i], across);
    along = product_plus(apart, (float)half_window_rows[i], along);
    for (int k = 0; k < MEASUREMENTS; ++k) {
      const Plane in = plane_of(&p, planes, w.rest + k);
      sum[k] = product_plus(ahead.weight, in[at + away], sum[k]);
      sum[k] = product_plus(behind.weight, in[at - away], sum[k]);
    }
  }
  const float inverse = 1.0f / weight;
  plane_of(&p, planes, w.variance_out)[at] = variance * (inverse * inverse);
  for (int k = 0; k < MEASUREMENTS; ++k) plane_of(&p, planes, w.to + k)[at] = sum[k] * inverse;
  join(&p, tables, planes, w.to, at, signal * inverse, shift * inverse);
  if (!w.is_balanced)
    plane_of(&p, planes, PLANE_REJECTED)[at] = rejected_share(&p, w.step, x, y, others);
  if (!w.is_last) return;
  const float squares = product_plus(across, across, along * along);
  const float most = middle * middle * (float)(WINDOW_REACH * WINDOW_REACH);
  const float least = middle * middle;
  plane_of(&p, planes, PLANE_SIGNAL_NEXT)[at] = SMALLER(squares, most) / LARGER(least, 1e-30f);
}

// ---- Near sums that are kept.

/// Computes the difference of depth between the sums before and after a window in standard
/// deviations. First restores the light before the window.
kernel void compare_sums(const struct FilterParameters p, const struct SlopeParameters w,
                         Floats tables, global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  join(&p, tables, planes, w.rest, at, plane_of(&p, planes, PLANE_SIGNAL)[at], 0.0f);
  const struct CurvePlace place = place_of(&p, plane_of(&p, planes, PLANE_DEPTH)[at]);
  float far2 = 0.0f, dot_product = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const float far = plane_of(&p, planes, w.to + j)[at];
    far2 = product_plus(far, far, far2);
    dot_product = product_plus(per_bin(&place, tables, j), far, dot_product);
  }
  const float along = dot_product / LARGER(far2, 1e-30f);
  float moved = 0.0f, move2 = 1e-30f;
  for (int j = 0; j < RANK; ++j) {
    const float far = plane_of(&p, planes, w.to + j)[at];
    const float move = product_plus(-along, far, per_bin(&place, tables, j));
    moved = product_plus(move, plane_of(&p, planes, w.rest + j)[at], moved);
    move2 = product_plus(move, move, move2);
  }
  const float variance = plane_of(&p, planes, w.variance_in)[at];
  const float near_variance = LARGER(variance, 1e-12f);
  const float less = near_variance - plane_of(&p, planes, w.variance_out)[at];
  const float least = near_variance * LEAST_NOISE_SHARE, noise = LARGER(less, least);
  const bool is_known = plane_of(&p, planes, PLANE_USABLE)[at] > 0.0f &&
                       far2 > near_variance * LEAST_ENERGY;
  plane_of(&p, planes, PLANE_SHIFT)[at] = is_known ? moved / sqrt(move2 * noise) : 0.0f;
}

kernel void keep_near(const struct FilterParameters p, const struct SlopeParameters w,
                      global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  const Plane usable = plane_of(&p, planes, PLANE_USABLE);
  const Plane difference = plane_of(&p, planes, PLANE_SHIFT);
  float squares = 0.0f, sum_around = 0.0f, count = 0.0f;
  for (int dy = -COMPARED_REACH; dy <= COMPARED_REACH; dy += COMPARED_STEP)
    for (int dx = -COMPARED_REACH; dx <= COMPARED_REACH; dx += COMPARED_STEP) {
      const int pixel = at + dy * p.stride + dx;
      const float d = difference[pixel];
      squares = product_plus(usable[pixel] * d, d, squares);
      sum_around = product_plus(usable[pixel], d, sum_around);
      count += usable[pixel];
    }
  const float around = squares / LARGER(count, 1.0f) - EXPLAINED_BY_NOISE;
  const float per_pixel = 1.0f / LARGER(count, 1.0f), mean_around = sum_around * per_pixel;
  const float bent = product_plus(-per_pixel, EXPLAINED_IN_PATCH, mean_around * mean_around);
  float best = 0.0f;
  for (int i = 0; i < LINE_DIRECTIONS; ++i) {
    const int away = LINE_STEP * (line_direction_rows[i] * p.stride + line_direction_columns[i]);
    float sum = 0.0f, on_line = 0.0f;
    for (int place = -LINE_SIDE; place <= LINE_SIDE; ++place) {
      const int pixel = at + place * away;
      sum = product_plus(usable[pixel], difference[pixel], sum);
      on_line += usable[pixel];
    }
    const float inverse = 1.0f / LARGER(on_line, 1.0f), mean = sum * inverse;
    const float excess = product_plus(-inverse, EXPLAINED_ALONG_LINES, mean * mean);
    best = LARGER(best, excess);
  }
  const float near_variance = plane_of(&p, planes, w.variance_in)[at];
  const float bright = near_variance * (BRIGHT_SIGMA * BRIGHT_SIGMA);
  const float if_bright = near_square(&p, planes, w.rest, at) > bright ? bent : 0.0f;
  best = LARGER(best, if_bright);
  const float excess = LARGER(around, 0.0f);
  const float by_all = excess / (excess + HALF_KEPT), by_line = best / (best + HALF_KEPT_ALONG_LINES);
  const float kept = LARGER(by_all, by_line);
  plane_of(&p, planes, PLANE_SIGNAL)[at] = kept;
  if (kept > 0.0f)
    keep_share(&p, planes, w.rest, w.to, w.variance_out, at, kept, kept * kept * KEPT_NOISE,
               near_variance);
}

kernel void add_slope_noise(const struct FilterParameters p, const struct SlopeNoiseParameters n,
                            global float* planes) {
  const int x = (int)get_global_id(0), y = (int)get_global_id(1);
  if (x >= p.width || y >= p.height) return;
  const int at = y * p.stride + x;
  if (!(plane_of(&p, planes, PLANE_USABLE)[at] > 0.0f)) return;
  const float far_share =
      n.has_near_share ? 1.0f - plane_of(&p, planes, PLANE_SIGNAL)[at] : 1.0f;
  const float d2 = n.is_last ? plane_of(&p, planes, PLANE_SIGNAL_NEXT)[at] : 0.0f;
  const float of_sum = n.sum + n.sum_offset * d2;
  const Plane variance = plane_of(&p, planes, n.variance);
  const float before = plane_of(&p, planes, PLANE_BEFORE)[at];
  const float any_of_near = before / plane_of(&p, planes, n.near_variance)[at];
  const float of_near = SLOPE_NOISE_OF_NEAR * (any_of_near < 1.0f ? any_of_near : 1.0f);
  const float of_before = n.is_last ? n.before * (1.0f - of_near) + n.before_offset * d2 : 0.0f;
  variance[at] +=
      far_share * far_share * (of_sum * variance[at] + of_before * before);
}
