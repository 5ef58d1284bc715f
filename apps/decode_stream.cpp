// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "read_ahead.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith::apps {

namespace {

/// Progress over all frames, which says how fast they come.
class Pace {
 public:
  Pace(const Progress& progress, const DecodeTarget& target)
      : progress_(progress), target_(target) {}

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// The progress of one band. @param pixels  decoded before it
  Progress of_band(const Band& band, std::int64_t pixels) const {
    const std::int64_t frame_pixels = std::int64_t{target_.view.height} * target_.view.width;
    const double before = static_cast<double>(pixels),
                 here = static_cast<double>(band.rows) * target_.view.width,
                 frame = static_cast<double>(frame_pixels), all = frame * target_.frames;
    return [this, band, before, here, frame, all](double fraction, std::string_view) {
      const double done = before + fraction * here, seconds = this->seconds();
      const double rate = seconds > 0.0 ? done / seconds : 0.0;
      const std::string where =
          target_.frames == 1
              ? fmt::format("row {} of {}", static_cast<int>(done / target_.view.width),
                            target_.view.height)
              : fmt::format("frame {} of {}, {} frames/s", band.frame - target_.first_frame + 1,
                            target_.frames, rate_text(rate / frame));
      return progress_(done / all, fmt::format("{}, {} Mpixel/s", where, rate_text(1e-6 * rate)));
    };
  }

 private:
  const Progress& progress_;
  const DecodeTarget& target_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Decodes one band to where it belongs in the planes and counts its statuses.
void decode_band(const RawView& raw, const Band& band, const DecodeRows& decode_rows,
                 const DecodeTarget& target, const DecodedView& decoded, const Progress& progress,
                 StatusCounts& statuses) {
  decode_rows(raw, band.first_row, decoded, progress);
  if (target.as_z && decoded.depth_m)
    turn_into_z(decoded.depth_m, band.first_row, band.rows, target.view);
  if (target.count_statuses) statuses.add({decoded.status, static_cast<std::size_t>(raw.pixels())});
}

}  // namespace

StatusCounts DecodeSummary::total() const {
  StatusCounts sum;
  for (const StatusCounts& frame : frames) sum.add(frame);
  return sum;
}

int rows_at_a_time(const RawFramesReader& reader, const DecodeTarget& target, double memory_bytes) {
  const double row_planes =
      static_cast<double>(bytes_per_pixel(target.needed_planes())) * target.view.width;
  const bool in_rows = target.in_rows();
  const double whole = static_cast<double>(reader.bytes_in_memory() + target.writing_bytes()) +
                       (in_rows ? 0.0 : row_planes * target.view.height);
  const double row =
      (reader.bytes_in_memory() > 0 ? 0.0 : 2.0 * static_cast<double>(reader.row_bytes())) +
      (in_rows ? row_planes : 0.0);
  if (whole + row > memory_bytes)
    throw IoError(
        target.path.string(),
        fmt::format("frames of {} x {} pixels take {:.3g} MB to be written so; expected at most "
                    "{:.3g} MB (fewer --outputs take less{}; --memory-mb allows more)",
                    target.view.height, target.view.width, 1e-6 * (whole + row),
                    1e-6 * memory_bytes,
                    in_rows ? "" : "; .npy is written row by row, with --stack every plane"));
  // Larger bands are no faster: new memory costs more than another call.
  constexpr double comfortable_bytes = 32e6;
  const double rows =
      row > 0.0 ? std::min(memory_bytes - whole, comfortable_bytes) / row : target.view.height;
  return std::clamp(static_cast<int>(rows), 1, target.view.height);
}

void decode_frames(const RawFramesReader& reader, int rows, const DecodeRows& decode_rows,
                   DecodeOutput& output, const Progress& progress, DecodeSummary& summary) {
  const DecodeTarget& target = output.target();
  const int height = target.view.height, width = target.view.width;
  const bool in_rows = target.in_rows();
  DecodedPlanes planes(target.needed_planes(), in_rows ? rows : height, width);
  ReadAhead input(reader,
                  bands_of(target.first_frame, target.first_frame + target.frames, height, rows));
  const Pace pace(progress, target);
  StatusCounts statuses;
  for (const Band& band : input.bands()) {
    const Progress here = pace.of_band(band, summary.pixels);
    report(here, 0.0, "reading");
    const RawView raw = input.next();
    const std::size_t first =
        static_cast<std::size_t>(band.first_row) * static_cast<std::size_t>(width);
    decode_band(raw, band, decode_rows, target, planes.view().from(in_rows ? 0 : first), here,
                statuses);
    output.take(band.frame, band.first_row, band.rows, planes);
    summary.pixels += raw.pixels();
    summary.seconds = pace.seconds();
    if (band.first_row + band.rows == height) summary.frames.push_back(std::exchange(statuses, {}));
  }
  output.finish();
  summary.seconds = pace.seconds();
}

}  // namespace tofsmith::apps
