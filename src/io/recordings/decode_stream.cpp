// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

#include "io/image_limits.hpp"
#include "io/images/raw_dump_reader.hpp"
#include "io/recordings/decode_plan.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

namespace {

constexpr const char* stream_name = "the stream";

/// Returns the number of bytes after which each exposure of a frame is complete; only planar frames
/// have several.
std::vector<std::size_t> exposure_ends(const RawFormat& format, int exposures) {
  const auto frame = static_cast<std::size_t>(format.frame_bytes());
  std::vector<std::size_t> ends(static_cast<std::size_t>(exposures), frame);
  if (format.layout != RawOrder::planar) return ends;
  const std::uint64_t image =
      format.image_bytes() +
      static_cast<std::uint64_t>(format.image_header_bytes + format.image_trailer_bytes);
  const int per_exposure = format.kept_measurements() / exposures;
  std::fill(ends.begin(), ends.end() - 1, std::size_t{0});
  for (int j = 0; j < format.measurements; ++j) {
    const int measurement = format.measurement_of(j);
    if (measurement < 0) continue;
    std::size_t& end = ends[static_cast<std::size_t>(measurement / per_exposure)];
    end = std::max(end, static_cast<std::size_t>(format.frame_header_bytes +
                                                 static_cast<std::uint64_t>(j + 1) * image));
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin(),
                   [](std::size_t a, std::size_t b) { return std::max(a, b); });
  return ends;
}

class StreamFrames {
 public:
  /// @param exposures  next() returns each frame once per exposure, when it is complete up to this
  ///   exposure; 1: whole frames
  StreamFrames(const ReadStream& read, RawFormat format, const RawMarking& marking, int exposures)
      : read_(read),
        header_(static_cast<std::size_t>(format.header_bytes)),
        trailer_bytes_(static_cast<std::size_t>(format.trailer_bytes)),
        bytes_(format.frame_bytes()),
        ends_(exposure_ends(format, exposures)) {
    format.header_bytes = format.trailer_bytes = 0;
    format.frames = 1;
    frame_ = std::make_unique<RawDumpReader>(bytes_, std::move(format), marking);
  }

  /// Returns the next frame or exposure, valid until the next call; none after the last.
  /// @throws IoError if the stream ends within a frame
  std::optional<RawView> next() {
    if (const std::size_t found = read_(header_); found < header_.size()) fail(found, header_);
    header_.clear();
    if (const std::size_t end = ends_[exposure_]; at_ < end) {
      const std::size_t found = at_ + read_(std::span(bytes_).subspan(at_, end - at_));
      const bool is_between_frames = at_ == 0 && frames_ > 0;
      if (is_between_frames && (found == 0 || found == trailer_bytes_)) return std::nullopt;
      if (found < end) fail(found, bytes_);
      at_ = end;
      view_ = frame_->format().needs_doubles() ? numbers(doubles_) : numbers(floats_);
    }
    if (++exposure_ == ends_.size()) {
      exposure_ = at_ = 0;
      ++frames_;
    }
    return view_;
  }

 private:
  template <typename Number>
  RawView numbers(std::vector<Number>& values) const {
    const RawFormat& f = frame_->format();
    const int height = f.output_height(), width = f.output_width();
    const auto row =
        static_cast<std::size_t>(width) * static_cast<std::size_t>(f.output_measurements());
    values.resize(static_cast<std::size_t>(height) * row);
    // A block of rows of a transposed image needs all rows of the file.
    parallel_for_blocks(height, f.is_transposed() ? height : 16, [&](IndexRange rows) {
      const auto first = static_cast<int>(rows.begin);
      frame_->read_rows(0, first, static_cast<int>(rows.end) - first,
                        values.data() + static_cast<std::size_t>(first) * row);
    });
    RawView view = RawView::interleaved(values.data(), height, width, f.output_measurements());
    view.is_marked = true;
    return view;
  }

