// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::gpu: averaging, filtering and decoding on OpenCL devices.
/// Includes tofsmith/core.hpp.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core.hpp"

namespace tofsmith {

/// What a device is.
enum class DeviceKind { gpu, cpu, other };

/// "gpu", "cpu", "other".
std::string_view name_of(DeviceKind kind);

/// What OpenCL says of a device.
struct DeviceInfo {
  std::string name;      ///< as its driver gives it
  std::string platform;  ///< whose driver that is
  std::string version;   ///< of OpenCL, and of the driver
  DeviceKind kind = DeviceKind::other;
  std::uint64_t memory_bytes = 0;
  bool has_doubles = false;           ///< arithmetic in double precision
  bool divides_as_processor = false;  ///< quotients and roots rounded correctly
};

/// A processor that OpenCL knows, which may be this computer's own. Its drivers are loaded when
/// devices are asked for, not before. Copies are the same device.
class Device {
 public:
  /// Of all platforms, in the order of their drivers; none where no driver is installed.
  /// @throws IoError if this build has no OpenCL, or a driver fails
  static std::vector<Device> all();
  /// Why all() may be empty, and what to do.
  static std::string_view none_found();
  /// @param name  "gpu": the first one of that kind; a number: of all(), from 0 on; else a part of
  ///              the name of a device or its platform, in any case of letters
  /// @throws IoError if this build has no OpenCL, or there is no such device, with those that are
  static Device named(std::string_view name);
  /// The first GPU; none where there is none, or this build has no OpenCL.
  static std::optional<Device> first_gpu();

  const DeviceInfo& info() const;

  struct State;  ///< of the backend
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

/// How a decoder or filter uses its device.
struct DeviceOptions {
  /// For the pixels under way and their planes [MB], > 0; larger frames go in parts. Where the
  /// device has less, parts become smaller. Filters take as many rows as a result depends on, at
  /// least.
  double memory_mb = 512.0;
  /// Computes with doubles where the device has them: ambient light, from raw numbers with black
  /// levels and gains, is then the same to the last bit.
  bool use_doubles = true;
  /// Frames of fewer pixels are left to the processor, >= 0: copies and the start of kernels take
  /// longer than they save.
  int min_pixels = 0;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<DeviceOptions> auto& o) {
  return std::tuple(Field("memory_mb", o.memory_mb, above(0)), Field("use_doubles", o.use_doubles),
                    Field("min_pixels", o.min_pixels, at_least(0)));
}

/// DeviceOptions::min_pixels of the device `auto`, for decoding and for filtering. The values are
/// guesses on the high side, not measured on any GPU.
inline constexpr int auto_min_pixels_to_decode = 300'000, auto_min_pixels_to_filter = 75'000;

struct FrameSource;  ///< of the implementation

/// A Decoder whose work a device does. Bins and statuses are those of the Decoder, everywhere: what
/// single precision does not prove on the device, the Decoder decides here. Planes of floats are
/// the same bits where the device rounds quotients and roots correctly and has doubles, else they
/// differ in the last ones.
///
/// Safe to use from many threads, which wait for one another.
class DeviceDecoder {
 public:
  /// Compiles kernels for the table and brings its tables to the device.
  /// @param decoder  must outlive this one
  /// @throws std::invalid_argument for options; IoError if the device fails, with what its compiler
  ///         says of kernels
  DeviceDecoder(const Device& device, const Decoder& decoder, const DeviceOptions& options = {});
  DeviceDecoder(const Device& device, Decoder&& decoder,
                const DeviceOptions& options = {}) = delete;
  ~DeviceDecoder();
  DeviceDecoder(DeviceDecoder&&) noexcept;
  DeviceDecoder& operator=(DeviceDecoder&&) noexcept;

  const Device& device() const;

  /// Decodes one frame into the caller's planes, as Decoder::decode.
  /// @return how many pixels were left to the Decoder
  /// @throws std::invalid_argument if the shape does not fit; IoError if the device fails, with
  /// part
  ///         of the planes written; Interrupted if progress says so
  std::int64_t decode(const RawView& raw, const DecodedView& decoded,
                      const Progress& progress = {}) const;
  /// The same for frame `frame` of several (F, H, W, K), into a new image.
  DepthImage decode(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  struct Plan;  ///< of the implementation

 private:
  friend class DeviceFilter;
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DecodedView& decoded, const Progress& progress) const;
  std::unique_ptr<Plan> plan_;
};

/// A Filter whose work a device does, and a decoder's after it, with frames that stay there between
/// the two. Numbers are those of the Filter: the same bits where the device rounds quotients and
/// roots correctly and has doubles, else they differ in the last ones, and where a threshold lies
/// between, by more.
///
/// Safe to use from many threads, which wait for one another.
class DeviceFilter {
 public:
  /// Compiles kernels for the table and brings its tables to the device.
  /// @param filter  must outlive this one
  /// @throws std::invalid_argument for options; IoError if the device fails, with what its compiler
  ///         says of kernels
  DeviceFilter(const Device& device, const Filter& filter, const DeviceOptions& options = {});
  DeviceFilter(const Device& device, Filter&& filter, const DeviceOptions& options = {}) = delete;
  ~DeviceFilter();
  DeviceFilter(DeviceFilter&&) noexcept;
  DeviceFilter& operator=(DeviceFilter&&) noexcept;

  const Device& device() const;

