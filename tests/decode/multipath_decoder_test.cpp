// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/shared/random.hpp"
#include "decode/multipath/multipath_engine.hpp"
#include "decode/multipath/multipath_search.hpp"
#include "decode/multipath/shared/bounded_quadratic.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith {

namespace {

/// Weighted least squares of one or two returns by exhaustive search over a fine grid, with exact
/// correlation functions, in double. As in SingleFits, chi^2 excludes the part that no return can
/// explain.
class ReferenceReturns {
 public:
  ReferenceReturns(const ForwardModel& model, const PixelGroup& group) {
    const Eigen::Index k_count = model.measurements();
    Eigen::VectorXd weight(k_count);
    target_.resize(k_count);
    for (Eigen::Index k = 0; k < k_count; ++k) {
      weight[k] = 1.0 / std::sqrt(double{group.variance_e2[k][0]});
      target_[k] = weight[k] * group.electrons[k][0];
    }
    Eigen::MatrixXd curve =
        model.correlation_table(places) * (model.exposure_s().cwiseProduct(weight)).asDiagonal();
    const Eigen::VectorXd ambient =
        model.exposure_s().cwiseProduct(model.ambient_gain()).cwiseProduct(weight).normalized();
    target_ -= target_.dot(ambient) * ambient;
    curve -= (curve * ambient) * ambient.transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(curve, Eigen::ComputeThinV);
    const Eigen::Index rank =
        (svd.singularValues().array() > 1e-6 * svd.singularValues()[0]).count();
    const Eigen::MatrixXd basis = svd.matrixV().leftCols(rank);
    target_ = basis.transpose() * target_;
    curve_ = curve * basis;
  }

  double best_single_chi2() const {
    double explained = 0.0;
    for (Eigen::Index j = 0; j < places; ++j) {
      const double b = std::max(curve_.row(j).dot(target_), 0.0);
      explained = std::max(explained, b * b / curve_.row(j).squaredNorm());
    }
    return target_.squaredNorm() - explained;
  }

  /// @param shortest, longest  limits of the delay [periods]
  double best_pair_chi2(double shortest, double longest) const {
    const Eigen::VectorXd along = curve_ * target_;
    const Eigen::MatrixXd gram = curve_ * curve_.transpose();
    double explained = 0.0;
    for (Eigen::Index j = 0; j < places; ++j)
      for (auto lag = static_cast<Eigen::Index>(std::ceil(shortest * places));
           lag <= static_cast<Eigen::Index>(longest * places); ++lag) {
        const Eigen::Index k = (j + lag) % places;
        const double det = gram(j, j) * gram(k, k) - gram(j, k) * gram(j, k);
        const double n1 = gram(k, k) * along[j] - gram(j, k) * along[k];
        const double n2 = gram(j, j) * along[k] - gram(j, k) * along[j];
        const double sum = std::max(along[j] + along[k], 0.0);
        if (n2 > n1)
          explained = std::max(explained, sum * sum / (gram(j, j) + 2 * gram(j, k) + gram(k, k)));
        else if (n2 >= 0.0 && det > 0.0)
          explained = std::max(explained, (n1 * along[j] + n2 * along[k]) / det);
      }
    return target_.squaredNorm() - explained;
  }

 private:
  static constexpr int places = 480;
  Eigen::VectorXd target_;
  Eigen::MatrixXd curve_;
};

/// Returns h = B^T B with a random B of `rows` rows; singular below three.
Quadratic random_quadratic(RandomStream& random, int rows) {
  Quadratic q;
  for (int r = 0; r < rows; ++r) {
    const Quadratic::Vector row{random.normal(), random.normal(), random.normal()};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) q.h[i][j] += row[i] * row[j];
    const double target = random.normal();  // g in the range of h: bounded below
    for (std::size_t i = 0; i < 3; ++i) q.g[i] += row[i] * target;
  }
  return q;
}

TEST(BoundedQuadratic, MinimumMeetsTheOptimalityConditions) {
  RandomStream random(1, 0);
  for (int trial = 0; trial < 3000; ++trial) {
    const int unknowns = 2 + trial % 2;
    const Quadratic q = random_quadratic(random, 2 + trial % 3);
    const BoundedMinimum least = minimize_bounded(q, unknowns);
    EXPECT_NEAR(least.value, q.at(least.x), 1e-12);
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_GE(least.x[at], 0.0);
      if (i >= unknowns) {
        EXPECT_EQ(least.x[at], 0.0);
        continue;
      }
      double slope = -q.g[at];
      for (std::size_t j = 0; j < 3; ++j) slope += q.h[at][j] * least.x[j];
      EXPECT_GE(slope, -1e-7) << trial;
      EXPECT_NEAR(slope * least.x[at], 0.0, 1e-7 * (1 + least.x[at])) << trial;
    }
  }
}

