// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/code_styles.hpp"

#include <array>
#include <utility>

namespace tofsmith {

LineStyle style_of_code(std::string_view code) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 10> colours = {{
      {"hamiltonian-k3", "#56b4e9"},         // sky blue
      {"hamiltonian-k4", "#0072b2"},         // blue
      {"hamiltonian-k5", "#009e73"},         // bluish green
      {"hamiltonian-k6", "#000000"},         // black
      {"hamiltonian", "#0072b2"},            // two-bucket ones by their number of values
      {"pulsed-multifrequency", "#8a8f98"},  // grey
      {"multifrequency", "#cc79a7"},         // reddish purple
      {"sinusoid", "#d55e00"},               // vermillion
      {"square", "#e69f00"},                 // orange
      {"", "#000000"},
  }};
  LineStyle style;
  for (const auto& [family, colour] : colours)
    if (code.starts_with(family)) {
      style.colour = colour;
      break;
    }
  if (code.find("-ideal") != std::string_view::npos) style.dash = Dash::dash;
  if (code.ends_with("-one-tap")) style.dash = Dash::dash_dot;
  if (code.find("-naive") != std::string_view::npos) style.dash = Dash::dot;
  return style;
}

}  // namespace tofsmith
