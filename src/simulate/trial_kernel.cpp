// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/trial_kernel.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulate/trial_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway requires its own headers after foreach_target, and this file's header first.
#include <hwy/highway.h>

#include "decode/output/shared/output_vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

void place(const DepthSlices& slices, double rows, double rows_per_bin, int trials,
           TrialTile& tile) {
  const Doubles d;
  const hn::RebindToSigned<Doubles> di;
  const hn::RebindToUnsigned<Doubles> du;
  const hn::Rebind<std::uint32_t, Doubles> narrow;
  const hn::Rebind<std::int32_t, Doubles> narrow_i;
  const hn::Rebind<float, Doubles> narrow_f;
  const int lanes = lanes_of(d);
  const double bins_per_row = 1.0 / rows_per_bin;  // exact: a power of two
  const auto set = [&](double value) { return hn::Set(d, value); };
  const auto low_byte = hn::Set(narrow, 0xffu);
  const auto as_double = [&](auto words) {
    return hn::ConvertTo(d, hn::BitCast(di, hn::PromoteTo(du, words)));
  };
  auto number = hn::Add(as_double(hn::Iota(narrow, 0u)), set(static_cast<double>(slices.first)));
  for (int i = 0; i < trials; i += lanes) {
    const auto high = hn::And(hn::LoadU(narrow, tile.words + trials_per_tile + i), low_byte);
    const auto low = hn::And(hn::LoadU(narrow, tile.words + 3 * trials_per_tile + i), low_byte);
    const auto within =
        hn::Mul(hn::Add(as_double(hn::Or(hn::ShiftLeft<8>(high), low)), set(0.5)), set(0x1p-16));
    auto at = hn::Mul(hn::Add(number, within), set(slices.rows_per_trial));
    at = hn::Min(at, set(rows * (1.0 - 0x1p-50)));
    if (slices.on_bins) at = hn::Mul(hn::Floor(hn::Mul(at, set(bins_per_row))), set(rows_per_bin));
    const auto row = hn::Floor(at);
    hn::StoreU(hn::DemoteTo(narrow_i, row), narrow_i, tile.row + i);
    hn::StoreU(hn::DemoteTo(narrow_f, hn::Sub(at, row)), narrow_f, tile.share + i);
    hn::StoreU(hn::Mul(at, set(bins_per_row)), d, tile.true_bin + i);
    number = hn::Add(number, set(lanes));
  }
}

struct RecordChunk {
  alignas(64) std::uint32_t start[pixels_per_chunk];
  alignas(64) float fields[4 * max_measurements * pixels_per_chunk];

  HWY_INLINE void read(const TrialModel& model, const TrialTile& tile, int first, int trials) {
    const int lanes = lanes_of();
    const int count = model.taps() * (model.has_own_shot_noise() ? 4 : 2);
    find_rows(model.records(), tile.row + first, trials, start);
    for (int i = 0; i < trials; i += lanes)
      gather(model.records().data(), start + i, 0, count, fields + i);
  }
  HWY_INLINE Vector between(int f, int taps, Vector share, int i) const {
    return hn::MulAdd(share, load(fields + (f + taps) * pixels_per_chunk, i),
                      load(fields + f * pixels_per_chunk, i));
  }
};

/// Adds L times normals, with the covariance c = L L^T stored row by row; skips directions without
/// variance.
template <int Rank>
HWY_INLINE void add_noise(int rank, Vector* c, const float* normals, Vector* q) {
  const Floats d;
  Vector inverse[Rank];
  for (int j = 0; j < rank; ++j) {
    Vector* const row = c + j * (j + 1) / 2;
    const Vector whole = row[j];
    Vector rest = whole;
    for (int l = 0; l < j; ++l) {
      const Vector* const other = c + l * (l + 1) / 2;
      Vector sum = row[l];
      for (int m = 0; m < l; ++m) sum = hn::NegMulAdd(row[m], other[m], sum);
      row[l] = hn::Mul(sum, inverse[l]);
      rest = hn::NegMulAdd(row[l], row[l], rest);
    }
    const Mask is_seen = hn::Gt(rest, hn::MulAdd(whole, all(1e-6f), all(1e-30f)));
    inverse[j] = hn::IfThenElseZero(is_seen, reciprocal_sqrt(hn::Max(rest, all(1e-30f))));
    row[j] = hn::Mul(rest, inverse[j]);
    for (int l = 0; l <= j; ++l)
      q[j] = hn::MulAdd(row[l], hn::Load(d, normals + l * trials_per_tile), q[j]);
  }
}

