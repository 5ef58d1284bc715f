// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/interference_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "simulate/interference_light.hpp"
#include "simulate/shared/depth_information.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;

/// A camera in bright light with weak light of other cameras.
Camera lit_camera(const OperatingInterference& others, int taps = 1) {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.total_s = 20e-3;
  camera.sensor.taps = taps;
  camera.operating.signal_e_per_s = {1e8};
  camera.operating.ambient_e_per_s = {1e6};
  camera.operating.error = DepthErrorKind::circular;
  camera.operating.interference = others;
  return camera;
}

InterferenceReport report_of(const std::string& family, const Camera& camera,
                             std::int64_t trials = 20000) {
  return interference_error(build_family(family, camera), camera, {.trials = trials});
}

double rms_m(const std::string& family, const Camera& camera) {
  return report_of(family, camera, 2).rms_m;
}

/// Error of each depth and phase of the other camera, from the expected measurements.
double enumerated_rms_m(const CodeSet& code, const Camera& camera, int phases) {
  const ForwardModel model(code, camera);
  const Eigen::Index cells = default_cells_per_bin(model) * model.samples();
  Eigen::MatrixXd signal, slope;
  middles_and_slopes(model.correlation_table(static_cast<int>(2 * cells)), signal, slope);
  const Eigen::MatrixXd light = model.correlation_table(phases);
  double square = 0.0;
  for (Eigen::Index j = 0; j < cells; ++j) {
    const DepthPart<Eigen::VectorXd> depth(slope.row(j), signal.row(j), model.ambient_gain());
    const Eigen::VectorXd error = light * (depth.across / (depth.length * depth.length));
    square += error.squaredNorm() / static_cast<double>(phases * cells);
  }
  return camera.operating.interference->signal_ratio * camera.range_m() * std::sqrt(square);
}

TEST(Interference, ClosedFormIsTheAverageOverAllDepthsAndPhases) {
  for (const int taps : {1, 2})
    for (const char* name : {"sinusoid-k4", "square-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
      const Camera camera = lit_camera({.signal_ratio = 0.01}, taps);
      const double expected_m = enumerated_rms_m(build_family(name, camera), camera, 480);
      EXPECT_NEAR(rms_m(name, camera), expected_m, 1e-4 * expected_m) << name << ", " << taps;
    }
}

TEST(Interference, OfASinusoidIsTheErrorOfASecondReturnWithRandomPhase) {
  const Camera camera = lit_camera({.signal_ratio = 0.02});
  EXPECT_NEAR(rms_m("sinusoid-k4", camera),
              0.02 * camera.range_m() / (2.0 * std::numbers::pi * std::sqrt(2.0)), 1e-6);
}

TEST(Interference, TrialsAgreeWithTheClosedForm) {
  const std::vector<OperatingInterference> all = {
      {.signal_ratio = 0.002},
      {.cameras = 3, .signal_ratio = 0.001},
      {.signal_ratio = 0.002, .frequency_offset_hz = 37.0},
      {.signal_ratio = 0.005, .frequency_offset_hz = 730.0},
      {.signal_ratio = 0.01, .spreading = Spreading::phases, .parts = 16},
      {.signal_ratio = 0.01, .spreading = Spreading::signs, .parts = 8},
      {.signal_ratio = 0.002,
       .frequency_offset_hz = 37.0,
       .spreading = Spreading::phases,
       .parts = 2},
      {.signal_ratio = 0.002, .code = "multifrequency-k5"}};
  for (const OperatingInterference& others : all)
    for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "multifrequency-k5"}) {
      const InterferencePoint point = report_of(name, lit_camera(others)).points.front();
      EXPECT_NEAR(point.circular_rmse_m.value, point.expected_rmse_m,
                  4.0 * point.circular_rmse_m.standard_error)
          << name << ", ratio " << others.signal_ratio << ", offset " << others.frequency_offset_hz
          << " Hz, spreading " << static_cast<int>(others.spreading) << ", " << others.code;
    }
}

