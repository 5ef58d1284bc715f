// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/bar_figure.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

using nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const FigureText some_text{"some-figure", "Some figure"};
const Axis some_axis{.label = "Depth", .unit = "m"};

json json_of(const Figure& figure) { return json::parse(figure.plotly_json()); }

TEST(Figure, RefusesIdsThatAreNoIds) {
  EXPECT_THROW(Figure({"", "Title"}, "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a b", "Title"}, "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a\"><script>", "Title"}, "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a", ""}, "{}"), std::invalid_argument);
  EXPECT_NO_THROW(Figure({"hamiltonian-K4", "Title"}, "{}"));
}

TEST(LineFigure, LeavesAGapWhereAValueIsNotFinite) {
  const Figure figure = line_figure(
      some_text, {{.name = "a", .x = {0, 1, 2, 3}, .y = {1.5, nan, infinity, -2}}}, {}, {});
  EXPECT_EQ(json_of(figure)["data"][0]["y"], json::parse("[1.5, null, null, -2.0]"));
}

TEST(LineFigure, KeepsSixDigits) {
  const Figure figure =
      line_figure(some_text, {{.name = "a", .x = {1.0 / 3}, .y = {0.1 + 0.2}}}, {}, {});
  EXPECT_NE(figure.plotly_json().find("[0.333333]"), std::string::npos);
  EXPECT_NE(figure.plotly_json().find("[0.3]"), std::string::npos);
}

TEST(LineFigure, ClosesThePeriodWithItsFirstValue) {
  const json trace = json_of(line_figure(
      some_text, {{.name = "a", .x = {0, 1, 2}, .y = {5, 6, 7}, .period = 3}}, {}, {}))["data"][0];
  EXPECT_EQ(trace["x"], json::parse("[0.0, 1.0, 2.0, 3.0]"));
  EXPECT_EQ(trace["y"], json::parse("[5.0, 6.0, 7.0, 5.0]"));
}

TEST(LineFigure, DrawsStepsThatHoldUntilTheNextPoint) {
  const Series steps{.name = "a", .x = {0, 1}, .y = {0, 1}, .mark = Mark::steps};
  EXPECT_EQ(json_of(line_figure(some_text, {steps}, {}, {}))["data"][0]["line"]["shape"], "hv");
}

TEST(LineFigure, NamesTheAxesWithTheirUnits) {
  const json layout = json_of(line_figure(some_text, {{.name = "a", .x = {1}, .y = {1}}}, some_axis,
                                          {.label = "Code"}))["layout"];
  EXPECT_EQ(layout["xaxis"]["title"]["text"], "Depth (m)");
  EXPECT_EQ(layout["yaxis"]["title"]["text"], "Code");
}

TEST(LineFigure, ShowsMarkupInNamesAsText) {
  const json trace = json_of(
      line_figure(some_text, {{.name = "<a href=x>&", .x = {1}, .y = {1}}}, {}, {}))["data"][0];
  EXPECT_EQ(trace["name"], "&lt;a href=x>&amp;");
}

TEST(LineFigure, RefusesSeriesWhoseLengthsDiffer) {
  const Series no_y{.name = "a", .x = {1, 2}, .y = {1}};
  const Series extra_error{.name = "a", .x = {1}, .y = {1}, .y_error = {1, 2}};
  EXPECT_THROW(line_figure(some_text, {}, {}, {}), std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {no_y}, {}, {}), std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {extra_error}, {}, {}), std::invalid_argument);
}

TEST(LineFigure, PutsLogarithmicTicksInsideTheData) {
  const json axis = json_of(line_figure(some_text, {{.name = "a", .x = {1, 2}, .y = {0.01, 10}}},
                                        {}, {.logarithmic = true}))["layout"]["yaxis"];
  EXPECT_EQ(axis["ticktext"], json::parse(R"(["0.01", "0.1", "1", "10"])"));
  EXPECT_EQ(axis["tickvals"], json::parse("[0.01, 0.1, 1.0, 10.0]"));
}

