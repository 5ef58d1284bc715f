// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "design/factorize/factorized_code.hpp"
#include "design_setup.hpp"
#include "refusal.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Camera two_bucket() {
  Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  camera.sensor.taps = 2;
  return camera;
}
Camera analog() {
  Camera camera = coarse_camera("paper-5f0");
  camera.light.binary = camera.sensor.binary = false;
  camera.sensor.noise = NoiseModel::poisson;
  return camera;
}
Camera weak() {
  Camera camera = coarse_camera("paper-30x");
  camera.light.peak_factor = 3.0;
  return camera;
}

void expect_best_wins(const Camera& camera, const DesignResult& result, const std::string& naive) {
  ASSERT_NE(result.find(naive), nullptr) << naive;
  const DepthErrorKind kind = camera.operating.error;
  for (const Candidate& c : result.candidates) {
    if (c.code.exposures() == result.winner().code.exposures()) {
      EXPECT_LE(geometric_mean_error_m(result.winner().error, kind),
                geometric_mean_error_m(c.error, kind))
          << c.code.name();
    }
    EXPECT_NO_THROW(require_fits(c.code, camera));
    EXPECT_EQ(c.error.code, c.code.name());
    EXPECT_EQ(c.code.provenance.depth_error_m, geometric_mean_error_m(c.error, kind));
    if (c.is_designed() || c.method == "naive") {
      EXPECT_EQ(c.code.provenance.method, c.method);
      EXPECT_EQ(c.code.provenance.camera, camera.name);
      EXPECT_EQ(c.code.provenance.version, TOFSMITH_VERSION);
    }
  }
}

TEST(Design, WinnerIsNeverWorseThanTheNaiveCodeOrAnyBaseline) {
  for (const Camera& camera :
       {coarse_camera("paper-5f0"), coarse_camera("paper-5f0", DepthErrorKind::circular), weak(),
        two_bucket(), analog()}) {
    const DesignResult result = design(camera, small_options());
    expect_best_wins(camera, result, "hamiltonian-k3-naive");
    const Candidate* designed = result.find("hamiltonian-k3-factorized");
    ASSERT_NE(designed, nullptr);
    EXPECT_EQ(designed->per_measurement.size(), 3u);
    EXPECT_EQ(designed->target.rows(), camera.samples);
    EXPECT_EQ(designed->target.cols(), 3);
    EXPECT_FALSE(designed->message.empty());
    for (const MeasurementReport& m : designed->per_measurement) {
      EXPECT_LE(m.smallest_residual_rms, m.residual_rms);
      EXPECT_LE(m.peak, camera.light.peak_factor * (1 + 1e-9));
      EXPECT_FALSE(m.history.empty());
    }
  }
}

TEST(Design, ATargetWithoutDepthInformationIsExcludedWithAReason) {
  const Camera camera = coarse_camera("paper-10f0");
  DesignOptions options = small_options();
  const Eigen::MatrixXd constant = Eigen::MatrixXd::Constant(camera.samples, 3, 0.5);
  options.target = targets_from_table("constant", constant, camera.samples, false);
  options.baselines = {"hamiltonian-k3"};
  const DesignResult result = design(camera, options);
  EXPECT_EQ(result.winner().code.name(), "hamiltonian-k3");
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_NE(result.left_out[0].find("constant-factorized"), std::string::npos);
  EXPECT_NE(result.left_out[0].find("rank"), std::string::npos) << result.left_out[0];
}

TEST(Design, ErrorEqualsThatOfEvaluateWithTheSameSeedAndTrials) {
  const Camera camera = coarse_camera("paper-5f0");
  const DesignOptions options = small_options();
  const Candidate winner = design(camera, options).winner();
  const DepthErrorReport again =
      evaluate(winner.code, camera, {.trials = winner.error.trials, .seed = options.seed});
  EXPECT_EQ(again.linear.geometric_mean_m.value, winner.error.linear.geometric_mean_m.value);
  EXPECT_EQ(again.seed, winner.error.seed);
}

