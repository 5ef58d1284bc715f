// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/shared/text_numbers.hpp"
#include "design_setup.hpp"
#include "report/design_sections.hpp"
#include "tofsmith/report/code_figures.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string odd_name = "a/b \xc3\xbc<script>[[x]]`";

std::vector<const Figure*> figures_of(const Page& page) {
  std::vector<const Figure*> figures;
  for (const Section& section : page.sections)
    for (const Block& block : section.blocks)
      if (const auto* figure = std::get_if<Figure>(&block)) figures.push_back(figure);
  return figures;
}

/// Expects that the page renders, figure ids are unique, and names are escaped.
void expect_sound(const Page& page, std::size_t min_figures) {
  std::set<std::string> ids;
  for (const Figure* figure : figures_of(page)) {
    EXPECT_TRUE(ids.insert(figure->text().id).second) << figure->text().id;
    EXPECT_TRUE(nlohmann::json::accept(figure->json())) << figure->text().id;
  }
  EXPECT_GE(ids.size(), min_figures);
  EXPECT_THAT(render(page), Not(HasSubstr("\xc3\xbc<script>")));
}

SceneResult small_scene(const Camera& camera, const std::vector<CodeSet>& codes) {
  SceneResult scene{.name = odd_name, .truth = SceneImage(4, 5)};
  for (std::size_t i = 0; i < scene.truth.depth_m.size(); ++i)
    scene.truth.depth_m.pixels[i] = 1.0f + 0.1f * static_cast<float>(i);
  scene.truth.depth_m.pixels[3] = std::numeric_limits<float>::quiet_NaN();
  scene.view = PinholeView::centred(5, 4, 1.0);
  capture_and_decode(scene, codes, camera, std::vector<NamedLight>{{odd_name, {1e5, 1e4}}}, 1,
                     FilterOptions{});
  return scene;
}

DesignResult design_with_odd_names(const Camera& camera) {
  DesignResult result = design(camera, small_options());
  for (Candidate& c : result.candidates)
    if (c.method != "factorize") {
      c.code = c.code.renamed(odd_name + c.code.name());
      c.error.code = c.code.name();
    }
  return result;
}

TEST(DesignReport, ShowsADesignWithItsSceneForAnyNames) {
  const Camera camera = coarse_camera("paper-5f0");
  DesignResult result = design_with_odd_names(camera);
  result.explanation.push_back("First remark.");
  result.explanation.push_back("Second remark.");
  std::vector<CodeSet> codes;
  for (const Candidate& c : result.candidates) codes.push_back(c.code);
  const Page page = design_report(camera, result, small_scene(camera, codes), "tofsmith <design>");
  expect_sound(page, 10);
  const std::string text = page_document(page);
  for (const Candidate& c : result.candidates) EXPECT_THAT(text, HasSubstr(c.method));
  for (const char* words : {"tofsmith <design>", "A scene: a/b", ", filtered",
                            "Averaged measurements", "First remark.", "Second remark."})
    EXPECT_THAT(text, HasSubstr(words));
}

TEST(DesignReport, ShowsTheBestCodeFirstAndFoldsOtherSections) {
  const Camera camera = coarse_camera("paper-5f0");
  const DesignResult result = design(camera, small_options());
  const Page page = design_report(camera, result, std::nullopt, "", {"camera.toml", "raw.npy"});
  const Section& front = page.sections.front();
  EXPECT_EQ(front.layout, SectionLayout::front);
  const auto& numbers = std::get<KeyNumbers>(front.blocks.at(0));
  EXPECT_EQ(numbers.entries.at(0).value, result.winner().code.name());
  const auto& table = std::get<Table>(front.blocks.at(1));
  EXPECT_EQ(table.highlighted_row, 0);
  EXPECT_EQ(table.rows.at(0).at(0), result.winner().code.name());
  EXPECT_EQ(table.rows.at(0).back(), "1.00");
  const auto number = [](std::string_view text) { return take_number(text).value(); };
  const double best_mm = number(table.rows.at(0).at(2));
  for (const std::vector<std::string>& row : table.rows)  // errors are rounded to 0.1 mm
    EXPECT_NEAR(number(row.at(3)), number(row.at(2)) / best_mm, 0.006 + 0.2 / best_mm);
  const std::string text = page_document(page);
  EXPECT_THAT(text, HasSubstr("tofsmith decode --camera camera.toml"));
  EXPECT_THAT(text, Not(HasSubstr("points.ply")));
  for (std::size_t i = 1; i < page.sections.size(); ++i)
    EXPECT_EQ(page.sections[i].layout, SectionLayout::folded) << page.sections[i].title;
}

