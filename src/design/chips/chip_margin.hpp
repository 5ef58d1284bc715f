// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

/// Electrons per chip at one operating point. A tap that is open for d chips and receives light of
/// level L during c chips has
///   mean      signal_e L c + ambient_e d
///   variance  mean + constant_e2.
struct ChipLight {
  double signal_e = 0.0;
  double ambient_e = 0.0;
  double constant_e2 = 0.0;
  double peak_factor = 1.0;
  int chips = 0;
  double chip_m = 0.0;
  bool is_known = false;

  ChipLight(const Camera& camera, const OperatingPoint& point, int chips, int exposures,
            ChipMetric metric = ChipMetric::unknown_light);

  double electrons_of(int on_chips) const {
    return signal_e * chip_level(on_chips, chips, peak_factor);
  }
};

std::optional<BrokenRule> why_not_plain(const Camera& camera);

inline constexpr int max_chip_measurements = 16;

/// Returns true if two real depths can have equal measurements at suitable light levels. Exact
/// (integers). Defined in chip_code.cpp.
/// @throws std::invalid_argument if the code is invalid
bool is_ambiguous(const ChipCode& code);

/// Noise-normalized distances between depths: the minimum over all depths z, z' with a circular
/// distance of at least `separation_periods`, and over all S' >= 0 and A', of
///   | mu(z, S, A) - mu(z', S', A') |, whitened by the variances at (z, S, A).
class ChipMargin {
 public:
  ChipMargin(const ChipCode& code, const ChipLight& light, double separation_periods);

  /// Returns true if the smallest distance is proven to be at least `sigma`.
  bool reaches(double sigma) const;
  /// Returns a lower bound of the smallest distance, tight to 0.1 %; 0 below 1e-3.
  double proven_sigma() const;
  /// Returns an upper bound of the smallest distance, from `per_chip` depths per chip.
  double sampled_sigma(int per_chip, double stop_below_sigma = 0.0) const;

 private:
  using Values = std::array<double, max_chip_measurements>;
  /// Part of a chip with alternative depths.
  struct Stretch {
    int chip;
    double begin, end;
  };
  struct Stretches {
    std::array<Stretch, 4> of{};
    std::size_t count = 0;
    void add(const Stretch& stretch) { of[count++] = stretch; }
    auto begin() const { return of.begin(); }
    auto end() const { return of.begin() + count; }
  };
  struct Whitening;

  Values values_at(int chip, double place) const;
  Whitening whitening(const Values& variance) const;
  Values variance_at(int chip, double place) const;
  Stretches alternatives(double first, double last, int chip) const;
  double squared_distance(int chip, double place, const Stretch& alternative) const;
  double lower_bound(int chip, double begin, double end, const Stretch& alternative) const;
  double nearest(int chip, double place) const;
  bool clears(int chip, double begin, double end, int alternative_chip, double& least,
              double factor) const;

  int chips_, measurements_;
  double separation_chips_;
  double constant_e2_;
  std::vector<Values> signal_e_;
  Values ambient_e_{};
  Values open_{};
};

}  // namespace tofsmith
