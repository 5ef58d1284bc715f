// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/correlation_calibration.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/shared/random.hpp"
#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double scale = 1000.0, level = 300.0;  // raw values

struct Bench {
  int side = 8;           // pixels in each direction
  int steps = 30;         // per period
  int frames = 31;        // the last frame repeats the first
  double noise = 3.0;     // raw values
  double drift = 0.0;     // relative change of light from the first to the last frame
  double mismatch = 0.0;  // of two taps
  double first = 0.0;     // delay of the first frame [steps]
  std::uint64_t seed = 1;
};

Camera camera_of(const Bench& bench, int taps = 1) {
  Camera camera = built_in_camera("paper-5f0");
  camera.sensor.taps = taps;
  camera.sensor.drain = taps == 1;
  camera.sensor.tap_mismatch = bench.mismatch;
  return camera;
}

double delay_of(int p) { return 0.004 * std::sin(1.7 * p); }  // periods
double gain_of(int p) { return 1.0 + 0.2 * std::cos(2.3 * p); }

/// Pixels have individual delays and gains, whose means are 0 and 1.
DelaySweep sweep_of(const Bench& bench, const ForwardModel& model) {
  DelaySweep sweep;
  const int pixels = bench.side * bench.side, columns = model.measurements();
  double mean_delay = 0.0, mean_gain = 0.0;
  for (int p = 0; p < pixels; ++p) {
    mean_delay += delay_of(p) / pixels;
    mean_gain += gain_of(p) / pixels;
  }
  sweep.frames = {
      .frames = bench.frames, .height = bench.side, .width = bench.side, .measurements = columns};
  for (int f = 0; f < bench.frames; ++f) {
    const double place = (f + bench.first) / bench.steps;
    sweep.delay_periods.push_back(place);
    const double light = 1.0 + bench.drift * (static_cast<double>(f) / (bench.frames - 1) - 0.5);
    for (int p = 0; p < pixels; ++p) {
      RandomStream random(bench.seed, static_cast<std::uint64_t>(p), static_cast<unsigned>(f));
      const bool one = pixels == 1;
      const double u = place + (one ? 0.0 : delay_of(p) - mean_delay);
      const double gain = one ? 1.0 : gain_of(p) / mean_gain;
      const Eigen::VectorXd chi = model.correlation((u - std::floor(u)) * model.samples());
      for (int k = 0; k < columns; ++k)
        sweep.frames.values.push_back(static_cast<float>(level + scale * light * gain * chi[k] +
                                                         bench.noise * random.normal()));
    }
  }
  return sweep;
}

/// A calibrated table of a code, and the model that it should equal.
struct Calibrated {
  Camera camera;
  ForwardModel model;
  CalibratedCorrelation found;

  explicit Calibrated(const Bench& bench, const std::string& code = "hamiltonian-k3", int taps = 1)
      : camera(camera_of(bench, taps)),
        model(build_family(code, camera), camera),
        found(calibrate_correlation(sweep_of(bench, model),
                                    {.taps = taps, .range_m = camera.range_m()})) {}
};

/// Largest and mean square deviation from the truth in standard errors. Drifting light is known at
/// the middle of the sweep.
std::pair<double, double> distance(const CalibratedCorrelation& found, const ForwardModel& model) {
  const Eigen::MatrixXd truth =
      (scale * model.correlation_table(found.table.samples())).array() + level;
  const Eigen::ArrayXXd off =
      (found.table.correlation - truth).array() / found.standard_error.array();
  return {off.abs().maxCoeff(), off.square().mean()};
}

