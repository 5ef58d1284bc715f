// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Depth-error trials per second and core, compared with random numbers only, decoding only, and the
// same experiment in NumPy (output of montecarlo_numpy.py).
//
//   benchmark_montecarlo [--rounds R] [--numpy FILE]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "asked_figures.hpp"
#include "decode_frame.hpp"
#include "in_turns.hpp"
#include "simulate/pixel_trials.hpp"
#include "tofsmith/core/build_info.hpp"

namespace tofsmith::benchmarks {
namespace {

constexpr std::int64_t trials_in_a_call = 1 << 17;
constexpr LightLevel light = light_levels[1];

/// Trials per second, by "code samples".
using PeerSpeeds = std::map<std::string, double>;

PeerSpeeds read_peer(const std::string& path) {
  PeerSpeeds speeds;
  std::ifstream file(path);
  std::string code, samples;
  double per_s = 0.0;
  while (file >> code >> samples >> per_s) speeds[fmt::format("{} {}", code, samples)] = per_s;
  return speeds;
}

/// A code at one light level with one noise model.
class Experiment {
 public:
  Experiment(const DecodeCode& code, int samples, NoiseModel noise)
      : code_(code),
        camera_(camera(code, samples, noise)),
        model_(forward_model(code, samples)),
        trials_(model_, camera_, {.trials = trials_in_a_call}),
        decoder_(make_decoding_table(model_, camera_)) {
    fill_raw();
  }

  void print(int rounds, const PeerSpeeds& peer, AskedFigures& asked) {
    const auto count = static_cast<double>(trials_in_a_call);
    std::vector<Contender> contenders;
    contenders.push_back({count, [this] { run(1); }});
    contenders.push_back({count, [this] { draw_numbers(); }});
    contenders.push_back({count, [this] { decoder_.decode(view_, {.depth_m = depth_m_.data()}); }});
    contenders.push_back(
        {count, [this] { decoder_.decode_bins(raw_.data(), trials_in_a_call, bin_.data()); }});
    const ThreadLimit one_core(1);
    const Turns turns(contenders, rounds);
    const auto millions = [&](std::size_t i) { return 1e-6 * turns.pixels_per_s(i); };
    const bool is_normal = camera_.sensor.noise == NoiseModel::gaussian;
    const auto at = peer.find(fmt::format("{} {}", code_.name, camera_.samples));
    const double numpy_per_s = at == peer.end() ? 0.0 : at->second;
    fmt::print("{:<5}{:>7} {:<9}|{:>9.1f} |{:>9.1f} |{:>9.1f}{:>7.2f}{:>7.2f} |{:>9.1f}{:>7.2f} |",
               code_.name, camera_.samples, is_normal ? "gaussian" : "poisson", millions(0),
               millions(1), millions(2), turns.speed_over(0, 2), turns.median_speed_over(0, 2),
               millions(3), turns.speed_over(0, 3));
    if (numpy_per_s > 0.0)
      fmt::print("{:>9.4f}{:>8.0f}", 1e-6 * numpy_per_s, turns.pixels_per_s(0) / numpy_per_s);
    fmt::print("\n");
    std::fflush(stdout);
    const std::string what = fmt::format("{}, N = {}: ", code_.name, camera_.samples);
    if (is_normal && camera_.samples == 1000)
      asked.at_least(what + "trials, share of decoding alone", turns.speed_over(0, 2), 0.5);
    if (is_normal && numpy_per_s > 0.0)
      asked.at_least(what + "trials over numpy", turns.pixels_per_s(0) / numpy_per_s, 100.0);
  }

  void print_threads(int rounds, AskedFigures& asked) {
    std::vector<Contender> contenders;
    for (const int threads : {1, 2})
      contenders.push_back({static_cast<double>(8 * trials_in_a_call), [this, threads] {
                              const ThreadLimit limit(threads);
                              run(8);
                            }});
    const Turns turns(contenders, rounds, CLOCK_MONOTONIC);
    asked.at_least(fmt::format("{}, N = {}: two threads over one", code_.name, camera_.samples),
                   turns.speed_over(1, 0), 1.9);
  }

 private:
  static Camera camera(const DecodeCode& code, int samples, NoiseModel noise) {
    Camera camera = decode_camera(code, samples);
    camera.sensor.noise = noise;
    camera.operating.signal_e_per_s = {light.signal_e_per_s};
    camera.operating.ambient_e_per_s = {light.ambient_e_per_s};
    return camera;
  }

