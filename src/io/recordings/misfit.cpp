// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/misfit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "decode/shared/marked_raw.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

namespace {

using Order = std::vector<int>;

/// The measurements of a pixel are adjacent.
struct PixelSample {
  std::vector<float> numbers;
  int measurements = 0;
  bool was_unsigned = false;
  double averaged = 1.0;

  int pixels() const { return static_cast<int>(numbers.size()) / measurements; }
};

/// Largest minus smallest measurement [e]; 0 if a number is clipped or not finite.
double contrast(const float* numbers, const DecodingTable& table) {
  const SaturationLevels levels(table);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int k = 0; k < table.measurements(); ++k) {
    const float number = numbers[k];
    if (!std::isfinite(number) || levels.clip(number)) return 0.0;
    const double electrons =
        (static_cast<double>(number) - table.black_level[k]) * table.gain_e_per_raw[k];
    low = std::min(low, electrons);
    high = std::max(high, electrons);
  }
  return high - low;
}

/// Returns the pixels with the most contrast in evenly spaced rows, because they show a wrong order
/// best.
PixelSample sample_of(const RawFramesReader& reader, int frame, const DecodingTable& table) {
  constexpr int max_rows = 64;
  constexpr std::size_t max_read = 1 << 14, max_kept = 512;
  const auto measurements = static_cast<std::size_t>(reader.measurements());
  PixelSample sample{.numbers = {}, .measurements = reader.measurements()};
  std::vector<float> read;
  std::vector<std::byte> buffer;
  const int rows = std::min(reader.height(), max_rows);
  const int step = std::max(1, reader.width() * rows / static_cast<int>(max_read));
  for (int i = 0; i < rows; ++i) {
    const int row = static_cast<int>(std::int64_t{i} * reader.height() / rows);
    const RawView view = reader.read_rows(frame, row, 1, buffer);
    sample.was_unsigned = view.is_unsigned();
    for (int column = 0; column < view.width; column += step) {
      read.resize(read.size() + measurements);
      copy_pixels(view, column, 1, read.data() + read.size() - measurements);
    }
  }
  std::vector<std::pair<double, std::size_t>> by_contrast;
  for (std::size_t at = 0; at < read.size(); at += measurements)
    if (const double size = contrast(read.data() + at, table); size > 0.0)
      by_contrast.emplace_back(size, at);
  const std::size_t kept = std::min(max_kept, (by_contrast.size() + 1) / 2);
  std::ranges::partial_sort(by_contrast, by_contrast.begin() + static_cast<std::ptrdiff_t>(kept),
                            std::greater());
  for (std::size_t i = 0; i < kept; ++i) {
    const auto first = read.begin() + static_cast<std::ptrdiff_t>(by_contrast[i].second);
    sample.numbers.insert(sample.numbers.end(), first,
                          first + static_cast<std::ptrdiff_t>(measurements));
  }
  return sample;
}

/// Square root of the median chi-square per degree of freedom; infinite without degrees of freedom.
double residual_of(const Decoder& decoder, const PixelSample& sample) {
  const int pixels = sample.pixels();
  std::vector<float> residual(static_cast<std::size_t>(pixels));
  RawView view = RawView::interleaved(sample.numbers.data(), 1, pixels, sample.measurements);
  const std::vector<float> averaged(static_cast<std::size_t>(pixels),
                                    static_cast<float>(sample.averaged));
  view.averaged = averaged.data();
  view.is_marked = true;
  view.was_unsigned = sample.was_unsigned;
  DecodedView decoded;
  decoded.residual = residual.data();
  decoder.decode(view, decoded);
  for (float& value : residual)
    if (std::isnan(value)) value = std::numeric_limits<float>::infinity();
  const auto middle = residual.begin() + pixels / 2;
  std::ranges::nth_element(residual, middle);
  return std::sqrt(static_cast<double>(*middle));
}

/// Exposure q[i] of the recording becomes the i-th exposure.
PixelSample reordered(const PixelSample& sample, const Order& q) {
  const int taps = sample.measurements / static_cast<int>(q.size());
  PixelSample result = sample;
  float* to = result.numbers.data();
  for (const float* from = sample.numbers.data();
       to != result.numbers.data() + result.numbers.size(); from += sample.measurements)
    for (const int exposure : q)
      for (int tap = 0; tap < taps; ++tap) *to++ = from[exposure * taps + tap];
  return result;
}

