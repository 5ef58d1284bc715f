// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/waveform_parameters.hpp"

#include <gtest/gtest.h>

#include "core/shared/random.hpp"

namespace tofsmith {
namespace {

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
    for (Eigen::Index i = 0; i < at.modulation.size(); ++i) {
      WaveformParameters up = at, down = at;
      up.modulation(i) += step;
      down.modulation(i) -= step;
      EXPECT_NEAR(gradient.modulation(i), (value(up) - value(down)) / (2 * step), 1e-5);
    }
    for (Eigen::Index i = 0; i < at.demodulation.size(); ++i) {
      WaveformParameters up = at, down = at;
      up.demodulation(i) += step;
      down.demodulation(i) -= step;
      EXPECT_NEAR(gradient.demodulation(i), (value(up) - value(down)) / (2 * step), 1e-5);
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

}  // namespace
}  // namespace tofsmith