TEST(BoundedQuadratic, SchurComplementIsTheInverseOfABlockOfTheInverse) {
  RandomStream random(2, 0);
  for (int trial = 0; trial < 300; ++trial) {
    const Quadratic q = random_quadratic(random, 5);
    Eigen::Matrix3d h;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        h(i, j) = q.h[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    const Eigen::Matrix3d inverse = h.inverse();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(left_of(q, i) * inverse(i, i), 1.0, 1e-8);
  }
  Quadratic without_third = random_quadratic(random, 4);
  for (std::size_t i = 0; i < 3; ++i) without_third.h[2][i] = without_third.h[i][2] = 0.0;
  const auto& h = without_third.h;
  EXPECT_NEAR(left_of(without_third, 0), h[0][0] - h[0][1] * h[0][1] / h[1][1], 1e-12);
  EXPECT_NEAR(left_of(without_third, 1), h[1][1] - h[0][1] * h[0][1] / h[0][0], 1e-12);
}

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double ambient_e_per_s = 1e4;

struct TwoBucket {
  Camera camera = camera_with("paper-10f0", 2);
  ForwardModel model{build_family("hamiltonian-k5", camera), camera};
  DecodingTable table = make_decoding_table(model, camera);

  /// Pixels at depths spread over the range.
  /// @param returns_at  returns of a pixel whose first return is at a bin
  /// @param noise       in standard deviations
  RawFrames pixels(int count, const std::function<std::vector<Return>(double bin)>& returns_at,
                   double noise, std::vector<double>& true_m, std::uint64_t seed = 3) const {
    RawFrames raw{.frames = 1,
                  .height = 1,
                  .width = count,
                  .measurements = model.measurements(),
                  .values = {}};
    RandomStream random(seed, 0);
    for (int i = 0; i < count; ++i) {
      const double bin = (i + 0.5) / count * model.samples();
      true_m.push_back(bin * camera.bin_m());
      const std::vector<Return> returns = returns_at(bin);
      const Eigen::VectorXd mean = model.expected_electrons(returns, ambient_e_per_s);
      const Eigen::VectorXd variance = model.variance_e2(returns, ambient_e_per_s);
      for (Eigen::Index k = 0; k < mean.size(); ++k)
        raw.values.push_back(
            static_cast<float>(mean[k] + noise * std::sqrt(variance[k]) * random.normal()));
    }
    return raw;
  }
  RawFrames pixels(int count, double signal, double ratio, double delay_m, double noise,
                   std::vector<double>& true_m) const {
    const auto two = [&](double bin) {
      return std::vector<Return>{{signal, bin}, {ratio * signal, bin + delay_m / camera.bin_m()}};
    };
    return pixels(count, two, noise, true_m);
  }

  double mean_error_m(const Image<float>& depth_m, const std::vector<double>& true_m) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < true_m.size(); ++i)
      sum += std::abs(circular_difference(depth_m.pixels[i], true_m[i], camera.range_m()));
    return sum / static_cast<double>(true_m.size());
  }
};

double share(const DepthImage& image, ReturnStatus status) {
  return static_cast<double>(std::ranges::count(image.returns.pixels, status)) /
         static_cast<double>(image.returns.size());
}

TEST(TwoReturnDecoder, RecoversBothReturnsWithoutNoise) {
  const TwoBucket setup;
  const TwoReturnDecoder decoder(setup.table);
  std::vector<double> true_m;
  const DepthImage image = decoder.decode(setup.pixels(64, 1e6, 0.3, 1.0, 0.0, true_m));
  EXPECT_EQ(share(image, ReturnStatus::two), 1.0);
  // A search from coarse places occasionally ends in another local minimum of chi^2.
  int found = 0;
  for (std::size_t i = 0; i < true_m.size(); ++i)
    found += std::abs(circular_difference(image.depth_m.pixels[i], true_m[i],
                                          setup.camera.range_m())) < 0.01 &&
             std::abs(image.delay_m.pixels[i] - 1.0f) < 0.03f &&
             std::abs(image.ratio.pixels[i] - 0.3f) < 0.02f &&
             std::abs(image.ambient_e_per_s.pixels[i] - ambient_e_per_s) < 0.05 * ambient_e_per_s;
  EXPECT_GE(found, 61);
}

