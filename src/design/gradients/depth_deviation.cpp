// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "camera/shared/ambient_leak.hpp"
#include "design/gradients/gradient_steps.hpp"
#include "simulate/shared/depth_information.hpp"

namespace tofsmith {

namespace {

/// Of the measurements, without memory of its own to fetch at every depth where they are few.
using FewMeasurements = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 16, 1>;

/// Electrons of measurements, and of the light they are made of, per unit of signal (4 N, K) and of
/// ambient light (K); slopes per period. As CramerRaoBound has them.
struct Information {
  Eigen::MatrixXd signal, slope, shot;
  Eigen::VectorXd ambient, shot_ambient;
};

Information information_of(const CodeGradients::Steps& steps, const MeasurementTable& table) {
  const Eigen::MatrixXd fine =
      steps.between.fine_table(steps.functions_of(table), 2 * cells_per_bin);
  const Eigen::VectorXd& time_s = steps.sampled.exposure_s();
  const Eigen::Index K = time_s.size();
  Information information;
  middles_and_slopes(fine.leftCols(K) * time_s.asDiagonal(), information.signal, information.slope);
  information.shot = information.signal;
  if (steps.has_shot()) {
    Eigen::MatrixXd unused;
    middles_and_slopes(fine.rightCols(K) * time_s.asDiagonal(), information.shot, unused);
  }
  information.shot_ambient = time_s.cwiseProduct(table.shot_ambient());
  information.ambient = time_s.cwiseProduct(table.ambient_gain);
  const double brightest = brightest_ambient_e_per_s(steps.camera);
  if (ambient_cancels(steps.camera, brightest * information.ambient,
                      steps.sampled.constant_variance_e2() + brightest * information.shot_ambient))
    information.ambient.setZero();
  information.ambient =
      (information.ambient.array().abs() > 1e-9 * information.shot_ambient.array())
          .select(information.ambient, 0.0);
  return information;
}

/// One depth: its Jacobian, whitened.
template <typename Column>
struct WhitenedDepth {
  WhitenedDepth(const Information& information, const Eigen::VectorXd& constant_e2,
                Eigen::Index depth, const OperatingPoint& point)
      : variance(point.signal_e_per_s * information.shot.row(depth).transpose() +
                 point.ambient_e_per_s * information.shot_ambient + constant_e2),
        weight(variance.cwiseMax(min_e2).cwiseSqrt().cwiseInverse()),
        part(point.signal_e_per_s * weight.cwiseProduct(information.slope.row(depth).transpose()),
             weight.cwiseProduct(information.signal.row(depth).transpose()),
             weight.cwiseProduct(information.ambient)) {}

  Column variance, weight;
  DepthPart<Column> part;
};

template <typename Column>
void write_deviations_m(const Information& information, const Eigen::VectorXd& constant_e2,
                        const OperatingPoint& point, double range_m,
                        Eigen::Ref<Eigen::VectorXd> deviation_m) {
  for (Eigen::Index j = 0; j < deviation_m.size(); ++j)
    deviation_m[j] =
        WhitenedDepth<Column>(information, constant_e2, j, point).part.deviation_m(range_m);
}

/// Gradient by what is in Information, and by light.
struct InformationGradient {
  InformationGradient(Eigen::Index cells, Eigen::Index measurements)
      : of{Eigen::MatrixXd::Zero(cells, measurements), Eigen::MatrixXd::Zero(cells, measurements),
           Eigen::MatrixXd::Zero(cells, measurements), Eigen::VectorXd::Zero(measurements),
           Eigen::VectorXd::Zero(measurements)} {}

