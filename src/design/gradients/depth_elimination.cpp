// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/gradients/depth_elimination.hpp"

#include <limits>
#include <vector>

#include "simulate/shared/depth_information.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/gradients/depth_elimination.cpp"
#include <hwy/foreach_target.h>
// Highway requires its header after foreach_target.
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

/// Vector of depths at one light level: weights w = 1 / variance, and the component of the depth
/// column of the Jacobian that is orthogonal (by w) to the signal and ambient columns:
///   across = depth - signal_share signal - ambient_share ambient.
class Elimination {
 public:
  Elimination(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2)
      : electrons_(electrons),
        constant_e2_(constant_e2.data()),
        measurements_(static_cast<int>(electrons.signal.cols())),
        depths_(electrons.signal.rows()),
        weights_(static_cast<std::size_t>(measurements_) * depth_block) {}

  HWY_INLINE void at(Eigen::Index first, const OperatingPoint& light) {
    first_ = first;
    const Doubles d;
    const auto signal_e = all(light.signal_e_per_s), ambient_e = all(light.ambient_e_per_s);
    auto aa = hn::Zero(d), as = hn::Zero(d), ad = hn::Zero(d), ss = hn::Zero(d), dd = hn::Zero(d);
    for (int i = 0; i < measurements_; ++i) {
      const auto other_e2 =
          hn::MulAdd(ambient_e, all(electrons_.shot_ambient[i]), all(constant_e2_[i]));
      const auto variance = hn::MulAdd(signal_e, row(electrons_.shot, i), other_e2);
      const auto weight = hn::Div(all(1.0), hn::Max(variance, all(min_e2)));
      hn::StoreU(weight, d, weights_.data() + i * depth_block);
      const auto a = all(electrons_.ambient[i]), s = row(electrons_.signal, i);
      const auto depth = hn::Mul(signal_e, row(electrons_.slope, i));
      const auto weighed_a = hn::Mul(weight, a), weighed_d = hn::Mul(weight, depth);
      aa = hn::MulAdd(weighed_a, a, aa);
      as = hn::MulAdd(weighed_a, s, as);
      ad = hn::MulAdd(weighed_a, depth, ad);
      ss = hn::MulAdd(hn::Mul(weight, s), s, ss);
      dd = hn::MulAdd(weighed_d, depth, dd);
    }
    const auto per_aa = inverse_or_zero(aa, hn::Zero(d));
    const auto signal_along = hn::Mul(as, per_aa), depth_along = hn::Mul(ad, per_aa);
    auto ss_across = hn::Zero(d), sd_across = hn::Zero(d);
    for (int i = 0; i < measurements_; ++i) {
      const auto a = all(electrons_.ambient[i]);
      const auto s = hn::NegMulAdd(signal_along, a, row(electrons_.signal, i));
      const auto depth = hn::NegMulAdd(depth_along, a, hn::Mul(signal_e, row(electrons_.slope, i)));
      const auto weighed = hn::Mul(weight_of(i), s);
      ss_across = hn::MulAdd(weighed, s, ss_across);
      sd_across = hn::MulAdd(weighed, depth, sd_across);
    }
    signal_share = hn::Mul(sd_across, inverse_or_zero(ss_across, hn::Mul(all(rounding), ss)));
    ambient_share = hn::NegMulAdd(signal_share, signal_along, depth_along);
    square = hn::Zero(d);
    for (int i = 0; i < measurements_; ++i) {
      const auto across = across_of(i, signal_e);
      square = hn::MulAdd(hn::Mul(weight_of(i), across), across, square);
    }
    is_known = hn::And(hn::Gt(square, hn::Mul(all(rounding), dd)), hn::Gt(square, hn::Zero(d)));
  }

  HWY_INLINE DoubleVector weight_of(int i) const {
    return hn::LoadU(Doubles(), weights_.data() + i * depth_block);
  }
  HWY_INLINE DoubleVector across_of(int i, DoubleVector signal_e) const {
    const auto depth = hn::Mul(signal_e, row(electrons_.slope, i));
    return hn::NegMulAdd(ambient_share, all(electrons_.ambient[i]),
                         hn::NegMulAdd(signal_share, row(electrons_.signal, i), depth));
  }
  HWY_INLINE DoubleVector row(const Eigen::MatrixXd& of, int i) const {
    return hn::LoadU(Doubles(), of.data() + i * depths_ + first_);
  }
  int measurements() const { return measurements_; }

  DoubleVector signal_share, ambient_share;
  DoubleVector square;  // |across|^2
  hn::Mask<Doubles> is_known;

 private:
  static constexpr double rounding = 1e-20;  // smaller squares are rounding errors

  HWY_INLINE DoubleVector inverse_or_zero(DoubleVector value, DoubleVector least) const {
    return hn::IfThenElseZero(hn::Gt(value, least), hn::Div(all(1.0), value));
  }

  const DepthElectrons& electrons_;
  const double* constant_e2_;
  int measurements_;
  Eigen::Index depths_, first_ = 0;
  std::vector<double> weights_;  // (depth_block, K)
};

