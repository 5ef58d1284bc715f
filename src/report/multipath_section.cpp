// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "report/design_sections.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

using Row = std::vector<std::string>;
using Cells = std::vector<MultipathCell> MultipathMaps::*;

Row row(const MultipathErrorReport& code, const MultipathMaps& maps, const std::string& light,
        const MultipathCell& cell) {
  const bool decoded = std::isfinite(cell.error_m.value);
  return {code.code,
          fmt::format("{:.3g}", maps.signal_e_per_s),
          light,
          mm_text(cell.law_m),
          mm_text(cell.single_bias_m.value),
          mm_text(cell.single_error_m.value),
          mm_text(cell.bias_m.value),
          mm_text(cell.error_m.value),
          decoded ? fmt::format("{:.2f}", cell.gain()) : "",
          mm_text(cell.cramer_rao_mae_m),
          decoded ? fmt::format("{:.1f}", 100 * cell.two_share) : "",
          decoded ? fmt::format("{:.1f}", 100 * cell.unresolved_share) : ""};
}

std::string light_of(const MultipathCell& cell, const char* kind) {
  return fmt::format("{} r = {:.3g}, {:.3g} m", kind, cell.ratio, cell.delay_m);
}

/// Values in order of their first use.
std::vector<double> distinct(const std::vector<MultipathCell>& cells,
                             double MultipathCell::*member) {
  std::vector<double> values;
  for (const MultipathCell& cell : cells)
    if (std::ranges::find(values, cell.*member) == values.end()) values.push_back(cell.*member);
  return values;
}

void add_maps(FigureText text, const std::vector<MultipathErrorReport>& codes, Cells cells,
              const ColourScale& colours, const std::function<double(const MultipathCell&)>& value,
              Section& section) {
  std::vector<HeatMap> maps;
  CategoryAxis x{.label = cells == &MultipathMaps::points ? "delay" : "mean delay", .unit = "m"};
  CategoryAxis y{.label = "ratio"};
  for (const MultipathErrorReport& code : codes)
    for (const MultipathMaps& at : code.maps) {
      const std::vector<double> delays = distinct(at.*cells, &MultipathCell::delay_m);
      const std::vector<double> ratios = distinct(at.*cells, &MultipathCell::ratio);
      HeatMap map{.title = fmt::format("{}, S = {:.3g} e/s", code.code, at.signal_e_per_s)};
      map.values.resize(std::ssize(ratios), std::ssize(delays));
      bool has_value = false;
      for (Eigen::Index r = 0; r < map.values.rows(); ++r)
        for (Eigen::Index d = 0; d < map.values.cols(); ++d) {
          map.values(r, d) =
              value((at.*cells)[static_cast<std::size_t>(r * map.values.cols() + d)]);
          has_value = has_value || std::isfinite(map.values(r, d));
        }
      if (has_value) maps.push_back(std::move(map));
      if (!x.ticks.empty()) continue;
      for (const double d : delays) x.ticks.push_back(fmt::format("{:.3g}", d));
      for (const double r : ratios) y.ticks.push_back(fmt::format("{:.3g}", r));
    }
  if (!maps.empty())
    section.blocks.emplace_back(heat_map_figure(std::move(text), maps, x, y, colours));
}

void add_all_maps(const std::vector<MultipathErrorReport>& codes, Cells cells,
                  const std::string& id, const std::string& light, Section& section) {
  const ColourScale error{.label = "error", .unit = "mm", .logarithmic = true};
  const ColourScale bias{.label = "bias", .unit = "mm", .map = ColourMap::diverging};
  const auto add = [&](const std::string& what, const std::string& caption,
                       const ColourScale& colours, const auto& value) {
    add_maps({.id = "multipath-" + id + "-" + what,
              .title = caption + ", " + light,
              .caption = "Mean over depth."},
             codes, cells, colours, value, section);
  };
  add("single-bias", "Bias of single-path decoding", bias,
      [](const MultipathCell& cell) { return 1e3 * cell.single_bias_m.value; });
  add("bias", "Bias of two-return decoding", bias,
      [](const MultipathCell& cell) { return 1e3 * cell.bias_m.value; });
  add("single-error", "Error of single-path decoding", error,
      [](const MultipathCell& cell) { return 1e3 * cell.single_error_m.value; });
  add("error", "Error of two-return decoding", error,
      [](const MultipathCell& cell) { return 1e3 * cell.error_m.value; });
  add("bound", "Cramer-Rao bound of the direct depth", error,
      [](const MultipathCell& cell) { return 1e3 * cell.cramer_rao_mae_m; });
}

