// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/tile_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/shared/pixel_runs.hpp"
#include "decode/raw_scale.hpp"
#include "decode/search/direction_table.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/search/tile_projection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"
#include "decode/search/rows-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr int tile_pixels = pixels_per_tile;

/// Returns a b + c. For outputs it is rounded twice, with and without FMA instructions, for the
/// same result on every processor.
template <bool ForOutputs>
HWY_INLINE Vector product_plus(Vector a, Vector b, Vector c) {
  if constexpr (ForOutputs) return hn::Add(hn::Mul(a, b), c);
  return hn::MulAdd(a, b, c);
}
template <bool ForOutputs>
HWY_INLINE Vector minus_product(Vector a, Vector b, Vector c) {
  if constexpr (ForOutputs) return hn::Sub(c, hn::Mul(a, b));
  return hn::NegMulAdd(a, b, c);
}

template <int Rank, bool ForOutputs, int Count, typename Load>
HWY_INLINE void project_vector(const ProjectionView& view, const Load& load, Vector reference,
                               int pixel, PixelTile& tile) {
  const Floats d;
  const int count = Count > 0 ? Count : view.measurements;
  Vector q[Rank];
  for (int j = 0; j < Rank; ++j) q[j] = hn::Set(d, view.offset[j]);
  auto error = product_plus<ForOutputs>(hn::Abs(reference), hn::Set(d, view.error_of_reference),
                                        hn::Set(d, view.error_of_offset));
  for (int k = 0; k < count; ++k) {
    const auto difference =
        minus_product<ForOutputs>(reference, hn::Set(d, view.ratio[k]), load(k));
    error = product_plus<ForOutputs>(hn::Abs(difference), hn::Set(d, view.error_of_difference[k]),
                                     error);
    for (int j = 0; j < Rank; ++j)
      q[j] = product_plus<ForOutputs>(difference, hn::Set(d, view.weight[j * count + k]), q[j]);
  }
  for (int j = 0; j < Rank; ++j) hn::Store(q[j], d, tile.plane + j * tile_pixels + pixel);
  hn::Store(error, d, tile.error + pixel);
}

template <bool ForOutputs>
HWY_INLINE void project_any_rank(const ProjectionView& view, PixelTile& tile, int pixel) {
  const Floats d;
  const auto load = [&](int k) { return hn::Load(d, tile.raw + k * tile_pixels + pixel); };
  const auto reference = load(view.reference);
  auto error = product_plus<ForOutputs>(hn::Abs(reference), hn::Set(d, view.error_of_reference),
                                        hn::Set(d, view.error_of_offset));
  for (int j = 0; j < view.rank; ++j)
    hn::Store(hn::Set(d, view.offset[j]), d, tile.plane + j * tile_pixels + pixel);
  for (int k = 0; k < view.measurements; ++k) {
    const auto difference =
        minus_product<ForOutputs>(reference, hn::Set(d, view.ratio[k]), load(k));
    error = product_plus<ForOutputs>(hn::Abs(difference), hn::Set(d, view.error_of_difference[k]),
                                     error);
    for (int j = 0; j < view.rank; ++j) {
      float* const q = tile.plane + j * tile_pixels + pixel;
      const auto weight = hn::Set(d, view.weight[j * view.measurements + k]);
      hn::Store(product_plus<ForOutputs>(difference, weight, hn::Load(d, q)), d, q);
    }
  }
  hn::Store(error, d, tile.error + pixel);
}

template <int Measurements>
HWY_INLINE void load_interleaved(const float* raw, Vector* measured) {
  const Floats d;
  if (Measurements == 3)
    hn::LoadInterleaved3(d, raw, measured[0], measured[1], measured[2]);
  else
    hn::LoadInterleaved4(d, raw, measured[0], measured[1], measured[2], measured[3]);
}

template <int Rank, bool ForOutputs, int Measurements>
HWY_INLINE void project_interleaved(const ProjectionView& view, const float* raw, int vectors,
                                    PixelTile& tile) {
  const Floats d;
  const int lanes = lanes_of(d);
  for (int i = 0; i < vectors * lanes; i += lanes) {
    Vector measured[4];
    load_interleaved<Measurements>(raw + i * Measurements, measured);
    auto reference = measured[0];
    for (int k = 1; k < Measurements; ++k)
      if (view.reference == k) reference = measured[k];
    if (ForOutputs)
      for (int k = 0; k < Measurements; ++k)
        hn::Store(measured[k], d, tile.raw + k * tile_pixels + i);
    project_vector<Rank, ForOutputs, Measurements>(
        view, [&](int k) { return measured[k]; }, reference, i, tile);
  }
}

