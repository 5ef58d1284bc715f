// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the kernel of captures is told, in C++ and in OpenCL C alike: doubles first, then an even
// number of ints, so that both lay it out alike.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// As RowCapture and what it stands on.
struct CaptureParameters {
  // Light of the scene's direct returns.
  double signal_e_per_s, ambient_e_per_s, reference_distance_m;
  double range_m, bin_m, dark_e_per_s;
  double points_per_bin;
  // Noise and read-out.
  double read_noise_e, full_well_e;
  double gain_e_per_dn, black_level_dn, min_dn, max_dn;
  double margin;  ///< times the bounds on what functions may differ by

  int points;  ///< of the table of chi
  int taps, measurements;
  int is_collected;  ///< light comes as S chi of every tap value, not as a scene
  int has_ambient;   ///< of every pixel
  int has_falloff;
  int is_gaussian, subtracts, is_signed, has_adc, has_rows;
  int pixels;  ///< of this part of the frame
};

/// The streams of its pixels.
struct CaptureStream {
  unsigned int seed_low, seed_high;
  unsigned int first_low, first_high;  ///< number of the part's first pixel
  unsigned int frame;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
