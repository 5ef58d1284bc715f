// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "report/design_sections.hpp"
#include "report/shared/table_of_rows.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {
namespace {

std::string ratio(const Estimate& error, const Estimate& other) {
  return fmt::format("{:.4f}", error.value / other.value);
}

/// Errors with single and with second returns, by increasing weighted error.
Section operating_multipath_section(const OperatingMultipath& returns, const DesignResult& result,
                                    DepthErrorKind kind) {
  using Weighed = std::pair<double, const Candidate*>;
  std::vector<Weighed> codes;
  for (const Candidate& c : result.candidates)
    if (c.multipath)
      codes.emplace_back(returns.weighed(c.error.of(kind).geometric_mean_m.value,
                                         c.multipath->single_path.of(kind).value),
                         &c);
  std::ranges::stable_sort(codes, {}, &Weighed::first);
  Table table{
      .id = "operating-multipath",
      .caption = fmt::format(
          "Geometric means over the operating points. E1: {} error of single returns. E2: error "
          "with a second return of ratio {} to {} at a delay of {} to {} m and single-path "
          "decoding. Two-return: circular error with the same second return and two-return "
          "decoding. Codes are ranked by E1^{:.3g} E2^{:.3g}; two-return errors much larger than "
          "the errors of standard codes are penalized.",
          name_of(kind), returns.ratio[0], returns.ratio[1], returns.delay_m[0], returns.delay_m[1],
          1.0 - returns.weight, returns.weight),
      .columns = {{"code"},
                  {"E1 (mm)", true},
                  {"E2 (mm)", true},
                  {"ranked by (mm)", true},
                  {"two-return (mm)", true}}};
  for (const auto& [weighed_m, c] : codes) {
    if (c == &result.winner()) table.highlighted_row = static_cast<int>(table.rows.size());
    const auto& two_return = c->multipath->two_return;
    table.rows.push_back({c->code.name(), estimate_mm_text(c->error.of(kind).geometric_mean_m),
                          estimate_mm_text(c->multipath->single_path.of(kind)),
                          fmt::format("{:.1f}", 1e3 * weighed_m),
                          two_return ? estimate_mm_text(two_return->circular_m) : "unsupported"});
  }
  return {"Second returns", {std::move(table)}};
}

Table residual_table(const DesignResult& result) {
  Table table{
      .id = "residuals",
      .caption =
          "One row per measurement of the designed codes. Residual: distance of the selected "
          "pair of waveforms from the target. Smallest: smallest distance of all pairs found. This "
          "distance can be smaller than the residual, because pairs are selected by depth error.",
      .columns = {{"code"},
                  {"measurement", true},
                  {"residual", true},
                  {"smallest", true},
                  {"modulation duty", true},
                  {"peak", true},
                  {"demodulation duty", true},
                  {"edges", true},
                  {"start"}}};
  for (const Candidate& c : result.candidates)
    for (std::size_t k = 0; k < c.per_measurement.size(); ++k) {
      const MeasurementReport& m = c.per_measurement[k];
      const bool aimed = c.target.size() > 0;
      table.rows.push_back({c.code.name(), fmt::format("{}", k + 1),
                            aimed ? fmt::format("{:.4f}", m.residual_rms) : "",
                            aimed ? fmt::format("{:.4f}", m.smallest_residual_rms) : "",
                            fmt::format("{:.4f}", m.modulation_duty), fmt::format("{:.2f}", m.peak),
                            fmt::format("{:.4f}", m.demodulation_duty), fmt::format("{}", m.edges),
                            m.start});
    }
  return table;
}

constexpr std::size_t fewest_steps = 4;  // fewer points give no meaningful curve

void add_convergence(const DesignResult& result, Section& section) {
  for (const Candidate& c : result.candidates) {
    ColourAssignment colours;
    std::vector<Series> series;
    std::size_t longest = 0;
    for (std::size_t k = 0; k < c.per_measurement.size(); ++k) {
      Series relaxed{.name = fmt::format("measurement {}", k + 1),
                     .mark = Mark::line_and_markers,
                     .style = colours.style(fmt::format("{}", k))};
      for (std::size_t i = 0; i < c.per_measurement[k].history.size(); ++i) {
        relaxed.x.push_back(static_cast<double>(i + 1));
        relaxed.y.push_back(std::max(1e-6, c.per_measurement[k].history[i].playable_residual_rms));
      }
      longest = std::max(longest, relaxed.x.size());
      if (!relaxed.x.empty()) series.push_back(std::move(relaxed));
    }
    if (longest < fewest_steps) continue;
    section.blocks.push_back(line_figure(
        {.id = figure_id("convergence", c.code.name()),
         .title = fmt::format("Convergence of {}", c.code.name()),
         .caption = "Residual of the binary projection after each pair of convex steps, for the "
                    "random start with the smallest residual; values below 1e-6 are drawn at "
                    "1e-6."},
        series, {.label = "iteration"}, {.label = "residual, rms", .logarithmic = true}));
  }
}

void add_search_progress(const DesignResult& result, Section& section) {
  ColourAssignment colours;
  for (const Candidate& c : result.candidates) {
    if (!c.search || c.search->steps.size() < fewest_steps) continue;
    Series steps{.name = c.code.name(),
                 .mark = Mark::line_and_markers,
                 .style = colours.style(c.code.name())};
    for (const SearchStep& step : c.search->steps) {
      steps.x.push_back(step.work);
      steps.y.push_back(1e3 * step.error_m);
    }
    section.blocks.push_back(line_figure(
        {.id = figure_id("search", c.code.name()),
         .title = fmt::format("Search for {}", c.code.name()),
         .caption = fmt::format("The {} over the work of the search.", c.search->error_name)},
        {steps}, {.label = c.search->work_unit}, {.label = "depth error", .unit = "mm"}));
  }
}

Section search_section(const DesignResult& result) {
  Section section{.title = "Designed codes"};
  Table found = residual_table(result);
  if (!found.rows.empty()) section.blocks.push_back(std::move(found));
  Table searches{.caption = "How each code was found.", .columns = {{"code"}, {"found by"}}};
  for (const Candidate& c : result.candidates)
    if (c.search)
      searches.rows.push_back({c.code.name(), fmt::format("{}. {}", c.message, c.search->account)});
  if (!searches.rows.empty()) section.blocks.push_back(std::move(searches));
  add_search_progress(result, section);
  add_convergence(result, section);
  return section;
}

/// A table, because cells show user-defined names verbatim.
Table explanation(const DesignResult& result, DepthErrorKind kind) {
  std::vector<const char*> questions{"How does it compare?"};
  if (!result.winner().code.is_rows()) questions.push_back("Why this number of exposures?");
  questions.push_back("What limits its error?");
  if (result.winner().multipath) questions.push_back("How does it perform with multipath?");
  if (result.winner().interference) questions.push_back("How does it perform with other cameras?");
  if (result.winner().code.is_rows()) questions.push_back("How does it perform in dimmer light?");
  Table table{.columns = {{"question"}, {"answer"}}};
  if (kind == DepthErrorKind::linear)
    table.caption =
        "The depth origin of each code is shifted to minimize its linear error; `evaluate` does "
        "this only with --best-rotation.";
  for (std::size_t i = 0; i < result.explanation.size(); ++i)
    table.rows.push_back(
        {i < questions.size() ? questions[i] : "Further remarks", result.explanation[i]});
  return table;
}

Section candidates_section(const Camera& camera, const DesignResult& result) {
  const DepthErrorMeasure measure = camera.operating.measure();
  std::vector<DepthErrorRow> rows;
  for (const Candidate& c : result.candidates) {
    const bool is_best = &c == &result.winner();
    rows.push_back(
        {&c.error, c.method, is_best ? Estimate{1.0, 0.0} : gain_over(result, c, measure)});
  }
  return depth_error_section(camera, rows, result.best, false);
}

/// Omits the best code, which is on the first screen.
Section waveform_section(const Camera& camera, const DesignResult& result) {
  Section section{.title = "Waveforms of the other designed codes"};
  for (const Candidate& c : result.candidates) {
    if (!c.is_designed() || &c == &result.winner()) continue;
    section.blocks.push_back(
        waveform_figure({.id = figure_id("waveforms", c.code.name()),
                         .title = fmt::format("Waveforms of {}", c.code.name()),
                         .caption = "One row per measurement, over one period."},
                        c.code, camera, rotated_target(c)));
  }
  return section;
}

Section coding_curve_section(const Camera& camera, const DesignResult& result) {
  std::vector<CodeSet> shown{result.winner().code};
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"})
    if (const Candidate* c = result.find(name); c && c != &result.winner() && shown.size() < 3)
      shown.push_back(c->code);
  Section section{.title = "Coding curves"};
  section.blocks.push_back(
      Paragraph{"As depth varies over the range, the vector of correlation values follows a closed "
                "curve. Noise moves a measurement away from the curve; a long curve with "
                "well-separated branches distinguishes depths in spite of noise."});
  section.blocks.push_back(
      coding_curve_figure({.id = "coding-curves",
                           .title = "Coding curves",
                           .caption = "Projection onto the three directions of largest extent, "
                                      "coloured by depth. Drag to rotate."},
                          shown, camera));
  return section;
}

}  // namespace

