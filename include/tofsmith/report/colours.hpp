// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "tofsmith/report/figure.hpp"

namespace tofsmith {

enum class Dash { solid, dash, dot, dash_dot };

/// How a line is drawn. Colours are "#rrggbb"; black turns to the page's ink on a dark page.
struct LineStyle {
  std::string colour = "#0072b2";
  Dash dash = Dash::solid;
  double width_px = 1.8;
};

/// Gives every name its own colour and dash, and the same one whenever it is asked again: one
/// object per report makes a code look the same in every figure. Names get the colours of the
/// palette in the order of their first use; when they run out, the next dash starts over.
/// @see Okabe and Ito, "Color Universal Design", 2008; yellow is left out (too pale on white)
class ColourAssignment {
 public:
  LineStyle style(const std::string& name);

 private:
  std::map<std::string, int> order_;
};

/// Grey, dotted: targets, limits and bounds that belong to no code.
LineStyle reference_style();

/// Colours of maps. The sequential ones read in grey and with any colour vision; diverging runs
/// from blue over white to red and is symmetric about zero.
enum class ColourMap { viridis, cividis, diverging };

/// How values become colours.
struct ColourScale {
  std::string label = {};  ///< title of the colour bar
  std::string unit = {};
  ColourMap map = ColourMap::viridis;
  bool logarithmic = false;              ///< not for diverging maps
  std::optional<ValueRange> range = {};  ///< chosen from the values when absent
  double clip_fraction = 0;              ///< share of values that may lie beyond a chosen range
};

}  // namespace tofsmith
