// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Wrong wrap counts of multi-frequency codes: without noise for random frequencies, and with noise
// compared with exact maximum likelihood on the continuous model.
//
//   benchmark_wraps [SETS] [PIXELS PER SET] [SEED]     (default: 1000 sets of 10000 pixels)
//   benchmark_wraps --noise [PIXELS PER LEVEL]         (default: 100000)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <string_view>

#include "core/shared/random.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace {

using namespace tofsmith;
using Frequencies = std::vector<FrequencySteps>;

constexpr double turn = 2.0 * std::numbers::pi;

std::string name_of(const Frequencies& list) {
  std::string name = "multifrequency";
  for (const auto& [frequency, steps] : list) name += fmt::format("-{}x{}", frequency, steps);
  return name;
}

/// Differences of two buckets, f0 = 1 MHz, no impulse responses.
Camera ideal_camera() {
  Camera camera;
  camera.operating = paper_operating_range();
  camera.fundamental_frequency_hz = 1e6;
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  return camera;
}

double phase_of(const FrequencySteps& f, int step) {
  return turn * step / (f.steps == 2 ? 4 : f.steps);
}

/// Differences of the buckets for unit amplitude, plus normal noise.
void append_pixel(const Frequencies& list, double periods, double noise, RandomStream& random,
                  std::vector<float>& raw) {
  for (const FrequencySteps& f : list)
    for (int step = 0; step < f.steps; ++step)
      raw.push_back(static_cast<float>(std::cos(turn * f.frequency * periods - phase_of(f, step)) +
                                       (noise > 0.0 ? noise * random.normal() : 0.0)));
}

Decoder decoder_of(const Frequencies& list) {
  const Camera camera = ideal_camera();
  return Decoder(
      make_decoding_table(ForwardModel(build_family(name_of(list), camera), camera), camera));
}

std::vector<float> decoded_m(const Decoder& decoder, const std::vector<float>& raw) {
  const auto pixels = static_cast<int>(std::ssize(raw) / decoder.measurements());
  std::vector<float> depth_m(static_cast<std::size_t>(pixels));
  DecodedView planes;
  planes.depth_m = depth_m.data();
  decoder.decode(RawView::interleaved(raw.data(), 1, pixels, decoder.measurements()), planes);
  return depth_m;
}

Frequencies random_frequencies(RandomStream& random) {
  for (;;) {
    Frequencies list;
    int common = 0;
    const int count = random.uniform() < 0.5 ? 2 : 3;
    for (int i = 0; i < count; ++i) {
      list.push_back({1 + static_cast<int>(400 * random.uniform()),
                      2 + static_cast<int>(5 * random.uniform())});
      common = std::gcd(common, list.back().frequency);
    }
    if (common == 1) return list;
  }
}

int without_noise(int sets, int pixels, std::uint64_t seed) {
  std::int64_t wrong = 0;
  double largest_m = 0.0;
  for (int set = 0; set < sets; ++set) {
    RandomStream random(seed, static_cast<std::uint64_t>(set));
    const Frequencies list = random_frequencies(random);
    const Decoder decoder = decoder_of(list);
    const double range_m = decoder.table().range_m;
    // Wrong wraps are off by at least half a period of the highest frequency.
    int highest = 1;
    for (const FrequencySteps& f : list) highest = std::max(highest, f.frequency);
    std::vector<double> truth_m;
    std::vector<float> raw;
    for (int i = 0; i < pixels; ++i) {
      const double periods = random.uniform();
      truth_m.push_back(periods * range_m);
      append_pixel(list, periods, 0.0, random, raw);
    }
    const std::vector<float> found_m = decoded_m(decoder, raw);
    std::int64_t wrong_here = 0;
    double largest_here_m = 0.0;
    for (std::size_t i = 0; i < truth_m.size(); ++i) {
      const double error_m = std::abs(circular_difference(found_m[i], truth_m[i], range_m));
      if (!(error_m < 0.25 * range_m / highest))
        ++wrong_here;
      else
        largest_here_m = std::max(largest_here_m, error_m);
    }
    if (wrong_here > 0 || largest_here_m > 2e-5)
      fmt::print("{}: {} wrong wraps, largest other error {:.4f} mm\n", name_of(list), wrong_here,
                 1e3 * largest_here_m);
    wrong += wrong_here;
    largest_m = std::max(largest_m, largest_here_m);
  }
  fmt::print("{} wrong wraps in {} pixels of {} sets, largest other error {:.4f} mm\n", wrong,
             std::int64_t{sets} * pixels, sets, 1e3 * largest_m);
  return wrong > 0 ? 1 : 0;
}