  [[noreturn]] void fail(std::size_t found, const std::vector<std::byte>& expected) const {
    throw IoError(
        stream_name,
        fmt::format(
            "found {} bytes and the end; expected {} of {}", found, expected.size(),
            !header_.empty() ? "its header" : fmt::format("frame {}, counted from 0", frames_)));
  }

  const ReadStream& read_;
  std::vector<std::byte> header_;
  std::size_t trailer_bytes_;
  std::vector<std::byte> bytes_;
  std::vector<std::size_t> ends_;  // of exposures, in bytes_
  std::size_t exposure_ = 0;
  std::size_t at_ = 0;  // bytes of the frame that have been read
  RawView view_;
  std::unique_ptr<RawDumpReader> frame_;
  std::vector<float> floats_;
  std::vector<double> doubles_;
  std::int64_t frames_ = 0;
};

DecodeRequest checked(DecodeRequest request, const DepthDecoder& decoder) {
  require(!request.raw_format.empty(), "raw_format", "none",
          "must be a file that describes the frames of the stream");
  require(!request.frame, "frame", request.frame.value_or(0), "is only valid with files");
  require(!request.stack, "stack", "true", "is only valid with files");
  if (request.outputs.empty()) request.outputs = {DecodedPlane::depth};
  request.raw = {stream_name};
  request.output.clear();
  check_request(request, decoder);
  return request;
}

}  // namespace

void decode_stream(const DecodeRequest& asked, const FrameBackend& backend, const ReadStream& read,
                   const WriteStream& write, const Progress& progress, DecodedStream& result) {
  result = {};
  const DepthDecoder& decoder = backend.decoder();
  const DecodingTable& table = decoder.table();
  const DecodeRequest request = checked(asked, decoder);
  const RawFormat format = read_raw_format(request.raw_format);
  const std::string source = request.raw_format.string();
  const int height = format.output_height(), width = format.output_width();
  result.height = height;
  result.width = width;
  check_image_size(source, static_cast<std::uint64_t>(height), static_cast<std::uint64_t>(width));
  check_measurements(format, table.measurements(), source);
  const PlaneCorrections corrections = corrections_of(request, table, source, height, width);
  const PinholeView view = view_of_frames(request, source, width, height);
  const DecodeTarget target{
      .planes = planes_to_write(request, decoder),
      .count_statuses = std::ranges::count(request.outputs, DecodedPlane::status) > 0,
      .correction_planes = planes_for(corrections, table),
      .as_z = request.kind == DepthKind::z,
      .view = view,
      .pixel_rays = request.kind == DepthKind::z ? rays_of(request.lens, view) : PixelRays(),
      .undistortion = undistortion_of(request, view)};

  check_markers(table.marking.markers, format, source);
  const std::optional<Filter> filter = filter_of(request, table);
  Preparation preparation = preparation_of(request, table, filter);
  preparation.exposures_arrive = true;
  StreamFrames frames(read, format, table.marking, std::max(preparation.sliding, 1));
  const auto pipelines = prepare_pipelines(backend, preparation, height, width);
  PreparedFrames input([&] { return frames.next(); }, preparation, pipelines,
                       std::numeric_limits<int>::max());
  DepthImage planes(target.needed_planes(), height, width);
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    report(progress, 0.0, fmt::format("frame {}", result.frames));
    const ProgressParts parts(progress, {0.0, 1.0});  // the length of a stream is unknown
    // Only a temporal filter uses the frame number, which is limited to int.
    const auto frame = static_cast<int>(
        std::min<std::int64_t>(result.frames, std::numeric_limits<int>::max() / 2));
    if (!decode_next(input, corrections, {frame, 0, height}, target, planes, parts[0])) break;
    if (target.undistortion) undistort(planes, *target.undistortion, target.as_z);
    if (target.count_statuses) result.statuses.add(planes.status.pixels);
    for (const DecodedPlane plane : target.planes) write(items_of(planes, plane, height));
    ++result.frames;
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
}

}  // namespace tofsmith
