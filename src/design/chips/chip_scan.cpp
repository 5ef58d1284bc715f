// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/chip_scan.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "design/chips/chip_scan.cpp"
#include <hwy/foreach_target.h>
// Highway requires its header after foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tofsmith {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask, std::size_t first_lane) {
  alignas(8) std::uint8_t bytes[8] = {};
  const std::size_t written = hn::StoreMaskBits(d, mask, bytes);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < written && i < 4; ++i)
    bits |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
  return bits << first_lane;
}

template <class D>
struct Direction {
  hn::Vec<D> x, y;
  HWY_INLINE Direction(D d, const std::int16_t* counts, const ScanAssignment& taps,
                       std::size_t depth) {
    const auto row = [&](int tap) { return counts + (taps.row[tap] + depth) * scan_lanes; };
    const auto last = hn::LoadU(d, row(2));
    x = hn::Sub(hn::LoadU(d, row(0)), last);
    y = hn::Sub(hn::LoadU(d, row(1)), last);
  }
};

void turning(const std::int16_t* counts, std::span<const ScanAssignment> assignments, int chips,
             std::uint32_t* found) {
  const hn::CappedTag<std::int16_t, scan_lanes> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d), three = hn::Set(d, std::int16_t{3});
  for (std::size_t j = 0; j < assignments.size(); ++j) {
    found[j] = 0;
    for (std::size_t lane = 0; lane < scan_lanes; lane += lanes) {
      Direction<decltype(d)> here(d, counts + lane, assignments[j], 0);
      auto left = hn::FirstN(d, lanes), right = left;
      auto below = hn::BroadcastSignBit(here.y), halves = zero;
      bool any = true;
      for (int s = 1; s <= chips && any; ++s) {
        const Direction<decltype(d)> next(d, counts + lane, assignments[j],
                                          static_cast<std::size_t>(s));
        const auto cross = hn::Sub(hn::Mul(here.x, next.y), hn::Mul(next.x, here.y));
        // One turn in one sense changes the sign of y twice.
        const auto next_below = hn::BroadcastSignBit(next.y);
        halves = hn::Sub(halves, hn::Xor(below, next_below));
        const auto once = hn::Lt(halves, three);
        left = hn::And(left, hn::And(once, hn::Gt(cross, zero)));
        right = hn::And(right, hn::And(once, hn::Lt(cross, zero)));
        any = !hn::AllFalse(d, hn::Or(left, right));
        here = next;
        below = next_below;
      }
      if (any) found[j] |= bits_of(d, hn::Or(left, right), lane);
    }
  }
}

/// Keeps codes equal to the limit despite single precision.
constexpr float limit_slack = 1.0001F;
constexpr std::size_t entry_floats = scan_lanes, row_floats = fisher_entries * entry_floats;

template <class D, class Matrices>
HWY_INLINE hn::Vec<D> known_light_bound(D d, int chips, const Matrices& entry) {
  const auto tiny = hn::Set(d, 1e-30F);
  const auto zz = [&](int s) { return hn::Add(tiny, entry(s, 0)); };
  auto sum = hn::Zero(d);
  int s = 0;
  for (; s + 1 < chips; s += 2) {
    const auto a = zz(s), b = zz(s + 1);
    sum = hn::Add(sum, hn::Div(hn::Add(a, b), hn::Mul(a, b)));
  }
  if (s < chips) sum = hn::Add(sum, hn::Div(hn::Set(d, 1.0F), zz(s)));
  return sum;
}

/// Sum over depths of (m0 + m1 + m2 / 3) / det, rounded down. Entries are sums of up to 8 products
/// with errors below 10 u (u = 2^-24), relative to the root of the product of their diagonal
/// entries; errors of minors are below 64 u and of the determinant below 256 u, relative to
/// products of diagonal entries.
template <class D, class Matrices>
HWY_INLINE hn::Vec<D> unknown_light_bound(D d, int chips, const Matrices& entry) {
  const auto minor_error = hn::Set(d, 128.0F / 16777216.0F);
  const auto determinant_error = hn::Set(d, 256.0F / 16777216.0F);
  const auto third = hn::Set(d, 1.0F / 3.0F), zero = hn::Zero(d);
  auto sum = zero;
  for (int s = 0; s < chips; ++s) {
    const auto zz = entry(s, 0), zs = entry(s, 1), ss = entry(s, 2);
    const auto za = entry(s, 3), sa = entry(s, 4), aa = entry(s, 5);
    const auto m0 = hn::NegMulAdd(sa, sa, hn::Mul(ss, aa));
    const auto m1 = hn::NegMulAdd(za, sa, hn::Mul(zs, aa));
    const auto m2 = hn::NegMulAdd(za, za, hn::Mul(zz, aa));
    const auto other = hn::NegMulAdd(ss, za, hn::Mul(zs, sa));
    const auto determinant = hn::MulAdd(za, other, hn::NegMulAdd(zs, m1, hn::Mul(zz, m0)));
    const auto size = hn::Mul(aa, hn::Add(ss, zz));
    const auto above = hn::NegMulAdd(minor_error, size, hn::MulAdd(third, m2, hn::Add(m0, m1)));
    const auto below =
        hn::MulAdd(determinant_error, hn::Mul(hn::Mul(zz, ss), aa), hn::Max(determinant, zero));
    sum = hn::Add(sum, hn::Div(hn::Max(above, zero), below));
  }
  return sum;
}