  Information of;
  double signal_e_per_s = 0.0, ambient_e_per_s = 0.0;  ///< of the last point
};

/// sigma = range / |across|, and across is least over the shares of the other two columns:
///   d |across|^2 / 2 = <across, w (d depth - share d signal - share d ambient)>
///                      - sum across^2 / (2 variance) d variance.
template <typename Column>
void add_gradient(const Information& information, const Eigen::VectorXd& constant_e2,
                  const OperatingPoint& point, double range_m,
                  const Eigen::Ref<const Eigen::VectorXd>& by_deviation, InformationGradient& by) {
  const Eigen::Index cells = information.signal.rows(), K = information.signal.cols();
  by.signal_e_per_s = by.ambient_e_per_s = 0.0;
  for (Eigen::Index j = 0; j < cells; ++j) {
    const WhitenedDepth<Column> at(information, constant_e2, j, point);
    const DepthPart<Column>& part = at.part;
    if (!(part.length > 0.0) || by_deviation[j] == 0.0) continue;
    const double by_half_square =
        -by_deviation[j] * part.deviation_m(range_m) / (part.length * part.length);
    for (Eigen::Index i = 0; i < K; ++i) {
      const double across = by_half_square * part.across[i];
      const double by_mean = across * at.weight[i];
      by.of.slope(j, i) += by_mean * point.signal_e_per_s;
      by.of.signal(j, i) -= by_mean * part.signal_share;
      by.of.ambient[i] -= by_mean * part.ambient_share;
      by.signal_e_per_s += by_mean * information.slope(j, i);
      if (at.variance[i] <= min_e2) continue;
      const double by_variance = -0.5 * across * part.across[i] / at.variance[i];
      by.of.shot(j, i) += by_variance * point.signal_e_per_s;
      by.of.shot_ambient[i] += by_variance * point.ambient_e_per_s;
      by.signal_e_per_s += by_variance * information.shot(j, i);
      by.ambient_e_per_s += by_variance * information.shot_ambient[i];
    }
  }
}

}  // namespace

Eigen::MatrixXd CodeGradients::depth_deviation_m(const MeasurementTable& table,
                                                 std::span<const OperatingPoint> points) const {
  const Information information = information_of(*steps_, table);
  const auto write = table.measurements() <= FewMeasurements::MaxRowsAtCompileTime
                         ? &write_deviations_m<FewMeasurements>
                         : &write_deviations_m<Eigen::VectorXd>;
  Eigen::MatrixXd deviation_m(information.signal.rows(), points.size());
  for (std::size_t l = 0; l < points.size(); ++l)
    write(information, steps_->sampled.constant_variance_e2(), points[l], steps_->camera.range_m(),
          deviation_m.col(static_cast<Eigen::Index>(l)));
  return deviation_m;
}

PixelGradient CodeGradients::pull_back_depth_deviation(const MeasurementTable& table,
                                                       std::span<const OperatingPoint> points,
                                                       const Eigen::MatrixXd& by_deviation) const {
  const Information information = information_of(*steps_, table);
  const Eigen::Index K = information.signal.cols();
  const auto lights = static_cast<Eigen::Index>(points.size());
  const auto add = K <= FewMeasurements::MaxRowsAtCompileTime ? &add_gradient<FewMeasurements>
                                                              : &add_gradient<Eigen::VectorXd>;
  PixelGradient gradient{
      zeros_like(table), {}, Eigen::VectorXd::Zero(lights), Eigen::VectorXd::Zero(lights)};
  InformationGradient by(information.signal.rows(), K);
  for (Eigen::Index l = 0; l < lights; ++l) {
    add(information, steps_->sampled.constant_variance_e2(), points[static_cast<std::size_t>(l)],
        steps_->camera.range_m(), by_deviation.col(l), by);
    gradient.signal_e_per_s[l] = by.signal_e_per_s;
    gradient.ambient_e_per_s[l] = by.ambient_e_per_s;
  }
  const Eigen::VectorXd& time_s = steps_->sampled.exposure_s();
  if (!steps_->has_shot()) by.of.signal += by.of.shot;
  Eigen::MatrixXd by_fine =
      pull_back_middles_and_slopes(by.of.signal, by.of.slope) * time_s.asDiagonal();
  if (steps_->has_shot()) {
    by_fine.conservativeResize(Eigen::NoChange, 2 * K);
    by.of.slope.setZero();
    by_fine.rightCols(K) =
        pull_back_middles_and_slopes(by.of.shot, by.of.slope) * time_s.asDiagonal();
  }
  steps_->pull_back_functions(steps_->between.pull_back_fine(by_fine, 2 * cells_per_bin),
                              gradient.table);
  gradient.table.ambient_gain +=
      time_s.cwiseProduct((information.ambient.array() != 0.0).select(by.of.ambient, 0.0));
  (steps_->has_shot() ? gradient.table.shot_ambient_gain : gradient.table.ambient_gain) +=
      time_s.cwiseProduct(by.of.shot_ambient);
  return gradient;
}

}  // namespace tofsmith
