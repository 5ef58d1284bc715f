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
  bool has_frame() const { return frame.has_value(); }
  bool take_end() {
    frame = filter.add_end();
    return has_frame();
  }
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

TEST_F(FramesElsewhereTest, HasFramesWaitThatLookAhead) {
  const Decoder& decoder = std::get<Decoder>(decoder_);
  for (const int ahead : {1, 2, 9}) {
    for (const std::optional<int> frame : {std::optional<int>(), std::optional(1)}) {
      DecodeRequest added = request("here.npy");
      added.policy = OutputPolicy::overwrite;
      added.time_filter = TimeFilterOptions{.max_frames = 5, .look_ahead = ahead};
      added.frame = frame;
      added.stack = true;
      added.outputs = {DecodedPlane::depth};
      decode_recording(added, decoder_);
      KeptFrames kept{.filter = TimeFilter(decoder.table(), *time_filter_of(added))};
      added.frames_by = FramesElsewhere::of(kept);
      added.decode_by = [&](const RawView& raw, const DecodedView& decoded, const Progress&) {
        EXPECT_EQ(std::get<const float*>(raw.data), nullptr);
        decoder.decode(*kept.frame, decoded);
      };
      added.output = added.output.parent_path() / "there.npy";
      EXPECT_EQ(decode_recording(added, decoder_).frames.size(), frame ? 1u : 3u);
      for (std::size_t f = 0; f < (frame ? 1u : 3u); ++f)
        EXPECT_EQ(plane("there.npy", f), plane("here.npy", f));
    }
  }
}

