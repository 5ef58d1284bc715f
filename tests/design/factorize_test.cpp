// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/factorize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/shared/random.hpp"
#include "design/factorize/alternation.hpp"
#include "design/factorize/edge_refinement.hpp"
#include "design/run_lengths.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

Camera camera_with_peak(double peak_factor, double f_max_over_f0 = 0.0) {
  Camera camera = built_in_camera("paper-30x");
  camera.light.peak_factor = peak_factor;
  if (f_max_over_f0 > 0) {
    ImpulseResponse response;
    response.kind = ImpulseResponse::Kind::hann;
    response.f_max_hz = f_max_over_f0 * camera.fundamental_frequency_hz;
    camera.light.impulse_response = camera.sensor.impulse_response = response;
  }
  return camera;
}

TargetSet hamiltonian_targets(int order) {
  return targets_of(make_family("hamiltonian-k" + std::to_string(order), {.samples = 240}));
}

FactorizeOptions random_starts_only(std::uint64_t seed) {
  FactorizeOptions options;
  options.structured_starts = options.keep_naive = false;
  options.seed = seed;
  return options;
}

TEST(Factorize, RandomStartsFindTheExactPairIfThePeakAllowsIt) {
  for (const double peak : {6.0, 15.0, 30.0}) {
    const Factorization f = factorize(hamiltonian_targets(3).measurements[0],
                                      camera_with_peak(peak), random_starts_only(3));
    EXPECT_LT(f.best().residual_rms, 1e-6) << "peak " << peak;
    EXPECT_TRUE(f.exact());
    EXPECT_NEAR(f.best().pair.modulation.duty(), 1.0 / 6.0, 1e-12);
    EXPECT_NEAR(f.best().pair.modulation.peak(), 6.0, 1e-9) << "a higher peak brings nothing";
    EXPECT_NEAR(f.best().pair.demodulation.duty(), 0.5, 1e-12);
  }
}

TEST(Factorize, AtTwiceTheAveragePowerBothWaveformsAreSquare) {
  const Factorization f = factorize(hamiltonian_targets(3).measurements[1], camera_with_peak(2.0),
                                    random_starts_only(1));
  EXPECT_NEAR(f.best().pair.modulation.duty(), 0.5, 2e-3);
  EXPECT_NEAR(f.best().pair.demodulation.duty(), 0.5, 2e-3);
  EXPECT_EQ(f.best().pair.modulation.edges(), 2);
  EXPECT_LT(f.best().residual_rms, 1.02 * 0.1927);
}

TEST(Factorize, ResidualIsAsSmallAsThatOfAnIndependentPrototype) {
  struct Case {
    int order;
    std::size_t measurement;
    double peak_factor, f_max_over_f0;
    double residual_rms;  // of the prototype, rounded
  };
  for (const Case& c :
       {Case{3, 0, 5, 0, 0.0308}, Case{4, 2, 5, 0, 0.131}, Case{5, 3, 15, 0, 0.0654},
        Case{3, 0, 15, 10, 0.016}, Case{4, 0, 15, 5, 0.121}, Case{5, 4, 15, 10, 0.319}}) {
    const Factorization f = factorize(hamiltonian_targets(c.order).measurements[c.measurement],
                                      camera_with_peak(c.peak_factor, c.f_max_over_f0));
    EXPECT_LT(f.best().residual_rms, 1.02 * c.residual_rms + 5e-4) << c.order << c.measurement;
  }
}