TEST(SmallMultiples, ListsEverySeriesNameOnce) {
  const Series a{.name = "a", .x = {0}, .y = {0}}, b{.name = "b", .x = {0}, .y = {0}};
  const json figure = json_of(small_multiples(some_text, {{"left", {}, {}}, {"right", {}, {}}},
                                              {{"", {{a, b}, {a}}}, {"", {{b}, {a}}}}));
  int entries = 0;
  for (const json& trace : figure["data"]) entries += trace["showlegend"].get<bool>() ? 1 : 0;
  EXPECT_EQ(figure["data"].size(), 5u);
  EXPECT_EQ(entries, 2);
  EXPECT_TRUE(figure["layout"].contains("xaxis4"));
  EXPECT_THROW(small_multiples(some_text, {{"left", {}, {}}}, {{"", {{a}, {b}}}}),
               std::invalid_argument);
}

TEST(HeatMap, DrawsLogarithmsOnALogarithmicScale) {
  HeatMap map{"code", Eigen::MatrixXd(1, 3)};
  map.values << 0.01, nan, 10;
  const json figure = json_of(heat_map_figure(some_text, {map}, {"x", "", {"1", "2", "3"}},
                                              {"y", "", {"1"}}, {.logarithmic = true}));
  EXPECT_EQ(figure["data"][0]["z"], json::parse("[[-2.0, null, 1.0]]"));
  EXPECT_EQ(figure["layout"]["coloraxis"]["cmin"], -2.0);
  EXPECT_EQ(figure["layout"]["coloraxis"]["cmax"], 1.0);
}

TEST(HeatMap, RefusesShapesAndScalesThatDoNotFit) {
  const HeatMap map{"code", Eigen::MatrixXd::Ones(1, 2)};
  const CategoryAxis one{"one", "", {"1"}}, two{"two", "", {"1", "2"}};
  EXPECT_NO_THROW(heat_map_figure(some_text, {map}, two, one, {}));
  EXPECT_THROW(heat_map_figure(some_text, {map}, one, two, {}), std::invalid_argument);
  EXPECT_THROW(heat_map_figure(some_text, {map}, two, one,
                               {.map = ColourMap::diverging, .logarithmic = true}),
               std::invalid_argument);
  EXPECT_THROW(heat_map_figure(some_text, {map}, two, one, {.range = ValueRange{2, 1}}),
               std::invalid_argument);
}