Order ascending(int n) {
  Order order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<Order> all_permutations(int n) {
  Order order = ascending(n);
  std::vector<Order> all;
  do all.push_back(order);
  while (std::ranges::next_permutation(order).found);
  return all;
}

/// Returns all permutations if n is small, otherwise the ascending and the descending order.
std::vector<Order> some_permutations(int n) {
  constexpr int max_permuted = 4;
  if (n <= max_permuted) return all_permutations(n);
  const Order order = ascending(n);
  return {order, Order(order.rbegin(), order.rend())};
}

/// Orders in which a driver may deliver exposures: frequencies exchanged, phases exchanged within
/// each frequency, or phase after phase.
std::set<Order> plausible_orders(int exposures) {
  constexpr int max_all = 6;
  if (exposures <= max_all) {
    const std::vector<Order> all = all_permutations(exposures);
    return {all.begin(), all.end()};
  }
  std::set<Order> orders;
  for (int size = 1; size <= exposures; ++size) {
    if (exposures % size != 0) continue;
    const int groups = exposures / size;
    for (const Order& group : some_permutations(groups))
      for (const Order& member : some_permutations(size)) {
        Order by_groups, by_members;
        for (const int g : group)
          for (const int m : member) {
            by_groups.push_back(g * size + m);
            by_members.push_back(m * groups + g);
          }
        orders.insert({by_groups, by_members});
      }
  }
  return orders;
}

/// Returns none if the numbers are not 16-bit integers.
std::optional<PixelSample> with_swapped_bytes(const PixelSample& sample) {
  PixelSample result = sample;
  const bool is_signed = std::ranges::any_of(sample.numbers, [](float n) { return n < 0.0f; });
  bool is_wide = false;
  for (float& number : result.numbers) {
    if (!(number >= -32768.0f && number <= 65535.0f) || std::nearbyint(number) != number)
      return std::nullopt;
    is_wide = is_wide || number < 0.0f || number > 255.0f;
    const auto word = static_cast<std::uint16_t>(static_cast<std::int32_t>(number));
    const auto swapped = static_cast<std::uint16_t>(word << 8 | word >> 8);
    number = is_signed ? static_cast<float>(static_cast<std::int16_t>(swapped))
                       : static_cast<float>(swapped);
  }
  return is_wide ? std::optional(result) : std::nullopt;
}

struct Alternative {
  double residual;
  std::string text;
};

/// Returns the option for the order q of the recorded exposures.
std::string option_text(const Order& recorded, const Order& q) {
  Order order(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) order[static_cast<std::size_t>(q[i])] = recorded[i];
  return std::ranges::is_sorted(order) ? "the order of the code"
                                       : fmt::format("--order {}", fmt::join(order, ","));
}

std::vector<Alternative> alternatives(const PixelSample& sample, const Decoder& decoder,
                                      const Order& recorded) {
  std::vector<Alternative> all;
  for (const Order& q : plausible_orders(static_cast<int>(recorded.size())))
    if (!std::ranges::is_sorted(q))
      all.push_back({residual_of(decoder, reordered(sample, q)), option_text(recorded, q)});
  if (const auto swapped = with_swapped_bytes(sample))
    all.push_back({residual_of(decoder, *swapped), "the other byte order"});
  return all;
}

/// Returns ". This fits ...: ..." with the best alternatives; "" if none is clearly better.
std::string better_text(std::vector<Alternative> all, double residual) {
  constexpr double clearly = 1.0 / 3.0, alike = 1.25;
  constexpr std::size_t max_named = 3;
  if (all.empty()) return "";
  const double best = std::ranges::min(all, {}, &Alternative::residual).residual;
  if (!(best <= clearly * residual)) return "";
  std::erase_if(all, [&](const Alternative& one) { return one.residual > alike * best; });
  std::string named;
  for (std::size_t i = 0; i < std::min(all.size(), max_named); ++i)
    named += (i == 0 ? "" : "; ") + all[i].text;
  const std::string rest =
      all.size() > max_named
          ? fmt::format("; and {} others, which differ by an offset or the direction of depth",
                        all.size() - max_named)
          : "";
  return fmt::format(". Better fit (residual {} times the noise): {}{}", plain_number(best, 2),
                     named, rest);
}

}  // namespace

std::optional<std::string> misfit_note(const DecodeRequest& request, const DepthDecoder& decoder,
                                       const RawFramesReader& reader, int frame) {
  constexpr int min_pixels = 20;
  constexpr double large = 3.0;
  const DecodingTable& table = decoder.table();
  PixelSample sample = sample_of(reader, frame, table);
  if (sample.pixels() < min_pixels) return std::nullopt;
  sample.averaged = request.averaged;
  std::optional<Decoder> own;
  const Decoder* correlation = decoder.correlation_decoder();
  if (!correlation) correlation = &own.emplace(table);
  const double residual = residual_of(*correlation, sample);
  if (!(residual > large) || std::isinf(residual)) return std::nullopt;
  const Order recorded = request.order.empty() ? ascending(table.measurements()) : request.order;
  return fmt::format(
      "raw numbers do not fit this code (residual {} times the noise): check --order, --code, "
      "--camera and the byte order{}",
      plain_number(residual, 2),
      better_text(alternatives(sample, *correlation, recorded), residual));
}

}  // namespace tofsmith
