// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Recordings whose frames are added up by something else than this computer's processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "decode_recording_fixture.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {
namespace {

using FramesElsewhereTest = DecodeRecording;

/// As a device: a filter in time, whose frames it keeps.
struct KeptFrames {
  bool takes(std::int64_t pixels) const { return pixels >= min_pixels; }
  void add(const RawView&) { ++added; }
  void take_mean(double averaged) { mean_of = averaged * std::exchange(added, 0); }
  void take(const RawView& raw) { frame = filter.add(raw); }
  RawView numbers() {
    ++asked;
    return *frame;
  }

  TimeFilter filter;
  std::optional<RawView> frame = {};
  int min_pixels = 0, added = 0, asked = 0;
  double mean_of = 0.0;
};

TEST_F(FramesElsewhereTest, AddsFramesUpWhereTheRequestSays) {
  const Decoder& decoder = std::get<Decoder>(decoder_);
  DecodeRequest added = request("added.npy");
  added.time_filter = TimeFilterOptions{.max_frames = 5};
  added.stack = true;
  added.outputs = {DecodedPlane::depth};
  decode_recording(added, decoder_);
  for (const int min_pixels : {0, 1000}) {
    KeptFrames kept{.filter = TimeFilter(decoder.table(), *time_filter_of(added)),
                    .min_pixels = min_pixels};
    added.frames_by = FramesElsewhere::of(kept);
    added.decode_by = [&](const RawView& raw, const DecodedView& decoded, const Progress&) {
      EXPECT_EQ(std::get<const float*>(raw.data) == nullptr, min_pixels == 0);
      decoder.decode(min_pixels == 0 ? *kept.frame : raw, decoded);
    };
    added.output = added.output.parent_path() / ("by" + std::to_string(min_pixels) + ".npy");
    decode_recording(added, decoder_);
    EXPECT_EQ(kept.asked, 0) << "nobody reads them here";
    const std::string name = added.output.filename();
    for (std::size_t f = 0; f < 3; ++f) EXPECT_EQ(plane(name.c_str(), f), plane("added.npy", f));
  }
}

TEST_F(FramesElsewhereTest, TakesNoMemoryHereForWhatIsAddedUpThere) {
  const Decoder& decoder = std::get<Decoder>(decoder_);
  DecodeRequest added = request("there.npy");
  added.time_filter = TimeFilterOptions{};
  added.outputs = {DecodedPlane::depth};
  added.stack = true;
  added.memory_mb = 1.3e-3;
  EXPECT_THROW(decode_recording(added, decoder_), IoError);
  KeptFrames kept{.filter = TimeFilter(decoder.table(), *time_filter_of(added))};
  added.frames_by = FramesElsewhere::of(kept);
  added.decode_by = [&](const RawView&, const DecodedView& decoded, const Progress&) {
    decoder.decode(*kept.frame, decoded);
  };
  EXPECT_EQ(decode_recording(added, decoder_).frames.size(), 3u);
}

TEST_F(FramesElsewhereTest, BringsFramesBackThatWereAddedUpElsewhereWhereTheyAreRead) {
  const Decoder& decoder = std::get<Decoder>(decoder_);
  DecodeRequest added = request("all.npy");
  added.time_filter = TimeFilterOptions{.max_frames = 5};
  added.stack = true;
  added.outputs = {DecodedPlane::depth, DecodedPlane::averaged};
  decode_recording(added, decoder_);
  KeptFrames kept{.filter = TimeFilter(decoder.table(), *time_filter_of(added))};
  added.frames_by = FramesElsewhere::of(kept);
  added.output = added.output.parent_path() / "by.npy";
  decode_recording(added, decoder_);
  EXPECT_EQ(kept.asked, 3);
  for (std::size_t f = 0; f < 3; ++f)
    EXPECT_EQ(plane("by-averaged.npy", f), plane("all-averaged.npy", f));
}

TEST_F(FramesElsewhereTest, HasMeansMadeWhereTheRequestSays) {
  DecodeRequest means = request("means.npy");
  means.average = 2;
  means.averaged = 4.0;
  means.outputs = {DecodedPlane::depth};
  means.stack = true;
  KeptFrames kept{.filter = TimeFilter(std::get<Decoder>(decoder_).table())};
  means.frames_by = FramesElsewhere::of(kept);
  std::vector<double> of;
  means.decode_by = [&](const RawView& raw, const DecodedView& decoded, const Progress&) {
    of.push_back(kept.mean_of);
    std::fill_n(decoded.depth_m, raw.pixels(), 1.0f);
  };
  decode_recording(means, decoder_);
  EXPECT_EQ(of, (std::vector<double>{8.0, 4.0}));  // of three frames
}

}  // namespace
}  // namespace tofsmith
