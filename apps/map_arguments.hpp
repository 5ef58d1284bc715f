// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tofsmith/decode/pixel_maps.hpp"

namespace tofsmith::apps {

/// What differs from pixel to pixel: `--offset-map`, `--gain-map`.
struct MapArguments {
  std::string offset, gain;

  void add_to(CLI::App& command);
  /// The maps of frames of this size.
  /// @throws IoError naming the file of a map that is of another size or holds what none may
  PixelMaps load(int height, int width) const;
};

}  // namespace tofsmith::apps
