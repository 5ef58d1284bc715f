// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include "report/error_sections.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/line_figure.hpp"
#include "tofsmith/report/scene_section.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// How many times larger another candidate's chosen error is than the winner's.
std::string gain_over(const DesignResult& result, std::string_view name, DepthErrorKind kind) {
  const Candidate* other = result.find(name);
  if (!other || other == &result.winner()) return "";
  return fmt::format(
      "{:.2f}x", chosen_error_m(other->error, kind) / chosen_error_m(result.winner().error, kind));
}

KeyNumbers headline(const DesignResult& result, DepthErrorKind kind) {
  const Candidate& winner = result.winner();
  KeyNumbers numbers;
  numbers.entries.push_back({"best code", winner.code.name()});
  numbers.entries.push_back(
      {kind == DepthErrorKind::linear ? "linear depth error" : "circular depth error",
       fmt::format("{:.1f} mm", 1e3 * chosen_error_m(winner.error, kind))});
  for (const char* baseline : {"sinusoid-k4", "square-k4"})
    if (const std::string gain = gain_over(result, baseline, kind); !gain.empty())
      numbers.entries.push_back({fmt::format("better than {}", baseline), gain});
  return numbers;
}

/// What the correlation functions of a candidate should be, moved with its origin.
Eigen::MatrixXd rotated_target(const Candidate& c) {
  Eigen::MatrixXd target(c.target.rows(), c.target.cols());
  for (Eigen::Index n = 0; n < target.rows(); ++n)
    target.row(n) = c.target.row((n + c.rotation_bin) % target.rows());
  return target;
}

Section waveform_section(const Camera& camera, const DesignResult& result) {
  Section section{.title = "Waveforms"};
  const auto add = [&](const Candidate& c) {
    std::string id = figure_id("waveforms", c.code.name());
    section.blocks.push_back(waveform_figure(
        {.id = id,
         .title = fmt::format("Waveforms of {}", c.code.name()),
         .caption = c.target.size() > 0
                        ? "One row per measurement: what is played, what the camera's impulse "
                          "responses leave of it, and the correlation function with its target."
                        : "One row per measurement, over one period."},
        c.code, camera, rotated_target(c)));
  };
  add(result.winner());
  for (const Candidate& c : result.candidates)
    if (&c != &result.winner() && !c.per_measurement.empty()) add(c);
  return section;
}

