// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Compares the decoder's bins with brute force in double precision on every instruction set of this
// machine. A sample of the reference bins is compared with the definition of the decoder. Different
// bins are a mismatch unless their scores are equal within the rounding of the reference; such ties
// are counted separately.
#include <fmt/format.h>
#include <hwy/targets.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "decode_frame.hpp"
#include "exactness_pixels.hpp"
#include "reference_bins.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/parallel.hpp"

namespace {

using namespace tofsmith;
using namespace tofsmith::benchmarks;

struct Options {
  std::vector<std::string> codes = {"k3", "k4", "k5", "two-bucket", "rank7"};
  std::vector<int> samples = {240, 1000, 10000};
  double pixels = 1e9;       // at N = 240, in total
  double fine_pixels = 1e7;  // at finer N, per code and target
  std::uint64_t seed = 1;
};

/// Largest N that is compared on many pixels.
constexpr int coarse_samples = 240;

struct Counts {
  std::int64_t decoded = 0;
  std::int64_t mismatches = 0;
  std::int64_t ties = 0;  // equal within rounding
};

/// Reference and decoder of a code, and the current pixels.
class Comparison {
 public:
  Comparison(const DecodeCode& code, int samples)
      : table_(decoding_table(code, samples)),
        decoder_(table_),
        curve_(table_),
        definition_(table_) {}

  static constexpr int block = 16 * pixels_per_kind;
  static constexpr int blocks = 16;
  static constexpr int chunk = blocks * block;

  /// Generates pixels with their reference bins.
  void make(std::uint64_t seed, int pixels);
  /// Decodes them with the selected instruction set.
  Counts compare() const;
  int rank() const { return curve_.rank(); }
  std::int64_t held_against_definition() const { return held_; }

 private:
  void check_sample(const float* raw, const ReferencePixel* pixels, const std::int32_t* bin);
  bool is_tie(std::size_t pixel, std::int32_t found) const;

