// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Decoding throughput on one thread, beside a plain search in double and the time it takes to read
// raw numbers and write bins.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/random.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace {

using namespace tofsmith;

constexpr int side = 512;  // pixels of a frame, each way

struct Work {
  std::string code;
  int taps;
};
const Work works[] = {
    {"hamiltonian-k3", 1}, {"hamiltonian-k4", 1}, {"hamiltonian-k5", 1}, {"hamiltonian-k4", 2}};

/// A noisy frame at the middle operating point, depths at random.
struct Bench {
  Decoder decoder;
  RawFrames frame;
};

Bench make_bench(const benchmark::State& state) {
  const Work& work = works[state.range(0)];
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 240;
  camera.sensor.taps = work.taps;
  const CodeSet code = build_family(work.code, camera).resampled(static_cast<int>(state.range(1)));
  camera.samples = code.samples();
  const ForwardModel model(code, camera);
  Bench bench{Decoder(make_decoding_table(model, camera)), {}};

  const DecodingTable& table = bench.decoder.table();
  bench.frame = {1, side, side, table.measurements(), {}};
  RandomStream random(1, 0);
  for (int i = 0; i < side * side; ++i) {
    const auto n = static_cast<Eigen::Index>(table.samples() * random.uniform());
    for (int k = 0; k < table.measurements(); ++k) {
      const double mean =
          table.exposure_s[k] * (1e4 * table.correlation(n, k) + 1e4 * table.ambient_gain[k]);
      bench.frame.values.push_back(static_cast<float>(
          mean + std::sqrt(mean + table.constant_variance_e2[k]) * random.normal()));
    }
  }
  return bench;
}

void report_pixels(benchmark::State& state) {
  state.SetLabel(works[state.range(0)].code + (works[state.range(0)].taps == 2 ? " x 2" : ""));
  state.counters["pixels"] =
      benchmark::Counter(side * side, benchmark::Counter::kIsIterationInvariantRate);
}

void bins(benchmark::State& state) {
  const Bench bench = make_bench(state);
  std::vector<std::int32_t> found(side * side);
  for (auto _ : state) {
    bench.decoder.decode_bins(bench.frame.frame(0), side * side, found.data());
    benchmark::ClobberMemory();
  }
  report_pixels(state);
}

void depth_bins(benchmark::State& state) {
  const Bench bench = make_bench(state);
  std::vector<double> found(side * side);
  for (auto _ : state) {
    bench.decoder.decode_depth_bins(bench.frame.frame(0), side * side, found.data());
    benchmark::ClobberMemory();
  }
  report_pixels(state);
}

void depth_image(benchmark::State& state) {
  const Bench bench = make_bench(state);
  const ThreadLimit one(1);
  for (auto _ : state) benchmark::DoNotOptimize(bench.decoder.decode(bench.frame));
  report_pixels(state);
}

/// All correlations with the mean taken off, in double: what a script would do.
void plain_search(benchmark::State& state) {
  const Bench bench = make_bench(state);
  const Eigen::MatrixXd& correlation = bench.decoder.table().correlation;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> units =
      correlation.colwise() - correlation.rowwise().mean();
  units.rowwise().normalize();
  const auto k_count = units.cols();
  std::vector<std::int32_t> found(side * side);
  for (auto _ : state) {
    for (int i = 0; i < side * side; ++i) {
      const float* raw = bench.frame.frame(0) + i * k_count;
      double best = -1e300;
      for (Eigen::Index n = 0; n < units.rows(); ++n) {
        double score = 0.0;
        for (Eigen::Index k = 0; k < k_count; ++k) score += raw[k] * units(n, k);
        if (score > best) {
          best = score;
          found[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(n);
        }
      }
    }
    benchmark::ClobberMemory();
  }
  report_pixels(state);
}

/// The limit: reads every raw number and writes one number per pixel.
void read_and_write(benchmark::State& state) {
  const Bench bench = make_bench(state);
  const auto k_count = bench.decoder.measurements();
  std::vector<float> sums(side * side);
  for (auto _ : state) {
    const float* raw = bench.frame.frame(0);
    for (float& sum : sums) {
      sum = 0.0f;
      for (int k = 0; k < k_count; ++k) sum += *raw++;
    }
    benchmark::ClobberMemory();
  }
  report_pixels(state);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgsProduct({{0, 1, 2, 3}, {240, 1000}})
      ->ArgNames({"code", "N"})
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK(bins)->Apply(sizes);
BENCHMARK(depth_bins)->Apply(sizes);
BENCHMARK(depth_image)->Apply(sizes);
BENCHMARK(plain_search)->Apply(sizes);
BENCHMARK(read_and_write)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