TEST(Interference, TrialsAgreeWithTheClosedFormOnOtherReceivers) {
  Camera differences = lit_camera({.signal_ratio = 0.002}, 2), mixer = lit_camera({}),
         neighbours = lit_camera({.signal_ratio = 0.002, .frequency_offset_hz = 37.0});
  differences.sensor.readout = Readout::difference;
  mixer.sensor.demodulation = Demodulation::weight;
  mixer.operating.interference->signal_ratio = 0.002;
  neighbours.operating.neighbours = 4;
  for (const Camera& camera : {differences, mixer, neighbours}) {
    const InterferencePoint point = report_of("hamiltonian-k4", camera).points.front();
    EXPECT_NEAR(point.circular_rmse_m.value, point.expected_rmse_m,
                4.0 * point.circular_rmse_m.standard_error);
  }
}

// A camera that plays its waveforms backwards in time measures chi(-z).
TEST(Interference, ReversedDelaysReverseTheBeat) {
  Camera reversed = lit_camera({.frequency_offset_hz = 37.0}), slower = reversed;
  reversed.playback.emplace().reversed = true;
  slower.operating.interference->frequency_offset_hz = -37.0;
  const double faster_m = rms_m("hamiltonian-k5", lit_camera({.frequency_offset_hz = 37.0}));
  const double slower_m = rms_m("hamiltonian-k5", slower);
  EXPECT_NEAR(rms_m("hamiltonian-k5", reversed), slower_m, 1e-6 * slower_m);
  EXPECT_GT(std::abs(faster_m - slower_m), 1e-3 * slower_m);
}

TEST(Interference, ErrorsOfIndependentCamerasAddInQuadrature) {
  OperatingInterference others{.signal_ratio = 0.01};
  const double one_m = rms_m("hamiltonian-k5", lit_camera(others));
  others.cameras = 9;
  EXPECT_NEAR(rms_m("hamiltonian-k5", lit_camera(others)), 3.0 * one_m, 1e-9);
}

TEST(Interference, RandomPhasesReduceItByTheRootOfTheirNumber) {
  OperatingInterference others{.spreading = Spreading::phases, .parts = 1};
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "multifrequency-k5"}) {
    others.parts = 1;
    const double one_m = rms_m(name, lit_camera(others));
    others.parts = 25;
    EXPECT_NEAR(rms_m(name, lit_camera(others)), one_m / 5.0, 1e-9) << name;
  }
}

TEST(Interference, RandomSignsDoNotReduceEvenHarmonics) {
  OperatingInterference others{.spreading = Spreading::signs, .parts = 4096};
  const double none_m = rms_m("sinusoid-k4", lit_camera({}));
  EXPECT_LT(rms_m("sinusoid-k4", lit_camera(others)), none_m / 60.0);
  EXPECT_GT(rms_m("hamiltonian-k4", lit_camera(others)),
            0.1 * rms_m("hamiltonian-k4", lit_camera({})));
}

TEST(Interference, OffsetsOfWholeBeatPeriodsRemoveIt) {
  // Exposures of 5 ms.
  const double none_m = rms_m("hamiltonian-k4", lit_camera({}));
  EXPECT_LT(rms_m("hamiltonian-k4", lit_camera({.frequency_offset_hz = 200.0})), 1e-6 * none_m);
  EXPECT_LT(rms_m("hamiltonian-k4", lit_camera({.frequency_offset_hz = -1000.0})), 1e-6 * none_m);
  const double sinusoid_m = rms_m("sinusoid-k4", lit_camera({}));
  EXPECT_NEAR(rms_m("sinusoid-k4", lit_camera({.frequency_offset_hz = 300.0})),
              sinusoid_m / (1.5 * std::numbers::pi), 1e-6)
      << "|sinc(1.5)|";
}

/// Mean light in an exposure, from samples of light and demodulation over time.
double sampled_light(const Waveform& demodulation, const Waveform& light, const Camera& camera,
                     double phase, double begin_s, double end_s) {
  constexpr int cells = 4096, samples = 400'009;
  const Eigen::VectorXd gate = demodulation.cell_averages(cells);
  const Eigen::VectorXd power = light.cell_averages(cells);
  const auto at = [](const Eigen::VectorXd& values, double periods) {
    return values[static_cast<Eigen::Index>((periods - std::floor(periods)) * cells) % cells];
  };
  const double own_hz = camera.fundamental_frequency_hz;
  const double other_hz = own_hz + camera.operating.interference->frequency_offset_hz;
  double sum = 0.0;
  for (int j = 0; j < samples; ++j) {
    const double time_s = begin_s + (j + 0.5) / samples * (end_s - begin_s);
    sum += at(gate, own_hz * time_s) * at(power, other_hz * time_s - phase);
  }
  return sum / samples;
}