TEST_F(FramesElsewhereTest, TakesNoMemoryHereForWhatIsAddedUpThere) {
  const Decoder& decoder = std::get<Decoder>(decoder_);
  DecodeRequest added = request("there.npy");
  added.time_filter = TimeFilterOptions{.look_ahead = 2};
  added.outputs = {DecodedPlane::depth};
  added.stack = true;
  added.memory_mb = 3e-3;  // 27 floats a pixel, or 9
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

/// As a device that has two frames under way: notes what it is asked for.
struct FramesInTurns {
  void start(const RawView& raw, const DecodedView& decoded) {
    said += 's';
    ASSERT_LT(++under_way, 3);
    if (said == fails_after) throw IoError("device", "is gone");
    numbers.emplace_back(static_cast<std::size_t>(raw.pixels() * 4));
    copy_pixels(raw, 0, raw.pixels(), numbers.back().data());
    views.push_back(decoded);
    pixels = raw.pixels();
  }
  void finish() {
    said += 'f';
    --under_way;
    const RawView raw =
        RawView::interleaved(numbers.front().data(), 1, static_cast<int>(pixels), 4);
    decoder.decode(raw, views.front());
    numbers.erase(numbers.begin());
    views.erase(views.begin());
  }
  void forget() {
    said.clear();
    under_way = 0;
    numbers.clear();
    views.clear();
  }

  const Decoder& decoder;
  std::string said = {}, fails_after = "none";
  int under_way = 0;
  std::int64_t pixels = 0;
  std::vector<std::vector<float>> numbers = {};
  std::vector<DecodedView> views = {};
};

class OverlappedFramesTest : public FramesElsewhereTest {
 protected:
  /// Frames that are filtered and decoded by `in_turns`, or one after another without a filter.
  DecodeRequest overlapped(const std::string& output, FramesInTurns& in_turns) {
    DecodeRequest asked = request(output.c_str());
    asked.outputs = {DecodedPlane::depth, DecodedPlane::status};
    asked.stack = asked.output.extension() == ".npy";
    asked.filter = FilterOptions{};
    asked.filter_by = [&in_turns](const RawView& raw, const DecodedView& decoded, FilteredFrame*,
                                  const Progress&, const Image<std::uint8_t>&) {
      in_turns.decoder.decode(raw, decoded);
    };
    asked.overlapped_by = FramesUnderWay::of(in_turns);
    return asked;
  }
};

TEST_F(OverlappedFramesTest, AreBegunBeforeTheOneBeforeIsFinished) {
  FramesInTurns in_turns{std::get<Decoder>(decoder_)};
  DecodeRequest alone = overlapped("alone.npy", in_turns);
  alone.overlapped_by = {};
  const DecodedRecording expected = decode_recording(alone, decoder_);
  const DecodedRecording found = decode_recording(overlapped("turns.npy", in_turns), decoder_);
  EXPECT_EQ(in_turns.said, "ssfsff");
  EXPECT_EQ(found.frames.size(), 3u);
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_EQ(plane("turns.npy", f), plane("alone.npy", f));
    EXPECT_EQ(found.frames[f].of(PixelStatus::ok), expected.frames[f].of(PixelStatus::ok));
  }
  // Files of frames appear in their order, with the planes of each.
  decode_recording(overlapped("frame.npz", in_turns), decoder_);
  EXPECT_EQ(in_turns.said, "ssfsff");
  alone.output = alone.output.parent_path() / "one.npz";
  alone.stack = false;
  decode_recording(alone, decoder_);
  const auto bytes_of = [&](const std::string& name) {
    std::ifstream file(path(name.c_str()), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  for (const std::string f : {"0", "1", "2"}) {
    EXPECT_GT(bytes_of("one-" + f + ".npz").size(), 100u);
    EXPECT_EQ(bytes_of("frame-" + f + ".npz"), bytes_of("one-" + f + ".npz"));
  }
}

TEST_F(OverlappedFramesTest, GoOneAfterAnotherWhereTheyCannotGoInTurns) {
  FramesInTurns in_turns{std::get<Decoder>(decoder_)};
  const auto said_of = [&](const std::function<void(DecodeRequest&)>& change) {
    DecodeRequest asked = overlapped("turns.npy", in_turns);
    asked.policy = OutputPolicy::overwrite;
    change(asked);
    in_turns.said.clear();
    decode_recording(asked, decoder_);
    return in_turns.said;
  };
  EXPECT_EQ(said_of([](DecodeRequest& asked) { asked.frame = 1; }), "");
  EXPECT_EQ(said_of([](DecodeRequest& asked) { asked.filter.reset(); }), "");
  EXPECT_EQ(said_of([](DecodeRequest& asked) { asked.average = 2; }), "ssff");
  // Where planes of two frames do not fit, one of them does.
  double refused_mb = 1e-6, enough_mb = 256.0;
  std::string said;
  while (enough_mb > (1.0 + 1e-6) * refused_mb) {
    const double memory_mb = 0.5 * (refused_mb + enough_mb);
    try {
      said = said_of([&](DecodeRequest& asked) { asked.memory_mb = memory_mb; });
      enough_mb = memory_mb;
    } catch (const IoError&) {
      refused_mb = memory_mb;
    }
  }
  EXPECT_EQ(said, "");
}

TEST_F(OverlappedFramesTest, LeaveNothingHalfWrittenWhereTheDeviceFails) {
  FramesInTurns in_turns{std::get<Decoder>(decoder_)};
  in_turns.fails_after = "ssfs";
  EXPECT_THROW(decode_recording(overlapped("stack.npy", in_turns), decoder_), IoError);
  EXPECT_FALSE(std::filesystem::exists(path("stack.npy")));
  DecodedRecording result;
  EXPECT_THROW(decode_recording(overlapped("frame.npz", in_turns), decoder_, {}, result), IoError);
  EXPECT_EQ(result.files.size(), 1u);
  EXPECT_TRUE(std::filesystem::exists(path("frame-0.npz")));
  EXPECT_FALSE(std::filesystem::exists(path("frame-1.npz")));
  in_turns.fails_after = "none";
  EXPECT_EQ(decode_recording(overlapped("stack.npy", in_turns), decoder_).frames.size(), 3u);
}

TEST_F(OverlappedFramesTest, StopWithTheFramesThatGoingAloneWouldHaveWritten) {
  FramesInTurns in_turns{std::get<Decoder>(decoder_)};
  for (const double stop_at : {0.1, 0.5, 2.0}) {
    std::vector<std::size_t> written;
    for (const bool overlaps : {false, true}) {
      DecodeRequest asked = overlapped("frame.npz", in_turns);
      asked.policy = OutputPolicy::overwrite;
      if (!overlaps) asked.overlapped_by = {};
      DecodedRecording result;
      double last = 0.0;
      const auto progress = [&](double fraction, std::string_view) {
        EXPECT_GE(fraction, last);
        last = fraction;
        return fraction < stop_at;
      };
      if (stop_at <= 1.0) {
        EXPECT_THROW(decode_recording(asked, decoder_, progress, result), Interrupted);
      } else {
        decode_recording(asked, decoder_, progress, result);
        if (overlaps) {
          EXPECT_EQ(last, 1.0);
        }
      }
      written.push_back(result.files.size());
    }
    EXPECT_EQ(written[0], written[1]) << stop_at;
  }
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
