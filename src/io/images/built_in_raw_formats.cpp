// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {
namespace {

const std::map<std::string, std::string>& known_formats() {
  static const std::map<std::string, std::string> formats = {
      {"arducam-tof",
       "# Arducam ToF camera through V4L2 as pixel format Y12: four buffers per frame, one per "
       "phase.\n#   v4l2-ctl --set-fmt-video=width=240,height=180,pixelformat=Y12 --stream-mmap "
       "--stream-to=-\n# Layout from a public driver for the Raspberry Pi (arducam_tof.cpp): "
       "signed 11 bits, rows from\n# bottom to top, depth = c / (4 pi f) atan2(third - first, "
       "fourth - second).\nwidth = 240\nheight = 180\nmeasurements = 4\nbits = 11\ncontainer_bits "
       "= 16\nunused_bits = \"ignored\"\nsigned = true\norder = [3, 2, 1, 0]\nflip_rows = true\n"}};
  return formats;
}

std::string reason_of(const std::string& camera) {
  if (camera == "kinect-v2")
    return "its columns are interleaved and its numbers require a lookup table (unpack them with "
           "libfreenect2, and save the nine images as .npy)";
  return "the format of its raw frames is not published";
}

}  // namespace

std::vector<std::string> built_in_raw_format_names() {
  std::vector<std::string> names;
  for (const auto& [name, text] : known_formats()) names.push_back(name);
  return names;
}

std::string built_in_raw_format_toml(const std::string& camera) {
  static_cast<void>(built_in_camera(camera));  // rejects unknown names
  const auto found = known_formats().find(camera);
  if (found != known_formats().end()) return found->second;
  reject("camera", camera,
         fmt::format("has no description of its raw frames: {}; expected {}", reason_of(camera),
                     fmt::join(built_in_raw_format_names(), ", ")));
}

}  // namespace tofsmith
