// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/decode_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "decode/filter/shared/filter_parts.hpp"
#include "io/recordings/decode_plan.hpp"
#include "io/recordings/decoded_output.hpp"
#include "io/recordings/misfit.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {

namespace {

std::string_view likely_cause(PixelStatus status) {
  switch (status) {
    case PixelStatus::invalid:
      return "the raw numbers are NaN or infinite, or the maps mark every pixel as dead; check the "
             "files and --raw-format";
    case PixelStatus::saturated:
      return "every pixel has a raw number at the saturation level; reduce the exposure, or "
             "correct sensor.full_well_e, sensor.adc_bits and sensor.gain_e_per_dn";
    case PixelStatus::too_near:
    case PixelStatus::too_far:
      return "every depth is outside the limits; check --min-depth and --max-depth, or "
             "operating.working_distance_m of the camera";
    default:
      return "the raw numbers contain no signal; check the light source, --code, --layout and "
             "sensor.black_level_dn";
  }
}

/// Note if raw numbers are integers, but the camera has no gain, black level or saturation.
std::optional<std::string> electrons_note(const RawFramesReader& reader,
                                          const DecodingTable& table) {
  if (!reader.holds_integers() || table.saturation_level ||
      (table.gain_e_per_raw.array() != 1.0).any() || (table.black_level.array() != 0.0).any())
    return std::nullopt;
  return "no gain, black level or saturation level is set, so raw numbers are interpreted as "
         "electrons (--set sensor.adc_bits=... --set sensor.gain_e_per_dn=... --set "
         "sensor.black_level_dn=...)";
}

/// Warning if both the table and the pixels' offsets contain a constant, which may be the same
/// constant.
std::optional<std::string> repeated_offset_note(const DecodingTable& table,
                                                const Image<float>& offset_m) {
  if (table.playback_offset_m == 0.0) return std::nullopt;
  double count = 0.0, sum = 0.0, squares = 0.0;
  for (const float offset : offset_m.pixels) {
    if (!std::isfinite(offset)) continue;
    const auto value = static_cast<double>(offset);
    ++count;
    sum += value;
    squares += value * value;
  }
  const double mean_m = count > 0.0 ? sum / count : 0.0;
  const double spread_m =
      std::sqrt(std::max(squares / std::max(count, 1.0) - mean_m * mean_m, 0.0));
  if (!(std::abs(mean_m) > spread_m)) return std::nullopt;
  return fmt::format(
      "both the camera's [playback] and the offsets of the pixels contain a constant, {:.4g} m and "
      "{:.4g} m on average; their sum of {:.4g} m is subtracted from depth. If it is one constant, "
      "remove it from one of them: --set playback.offset_m=0, or an offset map with mean 0",
      table.playback_offset_m, mean_m, table.playback_offset_m + mean_m);
}

/// Note if the offset of a pixel exceeds the unambiguous range: its unit may not be metres.
std::optional<std::string> large_offset_note(const DecodingTable& table,
                                             const Image<float>& offset_m) {
  double largest_m = 0.0;
  for (const float offset : offset_m.pixels)
    if (std::isfinite(offset)) largest_m = std::max(largest_m, std::abs(double{offset}));
  if (largest_m <= table.range_m) return std::nullopt;
  return fmt::format(
      "offsets of pixels reach {:.4g} m, more than the unambiguous range of {:.4g} m; check that "
      "they are in metres",
      largest_m, table.range_m);
}

/// Note if no pixel of any frame has a depth.
std::optional<std::string> no_depth_note(const StatusCounts& statuses) {
  constexpr std::array without_depth = {PixelStatus::invalid, PixelStatus::no_return,
                                        PixelStatus::saturated, PixelStatus::too_near,
                                        PixelStatus::too_far};
  std::int64_t without = 0;
  std::string counts;
  for (const PixelStatus status : without_depth) {
    without += statuses.of(status);
    if (statuses.of(status) > 0)
      counts +=
          fmt::format("{}{} {}", counts.empty() ? "" : ", ", statuses.of(status), name_of(status));
  }
  if (without == 0 || without < statuses.pixels()) return std::nullopt;
  const auto by_count = [&](PixelStatus status) { return statuses.of(status); };
  return fmt::format("no pixel has a depth ({}); {}", counts,
                     likely_cause(std::ranges::max(without_depth, {}, by_count)));
}

/// Warning if more than 10 % of the pixels of all frames are inconsistent.
std::optional<std::string> inconsistent_note(const StatusCounts& statuses) {
  constexpr double many = 0.1;
  const auto count = static_cast<double>(statuses.of(PixelStatus::inconsistent));
  const auto pixels = static_cast<double>(statuses.pixels());
  if (!(count > many * pixels)) return std::nullopt;
  return fmt::format(
      "{:.1f} % of the pixels are inconsistent: no depth explains their measurements within the "
      "camera's noise. Check --code, --camera and the order and type of the raw numbers. If they "
      "are right, the camera differs from its description: calibrate it, set "
      "sensor.modulation_contrast, or tolerate the difference with --model-error-percent",
      100.0 * count / pixels);
}

/// Warning if the noise of a filtered frame differs from the prediction of the camera by a factor
/// above 1.5.
/// @param ratio  measured divided by predicted standard deviation
/// @param averaged  DecodeRequest::averaged
std::optional<std::string> noise_note(double ratio, int frame, double averaged) {
  constexpr double usual = 1.5;
  if (ratio <= usual && ratio >= 1.0 / usual) return std::nullopt;
  return fmt::format(
      "frame {} has {:.2g} times the noise that the camera predicts (estimated from differences of "
      "neighbouring pixels), so the filter {}. Measure the noise with `tofsmith calibrate noise`, "
      "or assume the noise of this frame with --averaged {:.3g}",
      frame, ratio,
      ratio < 1.0 ? "averages pixels of different depths" : "averages fewer pixels than it could",
      std::min(averaged / (ratio * ratio), 1e9));
}

RawFramesReader open_recording(const DecodeRequest& request, const DecodingTable& table) {
  RawReadOptions options{.measurements = table.measurements(),
                         .layout = request.layout,
                         .max_in_memory = static_cast<std::uint64_t>(1e6 * request.memory_mb),
                         .dataset = request.dataset,
                         .marking = table.marking};
  if (!request.raw_format.empty()) {
    options.format = read_raw_format(request.raw_format);
    if (request.raw.front().extension() == ".npy" && options.format->header_bytes == 0)
      throw IoError(request.raw.front().string(),
                    "found a NumPy array, which describes itself; expected binary frames as in " +
                        request.raw_format.string() + ", or no raw format");
  }
  return RawFramesReader(request.raw, options);
}

DecodeTarget target_of(const DecodeRequest& request, const DepthDecoder& decoder,
                       const RawFramesReader& reader) {
  const DecodingTable& table = decoder.table();
  const std::string held = fmt::format("{} contains {} frame{}", request.raw.front().string(),
                                       reader.frames(), reader.frames() == 1 ? "" : "s");
  require(request.average <= reader.frames(), "average", request.average, held);
  Preparation preparation{.hdr = request.hdr, .sliding = sliding_exposures(request, table)};
  preparation.steps.average = request.average;
  const int frames = preparation.frames_of(reader.frames());
  require(request.hdr.empty() || reader.frames() % preparation.group() == 0, "hdr",
          fmt::format("{} exposures", request.hdr.size()), fmt::format("{}: not a multiple", held));
  require(!request.frame || *request.frame < frames, "frame", request.frame.value_or(0),
          fmt::format("{}{}, counted from 0", held,
                      request.average > 1       ? fmt::format(", {} means", frames)
                      : preparation.sliding > 0 ? fmt::format(", {} windows", frames)
                      : request.hdr.empty()     ? ""
                                                : fmt::format(", {} of all exposures", frames)));
  const PinholeView view =
      view_of_frames(request, request.raw.front().string(), reader.width(), reader.height());
  const PinholeView written = request.undistort ? view.ideal() : view;
  const bool as_z = request.kind == DepthKind::z && !holds_points(request.output);
  return {.path = request.output,
          .policy = request.policy,
          .stack = request.stack,
          .planes = planes_to_write(request, decoder),
          .count_statuses = request.outputs.empty() ||
                            std::ranges::count(request.outputs, DecodedPlane::status) > 0,
          .all_points = request.all_points,
          .as_z = as_z,
          .first_frame = request.frame.value_or(0),
          .frames = request.frame ? 1 : frames,
          .view = view,
          .pixel_rays = as_z                           ? rays_of(request.lens, view)
                        : holds_points(request.output) ? rays_of(request.lens, written)
                                                       : PixelRays(),
          .undistortion = undistortion_of(request, view)};
}

/// Applies even with OutputPolicy::overwrite.
void check_inputs_are_kept(const DecodeRequest& request, const DecodeTarget& target) {
  std::vector<std::string> inputs = request.other_inputs;
  for (const std::filesystem::path& path :
       {request.raw_format, request.offset_map, request.gain_map, request.stray_light})
    inputs.push_back(path.string());
  if (request.lens) inputs.push_back(request.lens->rays);
  for (const std::filesystem::path& path : request.raw) inputs.push_back(path.string());
  for (const std::filesystem::path& path : target.paths()) check_not_input(path, inputs);
}

double bytes_of_planes(const DecodeTarget& target, int rows) {
  return static_cast<double>(bytes_per_pixel(target.needed_planes())) * target.view.width * rows;
}

/// `row` is memory per row that is read and decoded at a time.
FrameMemory buffer_memory(const RawFramesReader& reader, const DecodeTarget& target,
                          const Preparation& preparation,
                          const std::vector<std::unique_ptr<FramePipeline>>& pipelines) {
  const int height = target.view.height, width = target.view.width;
  const double row_planes = bytes_of_planes(target, 1);
  const bool in_rows = target.in_rows();
  const FrameMemory prepared = preparation.memory(height, width, reader.measurements()),
                    processed =
                        pipelines.front()->memory(preparation.submitted_of(reader.frames()));
  const auto pipeline_count = static_cast<double>(pipelines.size());
  const auto of_files = static_cast<double>(
      reader.bytes_in_memory() + target.writing_bytes() + target.pixel_rays.bytes() +
      (target.undistortion ? target.undistortion->bytes() : 0));
  FrameMemory all;
  all.whole = of_files + prepared.whole + pipeline_count * processed.whole +
              (in_rows ? 0.0 : row_planes * height);
  all.row = (reader.bytes_in_memory() > 0 ? 0.0 : 2.0 * static_cast<double>(reader.row_bytes())) +
            2.0 * static_cast<double>(reader.marked_row_bytes()) + prepared.row +
            pipeline_count * processed.row + (in_rows ? row_planes : 0.0);
  if (!preparation.needs_frames()) return all;
  return {.whole = all.whole + all.row * height, .row = 0.0};
}

/// Returns the number of rows for which all buffers fit into the memory.
/// @throws IoError if a frame in this format, a frame with filters, or a single row needs more
int rows_at_a_time(const FrameMemory& bytes, const DecodeTarget& target,
                   const Preparation& preparation, double memory_bytes) {
  const int height = target.view.height, width = target.view.width;
  const auto [whole, row] = bytes;
  if (whole + row > memory_bytes)
    throw IoError(
        target.path.string(),
        fmt::format(
            "frames of {} x {} pixels require {:.3g} MB to be {}written to this output; expected "
            "at most {:.3g} MB ({}fewer --outputs require less{}; --memory-mb allows more)",
            height, width, 1e-6 * (whole + row),
            preparation.steps.filter || preparation.steps.time_filter ? "filtered and " : "",
            1e-6 * memory_bytes,
            preparation.needs_frames()
                ? "without filters, mixed and undistort, frames are decoded in bands of rows; "
                : "",
            target.in_rows() ? "" : "; .npy is written row by row, with --stack for every plane"));
  // Larger bands are not faster.
  constexpr double comfortable_bytes = 32e6;
  const double rows = row > 0.0 ? std::min(memory_bytes - whole, comfortable_bytes) / row : height;
  return std::clamp(static_cast<int>(rows), 1, height);
}

class Pace {
 public:
  Pace(const Progress& progress, const DecodeTarget& target)
      : progress_(progress), target_(target) {}

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// @param pixels  number of pixels decoded before
  Progress of_band(const Band& band, std::int64_t pixels) const {
    if (!progress_) return {};
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
                            target_.frames, plain_number(rate / frame, 3));
      return progress_(done / all,
                       fmt::format("{}, {} Mpixel/s", where, plain_number(1e-6 * rate, 3)));
    };
  }

 private:
  const Progress& progress_;
  const DecodeTarget& target_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void add_noise_note(FramePipeline& pipeline, const Band& band, DecodedRecording& result) {
  const FrameSteps& steps = pipeline.steps();
  if (const auto ratio = measured_noise_ratio(*steps.filter, pipeline.measured()))
    if (const auto note = noise_note(*ratio, band.frame, steps.averaged))
      result.notes.push_back(*note);
}

