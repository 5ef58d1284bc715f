// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/core/array.hpp"
#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {

/// A picture of values, first row at the top; NaN is transparent.
struct ValueImage {
  std::string title = {};
  Image<float> pixels = {};
};

struct ImageFigureOptions {
  int columns = 3;     ///< pictures side by side
  int max_side = 320;  ///< longer pictures are shown at every n-th pixel; the caption says so
};

/// Pictures (H x W) side by side with one colour scale: depth maps, error maps.
/// @throws std::invalid_argument unless all pictures have one shape and the colour scale suits them
Figure image_figure(FigureText text, const std::vector<ValueImage>& images,
                    const ColourScale& colours, const ImageFigureOptions& options = {});

}  // namespace tofsmith