TEST(DesignReport, ShowsEachCurveOnceAndOmitsShortOnes) {
  const Camera camera = coarse_camera("paper-5f0");
  DesignResult result = design(camera, small_options());
  for (std::size_t i = 0; i < result.candidates.size(); ++i)
    if (result.candidates[i].is_designed()) result.best = i;
  ASSERT_TRUE(result.winner().is_designed());
  const std::string best = figure_id("waveforms", result.winner().code.name());
  const Page page = design_report(camera, result, std::nullopt, "");
  int error_curves = 0;
  for (const Figure* figure : figures_of(page)) {
    const std::string& id = figure->text().id;
    EXPECT_NE(id, best);
    const auto json = nlohmann::json::parse(figure->json());
    if (figure->kind() == "lines" &&
        json["columns"][0]["y"]["label"].get<std::string>().ends_with("depth error") &&
        json["columns"][0]["x"]["label"] == "signal") {
      ++error_curves;
      const auto& series = json["rows"][0]["panels"][0];
      for (std::size_t i = 1; i < series.size() && series[i]["mark"] != "line"; ++i)
        EXPECT_NE(series[i]["dash"], series[i - 1]["dash"]) << "both are visible if they coincide";
    }
    if (!id.starts_with("convergence-")) continue;
    std::size_t longest = 0;
    for (const auto& series : json["rows"][0]["panels"][0])
      longest = std::max(longest, series["y"].size());
    EXPECT_GE(longest, 4u) << id;
  }
  EXPECT_EQ(error_curves, 1);
}

TEST(DesignReport, ShowsCamerasOfManyKinds) {
  Camera two_bucket = coarse_camera("paper-10f0", DepthErrorKind::circular);
  two_bucket.sensor.taps = 2;
  Camera one_point = coarse_camera("paper-30x");
  one_point.operating.signal_e_per_s = {1e4};
  Camera analog = coarse_camera("paper-5f0");
  analog.light.binary = analog.sensor.binary = false;
  for (const Camera& camera : {two_bucket, one_point, analog})
    expect_sound(design_report(camera, design(camera, small_options()), std::nullopt, ""), 4);
}

TEST(DesignReport, ShowsMultipathErrorsEvenIfNoCodeSeparatesTwoReturns) {
  Camera camera = coarse_camera("paper-5f0", DepthErrorKind::circular);
  camera.operating.multipath = OperatingMultipath{{0.25, 0.5}, {1.0, 2.0}};
  const Page page = design_report(camera, design(camera, small_options()), std::nullopt, "");
  expect_sound(page, 4);
  const std::string html = page_document(page);
  for (const char* words : {"Second returns", "ratio 0.25 to 0.5", "two-return (mm)", "unsupported",
                            "How does it perform with multipath?", "too few independent means"})
    EXPECT_THAT(html, HasSubstr(words));
}

TEST(DesignReport, SupportsInfiniteBounds) {
  const Camera camera = coarse_camera("paper-5f0");
  DesignResult result = design(camera, small_options());
  for (Candidate& c : result.candidates)
    for (PointDepthError& p : c.error.points)
      p.cramer_rao_mae_m = p.receiver_bound_mae_m = p.direct_tof_bound_mae_m =
          std::numeric_limits<double>::infinity();
  expect_sound(design_report(camera, result, std::nullopt, ""), 4);
}

