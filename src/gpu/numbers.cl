// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Compiled after kernel_parameters.h, with MEASUREMENTS (K) and RANK defined. Products and sums are
// rounded separately, as on the CPU. With FUSES_PRODUCTS, if the CPU has FMA, product_plus() rounds
// once.
#pragma OPENCL FP_CONTRACT OFF
#ifdef HAS_DOUBLES
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

typedef global const float* Floats;
typedef global const int* Ints;
typedef global float* Plane;

Ints ints_at(Floats tables, int at) { return (Ints)(tables + at); }

/// a b + c, rounded as by the CPU's vector code.
float product_plus(float a, float b, float c) {
#ifdef FUSES_PRODUCTS
  return fma(a, b, c);
#else
  return a * b + c;
#endif
}

float raw_number(const struct TileParameters* tile, global const uchar* raw, int pixel, int k) {
  const size_t at =
      (size_t)pixel * (size_t)tile->pixel_stride + (size_t)k * (size_t)tile->measurement_stride;
  if (tile->number == raw_uint16) return (float)((global const ushort*)raw)[at];
  if (tile->number == raw_uint8) return (float)raw[at];
  return ((Floats)raw)[at];
}
