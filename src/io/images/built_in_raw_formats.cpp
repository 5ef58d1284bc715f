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
       "# Arducam ToF camera through V4L2 as pixel format Y12: four buffers a frame, one a phase.\n"
       "#   v4l2-ctl --set-fmt-video=width=240,height=180,pixelformat=Y12 --stream-mmap "
       "--stream-to=-\n"
       "# As a public driver for the Raspberry Pi reads them (arducam_tof.cpp): 11 bits with a "
       "sign,\n"
       "# rows from below, depth = c / (4 pi f) atan2(third - first, fourth - second).\n"
       "width = 240\n"
       "height = 180\n"
       "measurements = 4\n"
       "bits = 11\n"
       "container_bits = 16\n"
       "unused_bits = \"ignored\"\n"
       "signed = true\n"
       "order = [3, 2, 1, 0]\n"
       "flip_rows = true\n"}};
  return formats;
}

std::string reason_of(const std::string& camera) {
  if (camera == "kinect-v2")
    return "its columns are interleaved and its numbers go through a table (libfreenect2 unpacks "
           "them: hand its nine images over as .npy)";
  return "nobody publishes how its raw frames run";
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
         fmt::format("has no description of its raw frames: {}; there is one of {}",
                     reason_of(camera), fmt::join(built_in_raw_format_names(), ", ")));
}

}  // namespace tofsmith