TEST(DesignReport, ShiftsTheTargetOfARotatedCode) {
  // The difference between the drawn correlation function and target must equal the reported
  // residual.
  const Camera camera = coarse_camera("paper-30x");
  DesignResult result = design(camera, small_options());
  for (Candidate& c : result.candidates) {
    if (c.method != "factorize") continue;
    c.code = c.code.rotated(7);
    c.rotation_bin = (c.rotation_bin + 7) % camera.samples;
    ASSERT_LT(c.per_measurement[0].residual_rms, 1e-6);
  }
  const Page page = design_report(camera, result, std::nullopt, "");
  for (const Figure* figure : figures_of(page)) {
    if (figure->text().id != figure_id("waveforms", "hamiltonian-k3-factorized")) continue;
    std::vector<double> drawn, target;
    const auto json = nlohmann::json::parse(figure->json());
    for (const auto& series : json["rows"][0]["panels"][2]) {
      if (series["name"] == "correlation function") drawn = series["y"].get<std::vector<double>>();
      if (series["name"] == "target") target = series["y"].get<std::vector<double>>();
    }
    ASSERT_FALSE(target.empty());
    const std::size_t step = (drawn.size() - 1) / (target.size() - 1);
    for (std::size_t n = 0; n < target.size(); ++n)
      EXPECT_NEAR(target[n], drawn[n * step], 1e-4) << n;
    return;
  }
  FAIL() << "no waveforms of the designed code";
}

TEST(EvaluationReport, ShowsCodesOfEqualNames) {
  const Camera camera = coarse_camera("paper-5f0");
  const CodeSet code = build_family("sinusoid-k4", camera).renamed(odd_name);
  const DepthErrorReport error = evaluate(code, camera, {.trials = 1000});
  const std::vector<EvaluatedCode> evaluated(2, {error, 0, {}, {}});
  expect_sound(evaluation_report(camera, {code, code}, evaluated, "x"), 4);
}

TEST(EvaluationReport, DrawsTheDistributionOfDepthsUnlessUniform) {
  Camera camera = coarse_camera("paper-5f0");
  const CodeSet code = build_family("sinusoid-k4", camera);
  const auto html_of = [&] {
    const std::vector<EvaluatedCode> evaluated{
        {evaluate(code, camera, {.trials = 1000}), 0, {}, {}}};
    const Page page = evaluation_report(camera, {code}, evaluated, "x");
    expect_sound(page, 3);
    return page_document(page);
  };
  std::string html = html_of();
  EXPECT_THAT(html, Not(HasSubstr("\"true-depths\"")));
  EXPECT_THAT(html, HasSubstr("true depths anywhere in the range;"));
  camera.operating.working_distance_m = {1.0, 3.0};
  camera.operating.depths = {2.0, 1.0};
  html = html_of();
  EXPECT_THAT(html, HasSubstr("\"true-depths\""));
  EXPECT_THAT(html, HasSubstr("true depths from 1 to 3 m, distributed by 2 weights;"));
}

TEST(SceneSection, WithoutCapturesShowsTheScene) {
  const Camera camera = coarse_camera("paper-5f0");
  SceneResult scene = small_scene(camera, {});
  for (const bool captured : {true, false}) {
    if (!captured) scene.captures.clear();
    const Section section = scene_section(scene, camera, "none");
    expect_sound({.title = "x", .sections = {section}}, 2);
  }
}

TEST(FigureId, DiffersForDifferentNames) {
  const std::set<std::string> ids{figure_id("p", "a/b"), figure_id("p", "a b"),
                                  figure_id("p", "a-b"), figure_id("p", "")};
  EXPECT_EQ(ids.size(), 4u);
  EXPECT_EQ(figure_id("waveforms", "hamiltonian-k4"), "waveforms-hamiltonian-k4");
}

}  // namespace
}  // namespace tofsmith