void decode_frames(const RawFramesReader& reader, const Preparation& preparation, int rows,
                   const std::vector<std::unique_ptr<FramePipeline>>& pipelines,
                   const PlaneCorrections& corrections, DecodeOutput& output,
                   const Progress& progress, DecodedRecording& result) {
  const DecodeTarget& target = output.target();
  const int height = target.view.height, width = target.view.width;
  DepthImage planes(target.needed_planes(), target.in_rows() ? rows : height, width);
  const std::vector<Band> bands =
      bands_of(target.first_frame, target.first_frame + target.frames, height, rows);
  ReadAhead recorded(reader, bands_to_read(preparation, reader.frames(), bands));
  PreparedFrames input([&] { return recorded.next(); }, preparation, pipelines, reader.frames());
  const Pace pace(progress, target);
  StatusCounts statuses;
  for (const Band& band : bands) {
    const Progress here = pace.of_band(band, result.pixels);
    report(here, 0.0, "reading");
    decode_next(input, corrections, band, target, planes, here);
    if (preparation.steps.filter && result.frames.empty())
      add_noise_note(input.pipeline(), band, result);
    if (target.undistortion) undistort(planes, *target.undistortion, target.as_z);
    const std::int64_t pixels = std::int64_t{band.rows} * width;
    if (target.count_statuses)
      statuses.add(std::span(planes.status.pixels)
                       .subspan(target.first_pixel(band), static_cast<std::size_t>(pixels)));
    output.take(band.frame, band.first_row, band.rows, planes);
    result.pixels += pixels;
    result.seconds = pace.seconds();
    if (band.first_row + band.rows < height) continue;
    result.frames.push_back(std::exchange(statuses, {}));
    if (!target.stack) result.files.push_back(target.frame_path(band.frame));
  }
  output.finish();
  if (target.stack) result.files = target.paths();
  result.seconds = pace.seconds();
}

}  // namespace