TEST(TwoReturnDecoder, ReducesTheErrorFourfoldWithCorrectDeviations) {
  const TwoBucket setup;
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(400, 1e5, 0.3, 1.0, 1.0, true_m);
  const DepthImage image = TwoReturnDecoder(setup.table).decode(raw);
  const double single = setup.mean_error_m(Decoder(setup.table).decode(raw).depth_m, true_m);
  EXPECT_GT(single, 4.0 * setup.mean_error_m(image.depth_m, true_m));
  int within = 0;
  for (std::size_t i = 0; i < true_m.size(); ++i)
    within +=
        std::abs(circular_difference(image.depth_m.pixels[i], true_m[i], setup.camera.range_m())) <
        3.0 * image.deviation_m.pixels[i];
  EXPECT_GT(within, 0.94 * 400);
}

TEST(TwoReturnDecoder, DoesNotChangeSingleReturns) {
  const TwoBucket setup;
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(2000, 1e4, 0.0, 0.0, 1.0, true_m);
  const DepthImage image = TwoReturnDecoder(setup.table).decode(raw);
  const DepthImage single = Decoder(setup.table).decode(raw);
  EXPECT_LE(share(image, ReturnStatus::two), 0.015);
  EXPECT_LT(setup.mean_error_m(image.depth_m, true_m),
            1.06 * setup.mean_error_m(single.depth_m, true_m));
  for (std::size_t i = 0; i < true_m.size(); ++i) {
    if (image.returns.pixels[i] == ReturnStatus::two) continue;
    ASSERT_EQ(image.depth_m.pixels[i], single.depth_m.pixels[i]);
    ASSERT_TRUE(std::isnan(image.delay_m.pixels[i]));
  }
}

TEST(TwoReturnDecoder, FitsAsWellAsAnExhaustiveReference) {
  const TwoBucket setup;
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(24, 1e5, 0.4, 1.3, 1.0, true_m);
  const AmbientProjection projection(setup.table);
  const MultipathCurve curve(setup.table, projection, 0.0);
  const auto points = static_cast<float>(curve.points);
  const DelayBounds delays{0.1f / static_cast<float>(setup.camera.range_m()) * points,
                           0.33f * points};
  int as_good = 0;
  for (int i = 0; i < raw.width; ++i) {
    PixelGroup group{};
    for (int k = 0; k < raw.measurements; ++k)
      for (int lane = 0; lane < pixels_per_group; ++lane) {
        group.electrons[k][lane] = raw.frame(0)[i * raw.measurements + k];
        group.variance_e2[k][lane] = group.electrons[k][lane] + 400.0f;
      }
    PairFits fits;
    fit_pair(curve, delays, group, fits);
    const ReferenceReturns reference(setup.model, group);
    // Tolerance: interpolation error of the table between bins.
    as_good += fits.chi2[0] <
               reference.best_pair_chi2(delays.shortest / points, delays.longest / points) + 1.0;
    EXPECT_NEAR(fits.single_chi2[0], reference.best_single_chi2(),
                1.0 + 0.02 * fits.single_chi2[0]);
  }
  EXPECT_GE(as_good, 23);
}

TEST(TwoReturnDecoder, IsBitIdenticalForAnyNumberOfThreadsAndNeighbours) {
  const TwoBucket setup;
  const TwoReturnDecoder decoder(setup.table);
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(600, 1e5, 0.3, 0.8, 1.0, true_m);
  std::vector<double> whole(600), alone(600);
  decoder.decode_depth_bins(raw.frame(0), 600, whole.data());
  for (int i = 0; i < 600; i += 37)
    decoder.decode_depth_bins(raw.frame(0) + i * raw.measurements, 1, &alone[i]);
  for (int i = 0; i < 600; i += 37) EXPECT_EQ(alone[i], whole[i]);
  const DepthImage many = decoder.decode(raw);
  const ThreadLimit one(1);
  const DepthImage few = decoder.decode(raw);
  EXPECT_EQ(many.depth_m.pixels, few.depth_m.pixels);
  EXPECT_EQ(many.returns.pixels, few.returns.pixels);
}

TEST(TwoReturnDecoder, IsIdenticalOnEveryInstructionSet) {
  const TwoBucket setup;
  const TwoReturnDecoder decoder(setup.table);
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(48, 1e6, 0.3, 1.0, 0.0, true_m);
  for_each_target(
      [&] { EXPECT_LT(setup.mean_error_m(decoder.decode(raw).depth_m, true_m), 0.01); });
}

