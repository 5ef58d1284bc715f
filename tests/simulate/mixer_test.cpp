// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "captured_moments.hpp"
#include "core/shared/random.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/likelihood_decoder.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

namespace {

// Mixers (weights from -1 to 1), from the forward model to depth errors.

using testing::HasSubstr;

Camera mixer_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.demodulation = Demodulation::weight;
  return camera;
}

CodeSet analog_code(int samples, double mean = 0.0) {
  constexpr int exposures = 4;
  std::vector<Waveform> light;
  Eigen::MatrixXd weights(samples, exposures);
  for (int e = 0; e < exposures; ++e) {
    light.push_back(rectangular_pulse(5.0 / samples));
    for (int n = 0; n < samples; ++n)
      weights(n, e) =
          mean + (1.0 - mean) * std::cos(2 * std::numbers::pi * ((n + 0.5) / samples - e / 4.0));
  }
  return CodeSet::create_signed("analog", std::move(light), weights);
}

SceneImage random_depths(int height, int width, double range_m) {
  SceneImage scene(height, width);
  RandomStream random(4, 0);
  for (float& depth_m : scene.depth_m.pixels)
    depth_m = static_cast<float>(range_m * random.uniform());
  return scene;
}

void expect_depths(const DepthImage& image, const SceneImage& scene, const Camera& camera,
                   double tolerance_m) {
  for (std::size_t i = 0; i < scene.depth_m.size(); ++i)
    ASSERT_LT(std::abs(circular_difference(image.depth_m.pixels[i], scene.depth_m.pixels[i],
                                           camera.range_m())),
              tolerance_m);
}

TEST(Mixer, ABinaryWeightMeasuresLikeTwoBuckets) {
  Camera camera = mixer_camera();
  camera.sensor.modulation_contrast = 0.8;
  camera.sensor.dark_current_e_per_s = 700.0;
  camera.sensor.edge_jitter_s = 2e-10;
  const Camera buckets = in_buckets(camera);
  EXPECT_EQ(buckets.sensor.taps, 2);
  for (const char* name : {"hamiltonian-k4", "square-k4", "gray-k4", "multifrequency-k5"}) {
    SCOPED_TRACE(name);
    const CodeSet code = build_family(name, camera);
    ASSERT_TRUE(code.is_signed());
    const ForwardModel one(code, camera), two(code.buckets_of_signed(), buckets);
    ASSERT_EQ(one.measurements(), two.measurements());
    const std::vector<Return> light{{1e4, 31.7}, {2e3, 80.2}};
    EXPECT_LT((one.expected_electrons(light, 3e3) - two.expected_electrons(light, 3e3)).norm(),
              1e-9);
    if (!code.demodulation(0).is_binary()) continue;  // other weights have less noise, tested below
    EXPECT_LT((one.variance_e2(light, 3e3) - two.variance_e2(light, 3e3)).norm(), 1e-8);
    EXPECT_LT((one.covariance_e2(light, 3e3) - two.covariance_e2(light, 3e3)).norm(), 1e-8);
    const OperatingPoint point{1e4, 3e3};
    EXPECT_NEAR(CramerRaoBound(one, camera).mae_m(point), CramerRaoBound(two, buckets).mae_m(point),
                1e-9);
    EXPECT_NEAR(ReceiverBound(camera, code.exposures()).mae_m(point),
                ReceiverBound(buckets, code.exposures()).mae_m(point), 1e-9);
    const DecodingTable a = make_decoding_table(one, camera), b = make_decoding_table(two, buckets);
    EXPECT_LT((a.correlation - b.correlation).norm(), 1e-9);
    EXPECT_LT((a.shot() - b.shot()).norm(), 1e-9);
    EXPECT_LT((a.constant_variance_e2 - b.constant_variance_e2).norm(), 1e-9);
  }
}

