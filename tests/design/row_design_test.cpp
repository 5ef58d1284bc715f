// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "design/rows/dim_light.hpp"
#include "design/rows/tone_rows.hpp"
#include "design_setup.hpp"
#include "rows_setup.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {
namespace {

Camera camera_of(int samples, double signal_e, double ambient_e, double cutoff_hz) {
  Camera camera = rows_camera(samples, signal_e, ambient_e);
  camera.light.peak_factor = 12;
  camera.light.impulse_response.cutoff_hz = cutoff_hz;
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

Camera small_camera() { return camera_of(120, 1000, 3000, 60e6); }

DesignOptions quick(int rows) {
  DesignOptions options = with_effort({}, 0.1);
  options.method = DesignMethod::optimize;
  options.exposures = {rows};
  options.search_trials = 200;
  options.trials = 2000;
  return options;
}

double error_m(const CodeSet& code, const Camera& camera, int trials) {
  const EvaluateOptions judging{.trials = trials, .bounds = false};
  return evaluate(code, camera, judging).circular.geometric_mean_m.value;
}

TEST(RowDesign, BeatsEveryFamilyWithEqualRows) {
  const DesignResult result = design(small_camera(), quick(6));
  ASSERT_TRUE(result.find("fourier-k6"));
  ASSERT_TRUE(result.find("histogram-k6"));
  ASSERT_TRUE(result.find("hamiltonian-k5"));
  EXPECT_EQ(result.winner().code.name(), "tones-k6");
  EXPECT_TRUE(result.winner().is_designed());
  for (const Candidate& candidate : result.candidates) {
    if (candidate.is_designed()) continue;
    EXPECT_GT(gain_over(result, candidate, DepthErrorKind::circular).value, 1.1)
        << candidate.code.name();
  }
}

TEST(RowDesign, LightRespectsItsPeakAndMean) {
  const Camera camera = small_camera();
  for (const Candidate& candidate : row_candidates(camera, 8, quick(8), {})) {
    EXPECT_LE(candidate.code.peak(), 12 * (1 + 1e-9));
    EXPECT_NEAR(candidate.code.modulation(0).mean(), 1.0, 1e-9);
    EXPECT_TRUE(candidate.code.modulation(0).is_binary());
    EXPECT_FALSE(why_not_playable(candidate.code, camera));
  }
}

/// 240 bins; the impulse response attenuates the 20th harmonic to one half.
Camera camera_of_many_lobes() { return camera_of(240, 1000, 1000, 100e6); }

TEST(RowDesign, IsRobustToATenthOfTheLight) {
  const Camera camera = camera_of_many_lobes(), dim = in_share_of_light(camera, 0.1);
  EXPECT_EQ(dim.operating.signal_e_per_s[0], 100);
  EXPECT_EQ(dim.operating.ambient_e_per_s[0], 100);
  DesignOptions options = with_effort({}, 0.3);
  const CodeSet code = row_candidates(camera, 8, options, {}).front().code;
  // If optimized for the nominal light only, rows had an error of 7.8 mm there and of 373 mm at a
  // tenth.
  EXPECT_LT(error_m(code, camera, 4000), 1.04 * 7.8e-3);
  EXPECT_LT(error_m(code, dim, 4000), error_m(build_family("fourier-k8", camera), dim, 4000));
}

/// Mean absolute and root mean square errors of rows that minimize `statistic`; geometric means
/// over three seeds.
Eigen::Array2d errors_of_rows_for(ErrorStatistic statistic) {
  Camera camera = camera_of(240, 300, 3000, 100e6);
  camera.operating.statistic = statistic;
  DesignOptions options = with_effort({}, 0.3);
  Eigen::Array2d logarithms = Eigen::Array2d::Zero();
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    const CodeSet code = row_candidates(camera, 8, options, {}).front().code;
    const DepthErrorReport error = evaluate(code, camera, {.trials = 20000, .bounds = false});
    logarithms += Eigen::Array2d(error.circular.geometric_mean_m.value,
                                 error.circular_rmse.geometric_mean_m.value)
                      .log();
  }
  return (logarithms / 3.0).exp();
}

TEST(RowDesign, MinimizesTheSelectedStatisticWithoutManyWrongLobes) {
  const Eigen::Array2d mae = errors_of_rows_for(ErrorStatistic::mae);
  const Eigen::Array2d rmse = errors_of_rows_for(ErrorStatistic::rmse);
  EXPECT_LT(mae[0], rmse[0]);
  EXPECT_LT(rmse[1], 0.9 * mae[1]);
  EXPECT_LT(mae[1], 1.6 * rmse[1]);
}

Camera with_decoder(Camera camera, RowDecoder decoder) {
  camera.sensor.decoder = decoder;
  return camera;
}

TEST(RowDesign, RowsForThePlainDecoderSumToZero) {
  const Camera camera = with_decoder(small_camera(), RowDecoder::plain);
  for (const int rows : {3, 6, 8}) {
    const CodeSet code = row_candidates(camera, rows, quick(rows), {}).front().code;
    const Eigen::MatrixXd weights = code.demodulation_samples();
    ASSERT_EQ(weights.cols(), rows);
    EXPECT_LT(weights.rowwise().sum().cwiseAbs().maxCoeff(), 1e-12);
    // Thus, and because their noise is white, whitening has no effect.
    const double whitened_m = error_m(code, small_camera(), 2000);
    EXPECT_NEAR(error_m(code, camera, 2000), whitened_m, 1e-3 * whitened_m);
  }
}

TEST(RowDesign, WinsWithTheDecoderForWhichItIsDesigned) {
  const Camera usual = camera_of(240, 300, 3000, 100e6);
  const Camera plain = with_decoder(usual, RowDecoder::plain);
  const DesignOptions options = with_effort({}, 0.3);
  const auto plain_error_m = [&](const Camera& designed_on) {
    return error_m(row_candidates(designed_on, 8, options, {}).front().code, plain, 20000);
  };
  EXPECT_LT(plain_error_m(plain), plain_error_m(usual));
}

TEST(RowDesign, ReportsAStandardCodeThatIsBetterInDimLight) {
  const Camera camera = camera_of_many_lobes();
  DesignResult result;
  for (const char* name : {"fourier-k8", "histogram-k8"})
    result.candidates.push_back({.code = build_family(name, camera), .method = "family"});
  const DesignOptions options = quick(8);
  EXPECT_FALSE(dim_light_note(camera, result, options)) << "fourier-k8 is the better of the two";
  result.best = 1;
  const std::optional<std::string> note = dim_light_note(camera, result, options);
  ASSERT_TRUE(note);
  EXPECT_THAT(*note, testing::HasSubstr("S = 100 e/s"));
  EXPECT_THAT(*note, testing::HasSubstr("fourier-k8"));
  EXPECT_THAT(*note, testing::HasSubstr("operating.signal_e_per_s = [100, 1000] and "
                                        "operating.ambient_e_per_s = [100, 1000]"));
  // Without baselines, nothing is compared.
  result.candidates.erase(result.candidates.begin());
  result.best = 0;
  EXPECT_FALSE(dim_light_note(camera, result, options));
}

TEST(RowDesign, MoreRowsAreNoWorse) {
  const Camera camera = small_camera();
  DesignOptions options = quick(4);
  options.exposures = {4, 8};
  const DesignResult result = design(camera, options);
  EXPECT_LT(result.find("tones-k8")->error.circular.geometric_mean_m.value,
            result.find("tones-k4")->error.circular.geometric_mean_m.value);
}

TEST(RowDesign, IsTheSameForAnyNumberOfThreads) {
  const Camera camera = small_camera();
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return row_candidates(camera, 5, quick(5), {});
  };
  const auto first = with_threads(1), again = with_threads(4);
  ASSERT_EQ(first.size(), again.size());
  expect_same_code(first.front().code, again.front().code);
  EXPECT_EQ(first.front().code.provenance.version, TOFSMITH_VERSION);
}

