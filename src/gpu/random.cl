// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The random numbers of RandomStream, in doubles. Compiled behind numbers.cl.
//
// Words are the same, and so is all arithmetic, each step of which is rounded correctly here and
// there. Only logarithms, exponentials, sines and cosines may differ in their last bits: by 3 or 4
// units here (OpenCL 1.2, 7.4) and by 1 there. What hangs on those bits is marked as open.

/// A number and what it may differ by from that of the processor.
struct Drawn {
  double value, error;
};

struct Stream {
  uint4 counter;  ///< block, frame, pixel
  uint2 key;
  uint2 kept_words;
  double kept_normal, kept_error;
  int has_words, has_normal;
  int is_open;    ///< what was drawn may be another number than the processor draws
  double margin;  ///< times all bounds
};

/// Philox4x32-10 (Salmon et al., SC 2011).
uint4 philox(uint4 x, uint2 key) {
  for (int round = 0; round < 10; ++round) {
    const uint high_0 = mul_hi(0xD2511F53u, x.x), low_0 = 0xD2511F53u * x.x;
    const uint high_2 = mul_hi(0xCD9E8D57u, x.z), low_2 = 0xCD9E8D57u * x.z;
    x = (uint4)(high_2 ^ x.y ^ key.x, low_2, high_0 ^ x.w ^ key.y, low_0);
    key += (uint2)(0x9E3779B9u, 0xBB67AE85u);
  }
  return x;
}

struct Stream stream_of(const struct CaptureStream* of, int pixel, double margin) {
  const ulong number = (((ulong)of->first_high << 32) | of->first_low) + (ulong)pixel;
  struct Stream s;
  s.counter = (uint4)(0u, of->frame, (uint)number, (uint)(number >> 32));
  s.key = (uint2)(of->seed_low, of->seed_high);
  s.kept_words = (uint2)(0u, 0u);
  s.kept_normal = s.kept_error = 0.0;
  s.has_words = s.has_normal = s.is_open = 0;
  s.margin = margin;
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

double uniform_of(uint2 words) {
  return (double)((((ulong)words.x << 32) | words.y) >> 11) * 0x1p-53;
}

double open_uniform(uint word) { return ((double)word + 0.5) * 0x1p-32; }

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
  s->kept_error = 4e-15 * s->margin * fabs(s->kept_normal);
  s->has_normal = 1;
  normal.value = radius * cos(angle);
  normal.error = 4e-15 * s->margin * fabs(normal.value);
  return normal;
}

/// Whether a < b; where they are as close as bounds, it is open.
int is_less(struct Stream* s, double a, double b, double bound) {
  if (fabs(a - b) <= bound * s->margin) s->is_open = 1;
  return a < b;
}

constant double log_factorials[16] = {0.0,
                                      0.0,
                                      0.69314718055994531,
                                      1.7917594692280550,
                                      3.1780538303479458,
                                      4.7874917427820458,
                                      6.5792512120101012,
                                      8.5251613610654147,
                                      10.604602902745251,
                                      12.801827480081469,
                                      15.104412573075516,
                                      17.502307845873887,
                                      19.987214495661885,
                                      22.552163853123425,
                                      25.191221182738680,
                                      27.899271383840890};

/// As log_probability() of core/poisson_attempt.cpp.
double log_probability(double k, double mean) {
  if (k < 16.0) return k * log(mean) - mean - log_factorials[(int)k];
  const double r = 1.0 / k, r2 = r * r;
  const double series =
      r * (1.0 / 12 - r2 * (1.0 / 360 - r2 * (1.0 / 1260 - r2 / 1680)));
  return k * log(mean * r) - mean + k - 0.5 * log(k) - 0.91893853320467274178 - series;
}

/// As attempted_poisson() there. @return negative: not accepted
double attempted_poisson(struct Stream* s, double mean, uint2 words) {
  const double u = open_uniform(words.x) - 0.5, v = open_uniform(words.y);
  const double us = 0.5 - fabs(u);
  const double b = 0.931 + 2.53 * sqrt(mean), a = -0.059 + 0.02483 * b;
  const double k = floor((2.0 * a / us + b) * u + mean + 0.43);
  if (us >= 0.07 && v <= 0.9277 - 3.6224 / (b - 2.0)) return k;
  if (k < 0.0 || (us < 0.013 && v > us)) return -1.0;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double bound = 4e-15 * (mean + k) + 1e-12;  // terms of that size cancel
  return is_less(s, log_probability(k, mean), log(v * inverse_alpha / (a / (us * us) + b)), bound)
             ? -1.0
             : k;
}

/// As inverted_poisson() there.
double inverted_poisson(struct Stream* s, double mean, uint2 words) {
  double probability = exp(-mean), rest = uniform_of(words) - probability, k = 0.0;
  while (!is_less(s, rest, 0.0, 1e-13) && k < 200.0) {
    k += 1.0;
    probability *= mean / k;
    rest -= probability;
  }
  return k;
}

/// The number that lies nearest, if all within the bound have the same.
double whole(struct Stream* s, double value, double bound) {
  if (round(value - bound) != round(value + bound)) s->is_open = 1;
  return round(value);
}

double next_poisson(struct Stream* s, double mean) {
  if (!(mean > 0.0)) return 0.0;
  if (mean > 1e9) {
    const struct Drawn normal = next_normal(s);
    const double root = sqrt(mean);
    return whole(s, mean + root * normal.value, root * normal.error + 1e-15 * s->margin * mean);
  }
  for (;;) {
    const uint2 words = next_words(s);
    if (mean < 10.0) return inverted_poisson(s, mean, words);
    const double k = attempted_poisson(s, mean, words);
    if (k >= 0.0 || s->is_open) return k;
  }
}
