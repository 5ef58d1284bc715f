// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>

#include "figure_checks.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

using namespace test;

const Reproduction& fig9() {
  static const Reproduction reproduction = coarsely("fig9");
  return reproduction;
}

TEST(Fig9, TheRedesignedCodeBeatsTheSinusoidBehindEveryFilter) {
  EXPECT_EQ(verdict_on(fig9(), "sinusoid-k4"), Verdict::holds);
  EXPECT_NE(verdict_on(fig9(), "multifrequency-k5"), Verdict::fails);
}

TEST(Fig9, ErrorsGrowWithEveryFilter) {
  double before = 0.0;
  for (const char* name : {"circular_mde_m_od1", "circular_mde_m_od2", "circular_mde_m_od3"}) {
    const std::vector<double> errors = values_of(fig9(), name, {4, 5});
    const double worst = std::ranges::max(errors);
    EXPECT_GT(worst, before) << name;
    before = worst;
  }
}

TEST(Fig9, PageHoldsTogether) { EXPECT_THAT(rendered("fig9", fig9()), testing::HasSubstr("O.D.")); }

TEST(Table1, GivesCamerasThatReadBackAndSaysWhatGeneratorsCost) {
  const Reproduction table = coarsely("table1");
  EXPECT_EQ(verdict_on(table, "existing hardware"), Verdict::in_part);
  for (const char* name : {"prototype.toml", "prototype-p5.toml", "prototype-p30.toml"}) {
    const Camera camera = parse_camera_toml(table.files.at(name), name);
    EXPECT_EQ(camera.light.generator->points_per_period(camera.fundamental_frequency_hz), 100);
    EXPECT_NEAR(camera.operating.signal_e_per_s.back(), 1e6, 1e-3);
  }
  EXPECT_THAT(rendered("table1", table), testing::HasSubstr("prototype-p30"));
}

}  // namespace
}  // namespace tofsmith
