// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Speed of two-return decoding relative to the single-path decoder: a two-bucket Hamiltonian code
// with five exposures, on one core.
#include <fmt/format.h>

#include <cmath>

#include "asked_figures.hpp"
#include "fast_random.hpp"
#include "in_turns.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"

namespace tofsmith::benchmarks {
namespace {

constexpr int pixels = 32768;

/// In a fraction of the pixels there is a second return that one return cannot explain.
std::vector<float> frame(const DecodingTable& table, double share) {
  FastRandom random(11);
  std::vector<float> raw;
  constexpr double signal_e_per_s = 1e5, ambient_e_per_s = 1e4, ratio = 0.3;
  for (int i = 0; i < pixels; ++i) {
    const int bin = random.below(table.samples());
    const bool has_two = random.uniform() < share;
    const int delay = static_cast<int>(random.uniform(0.75, 3.0) / table.bin_m());
    const int later = (bin + delay) % table.samples();
    for (int k = 0; k < table.measurements(); ++k) {
      const double chi =
          table.correlation(bin, k) + (has_two ? ratio * table.correlation(later, k) : 0.0);
      const double mean =
          table.exposure_s[k] * (signal_e_per_s * chi + ambient_e_per_s * table.ambient_gain[k]);
      raw.push_back(static_cast<float>(mean + std::sqrt(mean + table.constant_variance_e2[k]) *
                                                  random.normal()));
    }
  }
  return raw;
}

void run() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  const DecodingTable table =
      make_decoding_table(ForwardModel(build_family("hamiltonian-k5", camera), camera), camera);
  const Decoder single(table);
  const TwoReturnDecoder two(table);
  const TailDecoder tail(table);
  DepthImage image(1, pixels), image_of_two(usual_planes(true), 1, pixels);
  const ThreadLimit one_core(1);
  AskedFigures asked;
  fmt::print("{:>22}{:>16}{:>16}{:>16}{:>12}{:>16}\n", "pixels of two returns", "single (us/px)",
             "two (us/px)", "tail (us/px)", "two/single", "us per two");
  double none_s = 0.0;
  for (const double share : {0.0, 0.1, 1.0}) {
    const std::vector<float> raw = frame(table, share);
    const RawView view = RawView::interleaved(raw.data(), 1, pixels, table.measurements());
    const Turns turns({{pixels, [&] { single.decode(view, DecodedView::of(image)); }},
                       {pixels, [&] { two.decode(view, DecodedView::of(image_of_two)); }},
                       {pixels, [&] { tail.decode(view, DecodedView::of(image_of_two)); }}},
                      7);
    if (share == 0.0) none_s = turns.min_s(1);
    const double per_two_us = share > 0.0 ? 1e6 * (turns.min_s(1) - none_s) / share : 0.0;
    fmt::print("{:>20.0f} %{:>16.4f}{:>16.4f}{:>16.4f}{:>12.3f}{:>16.3f}\n", 100 * share,
               1e6 * turns.min_s(0), 1e6 * turns.min_s(1), 1e6 * turns.min_s(2),
               turns.speed_over(1, 0), per_two_us);
    if (share == 1.0) asked.at_most("us per ambiguous pixel", per_two_us, 5.0);
    if (share == 0.1)
      asked.at_least("speed with 10 % ambiguous over single-path", turns.speed_over(1, 0),
                     1.0 / 3.0);
  }
  asked.print();
}

}  // namespace
}  // namespace tofsmith::benchmarks

int main() { tofsmith::benchmarks::run(); }