TEST(TwoReturnDecoder, MarksPixelsWithoutDepth) {
  const TwoBucket setup;
  std::vector<double> true_m;
  RawFrames raw = setup.pixels(2, 1e5, 0.3, 1.0, 0.0, true_m);
  raw.values[3] = std::numeric_limits<float>::quiet_NaN();
  const DepthImage image = TwoReturnDecoder(setup.table).decode(raw);
  EXPECT_EQ(image.returns.pixels[0], ReturnStatus::none);
  EXPECT_EQ(image.status.pixels[0], PixelStatus::invalid);
  EXPECT_EQ(image.returns.pixels[1], ReturnStatus::two);
}

TEST(TwoReturnDecoder, FollowsItsPriorInDimLight) {
  const TwoBucket setup;
  std::vector<double> true_m;
  const RawFrames raw = setup.pixels(150, 1e4, 0.3, 0.5, 1.0, true_m);
  const DepthImage likely = TwoReturnDecoder(setup.table, {.threshold = 2.0}).decode(raw);
  const DepthImage believed =
      TwoReturnDecoder(setup.table, {.threshold = 2.0, .prior = ReturnPrior{}}).decode(raw);
  EXPECT_LT(setup.mean_error_m(believed.depth_m, true_m),
            setup.mean_error_m(likely.depth_m, true_m));
}

TEST(TwoReturnDecoder, RejectsCodesThatCannotSeparateReturns) {
  const auto refused = [](const char* code, int taps, const char* why) {
    const DecodingTable table = decoding_table_of(code, camera_with("paper-10f0", taps));
    EXPECT_THAT([&] { TwoReturnDecoder{table}; },
                ThrowsMessage<std::invalid_argument>(testing::AllOf(
                    HasSubstr("independent means"), HasSubstr(why), HasSubstr("sensor.taps=2"))))
        << code;
  };
  refused("hamiltonian-k5", 1, "5; must be >= 6");
  refused("sinusoid-k4", 1, "only one frequency");
  refused("multifrequency-k5", 1, "only two frequencies");
}

TEST(TwoReturnDecoder, DoesNotRecommendACodeBeyondTheBandwidth) {
  Camera camera = camera_with("paper-10f0", 2);
  camera.light.impulse_response.f_max_hz = camera.sensor.impulse_response.f_max_hz = 2.5e7;
  const auto problem =
      TwoReturnDecoder::why_not_decodable(decoding_table_of("hamiltonian-k5", camera));
  ASSERT_TRUE(problem);
  EXPECT_THAT(*problem, testing::AllOf(HasSubstr("its 10 measurements suffice"),
                                       HasSubstr("higher bandwidth"),
                                       testing::Not(HasSubstr("hamiltonian-k5"))));
}

TEST(TwoReturnDecoder, RejectsInvalidOptions) {
  const TwoBucket setup;
  const auto refused = [&](const MultipathOptions& options, const char* field) {
    EXPECT_THAT([&] { TwoReturnDecoder(setup.table, options); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(field)));
  };
  refused({.threshold = -1.0}, "threshold = -1");
  refused({.shortest_delay_m = 0.0}, "shortest_delay_m = 0");
  refused({.longest_delay_m = 20.0}, "longest_delay_m = 20");
  refused({.tail_m = 11.0}, "tail_m = 11");
  refused({.prior = ReturnPrior{.max_ratio = 2.0}}, "max_ratio = 2");
}

TEST(TailDecoder, ReducesTheErrorOfATailFivefold) {
  const TwoBucket setup;
  std::vector<double> true_m;
  const auto with_tail = [&](double bin) {
    std::vector<Return> returns = {{1e5, bin}};
    constexpr int parts = 20;
    for (int j = 0; j < parts; ++j)
      returns.push_back(
          {0.3e5 / parts, bin - 0.5 * std::log1p(-(j + 0.5) / parts) / setup.camera.bin_m()});
    return returns;
  };
  const RawFrames raw = setup.pixels(100, with_tail, 1.0, true_m, 5);
  const DepthImage image = TailDecoder(setup.table).decode(raw);
  EXPECT_GT(setup.mean_error_m(Decoder(setup.table).decode(raw).depth_m, true_m),
            5.0 * setup.mean_error_m(image.depth_m, true_m));
}

}  // namespace

}  // namespace tofsmith
