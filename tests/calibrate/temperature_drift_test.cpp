// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    return calibrate_temperature(capture(), temperature_c, build_family("sinusoid-k4", camera),
                                 camera);
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
  camera.temperature = Temperature{.now_c = NAN};
  EXPECT_THAT([&] { camera.validate(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("temperature.now_c")));
}

TEST(TemperatureDrift, ReportsNonlinearDrift) {
  EXPECT_THAT(Warming{}.calibrate().notes, IsEmpty());
  EXPECT_THAT(Warming{.offset_m_per_c2 = 5e-4}.calibrate().notes,
              Contains(HasSubstr("offset bends")));
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
        calibrate_temperature(dark, bench.temperature_c(), build_family("sinusoid-k4", camera),
                              camera);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("status ok")));
}

}  // namespace
}  // namespace tofsmith
