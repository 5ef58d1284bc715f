// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "depth_output.hpp"

namespace tofsmith::apps {

namespace {

std::filesystem::path with_suffix(std::filesystem::path path, const std::string& suffix) {
  path.replace_filename(path.stem().string() + suffix + path.extension().string());
  return path;
}

}  // namespace

std::filesystem::path DecodeTarget::frame_path(int frame) const {
  if (frames == 1) return path;
  const std::size_t digits = std::to_string(first_frame + frames - 1).size();
  return with_suffix(path, fmt::format("-{:0{}}", frame, digits));
}

std::filesystem::path DecodeTarget::stack_path(const std::string& plane) const {
  return plane == "depth" ? path : with_suffix(path, "-" + plane);
}

std::vector<std::filesystem::path> DecodeTarget::paths() const {
  std::vector<std::filesystem::path> all;
  if (stack)
    for (const std::string& plane : planes) all.push_back(stack_path(plane));
  else
    for (int frame = first_frame; frame < first_frame + frames; ++frame)
      all.push_back(frame_path(frame));
  return all;
}

std::vector<std::string> DecodeTarget::needed_planes() const {
  std::vector<std::string> needed = planes;
  const auto need = [&](const std::string& name) {
    if (std::ranges::find(needed, name) == needed.end()) needed.push_back(name);
  };
  if (path.extension() == ".ply") need("depth");
  if (count_statuses) need("status");
  return needed;
}

std::size_t DecodeTarget::writing_bytes() const {
  if (in_rows()) return 0;
  return static_cast<std::size_t>(view.height) * static_cast<std::size_t>(view.width) *
         writing_bytes_per_pixel(path.extension().string(), planes);
}

DecodeOutput::DecodeOutput(DecodeTarget target, const Session& session)
    : target_(std::move(target)), policy_(session.output_policy()) {
  for (const std::filesystem::path& path : target_.paths()) check_decoded_output(path, session);
}

void DecodeOutput::take(int frame, int first_row, int rows, const DecodedPlanes& planes) {
  const bool first = first_row == 0, last = first_row + rows == target_.view.height;
  if (!target_.in_rows()) {
    if (last)
      write_decoded(target_.frame_path(frame), planes, target_.planes, target_.view, policy_);
    return;
  }
  if (first && !(target_.stack && frame > target_.first_frame)) open_files(frame);
  for (std::size_t i = 0; i < files_.size(); ++i)
    files_[i]->append(planes.items(target_.planes[i], rows));
  if (last && !target_.stack) close_files();
}

void DecodeOutput::open_files(int frame) {
  const auto height = static_cast<std::size_t>(target_.view.height);
  const auto width = static_cast<std::size_t>(target_.view.width);
  NpyShape shape = {height, width};
  if (target_.stack) shape.insert(shape.begin(), static_cast<std::size_t>(target_.frames));
  for (const std::string& plane : target_.planes)
    files_.push_back(std::make_unique<NpyItemWriter>(
        target_.stack ? target_.stack_path(plane) : target_.frame_path(frame), type_of_plane(plane),
        shape, policy_));
}

void DecodeOutput::close_files() {
  for (const auto& file : files_) file->commit();
  files_.clear();
}

void DecodeOutput::finish() { close_files(); }

}  // namespace tofsmith::apps