TEST(Mixer, HasTheErrorOfTwoBuckets) {
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian}) {
    Camera camera = mixer_camera();
    camera.sensor.noise = noise;
    camera.sensor.dark_current_e_per_s = 700.0;
    camera.operating.signal_e_per_s = {3e3, 1e5};
    camera.operating.ambient_e_per_s = {1e2, 1e4};
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const EvaluateOptions options{.trials = 20000};
    const Estimate one = evaluate(code, camera, options).circular.geometric_mean_m;
    const Estimate two =
        evaluate(code.buckets_of_signed(), in_buckets(camera), {.trials = 20000, .seed = 2})
            .circular.geometric_mean_m;
    EXPECT_NEAR(one.value, two.value, 4 * std::hypot(one.standard_error, two.standard_error));
  }
}

TEST(Mixer, PhotonInformationIsThatOfAllPhotonNoise) {
  Camera analog = mixer_camera();
  analog.sensor.binary = false;
  Camera taps = built_in_camera("paper-10f0");  // enough taps to resolve arrival times
  taps.sensor.taps = 16;
  for (const double read_noise_e : {0.0, 20.0, 2000.0}) {
    analog.sensor.read_noise_e = taps.sensor.read_noise_e = read_noise_e;
    const ReceiverBound bound(analog, 4), of_taps(taps, 4);
    // If other noise dominates, gates of one tap each gather less.
    for (const OperatingPoint& point : {OperatingPoint{1e5, 1e3}, OperatingPoint{1e3, 1e5}})
      if (read_noise_e < 100.0) {
        EXPECT_NEAR(bound.photon_information(point) / of_taps.photon_information(point), 1.0, 1e-9)
            << read_noise_e;
      }
    // Weights of any size, for the shortest pulse that the responses pass.
    const Eigen::VectorXcd transfer = analog.transfer(120);
    Eigen::VectorXd light, slope;
    sample_with_slope(transfer, light, slope);
    const double time_s = 0.3 / 4, c = read_noise_e * read_noise_e;
    const OperatingPoint point{1e5, 1e3};
    const Eigen::ArrayXd rate = time_s * (1e5 * light.array().max(0.0) + 1e3);
    const Eigen::ArrayXd rate_slope = time_s * 1e5 * slope.array();
    double nearest = 0.0;
    for (std::uint64_t item = 0; item < 40; ++item) {
      RandomStream random(9, item);
      // The best weights are proportional to slope over light; also test weights far from them.
      const double steep = std::pow(10.0, 4.0 * random.uniform() - 3.0), noise = random.uniform();
      Eigen::ArrayXd weight = steep * rate_slope / (rate + c);
      for (double& w : weight) w = std::clamp(w + 0.3 * noise * noise * random.normal(), -1.0, 1.0);
      const double mean = (weight * rate_slope).mean();
      const double found = mean * mean / ((weight.square() * rate).mean() + c);
      EXPECT_LE(4.0 * found, bound.photon_information(point) * (1 + 1e-9)) << read_noise_e;
      nearest = std::max(nearest, 4.0 * found / bound.photon_information(point));
    }
    if (read_noise_e == 0.0) {
      EXPECT_GT(nearest, 0.9);
    }
  }
}

TEST(Mixer, NoiseIsThatOfTheSquareOfItsWeight) {
  Camera camera = mixer_camera();
  camera.light.peak_factor = 60.0;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  for (const double mean : {0.0, 0.4}) {
    const CodeSet code = analog_code(camera.samples, mean);
    const ForwardModel model(code, camera);
    const double S = 2e4, A = 5e3, T = camera.exposure_s.total_s / 4;
    const Eigen::MatrixXd m = code.modulation_samples(), w = code.demodulation_samples();
    for (const int depth : {0, 17, 200}) {
      const Return light{S, static_cast<double>(depth)};
      const Eigen::VectorXd expected = model.expected_electrons({&light, 1}, A);
      const Eigen::VectorXd variance = model.variance_e2({&light, 1}, A);
      for (int e = 0; e < 4; ++e) {
        double sum = 0.0, squares = 0.0;
        for (int n = 0; n < camera.samples; ++n) {
          const double rate = S * m((n - depth + camera.samples) % camera.samples, e) + A;
          sum += T * rate * w(n, e) / camera.samples;
          squares += T * rate * w(n, e) * w(n, e) / camera.samples;
        }
        EXPECT_NEAR(expected[e], sum, 1e-7);
        EXPECT_NEAR(variance[e], squares + 400.0, 1e-7) << "read once";
      }
    }
    EXPECT_NEAR(model.ambient_gain()[0], mean, 1e-12);
  }
}

