// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "camera/shared/ambient_leak.hpp"
#include "design/gradients/depth_elimination.hpp"
#include "design/gradients/gradient_steps.hpp"
#include "simulate/shared/depth_information.hpp"

namespace tofsmith {

namespace {

void round_up(Eigen::MatrixXd& table) {
  const Eigen::Index depths = table.rows();
  const Eigen::Index rows = (depths + depth_block - 1) / depth_block * depth_block;
  if (rows == depths) return;
  table.conservativeResize(rows, Eigen::NoChange);
  table.bottomRows(rows - depths).setZero();
}

DepthElectrons electrons_of(const CodeGradients::Steps& steps, const MeasurementTable& table) {
  const Eigen::MatrixXd fine =
      steps.between.fine_table(steps.functions_of(table), 2 * cells_per_bin);
  const Eigen::VectorXd& time_s = steps.sampled.exposure_s();
  const Eigen::Index K = time_s.size();
  DepthElectrons electrons;
  middles_and_slopes(fine.leftCols(K) * time_s.asDiagonal(), electrons.signal, electrons.slope);
  electrons.shot = electrons.signal;
  if (steps.has_shot()) {
    Eigen::MatrixXd unused;
    middles_and_slopes(fine.rightCols(K) * time_s.asDiagonal(), electrons.shot, unused);
  }
  electrons.shot_ambient = time_s.cwiseProduct(table.shot_ambient());
  electrons.ambient = time_s.cwiseProduct(table.ambient_gain);
  const double brightest = brightest_ambient_e_per_s(steps.camera);
  if (ambient_cancels(steps.camera, brightest * electrons.ambient,
                      steps.sampled.constant_variance_e2() + brightest * electrons.shot_ambient))
    electrons.ambient.setZero();
  electrons.ambient = (electrons.ambient.array().abs() > 1e-9 * electrons.shot_ambient.array())
                          .select(electrons.ambient, 0.0);
  for (Eigen::MatrixXd* of : {&electrons.signal, &electrons.slope, &electrons.shot}) round_up(*of);
  return electrons;
}

}  // namespace

Eigen::MatrixXd CodeGradients::depth_deviation_m(const MeasurementTable& table,
                                                 std::span<const OperatingPoint> points) const {
  Eigen::MatrixXd deviation_m;
  eliminate_light(electrons_of(*steps_, table), steps_->sampled.constant_variance_e2(), points,
                  steps_->camera.range_m(), deviation_m);
  const Eigen::Index depths = cells_per_bin * table.samples();
  if (deviation_m.rows() > depths) deviation_m.conservativeResize(depths, Eigen::NoChange);
  return deviation_m;
}

PixelGradient CodeGradients::pull_back_depth_deviation(const MeasurementTable& table,
                                                       std::span<const OperatingPoint> points,
                                                       const Eigen::MatrixXd& by_deviation) const {
  const DepthElectrons electrons = electrons_of(*steps_, table);
  const Eigen::Index K = electrons.signal.cols(), depths = cells_per_bin * table.samples();
  const auto lights = static_cast<Eigen::Index>(points.size());
  PixelGradient gradient{
      zeros_like(table), {}, Eigen::VectorXd::Zero(lights), Eigen::VectorXd::Zero(lights)};
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(electrons.signal.rows(), K);
  DepthElectrons by{none, none, none, Eigen::VectorXd::Zero(K), Eigen::VectorXd::Zero(K)};
  Eigen::MatrixXd weights = by_deviation;
  round_up(weights);
  std::vector<OperatingPoint> by_points(points.size());
  pull_back_elimination(electrons, steps_->sampled.constant_variance_e2(), points,
                        steps_->camera.range_m(), weights, by, by_points);
  for (Eigen::Index l = 0; l < lights; ++l) {
    gradient.signal_e_per_s[l] = by_points[static_cast<std::size_t>(l)].signal_e_per_s;
    gradient.ambient_e_per_s[l] = by_points[static_cast<std::size_t>(l)].ambient_e_per_s;
  }
  for (Eigen::MatrixXd* of : {&by.signal, &by.slope, &by.shot})
    of->conservativeResize(depths, Eigen::NoChange);
  const Eigen::VectorXd& time_s = steps_->sampled.exposure_s();
  if (!steps_->has_shot()) by.signal += by.shot;
  Eigen::MatrixXd by_fine = pull_back_middles_and_slopes(by.signal, by.slope) * time_s.asDiagonal();
  if (steps_->has_shot()) {
    by_fine.conservativeResize(Eigen::NoChange, 2 * K);
    by.slope.setZero();
    by_fine.rightCols(K) = pull_back_middles_and_slopes(by.shot, by.slope) * time_s.asDiagonal();
  }
  steps_->pull_back_functions(steps_->between.pull_back_fine(by_fine, 2 * cells_per_bin),
                              gradient.table);
  gradient.table.ambient_gain +=
      time_s.cwiseProduct((electrons.ambient.array() != 0.0).select(by.ambient, 0.0));
  (steps_->has_shot() ? gradient.table.shot_ambient_gain : gradient.table.ambient_gain) +=
      time_s.cwiseProduct(by.shot_ambient);
  return gradient;
}

}  // namespace tofsmith
