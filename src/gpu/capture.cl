// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Captures, as PixelCapture makes them, one item a pixel. Compiled behind random.cl and
// capture_parameters.h.

/// A number and what it may differ by from that of the processor.
struct Drawn {
  double value, error;
};

/// As RandomStream.
struct Stream {
  uint4 counter;  ///< block, frame, pixel
  uint2 key;
  uint2 kept_words;
  double kept_normal, kept_error;
  int has_words, has_normal;
  struct Doubt doubt;
};

struct Stream stream_of(const struct CaptureStream* of, int pixel, double margin) {
  const ulong number = (((ulong)of->first_high << 32) | of->first_low) + (ulong)pixel;
  struct Stream s;
  s.counter = (uint4)(0u, of->frame, (uint)number, (uint)(number >> 32));
  s.key = (uint2)(of->seed_low, of->seed_high);
  s.kept_words = (uint2)(0u, 0u);
  s.kept_normal = s.kept_error = 0.0;
  s.has_words = s.has_normal = s.doubt.is_open = 0;
  s.doubt.margin = margin;
  s.doubt.step = 0.0;
  return s;
}

/// All that is drawn takes two words.
uint2 next_words(struct Stream* s) {
  if (s->has_words) {
    s->has_words = 0;
    return s->kept_words;
  }
  const uint4 words = philox(s->counter, s->key);
  s->counter.x += 1u;
  s->kept_words = words.zw;
  s->has_words = 1;
  return words.xy;
}

/// Standard normal numbers, in pairs: of them the length is off by 3 units of the last bit, the
/// cosine or sine by 5, and their product is rounded.
struct Drawn next_normal(struct Stream* s) {
  struct Drawn normal;
  if (s->has_normal) {
    s->has_normal = 0;
    normal.value = s->kept_normal;
    normal.error = s->kept_error;
    return normal;
  }
  const double radius = sqrt(-2.0 * log(1.0 - uniform_of(next_words(s))));
  const double angle = 2.0 * M_PI * uniform_of(next_words(s));
  s->kept_normal = radius * sin(angle);
  s->kept_error = 4e-15 * s->doubt.margin * fabs(s->kept_normal);
  s->has_normal = 1;
  normal.value = radius * cos(angle);
  normal.error = 4e-15 * s->doubt.margin * fabs(normal.value);
  return normal;
}

/// The number that lies nearest, if all within the bound have the same.
double whole(struct Stream* s, double value, double bound) {
  if (round(value - bound) != round(value + bound)) s->doubt.is_open = 1;
  return round(value);
}

double next_poisson(struct Stream* s, double mean) {
  if (!(mean > 0.0)) return 0.0;
  if (mean > 1e9) {
    const struct Drawn normal = next_normal(s);
    const double root = sqrt(mean);
    return whole(s, mean + root * normal.value,
                 root * normal.error + 1e-15 * s->doubt.margin * mean);
  }
  for (;;) {
    const uint2 words = next_words(s);
    if (mean < 10.0) return inverted_poisson(&s->doubt, mean, words);
    const double k = attempted_poisson(&s->doubt, mean, words);
    if (k >= 0.0 || s->doubt.is_open) return k;
  }
}

/// Light of a pixel before noise.
struct PixelLight {
  double signal_e_per_s, ambient_e_per_s;
  int cell;      ///< of the table of chi
  double share;  ///< of the way to the next
  Doubles taps;  ///< of every tap value, where it is collected; no cell then
};

