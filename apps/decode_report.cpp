// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace tofsmith::apps {

namespace {

constexpr std::size_t most_lines = 8, first_lines = 3, most_listed = 100'000;

std::string kind_of(const DecodeTarget& target) {
  if (target.path.extension() == ".ply") return "points";
  return target.as_z ? "z-depth" : "radial distance";
}

/// "a: b", or "a" if there is nothing to add.
std::string with_status(const std::string& text, const StatusCounts& statuses) {
  const std::string status = statuses.text();
  return status.empty() ? text : fmt::format("{}: {}", text, status);
}

std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string frame_lines(const DecodeTarget& target, const DecodeSummary& summary) {
  const std::size_t frames = summary.frames.size();
  const std::size_t listed = frames <= most_lines ? frames : first_lines;
  const auto path = [&](std::size_t i) {
    return target.frame_path(target.first_frame + static_cast<int>(i)).string();
  };
  std::string lines;
  for (std::size_t i = 0; i < listed; ++i)
    lines +=
        with_status(fmt::format("wrote {} ({})", path(i), kind_of(target)), summary.frames[i]) +
        "\n";
  if (listed < frames)
    lines += fmt::format(".. and {} more, to {}\n", frames - listed, path(frames - 1));
  return lines;
}

std::string stack_lines(const DecodeTarget& target) {
  std::string lines;
  for (const std::string& plane : target.planes)
    lines += fmt::format("wrote {} ({})\n", target.stack_path(plane).string(),
                         plane == "depth" ? kind_of(target) : plane);
  return lines;
}

/// What pixels without depth are most likely due to.
std::string_view likely_cause(PixelStatus status) {
  switch (status) {
    case PixelStatus::invalid:
      return "the raw numbers are NaN or infinite, or the maps mark every pixel as dead: were they "
             "written, and read with the right --raw-format?";
    case PixelStatus::saturated:
      return "every pixel has a raw number at the saturation level: expose less, or correct "
             "sensor.full_well_e, sensor.adc_bits and sensor.gain_e_per_dn";
    default:
      return "no signal is in the raw numbers: is the light on, --code the code that was played, "
             "--layout how they run, and sensor.black_level_dn what is in the dark?";
  }
}

}  // namespace

std::optional<std::string> no_depth_note(const StatusCounts& statuses) {
  constexpr std::array without_depth = {PixelStatus::invalid, PixelStatus::no_return,
                                        PixelStatus::saturated};
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

std::string decode_lines(const DecodeTarget& target, const DecodeSummary& summary) {
  return (target.stack ? stack_lines(target) : frame_lines(target, summary)) +
         with_status(
             fmt::format("{} of {} x {} in {}, {} frames/s, {} Mpixel/s",
                         plural(summary.frames.size(), "frame"), target.view.height,
                         target.view.width, time_text(summary.seconds),
                         rate_text(summary.frames_per_s()), rate_text(summary.megapixels_per_s())),
             summary.total());
}

void add_decode_summary(const DecodeTarget& target, const DecodeSummary& summary,
                        nlohmann::ordered_json& document) {
  const auto add_status = [](nlohmann::ordered_json& to, const StatusCounts& statuses) {
    const std::string text = statuses.text();
    if (!text.empty()) to["status"] = text;
  };
  document["frame_count"] = summary.frames.size();
  if (summary.frames.size() <= most_listed) {
    nlohmann::ordered_json& frames = document["frames"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < summary.frames.size(); ++i) {
      const int frame = target.first_frame + static_cast<int>(i);
      nlohmann::ordered_json entry = {{"frame", frame}};
      if (!target.stack) entry["output"] = target.frame_path(frame).string();
      add_status(entry, summary.frames[i]);
      frames.push_back(std::move(entry));
    }
  }
  if (target.stack)
    for (const std::string& plane : target.planes)
      document["stack"][plane] = target.stack_path(plane).string();
  add_status(document, summary.total());
  document["seconds"] = summary.seconds;
  document["frames_per_s"] = summary.frames_per_s();
  document["megapixels_per_s"] = summary.megapixels_per_s();
}

}  // namespace tofsmith::apps
