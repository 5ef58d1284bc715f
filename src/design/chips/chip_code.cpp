// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/chip_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "design/chips/chip_margin.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

Waveform chip_waveform(ChipWord word, int chips, double level) {
  if (word == 0) return Waveform::constant(0.0);
  Eigen::VectorXd is_on(chips);
  for (int k = 0; k < chips; ++k) is_on[k] = word >> k & 1U;
  return Waveform::binary_from_samples(is_on, level);
}

}  // namespace

ChipWord delayed_chips(ChipWord word, int shift, int chips) {
  const int by = ((shift % chips) + chips) % chips;
  return by == 0 ? word : ((word << by) | (word >> (chips - by))) & all_chips(chips);
}

ChipWord reversed_chips(ChipWord word, int chips) {
  ChipWord reversed = word & 1U;
  for (int k = 1; k < chips; ++k) reversed |= (word >> k & 1U) << (chips - k);
  return reversed;
}

std::string chip_text(ChipWord word, int chips) {
  std::string text;
  for (int k = 0; k < chips; ++k) text += (word >> k & 1U) != 0 ? '1' : '0';
  return text;
}

ChipWord chip_word(std::string_view text) {
  require(!text.empty() && text.size() <= max_chips, "chips", text,
          fmt::format("must be 1 to {} digits", max_chips));
  ChipWord word = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    require(text[k] == '0' || text[k] == '1', "chips", text, "must be digits 0 and 1");
    if (text[k] == '1') word |= ChipWord{1} << k;
  }
  return word;
}

const ChipWord* ChipCode::taps_of(int exposure) const {
  return demodulation.data() + static_cast<std::size_t>(exposure) * static_cast<std::size_t>(taps);
}

int ChipCode::correlation(int measurement, int shift) const {
  const ChipWord light = modulation[static_cast<std::size_t>(measurement / taps)];
  return std::popcount(demodulation[static_cast<std::size_t>(measurement)] &
                       delayed_chips(light, shift, chips));
}

std::string ChipCode::text() const {
  std::string text;
  for (int e = 0; e < exposures(); ++e) {
    text += e > 0 ? ", M " : "M ";
    text += chip_text(modulation[static_cast<std::size_t>(e)], chips);
    for (int i = 0; i < taps; ++i) {
      text += i == 0 ? " D " : "/";
      text += chip_text(taps_of(e)[i], chips);
    }
  }
  return text;
}

void ChipCode::validate() const {
  require(chips >= 3 && chips <= max_chips, "ChipCode::chips", chips,
          fmt::format("must be in [3, {}]", max_chips));
  require(taps >= 1 && taps <= 16, "ChipCode::taps", taps, "must be in [1, 16]");
  require(exposures() >= 1, "ChipCode::modulation", "[]", "must list at least one exposure");
  require(measurements() == exposures() * taps, "number of ChipCode::demodulation", measurements(),
          "must be exposures x taps");
  for (const ChipWord word : modulation)
    require(word <= all_chips(chips), "ChipCode::modulation", word, "must lie within the chips");
  for (int e = 0; e < exposures(); ++e) {
    ChipWord taken = 0;
    for (int i = 0; i < taps; ++i) {
      const ChipWord word = taps_of(e)[i];
      require(word <= all_chips(chips), "ChipCode::demodulation", word,
              "must lie within the chips");
      require((taken & word) == 0, "ChipCode::demodulation", chip_text(word, chips),
              "must not overlap another tap of its exposure");
      taken |= word;
    }
  }
}

std::optional<BrokenRule> why_no_chip_clock(const Camera& camera) {
  if (!camera.sensor.shortest_pulse_s)
    return broken("sensor.shortest_pulse_s", "none",
                  "must be set to the length of one chip to search codes on a chip clock");
  const double chip_s = *camera.sensor.shortest_pulse_s;
  const double chips = 1.0 / (camera.fundamental_frequency_hz * chip_s);
  if (std::abs(chips - std::round(chips)) < 1e-6 * chips && std::round(chips) >= 3 &&
      std::round(chips) <= max_chips)
    return std::nullopt;
  return broken("sensor.shortest_pulse_s", chip_s,
                fmt::format("must be the period divided by an integer from 3 to {}; found {:.6g} s "
                            "/ shortest_pulse_s = {:.6g}",
                            max_chips, 1.0 / camera.fundamental_frequency_hz, chips));
}

int chips_of(const Camera& camera) {
  require(why_no_chip_clock(camera));
  return static_cast<int>(
      std::lround(1.0 / (camera.fundamental_frequency_hz * *camera.sensor.shortest_pulse_s)));
}

double chip_level(int on_chips, int chips, double peak_factor) {
  return on_chips == 0 ? 0.0 : std::min(peak_factor, static_cast<double>(chips) / on_chips);
}

CodeSet to_code_set(const ChipCode& code, const Camera& camera, const std::string& name) {
  code.validate();
  std::vector<Waveform> modulation, demodulation;
  for (const ChipWord word : code.modulation)
    modulation.push_back(chip_waveform(
        word, code.chips, chip_level(std::popcount(word), code.chips, camera.light.peak_factor)));
  for (const ChipWord word : code.demodulation)
    demodulation.push_back(chip_waveform(word, code.chips, 1.0));
  return CodeSet::create(name, camera.samples, code.taps, std::move(modulation),
                         std::move(demodulation));
}

