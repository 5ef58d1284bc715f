// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/shared/random.hpp"
#include "rows_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decode_method.hpp"

namespace tofsmith {
namespace {

constexpr int samples = 60;

Camera rows_camera_with(RowDecoder decoder, double signal_e, double ambient_e) {
  Camera camera = rows_camera(samples, signal_e, ambient_e);
  camera.sensor.decoder = decoder;
  return camera;
}

struct RowsSetup {
  explicit RowsSetup(const char* name, double signal_e = 2e3, double ambient_e = 1e3,
                     RowDecoder decoder = RowDecoder::whitened)
      : RowsSetup(build_family(name, rows_camera_with(decoder, signal_e, ambient_e)),
                  rows_camera_with(decoder, signal_e, ambient_e)) {}
  RowsSetup(const CodeSet& code, Camera given)
      : camera(std::move(given)),
        model(code, camera),
        table(make_decoding_table(model, camera)),
        weights(model.readout().transpose()),
        light(samples, samples) {
    for (int z = 0; z < samples; ++z) light.col(z) = bins_e(model, z, 1.0, 0.0);
  }

  /// Interpolates between depths.
  Eigen::VectorXd bins(double depth_bin, double signal, double ambient) const {
    const int from = static_cast<int>(depth_bin), to = (from + 1) % samples;
    const double t = depth_bin - from;
    return (signal * ((1 - t) * light.col(from) + t * light.col(to))).array() + ambient / samples;
  }
  /// C^T diag(E h) C.
  Eigen::MatrixXd covariance(const Eigen::VectorXd& bins_e) const {
    return weights.transpose() * bins_e.asDiagonal() * weights;
  }
  Eigen::VectorXf pixel(double depth_bin, double signal, double ambient, std::uint64_t seed) const {
    RandomStream random(seed, 0, 0);
    Eigen::VectorXd counts = bins(depth_bin, signal, ambient);
    for (double& value : counts) value = random.poisson(value);
    return (weights.transpose() * counts).cast<float>();
  }

  Camera camera;
  ForwardModel model;
  DecodingTable table;
  Eigen::MatrixXd weights;  // C (N, K)
  Eigen::MatrixXd light;    // light in bin n from depth z, (N, N)
};

constexpr const char* names[] = {"fourier-k6", "hamiltonian-k4", "histogram-k5"};

/// Reference correlation: `ambient` is projected out, in coordinates in which `covariance` is
/// white.
class CorrelationByDefinition {
 public:
  CorrelationByDefinition(const RowsSetup& setup, const Eigen::MatrixXd& covariance,
                          const Eigen::VectorXd& ambient) {
    const Eigen::MatrixXd inverse = covariance.inverse();
    for (int z = 0; z < samples; ++z) {
      Eigen::VectorXd x = setup.weights.transpose() * setup.light.col(z);
      if (ambient.norm() > 1e-6 * setup.weights.norm())
        x -= x.dot(inverse * ambient) / ambient.dot(inverse * ambient) * ambient;
      references_.push_back(inverse * x / std::sqrt(x.dot(inverse * x)));
    }
  }
  /// Uses the mean covariance over depth at the nominal light.
  static CorrelationByDefinition whitened(const RowsSetup& setup) {
    const OperatingPoint nominal = setup.camera.operating.middle();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(setup.weights.cols(), setup.weights.cols());
    for (int z = 0; z < samples; ++z)
      sum += setup.covariance(setup.bins(z, nominal.signal_e_per_s, nominal.ambient_e_per_s));
    return {setup, sum / samples, setup.weights.transpose() * Eigen::VectorXd::Ones(samples)};
  }
  /// Zero-mean normalized cross-correlation of unweighted rows.
  static CorrelationByDefinition plain(const RowsSetup& setup) {
    const Eigen::Index rows = setup.weights.cols();
    return {setup, Eigen::MatrixXd::Identity(rows, rows), Eigen::VectorXd::Ones(rows)};
  }

  int best(const Eigen::VectorXd& y) const {
    int best = 0;
    for (int z = 1; z < samples; ++z)
      // Among bins equal up to rounding, use the first.
      if (references_[static_cast<std::size_t>(z)].dot(y) >
          references_[static_cast<std::size_t>(best)].dot(y) + 1e-9 * y.norm())
        best = z;
    return best;
  }

