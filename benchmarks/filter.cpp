// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Frames per second of the spatial and temporal filters (VGA, four measurements), compared with
// copying and decoding the same frame.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "asked_figures.hpp"
#include "decode_frame.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith::benchmarks {
namespace {

/// Shortest of several runs, with the least interference [s].
template <typename Work>
double seconds_of(const Work& work) {
  constexpr int runs = 7;
  double shortest = std::numeric_limits<double>::infinity();
  work();
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    shortest = std::min(
        shortest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return shortest;
}

struct NamedTimeFilter {
  const char* name;
  TimeFilterOptions options;
};
const std::array time_filters = {
    NamedTimeFilter{"in time", {}},
    NamedTimeFilter{"in time, before a filter in space", {.before_filter = true}},
    NamedTimeFilter{"in time, looking 4 frames ahead", {.look_ahead = 4}},
    NamedTimeFilter{"in time, looking 16 frames ahead", {.look_ahead = 16}}};

/// Memory of a temporal filter, in frames of K floats per pixel.
double frames_held(const TimeFilterOptions& options) {
  return static_cast<double>(TimeFilter::memory_bytes(options, frame_height, frame_width, 4, 1)) /
         (sizeof(float) * 4.0 * frame_pixels);
}

void measure(const LightLevel& light, AskedFigures& asked) {
  const DecodingTable table = decoding_table(decode_code("k4"), 240);
  const std::vector<float> raw = noisy_frame(table, Scene::planes, light);
  const RawView view =
      RawView::interleaved(raw.data(), frame_height, frame_width, table.measurements());
  std::vector<float> copy(raw.size());
  const double copied = seconds_of([&] { std::copy(raw.begin(), raw.end(), copy.begin()); });
  const Decoder decoder(table);
  DecodedPlanes planes;
  const auto rates = [&](int threads) {
    const ThreadLimit limit(threads);
    const double decoded =
        seconds_of([&] { decoder.decode(view, view_of(OutputSet::all, planes)); });
    fmt::print("{} thread{}, {} noise: decoding all outputs {:.0f} frames/s\n", threads,
               threads == 1 ? "" : "s", light.noise, 1 / decoded);
    for (const FilterStrength strength : all_values<FilterStrength>) {
      const Filter filter(table, FilterOptions::of(strength));
      FilteredFrame filtered;
      const double seconds = seconds_of([&] { filter.apply(view, filtered); });
      fmt::print("  {:<8}{:>8.1f} frames/s, {:>6.1f} times decoding, {:>7.0f} times copying\n",
                 name_of(strength), 1 / seconds, seconds / decoded, seconds / copied);
      const std::string what =
          fmt::format("{} filter, frames/s on {} thread{}, {} noise", name_of(strength), threads,
                      threads == 1 ? "" : "s", light.noise);
      if (strength == FilterStrength::normal)
        asked.at_least(what, 1 / seconds, threads == 1 ? 15 : 30);
      if (strength == FilterStrength::light && threads == 1) asked.at_least(what, 1 / seconds, 60);
    }
    for (const auto& [name, options] : time_filters) {
      TimeFilter filter(table, options);
      for (int frame = 0; frame < options.look_ahead; ++frame) filter.add(view);  // pre-fill
      const double seconds = seconds_of([&] { filter.add(view); });
      fmt::print("  {:<34}{:>8.1f} frames/s, {:>6.1f} times decoding, {:>7.0f} times copying\n",
                 name, 1 / seconds, seconds / decoded, seconds / copied);
    }
  };
  rates(1);
  rates(2);
}

}  // namespace
}  // namespace tofsmith::benchmarks

int main() {
  using namespace tofsmith;
  using namespace tofsmith::benchmarks;
  AskedFigures asked;
  for (const LightLevel& light : light_levels) measure(light, asked);
  asked.at_most("memory of a normal filter, frames of K floats a pixel",
                static_cast<double>(Filter::memory_bytes({}, frame_height, frame_width, 4, 1)) /
                    (sizeof(float) * 4.0 * frame_pixels),
                6);
  for (const auto& [name, options] : time_filters)
    fmt::print("memory {}: {:.1f} frames of K floats a pixel\n", name, frames_held(options));
  asked.print();
}
