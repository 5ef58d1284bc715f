// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/circle_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decode/search/circle_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/shared/vectors-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace {

constexpr float farthest = 1e30f;  // sums of larger numbers may overflow

bool search(const CirclePiece* pieces, int resolution, float margin, PixelTile& tile) {
  const Floats d;
  const Indices di;
  const hn::RebindToUnsigned<decltype(d)> dw;
  const int lanes = lanes_of(d);
  const auto half = hn::Set(d, 0.5f * static_cast<float>(resolution));
  const auto zero = hn::Zero(di), last = hn::Set(di, resolution - 1);
  const auto* words = reinterpret_cast<const std::int32_t*>(pieces);
  auto all_sure = hn::MaskFromVec(hn::Set(di, -1));
  for (int i = 0; i < tile.pixels; i += lanes) {
    const auto x = hn::Load(d, tile.plane + i), y = hn::Load(d, tile.plane + pixels_per_tile + i);
    const auto error = hn::Load(d, tile.error + i);
    const auto is_steep = hn::Gt(hn::Abs(y), hn::Abs(x));
    const auto larger = hn::IfThenElse(is_steep, y, x);
    const auto c = hn::Div(hn::IfThenElse(is_steep, x, y), hn::Abs(larger));
    // NaN also maps to a valid piece.
    const auto within = hn::Min(hn::Max(hn::ConvertTo(di, hn::MulAdd(c, half, half)), zero), last);
    const auto is_negative = hn::BitCast(di, hn::ShiftRight<31>(hn::BitCast(dw, larger)));
    const auto side =
        hn::Add(hn::IfThenElseZero(hn::RebindMask(di, is_steep), hn::Set(di, 2)), is_negative);
    const auto at = hn::Add(hn::Mul(side, hn::Set(di, resolution)), within);
    const auto border = hn::BitCast(d, hn::GatherIndex(di, words, hn::Add(at, at)));
    const auto bins = hn::GatherIndex(di, words + 1, hn::Add(at, at));

    const auto excess = hn::Sub(c, border);
    // An error of q changes c by at most twice the error / |larger|.
    const auto least = hn::Add(hn::Set(d, margin), hn::Div(hn::Add(error, error), hn::Abs(larger)));
    const auto is_near = hn::And(hn::Lt(least, hn::Set(d, CirclePiece::overlap)),
                                 hn::Lt(hn::Abs(larger), hn::Set(d, farthest)));
    const auto is_sure = hn::RebindMask(di, hn::And(hn::Gt(hn::Abs(excess), least), is_near));
    const auto above = hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(dw, bins)));
    const auto below = hn::And(bins, hn::Set(di, 0xffff));
    const auto bin = hn::IfThenElse(hn::RebindMask(di, hn::Gt(excess, hn::Zero(d))), above, below);
    hn::Store(hn::IfThenElse(is_sure, bin, hn::Set(di, -1)), di, tile.bin + i);
    all_sure = hn::And(all_sure, is_sure);
  }
  return hn::AllTrue(di, all_sure);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

HWY_EXPORT(search);

namespace {

constexpr double pi = std::numbers::pi;
// Rounding of c and of the border, and the overlap of pieces.
constexpr double rounding = 4 * 0.5 * std::numeric_limits<float>::epsilon();

double angle_at(int side, double c) {
  const double larger = side % 2 != 0 ? -1.0 : 1.0;
  return side < 2 ? std::atan2(c, larger) : std::atan2(larger, c);
}

double c_at(int side, double angle) {
  return side < 2 ? std::sin(angle) / std::abs(std::cos(angle))
                  : std::cos(angle) / std::abs(std::sin(angle));
}

}  // namespace

bool CircleSearch::serves(const DistinctDirections& directions) {
  return directions.rank() == 2 && directions.bin.back() <= 0xffff;
}