TEST(Design, ApproximatesAUserTarget) {
  const Camera camera = coarse_camera("paper-5f0");
  DesignOptions options = small_options();
  options.target = targets_of(build_family("square-k3", camera));
  const DesignResult known = design(camera, options);
  expect_best_wins(camera, known, "square-k3-naive");
  ASSERT_NE(known.find("square-k3-factorized"), nullptr);
  EXPECT_EQ(known.find("hamiltonian-k3-factorized"), nullptr);

  Eigen::MatrixXd table(4, 3);
  table << 0.0, 0.5, 1.0, 0.5, 1.0, 0.5, 1.0, 0.5, 0.0, 0.5, 0.0, 0.5;
  options.target = targets_from_table("mine", table, camera.samples, false);
  const DesignResult own = design(camera, options);
  ASSERT_NE(own.find("mine-factorized"), nullptr);
  EXPECT_EQ(own.find("mine-naive"), nullptr) << "no waveforms are known";
}

TEST(Design, BinaryArmsGetBinaryWaveformsOfASmoothTarget) {
  const Camera camera = coarse_camera("paper-5f0", DepthErrorKind::circular);
  DesignOptions options = small_options();
  options.target = targets_of(build_family("sinusoid-k3", camera));
  const DesignResult result = design(camera, options);
  const CodeSet& code = result.find("sinusoid-k3-factorized")->code;
  for (int i = 0; i < code.measurements(); ++i) {
    EXPECT_TRUE(code.demodulation(i).is_binary());
    EXPECT_TRUE(code.modulation_of(i).is_binary());
  }
}

TEST(Design, ReusesTheStoreAndSavesNewDesigns) {
  const Camera camera = coarse_camera("paper-5f0");
  std::vector<Candidate> saved;
  DesignStore store{.load = [](const std::string&) { return std::vector<Candidate>(); },
                    .save =
                        [&](const std::string& name, const std::vector<Candidate>& made) {
                          EXPECT_EQ(name, "hamiltonian-k3-factorized");
                          saved = made;
                        }};
  const DesignResult first = design(camera, small_options(), {}, store);
  ASSERT_EQ(saved.size(), 1u);
  EXPECT_EQ(saved[0].code.name(), "hamiltonian-k3-factorized");
  store.load = [&](const std::string& name) {
    EXPECT_EQ(name, "hamiltonian-k3-factorized");
    Candidate kept = saved[0];
    kept.message = "from the store";
    return std::vector<Candidate>{kept};
  };
  store.save = [](const std::string&, const std::vector<Candidate>&) {
    FAIL() << "nothing new to save";
  };
  const DesignResult second = design(camera, small_options(), {}, store);
  const Candidate* kept = second.find("hamiltonian-k3-factorized");
  EXPECT_EQ(kept->message, "from the store");
  expect_same_code(kept->code, first.find("hamiltonian-k3-factorized")->code);
}

TEST(Design, ExcludesFamiliesThatDoNotSuitTheCameraWithAReason) {
  Camera camera = coarse_camera("paper-5f0");
  camera.exposure_s.each_s = {0.1, 0.1, 0.1};
  DesignOptions options = small_options();
  options.baselines = {"sinusoid-k4", "sinusoid-k3", "sinusoid-x"};
  const DesignResult result = design(camera, options);
  EXPECT_EQ(result.find("sinusoid-k4"), nullptr);
  EXPECT_NE(result.find("sinusoid-k3"), nullptr);
  ASSERT_EQ(result.left_out.size(), 2u);
  EXPECT_THAT(result.left_out[0], HasSubstr("sinusoid-k4: number of exposure_s = 3"));
  EXPECT_THAT(result.left_out[1], HasSubstr("not a built-in family"));
}

TEST(Design, StopsOnRequestAtAnyTime) {
  const Camera camera = coarse_camera("paper-5f0");
  for (const double last : {0.0, 0.5, 1.0}) {
    const auto stop = [&](double fraction, std::string_view) {
      EXPECT_GE(fraction, 0.0);
      EXPECT_LE(fraction, 1.0);
      return fraction < last;
    };
    EXPECT_THROW(design(camera, small_options(), stop), Interrupted) << last;
  }
}

std::string refusal(const Camera& camera, const DesignOptions& options) {
  return refusal_of([&] {
    design(camera, options, [](double, std::string_view) -> bool {
      throw std::runtime_error("work began before the check");
    });
  });
}