void deviations_of(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                   std::span<const OperatingPoint> lights, double range_m,
                   Eigen::MatrixXd& deviation_m) {
  const Doubles d;
  Elimination depths(electrons, constant_e2);
  const auto infinite = all(std::numeric_limits<double>::infinity());
  for (std::size_t l = 0; l < lights.size(); ++l)
    for (Eigen::Index j = 0; j < electrons.signal.rows(); j += lanes_of(d)) {
      depths.at(j, lights[l]);
      const auto deviation = hn::Div(all(range_m), hn::Sqrt(depths.square));
      hn::StoreU(hn::IfThenElse(depths.is_known, deviation, infinite), d,
                 deviation_m.col(static_cast<Eigen::Index>(l)).data() + j);
    }
}

HWY_INLINE void add_lanes(double* sums, DoubleVector value) {
  const Doubles d;
  hn::StoreU(hn::Add(hn::LoadU(d, sums), value), d, sums);
}

double sum_of_lanes(const std::vector<double>& lanes, std::size_t at) {
  double sum = 0.0;
  for (int lane = 0; lane < lanes_of(Doubles()); ++lane)
    sum += lanes[at * depth_block + static_cast<std::size_t>(lane)];
  return sum;
}

void add_gradient_of(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                     std::span<const OperatingPoint> lights, double range_m,
                     const Eigen::MatrixXd& by_deviation, DepthElectrons& by,
                     std::span<OperatingPoint> by_lights) {
  const Doubles d;
  Elimination depths(electrons, constant_e2);
  const int K = depths.measurements();
  const auto measurements = static_cast<std::size_t>(K);
  std::vector<double> by_ambient(measurements * depth_block), by_shot_ambient(by_ambient.size());
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const auto signal_e = all(lights[l].signal_e_per_s), ambient_e = all(lights[l].ambient_e_per_s);
    const double* const weights = by_deviation.col(static_cast<Eigen::Index>(l)).data();
    auto by_signal_e = hn::Zero(d), by_ambient_e = hn::Zero(d);
    for (Eigen::Index j = 0; j < electrons.signal.rows(); j += lanes_of(d)) {
      depths.at(j, lights[l]);
      // d sigma = -range / |across|^3 d |across|^2 / 2
      const auto by_half_square = hn::IfThenElseZero(
          depths.is_known, hn::Div(hn::Mul(hn::LoadU(d, weights + j), all(-range_m)),
                                   hn::Mul(depths.square, hn::Sqrt(depths.square))));
      for (int i = 0; i < K; ++i) {
        const auto weight = depths.weight_of(i), across = depths.across_of(i, signal_e);
        const auto by_mean = hn::Mul(by_half_square, hn::Mul(weight, across));
        const Eigen::Index at = i * electrons.signal.rows() + j;
        add_lanes(by.slope.data() + at, hn::Mul(by_mean, signal_e));
        add_lanes(by.signal.data() + at, hn::Neg(hn::Mul(by_mean, depths.signal_share)));
        add_lanes(by_ambient.data() + i * depth_block,
                  hn::Neg(hn::Mul(by_mean, depths.ambient_share)));
        by_signal_e = hn::MulAdd(by_mean, depths.row(electrons.slope, i), by_signal_e);
        // At its minimum the variance is clipped and has no gradient.
        const auto by_variance =
            hn::IfThenElseZero(hn::Lt(weight, all(1.0 / min_e2)),
                               hn::Mul(hn::Mul(all(-0.5), by_mean), hn::Mul(weight, across)));
        add_lanes(by.shot.data() + at, hn::Mul(by_variance, signal_e));
        add_lanes(by_shot_ambient.data() + i * depth_block, hn::Mul(by_variance, ambient_e));
        by_signal_e = hn::MulAdd(by_variance, depths.row(electrons.shot, i), by_signal_e);
        by_ambient_e = hn::MulAdd(by_variance, all(electrons.shot_ambient[i]), by_ambient_e);
      }
    }
    by_lights[l] = {sum_of_lanes(d, by_signal_e), sum_of_lanes(d, by_ambient_e)};
  }
  for (std::size_t i = 0; i < measurements; ++i) {
    by.ambient[static_cast<Eigen::Index>(i)] += sum_of_lanes(by_ambient, i);
    by.shot_ambient[static_cast<Eigen::Index>(i)] += sum_of_lanes(by_shot_ambient, i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(deviations_of);
HWY_EXPORT(add_gradient_of);

void eliminate_light(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                     std::span<const OperatingPoint> lights, double range_m,
                     Eigen::MatrixXd& deviation_m) {
  deviation_m.resize(electrons.signal.rows(), static_cast<Eigen::Index>(lights.size()));
  HWY_DYNAMIC_DISPATCH(deviations_of)(electrons, constant_e2, lights, range_m, deviation_m);
}

void pull_back_elimination(const DepthElectrons& electrons, const Eigen::VectorXd& constant_e2,
                           std::span<const OperatingPoint> lights, double range_m,
                           const Eigen::MatrixXd& by_deviation, DepthElectrons& by_electrons,
                           std::span<OperatingPoint> by_lights) {
  HWY_DYNAMIC_DISPATCH(add_gradient_of)
  (electrons, constant_e2, lights, range_m, by_deviation, by_electrons, by_lights);
}

}  // namespace tofsmith
#endif