/// `Rank` 0: known only at run time.
template <int Rank>
void plane_of_rank(const TrialModel& model, const PlaneNoise& noise, int trials, TrialTile& tile) {
  constexpr int max_rank = Rank > 0 ? Rank : max_measurements;
  const int rank = Rank > 0 ? Rank : noise.rank, pairs = rank * (rank + 1) / 2;
  const Floats d;
  const int taps = model.taps();
  const bool has_own = model.has_own_shot_noise();
  RecordChunk chunk;
  for (int first = 0; first < trials; first += pixels_per_chunk) {
    const int count = std::min(pixels_per_chunk, trials - first);
    chunk.read(model, tile, first, count);
    for (int i = 0; i < count; i += lanes_of(d)) {
      const Vector share = hn::Load(d, tile.share + first + i);
      const Vector signal = hn::Load(d, tile.signal + first + i);
      Vector q[max_rank], c[max_rank * (max_rank + 1) / 2];
      for (int j = 0; j < rank; ++j) q[j] = all(noise.offset[static_cast<std::size_t>(j)]);
      for (int p = 0; p < pairs; ++p) c[p] = all(noise.floor[static_cast<std::size_t>(p)]);
      const float* weight = noise.weight.data();
      const float* products = noise.products.data();
      for (int k = 0; k < taps; ++k, weight += rank, products += pairs) {
        const auto tap = static_cast<std::size_t>(k);
        Vector mean =
            hn::MulAdd(signal, chunk.between(k, taps, share, i), all(noise.mean_floor_e[tap]));
        Vector shot = mean;
        if (has_own)
          shot = hn::MulAdd(signal, chunk.between(2 * taps + k, taps, share, i),
                            all(noise.shot_floor_e2[tap]));
        else
          mean = hn::Max(mean, hn::Zero(d));
        shot = hn::Max(shot, hn::Zero(d));
        for (int j = 0; j < rank; ++j) q[j] = hn::MulAdd(mean, all(weight[j]), q[j]);
        for (int p = 0; p < pairs; ++p) c[p] = hn::MulAdd(shot, all(products[p]), c[p]);
      }
      add_noise<max_rank>(rank, c, tile.normals + first + i, q);
      for (int j = 0; j < rank; ++j)
        hn::Store(q[j], d, tile.pixels.plane + j * trials_per_tile + first + i);
    }
  }
}

void plane(const TrialModel& model, const PlaneNoise& noise, int trials, TrialTile& tile) {
  switch (noise.rank) {
    case 2:
      return plane_of_rank<2>(model, noise, trials, tile);
    case 3:
      return plane_of_rank<3>(model, noise, trials, tile);
    case 4:
      return plane_of_rank<4>(model, noise, trials, tile);
    case 5:
      return plane_of_rank<5>(model, noise, trials, tile);
    default:
      return plane_of_rank<0>(model, noise, trials, tile);
  }
}

/// For a mixer: means, followed by their shot noise.
void expect(const TrialModel& model, const float* mean_floor_e, const float* shot_floor_e2,
            int trials, TrialTile& tile) {
  const Floats d;
  RecordChunk chunk;
  const int taps = model.taps();
  const bool is_signed = model.conversion().is_signed;
  for (int first = 0; first < trials; first += pixels_per_chunk) {
    const int count = std::min(pixels_per_chunk, trials - first);
    chunk.read(model, tile, first, count);
    for (int i = 0; i < count; i += lanes_of(d)) {
      const Vector share = hn::Load(d, tile.share + first + i);
      const Vector signal = hn::Load(d, tile.signal + first + i);
      for (int k = 0; k < taps; ++k) {
        Vector mean = hn::MulAdd(signal, chunk.between(k, taps, share, i), all(mean_floor_e[k]));
        if (is_signed) {
          const Vector shot = hn::MulAdd(signal, chunk.between(2 * taps + k, taps, share, i),
                                         all(shot_floor_e2[k]));
          hn::Store(hn::Max(shot, hn::Zero(d)), d,
                    tile.taps + (taps + k) * trials_per_tile + first + i);
        } else {
          mean = hn::Max(mean, hn::Zero(d));
        }
        hn::Store(mean, d, tile.taps + k * trials_per_tile + first + i);
      }
    }
  }
}