/// Returns the lanes whose bounds, multiplied over the points, do not exceed the limit or are NaN.
template <class D, class EntriesOfPoint>
HWY_INLINE std::uint32_t within_limit(D d, const InformationRows& rows, int chips, std::size_t lane,
                                      const EntriesOfPoint& entries) {
  const auto limit = hn::Set(d, limit_slack);
  const auto scale = hn::Set(d, static_cast<float>(1.0 / (rows.limit * chips)));
  auto known = hn::Set(d, 1.0F), unknown = known;
  for (std::size_t p = 0; p < rows.point.size(); ++p)
    known = hn::Mul(known, hn::Mul(scale, known_light_bound(d, chips, entries(p))));
  auto kept = hn::Not(hn::Gt(known, limit));
  if (hn::AllFalse(d, kept)) return 0;
  if (rows.metric == ChipMetric::known_light) return bits_of(d, kept, lane);
  for (std::size_t p = 0; p < rows.point.size(); ++p)
    unknown = hn::Mul(unknown, hn::Mul(scale, unknown_light_bound(d, chips, entries(p))));
  kept = hn::AndNot(hn::Gt(unknown, limit), kept);
  return bits_of(d, kept, lane);
}

void informed(const InformationRows& rows, std::span<const ScanAssignment> assignments, int chips,
              int taps, std::uint32_t* found) {
  const hn::CappedTag<float, scan_lanes> d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t j = 0; j < assignments.size(); ++j) {
    found[j] = 0;
    for (std::size_t lane = 0; lane < scan_lanes; lane += lanes) {
      const auto entries = [&](std::size_t point) {
        const float* const first = rows.point[point] + lane;
        return [d, first, taps, &assignment = assignments[j]](int s, int entry) {
          auto sum = hn::Zero(d);
          for (int tap = 0; tap < taps; ++tap)
            sum = hn::Add(
                sum,
                hn::LoadU(d, first +
                                 (assignment.row[tap] + static_cast<std::size_t>(s)) * row_floats +
                                 static_cast<std::size_t>(entry) * entry_floats));
          return sum;
        };
      };
      found[j] |= within_limit(d, rows, chips, lane, entries);
    }
  }
}

void informed_pairs(const InformationRows& others, std::span<const float> first, int chips,
                    std::size_t blocks, std::uint32_t* found) {
  const hn::CappedTag<float, scan_lanes> d;
  const std::size_t lanes = hn::Lanes(d), depths = static_cast<std::size_t>(chips);
  for (std::size_t block = 0; block < blocks; ++block) {
    found[block] = 0;
    for (std::size_t lane = 0; lane < scan_lanes; lane += lanes) {
      const auto entries = [&](std::size_t point) {
        const float* const rows = others.point[point] + block * depths * row_floats + lane;
        const float* const own = first.data() + point * depths * fisher_entries;
        return [d, rows, own](int s, int entry) {
          const auto depth = static_cast<std::size_t>(s), at = static_cast<std::size_t>(entry);
          return hn::Add(hn::Set(d, own[depth * fisher_entries + at]),
                         hn::LoadU(d, rows + depth * row_floats + at * entry_floats));
        };
      };
      found[block] |= within_limit(d, others, chips, lane, entries);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tofsmith
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tofsmith {

namespace {
HWY_EXPORT(turning);
HWY_EXPORT(informed);
HWY_EXPORT(informed_pairs);
}  // namespace

void find_turning(const std::int16_t* counts, std::span<const ScanAssignment> assignments,
                  int chips, std::uint32_t* found) {
  HWY_DYNAMIC_DISPATCH(turning)(counts, assignments, chips, found);
}

void find_informed(const InformationRows& information, std::span<const ScanAssignment> assignments,
                   int chips, int taps, std::uint32_t* found) {
  HWY_DYNAMIC_DISPATCH(informed)(information, assignments, chips, taps, found);
}

void find_informed_pairs(const InformationRows& others, std::span<const float> first, int chips,
                         std::size_t blocks, std::uint32_t* found) {
  HWY_DYNAMIC_DISPATCH(informed_pairs)(others, first, chips, blocks, found);
}

}  // namespace tofsmith
#endif