CircleSearch::CircleSearch(const DistinctDirections& directions) {
  std::vector<std::int32_t> order(static_cast<std::size_t>(directions.count()));
  std::iota(order.begin(), order.end(), 0);
  const auto angle_of = [&](std::int32_t n) {
    return std::atan2(directions.unit(n, 1), directions.unit(n, 0));
  };
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return angle_of(a) < angle_of(b); });
  unit_ = directions.unit(order, Eigen::all);
  min_gap_ = 2 * pi;
  for (std::size_t i = 0; i < order.size(); ++i) {
    angle_.push_back(angle_of(order[i]));
    bin_.push_back(directions.bin[static_cast<std::size_t>(order[i])]);
  }
  for (std::size_t i = 0; i < angle_.size(); ++i) {
    const double next = i + 1 < angle_.size() ? angle_[i + 1] : angle_[0] + 2 * pi;
    border_.push_back(0.5 * (angle_[i] + next));
    min_gap_ = std::min(min_gap_, next - angle_[i]);
  }
  // Ties are closer to a border; c changes by at most twice the angle.
  margin_ = static_cast<float>(rounding + 20 * tie_tolerance / min_gap_);
  cut_into_pieces();
}

void CircleSearch::cut_into_pieces() {
  constexpr double tolerated = 0.002;  // share of pieces with several borders
  const auto count = static_cast<unsigned>(angle_.size());
  const auto most = static_cast<int>(std::min(16 * std::bit_ceil(count), 1u << 16));
  for (resolution_ = static_cast<int>(std::max(16u, std::bit_ceil(count / 2)));; resolution_ *= 2) {
    pieces_.clear();
    for (int side = 0; side < 4; ++side)
      for (int i = 0; i < resolution_; ++i)
        pieces_.push_back(piece(side, 2.0 * i / resolution_ - 1, 2.0 * (i + 1) / resolution_ - 1));
    const auto crowded = std::count_if(pieces_.begin(), pieces_.end(),
                                       [](const CirclePiece& p) { return std::isnan(p.border); });
    if (resolution_ >= most ||
        static_cast<double>(crowded) <= tolerated * static_cast<double>(pieces_.size()))
      return;
  }
}

CirclePiece CircleSearch::piece(int side, double begin, double end) const {
  constexpr double reach = 3e-5;  // exceeds the error of the search
  const double at_begin = angle_at(side, begin - reach), at_end = angle_at(side, end + reach);
  // Angles increase with c on sides 0 and 3; side 1 contains the jump at pi.
  const bool grows = side == 0 || side == 3;
  const std::size_t low = owner(grows ? at_begin : at_end), high = owner(grows ? at_end : at_begin);
  const std::size_t between = (high + angle_.size() - low) % angle_.size();
  CirclePiece result;
  const std::size_t below = grows ? low : high, above = grows ? high : low;
  result.below = static_cast<std::uint16_t>(bin_[below]);
  result.above = static_cast<std::uint16_t>(bin_[above]);
  if (between == 0)
    result.border = -2.0f;  // below all c
  else if (between == 1)
    result.border = static_cast<float>(c_at(side, border_[low]));
  else
    result.border = std::numeric_limits<float>::quiet_NaN();
  return result;
}

std::size_t CircleSearch::owner(double angle) const {
  // The last border may exceed pi.
  if (angle < border_.back() - 2 * pi) return angle_.size() - 1;
  const auto first = std::lower_bound(border_.begin(), border_.end(), angle);
  return first == border_.end() ? 0 : static_cast<std::size_t>(first - border_.begin());
}

double CircleSearch::score(const double* unit, std::size_t i) const {
  const auto row = static_cast<Eigen::Index>(i);
  return unit[0] * unit_(row, 0) + unit[1] * unit_(row, 1);
}

std::int32_t CircleSearch::choose(const double* unit, double tie) const {
  const std::size_t count = angle_.size(), nearest = owner(std::atan2(unit[1], unit[0]));
  // Rounding may shift a border by one direction.
  const std::size_t before = (nearest + count - 1) % count, after = (nearest + 1) % count;
  const double best = std::max({score(unit, nearest), score(unit, before), score(unit, after)});
  std::int32_t lowest = bin_[nearest];
  const auto walk = [&](std::size_t step) {
    std::size_t i = (nearest + step) % count;
    for (std::size_t k = 1; k < count; ++k, i = (i + step) % count) {
      if (score(unit, i) >= best - tie)
        lowest = std::min(lowest, bin_[i]);
      else if (k > 1)
        break;
    }
  };
  if (score(unit, nearest) < best - tie) lowest = std::numeric_limits<std::int32_t>::max();
  walk(1);
  walk(count - 1);
  return lowest;
}

bool CircleSearch::search(PixelTile& tile) const {
  return HWY_DYNAMIC_DISPATCH(search)(pieces_.data(), resolution_, margin_, tile);
}

}  // namespace tofsmith
#endif
