// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Elementary functions in single precision, as core/shared/vector_math-inl.hpp, step by step: the
// same bits. Compiled behind numbers.cl.

float reciprocal_sqrt(float x) {
  float y = as_float(0x5f375a86 - (as_int(x) >> 1));
  const float half_x = x * 0.5f;
  for (int step = 0; step < 3; ++step) y = y * product_plus(-(half_x * y), y, 1.5f);
  return y;
}

float natural_log(float x) {
  const int bits = as_int(x) + (0x3f800000 - 0x3f3504f3);
  const float e = (float)((bits >> 23) - 127);
  const float m = as_float((bits & 0x007fffff) + 0x3f3504f3) - 1.0f;
  float p = 7.0376836292e-2f;
  p = product_plus(p, m, -1.1514610310e-1f);
  p = product_plus(p, m, 1.1676998740e-1f);
  p = product_plus(p, m, -1.2420140846e-1f);
  p = product_plus(p, m, 1.4249322787e-1f);
  p = product_plus(p, m, -1.6668057665e-1f);
  p = product_plus(p, m, 2.0000714765e-1f);
  p = product_plus(p, m, -2.4999993993e-1f);
  p = product_plus(p, m, 3.3333331174e-1f);
  const float m2 = m * m;
  p = p * m * m2;
  p = product_plus(e, -2.12194440e-4f, p);
  p = product_plus(-m2, 0.5f, p);
  return product_plus(e, 0.693359375f, m + p);
}

/// Two normals, as normals_of() in core/random_tile.cpp.
float2 normals_of(uint radius, uint angle) {
  const float u = ((float)(int)(radius >> 1) + 0.5f) * 0x1p-31f;
  const float square = fmax(natural_log(u) * -2.0f, 0.0f);
  const float length = square * reciprocal_sqrt(square);

  const float turn = ((float)(int)(angle >> 8 & 0x3fffffu) + 0.5f) * 0x1p-22f;
  const float x = (turn - 0.5f) * 1.57079632679f;
  const float x2 = x * x;
  float s = product_plus(x2, -1.9515295891e-4f, 8.3321608736e-3f);
  s = product_plus(product_plus(s, x2, -1.6666654611e-1f), x2 * x, x);
  float c = product_plus(x2, 2.443315711809948e-5f, -1.388731625493765e-3f);
  c = product_plus(c, x2, 4.166664568298827e-2f);
  c = product_plus(c * x2, x2, product_plus(-x2, 0.5f, 1.0f));
  const bool is_odd = (angle >> 30 & 1u) != 0;
  const float2 point = is_odd ? (float2)(-s, c) : (float2)(c, s);
  return length * ((angle >> 31) != 0 ? -point : point);
}
