// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Frames of a recording of which two are under way against those that go one after another.
#if __has_include(<CL/cl.h>)
#include <gmock/gmock.h>

#include <algorithm>

#include "device_setup.hpp"
#include "tofsmith/core/error.hpp"
#include "watched_opencl.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// What is done to frames before they are decoded.
struct Steps {
  bool filter = false, mean = false;
  std::optional<int> look_ahead = {};  // of a filter in time; none: there is none
};

const std::vector<Steps> all_steps = {{.filter = true},
                                      {.look_ahead = 0},
                                      {.look_ahead = 2},
                                      {.filter = true, .look_ahead = 0},
                                      {.filter = true, .look_ahead = 1},
                                      {.mean = true},
                                      {.filter = true, .mean = true},
                                      {.filter = true, .mean = true, .look_ahead = 3}};

class DeviceFramesUnderWayOf : public OnDevice {
 protected:
  static constexpr int height = 45, width = 34, count = 5;

  DeviceFramesUnderWayOf() : setup_("hamiltonian-k4", camera_with("paper-10f0")) {
    for (std::uint64_t f = 0; f < count; ++f)
      raw_.push_back(noisy_pixels(setup_.decoder.table(), 1e5, 1e4, height * width, f + 1));
  }
  void SetUp() override {
    OnDevice::SetUp();
    failure = {};
  }
  void TearDown() override { failure = {}; }

  RawView view(std::size_t frame) const {
    return RawView::interleaved(raw_[frame].data(), height, width, 4);
  }
  bool can(const Steps& steps) const { return !steps.mean || device().info().has_doubles; }

  /// All that works on frames.
  struct Work {
    Work(const Device& device, const Decoder& decoder_, const Steps& steps_,
         const DeviceOptions& options = {})
        : steps(steps_), decoder(device, decoder_, options) {
      const DecodingTable& table = decoder_.table();
      if (steps.filter) {
        filter.emplace(table);
        filter_there.emplace(device, *filter, options);
      }
      if (steps.look_ahead)
        time_filter.emplace(table, TimeFilterOptions{.before_filter = steps.filter,
                                                     .look_ahead = *steps.look_ahead});
      if (steps.look_ahead || steps.mean)
        frames.emplace(device, table, time_filter ? &*time_filter : nullptr);
      under_way.emplace(decoder, filter_there ? &*filter_there : nullptr,
                        frames ? &*frames : nullptr);
    }

    /// Has a frame come. @return whether there is one to decode
    bool take(const RawView& raw) {
      if (!frames) return true;
      if (steps.mean) {
        frames->add(raw);
        frames->add(raw);
        frames->take_mean();
      } else {
        frames->take(raw);
      }
      return frames->has_frame();
    }
    bool take_end() { return frames && frames->take_end(); }
    void decode_alone(const RawView& raw, const DecodedView& planes) {
      if (filter && frames)
        frames->decode(*filter_there, decoder, planes);
      else if (filter)
        filter_there->decode(raw, decoder, planes);
      else
        frames->decode(decoder, planes);
    }

    Steps steps;
    DeviceDecoder decoder;
    std::optional<Filter> filter;
    std::optional<DeviceFilter> filter_there;
    std::optional<TimeFilter> time_filter;
    std::optional<DeviceFrames> frames;
    std::optional<DeviceFramesUnderWay> under_way;
  };

