// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/families.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "code/shared/family_members.hpp"
#include "code/shared/on_intervals.hpp"
#include "refusal.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

class HamiltonianOrder : public testing::TestWithParam<int> {};

TEST_P(HamiltonianOrder, WalkIsClosedAndStepsAlongEdges) {
  const auto walk = hamiltonian_walk(GetParam());
  for (std::size_t i = 0; i < walk.size(); ++i)
    EXPECT_EQ(std::popcount(walk[i] ^ walk[(i + 1) % walk.size()]), 1) << "step " << i;
}

TEST_P(HamiltonianOrder, WalkVisitsNoVertexTwiceAndHasMaximumLength) {
  const int k = GetParam();
  const auto walk = hamiltonian_walk(k);
  const std::set<std::uint32_t> vertices(walk.begin(), walk.end());
  EXPECT_EQ(vertices.size(), walk.size());
  EXPECT_EQ(static_cast<int>(walk.size()), (1 << k) - (k % 2 == 0 ? 4 : 2));
  EXPECT_FALSE(vertices.contains(0));
  EXPECT_FALSE(vertices.contains((1u << k) - 1));
}

TEST_P(HamiltonianOrder, EveryDutyIsOneHalfAndMeanPowerIsOne) {
  const int length = hamiltonian_length(GetParam());
  const CodeSet code = hamiltonian_code(GetParam(), {.samples = 4 * length});
  for (int i = 0; i < code.measurements(); ++i) {
    EXPECT_NEAR(code.demodulation(i).mean(), 0.5, 1e-12);
    EXPECT_NEAR(code.modulation(i).mean(), 1.0, 1e-12);
  }
  EXPECT_NEAR(code.peak(), length, 1e-9);
}

TEST_P(HamiltonianOrder, GridRepresentsTheCodeExactly) {
  const CodeSet code =
      hamiltonian_code(GetParam(), {.samples = 2 * hamiltonian_length(GetParam())});
  const Eigen::MatrixXd d = code.demodulation_samples();
  EXPECT_LT((d.array() * (1.0 - d.array())).abs().maxCoeff(), 1e-12) << "samples are 0 or 1";
}

INSTANTIATE_TEST_SUITE_P(PublishedAndConstructed, HamiltonianOrder, testing::Range(3, 10));

TEST(Hamiltonian, PulseRespectsThePeak) {
  const CodeSet code = hamiltonian_code(5, {.samples = 240, .peak_factor = 4.0});
  EXPECT_DOUBLE_EQ(code.peak(), 4.0);
  EXPECT_NEAR(code.modulation(0).mean(), 1.0, 1e-12);
}

TEST(Hamiltonian, KeepsItsSwitchingTimesForAnyNumberOfSamples) {
  const CodeSet exact = hamiltonian_code(5, {.samples = 990});
  const CodeSet other = hamiltonian_code(5, {.samples = 1000});
  for (int i = 0; i < exact.measurements(); ++i)
    EXPECT_TRUE(exact.demodulation(i) == other.demodulation(i));
}

TEST(Families, RespectAnyPeakAndUseTheWholePower) {
  for (const char* name : {"sinusoid-k3", "square-k4", "hamiltonian-k3", "hamiltonian-k4",
                           "hamiltonian-k6", "multifrequency-k5", "multifrequency-1x4-5x4",
                           "pulsed-multifrequency-k5", "pulsed-multifrequency-k4-q5", "burst-k5-q4",
                           "burst-k5-q5", "gray-k4", "single-ramp-k3", "double-ramp-k3"})
    for (const double peak : {1.2, 2.0, 5.0, 15.0, 30.0}) {
      const CodeSet code = make_family(name, {.samples = 240, .peak_factor = peak});
      EXPECT_LE(code.peak(), peak * (1 + 1e-12));
      for (int e = 0; e < code.exposures(); ++e) {
        const double mean = code.modulation(e).mean();
        if (mean == 0.0) continue;  // a background exposure
        EXPECT_NEAR(mean, 1.0, 1e-12) << name << " at peak " << peak;
      }
    }
}