 private:
  std::vector<Eigen::VectorXd> references_;
};

void expect_bins(const RowsSetup& setup, const CorrelationByDefinition& definition) {
  const Decoder decoder(setup.table);
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Eigen::VectorXf raw = setup.pixel(static_cast<double>(seed) * 0.97, 100, 300, seed);
    std::int32_t found = 0;
    decoder.decode_bins(raw.data(), 1, &found);
    EXPECT_EQ(found, definition.best(raw.cast<double>())) << seed;
  }
}

TEST(RowsDecoder, FindsTheBinOfTheDefinition) {
  for (const char* name : names) {
    SCOPED_TRACE(name);
    const RowsSetup setup(name);
    expect_bins(setup, CorrelationByDefinition::whitened(setup));
  }
}

/// Rows of different sums, so that ambient light differs between them.
CodeSet rows_of_unequal_sums() {
  Eigen::VectorXd light = Eigen::VectorXd::Zero(samples);
  light.head(4).setOnes();
  Eigen::MatrixXd weights(samples, 5);
  for (int k = 0; k < 5; ++k)
    for (int n = 0; n < samples; ++n)
      weights(n, k) =
          0.3 * k + std::cos(2.0 * std::numbers::pi * (k / 2 + 1) * (n + 17.0 * k) / samples);
  return CodeSet::create_rows("unequal-k5", light, weights);
}

TEST(RowsDecoder, PlainFindsTheBinOfTheDefinition) {
  const Camera camera = rows_camera_with(RowDecoder::plain, 2e3, 1e3);
  std::vector<CodeSet> codes = {rows_of_unequal_sums()};
  for (const char* name : names) codes.push_back(build_family(name, camera));
  for (const CodeSet& code : codes) {
    SCOPED_TRACE(code.name());
    const RowsSetup setup(code, camera);
    expect_bins(setup, CorrelationByDefinition::plain(setup));
  }
}

TEST(RowsDecoder, PlainEqualsWhitenedIfTheNoiseIsWhite) {
  // On average over depth, equal gates have equal and independent noise.
  const RowsSetup whitened("histogram-k5"), plain("histogram-k5", 2e3, 1e3, RowDecoder::plain);
  const Decoder first(whitened.table), second(plain.table);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Eigen::VectorXf raw = whitened.pixel(static_cast<double>(seed) * 0.29, 100, 300, seed);
    double expected = 0.0, found = 0.0;
    first.decode_depth_bins(raw.data(), 1, &expected);
    second.decode_depth_bins(raw.data(), 1, &found);
    EXPECT_LT(std::abs(circular_difference(found, expected, samples)), 1e-4) << seed;
  }
}

TEST(RowsDecoder, MaximumLikelihoodRejectsThePlainDecoder) {
  const RowsSetup setup("fourier-k6", 2e3, 1e3, RowDecoder::plain);
  EXPECT_THAT([&] { LikelihoodDecoder decoder(setup.table); },
              testing::ThrowsMessage<InvalidArgument>(
                  testing::HasSubstr("sensor.decoder = plain; must be \"whitened\"")));
}

TEST(RowsDecoder, RecoversEveryDepthWithoutNoise) {
  for (const char* name : names)
    for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml}) {
      const RowsSetup setup(name);
      const std::unique_ptr<const DepthDecoder> decoder = make_decoder(method, setup.table);
      for (int depth_bin = 0; depth_bin < samples; ++depth_bin) {
        const Eigen::VectorXf raw =
            (setup.weights.transpose() * setup.bins(depth_bin, 800, 400)).cast<float>();
        double found = 0.0;
        decoder->decode_depth_bins(raw.data(), 1, &found);
        EXPECT_LT(std::abs(circular_difference(found, depth_bin, samples)), 2e-2) << name;
      }
    }
}

/// (y - mu)^T Sigma^-1 (y - mu) + log det Sigma.
double cost_by_definition(const RowsSetup& setup, const Eigen::VectorXd& y, double depth_bin,
                          double signal, double ambient) {
  const Eigen::VectorXd bins = setup.bins(depth_bin, signal, ambient);
  const Eigen::MatrixXd covariance = setup.covariance(bins);
  const Eigen::VectorXd residual = y - setup.weights.transpose() * bins;
  return residual.dot(covariance.inverse() * residual) + std::log(covariance.determinant());
}

