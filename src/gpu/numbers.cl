// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What all kernels begin with. Compiled behind decode_parameters.h, with MEASUREMENTS (K) and RANK.
// Products and sums are rounded one by one, as on the processor, so that numbers are the same.
#pragma OPENCL FP_CONTRACT OFF
#ifdef HAS_DOUBLES
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

typedef global const float* Floats;
typedef global const int* Ints;

Ints ints_at(Floats tables, int at) { return (Ints)(tables + at); }

float raw_number(const struct TileParameters* tile, global const uchar* raw, int pixel, int k) {
  const size_t at =
      (size_t)pixel * (size_t)tile->pixel_stride + (size_t)k * (size_t)tile->measurement_stride;
  if (tile->number == raw_uint16) return (float)((global const ushort*)raw)[at];
  if (tile->number == raw_uint8) return (float)raw[at];
  return ((Floats)raw)[at];
}
