// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/time_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "decode/ambient_projection.hpp"
#include "decode/raw_scale.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {
namespace {

constexpr int height = 37, width = 45, pixels = height * width;

/// A block moves in front of a slanted plane.
std::vector<RawFrames> recording_of(const DecodingTable& table, int frames) {
  std::vector<RawFrames> recording;
  for (int frame = 0; frame < frames; ++frame) {
    const auto scene = [&](int row, int column) {
      const bool is_block = std::abs(row - 12) < 8 && std::abs(column - 8 - 2 * frame) < 6;
      return Seen{60.0 + 0.3 * row + 0.1 * column - (is_block ? 2.5 * frame : 0.0), 1e5};
    };
    recording.push_back(frame_seen(table, height, width, scene, 1e4, 7 + std::uint64_t(frame)));
  }
  return recording;
}

/// Reference filter for single, valid measurements.
class PlainTimeFilter {
 public:
  PlainTimeFilter(const DecodingTable& table, const TimeFilterOptions& options)
      : noise_(table),
        scale_(table),
        k_count_(table.measurements()),
        options_(options),
        tests_{ChangeTest(k_count_, options.max_difference_sigma),
               ChangeTest(patch_pixels * k_count_, options.max_difference_sigma),
               ChangeTest(k_count_, options.max_difference_sigma)} {}

  void add(const RawFrames& raw) {
    if (mean.empty()) {
      mean.assign(raw.values.begin(), raw.values.end());
      averaged.assign(pixels, 1.0);
      return;
    }
    compare(raw);
    std::vector<double> weights;
    for (int i = 0; i < pixels; ++i) weights.push_back(weight(i / width, i % width));
    for (std::size_t i = 0; i < pixels; ++i) {
      const double w = weights[i];
      for (std::size_t k = 0; k < static_cast<std::size_t>(k_count_); ++k) {
        double& m = mean[i * static_cast<std::size_t>(k_count_) + k];
        m = (w * m + static_cast<double>(raw.values[i * static_cast<std::size_t>(k_count_) + k])) /
            (w + 1);
      }
      averaged[i] = w > 0 ? (w + 1) * (w + 1) / (w * w / averaged[i] + 1) : 1.0;
    }
  }

  std::vector<double> mean, averaged;

 private:
  std::size_t at(int i, int k) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(k_count_) +
           static_cast<std::size_t>(k);
  }

  void compare(const RawFrames& raw) {
    difference_.assign(raw.values.size(), 0.0);
    chi2_.assign(pixels, 0.0);
    for (int i = 0; i < pixels; ++i)
      for (int k = 0; k < k_count_; ++k) {
        const double n = averaged[static_cast<std::size_t>(i)];
        const auto now = static_cast<double>(raw.values[at(i, k)]);
        const double both = (mean[at(i, k)] * n + now) / (n + 1);
        const double variance =
            (noise_.floor_variance_e2[k] + std::max(0.0, scale_.electrons(both, k))) * (1 / n + 1);
        const double d = scale_.electrons(now, k) - scale_.electrons(mean[at(i, k)], k);
        difference_[at(i, k)] = d / std::sqrt(variance);
        chi2_[static_cast<std::size_t>(i)] += d * d / variance;
      }
  }

  double weight(int row, int column) const {
    double patch = 0.0, count = 0.0, common = 0.0;
    std::vector<double> sums(static_cast<std::size_t>(k_count_), 0.0);
    for (int y = row - patch_reach; y <= row + patch_reach; ++y)
      for (int x = column - patch_reach; x <= column + patch_reach; ++x) {
        if (y < 0 || x < 0 || y >= height || x >= width) {
          patch += k_count_;  // neighbours outside the frame count as equal
          continue;
        }
        ++count;
        patch += chi2_[static_cast<std::size_t>(y * width + x)];
        for (int k = 0; k < k_count_; ++k)
          sums[static_cast<std::size_t>(k)] += difference_[at(y * width + x, k)];
      }
    for (const double sum : sums) common += sum * sum / count;
    const double n = averaged[static_cast<std::size_t>(row * width + column)];
    const std::array chi2 = {chi2_[static_cast<std::size_t>(row * width + column)], patch, common};
    const std::array per = {1.0, 1.0 * patch_pixels, 1.0 * patch_pixels};
    double share = 1.0, beyond = 0.0;
    for (std::size_t t = 0; t < 3; ++t) {
      share = std::min(share, static_cast<double>(tests_[t].share(static_cast<float>(chi2[t]))));
      beyond = std::max(
          beyond, static_cast<double>(tests_[t].beyond(static_cast<float>(chi2[t]))) / per[t]);
    }
    const double changed = (1 / n + 1) / k_count_ * beyond;
    return std::min(share * n / (1 + n * changed), options_.max_frames - 1.0);
  }

  ExpectedNoise noise_;
  RawScale scale_;
  int k_count_;
  TimeFilterOptions options_;
  std::array<ChangeTest, 3> tests_;
  std::vector<double> difference_, chi2_;
};

TEST(TimeKernel, EqualsTheReference) {
  for (const char* code : {"hamiltonian-k4", "sinusoid-k3", "hamiltonian-k5"}) {
    SCOPED_TRACE(code);
    const DecodingTable table = decoding_table_of(code, camera_with("paper-10f0"));
    const TimeFilterOptions options{.max_frames = 4};
    TimeFilter filter(table, options);
    PlainTimeFilter plain(table, options);
    int partly = 0, anew = 0;
    for (const RawFrames& raw : recording_of(table, 6)) {
      const RawView view = *filter.add(view_of_frame(raw, 0));
      plain.add(raw);
      const std::vector<float> values = values_of(view);
      for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_NEAR(static_cast<double>(values[i]), plain.mean[i], 2e-4 * std::abs(plain.mean[i]));
      for (std::size_t i = 0; i < pixels; ++i) {
        ASSERT_NEAR(static_cast<double>(view.averaged[i]), plain.averaged[i],
                    2e-3 * plain.averaged[i]);
        anew += plain.averaged[i] == 1.0;
        partly += plain.averaged[i] > 1.0 && plain.averaged[i] < 1.9;
      }
    }
    EXPECT_GT(anew - pixels, 50);  // pixels that restart, except in the first frame
    EXPECT_GT(partly, 0);
  }
}

TEST(TimeKernel, IsBitIdenticalOnEveryInstructionSet) {
  for (const auto& [code, camera] :
       {std::pair{"hamiltonian-k4", camera_with("paper-10f0")},
        {"square-k4", camera_with("paper-10f0", 2, Readout::difference)}}) {
    const DecodingTable table = decoding_table_of(code, camera);
    const auto recording = recording_of(table, 3);
    std::vector<float> first;
    for_each_target([&] {
      TimeFilter filter(table, {.before_filter = true});
      std::vector<float> values;
      for (const RawFrames& raw : recording) {
        const RawView view = *filter.add(view_of_frame(raw, 0));
        const std::vector<float> means = values_of(view);
        values.insert(values.end(), view.averaged, view.averaged + pixels);
        values.insert(values.end(), means.begin(), means.end());
      }
      if (first.empty()) first = values;
      EXPECT_EQ(values, first);
    });
  }
}

}  // namespace
}  // namespace tofsmith
