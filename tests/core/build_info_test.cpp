// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/build_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tofsmith/version.hpp"

namespace tofsmith {
namespace {

static_assert(TOFSMITH_VERSION_NUMBER == TOFSMITH_MAKE_VERSION(TOFSMITH_VERSION_MAJOR,
                                                               TOFSMITH_VERSION_MINOR,
                                                               TOFSMITH_VERSION_PATCH));
static_assert(TOFSMITH_MAKE_VERSION(0, 2, 0) > TOFSMITH_MAKE_VERSION(0, 1, 99));
static_assert(TOFSMITH_MAKE_VERSION(1, 0, 0) > TOFSMITH_MAKE_VERSION(0, 99, 99));

TEST(BuildInfo, HasTheVersionOfTheHeader) {
  EXPECT_EQ(build_info().version, TOFSMITH_VERSION);
  EXPECT_EQ(std::to_string(TOFSMITH_VERSION_MAJOR) + "." + std::to_string(TOFSMITH_VERSION_MINOR) +
                "." + std::to_string(TOFSMITH_VERSION_PATCH),
            TOFSMITH_VERSION);
}

TEST(BuildInfo, ListsEveryTargetThatRunsHere) {
  EXPECT_THAT(build_info().targets, testing::IsSupersetOf(dispatch_targets()));
}

TEST(BuildInfo, TheFirstLineHasVersionAndCommit) {
  const BuildInfo info = build_info();
  EXPECT_THAT(info.commit, testing::AnyOf("unknown", testing::SizeIs(testing::Ge(7u))));
  EXPECT_THAT(to_text(info),
              testing::StartsWith("tofsmith " + info.version + " (commit " + info.commit + ")\n"));
}

TEST(BuildInfo, TextReportsThatNoOptionalComponentIsIncluded) {
  BuildInfo info = build_info();
  info.features = {};
  EXPECT_THAT(to_text(info), testing::EndsWith("with no optional features"));
  info.features = {"TBB", "FFTW"};
  EXPECT_THAT(to_text(info), testing::EndsWith("with TBB, FFTW"));
}

}  // namespace
}  // namespace tofsmith