/// Projects interleaved pixels with K > 4 by four measurements at a time; the last ones may be
/// loaded twice.
template <int Rank, bool ForOutputs, int Count>
HWY_INLINE void project_strided(const ProjectionView& view, const float* raw, int vectors,
                                PixelTile& tile) {
  const Floats d;
  const int lanes = lanes_of(d);
  const int count = Count > 0 ? Count : view.measurements;
  for (int i = 0; i < vectors * lanes; i += lanes) {
    const float* const first = raw + static_cast<std::ptrdiff_t>(i) * count;
    Vector measured[Count > 0 ? Count : max_measurements];
    measured[0] = hn::Zero(d);  // compilers do not know that count > 4
    for (int k = 0; k < count; k += row_length) {
      const int from = k + row_length < count ? k : count - row_length;
      load_rows([&](int lane) { return first + lane * count + from; }, measured + from);
    }
    if (ForOutputs)
      for (int k = 0; k < count; ++k) hn::Store(measured[k], d, tile.raw + k * tile_pixels + i);
    auto reference = measured[0];
    for (int k = 1; k < count; ++k)
      if (view.reference == k) reference = measured[k];
    project_vector<Rank, ForOutputs, Count>(
        view, [&](int k) { return measured[k]; }, reference, i, tile);
  }
}

template <int Rank, bool ForOutputs>
HWY_INLINE void project_planes(const ProjectionView& view, const float* raw, std::ptrdiff_t stride,
                               int from, int to, PixelTile& tile) {
  const Floats d;
  const int lanes = lanes_of(d);
  for (int i = from; i < to; i += lanes) {
    const auto load = [&](int k) { return hn::LoadU(d, raw + k * stride + i); };
    project_vector<Rank, ForOutputs, 0>(view, load, load(view.reference), i, tile);
  }
}

/// Copies raw values to the tile, followed by zeros.
HWY_INLINE void fill_planes(const TileSource& source, int k_count, int from, int pixels, int padded,
                            PixelTile& tile) {
  for (int k = 0; k < k_count; ++k) {
    float* const raw = tile.raw + k * tile_pixels;
    if (source.data)
      for (int i = from; i < pixels; ++i)
        raw[i] = source.data[i * source.pixel_stride + k * source.measurement_stride];
    std::fill(raw + pixels, raw + padded, 0.0f);
  }
}

template <int Rank, bool ForOutputs>
void project_rank(const ProjectionView& view, const TileSource& source, int pixels,
                  PixelTile& tile) {
  const int lanes = lanes_of();
  const int k_count = view.measurements;
  int done = 0;
  if (source.data && source.pixel_stride == k_count && (k_count == 3 || k_count == 4)) {
    const int vectors = pixels / lanes;
    if (k_count == 3)
      project_interleaved<Rank, ForOutputs, 3>(view, source.data, vectors, tile);
    else
      project_interleaved<Rank, ForOutputs, 4>(view, source.data, vectors, tile);
    done = vectors * lanes;
  } else if (source.data && source.pixel_stride == k_count && k_count > row_length) {
    const int vectors = pixels / lanes;
    if (k_count == 5)
      project_strided<Rank, ForOutputs, 5>(view, source.data, vectors, tile);
    else if (k_count == 8)
      project_strided<Rank, ForOutputs, 8>(view, source.data, vectors, tile);
    else
      project_strided<Rank, ForOutputs, 0>(view, source.data, vectors, tile);
    done = vectors * lanes;
  } else if (source.data && source.pixel_stride == 1 && !ForOutputs) {
    done = pixels / lanes * lanes;
    project_planes<Rank, ForOutputs>(view, source.data, source.measurement_stride, 0, done, tile);
  }
  const int padded = whole_vectors(pixels);
  if (done == padded) return;
  fill_planes(source, k_count, done, pixels, padded, tile);
  project_planes<Rank, ForOutputs>(view, tile.raw, tile_pixels, done, padded, tile);
}

template <bool ForOutputs>
void project(const ProjectionView& view, const TileSource& source, int pixels, PixelTile& tile) {
  switch (view.rank) {
    case 2:
      return project_rank<2, ForOutputs>(view, source, pixels, tile);
    case 3:
      return project_rank<3, ForOutputs>(view, source, pixels, tile);
    case 4:
      return project_rank<4, ForOutputs>(view, source, pixels, tile);
    default:
      break;
  }
  const int lanes = lanes_of();
  const int padded = whole_vectors(pixels);
  fill_planes(source, view.measurements, 0, pixels, padded, tile);
  for (int i = 0; i < padded; i += lanes) project_any_rank<ForOutputs>(view, tile, i);
}

