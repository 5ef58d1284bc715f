// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "tofsmith/core/units.hpp"
#include "unpacked.hpp"

namespace tofsmith {

namespace {

using nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const FigureText some_text{"some-figure", "Some figure"};
const Axis some_axis{.label = "Depth", .unit = "m"};

json json_of(const Figure& figure) { return json::parse(figure.json()); }

json only_series(const Figure& figure) { return json_of(figure)["rows"][0]["panels"][0][0]; }

TEST(Figure, RejectsInvalidIds) {
  EXPECT_THROW(Figure({"", "Title"}, "lines", "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a b", "Title"}, "lines", "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a\"><script>", "Title"}, "lines", "{}"), std::invalid_argument);
  EXPECT_THROW(Figure({"a", ""}, "lines", "{}"), std::invalid_argument);
  EXPECT_NO_THROW(Figure({"hamiltonian-K4", "Title"}, "lines", "{}"));
}

TEST(LineFigure, NonFiniteValuesAreNull) {
  const Figure figure = line_figure(
      some_text, {{.name = "a", .x = {0, 1, 2, 3}, .y = {1.5, nan, infinity, -2}}}, {}, {});
  EXPECT_EQ(only_series(figure)["y"], json::parse("[1.5, null, null, -2.0]"));
}

TEST(LineFigure, KeepsSixDigits) {
  const Figure figure =
      line_figure(some_text, {{.name = "a", .x = {1.0 / 3}, .y = {0.1 + 0.2}}}, {}, {});
  EXPECT_NE(figure.json().find("[0.333333]"), std::string::npos);
  EXPECT_NE(figure.json().find("[0.3]"), std::string::npos);
}

TEST(LineFigure, ClosesThePeriodWithItsFirstValue) {
  const json series = only_series(
      line_figure(some_text, {{.name = "a", .x = {0, 1, 2}, .y = {5, 6, 7}, .period = 3}}, {}, {}));
  EXPECT_EQ(series["x"], json::parse("[0.0, 1.0, 2.0, 3.0]"));
  EXPECT_EQ(series["y"], json::parse("[5.0, 6.0, 7.0, 5.0]"));
}

TEST(LineFigure, DescribesTheStyleOfSeriesAndAxes) {
  const Series steps{.name = "<a>", .x = {0, 1}, .y = {0, 1}, .mark = Mark::steps};
  const Figure figure = line_figure(some_text, {steps}, some_axis, {.logarithmic = true});
  EXPECT_EQ(figure.kind(), "lines");
  EXPECT_EQ(only_series(figure)["mark"], "steps");
  EXPECT_EQ(only_series(figure)["name"], "<a>");
  const json column = json_of(figure)["columns"][0];
  EXPECT_EQ(column["x"]["label"], "Depth");
  EXPECT_EQ(column["x"]["unit"], "m");
  EXPECT_EQ(column["y"]["log"], true);
}

TEST(LineFigure, RejectsSeriesOfDifferentLengthsAndInvalidRanges) {
  const Series no_y{.name = "a", .x = {1, 2}, .y = {1}};
  const Series extra_error{.name = "a", .x = {1}, .y = {1}, .y_error = {1, 2}};
  const Series good{.name = "a", .x = {1}, .y = {1}};
  EXPECT_THROW(line_figure(some_text, {}, {}, {}), std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {no_y}, {}, {}), std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {extra_error}, {}, {}), std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {good}, {.range = ValueRange{2, 1}}, {}),
               std::invalid_argument);
  EXPECT_THROW(line_figure(some_text, {good}, {.logarithmic = true, .range = ValueRange{0, 1}}, {}),
               std::invalid_argument);
}

TEST(SmallMultiples, HaveOnePanelPerColumn) {
  const Series a{.name = "a", .x = {0}, .y = {0}}, b{.name = "b", .x = {0}, .y = {0}};
  const json figure = json_of(small_multiples(some_text, {{"left", {}, {}}, {"right", {}, {}}},
                                              {{"", {{a, b}, {a}}}, {"second", {{b}, {a}}}}));
  EXPECT_EQ(figure["columns"][1]["title"], "right");
  EXPECT_EQ(figure["rows"][0]["panels"][0].size(), 2u);
  EXPECT_EQ(figure["rows"][1]["title"], "second");
  EXPECT_THROW(small_multiples(some_text, {{"left", {}, {}}}, {{"", {{a}, {b}}}}),
               std::invalid_argument);
}

