// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "figure_checks.hpp"
#include "paper/error_surface.hpp"
#include "paper/fig4_findings.hpp"
#include "paper/figures.hpp"
#include "paper/paper.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

using test::verdict_on;

/// Each figure is made once, coarsely.
const Reproduction& fig4() {
  static const Reproduction result = test::coarsely("fig4");
  return result;
}
const Reproduction& fig8() {
  static const Reproduction result = test::coarsely("fig8");
  return result;
}

/// Geometric mean over the light levels of code `c` of an array (codes, ambient, signal).
double mean_of(const Reproduction& reproduction, const std::string& array, std::size_t c) {
  const NpyArray& values = reproduction.arrays.at(array);
  const std::size_t levels = values.shape()[1] * values.shape()[2];
  const std::vector<double> all = values.to_doubles();
  return std::exp(std::accumulate(all.begin() + c * levels, all.begin() + (c + 1) * levels, 0.0,
                                  [](double sum, double v) { return sum + std::log(v); }) /
                  static_cast<double>(levels));
}

Comparison compared(double ours, double theirs, double standard_error) {
  ErrorSurface a, b;
  a.linear_m = Eigen::MatrixXd::Constant(2, 2, ours);
  b.linear_m = Eigen::MatrixXd::Constant(2, 2, theirs);
  a.linear_se_m = b.linear_se_m = Eigen::MatrixXd::Constant(2, 2, standard_error);
  return compare(a, b);
}

TEST(Compare, CallsEvenWhatTwoStandardErrorsCannotTellApart) {
  EXPECT_EQ(compared(1.0, 1.2, 0.05).better, 4);
  EXPECT_EQ(compared(1.0, 1.2, 0.1).even, 4);
  EXPECT_EQ(compared(1.2, 1.0, 0.05).worse, 4);
  EXPECT_DOUBLE_EQ(compared(1.0, 1.2, 0.05).mean, 1.2);
  EXPECT_EQ(verdict_of(compared(1.0, 1.2, 0.05)), Verdict::holds);
  EXPECT_EQ(verdict_of(compared(1.0, 1.2, 0.1)), Verdict::fails);
}

TEST(MeasureSurface, MeetsTheStandardErrorThatIsAsked) {
  Camera camera = paper_camera(15, 10);
  camera.operating.signal_e_per_s = {1e4, 1e5};
  camera.operating.ambient_e_per_s = {1e2, 1e4};
  const Contender square{"square-k4", build_family("square-k4", camera)};
  const ErrorSurface surface = measure_surface(square, camera, {.standard_error = 0.03});
  EXPECT_LE(surface.worst_standard_error(), 0.03);
  const Estimate named = surface.linear_at({1e5, 1e4});
  EXPECT_LE(named.standard_error, 0.03 * named.value);
  EXPECT_GT(named.standard_error, 0.003 * named.value) << "far more trials than needed";
  // Less light and more of the ambient kind cannot help.
  EXPECT_LT(surface.linear_m(0, 1), surface.linear_m(0, 0));
  EXPECT_LT(surface.circular_m(0, 1), surface.circular_m(1, 1));
  EXPECT_THROW(surface.linear_at({1, 1}), std::invalid_argument);
  // The same bits again.
  const ErrorSurface again = measure_surface(square, camera, {.standard_error = 0.03});
  EXPECT_EQ(surface.linear_m, again.linear_m);
}

TEST(Fig4, FindsWhatDoesNotDependOnChance) {
  EXPECT_NE(verdict_on(fig4(), "beat both baselines"), Verdict::fails);
  EXPECT_NE(verdict_on(fig4(), "2-5x better than sinusoid"), Verdict::fails);
  EXPECT_EQ(verdict_on(fig4(), "performs well at high"), Verdict::in_part);
  EXPECT_NE(verdict_on(fig4(), "degrades rapidly"), Verdict::fails);
  EXPECT_EQ(verdict_on(fig4(), "equal the ideal codes"), Verdict::holds);
  for (const CheckedStatement& finding : fig4().findings)
    EXPECT_TRUE(finding.verdict == Verdict::holds || !finding.why.empty()) << finding.statement;
}

TEST(Fig4, RedesignedCodesBeatTheSinusoidByFactors) {
  // Codes 0 .. 2 are redesigned, 3 is the sinusoid.
  for (const std::string panel : {"a", "b", "c"})
    for (std::size_t k = 0; k < 3; ++k) {
      const double sinusoid = mean_of(fig4(), panel + "_linear_mde_m", 3);
      EXPECT_LT(1.5 * mean_of(fig4(), panel + "_linear_mde_m", k), sinusoid) << panel << k;
    }
}

TEST(Fig4, HoldsEveryCodeAtEveryLightLevel) {
  for (const std::string panel : {"a", "b", "c"})
    for (const char* kind : {"linear_mde_m", "linear_se_m", "circular_mde_m", "circular_se_m"}) {
      const NpyArray& array = fig4().arrays.at(panel + "_" + kind);
      EXPECT_EQ(array.shape(), (std::vector<std::size_t>{10, 3, 3}));
      for (const double value : array.to_doubles()) EXPECT_GT(value, 0.0);
    }
  const std::string& csv = fig4().files.at("surfaces.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 1 + 3 * 10 * 9);
  EXPECT_EQ(std::ranges::count(fig4().files.at("readings.csv"), '\n'), 1 + 4 * 6 * 10);
}

TEST(Fig8, TwoBucketCodesBeatTheSinusoids) {
  for (const char* words : {"dual-frequency sinusoid", "sinusoid (4 phases"})
    EXPECT_NE(verdict_on(fig8(), words), Verdict::fails) << words;
  EXPECT_EQ(verdict_on(fig8(), "K exposures give 2K values"), Verdict::holds);
  EXPECT_EQ(fig8().arrays.at("10f0_linear_mde_m").shape(), (std::vector<std::size_t>{7, 3, 3}));
}

TEST(Fig8, SecondBucketsHelpMoreThanMoreExposures) {
  // 1: K = 4 with two buckets; 6: with one.
  for (const std::string panel : {"10f0", "5f0"})
    EXPECT_LT(1.2 * mean_of(fig8(), panel + "_circular_mde_m", 1),
              mean_of(fig8(), panel + "_circular_mde_m", 6));
}

TEST(DepthErrorFigures, HavePagesThatRender) {
  for (const auto& [name, reproduction] : {std::pair{"fig4", &fig4()}, {"fig8", &fig8()}}) {
    const std::string page =
        render(reproduction_page(paper_item(name), *reproduction, {.fast = true}));
    EXPECT_THAT(page, HasSubstr("\"type\":\"surface\""));
    EXPECT_THAT(page, HasSubstr("surfaces.csv"));
  }
}

}  // namespace
}  // namespace tofsmith