Section coding_curve_section(const Camera& camera, const DesignResult& result) {
  std::vector<CodeSet> shown{result.winner().code};
  for (const char* name : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"})
    if (const Candidate* c = result.find(name); c && c != &result.winner() && shown.size() < 3)
      shown.push_back(c->code);
  Section section{.title = "Coding curves"};
  section.blocks.push_back(Paragraph{
      "As depth runs through the range, the vector of correlation values draws a closed curve. A "
      "long curve that keeps away from itself separates depths; noise moves a measurement off "
      "it."});
  section.blocks.push_back(coding_curve_figure(
      {.id = "coding-curves",
       .title = "Coding curves",
       .caption = "In the three directions of largest extent, coloured by depth. Drag to turn."},
      shown, camera));
  return section;
}

/// Residuals against iterations of every measurement that was designed.
Section convergence_section(const DesignResult& result) {
  Section section{.title = "Convergence"};
  for (const Candidate& c : result.candidates) {
    ColourAssignment colours;
    std::vector<Series> series;
    for (std::size_t k = 0; k < c.per_measurement.size(); ++k) {
      Series relaxed{.name = fmt::format("measurement {}", k + 1),
                     .mark = Mark::line_and_markers,
                     .style = colours.style(fmt::format("{}", k))};
      for (std::size_t i = 0; i < c.per_measurement[k].history.size(); ++i) {
        relaxed.x.push_back(static_cast<double>(i + 1));
        relaxed.y.push_back(std::max(1e-6, c.per_measurement[k].history[i].playable_residual_rms));
      }
      if (!relaxed.x.empty()) series.push_back(std::move(relaxed));
    }
    if (series.empty()) continue;
    section.blocks.push_back(line_figure(
        {.id = figure_id("convergence", c.code.name()),
         .title = fmt::format("Convergence of {}", c.code.name()),
         .caption = "Residual of the binary projection after each pair of convex steps, for the "
                    "random start that came closest; values below 1e-6 are drawn "
                    "at 1e-6."},
        series, {.label = "iteration"}, {.label = "residual, rms", .logarithmic = true}));
  }
  return section;
}

Section residual_section(const DesignResult& result) {
  Section section{.title = "Designed codes"};
  Table table{.id = "residuals",
              .caption =
                  "Every measurement of every designed code. Pairs are chosen by depth error: the "
                  "residual is the chosen pair's distance from the target, beside the smallest "
                  "distance of any pair found.",
              .columns = {{"code"},
                          {"measurement", true},
                          {"residual", true},
                          {"smallest", true},
                          {"modulation duty", true},
                          {"peak", true},
                          {"demodulation duty", true},
                          {"edges", true},
                          {"found from"}}};
  for (const Candidate& c : result.candidates)
    for (std::size_t k = 0; k < c.per_measurement.size(); ++k) {
      const MeasurementReport& m = c.per_measurement[k];
      table.rows.push_back(
          {c.code.name(), fmt::format("{}", k + 1), fmt::format("{:.4f}", m.residual_rms),
           fmt::format("{:.4f}", m.smallest_residual_rms), fmt::format("{:.4f}", m.modulation_duty),
           fmt::format("{:.2f}", m.peak), fmt::format("{:.4f}", m.demodulation_duty),
           fmt::format("{}", m.edges), m.start});
    }
  section.blocks.push_back(std::move(table));
  return section;
}

}  // namespace

Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line) {
  const Candidate& winner = result.winner();
  Page page{.title = fmt::format("Codes for {}", camera.name),
            .subtitle = fmt::format(
                "{} candidates, judged by {} depth error", result.candidates.size(),
                camera.operating.error == DepthErrorKind::linear ? "linear" : "circular"),
            .footer = fmt::format("tofsmith {}, seed {}", TOFSMITH_VERSION, winner.error.seed)};
  page.sections.push_back({"Result", {headline(result, camera.operating.error)}});
  page.sections.push_back({"Camera", {camera_description(camera)}});

  std::vector<ComparedCode> compared;
  for (const Candidate& c : result.candidates) compared.push_back({&c.error, c.method});
  page.sections.push_back(depth_error_section(camera, compared, result.best));
  page.sections.push_back(waveform_section(camera, result));
  page.sections.push_back(coding_curve_section(camera, result));
  if (scene) page.sections.push_back(scene_section(*scene, camera, winner.code.name()));
  if (Section s = residual_section(result); !std::get<Table>(s.blocks[0]).rows.empty()) {
    page.sections.push_back(std::move(s));
    page.sections.push_back(convergence_section(result));
  }
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       const std::vector<DepthErrorReport>& errors,
                       const std::string& command_line) {
  Page page{.title = fmt::format("Depth error on {}", camera.name),
            .subtitle = fmt::format("{} codes", codes.size()),
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back({"Camera", {camera_description(camera)}});
  std::vector<ComparedCode> compared;
  std::size_t best = 0;
  const DepthErrorKind kind = camera.operating.error;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    compared.push_back({&errors[i], codes[i].provenance.method});
    if (chosen_error_m(errors[i], kind) < chosen_error_m(errors[best], kind)) best = i;
  }
  page.sections.push_back(depth_error_section(camera, compared, best));
  Section waveforms{.title = "Waveforms"};
  for (const CodeSet& code : codes)  // of any names, even the same
    waveforms.blocks.push_back(
        waveform_figure({.id = fmt::format("waveforms-{}", waveforms.blocks.size() + 1),
                         .title = fmt::format("Waveforms of {}", code.name()),
                         .caption = "One row per measurement, over one period."},
                        code, camera));
  page.sections.push_back(std::move(waveforms));
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

}  // namespace tofsmith
