// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/filter_plan.hpp"

#include <algorithm>
#include <array>

#include "core/shared/decompositions.hpp"
#include "core/shared/pixel_runs.hpp"
#include "decode/shared/marked_raw.hpp"

namespace tofsmith {

namespace {

constexpr int pixels_per_block = 256;

struct RowBlock {
  alignas(64) std::array<float, max_measurements * pixels_per_block> values;

  float* operator[](int k) { return values.data() + k * pixels_per_block; }
};

template <typename Work>
void for_each_block_of_row(int width, const Work& work) {
  for (int first = 0; first < width; first += pixels_per_block)
    work(first, std::min(pixels_per_block, width - first));
}

/// out[i] = sum_k matrix[k] in_k[i].
template <typename In>
void mix(const float* matrix, int count, const In& in, int pixels, float* out) {
  std::fill_n(out, pixels, 0.0f);
  for (int k = 0; k < count; ++k) {
    const float by = matrix[k];
    const float* const values = in(k);
    for (int i = 0; i < pixels; ++i) out[i] += by * values[i];
  }
}

/// Returns a basis of the decoding subspace followed by its complement (K, K).
Eigen::MatrixXd whole_basis(const Eigen::MatrixXd& plane) {
  const Eigen::Index k = plane.rows(), rank = plane.cols();
  Eigen::MatrixXd basis(k, k);
  basis.leftCols(rank) = plane;
  if (rank < k)
    basis.rightCols(k - rank) =
        thin_svd(Eigen::MatrixXd::Identity(k, k) - plane * plane.transpose()).u.leftCols(k - rank);
  return basis;
}

std::vector<float> curve_squares(const Eigen::MatrixXd& curve) {
  std::vector<float> squares;
  for (Eigen::Index n = 0; n < curve.rows(); ++n) {
    const Eigen::VectorXd here = curve.row(n);
    const Eigen::VectorXd on = curve.row((n + 1) % curve.rows()).transpose() - here;
    const double along = on.dot(here), length2 = std::max(here.squaredNorm(), 1e-300);
    const double turn2 = std::max(0.0, on.squaredNorm() - along * along / length2);
    squares.push_back(static_cast<float>(turn2));
    squares.push_back(static_cast<float>(length2));
  }
  return squares;
}

std::vector<float> row_by_row(const RowMajorMatrix& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

const float* averaged_of(const RawView& raw, int row, int column) {
  return raw.averaged ? raw.averaged + std::ptrdiff_t{row} * raw.width + column : nullptr;
}

void find_variance(const Filter::Plan& plan, RowBlock& electrons, int pixels, float* variance) {
  std::fill_n(variance, pixels, plan.hidden.floor_variance_e2);
  for (int k = 0; k < plan.measurements; ++k) {
    const float by = plan.hidden.shot_share[static_cast<std::size_t>(k)];
    const float* const values = electrons[k];
    for (int i = 0; i < pixels; ++i) variance[i] += by * std::max(values[i], 0.0f);
  }
}

}  // namespace

int window_step(int window) { return window == 0 ? 1 : window_side * window_step(window - 1); }

WindowVariances::WindowVariances(int window)
    : in(window == 0       ? FilterPlanes::variance
         : window % 2 == 1 ? FilterPlanes::variance_next
                           : FilterPlanes::variance_last),
      out(window % 2 == 0 ? FilterPlanes::variance_next : FilterPlanes::variance_last) {}

Filter::Plan::Plan(DecodingTable table, const FilterOptions& options_,
                   const AmbientProjection& projection)
    : options(options_),
      decoder(std::move(table)),
      scale(decoder.table()),
      measurements(decoder.measurements()),
      rank(projection.rank()),
      hidden(ExpectedNoise(decoder.table()), projection),
      has_own_shot_noise(decoder.table().shot_correlation.size() > 0) {
  const Eigen::MatrixXd basis = whole_basis(projection.basis);
  to_measurements = row_by_row(basis);
  to_coordinates = row_by_row(basis.transpose());
  RowMajorMatrix points = projection.gated * basis;
  points.leftCols(rank) = projection.curve;
  curve = row_by_row(points);
  squares = curve_squares(projection.curve);
}

void Filter::Plan::read(const RawView& raw, FilterPlanes& frame) const {
  for_each_row(frame, [&](int row) {
    const std::ptrdiff_t at = row * frame.grid.stride;
    read_row(raw, frame, row, 0, frame.scalar(FilterPlanes::usable) + at,
             frame.scalar(FilterPlanes::variance) + at);
  });
  if (has_own_shot_noise) for_each_row(frame, [&](int row) { find_hidden_noise(raw, frame, row); });
}

void Filter::Plan::read_again(const RawView& raw, FilterPlanes& frame, int set,
                              FilterPlanes::Scalar usable) const {
  for_each_row(frame, [&](int row) {
    read_row(raw, frame, row, set, frame.scalar(usable) + row * frame.grid.stride, nullptr);
  });
}

void Filter::Plan::read_row(const RawView& raw, FilterPlanes& frame, int row, int set,
                            float* row_usable, float* row_variance) const {
  const SaturationLevels levels(decoder.table());
  for_each_block_of_row(raw.width, [&](int first, int pixels) {
    const std::ptrdiff_t at = row * frame.grid.stride + first;
    float* const usable = row_usable + first;
    const float* const averaged = averaged_of(raw, row, first);
    for (int i = 0; i < pixels; ++i) usable[i] = !averaged || averaged[i] > 0.0f ? 1.0f : 0.0f;
    RowBlock electrons;
    for_each_run(
        raw, std::int64_t{row} * raw.width + first, pixels,
        [&](const auto* pixel, std::int64_t length, std::int64_t) {
          for (int k = 0; k < measurements; ++k) {
            const auto* number = pixel + k * raw.measurement_stride;
            float* const e = electrons[k];
            const auto dark = static_cast<float>(scale.electrons(0.0, k));
            const auto gain = static_cast<float>(scale.electrons(1.0, k) - scale.electrons(0.0, k));
            for (std::int64_t i = 0; i < length; ++i, number += raw.column_stride) {
              const auto value = static_cast<float>(*number);
              usable[i] = value < levels.highest && value > levels.lowest ? usable[i] : 0.0f;
              e[i] = value * gain + dark;
            }
          }
        });
    if (frame.left_out) {
      const std::uint8_t* const left_out = frame.left_out + std::ptrdiff_t{row} * raw.width + first;
      for (int i = 0; i < pixels; ++i)
        if (left_out[i] != 0) usable[i] = 0.0f;
    }
    for (int i = 0; i < pixels; ++i)
      if (!(usable[i] > 0.0f))
        for (int k = 0; k < measurements; ++k) electrons[k][i] = 0.0f;
    if (row_variance) {
      float* const variance = row_variance + first;
      find_variance(*this, electrons, pixels, variance);
      if (averaged)
        for (int i = 0; i < pixels; ++i)
          if (usable[i] > 0.0f) variance[i] /= averaged[i];
    }
    for (int j = 0; j < measurements; ++j)
      mix(
          to_coordinates.data() + j * measurements, measurements,
          [&](int k) { return electrons[k]; }, pixels, frame.light(set, j) + at);
  });
}

void Filter::Plan::find_hidden_noise(const RawView& raw, FilterPlanes& frame, int row) const {
  const FilterGrid& grid = frame.grid;
  const float* const averaged = averaged_of(raw, row, 0);
  for (int x = 0; x < grid.width; ++x) {
    float squares = 0.0f, count = 0.0f;
    for (int dy = -patch_reach; dy <= patch_reach; ++dy)
      for (int dx = -patch_reach; dx <= patch_reach; ++dx) {
        const std::ptrdiff_t at = (row + dy) * grid.stride + x + dx;
        count += frame.scalar(FilterPlanes::usable)[at];
        for (int j = 0; j < rank; ++j) squares += frame.light(0, j)[at] * frame.light(0, j)[at];
      }
    if (!(count > 0.0f)) continue;
    const float n = averaged && averaged[x] > 0.0f ? averaged[x] : 1.0f;
    frame.scalar(FilterPlanes::variance)[row * grid.stride + x] =
        (hidden.floor_variance_e2 + hidden.of(squares / count, n) * hidden.shot_per_signal) / n;
  }
}

WeightedSums Filter::Plan::sums_of(FilterPlanes& frame, int from, int to, int window) const {
  WeightedSums sums;
  sums.planes = measurements;
  frame.list_light(from, measurements, sums.in);
  frame.list_light(to, measurements, sums.out);
  const WindowVariances variances(window);
  sums.variance = frame.scalar(variances.in);
  sums.variance_out = frame.scalar(variances.out);
  return sums;
}

NearAndFar Filter::Plan::near_and_far(FilterPlanes& frame, int near, int far, int window) const {
  const WindowVariances variances(window);
  NearAndFar sums{.planes = measurements,
                  .rank = rank,
                  .usable = frame.scalar(FilterPlanes::usable),
                  .depth = frame.scalar(FilterPlanes::depth),
                  .near_variance = frame.scalar(variances.in),
                  .far_variance = frame.scalar(variances.out),
                  .difference = frame.scalar(FilterPlanes::shift),
                  .kept = frame.scalar(FilterPlanes::signal)};
  frame.list_light(near, measurements, sums.near);
  frame.list_light(far, measurements, sums.far);
  return sums;
}

void Filter::Plan::add_similar(FilterPlanes& frame, int from, int to, int window) const {
  SimilarityTest test{.rank = rank,
                      .energy = frame.scalar(FilterPlanes::energy),
                      .inverse_sigma = frame.scalar(FilterPlanes::inverse_sigma),
                      .usable = frame.scalar(FilterPlanes::usable),
                      .patch_reach = window == 0 ? patch_reach : patch_reach - 1,
                      .max_difference_sigma = static_cast<float>(options.max_difference_sigma)};
  frame.list_light(from, rank, test.u);
  const auto floor_share = static_cast<float>(1.0 / options.trusted_pixels);
  for_each_row(frame, [&](int row) {
    find_energy(test, frame.scalar(WindowVariances(window).in),
                frame.scalar(FilterPlanes::variance), window == 0 ? 0.0f : floor_share, frame.grid,
                row, frame.scalar(FilterPlanes::energy), frame.scalar(FilterPlanes::inverse_sigma));
  });
  WeightedSums sums = sums_of(frame, from, to, window);
  sums.bias = bias_of(window);
  for_each_strip(frame, window_step(window), false,
                 [&](const FilterStrip& strip, const PairWeights& weights) {
                   weigh_similar(test, frame.grid, strip, weights);
                   for (int r = 0; r < strip.rows; ++r)
                     add_weighted(sums, frame.grid, strip, weights, r);
                 });
  if (window > 0 && options.slope_rounds > 0) {
    const NearAndFar both = near_and_far(frame, from, to, window);
    for_each_row(frame, [&](int row) { keep_bright(both, frame.grid, row); });
  }
}

void Filter::Plan::write_raw_row(const RawView& raw, FilterPlanes& frame, int from, int to, int row,
                                 float* averaged) const {
  const std::ptrdiff_t start = row * frame.grid.stride;
  const float* const usable = frame.scalar(FilterPlanes::usable) + start;
  const float* const single = frame.scalar(FilterPlanes::variance) + start;
  const float* const left = frame.scalar(last_variance()) + start;
  for_each_block_of_row(frame.grid.width, [&](int first, int pixels) {
    const std::ptrdiff_t at = start + first;
    RowBlock electrons;
    for (int k = 0; k < measurements; ++k)
      mix(
          to_measurements.data() + k * measurements, measurements,
          [&](int j) { return frame.light(from, j) + at; }, pixels, electrons[k]);
    for (int k = 0; k < measurements; ++k) {
      const auto dark = static_cast<float>(scale.raw(0.0, k));
      const auto per_electron = static_cast<float>(scale.raw(1.0, k) - scale.raw(0.0, k));
      float* const numbers = frame.light(to, k) + at;
      for (int i = 0; i < pixels; ++i) numbers[i] = electrons[k][i] * per_electron + dark;
    }
    float* const n = averaged + first;
    if (has_own_shot_noise) {
      const float* const measured = averaged_of(raw, row, first);
      for (int i = 0; i < pixels; ++i) n[i] = single[first + i] * (measured ? measured[i] : 1.0f);
    } else {
      find_variance(*this, electrons, pixels, n);
    }
    for (int i = 0; i < pixels; ++i)
      n[i] = usable[first + i] > 0.0f ? std::max(n[i] / left[first + i], 1e-3f) : 1.0f;
  });
}

OwnLightTest Filter::Plan::own_light_test(FilterPlanes& frame, int added, int measured) const {
  OwnLightTest test{.rank = rank,
                    .usable = frame.scalar(FilterPlanes::usable),
                    .variance = frame.scalar(FilterPlanes::variance),
                    .limit_sigma = static_cast<float>(options.own_light_sigma)};
  frame.list_light(added, rank, test.added);
  frame.list_light(measured, rank, test.measured);
  return test;
}

void Filter::Plan::leave_dark(const RawView& raw, FilterPlanes& frame, int set, int other) const {
  read_again(raw, frame, other, FilterPlanes::usable);
  const OwnLightTest test = own_light_test(frame, set, other);
  const float* const is_own = frame.scalar(FilterPlanes::signal);
  for_each_row(frame, [&](int row) {
    find_own_light(test, frame.grid, row,
                   frame.scalar(FilterPlanes::signal) + row * frame.grid.stride);
  });
  for_each_row(frame, [&](int row) {
    const std::ptrdiff_t start = row * frame.grid.stride;
    std::copy_n(is_own + start, frame.grid.width, frame.scalar(FilterPlanes::usable) + start);
  });
}

void Filter::Plan::write_deviation_factors(FilterPlanes& frame, int row,
                                           const float* is_filtered) const {
  const std::ptrdiff_t at = row * frame.grid.stride;
  const float* const rejected = frame.scalar(FilterPlanes::rejected) + at;
  const float* const single = frame.scalar(FilterPlanes::variance) + at;
  const float* const left = frame.scalar(last_variance()) + at;
  float* const factor = &frame.deviation_factor(row, 0);
  for (int x = 0; x < frame.grid.width; ++x)
    factor[x] =
        is_filtered[x] > 0.0f ? tofsmith::deviation_factor(rejected[x], single[x] / left[x]) : 1.0f;
}

void Filter::Plan::finish(const RawView& raw, FilterPlanes& frame, int set, int other) const {
  read_again(raw, frame, other, FilterPlanes::usable);
  const OwnLightTest test = own_light_test(frame, set, other);
  float* const amplitude = frame.scalar(FilterPlanes::signal_next);
  for_each_row(frame, [&](int row) {
    float* const here = amplitude + row * frame.grid.stride;
    find_own_amplitude(test, frame.scalar(last_variance()), frame.grid, row, here);
    std::fill(here + frame.grid.width, here + frame.grid.stride, 0.0f);
  });
  const LitTest lit{
      .light = &test,
      .amplitude = amplitude,
      .variance = frame.scalar(last_variance()),
      .rejected = options.slope_rounds > 0 ? frame.scalar(FilterPlanes::rejected) : nullptr,
      .bar_sigma = lit_bar_sigma(),
      .points = frame.lit_points.data()};
  for_each_row(frame, [&](int row) {
    const std::ptrdiff_t start = row * frame.grid.stride;
    float* const is_filtered = frame.scalar(FilterPlanes::signal) + start;
    float* const share = frame.scalar(FilterPlanes::shift) + start;
    find_own_light(test, frame.grid, row, is_filtered);
    find_lit_share(lit, frame.grid, row, share);
    float* const averaged = &frame.averaged(row, 0);
    write_raw_row(raw, frame, set, set, row, averaged);
    for (int x = 0; x < frame.grid.width; ++x) averaged[x] *= share[x];
    if (options.slope_rounds > 0) write_deviation_factors(frame, row, is_filtered);
    const float* const measured = averaged_of(raw, row, 0);
    for_each_run(raw, std::int64_t{row} * raw.width, raw.width,
                 [&](const auto* pixel, std::int64_t length, std::int64_t) {
                   for (std::int64_t x = 0; x < length; ++x, pixel += raw.column_stride) {
                     if (is_filtered[x] > 0.0f) continue;
                     averaged[x] = measured ? measured[x] : 1.0f;
                     for (int k = 0; k < measurements; ++k)
                       frame.light(set, k)[start + x] =
                           static_cast<float>(pixel[k * raw.measurement_stride]);
                   }
                 });
  });
}

}  // namespace tofsmith
