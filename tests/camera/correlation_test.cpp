// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/shared/random.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

Waveform random_waveform(RandomStream& random) {
  if (random() % 2 == 0) {
    Eigen::VectorXd samples(1 + static_cast<int>(random() % 9));
    for (double& sample : samples) sample = random.uniform();
    return Waveform::sampled(samples);
  }
  std::vector<double> times(2 + 2 * (random() % 3));
  for (double& time : times) time = random.uniform();
  std::sort(times.begin(), times.end());
  std::vector<OnInterval> on;
  for (std::size_t i = 0; i + 1 < times.size(); i += 2) on.push_back({times[i], times[i + 1]});
  return Waveform::binary(std::move(on), 0.5 + random.uniform());
}

double value_at(const Waveform& waveform, double t) {
  t = wrap(t, 1.0);
  if (!waveform.is_binary())
    return waveform
        .samples()[static_cast<Eigen::Index>(t * static_cast<double>(waveform.samples().size()))];
  for (const OnInterval& on : waveform.on_intervals())
    if ((t >= on.rise && t < on.fall) || t + 1.0 < on.fall) return waveform.level();
  return 0.0;
}

/// The defining integral, by the midpoint rule.
double integrated(const Waveform& d, const Waveform& m, double u) {
  constexpr int points = 40000;
  double sum = 0.0;
  for (int j = 0; j < points; ++j) {
    const double t = (j + 0.5) / points;
    sum += value_at(d, t) * value_at(m, t - u);
  }
  return sum / points;
}

TEST(CorrelationFunction, EqualsTheIntegralForAllKindsOfWaveformsAtAnyDepth) {
  for (std::uint32_t i = 0; i < 40; ++i) {
    RandomStream random(11, i);
    const Waveform d = random_waveform(random), m = random_waveform(random);
    const CorrelationFunction correlation(d, m);
    const double u = 4 * random.uniform() - 2;
    EXPECT_NEAR(correlation(u), integrated(d, m, u), 2e-3) << "case " << i << " at " << u;
    EXPECT_NEAR(correlation(u), correlation(u + 1), 1e-12);
  }
}

TEST(CorrelationFunction, HarmonicsOfAnUnlimitedCameraGiveTheSame) {
  for (std::uint32_t i = 0; i < 10; ++i) {
    RandomStream random(12, i);
    const Waveform d = random_waveform(random), m = random_waveform(random);
    const CorrelationFunction corners(d, m), harmonics(d, m, Eigen::VectorXcd::Ones(4000));
    for (int j = 0; j < 5; ++j) {
      const double u = random.uniform();
      EXPECT_NEAR(corners(u), harmonics(u), 1e-3);
    }
    const Eigen::VectorXd table = harmonics.table(37);
    for (int j = 0; j < 37; ++j) EXPECT_NEAR(table[j], harmonics(j / 37.0), 1e-10);
  }
}

// 2^18 pairs of breakpoints would take seconds, and 65536 samples 34 GB.
TEST(CorrelationFunction, OfManySamplesUsesTheirSharedGrid) {
  RandomStream random(7, 0);
  const auto sampled = [&](int size) {
    Eigen::VectorXd samples(size);
    for (double& sample : samples) sample = random.uniform();
    return Waveform::sampled(samples);
  };
  const Waveform d = sampled(600), m = sampled(600);
  // Few intervals on the same grid are evaluated by pairs of breakpoints.
  const Waveform chips = Waveform::binary({{0.1, 0.25}, {0.5, 0.505}}, 2.0);
  const CorrelationFunction grid(d, m), pairs(d, chips);
  for (const double u : {0.0, 1.0 / 600, 0.37, 0.9999}) {
    EXPECT_NEAR(grid(u), integrated(d, m, u), 1e-3) << u;
    EXPECT_NEAR(pairs(u), integrated(d, chips, u), 1e-3) << u;
  }
  const double cell = 1.0 / 600;
  EXPECT_NEAR(grid(0.4 * cell), 0.6 * grid(0.0) + 0.4 * grid(cell), 1e-12) << "straight in a cell";
  double sum = 0.0;
  for (int n = 0; n < 600; ++n) sum += d.samples()[(n + 100) % 600] * m.samples()[n];
  EXPECT_NEAR(grid(100 * cell), sum / 600, 1e-12);

  const Waveform huge = sampled(65536);
  EXPECT_NEAR(CorrelationFunction(huge, huge)(0.0), huge.samples().squaredNorm() / 65536, 1e-9);
}

TEST(CorrelationFunction, OmittedHarmonicsAreBelowRoundingError) {
  const Camera camera = built_in_camera("paper-10f0");
  constexpr int highest = 4096;
  const Eigen::VectorXcd transfer = camera.transfer(highest);
  for (std::uint64_t i = 0; i < 20; ++i) {
    RandomStream random(12, i);
    const Waveform d = random_waveform(random), m = random_waveform(random);
    const Eigen::VectorXcd all =
        d.harmonics(highest).cwiseProduct(m.harmonics(highest).conjugate()).cwiseProduct(transfer);
    const CorrelationFunction function(d, m, transfer);
    for (const double u : {0.0, 0.1234, 0.77}) {
      double expected = all[0].real();
      for (int n = 1; n <= highest; ++n)
        expected += 2.0 * (all[n] * std::polar(1.0, 2 * M_PI * wrap(n * u, 1.0))).real();
      EXPECT_NEAR(function(u), expected, 1e-13) << i;
    }
  }
}

TEST(CorrelationFunction, RejectsTooManySwitchingTimes) {
  std::vector<OnInterval> on;
  for (int i = 0; i < 8000; ++i) on.push_back({(i + 0.3 + 1e-5 * i) / 8000.1, (i + 0.7) / 8000.1});
  const Waveform many = Waveform::binary(on, 1.0);
  EXPECT_THROW(CorrelationFunction(many, many.delayed(0.1234567)), std::invalid_argument);
}

TEST(CodeSet, RotationShiftsTheOriginOfEveryCorrelationFunction) {
  for (const char* name : {"paper-30x", "paper-5f0"}) {
    const Camera camera = built_in_camera(name);
    const CodeSet code = build_family("hamiltonian-k4", camera);
    for (const int rotation : {1, 17, 239}) {
      const Eigen::MatrixXd before = ForwardModel(code, camera).correlation_table(240);
      const Eigen::MatrixXd after =
          ForwardModel(code.rotated(rotation), camera).correlation_table(240);
      for (int n = 0; n < 240; ++n)
        EXPECT_LT((after.row(n) - before.row((n + rotation) % 240)).norm(), 1e-9)
            << name << " rotated by " << rotation << ", bin " << n;
    }
  }
}

}  // namespace
}  // namespace tofsmith
