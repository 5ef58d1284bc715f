// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "sample_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/report/figure.hpp"

namespace tofsmith {
namespace {

constexpr double period_ns = 66.7;
constexpr double range_m = 9.99;
const std::vector<std::string> codes = {
    "sinusoid-k4",  "square-k4",   "multifrequency-k5",        "hamiltonian-k4",
    "factorize-k4", "optimize-k4", "pulsed-multifrequency-k5", "gray-k4"};

/// Samples f at 240 points of [0, span).
template <typename Function>
Series sampled(const std::string& name, LineStyle style, double span, Function f) {
  Series series{.name = name, .period = span, .style = style};
  for (int i = 0; i < 240; ++i) {
    series.x.push_back(i / 240.0 * span);
    series.y.push_back(f(i / 240.0));
  }
  return series;
}

Figure waveforms(ColourAssignment& colours) {
  const Axis time_axis{.label = "Time", .unit = "ns"};
  const std::vector<PanelColumn> columns = {
      {"Modulation", time_axis, {.label = "Light", .unit = "P/P_ave", .from_zero = true}},
      {"Demodulation", time_axis, {.label = "Gain"}},
      {"Correlation",
       {.label = "Depth", .unit = "m"},
       {.label = "Electrons", .unit = "normalized"}}};
  const LineStyle style = colours.style("hamiltonian-k4");
  std::vector<PanelRow> rows;
  for (int k = 0; k < 4; ++k) {
    const auto wave = [k](double phase) {
      return 0.5 + 0.5 * std::cos(2 * std::numbers::pi * (phase + 0.25 * k));
    };
    const auto gate = [&](double phase) { return wave(phase) > 0.5 ? 1.0 : 0.0; };
    Series light = sampled("commanded", reference_style(), period_ns,
                           [&](double phase) { return 15 * gate(phase); });
    Series gain = sampled("commanded", reference_style(), period_ns, gate);
    light.mark = gain.mark = Mark::steps;
    rows.push_back({fmt::format("k = {}", k + 1),
                    {{light, sampled("band-limited", style, period_ns,
                                     [&](double phase) { return 13 * wave(phase); })},
                     {gain, sampled("band-limited", style, period_ns, wave)},
                     {sampled("target", reference_style(), range_m, gate),
                      sampled("band-limited", style, range_m, wave)}}});
  }
  return small_multiples(
      {"waveforms", "Waveforms in and out of the band limit",
       "Nominal input of light source and sensor (grey), and their output at 150 MHz.",
       "Four rows of modulation, demodulation and correlation functions"},
      columns, rows);
}

Figure error_by_signal(ColourAssignment& colours) {
  std::vector<Series> series;
  for (std::size_t c = 0; c < codes.size(); ++c) {
    Series one{.name = codes[c], .mark = Mark::line_and_markers, .style = colours.style(codes[c])};
    for (int i = 0; i <= 4; ++i) {
      one.x.push_back(std::pow(10, 3 + 0.5 * i));
      one.y.push_back(0.6 * std::exp(-0.8 * i - 0.25 * static_cast<double>(c)));
      one.y_error.push_back(0.06 * one.y.back());
    }
    series.push_back(one);
  }
  Series bound{.name = "Cramér-Rao bound", .x = series[0].x, .style = reference_style()};
  for (const double s : bound.x) bound.y.push_back(20 / s);
  series.push_back(bound);
  return line_figure({"error-by-signal", "Depth error by signal",
                      "Mean absolute depth error, ambient 10⁴ electrons per second; bars are four "
                      "standard errors.",
                      ""},
                     series, {.label = "Signal", .unit = "electrons/s", .logarithmic = true},
                     {.label = "Mean depth error", .unit = "m", .logarithmic = true});
}

Figure convergence(ColourAssignment& colours) {
  Series one{.name = codes[5], .style = colours.style(codes[5])};
  for (int i = 0; i < 200; ++i) {
    one.x.push_back(i);
    one.y.push_back(i == 120 ? std::numeric_limits<double>::quiet_NaN() : std::exp(-0.03 * i));
  }
  return line_figure({"convergence", "Convergence",
                      "Objective by iteration; the gap is an iterate without a value.", ""},
                     {one}, {.label = "Iteration"},
                     {.label = "Objective", .unit = "m", .logarithmic = true});
}

Figure coding_curves() {
  std::vector<Curve3d> curves;
  for (const std::size_t c : {0u, 3u}) {
    Curve3d curve{codes[c], Eigen::MatrixX3d(240, 3), Eigen::VectorXd(240)};
    const double amplitude = c == 0 ? 0.3 : 0.5;
    for (int i = 0; i < 240; ++i) {
      for (int k = 0; k < 3; ++k)
        curve.points(i, k) =
            0.5 + amplitude * std::cos(2 * std::numbers::pi * (i / 240.0 - k / 3.0));
      curve.values[i] = i / 240.0 * range_m;
    }
    curves.push_back(curve);
  }
  return curve_3d_figure(
      {"coding-curve", "Coding curves",
       "Measured brightness of depth 0 to 10 m; a longer curve tells depths apart better.", ""},
      curves, {Axis{.label = "I1"}, Axis{.label = "I2"}, Axis{.label = "I3"}},
      {.label = "Depth", .unit = "m"});
}

Figure operating_points() {
  std::vector<HeatMap> maps;
  for (std::size_t c = 0; c < 5; ++c) {
    HeatMap map{codes[c], Eigen::MatrixXd(5, 5)};
    for (int a = 0; a < 5; ++a)
      for (int s = 0; s < 5; ++s)
        map.values(a, s) = 2.2 * std::exp(-0.9 * s + 0.35 * a - 0.2 * static_cast<double>(c));
    maps.push_back(map);
  }
  maps.back().values(4, 0) = std::numeric_limits<double>::quiet_NaN();
  return heat_map_figure(
      {"operating-points", "Depth error by operating point",
       "Mean absolute depth error of all candidates; one colour scale.", ""},
      maps, {"Signal", "electrons/s", {"10³", "3·10³", "10⁴", "3·10⁴", "10⁵"}},
      {"Ambient", "electrons/s", {"10²", "10³", "10⁴", "3·10⁴", "10⁵"}},
      {.label = "Mean depth error", .unit = "m", .map = ColourMap::cividis, .logarithmic = true});
}

/// A tilted plane with a disc in front of it, and a part without return.
Image<float> true_depth() {
  Image<float> depth(480, 640);
  for (int r = 0; r < 480; ++r)
    for (int c = 0; c < 640; ++c)
      depth(r, c) =
          std::hypot(r - 200.0, c - 400.0) < 100.0 ? 1.5f : 3.0f - 0.003f * static_cast<float>(r);
  for (int r = 30; r < 90; ++r)
    for (int c = 500; c < 600; ++c) depth(r, c) = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

Image<float> noisy(const Image<float>& depth, double sigma, std::uint64_t seed) {
  Image<float> result = depth;
  for (std::size_t i = 0; i < result.size(); ++i)
    result.pixels[i] += static_cast<float>(sigma * RandomStream(seed, i).normal());
  return result;
}

std::vector<Block> depth_blocks() {
  const Image<float> depth = true_depth();
  const Image<float> good = noisy(depth, 0.01, 1), poor = noisy(depth, 0.06, 2);
  const auto error = [&](Image<float> decoded) {
    for (std::size_t i = 0; i < decoded.size(); ++i) decoded.pixels[i] -= depth.pixels[i];
    return decoded;
  };
  Eigen::MatrixX3f points(depth.size(), 3);
  Eigen::VectorXf values(depth.size());
  for (int r = 0; r < 480; ++r)
    for (int c = 0; c < 640; ++c) {
      const float z = good(r, c);
      const Eigen::Index i = r * 640 + c;
      points.row(i) << z * static_cast<float>(c - 320) / 525.f,
          z * static_cast<float>(r - 240) / 525.f, z;
      values[i] = z;
    }
  return {image_figure({"depth", "True and decoded depth",
                        "A disc in front of a plane; white pixels have no return.", ""},
                       {{"true", depth}, {codes[5], good}, {codes[0], poor}},
                       {.label = "Depth", .unit = "m"}),
          image_figure(
              {"depth-error", "Signed depth error", "Decoded less true depth.", ""},
              {{codes[5], error(good)},
               {codes[0], error(poor)},
               {codes[1], error(poor)},
               {codes[2], error(good)}},
              {.label = "Error", .unit = "m", .map = ColourMap::diverging, .clip_fraction = 0.02},
              {.columns = 2}),
          image_figure({"compared", "Before and after", "Move the slider.", ""},
                       {{"medium light", good, poor}, {"high light", depth, good}},
                       {.label = "Depth", .unit = "m"},
                       {.before_name = "poor",
                        .reference = ImageReference{.name = "error",
                                                    .values = depth,
                                                    .factor = 1e3,
                                                    .colours = {.label = "decoded minus true",
                                                                .unit = "mm",
                                                                .map = ColourMap::diverging}}}),
          point_cloud_figure({"point-cloud", "Point cloud", "Drag to turn.", ""}, points, values,
                             {.label = "Depth", .unit = "m"})};
}

Table candidates() {
  Table table{"candidates",
              "Candidates",
              "Depth error of all candidates, geometric mean over the operating points.",
              {{"Code"},
               {"K", true},
               {"Mean error (mm)", true},
               {"± (mm)", true},
               {"Share of `sinusoid-k4`", true}},
              {},
              5};
  for (std::size_t c = 0; c < codes.size(); ++c)
    table.rows.push_back({codes[c], "4",
                          fmt::format("{:.1f}", 131.0 - 14.2 * static_cast<double>(c)), "0.4",
                          fmt::format("{:.2f}", 1 - 0.1 * static_cast<double>(c))});
  return table;
}

/// Higher than the limit of other tables on a phone.
Table explanation() {
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "More exposures distinguish more depths but share the light. ";
  return {.columns = {{"question"}, {"answer"}}, .rows = {{"Why this number of exposures?", text}}};
}

}  // namespace

Page sample_page() {
  ColourAssignment colours;
  const auto waves = waveforms(colours);
  return {
      .title = "Codes for paper-10f0",
      .subtitle =
          "Designed, judged and decoded by tofsmith for a 15 MHz camera whose light source and "
          "sensor are band-limited to 150 MHz",
      .sections =
          {{"Result",
            {Paragraph{
                 "The code `optimize-k4` measures depth best on this camera. Text stays text: "
                 "<b>, </script>, a & b, [brackets], `a < b`."},
             KeyNumbers{{{"best code", "optimize-k4"},
                         {"mean depth error", "60 ± 0.4 mm"},
                         {"of sinusoid-k4's", "46 %"},
                         {"of the Cramér-Rao bound", "1.31 ×"}}},
             candidates(), explanation()}},
           {"Camera",
            {KeyValueList{{{"Fundamental frequency", "15 MHz"},
                           {"Unambiguous range", "9.99 m"},
                           {"Light source", "binary, Hann 150 MHz"},
                           {"Sensor", "1 tap, binary, Hann 150 MHz"}}},
             CodeBlock{
                 "tofsmith design paper-10f0 --method best --exposures 4 --seed 1 -o out/</pre>"}}},
           {"Codes", {waves, coding_curves(), convergence(colours)}},
           {"Depth error", {error_by_signal(colours), operating_points()}},
           {"Scene", depth_blocks()},
           {"Files",
            {KeyValueList{{{"a & b", "javascript:alert(1)/\"x\".html"}}}},
            SectionLayout::folded}},
      .footer = "tofsmith 0.1.0, seed 1"};
}

}  // namespace tofsmith