void read_out(const TapConversion& sensor, const float* max_e, int taps, int trials,
              TrialTile& tile) {
  const Floats d;
  const Vector sigma = all(sensor.read_noise_e), min_dn = all(sensor.min_dn);
  const Vector sign = all(sensor.is_signed ? -1.0f : 0.0f);  // for the lower limits
  for (int i = 0; i < trials; i += lanes_of(d))
    for (int k = 0; k < taps; ++k) {
      float* const value = tile.taps + k * trials_per_tile + i;
      Vector e = hn::Load(d, value), deviation = sigma;
      if (!sensor.is_poisson) {
        const Vector shot = sensor.is_signed ? hn::Load(d, value + taps * trials_per_tile) : e;
        const Vector variance = hn::MulAdd(sigma, sigma, shot);
        deviation = hn::Mul(variance, reciprocal_sqrt(variance));
      }
      e = hn::MulAdd(deviation, hn::Load(d, tile.normals + k * trials_per_tile + i), e);
      if (max_e) e = hn::Min(hn::Max(e, hn::Mul(sign, all(max_e[k]))), all(max_e[k]));
      e = hn::Min(e, all(sensor.full_well_e));
      if (sensor.is_signed) e = hn::Max(e, all(-sensor.full_well_e));
      if (sensor.has_adc) {
        const Vector dn =
            hn::Round(hn::MulAdd(e, all(sensor.dn_per_e), all(sensor.black_level_dn)));
        e = hn::Min(hn::Max(dn, min_dn), all(sensor.max_dn));
      }
      hn::Store(e, d, value);
    }
  if (!sensor.is_difference) return;
  for (int k = 0; k < taps / 2; ++k)
    for (int i = 0; i < trials; i += lanes_of(d)) {
      const float* const pair = tile.taps + 2 * k * trials_per_tile + i;
      hn::Store(hn::Sub(hn::Load(d, pair), hn::Load(d, pair + trials_per_tile)), d,
                tile.taps + k * trials_per_tile + i);
    }
}

/// One pair per lane.
struct PairVectors {
  DoubleVector sum, squared_difference, squared_sum, squared_product;

  explicit PairVectors(DoubleVector zero)
      : sum(zero), squared_difference(zero), squared_sum(zero), squared_product(zero) {}

  HWY_INLINE void add(DoubleVector even, DoubleVector odd) {
    const DoubleVector difference = hn::Sub(even, odd), both = hn::Add(even, odd);
    const DoubleVector product = hn::Mul(difference, both);
    sum = hn::Add(sum, both);
    squared_difference = hn::MulAdd(difference, difference, squared_difference);
    squared_sum = hn::MulAdd(both, both, squared_sum);
    squared_product = hn::MulAdd(product, product, squared_product);
  }
  PairSums total() const {
    const Doubles d;
    const auto all_lanes = [&](DoubleVector v) { return sum_of_lanes(d, v); };
    return {all_lanes(sum), all_lanes(squared_difference), all_lanes(squared_sum),
            all_lanes(squared_product)};
  }
};

PairSums pair(double a, double b) {
  const double difference = a - b, both = a + b, product = difference * both;
  return {both, difference * difference, both * both, product * product};
}

