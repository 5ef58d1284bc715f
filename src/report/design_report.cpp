// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/report/design_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/error_sections.hpp"
#include "report/search_sections.hpp"
#include "report/second_return_section.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/robustness_section.hpp"
#include "tofsmith/report/scene_section.hpp"
#include "tofsmith/report/zncc_comparison.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

/// How many times larger another candidate's chosen error is than the winner's.
std::string gain_text(const DesignResult& result, std::string_view name, DepthErrorKind kind) {
  const Candidate* other = result.find(name);
  if (!other || other == &result.winner()) return "";
  return fmt::format("{:.2f}x", gain_over(result, *other, kind).value);
}

KeyNumbers headline(const DesignResult& result, DepthErrorKind kind) {
  const Candidate& winner = result.winner();
  KeyNumbers numbers;
  numbers.entries.push_back({"best code", winner.code.name()});
  numbers.entries.push_back(
      {kind == DepthErrorKind::linear ? "linear depth error" : "circular depth error",
       fmt::format("{:.1f} mm", 1e3 * geometric_mean_error_m(winner.error, kind))});
  if (winner.second_returns)
    numbers.entries.push_back(
        {"behind second returns",
         fmt::format("{:.1f} mm", 1e3 * winner.second_returns->single_path.of(kind).value)});
  for (const char* baseline : {"sinusoid-k4", "square-k4"})
    if (const std::string gain = gain_text(result, baseline, kind); !gain.empty())
      numbers.entries.push_back({fmt::format("better than {}", baseline), gain});
  return numbers;
}

/// Why the winner won. A table, whose cells are set as they are: the names in them are users'.
Table explanation(const DesignResult& result, DepthErrorKind kind) {
  constexpr std::array questions = {"What does it beat?", "Why so many exposures?",
                                    "What limits it?", "And behind second returns?"};
  Table table{.caption = "Why this code.", .columns = {{"question"}, {"answer"}}};
  if (kind == DepthErrorKind::linear)
    table.caption +=
        " Every code is judged at its best origin of depth; evaluate takes it as it is, "
        "or moves it with --best-rotation.";
  for (std::size_t i = 0; i < std::min(questions.size(), result.explanation.size()); ++i)
    table.rows.push_back({questions[i], result.explanation[i]});
  return table;
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
    if (&c != &result.winner() && c.is_designed()) add(c);
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

Section residual_section(const DesignResult& result) {
  Section section{.title = "Designed codes"};
  Table table{.id = "residuals",
              .caption =
                  "Every measurement of every designed code. Factorized pairs are chosen by depth "
                  "error: the residual is the chosen pair's distance from the target, beside the "
                  "smallest distance of any pair found.",
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
      const bool aimed = c.target.size() > 0;
      table.rows.push_back({c.code.name(), fmt::format("{}", k + 1),
                            aimed ? fmt::format("{:.4f}", m.residual_rms) : "",
                            aimed ? fmt::format("{:.4f}", m.smallest_residual_rms) : "",
                            fmt::format("{:.4f}", m.modulation_duty), fmt::format("{:.2f}", m.peak),
                            fmt::format("{:.4f}", m.demodulation_duty), fmt::format("{}", m.edges),
                            m.start});
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
  Section first{"Result", {headline(result, camera.operating.error)}};
  first.blocks.push_back(explanation(result, camera.operating.error));
  page.sections.push_back(std::move(first));
  page.sections.push_back({"Camera", {camera_description(camera)}});

  std::vector<DepthErrorRow> compared;
  for (const Candidate& c : result.candidates) compared.push_back({&c.error, c.method});
  page.sections.push_back(depth_error_section(camera, compared, result.best));
  if (camera.operating.multipath)
    page.sections.push_back(
        second_return_section(*camera.operating.multipath, result, camera.operating.error));
  page.sections.push_back(gain_section(camera, result));
  std::vector<JudgedCode> perturbed;
  for (const Candidate& c : result.candidates)
    if (c.robustness) perturbed.push_back({c.code.name(), *c.robustness});
  if (!perturbed.empty()) page.sections.push_back(robustness_section(perturbed));
  page.sections.push_back(waveform_section(camera, result));
  page.sections.push_back(coding_curve_section(camera, result));
  if (scene) page.sections.push_back(scene_section(*scene, camera, winner.code.name()));
  if (Section s = residual_section(result); !std::get<Table>(s.blocks[0]).rows.empty()) {
    page.sections.push_back(std::move(s));
    page.sections.push_back(search_section(result));
  }
  if (!command_line.empty()) page.sections.push_back({"Command", {CodeBlock{command_line}}});
  return page;
}

Page design_report(const DesignedDirectory& found, const std::string& command_line) {
  return design_report(found.design.camera, found.design.result, found.scene, command_line);
}

Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       const std::vector<DepthErrorReport>& errors,
                       const std::string& command_line) {
  Page page{.title = fmt::format("Depth error on {}", camera.name),
            .subtitle = fmt::format("{} code{}", codes.size(), codes.size() == 1 ? "" : "s"),
            .footer = "tofsmith " TOFSMITH_VERSION};
  page.sections.push_back({"Camera", {camera_description(camera)}});
  std::vector<DepthErrorRow> compared;
  std::size_t best = 0;
  const DepthErrorKind kind = camera.operating.error;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    compared.push_back({&errors[i], codes[i].provenance.method});
    if (geometric_mean_error_m(errors[i], kind) < geometric_mean_error_m(errors[best], kind))
      best = i;
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

Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line) {
  std::vector<DepthErrorReport> errors;
  for (const EvaluatedCode& code : evaluated) errors.push_back(code.error);
  Page page = evaluation_report(camera, codes, errors, command_line);
  if (is_compared_with_zncc(evaluated)) page.sections.push_back(zncc_comparison(evaluated));
  if (const auto judged = judged_codes(evaluated); !judged.empty())
    page.sections.push_back(robustness_section(judged));
  return page;
}

}  // namespace tofsmith
