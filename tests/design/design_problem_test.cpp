// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/design_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/shared/random.hpp"
#include "design/optimize/edge_polish.hpp"
#include "design/optimize/waveform_parameters.hpp"

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

std::vector<WaveformSpace> spaces() {
  return {{.cells = 12, .repeat = 2, .exposures = 2, .taps = 1, .drain = true, .peak_factor = 4},
          {.cells = 16, .exposures = 2, .taps = 2, .peak_factor = 3},
          {.cells = 16, .exposures = 2, .taps = 2, .peak_factor = 3, .equal_duties = true},
          {.cells = 10, .exposures = 1, .taps = 3, .drain = true, .peak_factor = 5},
          {.cells = 10, .repeat = 3, .exposures = 2, .taps = 4, .peak_factor = 1.5}};
}

WaveformParameters random_parameters(const WaveformSpace& space, std::uint64_t seed) {
  RandomStream random(seed, 0);
  WaveformParameters p{Eigen::MatrixXd(space.cells, space.exposures),
                       Eigen::MatrixXd(space.cells, space.exposures * space.columns())};
  for (double& v : p.modulation.reshaped()) v = random.normal();
  for (double& v : p.demodulation.reshaped()) v = random.normal();
  return p;
}

TEST(WaveformParameters, EveryValueGivesAValidCode) {
  for (const WaveformSpace& space : spaces())
    for (const double steepness : {0.1, 1.0, 8.0, 200.0}) {
      const SampledCode code = render(space, random_parameters(space, 1), {steepness, steepness});
      EXPECT_GE(code.modulation.minCoeff(), 0.0);
      EXPECT_LE(code.modulation.maxCoeff(), space.peak_factor + 1e-9);
      EXPECT_NEAR(code.modulation.colwise().mean().maxCoeff(), 1.0, 1e-6);
      EXPECT_NEAR(code.modulation.colwise().mean().minCoeff(), 1.0, 1e-6);
      EXPECT_GE(code.demodulation.minCoeff(), 0.0);
      for (int e = 0; e < space.exposures; ++e) {
        const Eigen::VectorXd sum =
            code.demodulation.middleCols(e * space.taps, space.taps).rowwise().sum();
        EXPECT_LE(sum.maxCoeff(), 1.0 + 1e-12);
        if (!space.drain) {
          EXPECT_NEAR(sum.minCoeff(), 1.0, 1e-12);
        }
        if (space.equal_duties) {
          EXPECT_NEAR(code.demodulation.col(2 * e).mean(), 0.5, 1e-6);
        }
      }
    }
}

TEST(WaveformParameters, GradientMatchesFiniteDifferences) {
  const Sharpness sharpness{1.7, 2.3};
  for (const WaveformSpace& space : spaces()) {
    const WaveformParameters at = random_parameters(space, 2);
    const SampledCode code = render(space, at, sharpness);
    RandomStream random(5, 0);
    SampledCode weights = code;  // the function is the weighted sum of all samples
    for (double& w : weights.modulation.reshaped()) w = random.normal();
    for (double& w : weights.demodulation.reshaped()) w = random.normal();
    const auto value = [&](const WaveformParameters& p) {
      const SampledCode c = render(space, p, sharpness);
      return c.modulation.cwiseProduct(weights.modulation).sum() +
             c.demodulation.cwiseProduct(weights.demodulation).sum();
    };
    const WaveformParameters gradient = pull_back(space, code, sharpness, weights);
    const double step = 1e-5;
    for (auto arm : {&WaveformParameters::modulation, &WaveformParameters::demodulation})
      for (Eigen::Index i = 0; i < (at.*arm).size(); ++i) {
        WaveformParameters up = at, down = at;
        (up.*arm)(i) += step;
        (down.*arm)(i) -= step;
        EXPECT_NEAR((gradient.*arm)(i), (value(up) - value(down)) / (2 * step), 1e-5);
      }
  }
}

TEST(WaveformParameters, ReproduceASwitchingCode) {
  for (WaveformSpace space : spaces()) {
    space.cells = 60;
    space.peak_factor = 5.0;
    space.repeat = 2;
    SampledCode code{Eigen::MatrixXd::Zero(space.samples(), space.exposures),
                     Eigen::MatrixXd::Zero(space.samples(), space.exposures * space.taps)};
    for (int e = 0; e < space.exposures; ++e) {
      code.modulation.col(e).segment(2 * e, space.samples() / 5).setConstant(5.0);
      for (int n = 0; n < space.samples(); ++n) {
        const int to = n * space.classes() / space.samples();
        if (to < space.taps) code.demodulation(n, e * space.taps + to) = 1.0;
      }
    }
    const SampledCode again = render(space, parameters_near(space, code, 2.0), {30.0, 30.0});
    EXPECT_LT((again.demodulation - code.demodulation).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT((again.modulation - code.modulation).cwiseAbs().maxCoeff(), 5e-3);
  }
}

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
  return render(problem.space, random_parameters(problem.space, 4), {steepness, steepness});
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
