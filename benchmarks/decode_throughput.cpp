// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_throughput.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>
#include <type_traits>

#include "in_turns.hpp"
#include "reference_bins.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith::benchmarks {

namespace {

/// Target for bins at N = 1000 and medium noise, as a fraction of the read-write limit.
std::optional<double> asked_share(std::string_view code) {
  if (code == "k3") return 1.0 / 3.0;
  if (code == "k4") return 1.0 / 4.0;
  if (code == "k5" || code == "two-bucket") return 1.0 / 6.0;
  return std::nullopt;
}

/// Reads every raw value and writes every value of the requested planes, a few thousand pixels at a
/// time: the minimum work of a decoder.
void read_and_write(const std::vector<float>& raw, int measurements, const DecodedView& planes) {
  constexpr int block = 4096;
  const int pixels = static_cast<int>(raw.size()) / measurements;
  for (int first = 0; first < pixels; first += block) {
    const int count = std::min(block, pixels - first);
    const float* numbers = raw.data() + static_cast<std::ptrdiff_t>(first) * measurements;
    std::uint32_t seen = 0;
    for (int i = 0; i < count * measurements; ++i) {
      std::uint32_t bits;
      std::memcpy(&bits, numbers + i, sizeof bits);
      seen |= bits;
    }
    const auto value = static_cast<std::int32_t>(seen >> 9);
    for_each_plane(
        [&]<typename Value>(Value* plane) {
          if (plane != nullptr)
            std::fill_n(plane + first, count,
                        static_cast<Value>(std::is_enum_v<Value> ? value & 1 : value));
        },
        planes);
    asm volatile("" ::: "memory");
  }
}

/// Pixels spread over a frame, for slow decoders.
std::vector<float> some_pixels(const std::vector<float>& raw, int measurements, int count) {
  std::vector<float> some;
  for (int i = 0; i < count; ++i) {
    const auto first = raw.begin() + std::ptrdiff_t{frame_pixels / count} * i * measurements;
    some.insert(some.end(), first, first + measurements);
  }
  return some;
}

}  // namespace

DecodeThroughput::DecodeThroughput(const DecodeCode& code, int samples)
    : code_(code), table_(decoding_table(code, samples)), decoder_(table_), curve_(table_) {}

void DecodeThroughput::print_heading() {
  fmt::print(
      "{:<11}{:>2}{:>5}{:>7} {:<7}{:<7}|{:>8} {:>6} {:>6} |{:>8} {:>6} |{:>8} {:>6} |"
      "{:>8} {:>6} |{:>8} {:>6} {:>6} |{:>7} {:>7}\n",
      "code", "K", "rank", "N", "scene", "noise", "bin", "share", "median", "depth", "share",
      "d S A", "share", "d c st", "share", "all", "share", "/ bin", "brute", "times");
}

void DecodeThroughput::print(Scene scene, const LightLevel& light, int rounds,
                             AskedFigures& asked) const {
  const int k_count = table_.measurements();
  const std::vector<float> raw = noisy_frame(table_, scene, light);
  const RawView view = RawView::interleaved(raw.data(), frame_height, frame_width, k_count);
  DecodedPlanes planes;
  const ThreadLimit one_core(1);

  std::vector<Contender> contenders;
  for (const OutputSet set : output_sets) {
    const DecodedView wanted = view_of(set, planes);
    contenders.push_back({frame_pixels, [&, wanted] { decoder_.decode(view, wanted); }});
    contenders.push_back({frame_pixels, [&, wanted] { read_and_write(raw, k_count, wanted); }});
  }
  const int brute_pixels = std::clamp(2'000'000 / table_.samples(), 64, 4096);
  const std::vector<float> for_brute_force = some_pixels(raw, k_count, brute_pixels);
  std::vector<ReferencePixel> projected(static_cast<std::size_t>(brute_pixels));
  contenders.push_back({static_cast<double>(brute_pixels), [&] {
                          for (int i = 0; i < brute_pixels; ++i)
                            projected[static_cast<std::size_t>(i)] =
                                curve_.project(for_brute_force.data() + i * k_count);
                          bins_by_brute_force(curve_, projected.data(), brute_pixels,
                                              planes.bin.data());
                        }});
  const Turns turns(contenders, rounds);

  const auto mpixels = [&](std::size_t i) { return 1e-6 * turns.pixels_per_s(i); };
  const auto share = [&](std::size_t i) { return turns.speed_over(i, i + 1); };
  const std::size_t bin = 0, all = 8, brute = 10;
  fmt::print("{:<11}{:>2}{:>5}{:>7} {:<7}{:<7}|{:>8.1f} {:>6.3f} {:>6.3f} |", code_.name, k_count,
             curve_.rank(), table_.samples(), scene == Scene::planes ? "planes" : "random",
             light.noise, mpixels(bin), share(bin), turns.median_speed_over(bin, bin + 1));
  for (std::size_t i = 2; i < all; i += 2) fmt::print("{:>8.1f} {:>6.3f} |", mpixels(i), share(i));
  fmt::print("{:>8.1f} {:>6.3f} {:>6.3f} |{:>7.2f} {:>7.1f}\n", mpixels(all), share(all),
             turns.speed_over(all, bin), mpixels(brute), turns.speed_over(bin, brute));
  std::fflush(stdout);

  if (light.noise != "medium") return;
  const std::string what = fmt::format("{}, N = {}, {}", code_.name, table_.samples(),
                                       scene == Scene::planes ? "planes" : "random depths");
  if (table_.samples() == 1000) {
    if (const auto least = asked_share(code_.name)) {
      asked.at_least(what + ": bins, share of limit", share(bin), *least);
      asked.at_least(what + ": all outputs, share of their limit", share(all), 0.6 * *least);
    }
    asked.at_least(what + ": all outputs, speed over bins", turns.speed_over(all, bin), 0.6);
  }
  if (table_.samples() == 10000 && code_.name == "rank7")
    asked.at_least(what + ": bins, speed over brute force", turns.speed_over(bin, brute), 10.0);
}

}  // namespace tofsmith::benchmarks
