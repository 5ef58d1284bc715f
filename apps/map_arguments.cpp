// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "map_arguments.hpp"

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/float_image_file.hpp"

namespace tofsmith::apps {

namespace {

/// Reads one map and checks it alone, so that errors name its file.
void load_map(const std::string& path, const char* name, int height, int width,
              Image<float> PixelMaps::*map, PixelMaps& maps) {
  if (path.empty()) return;
  PixelMaps alone;
  alone.*map = read_float_image(path, name);
  try {
    alone.validate(height, width);
  } catch (const std::invalid_argument& error) {
    throw IoError(path, error.what());
  }
  maps.*map = std::move(alone.*map);
}

}  // namespace

void MapArguments::add_to(CLI::App& command) {
  command.add_option("--offset-map", offset,
                     "how much too far each pixel decodes in metres (.npy .npz .exr .pfm), taken "
                     "off its depth; NaN marks a dead pixel");
  command.add_option("--gain-map", gain,
                     "response of each pixel over that of a usual one, taken out of signal and "
                     "ambient; NaN marks a dead pixel");
}

PixelMaps MapArguments::load(int height, int width) const {
  PixelMaps maps;
  load_map(offset, "offset", height, width, &PixelMaps::delay_offset_m, maps);
  load_map(gain, "gain", height, width, &PixelMaps::gain, maps);
  return maps;
}

}  // namespace tofsmith::apps