Row row_of(const DelayClass& its, const std::string& delay) {
  const double gain = std::abs(its.bias_m[0]) / std::abs(its.bias_m[1]);
  return {delay,
          std::to_string(its.pixels),
          fmt::format("{:.3f}", its.ratio),
          mm_text(its.bias_m[0]),
          mm_text(its.bias_m[1]),
          std::isfinite(gain) ? fmt::format("{:.1f}", gain) : "",
          mm_text(its.error_m[0]),
          mm_text(its.error_m[1]),
          fmt::format("{:.1f}", 100 * its.two_share),
          fmt::format("{:.1f}", 100 * its.unresolved_share)};
}

Figure depth_figure(const MultipathScene& scene, const Image<float>& truth_m,
                    const Camera& camera) {
  std::vector<ValueImage> images{{.title = "true depth", .pixels = truth_m}};
  for (std::size_t i = 0; i < scene.decodings.size(); ++i)
    images.push_back({.title = fmt::format("{}: mean {} mm", scene.decodings[i].method,
                                           mm_text(scene.all.bias_m[i])),
                      .pixels = scene.decodings[i].depth_m});
  return image_figure(
      {.id = "multipath-scene-depth",
       .title = "Depth",
       .caption = "Titles contain the mean error of pixels with multipath light.",
       .alt_text = "Maps of decoded depth and its error"},
      images, {.label = "depth", .unit = "m", .range = depth_range(scene.truth, camera)},
      {.reference = error_reference(scene.truth, camera, 2e3 * scene.all.error_m[0])});
}

Figure later_light_figure(const MultipathScene& scene) {
  return image_figure({.id = "multipath-scene-ratio",
                       .title = "Multipath light",
                       .caption = "Ratio of the multipath light of a pixel to its direct light.",
                       .alt_text = "Map of the share of multipath light"},
                      {{.pixels = scene.multipath_ratio}},
                      {.label = "ratio", .map = ColourMap::cividis});
}

Figure returns_figure(const MultipathScene& scene) {
  Image<float> codes(scene.returns.height, scene.returns.width);
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes.pixels[i] = static_cast<float>(scene.returns.pixels[i]);
  return image_figure({.id = "multipath-scene-returns",
                       .title = "Returns found by two-return decoding",
                       .caption = "0 none, 1 single, 2 two returns, 3 unresolved: neither one nor "
                                  "two returns explain the measurements.",
                       .alt_text = "Map of the number of returns"},
                      {{.pixels = std::move(codes)}},
                      {.label = "returns", .range = ValueRange{0.0, 3.0}});
}

Figure plan_figure(const MultipathScene& scene, const Image<float>& truth_m) {
  const int row = scene.view.height / 2;
  ColourAssignment colours;
  const auto series = [&](const std::string& name, const Image<float>& depth_m, Mark mark) {
    Series line{.name = name, .mark = mark};
    for (int column = 0; column < depth_m.width; ++column) {
      const Eigen::Vector3d at =
          scene.view.ray(row, column) * static_cast<double>(depth_m(row, column));
      line.x.push_back(at.x());
      line.y.push_back(at.z());
    }
    return line;
  };
  std::vector<Series> lines{series("truth", truth_m, Mark::line)};
  lines.back().style = reference_style();
  for (const MultipathSceneDecoding& d : scene.decodings) {
    lines.push_back(series(d.method, d.depth_m, Mark::markers));
    lines.back().style = colours.style(d.method);
  }
  return line_figure({.id = "multipath-scene-plan",
                      .title = "The middle row, seen from above",
                      .caption = "Straight walls should look straight."},
                     lines, {.label = "x", .unit = "m"}, {.label = "z", .unit = "m"});
}