TEST(Factorize, EveryCandidateSuitsTheCameraAndOneIsNaive) {
  const Camera camera = camera_with_peak(4.0, 10.0);
  const Factorization f = factorize(hamiltonian_targets(4).measurements[2], camera);
  for (const PairCandidate& c : f.candidates) {
    EXPECT_LE(c.pair.modulation.peak(), 4.0 * (1 + 1e-9)) << c.start;
    EXPECT_LE(c.pair.modulation.mean(), 1.0 + 1e-9) << c.start;
    EXPECT_GE(c.pair.modulation.minimum(), 0.0) << c.start;
    EXPECT_LE(c.pair.demodulation.peak(), 1.0 + 1e-9) << c.start;
    EXPECT_TRUE(c.pair.modulation.is_binary());
    EXPECT_TRUE(c.pair.demodulation.is_binary());
  }
  EXPECT_TRUE(std::ranges::is_sorted(f.candidates, {}, &PairCandidate::residual_rms));
  EXPECT_TRUE(
      std::ranges::any_of(f.candidates, [](const PairCandidate& c) { return c.start == "naive"; }));
}

TEST(Factorize, AnalogArmsFitAtLeastAsWellAsBinaryOnes) {
  Camera analog = camera_with_peak(5.0, 5.0);
  analog.light.binary = analog.sensor.binary = false;
  const CorrelationTarget target = hamiltonian_targets(4).measurements[2];
  FactorizeOptions options;
  options.max_iterations = 40;
  const double binary = factorize(target, camera_with_peak(5.0, 5.0), options).best().residual_rms;
  EXPECT_LT(factorize(target, analog, options).best().residual_rms, binary * 1.01);
}

TEST(Factorize, RespectsTheShortestPulse) {
  Camera camera = camera_with_peak(15.0, 20.0);
  const CorrelationTarget target = hamiltonian_targets(5).measurements[2];
  camera.sensor.shortest_pulse_s = 0.06 / camera.fundamental_frequency_hz;
  for (const PairCandidate& c : factorize(target, camera).candidates)
    for (const Waveform& w : {c.pair.modulation, c.pair.demodulation})
      for (const OnInterval& on : w.on_intervals())
        EXPECT_GE(on.fall - on.rise, 0.06 - 1e-9) << c.start;
  camera.sensor.shortest_pulse_s = 0.9 / camera.fundamental_frequency_hz;
  EXPECT_THAT(factorize(target, camera).message, testing::HasSubstr("shortest_pulse_s"));
}

TEST(Factorize, UnreachableTargetsEndAsAResult) {
  TargetSet shifted = hamiltonian_targets(3);
  shifted.measurements[0].samples.array() = 3.0 * shifted.measurements[0].samples.array() - 1.0;
  shifted.measurements[0].ideal.reset();
  const Factorization f = factorize(shifted.measurements[0], camera_with_peak(6.0));
  EXPECT_FALSE(f.exact());
  EXPECT_GT(f.best().residual_rms, 0.3);
  EXPECT_THAT(f.message, testing::HasSubstr("exceeds [0, 1]"));
}

TEST(Factorize, StopsOnRequest) {
  EXPECT_THROW(factorize(hamiltonian_targets(3).measurements[0], camera_with_peak(5.0), {},
                         [](double, std::string_view) { return false; }),
               Interrupted);
}

TEST(Factorize, RejectsInvalidTargetsAndOptions) {
  const CorrelationTarget target = hamiltonian_targets(3).measurements[0];
  FactorizeOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(factorize(target, camera_with_peak(5.0), options), std::invalid_argument);
  Camera other = camera_with_peak(5.0);
  other.samples = 120;
  EXPECT_THROW(factorize(target, other), std::invalid_argument);
}

TEST(Alternation, ObjectiveDoesNotRise) {
  const Camera camera = camera_with_peak(5.0);
  const PairModel model(hamiltonian_targets(4).measurements[2], camera);
  FactorizeOptions options;
  options.max_iterations = 25;
  CirculantTvSolver solver(model.samples());
  for (int start = 0; start < 5; ++start) {
    const AlternationResult run =
        alternate(model, random_start(model, 1, start).pair, 3e-4, options, solver);
    for (std::size_t i = 1; i < run.history.size(); ++i)
      EXPECT_LE(run.history[i].objective, run.history[i - 1].objective * (1 + 1e-6));
  }
}