TEST(Design, EffortScalesSearchesOnly) {
  const DesignOptions full, quick = with_effort(full, 0.05), longer = with_effort(full, 3);
  EXPECT_EQ(quick.optimize.starts, 2);
  EXPECT_EQ(quick.optimize.hops, 1);
  EXPECT_EQ(quick.optimize.refinement_steps, 50);
  EXPECT_EQ(quick.factorize.random_starts, 2);
  EXPECT_EQ(quick.search.annealing_starts, 2);
  EXPECT_EQ(quick.optimize.steps_per_start, full.optimize.steps_per_start);
  EXPECT_EQ(quick.trials, full.trials);
  EXPECT_EQ(longer.optimize.starts, 108);
  EXPECT_EQ(longer.factorize.random_starts, 90);
  EXPECT_EQ(with_effort(full, 0.0).method, DesignMethod::atlas);
  EXPECT_THROW(with_effort({.method = DesignMethod::optimize}, 0.0), std::invalid_argument);
  for (const double effort : {-1.0, 0.005, 101.0, std::nan("")})
    EXPECT_THROW(with_effort(full, effort), std::invalid_argument) << effort;
}

TEST(Design, RejectsInvalidRequestsBeforeAnyWork) {
  const auto with = [](auto&& change) {
    DesignOptions options = small_options();
    change(options);
    return refusal(coarse_camera("paper-5f0"), options);
  };
  EXPECT_THAT(with([](auto& o) { o.exposures = {7}; }), HasSubstr("DesignOptions::exposures = 7"));
  EXPECT_THAT(with([](auto& o) { o.exposures = {3, 3}; }), HasSubstr("must be listed once"));
  EXPECT_THAT(with([](auto& o) {
                o.baselines = {"gray-k4", "gray-k4"};
              }),
              HasSubstr("DesignOptions::baselines = gray-k4"));
  EXPECT_THAT(with([](auto& o) { o.trials = 3; }), HasSubstr("DesignOptions::trials = 3"));
  EXPECT_THAT(with([](auto& o) { o.search_trials = 3; }), HasSubstr("search_trials = 3"));
  EXPECT_THAT(with([](auto& o) { o.outlier_threshold_m = -1; }),
              HasSubstr("outlier_threshold_m = -1"));
  EXPECT_THAT(with([](auto& o) { o.factorize.kept = 0; }), HasSubstr("FactorizeOptions::kept"));
  EXPECT_THAT(with([](auto& o) {
                o.target = TargetSet{"none", {}};
              }),
              HasSubstr("DesignOptions::target"));
  EXPECT_THAT(with([](auto& o) {
                o.method = DesignMethod::best;
                o.exposures = {1};
                o.baselines = {"histogram-k4"};
              }),
              AllOf(HasSubstr("histogram-k4: "), HasSubstr("optimize: ")));
  EXPECT_THAT(with([](auto& o) {
                o.target = targets_from_table("two", Eigen::MatrixXd::Identity(4, 2), 60, false);
              }),
              HasSubstr("number of correlation functions = 2"));
  Camera camera = coarse_camera("paper-5f0");
  camera.sensor.taps = 3;
  EXPECT_THAT(refusal(camera, small_options()), HasSubstr("sensor.taps = 3"));
  camera = coarse_camera("paper-5f0");
  camera.exposure_s.each_s = {0.1, 0.2};
  EXPECT_THAT(refusal(camera, small_options()), HasSubstr("3 exposures of hamiltonian-k3"));
}

TEST(ChooseByDepthError, IsNeverWorseThanEitherStart) {
  for (const bool rotated : {false, true}) {
    const Camera camera = coarse_camera("paper-5f0");
    const TargetSet targets = targets_of(build_family("hamiltonian-k3", weak()));
    std::vector<Factorization> factorizations;
    for (const CorrelationTarget& target : targets.measurements)
      factorizations.push_back(factorize(target, camera, small_options().factorize));
    const EvaluateOptions search{.trials = 300, .seed = 5};
    const auto error_of = [&](const PairChoice& choice) {
      const CodeSet code = assemble("x", factorizations, choice, camera);
      const DepthErrorReport error = evaluate(code, camera, search);
      return (rotated ? error.circular : error.linear).geometric_mean_m.value;
    };
    PairChoice naive;
    for (const Factorization& f : factorizations) {
      std::size_t i = 0;
      while (f.candidates[i].start != "naive") ++i;
      naive.push_back(i);
    }
    const PairChoice chosen = choose_by_depth_error(factorizations, camera, search, rotated, {});
    EXPECT_LE(error_of(chosen), error_of(naive));
    EXPECT_LE(error_of(chosen), error_of(PairChoice(3, 0)));
  }
}

}  // namespace
}  // namespace tofsmith
