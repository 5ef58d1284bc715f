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

/// Texts of a figure.
struct FigureText {
  std::string id = {};     ///< unique on a page; letters, digits and dashes
  std::string title = {};  ///< in bold before the caption
  std::string caption = {};
  std::string alt_text = {};  ///< for screen readers; default: the title
};

/// Ends of an axis or of a colour scale.
struct ValueRange {
  double low = 0;
  double high = 1;
};

/// An axis, titled "label (unit)", or "label" when the unit is empty.
struct Axis {
  std::string label = {};
  std::string unit = {};
  bool logarithmic = false;  ///< values <= 0 are omitted
  bool from_zero = false;
  std::optional<ValueRange> range = {};  ///< default: from the values
};

/// A figure as data, which the page's viewer draws.
class Figure {
 public:
  /// @param kind  "lines", "map", "image", "curves" or "cloud"
  /// @throws std::invalid_argument if the id has other characters than letters, digits and dashes,
  ///         or the title is empty
  Figure(FigureText text, std::string kind, std::string json);

  const FigureText& text() const { return text_; }
  const std::string& kind() const { return kind_; }
  const std::string& json() const { return json_; }

 private:
  FigureText text_;
  std::string kind_;
  std::string json_;
};

/// Converts a vector expression for the functions below.
std::vector<double> to_values(const Eigen::Ref<const Eigen::VectorXd>& vector);

enum class Dash { solid, dash, dot, dash_dot };

/// Style of a line. Colours are "#rrggbb"; palette colours are lightened on a dark page.
struct LineStyle {
  std::string colour = "#0072b2";
  Dash dash = Dash::solid;
  double width_px = 1.8;
};

/// Assigns each name a fixed colour and dash, in the order of first use. When the palette is
/// exhausted, it is repeated with the next dash.
/// @see Okabe and Ito, "Color Universal Design", 2008; without yellow, which is too pale on white
class ColourAssignment {
 public:
  LineStyle style(const std::string& name);

 private:
  std::map<std::string, int> order_;
};

/// Grey and dotted, for targets, limits and bounds.
LineStyle reference_style();

/// Colour maps. Sequential maps also work in grey and with any colour vision; diverging is blue,
/// white and red, symmetric about zero.
enum class ColourMap { viridis, cividis, diverging };

/// Mapping of values to colours.
struct ColourScale {
  std::string label = {};
  std::string unit = {};
  ColourMap map = ColourMap::viridis;
  bool logarithmic = false;              ///< not supported for diverging maps
  std::optional<ValueRange> range = {};  ///< default: from the values
  double clip_fraction = 0;              ///< maximum share of values outside a default range
};

enum class Mark {
  line,   ///< joined by straight lines
  steps,  ///< constant until the next point
  line_and_markers,
  markers
};

/// A curve; values that are not finite leave a gap.
struct Series {
  std::string name = {};
  std::vector<double> x = {};
  std::vector<double> y = {};
  std::vector<double> y_error = {};   ///< half lengths; may be empty
  std::optional<double> period = {};  ///< of x; the curve is closed by one more point
  Mark mark = Mark::line;
  LineStyle style = {};
};

/// Curves on common axes. @throws std::invalid_argument if there is no series, or lengths differ
Figure line_figure(FigureText text, const std::vector<Series>& series, const Axis& x,
                   const Axis& y);

/// An axis of named categories.
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
  int columns = 3;
  bool show_values = true;  ///< with two significant digits
};

/// Heat maps on the same axes with one colour scale, e.g. depth error by operating point.
/// @throws std::invalid_argument unless every map has y.ticks x x.ticks values that suit the scale
Figure heat_map_figure(FigureText text, const std::vector<HeatMap>& maps, const CategoryAxis& x,
                       const CategoryAxis& y, const ColourScale& colours,
                       const HeatMapOptions& options = {});

/// Image of values, first row at the top; NaN is transparent.
struct ValueImage {
  std::string title = {};
  Image<float> pixels = {};
  Image<float> before = {};  ///< same size; shown to the left of a slider; may be empty
};

/// Reference values, whose differences can also be shown.
struct ImageReference {
  std::string name = {};  ///< of the differences, e.g. "error"
  Image<float> values = {};
  double period = 0;  ///< differences are wrapped to this period; 0: none
  double factor = 1;  ///< converts differences to the unit of `colours`
  ColourScale colours = {};
};

struct ImageFigureOptions {
  int columns = 3;
  int max_side = 320;  ///< larger images are subsampled
  std::string before_name = "before";
  std::string after_name = "after";
  std::optional<ImageReference> reference = {};
};

/// Images side by side with a common colour scale.
/// @throws std::invalid_argument unless they have the same shape and suit the colour scale
Figure image_figure(FigureText text, const std::vector<ValueImage>& images,
                    const ColourScale& colours, const ImageFigureOptions& options = {});

/// A closed curve in space.
struct Curve3d {
  std::string title = {};
  Eigen::MatrixX3d points = {};  ///< (N, 3)
  Eigen::VectorXd values = {};   ///< (N), shown as colours
};

/// Closed curves, each in its own box, with a common colour scale; browsers show about 16 boxes.
/// @throws std::invalid_argument if there is no curve or points and values differ in number
Figure curve_3d_figure(FigureText text, const std::vector<Curve3d>& curves,
                       const std::array<Axis, 3>& axes, const ColourScale& colours);

struct PointCloudOptions {
  int max_points = 40000;      ///< larger clouds are thinned randomly
  double point_size_px = 2.2;  ///< diameter
};

/// Points in the camera's frame (x right, y down, z forward) [m].
struct ColouredPoints {
  std::string title = {};
  Eigen::MatrixX3f points = {};  ///< (P, 3)
  Eigen::VectorXf values = {};   ///< (P), shown as colours
};

/// Point clouds, each in its own box, with a common colour scale. Points that are not finite are
/// omitted. Thinning is reproducible.
/// @throws std::invalid_argument as curve_3d_figure()
Figure point_cloud_figure(FigureText text, const std::vector<ColouredPoints>& clouds,
                          const ColourScale& colours, const PointCloudOptions& options = {});
/// As above for one cloud.
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

/// A grid of panels. Series with the same name share a legend entry.
/// @throws std::invalid_argument unless every row has one panel per column
Figure small_multiples(FigureText text, const std::vector<PanelColumn>& columns,
                       const std::vector<PanelRow>& rows);

}  // namespace tofsmith