TEST(PairModel, GridModelAgreesWithTheContinuousOneAtTheBins) {
  const Camera camera = camera_with_peak(5.0, 10.0);
  const PairModel model(hamiltonian_targets(4).measurements[0], camera);
  const AlternationStart start = random_start(model, 5, 0);
  const CorrelationFunction exact(Waveform::sampled(start.pair.demodulation),
                                  Waveform::sampled(start.pair.modulation), camera.transfer(4000));
  Eigen::VectorXd difference = exact.table(240) - model.target_samples();
  EXPECT_NEAR(model.residual_rms(start.pair.modulation, start.pair.demodulation),
              std::sqrt(difference.squaredNorm() / 240), 1e-9);
}

TEST(RunLengths, DerivativesMatchFiniteDifferences) {
  const Waveform w = Waveform::binary({{0.1, 0.25}, {0.5, 0.7}, {0.9, 1.02}}, 2.0);
  for (const double shortest_duty : {0.0, 0.2}) {
    const RunLengths runs(w, shortest_duty);
    const Eigen::VectorXd at = runs.parameters();
    Eigen::VectorXd times, high, low;
    Eigen::MatrixXd derivatives, unused;
    runs.edges(at, times, derivatives);
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      Eigen::VectorXd moved = at;
      moved[k] += 1e-6;
      runs.edges(moved, high, unused);
      moved[k] -= 2e-6;
      runs.edges(moved, low, unused);
      EXPECT_LT(((high - low) / 2e-6 - derivatives.col(k)).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(RunLengths, AnyParametersGiveAValidWaveform) {
  const RunLengths runs(Waveform::binary({{0.1, 0.25}, {0.5, 0.7}, {0.9, 1.02}}, 2.0), 0.2);
  for (std::uint64_t i = 0; i < 200; ++i) {
    RandomStream random(4, i);
    Eigen::VectorXd parameters = runs.parameters();
    for (double& p : parameters) p += 0.7 * random.normal();
    parameters[parameters.size() - 1] = std::min(0.95, std::abs(parameters[parameters.size() - 1]));
    const Waveform w = runs.waveform(parameters, 1e-3);
    EXPECT_LE(w.peak(), 5.0 * (1 + 1e-12));
    EXPECT_LE(w.mean(), 1.0 + 1e-12);
    EXPECT_GE(w.mean(), 0.95) << "only runs shorter than 1e-3 may be missing";
  }
}

TEST(EdgeRefinement, FindsSwitchingTimesBetweenGridPoints) {
  const Camera camera = camera_with_peak(30.0, 10.0);
  const double width = 0.0731;
  const WaveformPair truth{rectangular_pulse(width, 0.2), Waveform::binary({{0.317, 0.817}})};
  CorrelationTarget target{
      CorrelationFunction(truth.demodulation, truth.modulation, camera.transfer(2000)).table(240),
      0.5, std::nullopt};
  const PairModel model(target, camera);
  const WaveformPair start{rectangular_pulse(0.09, 0.21), Waveform::binary({{0.33, 0.8}})};
  const auto refined = refine_edges(model, start);
  ASSERT_TRUE(refined.has_value());
  EXPECT_NEAR(refined->modulation.duty(), width, 1e-3);
  EXPECT_NEAR(refined->demodulation.mean(), 0.5, 1e-4);
  EXPECT_LT(model.residual_rms(*refined), 1e-3);
}

TEST(EdgeRefinement, DoesNotChangeConstants) {
  const Camera camera = camera_with_peak(5.0);
  const PairModel model(hamiltonian_targets(3).measurements[0], camera);
  EXPECT_FALSE(refine_edges(model, {Waveform::constant(1.0), square_wave(1, 0)}).has_value());
}

TEST(TargetSet, UserTablesAreResampledAndChecked) {
  Eigen::MatrixXd table(4, 1);
  table << 0, 1, 2, 1;
  const TargetSet set = targets_from_table("mine", table, 8, true);
  EXPECT_EQ(set.samples(), 8);
  EXPECT_DOUBLE_EQ(set.measurements[0].samples[1], 0.25);
  EXPECT_DOUBLE_EQ(set.measurements[0].samples.maxCoeff(), 1.0);
  table(2, 0) = std::nan("");
  EXPECT_THROW(targets_from_table("mine", table, 8, false), std::invalid_argument);
  for (const double size : {1e200, 1e-200})
    EXPECT_THROW(targets_from_table("mine", size * Eigen::MatrixXd::Random(9, 1), 8, false),
                 std::invalid_argument);
  EXPECT_THROW(targets_from_table("mine", Eigen::MatrixXd::Ones(9, 1), 8, true),
               std::invalid_argument);
}

TEST(SettleOnPoints, GeneratorsReproduceItExactlyAndItBeatsRounding) {
  const Camera camera = built_in_camera("prototype");
  const double f0_hz = camera.fundamental_frequency_hz;
  for (const CorrelationTarget& target :
       targets_of(make_family("hamiltonian-k5", {.samples = camera.samples})).measurements) {
    const PairModel model(target, camera);
    const WaveformPair ideal = naive_start(model).front().pair;
    const WaveformPair between = {ideal.modulation.delayed(0.0031),
                                  ideal.demodulation.delayed(0.0031)};
    const auto settled = settle_on_points(model, between);
    ASSERT_TRUE(settled);
    EXPECT_EQ(generated(settled->modulation, *camera.light.generator, f0_hz), settled->modulation);
    EXPECT_EQ(generated(settled->demodulation, *camera.sensor.generator, f0_hz),
              settled->demodulation);
    EXPECT_LE(settled->modulation.peak(), camera.light.peak_factor * (1 + 1e-9));
    EXPECT_NEAR(settled->modulation.mean(), 1.0, 1e-9);
    EXPECT_LE(model.residual_rms(*settled), model.residual_rms(between));
  }
}

TEST(SettleOnPoints, ReturnsNothingWithoutGenerators) {
  const Camera camera = camera_with_peak(8);
  const PairModel model(hamiltonian_targets(4).measurements[1], camera);
  EXPECT_FALSE(settle_on_points(model, naive_start(model).front().pair));
}

TEST(Alternate, MatchesTheCandidateOfTheSameStart) {
  const CorrelationTarget target = hamiltonian_targets(4).measurements[2];
  FactorizeOptions options = random_starts_only(7);
  options.random_starts = 1;
  options.refine_edges = false;
  options.total_variation_weights = {3e-4};
  const Factorization whole = factorize(target, camera_with_peak(15), options);
  const Alternation one = alternate(target, camera_with_peak(15), 0, 3e-4, options);
  EXPECT_EQ(one.playable.modulation, whole.best().pair.modulation);
  EXPECT_EQ(one.playable.demodulation, whole.best().pair.demodulation);
  EXPECT_EQ(std::ssize(one.history), whole.best().iterations);
}

TEST(Alternate, RelaxedWaveformsKeepTheBoundsWithoutTotalVariation) {
  const Alternation one =
      alternate(hamiltonian_targets(3).measurements[0], camera_with_peak(15), 2, 0.0);
  EXPECT_LE(one.relaxed.modulation.peak(), 15 + 1e-9);
  EXPECT_LE(one.relaxed.modulation.mean(), 1 + 1e-9);
  EXPECT_GE(one.relaxed.demodulation.samples().minCoeff(), -1e-9);
  EXPECT_FALSE(one.relaxed.modulation.is_binary());
  EXPECT_TRUE(one.playable.modulation.is_binary());
}

TEST(Alternate, RefusesBadArguments) {
  const CorrelationTarget target = hamiltonian_targets(3).measurements[0];
  EXPECT_THROW(alternate(target, camera_with_peak(15), -1, 0.0), std::invalid_argument);
  EXPECT_THROW(alternate(target, camera_with_peak(15), 0, -1e-4), std::invalid_argument);
  Camera other = camera_with_peak(15);
  other.samples = 120;
  EXPECT_THROW(alternate(target, other, 0, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