TEST(Mixer, CapturesHaveTheMeanAndVarianceOfTheModel) {
  Camera camera = mixer_camera();
  camera.light.peak_factor = 60.0;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.dark_current_e_per_s = 100.0;
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian}) {
    camera.sensor.noise = noise;
    // Almost no ambient light, so that the mean weight of all light may be small.
    for (const CodeSet& code :
         {build_family("hamiltonian-k4", camera), analog_code(camera.samples, 0.1)})
      expect_moments_of_the_model(code, camera, {1250.0, 3.0}, 47.0);
  }
}

TEST(Mixer, PoissonElectronsOfAnyWeightHaveTheCorrectMeanAndVariance) {
  Sensor sensor;
  sensor.demodulation = Demodulation::weight;
  sensor.read_noise_e = 0.0;
  const PixelNoise noise(sensor);
  // a = (w^2 + w) / 2, b = (w^2 - w) / 2 for 8 electrons, in some cases with w = 1/4.
  for (const auto& [mean, variance] :
       {std::pair{8.0, 8.0}, {2.0, 8.0}, {-2.0, 0.5}, {3.0, 1.0}, {0.0, 5.0}, {0.0, 0.0}}) {
    RandomStream random(7, 1);
    RunningStatistics drawn;
    for (int i = 0; i < 40000; ++i)
      drawn.add(noise.draw_difference(0.5 * (variance + mean), 0.5 * (variance - mean), random));
    EXPECT_NEAR(drawn.mean(), mean, 4 * drawn.standard_error() + 1e-12);
    EXPECT_NEAR(drawn.variance(), variance, 0.05 * variance);
  }
}

TEST(Mixer, ProjectedTrialsHaveTheErrorsOfTrialsPerMeasurement) {
  Camera camera = mixer_camera();
  camera.light.peak_factor = 60.0;
  camera.sensor.noise = NoiseModel::gaussian;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e3};
  for (const double mean : {0.0, 0.3}) {
    const CodeSet code = analog_code(camera.samples, mean);
    EvaluateOptions options{.trials = 20000};
    const Estimate plane = evaluate(code, camera, options).circular.geometric_mean_m;
    options.draw_every_measurement = true;
    options.seed = 2;
    const Estimate drawn = evaluate(code, camera, options).circular.geometric_mean_m;
    EXPECT_NEAR(plane.value, drawn.value,
                4 * std::hypot(plane.standard_error, drawn.standard_error));
    camera.sensor.noise = NoiseModel::poisson;
    const Estimate counted = evaluate(code, camera, options).circular.geometric_mean_m;
    EXPECT_NEAR(plane.value, counted.value,
                4 * std::hypot(plane.standard_error, counted.standard_error));
    camera.sensor.noise = NoiseModel::gaussian;
  }
}

TEST(Mixer, CapturedDepthsAreDecodedInAnyAmbientLight) {
  Camera camera = mixer_camera();
  camera.light.peak_factor = 60.0;
  camera.exposure_s.total_s = 3000.0;  // almost no noise
  const SceneImage scene = random_depths(20, 30, camera.range_m());
  for (const CodeSet& code :
       {build_family("hamiltonian-k4", camera), build_family("sinusoid-k4", camera),
        build_family("multifrequency-k5", camera), analog_code(camera.samples, 0.3)}) {
    SCOPED_TRACE(code.name());
    const RawFrames raw = capture(scene, code, camera, {.ambient_e_per_s = 1e5, .falloff = false});
    const DecodingTable table = make_decoding_table(ForwardModel(code, camera), camera);
    for (const DepthImage& image :
         {Decoder(table).decode(raw), LikelihoodDecoder(table).decode(raw)})
      expect_depths(image, scene, camera, 0.02);
  }
}

