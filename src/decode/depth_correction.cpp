// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoding_table.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

namespace {

/// Maps index 0 ... n - 1 to [-1, 1].
double place(int at, int n) { return n > 1 ? 2.0 * at / (n - 1) - 1.0 : 0.0; }

double harmonics_m(const Eigen::VectorXd& terms_m, double phase_rad) {
  const double c = std::cos(phase_rad), s = std::sin(phase_rad);
  double cosine = 1.0, sine = 0.0, sum_m = 0.0;
  for (Eigen::Index h = 0; h + 1 < terms_m.size(); h += 2) {
    const double next = cosine * c - sine * s;
    sine = cosine * s + sine * c;
    cosine = next;
    sum_m += terms_m[h] * cosine + terms_m[h + 1] * sine;
  }
  return sum_m;
}

double field_m(const Eigen::VectorXd& terms_m, double row, double column) {
  double sum_m = 0.0;
  Eigen::Index at = 0;
  for (int degree = 1; at < terms_m.size(); ++degree)
    for (int i = 0; i <= degree && at < terms_m.size(); ++i, ++at) {
      double product = terms_m[at];
      for (int j = 0; j < degree - i; ++j) product *= row;
      for (int j = 0; j < i; ++j) product *= column;
      sum_m += product;
    }
  return sum_m;
}

double terms_m(const DepthErrorTerms& terms, double phase_rad, double row, double column,
               double log_signal) {
  double sum_m = terms.offset_m + harmonics_m(terms.harmonic_m, phase_rad) +
                 field_m(terms.field_m, row, column);
  double power = 1.0;
  for (const double term_m : terms.signal_m) sum_m += term_m * (power *= log_signal);
  return sum_m;
}

bool is_field_size(Eigen::Index size) {
  Eigen::Index full = 0;
  for (Eigen::Index degree = 1; full < size; ++degree) full += degree + 1;
  return full == size;
}

void validate_terms(const DepthErrorTerms& terms, const std::string& name) {
  const auto rule = [&](bool holds, const char* field, Eigen::Index size, const char* rule_text) {
    require(holds, name + "." + field, std::to_string(size) + " entries", rule_text);
  };
  require(std::isfinite(terms.offset_m), name + ".offset_m", terms.offset_m, "must be finite");
  rule(terms.harmonic_m.size() % 2 == 0 && terms.harmonic_m.size() <= 64, "harmonic_m",
       terms.harmonic_m.size(), "must have two entries for each of at most 32 harmonics");
  rule(is_field_size(terms.field_m.size()) && terms.field_m.size() <= 65, "field_m",
       terms.field_m.size(), "must have d + 1 entries for each degree d from 1 to at most 10");
  rule(terms.signal_m.size() <= 4, "signal_m", terms.signal_m.size(),
       "must have at most 4 entries");
  rule(terms.harmonic_m.allFinite() && terms.field_m.allFinite() && terms.signal_m.allFinite(),
       "terms", terms.harmonic_m.size(), "must be finite");
}

}  // namespace

double DepthCorrection::error_m(double depth_m, double range_m, int row, int column,
                                double signal_e_per_s_here) const {
  const double phase_rad = 2.0 * std::numbers::pi * depth_m / range_m;
  const double r = place(row, height), c = place(column, width);
  double log_signal = 0.0;
  if (needs_signal())
    log_signal = std::log(std::clamp(signal_e_per_s_here, min_signal_e_per_s, max_signal_e_per_s) /
                          signal_e_per_s);
  // Interpolate linearly between the middles of adjacent parts.
  double share = 1.0;
  if (const Eigen::Index parts = known_share.size(); parts > 0) {
    const double at = depth_m / range_m * static_cast<double>(parts) - 0.5;
    const double below = std::floor(at), between = at - below;
    const Eigen::Index low = ((static_cast<Eigen::Index>(below) % parts) + parts) % parts;
    share = (1.0 - between) * known_share[low] + between * known_share[(low + 1) % parts];
  }
  double error = 0.0;
  if (share > 0.0) error += share * terms_m(known, phase_rad, r, c, log_signal);
  if (share < 1.0) error += (1.0 - share) * terms_m(beyond, phase_rad, r, c, log_signal);
  return error;
}

void DepthCorrection::validate() const {
  require(height >= 1 && width >= 1, "correction size",
          std::to_string(height) + " x " + std::to_string(width), "must be at least 1 x 1");
  validate_terms(known, "correction.known");
  validate_terms(beyond, "correction.beyond");
  require(
      known_share.size() == 0 || (known_share.minCoeff() >= 0.0 && known_share.maxCoeff() <= 1.0),
      "correction.known_share", std::to_string(known_share.size()) + " entries",
      "must be in [0, 1]");
  if (!needs_signal()) return;
  require(std::isfinite(signal_e_per_s) && signal_e_per_s > 0.0, "correction.signal_e_per_s",
          signal_e_per_s, "must be finite and > 0");
  require(min_signal_e_per_s > 0.0 && min_signal_e_per_s <= max_signal_e_per_s &&
              std::isfinite(max_signal_e_per_s),
          "correction.min_signal_e_per_s", min_signal_e_per_s,
          "must be > 0 and at most max_signal_e_per_s");
}

void apply(const DepthCorrection& correction, double range_m, const DecodedView& decoded,
           int height, int width, std::size_t first, std::size_t count) {
  require(std::isfinite(range_m) && range_m > 0.0, "range_m", range_m, "must be finite and > 0");
  const auto text = [](int h, int w) { return std::to_string(h) + " x " + std::to_string(w); };
  require(correction.height == height && correction.width == width, "frame size",
          text(height, width),
          "must equal that of the table's depth correction, " +
              text(correction.height, correction.width));
  if (!decoded.depth_m) return;
  require(!correction.needs_signal() || decoded.signal_e_per_s, "signal_e_per_s", "null",
          "is required, because the depth correction depends on the signal");
  parallel_for_blocks(static_cast<std::int64_t>(count), 4096, [&](IndexRange range) {
    for (std::int64_t i = range.begin; i < range.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (std::isnan(decoded.depth_m[at])) continue;
      const auto pixel = first + at;
      const double depth_m = static_cast<double>(decoded.depth_m[at]);
      const double error_m = correction.error_m(
          depth_m, range_m, static_cast<int>(pixel / static_cast<std::size_t>(width)),
          static_cast<int>(pixel % static_cast<std::size_t>(width)),
          decoded.signal_e_per_s ? static_cast<double>(decoded.signal_e_per_s[at]) : 1.0);
      double corrected_m = depth_m - error_m;
      corrected_m -= range_m * std::floor(corrected_m / range_m);
      const auto rounded = static_cast<float>(corrected_m);
      // Rounding to float can yield range_m, which equals 0.
      decoded.depth_m[at] = rounded >= static_cast<float>(range_m) ? 0.0f : rounded;
    }
  });
}

}  // namespace tofsmith