TEST(ImageFigure, PlainArraysHoldThePixelsThatTypedArraysHold) {
  Image<float> pixels(2, 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels.pixels[i] = static_cast<float>(i) / 4;
  pixels(1, 2) = static_cast<float>(nan);
  const Figure figure = image_figure(some_text, {{"one", pixels}}, {.label = "Depth", .unit = "m"});
  EXPECT_EQ(json_of(figure)["data"][0]["z"]["shape"], "2, 3");
  EXPECT_EQ(json::parse(figure.plain_plotly_json())["data"][0]["z"],
            json::parse("[[0.0, 0.25, 0.5], [0.75, 1.0, null]]"));
}

TEST(ImageFigure, SaysWhenItShowsEveryNthPixel) {
  const Image<float> pixels(50, 100, 1.0f);
  const Figure whole = image_figure(some_text, {{"", pixels}}, {}, {.max_side = 100});
  EXPECT_EQ(whole.text().caption, "");
  const Figure thinned = image_figure(some_text, {{"", pixels}}, {}, {.max_side = 40});
  EXPECT_NE(thinned.text().caption.find("every 3rd pixel of 100 x 50"), std::string::npos);
  EXPECT_EQ(json_of(thinned)["data"][0]["z"]["shape"], "17, 34");
}

TEST(ImageFigure, CentresADivergingScaleOnZero) {
  Image<float> pixels(1, 2, 1.0f);
  pixels(0, 1) = -3;
  const json axis = json_of(image_figure(some_text, {{"", pixels}},
                                         {.map = ColourMap::diverging}))["layout"]["coloraxis"];
  EXPECT_EQ(axis["cmin"], -3.0);
  EXPECT_EQ(axis["cmax"], 3.0);
}

TEST(ImageFigure, DrawsPicturesWithoutAnyValue) {
  const Image<float> pixels(4, 4, static_cast<float>(nan));
  for (const bool logarithmic : {false, true})
    EXPECT_NO_THROW(image_figure(some_text, {{"", pixels}}, {.logarithmic = logarithmic}));
}

TEST(Curve3d, EndsWhereItBegins) {
  Curve3d curve{"", Eigen::MatrixX3d(2, 3), Eigen::VectorXd(2)};
  curve.points << 1, 2, 3, 4, 5, 6;
  curve.values << 7, 8;
  const json trace = json_of(curve_3d_figure(some_text, {curve}, {}, {}))["data"][0];
  EXPECT_EQ(trace["x"], json::parse("[1.0, 4.0, 1.0]"));
  EXPECT_EQ(trace["line"]["color"], json::parse("[7.0, 8.0, 7.0]"));
}

TEST(PointCloud, KeepsExactlyTheStatedNumberOfFinitePoints) {
  Eigen::MatrixX3f points = Eigen::MatrixX3f::Random(1000, 3);
  const Eigen::VectorXf values = Eigen::VectorXf::LinSpaced(1000, 0, 1);
  points(3, 1) = static_cast<float>(nan);
  const auto shape = [&](int most) {
    return json_of(point_cloud_figure(some_text, points, values, {},
                                      {.max_points = most}))["data"][0]["x"]["shape"];
  };
  EXPECT_EQ(shape(100), "100");
  EXPECT_EQ(shape(5000), "999");
  EXPECT_EQ(point_cloud_figure(some_text, points, values, {}, {.max_points = 9}).plotly_json(),
            point_cloud_figure(some_text, points, values, {}, {.max_points = 9}).plotly_json());
}

TEST(PointCloud, DrawsSeveralCloudsInBoxesOfTheirOwn) {
  const Eigen::MatrixX3f points = Eigen::MatrixX3f::Random(10, 3);
  const ColouredPoints one{"one", points, Eigen::VectorXf::Zero(10)},
      two{"two", points, Eigen::VectorXf::Ones(10)};
  const json figure = json_of(point_cloud_figure(some_text, {one, two}, {}));
  ASSERT_EQ(figure["data"].size(), 2u);
  EXPECT_EQ(figure["data"][0]["scene"], "scene");
  EXPECT_EQ(figure["data"][1]["scene"], "scene2");
  EXPECT_LE(figure["layout"]["scene"]["domain"]["x"][1],
            figure["layout"]["scene2"]["domain"]["x"][0]);
  EXPECT_EQ(figure["layout"]["annotations"][1]["text"], "two");
  EXPECT_THROW(point_cloud_figure(some_text, std::vector<ColouredPoints>(), {}),
               std::invalid_argument);
  ColouredPoints wrong = one;
  wrong.values.resize(9);
  EXPECT_THROW(point_cloud_figure(some_text, {one, wrong}, {}), std::invalid_argument);
}

TEST(ImageFigure, DrawsPicturesBeforeLeftOfASlider) {
  const Image<float> before(2, 3, 1.0F), after(2, 3, 2.0F);
  const json figure = json_of(image_figure(some_text, {{"a", after, before}, {"b", after}}, {},
                                           {.before_name = "raw", .after_name = "better"}));
  ASSERT_EQ(figure["data"].size(), 3u);
  EXPECT_EQ(figure["data"][0]["meta"], json::parse(R"({"slider": "left", "name": "raw"})"));
  EXPECT_EQ(figure["data"][1]["meta"], json::parse(R"({"slider": "right", "name": "better"})"));
  EXPECT_FALSE(figure["data"][2].contains("meta"));
  EXPECT_EQ(figure["data"][0]["xaxis"], figure["data"][1]["xaxis"]);
  EXPECT_NE(figure["data"][1]["xaxis"], figure["data"][2]["xaxis"]);
  EXPECT_NE(figure["data"][0]["z"]["bdata"], figure["data"][1]["z"]["bdata"]);
  EXPECT_THROW(image_figure(some_text, {{"a", after, Image<float>(3, 2, 1.0F)}}, {}),
               std::invalid_argument);
}

TEST(BarFigure, DrawsDotsWhereABarWouldHaveNoLength) {
  const std::vector<BarSeries> series = {{.name = "a", .values = {1, 2}}};
  EXPECT_EQ(json_of(bar_figure(some_text, {"x", "y"}, series, {}))["data"][0]["type"], "bar");
  EXPECT_EQ(
      json_of(bar_figure(some_text, {"x", "y"}, series, {.logarithmic = true}))["data"][0]["type"],
      "scatter");
  EXPECT_THROW(bar_figure(some_text, {"x"}, series, {}), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