TEST(Mixer, ClipsAndQuantizesBothSigns) {
  Sensor sensor;
  sensor.demodulation = Demodulation::weight;
  sensor.full_well_e = 1000.0;
  EXPECT_EQ(PixelNoise(sensor).convert(-1500.0), -1000.0);
  EXPECT_EQ(PixelNoise(sensor).convert(1500.0), 1000.0);
  sensor.full_well_e.reset();
  sensor.adc_bits = 8;
  sensor.gain_e_per_dn = 10.0;
  EXPECT_EQ(PixelNoise(sensor).convert(-234.0), -23.0);
  EXPECT_EQ(PixelNoise(sensor).convert(-5000.0), -128.0);
  EXPECT_EQ(PixelNoise(sensor).convert(5000.0), 127.0);
  sensor.black_level_dn = 128.0;
  EXPECT_EQ(PixelNoise(sensor).convert(-234.0), 105.0);
  EXPECT_EQ(PixelNoise(sensor).convert(-5000.0), 0.0);

  Camera camera = mixer_camera();
  camera.exposure_s.total_s = 30.0;
  for (const std::optional<double> black_dn : {std::optional<double>(), std::optional(32768.0)}) {
    camera.sensor.adc_bits = 16;
    camera.sensor.gain_e_per_dn = 20.0;
    camera.sensor.black_level_dn = black_dn;
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const SceneImage scene = random_depths(10, 10, camera.range_m());
    const RawFrames raw = capture(scene, code, camera, {.falloff = false});
    const Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
    expect_depths(decoder.decode(raw), scene, camera, 0.3);
    // Trials clip like captures: coarse quantization increases the error.
    camera.operating.signal_e_per_s = {1e5};
    camera.operating.ambient_e_per_s = {1e3};
    const double fine_m = evaluate(code, camera, {.trials = 2000}).circular.geometric_mean_m.value;
    camera.sensor.gain_e_per_dn = 2e4;
    EXPECT_GT(evaluate(code, camera, {.trials = 2000}).circular.geometric_mean_m.value, fine_m);
  }
}

std::string refusal_of(const Camera& camera) {
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Mixer, RejectsSettingsOfTaps) {
  Camera camera = mixer_camera();
  EXPECT_EQ(refusal_of(camera), "");
  camera.sensor.taps = 2;
  EXPECT_THAT(refusal_of(camera), HasSubstr("sensor.taps = 2; must be 1 with sensor.demodulation"));
  camera.sensor.readout = Readout::difference;
  EXPECT_THAT(refusal_of(camera), HasSubstr("must be 1 with sensor.demodulation"));
  camera = mixer_camera();
  camera.sensor.readout = Readout::rows;
  EXPECT_THAT(refusal_of(camera), HasSubstr("rows of one exposure already have signed weights"));
  camera = mixer_camera();
  camera.sensor.drain = false;
  EXPECT_THAT(
      refusal_of(camera),
      HasSubstr("sensor.drain = false; must be omitted with sensor.demodulation = \"signed\""));
  camera = mixer_camera();
  camera.sensor.adc_bits = 8;
  camera.sensor.gain_e_per_dn = 1.0;
  camera.sensor.black_level_dn = 0.0;
  EXPECT_THAT(refusal_of(camera), HasSubstr("sensor.black_level_dn = 0; must be > 0"));

  const Camera gains = built_in_camera("paper-10f0");
  camera = mixer_camera();
  const CodeSet of_gains = build_family("hamiltonian-k4", gains),
                of_weights = build_family("hamiltonian-k4", camera);
  EXPECT_THAT(why_not_playable(of_gains, camera).value_or(""), HasSubstr("weights in [-1, 1]"));
  EXPECT_THAT(why_not_playable(of_weights, gains).value_or(""),
              HasSubstr("requires a camera with sensor.demodulation = \"signed\""));
  EXPECT_THROW(of_weights.with_two_buckets(), std::invalid_argument);
  EXPECT_THROW(of_gains.with_two_buckets().with_signed_weights(), std::invalid_argument);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(8, 1);
  weights(3, 0) = 1.1;
  EXPECT_THROW(CodeSet::create_signed("too much", {Waveform::constant(1.0)}, weights),
               std::invalid_argument);
}