TEST(HeatMap, HasRowsOfValues) {
  HeatMap map{"code", Eigen::MatrixXd(2, 2)};
  map.values << 0.01, nan, 10, 20;
  const json figure = json_of(heat_map_figure(some_text, {map}, {"x", "", {"1", "2"}},
                                              {"y", "", {"1", "2"}}, {.logarithmic = true}));
  EXPECT_EQ(figure["panels"][0]["values"], json::parse("[0.01, null, 10.0, 20.0]"));
  EXPECT_EQ(figure["colours"]["log"], true);
}

TEST(HeatMap, RejectsInvalidShapesAndScales) {
  const HeatMap map{"code", Eigen::MatrixXd::Ones(1, 2)};
  const CategoryAxis one{"one", "", {"1"}}, two{"two", "", {"1", "2"}};
  EXPECT_NO_THROW(heat_map_figure(some_text, {map}, two, one, {}));
  EXPECT_THROW(heat_map_figure(some_text, {map}, one, two, {}), std::invalid_argument);
  EXPECT_THROW(heat_map_figure(some_text, {map}, two, one,
                               {.map = ColourMap::diverging, .logarithmic = true}),
               std::invalid_argument);
  EXPECT_THROW(heat_map_figure(some_text, {map}, two, one, {.range = ValueRange{2, 1}}),
               std::invalid_argument);
  EXPECT_THROW(heat_map_figure(some_text, {map}, two, one, {.clip_fraction = 0.5}),
               std::invalid_argument);
}

TEST(ImageFigure, PacksPixelsToWithinHalfAStep) {
  Image<float> pixels(20, 30);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels.pixels[i] = std::sin(static_cast<float>(i * i)) * 3 - 1;
  pixels(1, 2) = static_cast<float>(nan);
  pixels(7, 0) = std::numeric_limits<float>::infinity();
  const json panel = json_of(image_figure(some_text, {{"one", pixels}}, {}))["panels"][0];
  const std::vector<float> shown = unpacked(panel["values"]);
  ASSERT_EQ(shown.size(), pixels.size());
  const float half = panel["values"]["step"].get<float>() / 2;
  EXPECT_LT(half, 0.01f);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (std::isfinite(pixels.pixels[i]))
      EXPECT_NEAR(shown[i], pixels.pixels[i], 1.001f * half) << i;
    else
      EXPECT_TRUE(std::isnan(shown[i])) << i;
  }
}

TEST(ImageFigure, PacksConstantAndEmptyPictures) {
  for (const float value : {0.0f, 2.5f, -1e6f, static_cast<float>(nan)})
    for (const bool logarithmic : {false, true}) {
      const Image<float> pixels(4, 4, value);
      const json panel = json_of(
          image_figure(some_text, {{"", pixels}}, {.logarithmic = logarithmic}))["panels"][0];
      for (const float shown : unpacked(panel["values"])) {
        if (std::isnan(value))
          EXPECT_TRUE(std::isnan(shown));
        else
          EXPECT_NEAR(shown, value, 1e-4 * std::abs(value) + 1e-5);
      }
    }
}

TEST(ImageFigure, ReportsSubsampling) {
  const Image<float> pixels(50, 100, 1.0f);
  const Figure whole = image_figure(some_text, {{"", pixels}}, {}, {.max_side = 100});
  EXPECT_EQ(whole.text().caption, "");
  const Figure thinned = image_figure(some_text, {{"", pixels}}, {}, {.max_side = 40});
  EXPECT_NE(thinned.text().caption.find("every 3rd pixel of 100 x 50"), std::string::npos);
  EXPECT_EQ(json_of(thinned)["height"], 17);
  EXPECT_EQ(json_of(thinned)["width"], 34);
  EXPECT_EQ(unpacked(json_of(thinned)["panels"][0]["values"]).size(), 17u * 34u);
}

TEST(ImageFigure, SupportsPicturesBeforeProcessingOfTheSameSize) {
  const Image<float> before(2, 3, 1.0F), after(2, 3, 2.0F);
  const json figure = json_of(image_figure(some_text, {{"a", after, before}, {"b", after}}, {},
                                           {.before_name = "raw", .after_name = "better"}));
  EXPECT_NEAR(unpacked(figure["panels"][0]["before"])[0], 1.0, 1e-3);
  EXPECT_NEAR(unpacked(figure["panels"][0]["values"])[0], 2.0, 1e-3);
  EXPECT_FALSE(figure["panels"][1].contains("before"));
  EXPECT_EQ(figure["before_name"], "raw");
  EXPECT_THROW(image_figure(some_text, {{"a", after, Image<float>(3, 2, 1.0F)}}, {}),
               std::invalid_argument);
}

