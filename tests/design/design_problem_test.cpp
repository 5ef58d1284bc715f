// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/design_problem.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

TEST(DesignProblem, CellsAreAtLeastAsLongAsTheShortestPulse) {
  Camera camera = built_in_camera("paper-30x");
  const auto space_for = [&](double periods, double peak_factor) {
    camera.sensor.shortest_pulse_s = periods / camera.fundamental_frequency_hz;
    camera.light.peak_factor = peak_factor;
    return waveform_space(camera, 4, 120);
  };
  for (const double periods : {1.0 / 4.0, 1.0 / 7.3, 1.0 / 33.0, 1.0 / 133.0, 1.0 / 500.0})
    for (const double peak_factor : {1.5, 7.0, 15.0, 30.0}) {
      const WaveformSpace space = space_for(periods, peak_factor);
      EXPECT_GE(1.0 / space.cells, periods * (1 - 1e-9));
      EXPECT_LE(space.cells, 120);
      EXPECT_GE(space.samples(), 96);
    }
  EXPECT_EQ(space_for(1.0 / 133.3, 15.0).cells, 120);
  EXPECT_EQ(space_for(1.0 / 33.0, 15.0).repeat, 4);  // 30 cells: a pulse fills two
  EXPECT_EQ(why_not_optimizable(camera, 4), std::nullopt);
  camera.sensor.shortest_pulse_s = 0.3 / camera.fundamental_frequency_hz;
  EXPECT_NE(why_not_optimizable(camera, 4), std::nullopt);
}

TEST(DesignProblem, UsesThePointsOfTheRangeOrLevelsWithinIt) {
  Camera camera = built_in_camera("paper-10f0");
  EXPECT_EQ(training_points(camera), camera.operating.points());
  camera.operating.signal_e_per_s.clear();
  camera.operating.ambient_e_per_s = {0.0};
  for (int i = 0; i < 9; ++i) {
    camera.operating.signal_e_per_s.push_back(1e3 * (i + 1));
    camera.operating.ambient_e_per_s.push_back(1e3 * (i + 1));
  }
  const std::vector<OperatingPoint> fewer = training_points(camera);
  EXPECT_EQ(fewer.size(), 36u);
  for (const OperatingPoint& point : fewer) {
    EXPECT_GE(point.signal_e_per_s, 1e3);
    EXPECT_LE(point.signal_e_per_s, 9e3);
    EXPECT_GE(point.ambient_e_per_s, 0.0);
    EXPECT_LE(point.ambient_e_per_s, 9e3);
  }
}

TEST(DesignProblem, RejectsVariantsWithOtherTaps) {
  std::vector<Camera> variants(2, built_in_camera("paper-10f0"));
  variants[1].sensor.taps = 2;
  EXPECT_THROW(make_design_problem(variants, 4, 120), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
