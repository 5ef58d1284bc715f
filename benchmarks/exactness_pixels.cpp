// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "exactness_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "decode_frame.hpp"
#include "fast_random.hpp"

namespace tofsmith::benchmarks {

namespace {

enum class Kind { low, medium, high, ambient, any_light, half_way, whole, scaled, odd, mixed };

/// One cycle of kinds: common light is frequent, cases decided in double are rare.
constexpr Kind kinds[] = {Kind::low,       Kind::medium, Kind::high,     Kind::ambient,
                          Kind::any_light, Kind::medium, Kind::half_way, Kind::high,
                          Kind::low,       Kind::whole,  Kind::ambient,  Kind::any_light,
                          Kind::scaled,    Kind::medium, Kind::mixed,    Kind::odd};

class HardPixels {
 public:
  HardPixels(const DecodingTable& table, std::uint64_t seed) : table_(table), random_(seed) {}

  void fill(Kind kind, float* raw) {
    switch (kind) {
      case Kind::low:
        return noisy(light_levels[0].signal_e_per_s, light_levels[0].ambient_e_per_s, raw);
      case Kind::medium:
        return noisy(light_levels[1].signal_e_per_s, light_levels[1].ambient_e_per_s, raw);
      case Kind::high:
        return noisy(light_levels[2].signal_e_per_s, light_levels[2].ambient_e_per_s, raw);
      case Kind::ambient: {
        const double signal_e_per_s = random_.log_uniform(1e3, 1e5);
        return noisy(signal_e_per_s, 100 * signal_e_per_s, raw);
      }
      case Kind::any_light:
        return noisy(random_.log_uniform(1e1, 1e7), random_.log_uniform(1e1, 1e7), raw);
      case Kind::half_way:
        return half_way(raw);
      case Kind::whole:
        return whole(raw);
      case Kind::scaled:
        return scaled(raw);
      case Kind::odd:
        return odd(raw);
      case Kind::mixed:
        return fill(kinds[random_.below(13)], raw);
    }
  }

 private:
  int measurements() const { return table_.measurements(); }

  void set(float* raw, int k, double electrons) {
    raw[k] = static_cast<float>(electrons / table_.gain_e_per_raw[k] + table_.black_level[k]);
  }

  void noisy(double signal_e_per_s, double ambient_e_per_s, float* raw) {
    const double depth_bin = random_.uniform(0.0, table_.samples());
    const int from = static_cast<int>(depth_bin), to = (from + 1) % table_.samples();
    const double t = depth_bin - from;
    for (int k = 0; k < measurements(); ++k) {
      const double chi = (1 - t) * table_.correlation(from, k) + t * table_.correlation(to, k);
      const double mean =
          table_.exposure_s[k] * (signal_e_per_s * chi + ambient_e_per_s * table_.ambient_gain[k]) +
          table_.dark_electrons[k];
      set(raw, k, mean + std::sqrt(mean + table_.constant_variance_e2[k]) * random_.normal());
    }
  }

  /// Norm of a bin without its ambient component.
  double contrast(int bin) const {
    double along = 0.0, ambient = 0.0, square = 0.0;
    for (int k = 0; k < measurements(); ++k) {
      const double x = table_.exposure_s[k] * table_.correlation(bin, k);
      const double a = table_.exposure_s[k] * table_.ambient_gain[k];
      along += x * a;
      ambient += a * a;
      square += x * x;
    }
    return std::sqrt(square - along * along / ambient);
  }

  /// Half-way between two adjacent or arbitrary bins: a tie up to rounding.
  void half_way(float* raw) {
    const int n = random_.below(table_.samples());
    const int m =
        random_.below(8) != 0 ? (n + 1) % table_.samples() : random_.below(table_.samples());
    const double of_n = 1 / contrast(n), of_m = 1 / contrast(m);
    const double signal = random_.log_uniform(1e2, 1e6);
    const double ambient = random_.below(2) != 0 ? random_.log_uniform(1e2, 1e6) : 0.0;
    for (int k = 0; k < measurements(); ++k)
      set(raw, k,
          table_.exposure_s[k] *
                  (signal * (of_n * table_.correlation(n, k) + of_m * table_.correlation(m, k)) +
                   ambient * table_.ambient_gain[k]) +
              table_.dark_electrons[k]);
  }

  void whole(float* raw) {
    if (random_.below(2) != 0) {
      const int most = 1 + random_.below(100);
      for (int k = 0; k < measurements(); ++k)
        raw[k] = static_cast<float>(random_.below(2 * most + 1) - most);
      return;
    }
    noisy(random_.log_uniform(1e2, 1e5), random_.log_uniform(1e2, 1e5), raw);
    std::transform(raw, raw + measurements(), raw, [](float value) { return std::round(value); });
  }

  void scaled(float* raw) {
    noisy(1e4, random_.log_uniform(1e2, 1e6), raw);
    const auto scale = static_cast<float>(random_.log_uniform(1e-30, 1e30));
    std::transform(raw, raw + measurements(), raw, [&](float value) { return scale * value; });
  }

  void odd(float* raw) {
    noisy(1e4, 1e4, raw);
    switch (random_.below(8)) {
      case 0:
        raw[random_.below(measurements())] = std::numeric_limits<float>::quiet_NaN();
        return;
      case 1:
        raw[random_.below(measurements())] = -std::numeric_limits<float>::infinity();
        return;
      case 2:
        std::fill_n(raw, measurements(), 0.0f);
        return;
      case 3:  // one different value
        std::fill_n(raw, measurements(), static_cast<float>(random_.below(1000)));
        raw[random_.below(measurements())] += static_cast<float>(random_.below(1000));
        return;
      case 4:  // one value is the next float
        std::fill_n(raw, measurements(), static_cast<float>(random_.log_uniform(1.0, 1e6)));
        raw[0] = std::nextafter(raw[0], 1e9f);
        return;
      default:  // extreme values
        for (int k = 0; k < measurements(); ++k)
          raw[k] = random_.below(2) != 0 ? 0.0f : static_cast<float>(random_.log_uniform(1.0, 1e5));
    }
  }

  const DecodingTable& table_;
  FastRandom random_;
};

}  // namespace

void fill_hard_pixels(const DecodingTable& table, std::uint64_t seed, int pixels, float* raw) {
  HardPixels source(table, seed);
  for (int i = 0; i < pixels; ++i) {
    const auto block = static_cast<std::uint64_t>(i / pixels_per_kind) + seed;
    source.fill(kinds[block % std::size(kinds)], raw + i * table.measurements());
  }
}

}  // namespace tofsmith::benchmarks