TEST(Families, EveryListedExampleCanBeBuilt) {
  for (const FamilyDescription& family : list_families()) {
    EXPECT_TRUE(is_family(family.example)) << family.example;
    EXPECT_NO_THROW(make_family(family.example, {.samples = 240})) << family.example;
  }
}

TEST(Families, UnknownNameSuggestsTheNearest) {
  EXPECT_THAT(refusal_of([] { make_family("hamiltonain-k4", {}); }), HasSubstr("hamiltonian-k4"));
}

// Taps that share an exposure measure the phase steps of one tap, each with its part of the light.
TEST(Families, PhaseStepsAreSharedByTaps) {
  for (const int taps : {3, 4, 5})
    for (const int steps : {taps, 2 * taps}) {
      const std::string name = fmt::format("sinusoid-k{}", steps);
      const CodeSet one = make_family(name, {.samples = 240});
      const CodeSet shared = make_family(name, {.samples = 240, .taps = taps});
      ASSERT_EQ(shared.taps(), taps);
      ASSERT_EQ(shared.exposures(), steps / taps);
      std::set<int> measured;
      for (int i = 0; i < steps; ++i)
        for (int step = 0; step < steps; ++step)
          if (std::abs(shared.demodulation(i).harmonics(1)[1] * (taps / 2.0) -
                       one.demodulation(step).harmonics(1)[1]) < 1e-12)
            measured.insert(step);
      EXPECT_EQ(static_cast<int>(measured.size()), steps) << name << ", " << taps << " taps";
    }
}

TEST(Families, TapsOfAnExposureCollectEveryElectronOnce) {
  for (const char* name : {"sinusoid-k6", "square-k6", "multifrequency-1x3-5x6"}) {
    const CodeSet code = make_family(name, {.samples = 240, .peak_factor = 1.0, .taps = 3});
    EXPECT_LE(code.peak(), 1.0 + 1e-12) << name;
    const Eigen::MatrixXd gains = code.demodulation_samples();
    for (int e = 0; e < code.exposures(); ++e)
      EXPECT_LT((gains.middleCols(3 * e, 3).rowwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12)
          << name << ", exposure " << e;
  }
}

TEST(Families, RejectTapsThatCannotShareTheirSteps) {
  const FamilyOptions three_taps{.samples = 240, .taps = 3};
  EXPECT_THAT(*why_no_family("sinusoid-k4", three_taps),
              HasSubstr("must be a multiple of the 3 taps"));
  EXPECT_THAT(*why_no_family("hamiltonian-k4", three_taps), HasSubstr("sinusoid-k3 or square-k3"));
}

TEST(GrayCode, NeighbouringCellsDifferInOneBit) {
  const Eigen::MatrixXd d = gray_code(4, {.samples = 16}).demodulation_samples();
  for (int n = 0; n < 16; ++n)
    EXPECT_DOUBLE_EQ((d.row((n + 1) % 16) - d.row(n)).cwiseAbs().sum(), 1.0);
}

TEST(CodingCurve, SquareWaveWithSquareLightIsATriangle) {
  Eigen::MatrixXd table(4, 1);
  table << 0, 0.5, 1, 0.5;
  EXPECT_DOUBLE_EQ(coding_curve_length(table), 2.0);
  EXPECT_EQ(harmonics_used(table), 1);
}

TEST(CodingCurve, RankCountsIndependentDirections) {
  Eigen::MatrixXd table(60, 3);
  for (int n = 0; n < 60; ++n)
    table.row(n) << std::cos(n * 0.1047198), std::sin(n * 0.1047198), std::cos(n * 0.1047198) + 3;
  EXPECT_EQ(coding_curve_rank(table), 2);
}

}  // namespace
}  // namespace tofsmith