/// As pixel_signal_e_per_s() and FineCorrelation::at().
struct PixelLight light_of(const struct CaptureParameters* p, int pixel, Floats depth,
                           Floats albedo, Floats cosine, Floats ambient_scale, Doubles collected,
                           Doubles ambient) {
  struct PixelLight light;
  light.taps = collected;
  light.cell = 0;
  light.share = light.signal_e_per_s = 0.0;
  if (p->is_collected) {
    light.taps = collected + (size_t)pixel * (size_t)p->taps;
    light.ambient_e_per_s = p->has_ambient ? ambient[pixel] : p->ambient_e_per_s;
    return light;
  }
  light.ambient_e_per_s =
      p->ambient_e_per_s * (p->has_ambient ? (double)ambient_scale[pixel] : 1.0);
  const double depth_m = depth[pixel];
  if (isnan(depth_m)) return light;
  light.signal_e_per_s = p->signal_e_per_s * (double)albedo[pixel];
  if (p->has_falloff) {
    const double distance = depth_m / p->reference_distance_m;
    light.signal_e_per_s = light.signal_e_per_s * (double)cosine[pixel] / (distance * distance);
  }
  const double wrapped = depth_m - p->range_m * floor(depth_m / p->range_m);
  const double position =
      (wrapped < p->range_m ? wrapped : 0.0) / p->bin_m * p->points_per_bin;
  light.cell = clamp((int)position, 0, p->points - 1);
  light.share = position - (double)light.cell;
  return light;
}

/// Electrons that are expected of a tap value.
double expected(const struct CaptureParameters* p, const struct PixelLight* light, Doubles chi,
                Doubles exposure_s, Doubles ambient_gain, int j) {
  double returned;
  if (p->is_collected) {
    returned = light->taps[j];
  } else {
    Doubles below, above;
    if (p->has_rows) {
      int at = light->cell - j * (int)p->points_per_bin;
      if (at < 0) at += p->points;
      below = chi + at;
      above = below + 1;
    } else {
      below = chi + (size_t)light->cell * (size_t)p->taps + (size_t)j;
      above = below + p->taps;
    }
    returned = light->signal_e_per_s * (*below + light->share * (*above - *below));
  }
  return exposure_s[j] * (returned + light->ambient_e_per_s * ambient_gain[j] + p->dark_e_per_s);
}

/// A number with noise of that deviation, which is rounded where there is any.
struct Drawn with_noise(struct Stream* s, double number, double deviation) {
  const struct Drawn normal = next_normal(s);
  const double noise = deviation * normal.value;
  struct Drawn drawn;
  drawn.value = number + noise;
  drawn.error = noise == 0.0 ? 0.0
                             : fabs(deviation) * normal.error +
                                   1e-15 * s->doubt.margin * (fabs(number) + fabs(noise));
  return drawn;
}

/// As PixelNoise::draw_electrons().
struct Drawn draw_electrons(const struct CaptureParameters* p, struct Stream* s,
                            double expected_e) {
  const double mean = expected_e < 0.0 ? 0.0 : expected_e;
  if (p->is_gaussian)
    return with_noise(s, mean, sqrt(mean + p->read_noise_e * p->read_noise_e));
  const double count = next_poisson(s, mean);
  return with_noise(s, count, p->read_noise_e);
}

/// As PixelNoise::draw_count().
struct Drawn draw_count(const struct CaptureParameters* p, struct Stream* s, double expected_e) {
  const double mean = expected_e < 0.0 ? 0.0 : expected_e;
  if (p->is_gaussian) return with_noise(s, mean, sqrt(mean));
  struct Drawn count;
  count.value = next_poisson(s, mean);
  count.error = 0.0;
  return count;
}

/// As PixelNoise::draw_difference().
struct Drawn draw_difference(const struct CaptureParameters* p, struct Stream* s, double a,
                             double b) {
  const double mean = a - b, variance = a + b < 0.0 ? 0.0 : a + b;
  if (p->is_gaussian)
    return with_noise(s, mean, sqrt(variance + p->read_noise_e * p->read_noise_e));
  const struct SignedElectrons e = signed_electrons(mean, variance);
  const double plus = next_poisson(s, e.plus), minus = next_poisson(s, e.minus);
  return with_noise(s, e.size * (plus - minus), p->read_noise_e);
}

/// As PixelNoise::convert(), which does not fall.
double convert(const struct CaptureParameters* p, double electrons) {
  double kept = p->full_well_e < electrons ? p->full_well_e : electrons;
  if (p->is_signed && kept < -p->full_well_e) kept = -p->full_well_e;
  if (!p->has_adc) return kept;
  const double number = round(kept / p->gain_e_per_dn + p->black_level_dn);
  return number < p->min_dn ? p->min_dn : p->max_dn < number ? p->max_dn : number;
}