/// @param source  without data if the raw values are in the tile
void project_tile(const ProjectionView& view, const TileSource& source, int pixels,
                  bool for_outputs, PixelTile& tile) {
  if (for_outputs) return project<true>(view, source, pixels, tile);
  project<false>(view, source, pixels, tile);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(project_tile);

namespace {

constexpr double unit_roundoff = 0.5 * std::numeric_limits<float>::epsilon();
constexpr double safety = 1.02;  // terms of higher order

/// Returns a source without data if vector code cannot read it.
TileSource source_of(const RawView& view, std::int64_t first, int pixels) {
  const auto* data = std::get_if<const float*>(&view.data);
  if (!data || view.width == 0) return {};
  const std::int64_t row = first / view.width, column = first % view.width;
  const bool in_one_run =
      view.row_stride == view.width * view.column_stride || column + pixels <= view.width;
  const bool is_interleaved =
      view.measurement_stride == 1 && view.column_stride == view.measurements;
  const bool is_planar = view.column_stride == 1;
  if (!in_one_run || !(is_interleaved || is_planar)) return {};
  return {*data + row * view.row_stride + column * view.column_stride, view.column_stride,
          view.measurement_stride};
}

template <typename Use>
void for_each_number(const RawView& view, std::int64_t first, int pixels, const Use& use) {
  for_each_run(view, first, pixels, [&](const auto* from, std::int64_t length, std::int64_t done) {
    for (int k = 0; k < view.measurements; ++k) {
      const auto* number = from + k * view.measurement_stride;
      for (std::int64_t i = 0; i < length; ++i) use(number[i * view.column_stride], k, done + i);
    }
  });
}

void gather_tile(const RawView& view, std::int64_t first, int pixels, PixelTile& tile) {
  for_each_number(view, first, pixels, [&](auto number, int k, std::int64_t i) {
    tile.raw[k * pixels_per_tile + i] = static_cast<float>(number);
  });
}

}  // namespace

TileProjection::TileProjection(const DecodingTable& table, const AmbientProjection& projection,
                               double min_distance) {
  const int k_count = table.measurements(), rank = projection.rank();
  const RawScale scale(table);
  // In raw units: electrons = gain (raw - zero).
  Eigen::VectorXd gain(k_count), zero(k_count);
  for (int k = 0; k < k_count; ++k) {
    gain[k] = scale.electrons(1.0, k) - scale.electrons(0.0, k);
    zero[k] = -scale.electrons(0.0, k) / gain[k];
  }
  Eigen::MatrixXd weight = projection.basis.transpose() * gain.asDiagonal();
  const Eigen::VectorXd offset = -weight * zero;
  const Eigen::VectorXd ambient = projection.ambient.cwiseQuotient(gain);
  Eigen::Index reference = 0;
  const bool has_ambient = ambient.cwiseAbs().maxCoeff(&reference) > 0.0;
  const Eigen::RowVectorXd error_per_raw = safety * weight.colwise().norm();
  if (has_ambient) weight.col(reference).setZero();

  // The norm |P y'| is at most the sum of gain |difference| plus the part of unequal offsets.
  const double tie = 2 * tie_tolerance / min_distance;
  constexpr double least = max_proven_error / max_proven_residual;
  Eigen::VectorXd left = gain.cwiseProduct(zero);
  if (has_ambient) {
    const Eigen::VectorXd direction = projection.ambient.normalized();
    left -= direction.dot(left) * direction;
  }
  const auto with_ties = [&](double rounding, double residual) {
    return static_cast<float>(safety * std::max(rounding + tie * residual, least * residual));
  };

  double error_of_reference = 0.0;
  for (int k = 0; k < k_count; ++k) {
    const double ratio = has_ambient ? ambient[k] / ambient[reference] : 0.0;
    const bool is_one = std::abs(ratio - 1.0) < 1e-13;
    const double length = weight.col(k).norm();
    ratio_.push_back(is_one ? 1.0f : static_cast<float>(ratio));
    error_of_difference_.push_back(with_ties((k_count + 3) * unit_roundoff * length, gain[k]));
    error_per_rounding_.push_back(error_per_raw[k]);
    error_of_reference +=
        safety * length * (is_one ? std::abs(ratio - 1.0) : 2 * unit_roundoff * std::abs(ratio));
  }
  for (int j = 0; j < rank; ++j) {
    offset_.push_back(static_cast<float>(offset[j]));
    for (int k = 0; k < k_count; ++k) weight_.push_back(static_cast<float>(weight(j, k)));
  }
  // Only matters if products underflow.
  constexpr double smallest = 1e-35;
  view_ = {.measurements = k_count,
           .rank = rank,
           .reference = static_cast<int>(reference),
           .ratio = ratio_.data(),
           .weight = weight_.data(),
           .offset = offset_.data(),
           .error_of_difference = error_of_difference_.data(),
           .error_of_reference = static_cast<float>(error_of_reference),
           .error_of_offset =
               with_ties((k_count + 2) * unit_roundoff * offset.norm() + smallest, left.norm())};
}

void TileProjection::project(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
                             PixelTile& tile) const {
  tile.pixels = pixels;
  const TileSource source = source_of(view, first, pixels);
  if (!source.data) gather_tile(view, first, pixels, tile);
  HWY_DYNAMIC_DISPATCH(project_tile)(view_, source, pixels, for_outputs, tile);
  if (!std::holds_alternative<const double*>(view.data)) return;
  for_each_number(view, first, pixels, [&](auto number, int k, std::int64_t i) {
    const double rounding = static_cast<double>(number) - tile.raw[k * pixels_per_tile + i];
    tile.error[i] +=
        static_cast<float>(error_per_rounding_[static_cast<std::size_t>(k)] * std::abs(rounding));
  });
}

}  // namespace tofsmith
#endif