TEST(RowDesign, StopsOnRequestAtAnyTime) {
  for (const double last : {0.0, 0.2, 0.5, 0.9}) {
    const auto stop = [&](double fraction, std::string_view) {
      EXPECT_GE(fraction, 0.0);
      EXPECT_LE(fraction, 1.0);
      return fraction < last;
    };
    EXPECT_THROW(row_candidates(small_camera(), 4, quick(4), stop), Interrupted) << last;
  }
}

TEST(RowDesign, ReportsUnsupportedRequests) {
  Camera camera = small_camera();
  EXPECT_THROW(design(camera, quick(2)), InvalidArgument);
  EXPECT_THROW(design(camera, quick(17)), InvalidArgument);
  camera.light.peak_factor = 1.0;
  EXPECT_EQ(why_no_row_design(camera, 6)->field, "light.peak_factor");
  camera = small_camera();
  camera.samples = 12;
  EXPECT_EQ(why_no_row_design(camera, 8)->field, "samples");
  // At most 8 exposures are supported.
  DesignOptions many = quick(9);
  EXPECT_THROW(design(built_in_camera("paper-10f0"), many), InvalidArgument);
  DesignOptions options = quick(4);
  options.method = DesignMethod::factorize;
  EXPECT_THROW(design(small_camera(), options), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith
