// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design_output.hpp"

#include <fmt/format.h>

#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith::apps {

namespace {

/// Returns sentences about the winner and its advantage over other codes.
std::string verdict(const Camera& camera, const DesignResult& result) {
  const DepthErrorMeasure measure = camera.operating.measure();
  const Candidate& winner = result.winner();
  const OperatingRange& range = camera.operating;
  std::string text = fmt::format("best: {} (geometric means over {} operating points, N = {}{})",
                                 winner.code.name(), winner.error.points.size(), camera.samples,
                                 range.depths || range.working_distance_m
                                     ? ", true depths " + true_depths_in_words(camera)
                                     : "");
  for (const std::string& sentence : result.explanation) text += "\n  " + sentence;
  std::string tied;
  for (const Candidate& c : result.candidates) {
    const Estimate gain = gain_over(result, c, measure);
    if (&c != &winner && gain.value - 1.0 < 2.0 * gain.standard_error)
      tied += (tied.empty() ? "" : ", ") + c.code.name();
  }
  if (!tied.empty() && !camera.operating.multipath && !camera.operating.interference)
    text += "\n  within two standard errors of the best: " + tied +
            " (increase --trials to distinguish them)";
  if (!camera.operating.interference)  // these ratios exclude other cameras
    for (const char* name : {"sinusoid-k3", "sinusoid-k4", "square-k4", "pulsed-multifrequency-k5"})
      if (const Candidate* other = result.find(name); other && other != &winner)
        text += fmt::format("\n  {:.2f}x better than {}", gain_over(result, *other, measure).value,
                            name);
  for (const Candidate& c : result.candidates)
    if (c.is_designed())
      text += fmt::format("\n  {}: {} ({})", c.code.name(), c.message, time_text(c.seconds));
  return text;
}

}  // namespace

void print_design(const Session& session, const Camera& camera, const DesignResult& result,
                  const DesignOptions& options) {
  if (session.json) return session.print_document(design_document(camera, result, options));
  const DepthErrorKind kind = camera.operating.error;
  const ErrorStatistic statistic = camera.operating.statistic;
  const std::vector<const Candidate*> order =
      by_geometric_mean_error(result, camera.operating.measure());
  const char* rms = statistic == ErrorStatistic::rmse ? "rms " : "";
  const auto error_text = [&](const Candidate& c, DepthErrorKind of) {
    return estimate_mm_text(c.error.of({of, statistic}).geometric_mean_m);
  };
  std::vector<std::vector<std::string>> rows{
      {"code", exposures_by_taps_title, fmt::format("linear {}(mm)", rms),
       fmt::format("circular {}(mm)", rms), "rotation (bin)", "made by"}};
  for (const Candidate* c : order)
    rows.push_back(
        {c->code.name(), exposures_by_taps(c->error), error_text(*c, DepthErrorKind::linear),
         error_text(*c, DepthErrorKind::circular), fmt::format("{}", c->rotation_bin), c->method});
  const auto add_column = [&](const char* title, const auto& text_of) {
    rows.front().push_back(title);
    for (std::size_t i = 0; i < order.size(); ++i) rows[i + 1].push_back(text_of(*order[i]));
  };
  if (camera.operating.multipath) {
    add_column("second return (mm)", [&](const Candidate& c) {
      return estimate_mm_text(c.multipath->single_path.of(kind));
    });
    add_column("two-return (mm)", [](const Candidate& c) {
      const auto& two_return = c.multipath->two_return;
      return two_return ? estimate_mm_text(two_return->circular_m) : std::string("unsupported");
    });
  }
  if (camera.operating.interference)
    add_column("interference (mm)", [&](const Candidate& c) {
      return estimate_mm_text(c.interference->of(kind).geometric_mean_m);
    });
  if (camera.operating.velocity_m_per_s)
    add_column("motion (mm)", [](const Candidate& c) {
      return fmt::format("{:.3f}", 1e3 * c.exposure_order->rms_bias_m);
    });
  session.say(text_table(rows));
  session.say(depth_error_legend);
  if (kind == DepthErrorKind::linear)
    session.say(
        "the depth origin of each code is shifted to minimize its linear error; `evaluate` does "
        "this only with --best-rotation");
  session.say(verdict(camera, result));
  for (const std::string& reason : result.left_out) session.say("  excluded: " + reason);
}

void write_report(const Session& session, const std::filesystem::path& directory,
                  OutputPolicy policy) {
  write_file_atomically(
      directory / "report.html",
      render(design_report(read_designed_directory(directory), session.command_line)), policy);
}

}  // namespace tofsmith::apps
