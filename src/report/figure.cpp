// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <algorithm>
#include <utility>

#include "report/shared/plotly_json.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

bool is_id_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

std::string axis_title(const std::string& label, const std::string& unit) {
  return unit.empty() ? label : label + " (" + unit + ")";
}

Figure::Figure(FigureText text, std::string plotly_json, FigureSize size)
    : text_(std::move(text)), plotly_json_(std::move(plotly_json)), size_(size) {
  require(!text_.id.empty() && std::ranges::all_of(text_.id, is_id_character), "FigureText::id",
          text_.id, "must be letters, digits and dashes");
  require(!text_.title.empty(), "FigureText::title", text_.title, "must not be empty");
}

std::string Figure::plain_plotly_json() const {
  auto json = plotly::Json::parse(plotly_json_);
  plotly::expand_typed_arrays(json);
  return json.dump();
}

std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return {vector.begin(), vector.end()};
}

}  // namespace tofsmith