bool is_compared_with_zncc(std::span<const EvaluatedCode> codes) {
  return !codes.empty() && codes.front().zncc_error;
}

std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level) {
  std::vector<std::vector<std::string>> rows{{"code", "signal (e/s)", "ambient (e/s)",
                                              "zncc linear (mm)", "ml / zncc", "zncc circular (mm)",
                                              "ml / zncc"}};
  for (const EvaluatedCode& code : codes) {
    const DepthErrorReport &own = code.error, &zncc = *code.zncc_error;
    rows.push_back({own.code, "geometric", "mean", estimate_mm_text(zncc.linear.geometric_mean_m),
                    ratio(own.linear.geometric_mean_m, zncc.linear.geometric_mean_m),
                    estimate_mm_text(zncc.circular.geometric_mean_m),
                    ratio(own.circular.geometric_mean_m, zncc.circular.geometric_mean_m)});
    for (std::size_t i = 0; every_level && i < own.points.size(); ++i) {
      const PointDepthError &p = own.points[i], &other = zncc.points[i];
      rows.push_back(
          {own.code, fmt::format("{:.3g}", p.point.signal_e_per_s),
           fmt::format("{:.3g}", p.point.ambient_e_per_s), estimate_mm_text(other.linear_mde_m),
           ratio(p.linear_mde_m, other.linear_mde_m), estimate_mm_text(other.circular_mde_m),
           ratio(p.circular_mde_m, other.circular_mde_m)});
    }
  }
  return rows;
}

Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line,
                   const std::vector<std::string>& files) {
  const Candidate& winner = result.winner();
  Page page{.title = fmt::format("Codes for {}", camera.name),
            .subtitle = fmt::format("{} candidates, ranked by {} depth error",
                                    result.candidates.size(), name_of(camera.operating.measure())),
            .footer = fmt::format("tofsmith {}, seed {}", TOFSMITH_VERSION, winner.error.seed)};
  page.sections.push_back(design_front(camera, result, scene, files));
  page.sections.push_back({"Why this code", {explanation(result, camera.operating.error)}});
  page.sections.push_back(camera_section(camera));
  page.sections.push_back(candidates_section(camera, result));
  if (camera.operating.multipath)
    page.sections.push_back(
        operating_multipath_section(*camera.operating.multipath, result, camera.operating.error));
  std::vector<JudgedCode> perturbed;
  for (const Candidate& c : result.candidates)
    if (c.robustness) perturbed.push_back({c.code.name(), *c.robustness});
  if (!perturbed.empty()) page.sections.push_back(robustness_section(perturbed));
  if (Section others = waveform_section(camera, result); !others.blocks.empty())
    page.sections.push_back(std::move(others));
  page.sections.push_back(coding_curve_section(camera, result));
  if (scene) page.sections.push_back(scene_section(*scene, camera, winner.code.name()));
  if (Section found = search_section(result); !found.blocks.empty())
    page.sections.push_back(std::move(found));
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  for (Section& section : page.sections)
    if (section.layout == SectionLayout::open) section.layout = SectionLayout::folded;
  return page;
}