  /// Filters one frame, as Filter::apply.
  /// @throws std::invalid_argument if the measurements or sizes differ; IoError if the device
  /// fails;
  ///         Interrupted if progress says so
  void apply(const RawView& raw, FilteredFrame& filtered, const Progress& progress = {},
             const Image<std::uint8_t>& left_out = {}) const;
  /// The same for frame `frame` of several (F, H, W, K).
  FilteredFrame apply(const RawFrames& raw, int frame = 0, const Progress& progress = {}) const;

  /// Filters one frame and has it decoded on the device, into the caller's planes.
  /// @param decoder   on the same device
  /// @param filtered  brought back as well; null: not wanted
  /// @return how many pixels were left to the Decoder
  /// @throws as apply() and DeviceDecoder::decode, with part of the planes written
  std::int64_t decode(const RawView& raw, const DeviceDecoder& decoder, const DecodedView& decoded,
                      FilteredFrame* filtered = nullptr, const Progress& progress = {},
                      const Image<std::uint8_t>& left_out = {}) const;

 private:
  friend class DeviceFrames;
  std::int64_t decode_source(const FrameSource& frame, const Device& its_device,
                             const DeviceDecoder& decoder, const DecodedView& decoded,
                             FilteredFrame* filtered, const Progress& progress,
                             const Image<std::uint8_t>& left_out) const;
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// Means of frames, and frames added up in time as a TimeFilter does, on a device, where they stay
/// for the filter in space and the decoder. Numbers are those of the processor: the same bits where
/// the device rounds quotients and roots correctly, else they differ in the last ones, and where a
/// threshold lies between, by more.
///
/// Keeps what was added up whole, whatever DeviceOptions::memory_mb says.
/// Not for several threads at once.
class DeviceFrames {
 public:
  /// Compiles kernels for the table.
  /// @param table        must outlive this one; says from where on raw numbers are clipped
  /// @param time_filter  without look_ahead; must outlive this one; null: means alone
  /// @throws std::invalid_argument for options, and a filter of other measurements or that looks
  ///         ahead; IoError if the device fails
  DeviceFrames(const Device& device, const DecodingTable& table, const TimeFilter* time_filter,
               const DeviceOptions& options = {});
  ~DeviceFrames();
  DeviceFrames(DeviceFrames&&) noexcept;
  DeviceFrames& operator=(DeviceFrames&&) noexcept;

  /// Whether frames so large are not to be left to the processor.
  bool takes(std::int64_t pixels) const;

  /// Adds a frame to those of which the next mean is. What is invalid or saturated in one is so in
  /// the mean.
  /// @throws std::invalid_argument if the measurements or sizes differ, or the device has no
  ///         doubles; IoError if the device fails, after which the next frame is the first
  void add(const RawView& raw);
  /// The mean of those is the next frame.
  /// @param averaged  of how many measurements the numbers of one are the mean
  /// @throws as add(); std::invalid_argument if there are none
  void take_mean(double averaged = 1.0);
  /// The next frame, without a mean, of a time filter. @throws as add()
  void take(const RawView& raw);
  /// The next frame is the first again, of any size.
  void forget();

  /// Whether there is a frame to decode.
  bool has_frame() const;
  /// Brings the frame back, until the next one: what TimeFilter::add() gives, or the mean in
  /// doubles.
  /// @throws std::invalid_argument if there is none; IoError if the device fails
  RawView numbers();
  /// Decodes the frame, as DeviceDecoder::decode.
  /// @param decoder  on the same device
  /// @return how many pixels were left to the Decoder
  std::int64_t decode(const DeviceDecoder& decoder, const DecodedView& decoded,
                      const Progress& progress = {});
  /// Filters the frame, as DeviceFilter::decode, and decodes it.
  /// @param filter   on the same device
  /// @param decoder  likewise
  /// @return how many pixels were left to the Decoder
  std::int64_t decode(const DeviceFilter& filter, const DeviceDecoder& decoder,
                      const DecodedView& decoded, FilteredFrame* filtered = nullptr,
                      const Progress& progress = {}, const Image<std::uint8_t>& left_out = {});

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

/// What decodes in place of a decoder on the device that a user names: "cpu", nothing; "auto": the
/// first GPU, or nothing where there is none or the decoder is no Decoder; else Device::named().
/// `auto` leaves frames of fewer than auto_min_pixels_to_decode to the processor.
/// @param decoder  must outlive what comes
/// @throws InvalidArgument if a device is named and the decoder is no Decoder; IoError if there is
///         no such device, or it fails
std::optional<DeviceDecoder> device_decoder(std::string_view device, const AnyDecoder& decoder);

/// The same of a filter; on the device of a decoder that follows it, if there is one.
/// @param filter  must outlive what comes
/// @param after   null: none follows
std::optional<DeviceFilter> device_filter(std::string_view device, const Filter& filter,
                                          const DeviceDecoder* after = nullptr);

/// What makes means of frames and adds them up in time on the device of the decoder that follows;
/// none where there is nothing to do, or the device cannot do it: means without doubles and time
/// filters that look ahead stay on the CPU. `auto` leaves small frames to the processor, as
/// device_decoder().
/// @param table, time_filter  must outlive what comes; the filter may be null
/// @param makes_means         of several frames each
std::optional<DeviceFrames> device_frames(std::string_view device, const DecodingTable& table,
                                          const TimeFilter* time_filter, bool makes_means,
                                          const DeviceDecoder& after);

}  // namespace tofsmith