  std::vector<Outputs> one_after_another(Work& work) const {
    std::vector<Outputs> all;
    const auto decode = [&](std::size_t f) {
      all.emplace_back(height * width);
      work.decode_alone(view(f), all.back().view());
    };
    for (std::size_t f = 0; f < count; ++f)
      if (work.take(view(f))) decode(f);
    while (work.take_end()) decode(0);
    return all;
  }
  std::vector<Outputs> two_at_a_time(Work& work, std::size_t frames = count) const {
    std::vector<Outputs> all(frames, Outputs(height * width));
    std::size_t begun = 0, done = 0;
    const auto begin = [&](const RawView& raw) {
      work.under_way->start(raw, all[begun].view());
      if (begun++ > 0) work.under_way->finish(), ++done;
    };
    for (std::size_t f = 0; f < frames; ++f)
      if (std::vector<float> numbers = raw_[f];  // is read no more once it was begun with
          work.take(RawView::interleaved(numbers.data(), height, width, 4)))
        begin(RawView::interleaved(numbers.data(), height, width, 4));
    while (work.take_end()) begin(view(0));
    while (done < begun) work.under_way->finish(), ++done;
    EXPECT_EQ(done, frames);
    return all;
  }
  static void expect_same_frames(const std::vector<Outputs>& a, const std::vector<Outputs>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t f = 0; f < a.size(); ++f) {
      SCOPED_TRACE(f);
      expect_same(a[f], b[f]);
    }
  }

  DecodeSetup setup_;
  std::vector<std::vector<float>> raw_;
};

TEST_F(DeviceFramesUnderWayOf, HaveTheBitsOfThoseThatGoAlone) {
  for (const double memory_mb : {512.0, 0.2})  // and where bands and parts go one after another
    for (std::size_t i = 0; i < all_steps.size(); ++i) {
      if (!can(all_steps[i])) continue;
      SCOPED_TRACE(testing::Message() << "steps " << i << ", " << memory_mb << " MB");
      Work alone(device(), setup_.decoder, all_steps[i], {.memory_mb = memory_mb});
      Work work(device(), setup_.decoder, all_steps[i], {.memory_mb = memory_mb});
      const std::vector<Outputs> expected = one_after_another(alone);
      for (int again = 0; again < 2; ++again) {
        expect_same_frames(two_at_a_time(work), expected);
        if (work.frames) work.frames->forget();
      }
    }
}

TEST_F(DeviceFramesUnderWayOf, MayBeLeftToTheProcessorOrDecodedAlone) {
  Work small(device(), setup_.decoder, {.filter = true}, {.min_pixels = 1 << 20});
  Work alone(device(), setup_.decoder, {.filter = true});
  const std::vector<Outputs> found = two_at_a_time(small), expected = one_after_another(alone);
  for (std::size_t f = 0; f < count; ++f)
    expect_alike(device().info(), true, found[f], expected[f], 1e6);
  Work plain(device(), setup_.decoder, {});
  const std::vector<Outputs> decoded = two_at_a_time(plain);
  for (std::size_t f = 0; f < count; ++f) {
    Outputs outputs(height * width);
    plain.decoder.decode(view(f), outputs.view());
    expect_same(decoded[f], outputs);
  }
}

/// Where calls of a kind stand.
std::vector<std::size_t> calls_of(DeviceCall::Kind kind, std::size_t bytes) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < device_calls.size(); ++i)
    if (device_calls[i].kind == kind && device_calls[i].bytes == bytes) at.push_back(i);
  return at;
}

TEST_F(DeviceFramesUnderWayOf, AreBroughtThereAndBackBesideKernelsOfOthers) {
  for (const Steps& steps :
       {Steps{.filter = true}, Steps{.look_ahead = 0}, Steps{.filter = true, .look_ahead = 0}}) {
    Work work(device(), setup_.decoder, steps);
    Outputs first(height * width), second(height * width);
    device_calls.clear();
    const auto begin = [&](std::size_t f, Outputs& outputs) {
      const std::size_t from = device_calls.size();
      if (work.take(view(f))) work.under_way->start(view(f), {.depth_m = outputs.depth_m.data()});
      return from;
    };
    begin(0, first);
    const std::size_t next = begin(1, second);
    work.under_way->finish();
    const std::size_t pixels = height * width;
    const auto brought = calls_of(DeviceCall::write, 16 * pixels),
               fetched = calls_of(DeviceCall::read, 4 * pixels),
               kernels = calls_of(DeviceCall::kernel, 0), waits = calls_of(DeviceCall::wait, 0);
    ASSERT_EQ(brought.size(), 2u);
    ASSERT_EQ(fetched.size(), 1u);
    EXPECT_EQ(waits.size(), 0u);
    // All kernels of the first stand in queues when the second is brought, by another queue than
    // that of the last of them, with no planes read between ..
    const std::size_t last_of_first =
        *std::prev(std::lower_bound(kernels.begin(), kernels.end(), next));
    EXPECT_GE(brought[1], next);
    EXPECT_NE(device_calls[brought[1]].queue, device_calls[last_of_first].queue);
    // .. and all of the second when planes of the first are read, by another queue likewise.
    EXPECT_LT(kernels.back(), fetched[0]);
    EXPECT_NE(device_calls[kernels.back()].queue, device_calls[fetched[0]].queue);
    work.under_way->finish();
  }
}