TEST(RowsDecoder, NoDepthIsMoreLikelyThanThatOfMaximumLikelihood) {
  for (const char* name : {"fourier-k6", "hamiltonian-k4"}) {
    const RowsSetup setup(name, 500, 300);
    const LikelihoodDecoder decoder(setup.table);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const double truth = 9.37 * static_cast<double>(seed);
      const Eigen::VectorXf raw = setup.pixel(truth, 500, 300, seed);
      const Eigen::VectorXd y = raw.cast<double>();
      const DepthImage image =
          decoder.decode(RawFrames{.frames = 1,
                                   .height = 1,
                                   .width = 1,
                                   .measurements = int(raw.size()),
                                   .values = std::vector<float>(raw.begin(), raw.end())});
      // Neither code sees ambient light; the nominal level is assumed.
      ASSERT_TRUE(std::isnan(image.ambient_e_per_s(0, 0)));
      const double own = cost_by_definition(setup, y, image.depth_m(0, 0) / setup.table.bin_m(),
                                            image.signal_e_per_s(0, 0), 300);
      for (double z = 0.0; z < samples; z += 0.25)
        for (double signal = 100; signal <= 900; signal += 100)
          EXPECT_GT(cost_by_definition(setup, y, z, signal, 300), own - 1e-2)
              << name << " " << seed << " " << z << " " << signal;
    }
  }
}

/// Predicted over empirical deviation.
template <typename DecoderType>
double deviation_ratio(const RowsSetup& setup, const DecoderType& decoder) {
  const OperatingPoint light = setup.camera.operating.middle();
  constexpr int pixels = 400;
  constexpr double depth_bin = 20.4;
  RawFrames raw{.frames = 1, .height = 1, .width = pixels, .measurements = 6, .values = {}};
  for (int i = 0; i < pixels; ++i) {
    const Eigen::VectorXf y = setup.pixel(depth_bin, light.signal_e_per_s, light.ambient_e_per_s,
                                          static_cast<std::uint64_t>(i));
    raw.values.insert(raw.values.end(), y.begin(), y.end());
  }
  const DepthImage image = decoder.decode(raw);
  double square = 0.0, predicted = 0.0;
  for (int i = 0; i < pixels; ++i) {
    square += std::pow(image.depth_m(0, i) - depth_bin * setup.table.bin_m(), 2);
    predicted += std::pow(image.deviation_m(0, i), 2);
  }
  return std::sqrt(predicted / square);
}

TEST(RowsDecoder, PredictedDeviationsMatchTheNoise) {
  // The standard error of a deviation from 400 pixels is 4 %.
  const RowsSetup signal("fourier-k6", 5e3, 1e3), ambient("fourier-k6", 2e4, 2e5);
  EXPECT_NEAR(deviation_ratio(signal, LikelihoodDecoder(signal.table)), 1.0, 0.15);
  EXPECT_NEAR(deviation_ratio(ambient, LikelihoodDecoder(ambient.table)), 1.0, 0.15);
  EXPECT_NEAR(deviation_ratio(ambient, Decoder(ambient.table)), 1.0, 0.15);
  const RowsSetup plain("fourier-k6", 2e4, 2e5, RowDecoder::plain);
  EXPECT_NEAR(deviation_ratio(plain, Decoder(plain.table)), 1.0, 0.15);
  // With signal-dominated noise the covariance varies with depth. zncc neglects this and
  // overestimates the deviation.
  EXPECT_NEAR(deviation_ratio(signal, Decoder(signal.table)), 1.25, 0.25);
}

TEST(RowsDecoder, OtherMethodsRejectRows) {
  const RowsSetup setup("fourier-k6");
  for (const DecodeMethod method :
       {DecodeMethod::unwrap, DecodeMethod::two_return, DecodeMethod::tail})
    EXPECT_THROW(make_decoder(method, setup.table), InvalidArgument) << name_of(method);
}

}  // namespace
}  // namespace tofsmith