void StatusCounts::add(std::span<const PixelStatus> statuses) {
  for (const PixelStatus status : statuses) ++counts_[static_cast<std::size_t>(status)];
}

void StatusCounts::add(const StatusCounts& other) {
  for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

std::int64_t StatusCounts::pixels() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
}

StatusCounts DecodedRecording::total() const {
  StatusCounts sum;
  for (const StatusCounts& frame : frames) sum.add(frame);
  return sum;
}

void decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                      const Progress& progress, DecodedRecording& result) {
  result = {};
  const DepthDecoder& decoder = backend.decoder();
  check_request(request, decoder);
  const DecodingTable& table = decoder.table();
  const RawFramesReader reader = open_recording(request, table);
  DecodeTarget asked = target_of(request, decoder, reader);
  const PlaneCorrections corrections =
      corrections_of(request, table, request.raw.front().string(), reader.height(), reader.width());
  asked.correction_planes = planes_for(corrections, table);
  check_inputs_are_kept(request, asked);
  DecodeOutput output(std::move(asked));
  const DecodeTarget& target = output.target();
  const std::optional<Filter> filter = filter_of(request, table);
  const Preparation preparation = preparation_of(request, table, filter);
  const std::vector<std::unique_ptr<FramePipeline>> pipelines =
      prepare_pipelines(backend, preparation, reader.height(), reader.width());
  const int rows = rows_at_a_time(buffer_memory(reader, target, preparation, pipelines), target,
                                  preparation, 1e6 * request.memory_mb);

  result.height = reader.height();
  result.width = reader.width();
  result.measurements = reader.measurements();
  result.first_frame = target.first_frame;
  result.frame_count = target.frames;
  result.outputs = target.planes;
  if (const auto note = electrons_note(reader, table)) result.notes.push_back(*note);
  if (const auto note = repeated_offset_note(table, corrections.maps.delay_offset_m))
    result.notes.push_back(*note);
  if (const auto note = large_offset_note(table, corrections.maps.delay_offset_m))
    result.notes.push_back(*note);
  decode_frames(reader, preparation, rows, pipelines, corrections, output, progress, result);
  const StatusCounts total = result.total();
  if (const auto note = no_depth_note(total)) result.notes.push_back(*note);
  if (const auto note = inconsistent_note(total)) {
    const auto misfit =
        misfit_note(request, decoder, reader, preparation.first_recorded(target.first_frame));
    result.notes.push_back(misfit ? *misfit : *note);
  }
}

DecodedRecording decode_recording(const DecodeRequest& request, const FrameBackend& backend,
                                  const Progress& progress) {
  DecodedRecording result;
  decode_recording(request, backend, progress, result);
  return result;
}

}  // namespace tofsmith
