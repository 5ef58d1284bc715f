// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "design_setup.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"

namespace tofsmith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

auto breaks(const char* key, const char* reason) {
  return ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(key), HasSubstr(reason)));
}

TEST(ExposureShares, SplitTheTimeOfTheCamera) {
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet even = build_family("square-k4", camera);
  const CodeSet code = even.with_exposure_shares({0.4, 0.3, 0.2, 0.1});
  const ForwardModel model(code, camera);
  EXPECT_NEAR(model.exposure_s()[0], 0.4 * 0.3, 1e-15);
  EXPECT_NEAR(model.exposure_s()[3], 0.1 * 0.3, 1e-15);
  camera.playback = Playback{.order = {3, 2, 1, 0}};
  EXPECT_NEAR(ForwardModel(code, camera).exposure_s()[0], 0.1 * 0.3, 1e-15);
  camera.playback.reset();
  camera.exposure_s.each_s = {1.0, 1.0, 1.0, 2.0};
  EXPECT_EQ(ForwardModel(code, camera).exposure_s()[3], 2.0);
}

TEST(ExposureShares, StayWithTheCode) {
  const CodeSet code = make_family("square-k4", {}).with_exposure_shares({0.4, 0.3, 0.2, 0.1});
  for (const CodeSet& other : {code.renamed("b"), code.resampled(120), code.rotated(3),
                               code.with_two_buckets(), code.with_signed_weights()})
    EXPECT_EQ(other.exposure_shares(), code.exposure_shares()) << other.name();
  EXPECT_TRUE(code.with_exposure_shares({}).exposure_shares().empty());
  EXPECT_TRUE(code.with_exposure_shares({0.25, 0.25, 0.25, 0.25}).exposure_shares().empty());
}

TEST(ExposureOrder, MovesAllThatBelongsToAnExposure) {
  CodeSet code =
      make_family("square-k4", {}).with_two_buckets().with_exposure_shares({0.4, 0.3, 0.2, 0.1});
  code.provenance.residuals = {0, 1, 2, 3, 4, 5, 6, 7};
  const CodeSet moved = code.with_exposure_order({2, 0, 3, 1});
  EXPECT_EQ(moved.modulation(0), code.modulation(2));
  EXPECT_EQ(moved.demodulation(0), code.demodulation(4));
  EXPECT_EQ(moved.demodulation(1), code.demodulation(5));
  EXPECT_EQ(moved.exposure_shares(), (std::vector{0.2, 0.4, 0.1, 0.3}));
  EXPECT_EQ(moved.provenance.residuals, (std::vector<double>{4, 5, 0, 1, 6, 7, 2, 3}));
  expect_same_code(moved.with_exposure_order({1, 3, 0, 2}), code);
  for (const std::vector<int>& wrong :
       {std::vector{0, 1, 2}, std::vector{0, 1, 2, 2}, std::vector{1, 2, 3, 4}})
    EXPECT_THAT([&] { code.with_exposure_order(wrong); },
                breaks("exposure order", "each of the 4 exposures once"));
}

TEST(ExposureShares, MustAddUpToOne) {
  const CodeSet code = make_family("square-k4", {});
  EXPECT_THAT(
      [&] {
        code.with_exposure_shares({0.5, 0.5});
      },
      breaks("number of exposure_shares = 2", "4 exposures"));
  EXPECT_THAT(
      [&] {
        code.with_exposure_shares({0.4, 0.3, 0.2, 0.2});
      },
      breaks("sum of exposure_shares", "must be 1"));
  EXPECT_THAT(
      [&] {
        code.with_exposure_shares({1.2, 0.3, -0.6, 0.1});
      },
      breaks("exposure_shares = -0.6", "must be > 0"));
}

}  // namespace
}  // namespace tofsmith
