// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Decoding throughput compared with an upper bound and with other decoders, in alternation. Only
// ratios are meaningful.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "decode_throughput.hpp"
#include "in_turns.hpp"
#include "tofsmith/core/parallel.hpp"

namespace {

using namespace tofsmith;
using namespace tofsmith::benchmarks;

struct Options {
  std::vector<std::string> codes = {"k3", "k4", "k5", "two-bucket", "rank7"};
  std::vector<int> samples = {240, 1000, 10000};
  int rounds = 25;
  bool quick = false;
};

void print_throughput(const Options& options, AskedFigures& asked) {
  fmt::print(
      "One core, {} x {} pixels, Mpixel/s. share: of the speed at which the same numbers are read\n"
      "and as many bytes written, fastest against fastest (median: round by round). d S A: depth,\n"
      "signal, ambient light; d c st: depth, confidence, status; all: these, bins and deviation.\n"
      "brute: all bins in double, vectorized; times: bins by the decoder against it.\n\n",
      frame_width, frame_height);
  DecodeThroughput::print_heading();
  for (const std::string& code : options.codes)
    for (const int samples : options.samples) {
      const DecodeThroughput throughput(decode_code(code), samples);
      for (const Scene scene : {Scene::planes, Scene::random})
        for (const LightLevel& light : light_levels)
          if (!options.quick || light.noise == "medium")
            throughput.print(scene, light, options.rounds, asked);
    }
}

/// One frame on one and several threads, by wall-clock time; for comparison two independent halves
/// of the pixels, the maximum for two threads.
void print_cores(const std::string& code, int rounds, AskedFigures& asked) {
  const DecodingTable table = decoding_table(decode_code(code), 1000);
  const Decoder decoder(table);
  const int k_count = table.measurements();
  const std::vector<float> raw = noisy_frame(table, Scene::planes, light_levels[1]);
  const RawView view = RawView::interleaved(raw.data(), frame_height, frame_width, k_count);
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<int> thread_counts = {1};
  if (cores >= 2) thread_counts.push_back(2);
  if (cores > 2) thread_counts.push_back(cores);

  for (const OutputSet set : {OutputSet::bin, OutputSet::all}) {
    DecodedPlanes planes;
    std::vector<Contender> contenders;
    for (const int threads : thread_counts)
      contenders.push_back({frame_pixels, [&, threads] {
                              const ThreadLimit limit(threads);
                              decoder.decode(view, view_of(set, planes));
                            }});
    constexpr int half = frame_pixels / 2, repetitions = 4;  // amortizes the start of threads
    const auto decode_half = [&](int first) {
      for (int i = 0; i < repetitions; ++i)
        decoder.decode_bins(raw.data() + first * k_count, half, planes.bin.data() + first);
    };
    contenders.push_back({repetitions * frame_pixels, [&] {
                            decode_half(0);
                            decode_half(half);
                          }});
    contenders.push_back({repetitions * frame_pixels, [&] {
                            std::thread other(decode_half, half);
                            decode_half(0);
                            other.join();
                          }});
    const Turns turns(contenders, rounds, CLOCK_MONOTONIC);

    const char* outputs = set == OutputSet::bin ? "bins" : "all outputs";
    const std::size_t last = thread_counts.size() - 1;
    fmt::print("{:<11} {:<11}", code, outputs);
    for (std::size_t i = 0; i <= last; ++i)
      fmt::print(" |{:>3} core{} {:>7.1f} Mpixel/s {:>6.0f} frames/s {:>5.2f} x", thread_counts[i],
                 thread_counts[i] == 1 ? " " : "s", 1e-6 * turns.pixels_per_s(i),
                 turns.pixels_per_s(i) / frame_pixels, turns.speed_over(i, 0));
    const double machine = turns.speed_over(last + 2, last + 1);
    fmt::print(" | two halves apart {:.2f} x\n", machine);
    if (cores >= 2)
      asked.at_least(
          fmt::format("{}, {}: speed on 2 cores over 1 (machine: {:.2f})", code, outputs, machine),
          turns.speed_over(1, 0), 1.8);
    if (code == "k4" && set == OutputSet::bin)
      asked.at_least(fmt::format("k4, bins: VGA frames/s on {} cores", thread_counts[last]),
                     turns.pixels_per_s(last) / frame_pixels, 1000.0);
  }
}

int run(const Options& options) {
  AskedFigures asked;
  print_throughput(options, asked);
  fmt::print("\nBy the clock on the wall, N = 1000, planes, medium noise:\n");
  for (const std::string& code : options.codes) print_cores(code, 8 * options.rounds, asked);
  asked.print();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Decoding throughput beside its limit and its peers"};
  app.add_option("--code", options.codes, "k3, k4, k5, two-bucket, rank7; any number of them");
  app.add_option("--samples", options.samples, "N; any number of them");
  app.add_option("--rounds", options.rounds, "turns of each contender")
      ->check(CLI::Range(1, 100000));
  app.add_flag("--quick", options.quick, "medium noise only, 5 turns");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) options.rounds = std::min(options.rounds, 5);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "benchmark_decode: {}\n", error.what());
    return 1;
  }
}
