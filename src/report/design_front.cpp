// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "report/design_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/report/code_figures.hpp"

namespace tofsmith {
namespace {

constexpr double max_outlier_rate = 0.1;

/// Light levels with few outliers, or all levels if there are none.
std::vector<std::size_t> usable_levels(const DepthErrorReport& error) {
  std::vector<std::size_t> usable, all;
  for (std::size_t i = 0; i < error.points.size(); ++i) {
    all.push_back(i);
    if (error.points[i].outlier_rate.value <= max_outlier_rate) usable.push_back(i);
  }
  return usable.empty() ? all : usable;
}

/// Geometric mean over some light levels [mm].
double error_mm(const DepthErrorReport& error, const std::vector<std::size_t>& levels,
                DepthErrorMeasure measure) {
  double sum = 0.0;
  for (const std::size_t i : levels) {
    const PointDepthError& p = error.points[i];
    sum += std::log(p.of(measure).value);
  }
  return 1e3 * std::exp(sum / static_cast<double>(levels.size()));
}

/// The best code, the best standard code of every family, and sinusoid-k4, by error.
std::vector<const Candidate*> compared(const DesignResult& result, DepthErrorMeasure measure) {
  std::vector<const Candidate*> codes{&result.winner()};
  std::set<std::string> families;
  for (const Candidate* c : by_geometric_mean_error(result, measure)) {
    if (c == &result.winner() || c->is_designed() || c->method == "atlas") continue;
    const std::string name = c->code.name();
    const bool is_first = families.insert(name.substr(0, name.find('-'))).second;
    if (is_first || name == "sinusoid-k4") codes.push_back(c);
  }
  return codes;
}

Table comparison(const Camera& camera, const DesignResult& result) {
  const DepthErrorMeasure measure = camera.operating.measure();
  const DepthErrorReport& best = result.winner().error;
  const std::vector<std::size_t> levels = usable_levels(best);
  Table table{.id = "best",
              .title = "The best code and the standard codes",
              .caption = fmt::format(
                  "Error: geometric mean of the {} depth error over {} of the {} light levels. At "
                  "these levels, at most {:.0f} % of the depths of the best code are outliers "
                  "(errors above {:.2g} m). Ratio: error relative to the best code. Codes are "
                  "ranked by the mean over all levels.",
                  name_of(measure), levels.size(), best.points.size(), 100 * max_outlier_rate,
                  best.outlier_threshold_m),
              .columns = {{"code"}, {"exposures", true}, {"error (mm)", true}, {"ratio", true}},
              .highlighted_row = 0};
  const double best_mm = error_mm(best, levels, measure);
  for (const Candidate* c : compared(result, measure)) {
    const double its_mm = error_mm(c->error, levels, measure);
    table.rows.push_back({c->code.name(), fmt::format("{}", c->error.exposures),
                          fmt::format("{:.1f}", its_mm), fmt::format("{:.2f}", its_mm / best_mm)});
  }
  return table;
}

KeyNumbers headline(const Camera& camera, const DesignResult& result,
                    const std::optional<SceneResult>& scene) {
  const DepthErrorMeasure measure = camera.operating.measure();
  const Candidate& winner = result.winner();
  const std::vector<std::size_t> levels = usable_levels(winner.error);
  const double best_mm = error_mm(winner.error, levels, measure);
  KeyNumbers numbers{
      {{fmt::format("best code, {} exposures", winner.code.exposures()), winner.code.name()},
       {fmt::format("{} error, {} of {} light levels", name_of(measure), levels.size(),
                    winner.error.points.size()),
        fmt::format("{:.1f} mm", best_mm)}}};
  if (winner.multipath)
    numbers.entries.push_back(
        {"depth error with multipath, all levels",
         fmt::format("{:.1f} mm", 1e3 * winner.multipath->single_path.of(measure.kind).value)});
  for (const char* name : {"sinusoid-k4", "square-k4"})
    if (const Candidate* other = result.find(name); other && other != &winner)
      numbers.entries.push_back(
          {fmt::format("error ratio of {}", name),
           fmt::format("{:.2f} times", error_mm(other->error, levels, measure) / best_mm)});
  if (!scene || scene->captures.empty()) return numbers;
  const SceneCapture& brightest = scene->captures.back();
  for (const SceneDecoding& decoding : brightest.decodings)
    if (decoding.code == winner.code.name())
      numbers.entries.push_back({fmt::format("mean scene error, {} light", brightest.light),
                                 fmt::format("{:.1f} mm", 1e3 * decoding.error.mean_m)});
  return numbers;
}

std::vector<DepthErrorRow> rows_of(const std::vector<const Candidate*>& codes) {
  std::vector<DepthErrorRow> rows;
  for (const Candidate* c : codes) rows.push_back({&c->error, c->method});
  return rows;
}

/// A file of a design directory, listed in the order of use.
struct KnownFile {
  const char* name;
  const char* note;
};
constexpr KnownFile known_files[] = {
    {"camera.toml", "the camera"},
    {"design.json", "all numbers of this report"},
    {"codes", "every code"},
    {"waveforms", "waveforms of every code as CSV"},
    {"raw.npy", "raw frames of the scene with the best code"},
    {"depth.npy", "depth decoded from raw.npy (also .npz .exr .pfm .png)"},
    {"points.ply", "decoded depth as a point cloud"},
};

bool has(const std::vector<std::string>& files, const char* name) {
  return std::ranges::find(files, name) != files.end();
}

std::string commands(const std::string& code_file, const std::vector<std::string>& files) {
  std::string text = fmt::format(
      "# in the directory of the design\n"
      "tofsmith evaluate --camera camera.toml {0} sinusoid-k4\n"
      "tofsmith export --camera camera.toml --format csv {0} -o generator\n",
      code_file);
  text += has(files, "raw.npy")
              ? fmt::format("tofsmith decode --camera camera.toml --code {} raw.npy -o depth2.npy",
                            code_file)
              : fmt::format("tofsmith simulate --camera camera.toml --code {} table-top -o raw.npy",
                            code_file);
  return text;
}

}  // namespace

Eigen::MatrixXd rotated_target(const Candidate& candidate) {
  const Eigen::MatrixXd& target = candidate.target;
  Eigen::MatrixXd rotated(target.rows(), target.cols());
  for (Eigen::Index n = 0; n < target.rows(); ++n)
    rotated.row(n) = target.row((n + candidate.rotation_bin) % target.rows());
  return rotated;
}

Section design_front(const Camera& camera, const DesignResult& result,
                     const std::optional<SceneResult>& scene,
                     const std::vector<std::string>& files) {
  const Candidate& winner = result.winner();
  const std::vector<const Candidate*> codes = compared(result, camera.operating.measure());
  Section front{.title = "Result", .layout = SectionLayout::front};
  front.blocks.push_back(headline(camera, result, scene));
  front.blocks.push_back(comparison(camera, result));
  if (camera.operating.signal_e_per_s.size() > 1)
    front.blocks.push_back(error_by_signal("best-error", camera, rows_of(codes)));
  if (scene)
    if (auto picture = before_after_figure(*scene, camera, winner.code.name()))
      front.blocks.push_back(std::move(*picture));
  front.blocks.push_back(
      waveform_figure({.id = "best-waveforms",
                       .title = fmt::format("Waveforms of {}", winner.code.name()),
                       .caption = "One row per measurement, over one period."},
                      winner.code, camera, rotated_target(winner)));
  if (files.empty()) return front;
  KeyValueList written;
  const std::string code_file = fmt::format("codes/{}.code.json", file_name_of(winner.code.name()));
  written.entries.push_back({code_file, "the best code"});
  for (const KnownFile& file : known_files)
    if (has(files, file.name)) written.entries.push_back({file.name, file.note});
  front.blocks.push_back(std::move(written));
  front.blocks.push_back(CodeBlock{commands(code_file, files)});
  return front;
}

}  // namespace tofsmith