namespace {

/// Direction at one depth without the ambient component; unused entries are 0.
using Direction = std::array<std::int64_t, 16>;

/// Directions at the corners of the correlation functions. For a reference tap r that is not always
/// closed, the null space of the map
///   q_i = kappa_r C_i - C_r kappa_i,  i != r,
/// is the ambient vector kappa. Two depths can have equal measurements exactly if their q have the
/// same direction.
std::vector<Direction> corner_directions(const ChipCode& code) {
  std::vector<std::int64_t> open;
  for (const ChipWord word : code.demodulation) open.push_back(std::popcount(word));
  const auto reference =
      static_cast<int>(std::max_element(open.begin(), open.end()) - open.begin());
  std::vector<Direction> corners(static_cast<std::size_t>(code.chips), Direction{});
  for (int s = 0; s < code.chips; ++s)
    for (int i = 0; i < code.measurements(); ++i)
      corners[static_cast<std::size_t>(s)][static_cast<std::size_t>(i)] =
          open[static_cast<std::size_t>(reference)] * code.correlation(i, s) -
          code.correlation(reference, s) * open[static_cast<std::size_t>(i)];
  return corners;
}

/// Returns the unique relation sum_j x_j columns_j = 0, if any, by fraction-free elimination
/// (Bareiss).
std::optional<std::array<std::int64_t, 4>> only_relation(std::span<const Direction> columns) {
  const std::size_t width = columns.size(), height = Direction().size();
  std::array<Direction, 4> rows{};
  std::array<std::array<std::int64_t, 4>, 4> combination{};
  for (std::size_t j = 0; j < width; ++j) {
    rows[j] = columns[j];
    combination[j][j] = 1;
  }
  std::size_t rank = 0;
  std::int64_t previous = 1;
  for (std::size_t column = 0; column < height && rank < width; ++column) {
    std::size_t pivot = rank;
    while (pivot < width && rows[pivot][column] == 0) ++pivot;
    if (pivot == width) continue;
    std::swap(rows[rank], rows[pivot]);
    std::swap(combination[rank], combination[pivot]);
    const std::int64_t head = rows[rank][column];
    for (std::size_t j = rank + 1; j < width; ++j) {
      const std::int64_t factor = rows[j][column];
      for (std::size_t i = 0; i < height; ++i)
        rows[j][i] = (head * rows[j][i] - factor * rows[rank][i]) / previous;
      for (std::size_t i = 0; i < width; ++i)
        combination[j][i] = (head * combination[j][i] - factor * combination[rank][i]) / previous;
    }
    previous = head;
    ++rank;
  }
  if (rank + 1 != width) return std::nullopt;
  return combination[width - 1];
}

/// Returns true if sum_j x_j columns_j = 0 for some x >= 0, x != 0. Some such x has a support with
/// a unique relation, so testing all supports is sufficient.
bool have_positive_relation(std::span<const Direction> columns) {
  for (unsigned support = 1; support < 1U << columns.size(); ++support) {
    std::array<Direction, 4> chosen{};
    std::size_t count = 0;
    for (std::size_t j = 0; j < columns.size(); ++j)
      if ((support >> j & 1U) != 0) chosen[count++] = columns[j];
    const auto relation = only_relation(std::span(chosen).first(count));
    if (!relation) continue;
    const std::span<const std::int64_t> x(relation->data(), count);
    if (std::all_of(x.begin(), x.end(), [](std::int64_t value) { return value > 0; }) ||
        std::all_of(x.begin(), x.end(), [](std::int64_t value) { return value < 0; }))
      return true;
  }
  return false;
}

Direction negative(Direction vector) {
  for (std::int64_t& value : vector) value = -value;
  return vector;
}

bool stands_still(const Direction& here, const Direction& next) {
  return have_positive_relation(std::array{here, next}) ||
         have_positive_relation(std::array{here, negative(next)});
}

bool turns_back(const Direction& before, const Direction& here, const Direction& next) {
  return have_positive_relation(std::array{before, negative(next), here}) ||
         have_positive_relation(std::array{before, negative(next), negative(here)});
}

}  // namespace

bool is_ambiguous(const ChipCode& code) {
  code.validate();
  require(code.measurements() <= 16, "measurements of ChipCode", code.measurements(),
          "must be <= 16");
  if (std::all_of(code.demodulation.begin(), code.demodulation.end(),
                  [](ChipWord word) { return word == 0; }))
    return true;
  if (code.measurements() < 3) return true;  // at least as many unknowns
  const std::vector<Direction> corners = corner_directions(code);
  const std::size_t n = corners.size();
  const auto corner = [&](std::size_t s) -> const Direction& { return corners[s % n]; };
  for (std::size_t s = 0; s < n; ++s)
    if (stands_still(corner(s), corner(s + 1))) return true;
  for (std::size_t s = 0; s < n; ++s)
    if (turns_back(corner(s), corner(s + 1), corner(s + 2))) return true;
  for (std::size_t s = 0; s < n; ++s)
    for (std::size_t u = s + 2; u < n; ++u) {
      if (u + 1 - s == n) continue;
      if (have_positive_relation(
              std::array{corner(s), corner(s + 1), negative(corner(u)), negative(corner(u + 1))}))
        return true;
    }
  return false;
}

}  // namespace tofsmith