/// argmax_z Re sum_f phasor_f exp(-2 pi i f z) [periods]: maximum likelihood for equal noise in all
/// measurements and unknown signal, by brute force and Newton steps.
double most_likely(const Frequencies& list, const float* raw) {
  std::vector<std::complex<double>> phasor;
  int highest = 1;
  for (const FrequencySteps& f : list) {
    std::complex<double> sum = 0.0;
    for (int step = 0; step < f.steps; ++step)
      sum += static_cast<double>(*raw++) * std::polar(1.0, phase_of(f, step));
    phasor.push_back(sum);
    highest = std::max(highest, f.frequency);
  }
  const auto at = [&](double z, int order) {
    std::complex<double> sum = 0.0;
    for (std::size_t j = 0; j < list.size(); ++j)
      sum += phasor[j] * std::polar(1.0, -turn * list[j].frequency * z) *
             std::pow(std::complex<double>(0.0, -turn * list[j].frequency), order);
    return sum.real();
  };
  const int points = 24 * highest;
  std::vector<double> score(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i)
    score[static_cast<std::size_t>(i)] = at(static_cast<double>(i) / points, 0);
  const double most = *std::max_element(score.begin(), score.end());
  double best = 0.0, best_score = -1e300;
  for (int i = 0; i < points; ++i) {
    const double here = score[static_cast<std::size_t>(i)];
    if (here < most - 0.1 * std::abs(most) ||
        here < score[static_cast<std::size_t>((i + 1) % points)] ||
        here < score[static_cast<std::size_t>((i + points - 1) % points)])
      continue;
    double z = static_cast<double>(i) / points;
    for (int step = 0; step < 4; ++step) z -= at(z, 1) / at(z, 2);
    if (at(z, 0) > best_score) best_score = at(z, 0), best = z;
  }
  return best;
}

void in_noise(int pixels) {
  fmt::print("| code | noise / amplitude | wrong, maximum likelihood | wrong, zncc | ratio |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const Frequencies& list :
       {Frequencies{{7, 4}, {8, 4}}, Frequencies{{19, 4}, {20, 4}}, Frequencies{{59, 4}, {60, 4}},
        Frequencies{{83, 4}, {100, 4}}, Frequencies{{2, 3}, {10, 3}, {15, 3}},
        Frequencies{{29, 4}, {30, 4}, {31, 4}}}) {
    const Decoder decoder = decoder_of(list);
    double spread = 0.0;  // of wraps: their distance decreases with the RMS frequency
    for (const FrequencySteps& f : list) spread += f.frequency * f.frequency;
    const double scale = list.size() == 2 ? 1.0 / std::sqrt(spread) : 0.5 / std::pow(spread, 0.25);
    for (const double level : {1.0, 1.5, 2.5}) {
      const double noise = level * scale;
      RandomStream random(1, 0);
      std::int64_t wrong_ml = 0, wrong_zncc = 0;
      int highest = 1;
      for (const FrequencySteps& f : list) highest = std::max(highest, f.frequency);
      std::vector<double> truth;
      std::vector<float> raw;
      for (int i = 0; i < pixels; ++i) {
        truth.push_back(random.uniform());
        append_pixel(list, truth.back(), noise, random, raw);
      }
      const std::vector<float> found_m = decoded_m(decoder, raw);
      for (int i = 0; i < pixels; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const auto is_wrong = [&](double periods) {
          return std::abs(circular_difference(periods, truth[at], 1.0)) > 0.25 / highest;
        };
        wrong_ml += is_wrong(
            most_likely(list, &raw[at * static_cast<std::size_t>(decoder.measurements())]));
        wrong_zncc += is_wrong(found_m[at] / decoder.table().range_m);
      }
      fmt::print("| {} | {:.4f} | {:.4f} % | {:.4f} % | {:.3f} |\n", name_of(list), noise,
                 100.0 * static_cast<double>(wrong_ml) / pixels,
                 100.0 * static_cast<double>(wrong_zncc) / pixels,
                 static_cast<double>(wrong_zncc) /
                     static_cast<double>(std::max<std::int64_t>(1, wrong_ml)));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::atoi(argv[i]) : otherwise;
  };
  if (argc > 1 && std::string_view(argv[1]) == "--noise") {
    in_noise(number(2, 100000));
    return 0;
  }
  return without_noise(number(1, 1000), number(2, 10000), static_cast<std::uint64_t>(number(3, 1)));
}