Figure cloud_figure(const MultipathScene& scene, const ValueRange& range) {
  std::vector<ColouredPoints> clouds;
  for (const MultipathSceneDecoding& d : scene.decodings)
    clouds.push_back(cloud_of(scene.view, d.method, d.depth_m));
  return point_cloud_figure({.id = "multipath-scene-clouds",
                             .title = "Point clouds",
                             .caption = "Drag to rotate; walls should look straight from above.",
                             .alt_text = "Point clouds of the decoded scene"},
                            clouds, {.label = "depth", .unit = "m", .range = range},
                            {.max_points = 20000});
}

}  // namespace

std::vector<Row> multipath_rows(const std::vector<MultipathErrorReport>& codes) {
  std::vector<Row> rows{{"code", "signal (e/s)", "light", "r d/(1+r) (mm)", "bias 1 (mm)",
                         "error 1 (mm)", "bias 2 (mm)", "error 2 (mm)", "gain", "Cramer-Rao (mm)",
                         "two (%)", "unresolved (%)"}};
  for (const MultipathErrorReport& code : codes)
    for (const MultipathMaps& maps : code.maps) {
      rows.push_back(row(code, maps, "one return", maps.single));
      for (const MultipathCell& cell : maps.points)
        rows.push_back(row(code, maps, light_of(cell, "return"), cell));
      rows.push_back(row(code, maps, "one return, tail decoding", maps.single_by_tail));
      for (const MultipathCell& cell : maps.tails)
        rows.push_back(row(code, maps, light_of(cell, "tail"), cell));
    }
  return rows;
}

Section multipath_section(const std::vector<MultipathErrorReport>& codes) {
  Section section{"Multipath", {}};
  for (const MultipathErrorReport& code : codes)
    if (!code.why_no_two_returns.empty())
      section.blocks.emplace_back(
          Paragraph{code.code + " supports only single-path decoding: " + code.why_no_two_returns});
  add_all_maps(codes, &MultipathMaps::points, "point", "a second return", section);
  add_all_maps(codes, &MultipathMaps::tails, "tail", "an exponential tail", section);
  section.blocks.emplace_back(table_of_rows(
      "multipath",
      "1: single-path decoding, 2: two-return (or tail) decoding; gain: error 1 / error 2.",
      multipath_rows(codes), {0, 2}));
  return section;
}

std::vector<Row> multipath_scene_rows(const MultipathScene& scene) {
  std::vector<Row> rows{{"mean delay (m)", "pixels", "ratio", "bias 1 (mm)", "bias 2 (mm)",
                         "gain in bias", "error 1 (mm)", "error 2 (mm)", "two (%)",
                         "unresolved (%)"}};
  for (const DelayClass& its : scene.classes)
    rows.push_back(row_of(its, its.to_m > 1e6
                                   ? fmt::format("{:.3g} and more", its.from_m)
                                   : fmt::format("{:.3g} to {:.3g}", its.from_m, its.to_m)));
  if (scene.all.pixels > 0) rows.push_back(row_of(scene.all, "all"));
  return rows;
}

Section multipath_scene_section(const MultipathScene& scene, const Camera& camera) {
  const Image<float> truth_m = wrapped_depth_m(scene.truth, camera);
  Section section{.title = "Scene with indirect light: " + scene.name};
  section.blocks.push_back(Paragraph{
      fmt::format("Light reaches each surface directly and after reflection at one other surface. "
                  "The scene is captured with {}, a signal of {} e/s from a surface of albedo 1 at "
                  "{:.2f} m, and ambient light of {} e/s.",
                  scene.code, level_text(scene.light.signal_e_per_s),
                  scene.light.reference_distance_m, level_text(scene.light.ambient_e_per_s))});
  section.blocks.push_back(depth_figure(scene, truth_m, camera));
  section.blocks.push_back(plan_figure(scene, truth_m));
  section.blocks.push_back(later_light_figure(scene));
  section.blocks.push_back(returns_figure(scene));
  section.blocks.push_back(cloud_figure(scene, depth_range(scene.truth, camera)));
  section.blocks.push_back(
      table_of_rows("multipath-scene",
                    "Errors by the mean delay of multipath light; 1: single-path decoding, 2: "
                    "two-return decoding; gain: bias 1 / bias 2.",
                    multipath_scene_rows(scene), {0}));
  return section;
}

}  // namespace tofsmith