TileSums sums(const double* true_bin, const double* decoded_bin, int trials, double samples,
              double threshold_bin) {
  const Doubles d;
  const int lanes = lanes_of(d);
  const DoubleVector zero = hn::Zero(d), all_samples = hn::Set(d, samples);
  const DoubleVector threshold = hn::Set(d, threshold_bin), one = hn::Set(d, 1.0);
  PairVectors linear(zero), circular(zero);
  DoubleVector outliers = zero, outlier_squares = zero;
  const auto add = [&](DoubleVector even, DoubleVector odd) {
    const DoubleVector even_c = hn::Min(even, hn::Sub(all_samples, even));
    const DoubleVector odd_c = hn::Min(odd, hn::Sub(all_samples, odd));
    linear.add(even, odd);
    circular.add(even_c, odd_c);
    const DoubleVector even_o = hn::IfThenElseZero(hn::Gt(even_c, threshold), one);
    const DoubleVector odd_o = hn::IfThenElseZero(hn::Gt(odd_c, threshold), one);
    const DoubleVector difference = hn::Sub(even_o, odd_o);
    outliers = hn::Add(outliers, hn::Add(even_o, odd_o));
    outlier_squares = hn::MulAdd(difference, difference, outlier_squares);
  };
  int i = 0;
  for (; i + 2 * lanes <= trials; i += 2 * lanes) {
    DoubleVector true_even, true_odd, found_even, found_odd;
    hn::LoadInterleaved2(d, true_bin + i, true_even, true_odd);
    hn::LoadInterleaved2(d, decoded_bin + i, found_even, found_odd);
    add(hn::Abs(hn::Sub(found_even, true_even)), hn::Abs(hn::Sub(found_odd, true_odd)));
  }
  TileSums total{linear.total(), circular.total(), sum_of_lanes(d, outliers),
                 sum_of_lanes(d, outlier_squares)};
  for (; i + 1 < trials; i += 2) {
    const double a = std::abs(decoded_bin[i] - true_bin[i]);
    const double b = std::abs(decoded_bin[i + 1] - true_bin[i + 1]);
    const double a_c = std::min(a, samples - a), b_c = std::min(b, samples - b);
    const double a_o = a_c > threshold_bin ? 1.0 : 0.0, b_o = b_c > threshold_bin ? 1.0 : 0.0;
    total.merge({pair(a, b), pair(a_c, b_c), a_o + b_o, (a_o - b_o) * (a_o - b_o)});
  }
  return total;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(place);
HWY_EXPORT(plane);
HWY_EXPORT(expect);
HWY_EXPORT(read_out);
HWY_EXPORT(sums);

void PairSums::merge(const PairSums& other) {
  sum += other.sum;
  squared_difference += other.squared_difference;
  squared_sum += other.squared_sum;
  squared_product += other.squared_product;
}

void TileSums::merge(const TileSums& other) {
  linear.merge(other.linear);
  circular.merge(other.circular);
  outliers += other.outliers;
  outlier_squared_difference += other.outlier_squared_difference;
}

PlaneNoise::PlaneNoise(const TrialModel& model, const PlaneMap& map, double ambient_e_per_s)
    : rank(static_cast<int>(map.weight.rows())),
      mean_floor_e(in_floats(model.mean_floor_e(ambient_e_per_s))),
      shot_floor_e2(in_floats(model.shot_floor_e2(ambient_e_per_s))),
      offset(in_floats(map.weight * model.raw_at_zero() + map.offset)) {
  const Eigen::MatrixXd per_e = map.weight * model.raw_per_e();  // (rank, taps)
  for (int k = 0; k < model.taps(); ++k) {
    for (int j = 0; j < rank; ++j) weight.push_back(static_cast<float>(per_e(j, k)));
    for (int j = 0; j < rank; ++j)
      for (int l = 0; l <= j; ++l)
        products.push_back(static_cast<float>(per_e(j, k) * per_e(l, k)));
  }
  const Eigen::MatrixXd constant =
      per_e * model.constant_variance_e2().asDiagonal() * per_e.transpose();
  for (int j = 0; j < rank; ++j)
    for (int l = 0; l <= j; ++l) floor.push_back(static_cast<float>(constant(j, l)));
}

void place_depths(const TrialModel& model, const DepthSlices& slices, int trials, TrialTile& tile) {
  HWY_DYNAMIC_DISPATCH(place)
  (slices, static_cast<double>(model.rows()), model.rows_per_bin(), trials, tile);
}

void draw_plane(const TrialModel& model, const PlaneNoise& noise, int trials, TrialTile& tile) {
  HWY_DYNAMIC_DISPATCH(plane)(model, noise, trials, tile);
}

void expect_electrons(const TrialModel& model, const std::vector<float>& mean_floor_e,
                      const std::vector<float>& shot_floor_e2, int trials, TrialTile& tile) {
  HWY_DYNAMIC_DISPATCH(expect)
  (model, mean_floor_e.data(), shot_floor_e2.data(), trials, tile);
}

void read_out_taps(const TrialModel& model, const std::vector<float>& max_e, int trials,
                   TrialTile& tile) {
  HWY_DYNAMIC_DISPATCH(read_out)
  (model.conversion(), max_e.empty() ? nullptr : max_e.data(), model.taps(), trials, tile);
}

TileSums sum_errors(const double* true_bin, const double* decoded_bin, int trials, double samples,
                    double threshold_bin) {
  return HWY_DYNAMIC_DISPATCH(sums)(true_bin, decoded_bin, trials, samples, threshold_bin);
}

}  // namespace tofsmith
#endif