TEST(ImageFigure, HasTheReferenceOfItsDifferences) {
  const Image<float> picture(2, 3, 1.0F), truth(2, 3, 0.25F);
  const ImageReference reference{.name = "error", .values = truth, .period = 10, .factor = 1e3};
  const json figure =
      json_of(image_figure(some_text, {{"a", picture}}, {}, {.reference = reference}));
  EXPECT_NEAR(unpacked(figure["reference"]["values"])[5], 0.25, 1e-3);
  EXPECT_EQ(figure["reference"]["period"], 10);
  EXPECT_THROW(
      image_figure(some_text, {{"a", Image<float>(3, 2, 1.0F)}}, {}, {.reference = reference}),
      std::invalid_argument);
}

TEST(LineFigure, StoresEquidistantPositionsByEndsAndCount) {
  Series series{.name = "a", .period = 64.0};
  for (int i = 0; i < 64; ++i) {
    series.x.push_back(i);
    series.y.push_back(i % 2);
  }
  const json places = only_series(line_figure(some_text, {series}, {}, {}))["x"];
  EXPECT_EQ(places, json::parse(R"({"count": 65, "from": 0.0, "to": 64.0})"));
  series.x[7] += 0.1;
  EXPECT_EQ(only_series(line_figure(some_text, {series}, {}, {}))["x"].size(), 65u);
}

TEST(Curve3d, HasPointsWithValues) {
  Curve3d curve{"", Eigen::MatrixX3d(2, 3), Eigen::VectorXd(2)};
  curve.points << 1, 2, 3, 4, 5, 6;
  curve.values << 7, 8;
  const json panel = json_of(curve_3d_figure(some_text, {curve}, {}, {}))["panels"][0];
  EXPECT_EQ(panel["x"], json::parse("[1.0, 4.0]"));
  EXPECT_EQ(panel["values"], json::parse("[7.0, 8.0]"));
  curve.values.resize(3);
  EXPECT_THROW(curve_3d_figure(some_text, {curve}, {}, {}), std::invalid_argument);
}

TEST(PointCloud, KeepsExactlyTheStatedNumberOfFinitePoints) {
  Eigen::MatrixX3f points = Eigen::MatrixX3f::Random(1000, 3);
  const Eigen::VectorXf values = Eigen::VectorXf::LinSpaced(1000, 0, 1);
  points(3, 1) = static_cast<float>(nan);
  const auto cloud = [&](int most) {
    return point_cloud_figure(some_text, points, values, {}, {.max_points = most});
  };
  EXPECT_EQ(unpacked(json_of(cloud(100))["panels"][0]["x"]).size(), 100u);
  EXPECT_NE(cloud(100).text().caption.find("100 of 999 points"), std::string::npos);
  const json all = json_of(cloud(5000))["panels"][0];
  EXPECT_EQ(unpacked(all["values"]).size(), 999u);
  EXPECT_NEAR(unpacked(all["y"])[998], points(999, 1), 1e-3);
  EXPECT_EQ(cloud(9).json(), cloud(9).json());
}

TEST(PointCloud, RejectsValuesThatDoNotMatchThePoints) {
  const ColouredPoints one{"one", Eigen::MatrixX3f::Random(10, 3), Eigen::VectorXf::Zero(10)};
  EXPECT_EQ(json_of(point_cloud_figure(some_text, {one, one}, {}))["panels"].size(), 2u);
  EXPECT_THROW(point_cloud_figure(some_text, std::vector<ColouredPoints>(), {}),
               std::invalid_argument);
  ColouredPoints wrong = one;
  wrong.values.resize(9);
  EXPECT_THROW(point_cloud_figure(some_text, {one, wrong}, {}), std::invalid_argument);
}

std::pair<std::string, Dash> look(const LineStyle& style) { return {style.colour, style.dash}; }

TEST(ColourAssignment, DependsOnTheOrderOfFirstUseOnly) {
  ColourAssignment a, b;
  for (const char* name : {"one", "two", "one", "three"}) a.style(name);
  for (const char* name : {"one", "two", "three"}) b.style(name);
  for (const char* name : {"three", "two", "one"})
    EXPECT_EQ(look(a.style(name)), look(b.style(name)));
}

TEST(ColourAssignment, DistinguishesTwentyEightNames) {
  ColourAssignment colours;
  std::set<std::pair<std::string, Dash>> looks;
  for (int i = 0; i < 28; ++i) looks.insert(look(colours.style(std::to_string(i))));
  EXPECT_EQ(looks.size(), 28u);
}

}  // namespace

}  // namespace tofsmith