TEST(Mixer, CodesKeepTheirWeights) {
  const Camera camera = mixer_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  EXPECT_EQ(code.demodulation_samples().minCoeff(), -1.0);
  EXPECT_EQ(code.demodulation_samples().maxCoeff(), 1.0);
  for (const CodeSet& changed : {code.rotated(7), code.resampled(480), code.renamed("x")})
    EXPECT_TRUE(changed.is_signed());
  const CodeSet back = code.buckets_of_signed().signed_of_buckets();
  ASSERT_TRUE(back.is_signed());
  for (int e = 0; e < code.exposures(); ++e) EXPECT_EQ(back.demodulation(e), code.demodulation(e));
  std::vector<Waveform> light;
  for (int e = 0; e < code.exposures(); ++e) light.push_back(code.modulation(e));
  const CodeSet read = CodeSet::create_signed("read", light, code.demodulation_samples());
  for (int e = 0; e < code.exposures(); ++e) EXPECT_TRUE(read.demodulation(e).is_binary());
}

// Two-bucket sensors.

Camera two_bucket_camera(int samples = 240) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = samples;
  camera.sensor.taps = 2;
  return camera;
}

struct TwoBucketCode {
  const char* name;
  int samples;
};

constexpr TwoBucketCode two_bucket_codes[] = {
    {"hamiltonian-k4", 240},          {"hamiltonian-k5", 240},
    {"hamiltonian-k6", 240},          {"hamiltonian-k7", 252},
    {"hamiltonian-k8", 252},          {"sinusoid-k4", 240},
    {"multifrequency-1x4-7x4", 240},  {"multifrequency-1x2-7x2", 240},
    {"pulsed-multifrequency-k4", 240}};

TEST(TwoBuckets, CapturedDepthsAreDecoded) {
  for (const TwoBucketCode& c : two_bucket_codes)
    for (const Readout readout : {Readout::separate, Readout::difference}) {
      SCOPED_TRACE(c.name);
      Camera camera = two_bucket_camera(c.samples);
      camera.sensor.readout = readout;
      camera.exposure_s.total_s = 3000.0;  // almost no noise
      const CodeSet code = build_family(c.name, camera);
      const SceneImage scene = random_depths(20, 30, camera.range_m());
      const RawFrames raw = capture(scene, code, camera, {.falloff = false});
      const Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
      expect_depths(decoder.decode(raw), scene, camera, 0.02);
    }
}

TEST(TwoBuckets, TheSecondBucketReducesTheError) {
  for (const TwoBucketCode& c : two_bucket_codes) {
    Camera camera = two_bucket_camera(c.samples);
    camera.operating.signal_e_per_s = {1e5};
    camera.operating.ambient_e_per_s = {1e4};
    const DepthErrorReport two = evaluate(build_family(c.name, camera), camera, {.trials = 4000});
    EXPECT_EQ(two.taps, 2);
    EXPECT_EQ(two.measurements, 2 * two.exposures);
    camera.sensor.taps = 1;
    const DepthErrorReport one = evaluate(build_family(c.name, camera), camera, {.trials = 4000});
    EXPECT_EQ(one.exposures, two.exposures);
    EXPECT_LT(two.circular.mean_m.value, 0.9 * one.circular.mean_m.value) << c.name;
    EXPECT_GT(two.circular.mean_m.value, two.points[0].receiver_bound_mae_m) << c.name;
  }
}

}  // namespace

}  // namespace tofsmith