TEST(CorrelationCalibration, RecoversTheTableWithinFourStandardErrorsAtEverySample) {
  double mean_square = 0.0;
  constexpr int seeds = 6;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Bench bench{.seed = seed};
    const auto& [camera, model, found] = Calibrated(bench);
    EXPECT_EQ(found.table.samples(), bench.steps);
    EXPECT_EQ(found.noise_source, "pixels");
    EXPECT_NEAR(found.noise_rms, bench.noise, 0.1);
    const auto [largest, square] = distance(found, model);
    EXPECT_LT(largest, 4.0);
    mean_square += square / seeds;
    RunningStatistics offset, gain;
    for (int p = 0; p < bench.side * bench.side; ++p) {
      const auto i = static_cast<std::size_t>(p);
      offset.add(found.maps.delay_offset_m.pixels[i] / camera.range_m() - delay_of(p));
      gain.add(found.maps.gain.pixels[i] - gain_of(p));
    }
    const double offset_error = found.delay_error_m / camera.range_m();
    EXPECT_NEAR(std::sqrt(offset.variance()), offset_error, 0.35 * offset_error);
    EXPECT_LT(std::sqrt(gain.variance()), 3 * found.gain_error + 1e-3);
  }
  EXPECT_GT(mean_square, 0.6);
  EXPECT_LT(mean_square, 1.5);
}

TEST(CorrelationCalibration, DecodersTolerateTheErrorsOfItsTable) {
  const Bench bench{.side = 4};
  const Camera camera = camera_of(bench);
  const ForwardModel model(build_family("sinusoid-k4", camera), camera);
  const DelaySweep sweep = sweep_of(bench, model);
  CorrelationCalibrationOptions options{.range_m = camera.range_m(), .black_level = level};
  const CalibratedCorrelation found = calibrate_correlation(sweep, options);
  // With unequal exposures the values are equally certain, but ambient light explains less of them.
  options.exposure_s = Eigen::Vector4d(1.0, 1.0, 20.0, 20.0);
  const double of_unequal = calibrate_correlation(sweep, options).table.model_error_percent;
  EXPECT_LT(of_unequal, found.table.model_error_percent);
  EXPECT_GT(of_unequal, 0.25 * found.table.model_error_percent);
  constexpr int pixels = 3000;
  RawFrames bright{.frames = 1, .height = 1, .width = pixels, .measurements = 4};
  RandomStream random(5, 0, 0);
  for (int p = 0; p < pixels; ++p) {
    const Eigen::VectorXd chi = model.correlation(random.uniform() * model.samples());
    for (int k = 0; k < 4; ++k) {
      const double electrons = 1e8 * chi[k];
      bright.values.push_back(
          static_cast<float>(level + electrons + std::sqrt(electrons) * random.normal()));
    }
  }
  const auto inconsistent = [&](const MeasuredTable& table) {
    const DepthImage image = Decoder(make_decoding_table(table, camera)).decode(bright);
    return std::ranges::count(image.status.pixels, PixelStatus::inconsistent);
  };
  MeasuredTable strict = found.table;
  strict.model_error_percent = 0.0;
  EXPECT_GT(inconsistent(strict), pixels / 10);
  EXPECT_LT(inconsistent(found.table), pixels / 100);
  EXPECT_LT(found.table.model_error_percent, 1.0);
}

TEST(CorrelationCalibration, OfAMixerFindsItsSignedTable) {
  Camera camera = camera_of({});
  camera.sensor.demodulation = Demodulation::weight;
  camera.sensor.adc_bits = 12;
  camera.sensor.gain_e_per_dn = 1.0;
  camera.sensor.black_level_dn = level;
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  const DelaySweep sweep = sweep_of({}, model);
  const CorrelationCalibrationOptions options = sweep_options(camera, sweep);
  EXPECT_TRUE(options.differences);
  EXPECT_EQ(options.black_level, level);
  EXPECT_FALSE(options.saturation_level);
  const CalibratedCorrelation found = calibrate_correlation(sweep, options);
  EXPECT_TRUE(found.table.differences);
  EXPECT_LT(found.table.correlation.minCoeff(), 0.0);
  EXPECT_GT(found.table.correlation.maxCoeff(), 0.0);
  const Eigen::ArrayXXd off =
      found.table.correlation - scale * model.correlation_table(found.table.samples());
  EXPECT_LT((off / found.standard_error.array()).abs().maxCoeff(), 4.0);
  const Decoder decoder(make_decoding_table(found.table, camera));
  for (int bin = 0; bin < model.samples(); bin += 7) {
    const Eigen::VectorXf raw =
        ((scale * model.correlation(bin)).array() + level).cast<float>().matrix();
    double found_bin = 0.0;
    decoder.decode_depth_bins(raw.data(), 1, &found_bin);
    const double apart =
        std::remainder(found_bin / found.table.samples() - bin / double(model.samples()), 1.0);
    EXPECT_LT(std::abs(apart), 0.01) << bin;
  }
}

TEST(CorrelationCalibration, RemovesDriftFoundByRepeatedDelays) {
  const CalibratedCorrelation found =
      Calibrated({.frames = 60, .drift = 0.05}, "hamiltonian-k4").found;
  EXPECT_TRUE(found.drift_corrected);
  EXPECT_NEAR(found.light_drift.value, 0.05, 4 * found.light_drift.standard_error + 0.002);
  EXPECT_THAT(found.notes, Contains(HasSubstr("light changed by +5")));
  // Without repeated delays the drift is unknown.
  const CalibratedCorrelation blind = Calibrated({.frames = 30}, "hamiltonian-k4").found;
  EXPECT_FALSE(blind.drift_known);
  EXPECT_THAT(blind.notes, Contains(HasSubstr("measure the first delay again")));
}

TEST(CorrelationCalibration, ExcludesDeadPixels) {
  const Bench bench;
  const Camera camera = camera_of(bench);
  const ForwardModel model(build_family("hamiltonian-k3", camera), camera);
  DelaySweep sweep = sweep_of(bench, model);
  const int columns = 3, pixels = bench.side * bench.side;
  RandomStream random(9, 9);
  for (int f = 0; f < bench.frames; ++f)
    for (int k = 0; k < columns; ++k) {
      float* frame = sweep.frames.frame(f);
      frame[0 * columns + k] = 17.0f;                                         // constant
      frame[5 * columns + k] = 300.0f + static_cast<float>(random.normal());  // almost no response
      if (f == 3) frame[7 * columns + k] = NAN;
      if (f == 4) frame[9 * columns + k] = 5000.0f;  // saturated
    }
  const CalibratedCorrelation found =
      calibrate_correlation(sweep, {.range_m = camera.range_m(), .saturation_level = 4095.0f});
  EXPECT_EQ(found.dead.constant, 1);
  EXPECT_EQ(found.dead.low, 1);
  EXPECT_EQ(found.dead.not_a_number, 1);
  EXPECT_EQ(found.dead.saturated, 1);
  for (const std::size_t p : {0u, 5u, 7u, 9u}) {
    EXPECT_TRUE(std::isnan(found.maps.delay_offset_m.pixels[p])) << p;
    EXPECT_TRUE(std::isnan(found.maps.gain.pixels[p])) << p;
  }
  EXPECT_NO_THROW(found.maps.validate(bench.side, bench.side));
  EXPECT_EQ(std::ranges::count_if(found.maps.gain.pixels, [](float g) { return g > 0.0f; }),
            pixels - 4);
}

TEST(CorrelationCalibration, FindsTheImbalanceOfTaps) {
  const Calibrated calibrated({.mismatch = 0.03}, "sinusoid-k4", 2);
  const CalibratedCorrelation& found = calibrated.found;
  ASSERT_EQ(found.tap_mismatch.size(), 4u);
  for (const Estimate& m : found.tap_mismatch) EXPECT_NEAR(m.value, 0.03, 4 * m.standard_error);
  EXPECT_LT(distance(found, calibrated.model).first, 4.5);
}

TEST(CorrelationCalibration, AcceptsAnyStartOfTheSweepAndTablesOfMeans) {
  const Calibrated repeated(Bench{.side = 1, .frames = 90, .noise = 0.2, .first = 0.37});
  EXPECT_EQ(repeated.found.noise_source, "repeats");
  EXPECT_TRUE(repeated.found.maps.empty());
  EXPECT_LT(distance(repeated.found, repeated.model).first, 5.0);
  const Calibrated once(Bench{.side = 1, .steps = 60, .frames = 60, .noise = 0.2});
  EXPECT_EQ(once.found.noise_source, "high harmonics");
  EXPECT_NEAR(once.found.noise_rms, 0.2, 0.08);
}

TEST(CorrelationCalibration, RejectsLessThanAPeriod) {
  const auto refuses = [&](int frames, const char* why) {
    EXPECT_THAT([&] { Calibrated(Bench{.side = 2, .frames = frames}); },
                testing::ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses(20, "from 0.6667 to 0.9667 periods are missing, 10 more steps");
  refuses(5, "at least 8 different");
  EXPECT_NO_THROW(Calibrated(Bench{.side = 2, .frames = 30}));
}

TEST(IdealCodeFit, FindsCodeDelayAndResponse) {
  const Bench bench{.first = 0.0};
  const Camera camera = camera_of(bench);  // hann on both arms, 5 f0
  for (const char* name : {"hamiltonian-k4", "sinusoid-k4", "square-k4"}) {
    const CodeSet code = build_family(name, camera).rotated(-48);  // arrives 0.2 periods later
    const ForwardModel model(code, camera);
    const CalibratedCorrelation found =
        calibrate_correlation(sweep_of(bench, model), {.range_m = camera.range_m()});
    const auto fits = fit_ideal_codes(found.table.correlation, found.standard_error, camera,
                                      ideal_codes(camera, 4));
    const IdealCodeFit& best = fits.front();
    if (std::string(name) == "hamiltonian-k4") {
      EXPECT_EQ(best.code, name);
      EXPECT_NEAR(best.delay_periods, 0.2, 2e-3);
      EXPECT_FALSE(best.reversed || best.inverted);
      EXPECT_EQ(best.response.kind, ImpulseResponse::Kind::hann);
      EXPECT_NEAR(best.parameter_hz.value, 75e6, 4 * best.parameter_hz.standard_error + 1e6);
      EXPECT_LT(best.residual, 0.01);
      EXPECT_GT(best.ideal_residual, 2 * best.residual);
      const Camera fitted = with_fit(built_in_camera("paper-30x"), best);
      EXPECT_EQ(fitted.sensor.impulse_response, best.response);
    } else {  // any response passes a sinusoid, and may turn a square wave into one
      EXPECT_LT(best.residual, 0.01) << best.code;
    }
    EXPECT_THROW(fit_ideal_codes(found.table.correlation, found.standard_error, camera,
                                 ideal_codes(camera, 3)),
                 std::invalid_argument);
  }
}

class SweepFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name) << text;
    return directory_ / name;
  }
  std::string rows(int count, const std::string& header) const {
    std::string text = header;
    for (int i = 0; i < count; ++i)
      text += std::to_string(5 * i) + ".0," + std::to_string(i % 3) + ".5,1.25\n";
    return text;
  }
  /// A camera whose period is 20 steps of rows() in ns.
  static Camera of_100_ns() { return {.fundamental_frequency_hz = 10e6}; }
  TemporaryDirectory directory_;
};

TEST_F(SweepFile, TextHasDelaysInTheUnitOfItsHeader) {
  const DelaySweep sweep =
      read_delay_sweep(write("s.csv", rows(21, "delay_ns,a,b\n")), of_100_ns());
  EXPECT_EQ(sweep.frames.frames, 21);
  EXPECT_EQ(sweep.frames.measurements, 2);
  EXPECT_NEAR(sweep.delay_periods[1], 0.05, 1e-12);
  EXPECT_NEAR(sweep.delay_periods[20], 1.0, 1e-12);
  const DelaySweep in_metres = read_delay_sweep(write("s.csv", rows(21, "")),
                                                {.fundamental_frequency_hz = 299792458.0 / 200},
                                                {.unit = DelayUnit::metre});  // the range is 100 m
  EXPECT_NEAR(in_metres.delay_periods[1], 0.05, 1e-12);
}

TEST_F(SweepFile, DelaysHaveAnyUnitOfTime) {
  for (const auto& [unit, unit_s] :
       {std::pair(DelayUnit::second, 1.0), std::pair(DelayUnit::millisecond, 1e-3),
        std::pair(DelayUnit::microsecond, 1e-6), std::pair(DelayUnit::nanosecond, 1e-9),
        std::pair(DelayUnit::picosecond, 1e-12)}) {
    const DelaySweep sweep = read_delay_sweep(
        write("s.csv", rows(21, "")), {.fundamental_frequency_hz = 0.01 / unit_s}, {.unit = unit});
    EXPECT_NEAR(sweep.delay_periods[1], 0.05, 1e-12) << name_of(unit);
  }
}

TEST_F(SweepFile, IsIndependentOfTheDialect) {
  const Camera camera = of_100_ns();
  const DelaySweep expected = read_delay_sweep(write("s.csv", rows(21, "delay_ns,a,b\n")), camera);
  std::string commas = "\xef\xbb\xbfn;delay;a;b\n;ns;DN;DN\n", beside;
  for (int i = 0; i < 21; ++i) {
    commas += fmt::format("{};{},0;{},5;1,25;\r\n", i, 5 * i, i % 3);
    beside += fmt::format("{},,{}.0e-9,{}.5,1.25\n", i == 0 ? "Model,A" : ",", 5 * i, i % 3);
  }
  for (const auto& [name, text] : {std::pair("S.CSV", commas), std::pair("s.tsv", beside)}) {
    const DelaySweep sweep = read_delay_sweep(write(name, text), camera);
    EXPECT_EQ(sweep.frames.values, expected.frames.values) << text;
    for (std::size_t i = 0; i < 21; ++i)
      EXPECT_NEAR(sweep.delay_periods[i], expected.delay_periods[i], 1e-12) << text;
  }
}

TEST_F(SweepFile, ReportsTheMissingPartOfThePeriod) {
  EXPECT_THAT(
      io_error_of(
          [&] { read_delay_sweep(write("s.csv", rows(12, "delay_ns,a,b\n")), of_100_ns()); }),
      HasSubstr("s.csv: delays = 0.55 periods long in steps of 0.05; must cover a whole period "
                "without a gap: delays from 0.6 to 0.95"));
}

TEST_F(SweepFile, AStackHasAListOfShifts) {
  std::vector<float> values(12 * 2 * 2 * 3, 1.0f);
  write_npy(directory_ / "f.npy", NpyArray::of<float>({12, 2, 2, 3}, values),
            OutputPolicy::overwrite);
  std::string shifts;
  for (int i = 0; i < 12; ++i) shifts += std::to_string(20 * i) + "\n";
  const DelaySweepOptions options{.shifts = write("t.txt", shifts), .unit = DelayUnit::bin};
  const DelaySweep sweep = read_delay_sweep(directory_ / "f.npy", {}, options);
  EXPECT_EQ(sweep.frames.height, 2);
  EXPECT_NEAR(sweep.delay_periods[3], 0.25, 1e-12);
  write("t.txt", "1\n2\n");
  EXPECT_THAT(io_error_of([&] { read_delay_sweep(directory_ / "f.npy", {}, options); }),
              HasSubstr("found 2 shifts; expected 12"));
}

TEST_F(SweepFile, AnArrayIsOnePeriodInEqualSteps) {
  std::vector<double> values;
  for (int n = 0; n <= 16; ++n)
    for (int k = 0; k < 3; ++k) values.push_back((n % 16) * (k + 1.0));
  write_npy(directory_ / "t.npy", NpyArray::of<double>({17, 3}, values), OutputPolicy::overwrite);
  const DelaySweep sweep = read_delay_sweep(directory_ / "t.npy", Camera());
  EXPECT_EQ(sweep.frames.frames, 16);  // the repeated end point is removed
  EXPECT_THAT(sweep.notes, Contains(HasSubstr("repeats the first and was dropped")));
  EXPECT_THAT(sweep.notes, Contains(HasSubstr("equal steps of one period")));
}

}  // namespace

}  // namespace tofsmith