TEST(Interference, LightIsTheMeanProductOfBothWaveformsOverTime) {
  // 500 periods in each exposure.
  for (const double offset_hz : {0.0, 130.0, -250.0, 0.5e5, 2e5})
    for (const char* name : {"sinusoid-k4", "square-k4", "hamiltonian-k4"}) {
      Camera camera = lit_camera({.frequency_offset_hz = offset_hz});
      camera.fundamental_frequency_hz = 1e5;
      camera.light.impulse_response = camera.sensor.impulse_response = {};
      const CodeSet code = build_family(name, camera);
      const InterferenceLight other(code, camera);
      for (const int row : {0, 700, 1500})
        for (int e = 0; e < 4; ++e)
          EXPECT_NEAR(other.whole(0)(row, e),
                      sampled_light(code.demodulation(e), code.modulation(e), camera,
                                    static_cast<double>(row) / InterferenceLight::phases,
                                    5e-3 * (e - 2), 5e-3 * (e - 1)),
                      5e-3)
              << name << ", " << offset_hz << " Hz, exposure " << e;
    }
}

TEST(Interference, OfOtherFrequenciesIsDueToCommonHarmonics) {
  const double f0_hz = lit_camera({}).fundamental_frequency_hz;
  const double none_m = rms_m("square-k4", lit_camera({}));
  const double twice_m = rms_m("square-k4", lit_camera({.frequency_offset_hz = f0_hz}));
  const double thrice_m = rms_m("square-k4", lit_camera({.frequency_offset_hz = 2.0 * f0_hz}));
  EXPECT_LT(twice_m, 1e-4 * none_m) << "square waves have no even harmonics";
  EXPECT_GT(thrice_m, 0.05 * none_m);
  EXPECT_LT(thrice_m, 0.7 * none_m);
}

TEST(Interference, IsInfiniteOnlyInExpectationForUniformAlbedo) {
  Camera camera = lit_camera({.signal_ratio = 0.01});
  camera.operating.uniform_albedo = true;
  const InterferencePoint point = report_of("sinusoid-k4", camera, 2000).points.front();
  EXPECT_TRUE(std::isinf(point.expected_rmse_m));
  EXPECT_TRUE(std::isfinite(point.circular_rmse_m.value));
}

TEST(Interference, LeavesTheErrorAloneUnchanged) {
  const Camera camera = lit_camera({.signal_ratio = 0.05});
  Camera alone = camera;
  alone.operating.interference.reset();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const EvaluateOptions options{.trials = 1000, .bounds = false};
  EXPECT_EQ(evaluate(code, camera, options).circular.geometric_mean_m.value,
            evaluate(code, alone, options).circular.geometric_mean_m.value);
  EXPECT_THROW(interference_error(code, alone, options), InvalidArgument);
}

TEST(Interference, StrongLightMakesDepthsWrongAndInconsistent) {
  const InterferenceReport weak = report_of("hamiltonian-k5", lit_camera({.signal_ratio = 1e-5}));
  EXPECT_LT(weak.shares.wrong, 0.01);
  const InterferenceReport strong = report_of("hamiltonian-k5", lit_camera({.signal_ratio = 0.3}));
  EXPECT_GT(strong.shares.wrong, 0.5);
  EXPECT_GT(*strong.shares.detected(), 0.5);
}

TEST(Interference, RejectsWrongKeys) {
  const auto rejected = [](const OperatingInterference& others) {
    try {
      lit_camera(others).validate();
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(rejected({.cameras = 0}), HasSubstr("operating.interference.cameras = 0; must be"));
  EXPECT_THAT(rejected({.signal_ratio = 0.0}), HasSubstr("operating.interference.signal_ratio"));
  EXPECT_THAT(rejected({.code = "nonsense"}),
              HasSubstr("operating.interference.code = nonsense; must be \"same\""));
  EXPECT_THAT(rejected({.frequency_offset_hz = -1e8}),
              HasSubstr("operating.interference.frequency_offset_hz = -1e+08; must be >="));
  EXPECT_THAT(rejected({.spreading = Spreading::signs, .parts = 0}),
              HasSubstr("operating.interference.parts = 0"));
  Camera rows = lit_camera({.code = "multifrequency-k5"});
  rows.sensor.readout = Readout::rows;
  EXPECT_THROW(report_of("fourier-k8", rows, 2), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith
