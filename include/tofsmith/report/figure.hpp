// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// What a figure says about itself.
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

/// A figure as data: values, axes and units. The viewer of the page draws it.
class Figure {
 public:
  /// @param kind  "lines", "map", "image", "curves" or "cloud"
  /// @param json  members of the figure in the page's document; the functions below write it
  /// @throws std::invalid_argument if the id is not made of letters, digits and dashes, or the
  ///         title is empty
  Figure(FigureText text, std::string kind, std::string json);

  const FigureText& text() const { return text_; }
  const std::string& kind() const { return kind_; }
  const std::string& json() const { return json_; }

 private:
  FigureText text_;
  std::string kind_;
  std::string json_;
};

/// The values of a vector expression, in the type the builders take.
std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector);

enum class Dash { solid, dash, dot, dash_dot };

/// How a line is drawn. Colours are "#rrggbb"; the palette becomes lighter on a dark page.
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

enum class Mark {
  line,              ///< points joined by straight lines
  steps,             ///< a value holds until the next point: binary waveforms, patterns
  line_and_markers,  ///< lines with a dot at every point
  markers            ///< dots alone
};

/// One curve. Values that are not finite leave a gap.
struct Series {
  std::string name = {};
  std::vector<double> x = {};
  std::vector<double> y = {};
  std::vector<double> y_error = {};   ///< half lengths of error bars; empty for none
  std::optional<double> period = {};  ///< x repeats after this: one more point closes the period
  Mark mark = Mark::line;
  LineStyle style = {};
};

/// Curves in one pair of axes. A log y axis makes it a convergence plot.
/// @throws std::invalid_argument if there is no series, or x, y and y_error differ in length
Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y);

/// An axis of named places.
struct CategoryAxis {
  std::string label = {};
  std::string unit = {};
  std::vector<std::string> ticks = {};
};

/// Values by row (first row at the bottom) and column; NaN leaves a cell empty.
struct HeatMap {
  std::string title = {};
  Eigen::MatrixXd values = {};
};

struct HeatMapOptions {
  int columns = 3;          ///< panels side by side
  bool show_values = true;  ///< writes every value into its cell, two significant digits
};

/// Heat maps on the same axes with one colour scale, e.g. depth error by operating point, one
/// panel per code.
/// @throws std::invalid_argument unless every map has y.ticks x x.ticks values and the colour
///         scale suits them
Figure heat_map_figure(FigureText text, const std::vector<HeatMap>& maps, const CategoryAxis& x,
                       const CategoryAxis& y, const ColourScale& colours,
                       const HeatMapOptions& options = {});

/// A picture of values, first row at the top; NaN is transparent.
struct ValueImage {
  std::string title = {};
  Image<float> pixels = {};
  Image<float> before = {};  ///< of the same size: a slider shows it to its left; empty: none
};

/// Values to compare pictures with: the figure can also show their differences to these.
struct ImageReference {
  std::string name = {};     ///< of the differences, e.g. "error"
  Image<float> values = {};  ///< of the size of the pictures
  double period = 0;         ///< differences go the shorter way around; 0: no period
  double factor = 1;         ///< from differences to the unit of `colours`
  ColourScale colours = {};  ///< of the differences
};

struct ImageFigureOptions {
  int columns = 3;     ///< pictures side by side
  int max_side = 320;  ///< longer pictures are shown at every n-th pixel; the caption says so
  std::string before_name = "before";  ///< what the slider's ends are called
  std::string after_name = "after";
  std::optional<ImageReference> reference = {};
};

/// Pictures (H x W) side by side with one colour scale: depth maps, error maps.
/// @throws std::invalid_argument unless all pictures have one shape and the colour scale suits them
Figure image_figure(FigureText text, const std::vector<ValueImage>& images,
                    const ColourScale& colours, const ImageFigureOptions& options = {});

/// A closed curve in space; the last point is joined to the first.
struct Curve3d {
  std::string title = {};
  Eigen::MatrixX3d points = {};  ///< (N, 3)
  Eigen::VectorXd values = {};   ///< (N): what colours the curve, e.g. depth
};

/// Closed curves, each in its own box and all with one colour scale: coding curves.
/// A browser shows about 16 boxes per page.
/// @throws std::invalid_argument if there is no curve or points and values differ in number
Figure curve_3d_figure(FigureText text, const std::vector<Curve3d>& curves,
                       const std::array<Axis, 3>& axes, const ColourScale& colours);

struct PointCloudOptions {
  int max_points = 40000;      ///< a larger cloud is thinned at random; the caption says so
  double point_size_px = 2.2;  ///< diameter
};

/// Points in the camera's frame (x right, y down, z forward) [m].
struct ColouredPoints {
  std::string title = {};
  Eigen::MatrixX3f points = {};  ///< (P, 3)
  Eigen::VectorXf values = {};   ///< (P): what colours them
};

/// Clouds, each in its own box and all with one colour scale. Points with a coordinate or value
/// that is not finite are left out. The same cloud is always thinned to the same points.
/// @throws std::invalid_argument if there is no cloud or points and values differ in number
Figure point_cloud_figure(FigureText text, const std::vector<ColouredPoints>& clouds,
                          const ColourScale& colours, const PointCloudOptions& options = {});
/// The same of one cloud.
Figure point_cloud_figure(FigureText text, const Eigen::MatrixX3f& points,
                          const Eigen::VectorXf& values, const ColourScale& colours,
                          const PointCloudOptions& options = {});

/// One column of a grid of panels; its panels share both axes.
struct PanelColumn {
  std::string title = {};
  Axis x = {};
  Axis y = {};
};

/// One row of a grid of panels: the curves of each column.
struct PanelRow {
  std::string title = {};
  std::vector<std::vector<Series>> panels = {};
};

/// A grid of panels, e.g. measurements (rows) by modulation, demodulation and correlation
/// (columns). Series of one name share one legend entry.
/// @throws std::invalid_argument if a row has not one panel per column
Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows);

}  // namespace tofsmith
