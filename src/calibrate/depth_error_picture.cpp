// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/depth_error_picture.hpp"

#include <cmath>

namespace tofsmith {

namespace {

struct CellMeans {
  explicit CellMeans(std::size_t cells) : sum(cells), weight(cells) {}

  void add(std::size_t cell, double value, double w) {
    sum[cell] += w * value;
    weight[cell] += w;
  }
  double of(std::size_t cell) const { return sum[cell] / weight[cell]; }  // NaN for empty cells

  std::vector<double> sum, weight;
};

}  // namespace

DepthErrorPicture picture_of(const DepthFit& fit, const Eigen::VectorXd& fitted_m,
                             double offset_m) {
  constexpr std::size_t parts = 128;
  constexpr int cells_along = 160;
  const int side = std::max(1, (std::max(fit.height, fit.width) + cells_along - 1) / cells_along);
  const int rows = (fit.height + side - 1) / side, columns = (fit.width + side - 1) / side;
  CellMeans part_before(parts), part_after(parts);
  CellMeans cell_before(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)),
      cell_after = cell_before;
  for (Eigen::Index i = 0; i < fit.size(); ++i) {
    const ReferenceSample& s = fit.samples[static_cast<std::size_t>(i)];
    const double before_m = fit.error_m[i] - offset_m, after_m = fit.error_m[i] - fitted_m[i];
    const double share = s.depth_m / fit.range_m - std::floor(s.depth_m / fit.range_m);
    const auto part = std::min(parts - 1, static_cast<std::size_t>(share * parts));
    const auto cell = static_cast<std::size_t>(s.row / side) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(s.column / side);
    part_before.add(part, before_m, fit.weight[i]);
    part_after.add(part, after_m, fit.weight[i]);
    cell_before.add(cell, before_m, fit.weight[i]);
    cell_after.add(cell, after_m, fit.weight[i]);
  }
  DepthErrorPicture picture{.before_image_m = Image<float>(rows, columns),
                            .after_image_m = Image<float>(rows, columns)};
  for (std::size_t p = 0; p < parts; ++p) {
    picture.depth_m.push_back(fit.range_m * (static_cast<double>(p) + 0.5) / parts);
    picture.before_m.push_back(part_before.of(p));
    picture.after_m.push_back(part_after.of(p));
  }
  for (std::size_t c = 0; c < picture.before_image_m.size(); ++c) {
    picture.before_image_m.pixels[c] = static_cast<float>(cell_before.of(c));
    picture.after_image_m.pixels[c] = static_cast<float>(cell_after.of(c));
  }
  return picture;
}

}  // namespace tofsmith
