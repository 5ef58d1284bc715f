// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/switched_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "design/optimize/binarization.hpp"
#include "design/optimize/edge_polish.hpp"

namespace tofsmith {
namespace {

double shortest_run(const SwitchedLabels& labels) {
  double shortest = 1.0;
  for (std::size_t i = 0; i < labels.runs(); ++i) shortest = std::min(shortest, labels.length(i));
  return shortest;
}

DesignProblem problem_with(int taps, double shortest_periods = 0.0) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = taps;
  camera.light.peak_factor = 5.0;
  camera.operating.signal_e_per_s = camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = DepthErrorKind::circular;
  if (shortest_periods > 0.0)
    camera.sensor.shortest_pulse_s = shortest_periods / camera.fundamental_frequency_hz;
  return make_design_problem(std::span<const Camera>(&camera, 1), 3, 60);
}

SampledCode rendered(const DesignProblem& problem, double steepness) {
  RandomStream random(4, 0);
  const WaveformSpace& space = problem.space;
  WaveformParameters p{Eigen::MatrixXd(space.cells, space.exposures),
                       Eigen::MatrixXd(space.cells, space.exposures * space.columns())};
  for (double& v : p.modulation.reshaped()) v = random.normal();
  for (double& v : p.demodulation.reshaped()) v = random.normal();
  return render(space, p, {steepness, steepness});
}

TEST(SwitchedCode, ReadsRunsFromCellsRoundThePeriod) {
  const SwitchedLabels labels = SwitchedLabels::from_cells({1, 0, 0, 2, 1, 1, 1, 1});
  EXPECT_EQ(labels.at, (std::vector<double>{0.125, 0.375, 0.5}));
  EXPECT_EQ(labels.label, (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(labels.share(1), 0.625);
  EXPECT_EQ(shortest_run(labels), 0.125);
  EXPECT_EQ(labels.waveform(1, 2.0), Waveform::binary({{0.5, 1.125}}, 2.0));
  EXPECT_EQ(labels.waveform(5, 2.0), Waveform::constant(0.0));
  EXPECT_EQ(SwitchedLabels::from_cells({3, 3}).waveform(3, 1.0), Waveform::constant(1.0));
}

TEST(SwitchedCode, SamplesEqualThoseOfTheCodeSet) {
  for (const int taps : {1, 2, 3}) {
    const DesignProblem problem = problem_with(taps);
    const SwitchedCode code = binarized(problem, rendered(problem, 4.0));
    const SampledCode samples = sampled_on(problem.space, code);
    const CodeSet set = code_set("x", problem.space, code, problem.space.samples());
    EXPECT_LT((samples.modulation - set.modulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((samples.demodulation - set.demodulation_samples()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE(set.peak(), 5.0 * (1 + 1e-9));
  }
}

TEST(Binarization, DoesNotChangeASwitchedCode) {
  const DesignProblem problem = problem_with(3);
  const SampledCode code = sampled_on(problem.space, binarized(problem, rendered(problem, 4.0)));
  const SampledCode again = sampled_on(problem.space, binarized(problem, code));
  EXPECT_EQ((again.demodulation - code.demodulation).cwiseAbs().maxCoeff(), 0.0);
}

TEST(EdgePolish, GradientWithRespectToEdgesMatchesFiniteDifferences) {
  for (const int taps : {1, 2, 4}) {
    const DesignProblem problem = problem_with(taps);
    SwitchedCode code = binarized(problem, rendered(problem, 4.0));
    for (auto* arm : {&code.light, &code.gates})  // away from cell borders
      for (SwitchedLabels& labels : *arm)
        for (double& time : labels.at) time += 0.4 / problem.space.samples();
    SampledCode weights = sampled_on(problem.space, code);
    RandomStream random(8, 0);
    for (double& w : weights.modulation.reshaped()) w = random.normal();
    for (double& w : weights.demodulation.reshaped()) w = random.normal();
    const auto value = [&](const SwitchedCode& c) {
      const SampledCode s = sampled_on(problem.space, c);
      return s.modulation.cwiseProduct(weights.modulation).sum() +
             s.demodulation.cwiseProduct(weights.demodulation).sum();
    };
    const auto gradient = pull_back_to_edges(problem.space, code, weights);
    const double step = 1e-5;
    const auto check = [&](std::vector<SwitchedLabels> SwitchedCode::*arm, std::size_t index) {
      for (std::size_t e = 0; e < (code.*arm).size(); ++e)
        for (std::size_t i = 0; i < (code.*arm)[e].runs(); ++i) {
          SwitchedCode up = code, down = code;
          (up.*arm)[e].at[i] += step;
          (down.*arm)[e].at[i] -= step;
          const double slope = (value(up) - value(down)) / (2 * step);
          EXPECT_NEAR(gradient[index][e][i], slope, 1e-4 * (10.0 + std::abs(slope)));
        }
    };
    check(&SwitchedCode::light, 0);
    check(&SwitchedCode::gates, 1);
  }
}

TEST(EdgePolish, KeepsRunLengthsPeakAndOrderOfEdges) {
  const double shortest = 1.0 / 21.0;
  const DesignProblem problem = problem_with(1, shortest);
  EXPECT_EQ(problem.space.cells, 20);
  const SwitchedCode code = binarized(problem, rendered(problem, 4.0));
  const SwitchedCode polished = polish_edges(problem, code, 30, 40, 1, 2);
  bool moved = false;
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(polished.light[e].label, code.light[e].label);
    EXPECT_EQ(polished.gates[e].label, code.gates[e].label);
    EXPECT_GE(shortest_run(polished.light[e]), shortest);
    EXPECT_GE(shortest_run(polished.gates[e]), shortest);
    EXPECT_GE(polished.light[e].share(1), 1.0 / 5.0 - 1e-9);
    moved = moved || polished.gates[e].at != code.gates[e].at;
  }
  EXPECT_TRUE(moved);
}

}  // namespace
}  // namespace tofsmith