TEST_F(DeviceFramesUnderWayOf, AreForgottenWhereTheDeviceFailsAndStartAnewWhenItIsBack) {
  constexpr std::size_t frames = 3;
  for (const Steps& steps : {Steps{.filter = true}, Steps{.mean = true}, Steps{.look_ahead = 1},
                             Steps{.filter = true, .look_ahead = 0}}) {
    if (!can(steps)) continue;
    Work work(device(), setup_.decoder, steps);
    const std::vector<Outputs> expected = two_at_a_time(work, frames);
    for (const cl_int error : {CL_DEVICE_NOT_AVAILABLE, CL_OUT_OF_RESOURCES})
      for (int first = 0;; first += first < 25 ? 1 : steps.filter ? 19 : 5) {
        failure = {.first = first, .error = error};
        bool has_failed = false;
        try {
          two_at_a_time(work, frames);
        } catch (const IoError& lost) {
          EXPECT_THAT(lost.what(), HasSubstr(device().info().name));
          has_failed = true;
        }
        ASSERT_EQ(has_failed, failure.calls > first);
        failure = {};
        if (!has_failed) break;
        EXPECT_FALSE(work.frames && work.frames->has_frame());
        work.under_way->forget();  // one may be, where the next was lost as it came
        EXPECT_THROW(work.under_way->finish(), InvalidArgument);
        expect_same_frames(two_at_a_time(work, frames), expected);
      }
  }
}

TEST_F(DeviceFramesUnderWayOf, GoOneAfterAnotherWhereMemoryLacksForTwo) {
  Work work(device(), setup_.decoder, {.filter = true});
  const std::vector<Outputs> expected = two_at_a_time(work, 3);
  int failed = 0, calls = 0;
  for (int call = 0;; call += call < 40 ? 1 : 5) {
    Work anew(device(), setup_.decoder, {.filter = true});
    failure = {.first = call, .last = call, .error = CL_MEM_OBJECT_ALLOCATION_FAILURE};
    try {
      expect_same_frames(two_at_a_time(anew, 3), expected);
    } catch (const IoError&) {
      ++failed;  // as it was fetched
    }
    ++calls;
    if (failure.calls <= call) break;
  }
  EXPECT_LT(failed, calls / 3);
}

TEST_F(DeviceFramesUnderWayOf, AreTwoAndNoMoreOfOneDevice) {
  Work work(device(), setup_.decoder, {.filter = true});
  Outputs outputs(height * width);
  EXPECT_THROW(work.under_way->finish(), InvalidArgument);
  work.under_way->start(view(0), outputs.view());
  work.under_way->start(view(1), outputs.view());
  EXPECT_THAT([&] { work.under_way->start(view(2), outputs.view()); },
              ThrowsMessage<InvalidArgument>(HasSubstr("frames under way = 2; must be < 2")));
  work.under_way->finish();
  work.under_way->forget();
  EXPECT_THROW(work.under_way->finish(), InvalidArgument);
  const Filter filter(setup_.decoder.table());
  const DeviceFilter elsewhere(Device::all().front(), filter);
  EXPECT_THROW(DeviceFramesUnderWay(work.decoder, &elsewhere, nullptr), InvalidArgument);
  RawView fewer = view(0);
  --fewer.measurements;
  EXPECT_THAT([&] { work.under_way->start(fewer, outputs.view()); },
              ThrowsMessage<InvalidArgument>(HasSubstr("must be those of the frame")));
}

}  // namespace
}  // namespace tofsmith
#endif