/// A raw number with those that it lies between.
struct Number {
  double value, least, most;
};

struct Number converted(const struct CaptureParameters* p, struct Drawn e) {
  struct Number number;
  number.value = convert(p, e.value);
  number.least = convert(p, e.value - e.error);
  number.most = convert(p, e.value + e.error);
  return number;
}

/// The float that it is; open where it may be another.
float rounded(struct Stream* s, struct Number number) {
  if (!((float)number.least == (float)number.most)) s->doubt.is_open = 1;
  return (float)number.value;
}

/// Rows of an exposure: sums over all time bins, in another order than there.
void expose_rows(const struct CaptureParameters* p, const struct PixelLight* light,
                 struct Stream* s, Doubles chi, Doubles exposure_s, Doubles ambient_gain,
                 Doubles rows, global double* sums, global float* raw) {
  double error = 0.0;  // of the sums, for weights of 1
  for (int k = 0; k < p->measurements; ++k) sums[k] = 0.0;
  for (int n = 0; n < p->taps; ++n) {
    const struct Drawn count =
        draw_count(p, s, expected(p, light, chi, exposure_s, ambient_gain, n));
    for (int k = 0; k < p->measurements; ++k)
      sums[k] += rows[(size_t)n * (size_t)p->measurements + (size_t)k] * count.value;
    error += count.error + 2.3e-16 * s->doubt.margin * (double)p->taps * fabs(count.value);
  }
  for (int k = 0; k < p->measurements; ++k) {
    struct Drawn read = with_noise(s, sums[k], p->read_noise_e);
    double weight = 0.0;  // the largest
    for (int n = 0; n < p->taps; ++n)
      weight = fmax(weight, fabs(rows[(size_t)n * (size_t)p->measurements + (size_t)k]));
    read.error += weight * error;
    struct Number number;
    number.value = read.value;
    number.least = read.value - read.error;
    number.most = read.value + read.error;
    raw[k] = rounded(s, number);
  }
}

/// Raw measurements of the pixels of a part of a frame, K each, and those that the processor is to
/// make.
kernel void capture(const struct CaptureParameters parameters, const struct CaptureStream streams,
                    Doubles chi, Doubles exposure_s, Doubles ambient_gain, Doubles rows,
                    Floats depth, Floats albedo, Floats cosine, Floats ambient_scale,
                    Doubles collected, Doubles ambient, global double* sums, global float* raw,
                    global int* opened, global int* open) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= parameters.pixels) return;
  const struct CaptureParameters* p = &parameters;
  const struct PixelLight light =
      light_of(p, pixel, depth, albedo, cosine, ambient_scale, collected, ambient);
  struct Stream s = stream_of(&streams, pixel, p->margin);
  const size_t first = (size_t)pixel * (size_t)p->measurements;
  if (p->has_rows) {
    expose_rows(p, &light, &s, chi, exposure_s, ambient_gain, rows, sums + first, raw + first);
  } else {
    for (int k = 0; k < p->measurements; ++k) {
      const int j = p->subtracts ? 2 * k : k;
      const double e = expected(p, &light, chi, exposure_s, ambient_gain, j);
      struct Number number;
      if (p->is_signed) {
        const double other = expected(p, &light, chi, exposure_s, ambient_gain, j + 1);
        number = converted(p, draw_difference(p, &s, e, other));
      } else {
        number = converted(p, draw_electrons(p, &s, e));
        if (p->subtracts) {
          const double next = expected(p, &light, chi, exposure_s, ambient_gain, j + 1);
          const struct Number other = converted(p, draw_electrons(p, &s, next));
          number.value -= other.value;
          number.least -= other.most;
          number.most -= other.least;
        }
      }
      raw[first + (size_t)k] = rounded(&s, number);
    }
  }
  if (s.doubt.is_open) open[atomic_inc(opened)] = pixel;
}
