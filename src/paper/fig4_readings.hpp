// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "paper/context.hpp"
#include "paper/error_surface_figures.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// Limits of a camera. The paper draws the first three; its supplement has the others.
struct Limits {
  const char* id;
  const char* title;
  double peak_factor;
  double f_max_in_f0;  ///< 0: none
};
inline constexpr std::array<Limits, 6> all_limits = {{{"a", "p = 30", 30, 0},
                                                      {"b", "p = 15, 10 f0", 15, 10},
                                                      {"c", "p = 15, 5 f0", 15, 5},
                                                      {"p15", "p = 15", 15, 0},
                                                      {"p5", "p = 5", 5, 0},
                                                      {"p2", "p = 2", 2, 0}}};
inline constexpr std::size_t drawn_limits = 3;

/// What light and noise are taken to be: the paper can be read in several ways.
struct Reading {
  const char* id;
  const char* title;
  double read_noise_variance_e2;
  bool uniform_albedo;
};
inline constexpr std::array<Reading, 4> all_readings = {
    {{"sd20", "read noise of standard deviation 20 e", 400, false},
     {"var20", "read noise of variance 20 e²", 20, false},
     {"sd20-albedo", "read noise of standard deviation 20 e, albedo 0 to 1", 400, true},
     {"var20-albedo", "read noise of variance 20 e², albedo 0 to 1", 20, true}}};

/// All codes on all cameras under one reading.
struct ReadingResult {
  const Reading* reading;
  std::vector<ErrorSurfaceGroup> of_limits;  ///< as all_limits
};

/// Measures every code and the ideal codes as reference; exactly everywhere for the first reading
/// and the limits the paper draws, else in the geometric means and at the named light levels.
ReadingResult measure_reading(const Reading& reading, const ReproduceContext& context,
                              const Progress& progress);

/// Geometric means for all limits and readings.
Section readings_section(const std::vector<ReadingResult>& results);

/// How the redesigned codes fare against baselines that the paper does not have.
Section stronger_baselines_section(const ReadingResult& result);

/// Geometric means and named levels of every code.
std::string readings_csv(const std::vector<ReadingResult>& results);

}  // namespace tofsmith
