// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/explanation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "small_design.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string limit_of(double bound_over_error) {
  const Camera camera = small_camera("paper-10f0");
  DesignResult result = judge(
      camera, {{.code = build_family("sinusoid-k4", camera), .method = "family"}}, small_options());
  for (PointDepthError& p : result.candidates[0].error.points)
    p.cramer_rao_mae_m = bound_over_error * p.circular_mde_m.value;
  return explain(camera, result)[2];
}

TEST(Explanation, NeverReportsAnErrorBelowItsBoundAsARatio) {
  EXPECT_THAT(limit_of(0.8), HasSubstr("1.25 times the Cramer-Rao bound of the code"));
  EXPECT_THAT(limit_of(100), HasSubstr("correlation functions are nearly flat at some depth"));
  EXPECT_THAT(limit_of(100), Not(HasSubstr("times the Cramer-Rao bound of the code")));
}

}  // namespace
}  // namespace tofsmith