Page design_report(const DesignedDirectory& found, const std::string& command_line) {
  return design_report(found.design.camera, found.design.result, found.scene, command_line,
                       found.files);
}

Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line) {
  Page page{.title = fmt::format("Depth error on {}", camera.name),
            .subtitle = fmt::format("{} code{}", codes.size(), codes.size() == 1 ? "" : "s"),
            .footer = "tofsmith " TOFSMITH_VERSION};
  std::vector<DepthErrorRow> compared;
  std::size_t best = 0;
  const DepthErrorMeasure measure = camera.operating.measure();
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    const DepthErrorReport& error = evaluated[i].error;
    compared.push_back({&error, codes[i].provenance.method});
    if (geometric_mean_error_m(error, measure) <
        geometric_mean_error_m(*compared[best].error, measure))
      best = i;
  }
  page.sections.push_back(depth_error_section(camera, compared, best, true));
  Section waveforms{.title = "Waveforms"};
  for (const CodeSet& code : codes)  // names may be equal or invalid as ids
    waveforms.blocks.push_back(
        waveform_figure({.id = fmt::format("waveforms-{}", waveforms.blocks.size() + 1),
                         .title = fmt::format("Waveforms of {}", code.name()),
                         .caption = "One row per measurement, over one period."},
                        code, camera));
  page.sections.push_back(std::move(waveforms));
  if (is_compared_with_zncc(evaluated))
    page.sections.push_back(
        {"Maximum likelihood compared with correlation",
         {table_of_rows("zncc",
                        "Depth error of the same trials decoded by zero-mean normalized "
                        "cross-correlation (zncc), and ratio of the maximum-likelihood (ml) error "
                        "to the zncc error.",
                        zncc_comparison_rows(evaluated, true), {0})}});
  if (const auto judged = judged_codes(evaluated); !judged.empty())
    page.sections.push_back(robustness_section(judged));
  if (is_evaluated_with_motion(evaluated)) page.sections.push_back(motion_section(evaluated));
  if (is_evaluated_with_interference(evaluated))
    page.sections.push_back(interference_section(evaluated, *camera.operating.interference));
  page.sections.push_back(camera_section(camera));
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith
