// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

Camera phase_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.fundamental_frequency_hz = 60e6;
  camera.exposure_s.total_s = 1e-3;
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  camera.sensor.drain = false;
  return camera;
}

/// A static scene seen by a camera that warms up.
struct Warming {
  double offset_m_per_c = 0.8e-3, signal_per_c = -4e-3, offset_m_per_c2 = 0.0;
  int frames = 10, size = 6;
  double step_c = 3.0;
  std::uint64_t seed = 1;

  std::vector<double> temperature_c() const {
    std::vector<double> all;
    for (int f = 0; f < frames; ++f) all.push_back(20.0 + step_c * f);
    return all;
  }
  RawFrames capture() const {
    RandomStream random(seed, 7, 0);
    RawFrames raw{.frames = frames, .height = size, .width = size, .measurements = 4};
    const double range_m = phase_camera().range_m();
    for (const double t : temperature_c()) {
      const double warmer = t - 20.0;
      const double off_m = offset_m_per_c * warmer + offset_m_per_c2 * warmer * warmer;
      for (int i = 0; i < size * size; ++i) {
        const double depth_m = range_m * i / (size * size) + off_m;
        const double amplitude = 2e5 * (1.0 + 0.02 * i) * std::exp(signal_per_c * warmer);
        for (int k = 0; k < 4; ++k)
          raw.values.push_back(static_cast<float>(
              amplitude * std::cos(2 * std::numbers::pi * (depth_m / range_m - k / 4.0)) +
              std::sqrt(amplitude) * random.normal()));
      }
    }
    return raw;
  }
  TemperatureDrift calibrate() const { return calibrate(temperature_c()); }
  TemperatureDrift calibrate(const std::vector<double>& temperature_c) const {
    const Camera camera = phase_camera();
    return calibrate_temperature(capture(), {.of_camera_c = temperature_c, .of_sensor_c = {}},
                                 build_family("sinusoid-k4", camera), camera);
  }
};

TEST(TemperatureDrift, IntervalsContainTheTruthIn200Cameras) {
  int offsets = 0, signals = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RandomStream random(seed, 8, 0);
    const Warming bench{.offset_m_per_c = 2e-3 * (random.uniform() - 0.5),
                        .signal_per_c = 1e-2 * (random.uniform() - 0.5),
                        .frames = 5 + static_cast<int>(seed % 8),
                        .seed = seed};
    const TemperatureDrift found = bench.calibrate();
    const auto holds = [&](const Estimate& e, double truth) {
      return std::abs(e.value - truth) <= found.interval_factor * e.standard_error;
    };
    offsets += holds(found.offset_m_per_c, bench.offset_m_per_c);
    signals += holds(found.signal_per_c, bench.signal_per_c);
  }
  EXPECT_GE(offsets, 186);
  EXPECT_GE(signals, 186);
  RecordProperty("offsets", offsets);
  RecordProperty("signals", signals);
}

TEST(TemperatureDrift, ReportsTemperaturesInKelvin) {
  std::vector<double> kelvin = Warming{}.temperature_c();
  EXPECT_THAT(Warming{}.calibrate(kelvin).notes, Not(Contains(HasSubstr("kelvin"))));
  for (double& t : kelvin) t += 273.15;
  EXPECT_THAT(Warming{}.calibrate(kelvin).notes, Contains(HasSubstr("kelvin")));
}

TEST(TemperatureDrift, ACalibratedCameraMeasuresDepthAsAtTheReference) {
  const Warming bench{.offset_m_per_c = 2e-3, .signal_per_c = -5e-3};
  const CodeSet code = build_family("sinusoid-k4", phase_camera());
  Camera camera = with_temperature(phase_camera(), bench.calibrate(), 20.0);
  const RawFrames raw = bench.capture();
  const int last = raw.frames - 1;
  const auto decoded = [&](const DecodingTable& table) { return Decoder(table).decode(raw, last); };
  const auto of_code = [&] { return make_decoding_table(ForwardModel(code, camera), camera); };
  const DepthImage cold = decoded(of_code());
  camera.temperature->now_c = bench.temperature_c().back();
  const DepthImage warm = decoded(of_code());
  // A table measured at the reference temperature gives the same.
  camera.temperature->now_c.reset();
  MeasuredTable measured;
  measured.correlation = of_code().correlation;
  measured.differences = true;
  camera.temperature->now_c = bench.temperature_c().back();
  const DepthImage by_table = decoded(make_decoding_table(measured, camera));
  const double drift_m = 2e-3 * 27.0, gain = std::exp(-5e-3 * 27.0);
  for (std::size_t i = 0; i < cold.depth_m.pixels.size(); ++i) {
    const auto at = [i](const Image<float>& image) { return static_cast<double>(image.pixels[i]); };
    const auto apart_m = [&](const DepthImage& a, const DepthImage& b) {
      return std::remainder(at(a.depth_m) - at(b.depth_m), camera.range_m());
    };
    EXPECT_NEAR(apart_m(cold, warm), drift_m, 0.05 * drift_m) << i;
    EXPECT_NEAR(at(cold.signal_e_per_s) / at(warm.signal_e_per_s), gain, 0.02) << i;
    EXPECT_NEAR(apart_m(by_table, warm), 0.0, 1e-4) << i;
    EXPECT_NEAR(at(by_table.signal_e_per_s) / at(warm.signal_e_per_s), 1.0, 1e-3) << i;
  }
}

TEST(TemperatureDrift, RejectsImplausibleFactors) {
  Camera camera = phase_camera();
  camera.temperature = Temperature{.signal_per_c = 1.0, .now_c = 60.0};
  EXPECT_THAT([&] { camera.validate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("temperature.signal_per_c")));
  camera.temperature = Temperature{.sensor = SensorTemperature{.signal_per_c = 1.0, .now_c = 60.0}};
  EXPECT_THAT([&] { camera.validate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("temperature.sensor.signal_per_c")));
  camera.temperature = Temperature{.now_c = NAN};
  EXPECT_THAT([&] { camera.validate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("temperature.now_c")));
}

TEST(TemperatureDrift, ReportsNonlinearDrift) {
  EXPECT_THAT(Warming{}.calibrate().notes, IsEmpty());
  EXPECT_THAT(Warming{.offset_m_per_c2 = 5e-4}.calibrate().notes,
              Contains(HasSubstr("offset is not linear")));
}

TEST(TemperatureDrift, ReportsAlmostConstantTemperatures) {
  EXPECT_THAT(Warming{.step_c = 0.1}.calibrate().notes, Contains(HasSubstr("degrees only")));
}

TEST(TemperatureDrift, RejectsTemperaturesThatDoNotFit) {
  const Warming bench;
  const auto refuses = [&](const std::vector<double>& temperature_c, const char* why) {
    EXPECT_THAT([&] { bench.calibrate(temperature_c); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refuses({20.0, 21.0}, "one for each of the 10 frames");
  refuses(std::vector<double>(10, 25.0), "must not all be the same");
  std::vector<double> unknown = bench.temperature_c();
  unknown[3] = NAN;
  refuses(unknown, "must be finite");
  EXPECT_THAT([] { Warming{.frames = 4}.calibrate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("at least 5")));
}

TEST(TemperatureDrift, RejectsFramesWithoutLight) {
  const Warming bench;
  RawFrames dark = bench.capture();
  std::ranges::fill(dark.values, NAN);
  const Camera camera = phase_camera();
  EXPECT_THAT(
      [&] {
        calibrate_temperature(dark, {.of_camera_c = bench.temperature_c(), .of_sensor_c = {}},
                              build_family("sinusoid-k4", camera), camera);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("status ok")));
}

/// A still scene seen by a camera whose light source and sensor have separate temperatures.
struct TwoTemperatures {
  double light_m_per_c = 1.2e-3, sensor_m_per_c = -0.5e-3;
  double light_signal_per_c = -4e-3, sensor_signal_per_c = 1e-3;
  double hysteresis_m = 0.0;  ///< farther while the light source warms up than while it cools
  double lag = 0.5;           ///< of the sensor behind the light source; 0: they change together
  int frames = 16;
  std::uint64_t seed = 1;

  /// 1 while the light source warms up, -1 while it cools, 0 at the turn.
  double direction(int frame) const {
    return 2 * frame == frames ? 0.0 : 2 * frame < frames ? 1.0 : -1.0;
  }
  /// Up and down again between 20 and 50 degrees; the sensor follows.
  FrameTemperatures temperatures() const {
    FrameTemperatures all;
    double sensor_c = 20.0;
    for (int f = 0; f < frames; ++f) {
      const double part = 2.0 * f / frames;
      const double light_c = 20.0 + 30.0 * (part < 1.0 ? part : 2.0 - part);
      sensor_c += (1.0 - lag) * (light_c - sensor_c);
      all.of_camera_c.push_back(light_c);
      all.of_sensor_c.push_back(sensor_c);
    }
    return all;
  }
  RawFrames capture() const {
    RandomStream random(seed, 9, 0);
    const FrameTemperatures all = temperatures();
    const double range_m = phase_camera().range_m();
    RawFrames raw{.frames = frames, .height = 6, .width = 6, .measurements = 4};
    for (int f = 0; f < frames; ++f) {
      const double light_c = all.of_camera_c[static_cast<std::size_t>(f)] - 20.0,
                   sensor_c = all.of_sensor_c[static_cast<std::size_t>(f)] - 20.0;
      const double off_m =
          light_m_per_c * light_c + sensor_m_per_c * sensor_c + 0.5 * direction(f) * hysteresis_m;
      const double gain = std::exp(light_signal_per_c * light_c + sensor_signal_per_c * sensor_c);
      for (int i = 0; i < 36; ++i)
        for (int k = 0; k < 4; ++k)
          raw.values.push_back(static_cast<float>(
              2e5 * gain * std::cos(2 * std::numbers::pi * (i / 36.0 + off_m / range_m - k / 4.0)) +
              450.0 * random.normal()));
    }
    return raw;
  }
  TemperatureDrift calibrate(const FrameTemperatures& all) const {
    const Camera camera = phase_camera();
    return calibrate_temperature(capture(), all, build_family("sinusoid-k4", camera), camera);
  }
  TemperatureDrift calibrate() const { return calibrate(temperatures()); }
};

TEST(TwoTemperatures, IntervalsContainBothDriftsIn500Cameras) {
  std::array<int, 4> contained{};
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    RandomStream random(seed, 10, 0);
    const TwoTemperatures bench{.light_m_per_c = 2e-3 * (random.uniform() - 0.5),
                                .sensor_m_per_c = 2e-3 * (random.uniform() - 0.5),
                                .light_signal_per_c = 1e-2 * (random.uniform() - 0.5),
                                .sensor_signal_per_c = 1e-2 * (random.uniform() - 0.5),
                                .frames = 6 + static_cast<int>(seed % 8),
                                .seed = seed};
    const TemperatureDrift found = bench.calibrate();
    ASSERT_TRUE(found.sensor) << seed;
    const auto contains = [&](const Estimate& e, double truth) {
      return std::abs(e.value - truth) <= found.interval_factor * e.standard_error;
    };
    contained[0] += contains(found.offset_m_per_c, bench.light_m_per_c);
    contained[1] += contains(found.sensor->offset_m_per_c, bench.sensor_m_per_c);
    contained[2] += contains(found.signal_per_c, bench.light_signal_per_c);
    contained[3] += contains(found.sensor->signal_per_c, bench.sensor_signal_per_c);
  }
  EXPECT_THAT(contained, testing::Each(testing::Ge(460)));
  RecordProperty("least", *std::ranges::min_element(contained));
}

TEST(TwoTemperatures, ACameraWithBothMeasuresDepthAndSignalAsAtTheReferences) {
  const TwoTemperatures bench;
  const FrameTemperatures all = bench.temperatures();
  const CodeSet code = build_family("sinusoid-k4", phase_camera());
  Camera camera = with_temperature(phase_camera(), bench.calibrate(), 20.0, 20.0);
  const RawFrames raw = bench.capture();
  const auto of_code = [&] { return make_decoding_table(ForwardModel(code, camera), camera); };
  MeasuredTable at_references;
  at_references.correlation = of_code().correlation;
  at_references.differences = true;
  const auto mean_error_m = [&](const DepthImage& image) {
    double sum = 0.0;
    for (int i = 0; i < 36; ++i)
      sum += std::remainder(static_cast<double>(image.depth_m.pixels[static_cast<std::size_t>(i)]) -
                                camera.range_m() * i / 36.0,
                            camera.range_m());
    return sum / 36.0;
  };
  for (const int frame : {4, 8, 12}) {
    const auto f = static_cast<std::size_t>(frame);
    camera.temperature->now_c.reset();
    camera.temperature->sensor->now_c.reset();
    const DepthImage uncorrected = Decoder(of_code()).decode(raw, frame);
    camera.temperature->now_c = all.of_camera_c[f];
    camera.temperature->sensor->now_c = all.of_sensor_c[f];
    const DepthImage corrected = Decoder(of_code()).decode(raw, frame);
    const DepthImage by_table =
        Decoder(make_decoding_table(at_references, camera)).decode(raw, frame);
    EXPECT_GT(std::abs(mean_error_m(uncorrected)), 5e-3) << frame;
    EXPECT_NEAR(mean_error_m(corrected), 0.0, 1e-3) << frame;
    const double gain = std::exp(bench.light_signal_per_c * (all.of_camera_c[f] - 20.0) +
                                 bench.sensor_signal_per_c * (all.of_sensor_c[f] - 20.0));
    for (std::size_t i = 0; i < 36; ++i) {
      const auto at = [i](const Image<float>& image) { return double{image.pixels[i]}; };
      const double apart_m =
          std::remainder(at(by_table.depth_m) - at(corrected.depth_m), camera.range_m());
      EXPECT_NEAR(apart_m, 0.0, 1e-4) << i;
      EXPECT_NEAR(at(by_table.signal_e_per_s) / at(corrected.signal_e_per_s), 1.0, 1e-3) << i;
      EXPECT_NEAR(at(uncorrected.signal_e_per_s) / at(corrected.signal_e_per_s), gain, 0.02) << i;
    }
  }
}

TEST(TwoTemperatures, ThatChangeTogetherAreReportedAndTheLightSourceIsKept) {
  const TemperatureDrift found = TwoTemperatures{.lag = 0.0}.calibrate();
  EXPECT_FALSE(found.sensor);
  EXPECT_FALSE(with_temperature(phase_camera(), found, 20.0).temperature->sensor);
  EXPECT_NEAR(found.offset_m_per_c.value, 0.7e-3, 0.05e-3);
  EXPECT_THAT(found.notes, Contains(HasSubstr("condition number")));
  EXPECT_THAT(TwoTemperatures{}.calibrate().notes, Not(Contains(HasSubstr("condition number"))));
}

TEST(TwoTemperatures, HysteresisIsReportedWithItsSize) {
  const TemperatureDrift found = TwoTemperatures{.hysteresis_m = 4e-3}.calibrate();
  ASSERT_TRUE(found.hysteresis_m);
  EXPECT_NEAR(found.hysteresis_m->value, 4e-3, 1e-3);
  EXPECT_THAT(found.notes, Contains(HasSubstr("hysteresis")));
  const TemperatureDrift without = TwoTemperatures{}.calibrate();
  ASSERT_TRUE(without.hysteresis_m);
  EXPECT_THAT(without.notes, Not(Contains(HasSubstr("hysteresis"))));
  EXPECT_FALSE(Warming{}.calibrate().hysteresis_m) << "the temperature only rises";
  // A sensor that lags is hysteresis to the temperature of the light source alone.
  FrameTemperatures light = TwoTemperatures{}.temperatures();
  light.of_sensor_c.clear();
  EXPECT_THAT(TwoTemperatures{.sensor_m_per_c = -2e-3}.calibrate(light).notes,
              Contains(HasSubstr("hysteresis")));
}

TEST(TwoTemperatures, RejectsTemperaturesOfTheSensorThatDoNotFit) {
  const TwoTemperatures bench;
  const auto rejects = [&](const auto& change, const char* why) {
    FrameTemperatures all = bench.temperatures();
    change(all.of_sensor_c);
    EXPECT_THAT([&] { bench.calibrate(all); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  rejects([](std::vector<double>& c) { c.pop_back(); }, "sensor_temperatures = 15");
  rejects([](std::vector<double>& c) { std::ranges::fill(c, 30.0); }, "must not all be the same");
  EXPECT_THAT([] { TwoTemperatures{.frames = 5}.calibrate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("at least 6")));
  EXPECT_THAT([] { with_temperature(phase_camera(), Warming{}.calibrate(), 20.0, 30.0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("sensor_reference_c")));
}

}  // namespace
}  // namespace tofsmith
