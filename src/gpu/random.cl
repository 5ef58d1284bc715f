// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Random numbers of the processor's words, in doubles. Compiled behind numbers.cl.
//
// Words are the same, and so is the arithmetic, each step of which is rounded correctly here and
// there; vectors there may take two steps in one. Beside that only logarithms, exponentials, sines
// and cosines may differ in their last bits: by 3 or 4 units here (OpenCL 1.2, 7.4) and by 1 there,
// of vectors by 4. What hangs on those bits is marked as open.

/// What numbers hang on that are compared or counted.
struct Doubt {
  double margin;  ///< times all bounds
  double step;    ///< what a step of arithmetic may differ by there, of itself
  int is_open;    ///< what was drawn may be another number than the processor draws
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

double uniform_of(uint2 words) {
  return (double)((((ulong)words.x << 32) | words.y) >> 11) * 0x1p-53;
}

double open_uniform(uint word) { return ((double)word + 0.5) * 0x1p-32; }

/// Whether a < b; where they are as close as bounds, it is open.
int is_less(struct Doubt* doubt, double a, double b, double bound) {
  if (fabs(a - b) <= bound * doubt->margin) doubt->is_open = 1;
  return a < b;
}

/// The whole number at or below; where the next one is as close as the bound, it is open.
double whole_below(struct Doubt* doubt, double value, double bound) {
  if (floor(value - bound) != floor(value + bound)) doubt->is_open = 1;
  return floor(value);
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

/// As attempted_poisson() there, and in vectors in poisson_tile.cpp. @return negative: not accepted
double attempted_poisson(struct Doubt* doubt, double mean, uint2 words) {
  const double u = open_uniform(words.x) - 0.5, v = open_uniform(words.y);
  const double us = 0.5 - fabs(u);
  const double b = 0.931 + 2.53 * sqrt(mean), a = -0.059 + 0.02483 * b;
  const double from_mean = (2.0 * a / us + b) * u;
  const double step = doubt->step * doubt->margin;
  const double k =
      whole_below(doubt, from_mean + mean + 0.43, step * (fabs(from_mean) + mean + 1.0));
  if (us >= 0.07 && !is_less(doubt, 0.9277 - 3.6224 / (b - 2.0), v, doubt->step)) return k;
  if (k < 0.0 || (us < 0.013 && v > us)) return -1.0;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double bound = 4e-15 * (mean + k) + 1e-12;  // terms of that size cancel
  const double log_height = log(v * inverse_alpha / (a / (us * us) + b));
  return is_less(doubt, log_probability(k, mean), log_height, bound) ? -1.0 : k;
}

/// As inverted_poisson() there.
double inverted_poisson(struct Doubt* doubt, double mean, uint2 words) {
  double probability = exp(-mean), rest = uniform_of(words) - probability, k = 0.0;
  while (!is_less(doubt, rest, 0.0, 1e-13) && k < 200.0) {
    k += 1.0;
    probability *= mean / k;
    rest -= probability;
  }
  return k;
}

/// As SignedElectrons.
struct SignedElectrons {
  double plus, minus, size;
};

struct SignedElectrons signed_electrons(double mean, double variance) {
  struct SignedElectrons e;
  e.plus = 0.5 * (variance + mean);
  e.minus = 0.5 * (variance - mean);
  e.size = 1.0;
  if (fabs(mean) <= variance) return e;
  e.size = (variance < 0.0 ? 0.0 : variance) / fabs(mean);
  e.plus = e.size < 1e-12 ? 0.0 : (mean < 0.0 ? 0.0 : mean) / e.size;
  e.minus = e.size < 1e-12 ? 0.0 : (-mean < 0.0 ? 0.0 : -mean) / e.size;
  if (e.size < 1e-12) e.size = 0.0;
  return e;
}