  DecodingTable table_;
  Decoder decoder_;
  ReferenceCurve curve_;
  ReferenceDecoder definition_;
  int pixels_ = 0;
  std::vector<float> raw_;
  std::vector<std::int32_t> expected_;
  std::int64_t held_ = 0;
};

void Comparison::make(std::uint64_t seed, int pixels) {
  pixels_ = pixels;
  const auto k_count = static_cast<std::size_t>(table_.measurements());
  raw_.resize(static_cast<std::size_t>(pixels) * k_count);
  expected_.resize(static_cast<std::size_t>(pixels));
  parallel_for_blocks(pixels, block, [&](IndexRange range) {
    const auto first = static_cast<std::size_t>(range.begin);
    const auto count = static_cast<std::size_t>(range.end - range.begin);
    fill_hard_pixels(table_, combine_keys(seed, first), static_cast<int>(count),
                     &raw_[first * k_count]);
    std::vector<ReferencePixel> projected(count);
    for (std::size_t i = 0; i < count; ++i)
      projected[i] = curve_.project(&raw_[(first + i) * k_count]);
    bins_by_brute_force(curve_, projected.data(), static_cast<int>(count), &expected_[first]);
    for (std::size_t i = 0; i < count; ++i) {
      std::int32_t& bin = expected_[first + i];
      bin = projected[i].is_number ? table_.nearest_bin(bin) : -1;
    }
  });
  for (std::size_t i = seed % 997; i < expected_.size(); i += 9973) {  // a sample
    if (expected_[i] < 0) continue;
    const int bin = definition_.bin(&raw_[i * k_count]);
    require(bin == expected_[i] || is_tie(i, bin), "reference bin", expected_[i],
            "must be that of the definition");
    ++held_;
  }
}

/// Returns true if only rounding decides between the bins.
bool Comparison::is_tie(std::size_t pixel, std::int32_t found) const {
  const std::int32_t expected = expected_[pixel];
  if (found < 0 || expected < 0) return false;
  const ReferencePixel reference =
      curve_.project(&raw_[pixel * static_cast<std::size_t>(table_.measurements())]);
  const std::int32_t lower = std::min(found, expected), higher = std::max(found, expected);
  double best = -1.0, of_lower = -1.0, of_higher = -1.0;
  for (int row = 0; row < curve_.samples(); ++row) {
    const double score = curve_.score(reference, row);
    best = std::max(best, score);
    // Tables that a decoder refines have several rows per bin.
    const std::int32_t bin = table_.nearest_bin(row);
    if (bin == lower) of_lower = std::max(of_lower, score);
    if (bin == higher) of_higher = std::max(of_higher, score);
  }
  // The lower bin is correct if it ties with the best, otherwise the higher one.
  return std::abs(best - of_lower - reference.tie) <= reference.rounding &&
         best - of_higher <= reference.tie + reference.rounding;
}

Counts Comparison::compare() const {
  std::atomic<std::int64_t> mismatches = 0, ties = 0;
  parallel_for_blocks(pixels_, block, [&](IndexRange range) {
    const auto first = static_cast<std::size_t>(range.begin);
    const auto count = static_cast<std::size_t>(range.end - range.begin);
    std::vector<std::int32_t> bin(count);
    decoder_.decode_bins(&raw_[first * static_cast<std::size_t>(table_.measurements())],
                         range.end - range.begin, bin.data());
    for (std::size_t i = 0; i < count; ++i)
      if (bin[i] != expected_[first + i]) ++(is_tie(first + i, bin[i]) ? ties : mismatches);
  });
  return {pixels_, mismatches, ties};
}

void show(const std::string& text) {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\033[K{}", text);
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Counts compare_all_targets(const DecodeCode& code, int samples, const Options& options) {
  std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  std::erase_if(targets, [with_kernels = dispatch_targets()](std::int64_t target) {
    return std::ranges::find(with_kernels, hwy::TargetName(target)) == with_kernels.end();
  });
  const double start = now_s();
  Comparison comparison(code, samples);
  const double of_each =
      samples <= coarse_samples
          ? options.pixels / static_cast<double>(options.codes.size() * targets.size())
          : options.fine_pixels;
  const auto pixels = static_cast<std::int64_t>(std::ceil(of_each));
  std::vector<Counts> counts(targets.size());
  double reference_s = 0.0;
  for (std::int64_t first = 0; first < pixels; first += Comparison::chunk) {
    show(fmt::format("{}, N = {}: {:.0f} %", code.name, samples,
                     100.0 * static_cast<double>(first) / static_cast<double>(pixels)));
    const double begin = now_s();
    comparison.make(combine_keys(options.seed, static_cast<std::uint64_t>(first)),
                    static_cast<int>(std::min<std::int64_t>(Comparison::chunk, pixels - first)));
    reference_s += now_s() - begin;
    for (std::size_t t = 0; t < targets.size(); ++t) {
      hwy::SetSupportedTargetsForTest(targets[t]);
      const Counts now = comparison.compare();
      counts[t].decoded += now.decoded;
      counts[t].mismatches += now.mismatches;
      counts[t].ties += now.ties;
    }
    hwy::SetSupportedTargetsForTest(0);
  }
  show("");
  Counts sum;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    fmt::print("{:<11}{:>5}{:>7} {:<10}{:>14}{:>12}{:>8}\n", code.name, comparison.rank(), samples,
               hwy::TargetName(targets[t]), counts[t].decoded, counts[t].mismatches,
               counts[t].ties);
    sum.decoded += counts[t].decoded;
    sum.mismatches += counts[t].mismatches;
    sum.ties += counts[t].ties;
  }
  fmt::print(
      "    {:.0f} s, of which {:.0f} s are pixels and reference; {} of its bins held against the "
      "definition\n",
      now_s() - start, reference_s, comparison.held_against_definition());
  std::fflush(stdout);
  return sum;
}

int run(const Options& options) {
  fmt::print("{:<11}{:>5}{:>7} {:<10}{:>14}{:>12}{:>8}\n", "code", "rank", "N", "target", "pixels",
             "mismatches", "ties");
  std::int64_t mismatches = 0;
  for (const int samples : options.samples) {
    Counts sum;
    for (const std::string& code : options.codes) {
      const Counts counts = compare_all_targets(decode_code(code), samples, options);
      sum.decoded += counts.decoded;
      sum.mismatches += counts.mismatches;
      sum.ties += counts.ties;
    }
    fmt::print(
        "N = {}: {} mismatches in {} decoded pixels (asked: 0), {} ties to within rounding\n",
        samples, sum.mismatches, sum.decoded, sum.ties);
    std::fflush(stdout);
    mismatches += sum.mismatches;
  }
  return mismatches == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  bool is_quick = false;
  CLI::App app{"The decoder's bins against a double-precision reference on every instruction set"};
  app.add_option("--code", options.codes, "k3, k4, k5, two-bucket, rank7; any number of them");
  app.add_option("--samples", options.samples, "N; any number of them");
  app.add_option("--pixels", options.pixels,
                 "decoded at each N up to 240, over all codes and targets");
  app.add_option("--fine-pixels", options.fine_pixels, "of each code and target at finer N");
  app.add_option("--seed", options.seed, "of the pixels");
  app.add_flag("--quick", is_quick, "a thousandth of the pixels");
  CLI11_PARSE(app, argc, argv);
  if (is_quick) {
    options.pixels *= 1e-3;
    options.fine_pixels *= 1e-3;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "benchmark_decode_exactness: {}\n", error.what());
    return 1;
  }
}
