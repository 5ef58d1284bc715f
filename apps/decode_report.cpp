// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "session.hpp"

namespace tofsmith::apps {

namespace {

constexpr std::size_t max_lines = 8, first_lines = 3, max_listed = 100'000;

std::string kind_of(const DecodeRequest& request) {
  if (holds_points(request.output)) return "points";
  return request.kind == DepthKind::z ? "z-depth" : "radial distance";
}

/// Returns a text such as "ok 76.10 %, low_signal 3.20 %"; "" without pixels.
std::string status_text(const StatusCounts& statuses) {
  const auto pixels = static_cast<double>(statuses.pixels());
  std::string text;
  for (const PixelStatus status : all_pixel_statuses) {
    const std::int64_t count = statuses.of(status);
    if (count > 0)
      text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name_of(status),
                          100.0 * static_cast<double>(count) / pixels);
  }
  return text;
}

/// Returns "text: status", or only the text if no pixels were counted.
std::string with_status(const std::string& text, const StatusCounts& statuses) {
  const std::string status = status_text(statuses);
  return status.empty() ? text : fmt::format("{}: {}", text, status);
}

std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string frame_lines(const DecodeRequest& request, const DecodedRecording& result) {
  const std::size_t frames = result.frames.size();
  const std::size_t listed = frames <= max_lines ? frames : first_lines;
  std::string lines;
  for (std::size_t i = 0; i < listed; ++i)
    lines += with_status(fmt::format("wrote {} ({})", result.files[i].string(), kind_of(request)),
                         result.frames[i]) +
             "\n";
  if (listed < frames)
    lines += fmt::format("... and {} more, up to {}\n", frames - listed,
                         result.files[frames - 1].string());
  return lines;
}

std::string stack_lines(const DecodeRequest& request, const DecodedRecording& result) {
  std::string lines;
  for (std::size_t i = 0; i < result.files.size(); ++i) {
    const DecodedPlane plane = result.outputs[i];
    lines += fmt::format("wrote {} ({})\n", result.files[i].string(),
                         plane == DecodedPlane::depth ? kind_of(request) : name_of(plane));
  }
  return lines;
}

}  // namespace

std::string decode_lines(const DecodeRequest& request, const DecodedRecording& result) {
  return (request.stack ? stack_lines(request, result) : frame_lines(request, result)) +
         with_status(fmt::format("{} of {} x {} in {}, {} frames/s, {} Mpixel/s",
                                 plural(result.frames.size(), "frame"), result.height, result.width,
                                 time_text(result.seconds), rate_text(result.frames_per_s()),
                                 rate_text(result.megapixels_per_s())),
                     result.total());
}

void add_decode_summary(const DecodeRequest& request, const DecodedRecording& result,
                        nlohmann::ordered_json& document) {
  const auto add_status = [](nlohmann::ordered_json& to, const StatusCounts& statuses) {
    for (const PixelStatus status : all_pixel_statuses)
      if (statuses.of(status) > 0) to["status"][std::string(name_of(status))] = statuses.of(status);
  };
  document["frame_count"] = result.frames.size();
  if (result.frames.size() <= max_listed) {
    nlohmann::ordered_json& frames = document["frames"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
      nlohmann::ordered_json entry = {{"frame", result.first_frame + static_cast<int>(i)}};
      if (!request.stack) entry["output"] = result.files[i].string();
      add_status(entry, result.frames[i]);
      frames.push_back(std::move(entry));
    }
  }
  if (request.stack)
    for (std::size_t i = 0; i < result.files.size(); ++i)
      document["stack"][std::string(name_of(result.outputs[i]))] = result.files[i].string();
  add_status(document, result.total());
  document["seconds"] = result.seconds;
  document["frames_per_s"] = result.frames_per_s();
  document["megapixels_per_s"] = result.megapixels_per_s();
}

}  // namespace tofsmith::apps