  void run(int times) {
    std::vector<TrialRound> rounds;
    for (int i = 0; i < times; ++i) rounds.push_back({0, i * trials_in_a_call, trials_in_a_call});
    sums_ = sum_errors(trials_, rounds, 1.0, {});
  }

  /// Only the random numbers of the trials.
  void draw_numbers() {
    const int rank = decoder_.rank();
    const bool in_plane = trials_.draws_in_plane();
    const int normals = in_plane ? rank : trials_.measurements();
    for (std::int64_t first = 0; first < trials_in_a_call; first += trials_per_tile) {
      const TrialStreams streams{1, 0, static_cast<std::uint32_t>(first)};
      for (int i = 0; i < normals; i += 2) {
        if (i % 4 == 0)
          draw_words(streams, static_cast<std::uint32_t>(i / 4), trials_per_tile, tile_->words);
        const std::uint32_t* words = tile_->words + i % 4 * trials_per_tile;
        float* const row = tile_->normals + i * trials_per_tile;
        normals_of(words, words + trials_per_tile, trials_per_tile, row, row + trials_per_tile);
      }
      if (in_plane) continue;
      for (int k = 0; k < normals; ++k)
        draw_poisson(streams, k, trials_per_tile, mean_e_.data(), count_.data());
    }
  }

  void fill_raw() {
    const DepthTrials by_measurement(model_, camera_,
                                     {.trials = trials_in_a_call, .draw_every_measurement = true});
    const int k_count = by_measurement.measurements();
    raw_.resize(static_cast<std::size_t>(trials_in_a_call * k_count));
    for (std::int64_t first = 0; first < trials_in_a_call; first += trials_per_tile) {
      by_measurement.run({0, 0, trials_in_a_call}, {first, first + trials_per_tile}, *tile_);
      for (int i = 0; i < trials_per_tile; ++i)
        for (int k = 0; k < k_count; ++k)
          raw_[static_cast<std::size_t>((first + i) * k_count + k)] =
              tile_->taps[k * trials_per_tile + i];
    }
    constexpr int rows = 128;
    view_ =
        RawView::interleaved(raw_.data(), rows, static_cast<int>(trials_in_a_call / rows), k_count);
  }

  const DecodeCode& code_;
  Camera camera_;
  ForwardModel model_;
  DepthTrials trials_;
  Decoder decoder_;
  std::vector<float> raw_;
  RawView view_;
  std::vector<float> depth_m_ = std::vector<float>(trials_in_a_call);
  std::vector<std::int32_t> bin_ = std::vector<std::int32_t>(trials_in_a_call);
  std::vector<double> mean_e_ = std::vector<double>(trials_per_tile, 1000.0);
  std::vector<double> count_ = std::vector<double>(trials_per_tile);
  std::vector<ErrorSums> sums_;
  std::unique_ptr<TrialTile> tile_ = std::make_unique<TrialTile>();
};

}  // namespace
}  // namespace tofsmith::benchmarks

int main(int argc, char** argv) {
  using namespace tofsmith;
  using namespace tofsmith::benchmarks;
  CLI::App app("trials of depth error per second");
  int rounds = 15;
  std::string numpy;
  app.add_option("--rounds", rounds, "how often each is timed")->capture_default_str();
  app.add_option("--numpy", numpy, "what montecarlo_numpy.py printed")->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);

  const PeerSpeeds peer = numpy.empty() ? PeerSpeeds() : read_peer(numpy);
  AskedFigures asked;
  fmt::print(
      "camera paper-10f0, S = A = 1e4 e/s, one core, {}; millions per second\n"
      "share: trials over that, fastest rounds; median: of the rounds\n\n",
      dispatch_target());
  fmt::print("{:<5}{:>7} {:<9}|{:>9} |{:>9} |{:>9}{:>7}{:>7} |{:>9}{:>7} |{:>9}{:>8}\n", "code",
             "N", "noise", "trials", "numbers", "depths", "share", "median", "bins", "share",
             "numpy", "times");
  for (const int samples : {1000, 10000})
    for (const char* name : {"k3", "k4", "k5"})
      for (const NoiseModel noise : {NoiseModel::gaussian, NoiseModel::poisson}) {
        Experiment experiment(decode_code(name), samples, noise);
        experiment.print(rounds, peer, asked);
        if (samples == 1000 && noise == NoiseModel::gaussian)
          experiment.print_threads(rounds, asked);
      }
  asked.print();
  return 0;
}
