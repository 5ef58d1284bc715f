// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace tofsmith {

/// What a reader is told about a figure.
struct FigureText {
  std::string id = {};        ///< unique on a page; letters, digits and dashes, e.g. "coding-curve"
  std::string title = {};     ///< a few words; stands in bold before the caption
  std::string caption = {};   ///< what is drawn and what to see in it
  std::string alt_text = {};  ///< for readers who cannot see it; the title when empty
};

/// Ends of an axis or of a colour scale, in the unit of the values.
struct ValueRange {
  double low = 0;
  double high = 1;
};

/// An axis, titled "label (unit)", or "label" when the unit is empty.
struct Axis {
  std::string label = {};
  std::string unit = {};
  bool logarithmic = false;              ///< values that are not positive are left out
  bool from_zero = false;                ///< the axis always shows zero (linear axes)
  std::optional<ValueRange> range = {};  ///< chosen from the values when absent
};

/// "label (unit)", or "label" when there is no unit.
std::string axis_title(const std::string& label, const std::string& unit);

/// Room a figure takes on a page of any width: height = fixed_px + per_width * width.
struct FigureSize {
  double fixed_px = 380;
  double per_width = 0;
  double min_width_px = 0;  ///< a narrower page scrolls the figure sideways
};

/// A figure as Plotly JSON, without colours of page and text: those come from where it is shown.
class Figure {
 public:
  /// @param plotly_json  {"data": [..], "layout": {..}}; the builders beside this header make it
  /// @throws std::invalid_argument if the id is not made of letters, digits and dashes, or the
  ///         title is empty
  Figure(FigureText text, std::string plotly_json, FigureSize size = {});

  const FigureText& text() const { return text_; }
  const FigureSize& size() const { return size_; }

  /// {"data": [..], "layout": {..}}; large arrays as Plotly's typed arrays
  /// {"dtype": "f4", "bdata": base64, "shape": "H, W"}, which Plotly reads since 2.35.
  const std::string& plotly_json() const { return plotly_json_; }
  /// The same with every array written out as numbers, for any Plotly.
  std::string plain_plotly_json() const;

 private:
  FigureText text_;
  std::string plotly_json_;
  FigureSize size_;
};

/// The values of a vector expression, in the type the builders take.
std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector);

}  // namespace tofsmith
