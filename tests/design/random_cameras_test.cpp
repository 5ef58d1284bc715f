// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Design for any camera returns a code or a message with the limiting setting.
//
//   TOFSMITH_ALL_RANDOM_CAMERAS=1 test_design --gtest_filter='RandomCameras.*'
//
// tests 1000 cameras without search, some of them against all standard codes, and 50 with the
// default effort. Otherwise a fixed subset is tested with little effort.
#include "random_cameras.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "sanitizers.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {
namespace {

constexpr std::uint64_t seed = 1;

bool all_are_tried() { return std::getenv("TOFSMITH_ALL_RANDOM_CAMERAS") != nullptr; }

/// Returns whether a setting can by itself make depth measurement impossible.
bool names_a_physical_reason(const std::string& field) {
  for (const char* known : {"light.peak_factor", "number of exposure_s", "number of playback.order",
                            "sensor.taps", "codes that measure depth"})
    if (field == known) return true;
  return false;
}

void expect_a_code_or_a_reason(std::uint64_t index, double effort) {
  const Camera camera = random_camera(seed, index);
  SCOPED_TRACE(camera.name);
  ASSERT_NO_THROW(camera.validate());
  DesignOptions options = with_effort({}, effort);
  options.trials = 1000;
  // Searching all standard codes for contenders takes seconds.
  if (index % 16 != 0 || !all_are_tried())
    options.baselines = {"sinusoid-k3", "square-k4", "hamiltonian-k4"};
  try {
    const DesignResult result = design(camera, options);
    EXPECT_EQ(why_not_playable(result.winner().code, camera), std::nullopt);
    for (const Candidate& c : result.candidates)
      EXPECT_TRUE(std::isfinite(c.error.circular.geometric_mean_m.value)) << c.code.name();
  } catch (const InvalidArgument& refusal) {
    EXPECT_TRUE(names_a_physical_reason(refusal.field())) << refusal.what();
    EXPECT_LT(std::string(refusal.what()).size(), 700u) << refusal.what();
  }
}

TEST(RandomCameras, GiveACodeOrAReasonWithoutEffort) {
  const std::uint64_t cameras = all_are_tried() ? 1000 : repetitions(25u);
  const std::uint64_t step = all_are_tried() ? 1 : 40;
  for (std::uint64_t i = 0; i < cameras; ++i) expect_a_code_or_a_reason(step * i, 0.0);
}

TEST(RandomCameras, GiveACodeOrAReasonForEveryMethod) {
  const std::uint64_t cameras = all_are_tried() ? 50 : repetitions(2u);
  const std::uint64_t first = 1000, step = all_are_tried() ? 1 : 12;
  const double effort = all_are_tried() ? 1.0 : 0.01;
  for (std::uint64_t i = 0; i < cameras; ++i) expect_a_code_or_a_reason(first + step * i, effort);
}

}  // namespace
}  // namespace tofsmith
