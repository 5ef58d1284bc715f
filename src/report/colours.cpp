// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <array>

namespace tofsmith {

LineStyle ColourAssignment::style(const std::string& name) {
  static constexpr std::array palette = {
      "#0072b2",  // blue
      "#d55e00",  // vermillion
      "#009e73",  // bluish green
      "#cc79a7",  // reddish purple
      "#e69f00",  // orange
      "#56b4e9",  // sky blue
      "#000000",  // black
  };
  static constexpr std::array dashes = {Dash::solid, Dash::dash, Dash::dot, Dash::dash_dot};
  const int place = order_.try_emplace(name, static_cast<int>(order_.size())).first->second;
  const std::size_t colours = palette.size();
  const auto index = static_cast<std::size_t>(place);
  return {palette[index % colours], dashes[index / colours % dashes.size()]};
}

LineStyle reference_style() { return {"#8a8f98", Dash::dot, 1.5}; }

}  // namespace tofsmith
