// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "described_options.hpp"
#include "distance_arguments.hpp"
#include "help_pages.hpp"
#include "method_arguments.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith::apps {

namespace {

std::string bound_text(double bound_m, const Estimate& error_m) {
  if (bound_m == 0.0) return "none";
  if (!std::isfinite(bound_m)) return "inf";
  return fmt::format("{} ({:.2f}x)", plain_number(1e3 * bound_m, 4), error_m.value / bound_m);
}

using Row = std::vector<std::string>;

Row point_row(const DepthErrorReport& error, std::string_view which, const PointDepthError& p) {
  return {error.code,
          exposures_by_taps(error),
          std::string(which),
          fmt::format("{:.3g}", p.point.signal_e_per_s),
          fmt::format("{:.3g}", p.point.ambient_e_per_s),
          estimate_mm_text(p.linear_mde_m),
          estimate_mm_text(p.circular_mde_m),
          fmt::format("{:.2f}", 100 * p.outlier_rate.value),
          bound_text(p.cramer_rao_mae_m, p.circular_mde_m),
          bound_text(p.receiver_bound_mae_m, p.circular_mde_m),
          bound_text(p.direct_tof_bound_mae_m, p.circular_mde_m)};
}

Row mean_row(const DepthErrorReport& error) {
  return {error.code,
          exposures_by_taps(error),
          fmt::format("mean of {}", error.points.size()),
          "",
          "",
          estimate_mm_text(error.linear.geometric_mean_m),
          estimate_mm_text(error.circular.geometric_mean_m),
          "",
          "",
          "",
          ""};
}

/// Returns a table of depth errors, headings first. Each code has its geometric mean, then the
/// operating points with the least and the largest error, or all of them. Each bound is followed by
/// the ratio of the circular error to it.
std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes,
                                                      DepthErrorKind kind, bool every_level) {
  std::vector<Row> rows{{"code", exposures_by_taps_title, "light", "signal (e/s)", "ambient (e/s)",
                         "linear (mm)", "circular (mm)", "outliers (%)", "Cramer-Rao (mm)",
                         "receiver (mm)", "direct ToF (mm)"}};
  const auto error_m = [kind](const PointDepthError& p) { return p.of(kind).value; };
  for (const EvaluatedCode& code : codes) {
    const std::vector<PointDepthError>& points = code.error.points;
    const auto [best, worst] = std::ranges::minmax_element(points, {}, error_m);
    rows.push_back(mean_row(code.error));
    if (every_level || points.size() < 2) {
      for (const PointDepthError& p : points) rows.push_back(point_row(code.error, "", p));
    } else {
      rows.push_back(point_row(code.error, "best", *best));
      rows.push_back(point_row(code.error, "worst", *worst));
    }
  }
  return rows;
}

/// Returns the same as CSV, in metres.
std::string evaluation_csv(const std::vector<EvaluatedCode>& codes) {
  const bool compared = is_compared_with_zncc(codes);
  const bool has_others = is_evaluated_with_interference(codes);
  std::string text = "code";
  for (const PointColumn& column : point_columns({})) text += fmt::format(",{}", column.name);
  if (compared) text += ",zncc_linear_mde_m,zncc_circular_mde_m";
  if (has_others)
    text +=
        ",interference_rms_m,interference_expected_rmse_m,interference_circular_mde_m,"
        "interference_circular_rmse_m,interference_wrong,interference_wrong_ok,"
        "interference_wrong_inconsistent";
  text += "\n";
  for (const EvaluatedCode& code : codes)
    for (std::size_t i = 0; i < code.error.points.size(); ++i) {
      text += csv_field(code.error.code);
      for (const PointColumn& column : point_columns(code.error.points[i]))
        text += std::isnan(column.value) ? "," : fmt::format(",{:.9g}", column.value);
      if (compared)
        text += fmt::format(",{:.9g},{:.9g}", code.zncc_error->points[i].linear_mde_m.value,
                            code.zncc_error->points[i].circular_mde_m.value);
      if (has_others) {
        const InterferencePoint& lit = code.interference->points[i];
        text += fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}",
                            code.interference->rms_m, lit.expected_rmse_m, lit.circular_mde_m.value,
                            lit.circular_rmse_m.value, lit.shares.wrong, lit.shares.wrong_ok,
                            lit.shares.wrong_inconsistent);
      }
      text += "\n";
    }
  return text;
}

struct Quantity {
  std::string_view name;
  double RobustnessOptions::*field;
  bool is_time;
};

constexpr std::array quantities = {
    Quantity{"jitter", &RobustnessOptions::edge_jitter_s, true},
    Quantity{"clock", &RobustnessOptions::clock_s, true},
    Quantity{"droop", &RobustnessOptions::droop, false},
    Quantity{"bandwidth", &RobustnessOptions::bandwidth, false},
    Quantity{"peak", &RobustnessOptions::peak, false},
    Quantity{"mismatch", &RobustnessOptions::tap_mismatch, false},
};

/// Converts a text such as "50ps", "5 ns", "3%" or "0.03" to SI units; NaN if it is invalid.
double value_of(std::string_view text, bool is_time) {
  if (is_time) return number_with_unit(text, "s");
  return text.ends_with('%') ? number_with_unit(text, "%") / 100.0
                             : number_in_unit(text, "").value_or(NAN);
}

/// Parses `--perturb jitter=50ps,clock=5ns,droop=3%`: each of these changes alone, and all
/// together.
/// @throws UsageError
RobustnessOptions parse_perturbations(std::string_view text) {
  RobustnessOptions options{
      .bandwidth = 0.0, .peak = 0.0, .edge_jitter_s = 0.0, .tap_mismatch = 0.0, .together = true};
  std::vector<std::string_view> names;
  for (const Quantity& q : quantities) names.push_back(q.name);
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string_view name = word.substr(0, equals);
    const auto quantity = std::ranges::find(quantities, name, &Quantity::name);
    if (quantity == quantities.end() || equals == word.size()) {
      const std::string near = nearest_word(name, names);
      throw UsageError(
          fmt::format("--perturb: found '{}'; expected {}=VALUE{}", word,
                      near.empty() ? fmt::format("one of {}", fmt::join(names, ", ")) : near,
                      near.empty() ? " such as jitter=50ps,clock=5ns,droop=3%" : ""));
    }
    const double value = value_of(word.substr(equals + 1), quantity->is_time);
    if (!(value > 0.0 && value < 1.0))
      throw UsageError(fmt::format("--perturb {}: found '{}'; expected {}", name,
                                   word.substr(equals + 1),
                                   quantity->is_time ? "a time > 0 with its unit, such as 50ps"
                                                     : "a share in (0, 1), such as 3%"));
    options.*(quantity->field) = value;
  }
  return options;
}

struct EvaluateArguments {
  std::vector<std::string> codes;
  CameraArguments camera;
  EvaluateOptions options;
  MethodArguments method;
  bool on_bins = false;
  bool best_rotation = false;
  bool robustness = false;
  std::string perturb;
  bool every_level = false;
  DistanceArguments distance;
  TapArguments taps;
  std::string output;
};

std::string trials_text(const std::vector<EvaluatedCode>& codes, const EvaluateOptions& options) {
  std::int64_t min_trials = codes.front().error.trials, max_trials = 0;
  for (const EvaluatedCode& code : codes)
    for (const PointDepthError& point : code.error.points) {
      min_trials = std::min(min_trials, point.trials);
      max_trials = std::max(max_trials, point.trials);
    }
  if (options.target_standard_error == 0.0) return fmt::format("{} trials", max_trials);
  return fmt::format("{} to {} trials", min_trials, max_trials);
}

std::string true_depths_text(const Camera& camera, const EvaluateOptions& options) {
  if (options.depth != DepthSampling::bins) return true_depths_in_words(camera);
  const OperatingRange& range = camera.operating;
  return range.depths || range.working_distance_m ? "on bins " + true_depths_in_words(camera)
                                                  : "on bins";
}

/// Returns the number of light levels and their ranges of signal and ambient light.
std::string light_levels_text(const OperatingRange& operating) {
  const auto span = [](const std::vector<double>& e_per_s) {
    const auto [least, most] = std::ranges::minmax(e_per_s);
    return least == most ? fmt::format("{:.3g}", least)
                         : fmt::format("{:.3g} to {:.3g}", least, most);
  };
  return fmt::format("{} light levels of the camera (S = {}, A = {} e/s)",
                     operating.signal_e_per_s.size() * operating.ambient_e_per_s.size(),
                     span(operating.signal_e_per_s), span(operating.ambient_e_per_s));
}

/// Returns true if the Cramer-Rao bound significantly exceeds the error at some operating point.
bool exceeds_error(const EvaluatedCode& code) {
  return std::ranges::any_of(code.error.points, [](const PointDepthError& p) {
    return std::isfinite(p.cramer_rao_mae_m) && 0.9 * p.cramer_rao_mae_m > p.circular_mde_m.value;
  });
}

/// Prints a note if operating points reached the maximum number of trials before the target.
void note_missed_targets(const Session& session, const std::vector<EvaluatedCode>& codes,
                         const EvaluateOptions& options) {
  for (const EvaluatedCode& code : codes)
    if (code.error.points_short_of_target > 0)
      session.say(
          fmt::format("note: {}: {} of {} operating points did not reach a standard error of "
                      "{:.3g} % within {} trials; increase --max-trials or the target",
                      code.error.code, code.error.points_short_of_target, code.error.points.size(),
                      100.0 * options.target_standard_error, options.max_trials));
}

void print(const Session& session, const Camera& camera, const std::vector<EvaluatedCode>& codes,
           const EvaluateArguments& arguments) {
  const EvaluateOptions& options = arguments.options;
  const bool every_level = arguments.every_level || arguments.distance.is_asked();
  if (session.json) return session.print_document(evaluation_document(camera, codes, options));
  session.say(text_table(evaluation_rows(codes, camera.operating.error, every_level)));
  if (is_compared_with_zncc(codes))
    session.say(text_table(zncc_comparison_rows(codes, every_level)));
  if (const auto judged = judged_codes(codes); !judged.empty())
    session.say(text_table(robustness_rows(judged)));
  if (is_evaluated_with_motion(codes)) {
    session.say(text_table(motion_rows(codes, every_level)));
    session.say(fmt::format(
        "motion at {} m/s; bias: rms without noise; wrong: more than 3 deviations from every "
        "surface; detected: share of wrong depths with status inconsistent; edge ok: wrong depths "
        "with status ok",
        *camera.operating.velocity_m_per_s));
  }
  if (is_evaluated_with_interference(codes)) {
    session.say(text_table(interference_rows(codes, every_level)));
    session.say(fmt::format(
        "interference of {}; interference: rms error without noise, first order; expected rms: "
        "with noise; rms, error: root mean square and mean error of trials; alone: without other "
        "cameras; wrong: more than 3 deviations; wrong ok: the same with status ok; detected: "
        "share of wrong depths with status inconsistent",
        interference_text(*camera.operating.interference)));
  }
  session.say(fmt::format(
      "{} per operating point, seed {}, N = {}, true depths {}, decoded by {}{}; ± is "
      "one standard error; factors in parentheses are circular error / bound",
      trials_text(codes, options), options.seed, camera.samples, true_depths_text(camera, options),
      camera.sensor.decoder == RowDecoder::plain ? "plain " : "", name_of(options.method)));
  session.say(depth_error_legend);
  if (codes.front().error.points.size() > 2 && !every_level)
    session.say(fmt::format("to print all {}, use --every-level or -o FILE (.csv .json .html)",
                            light_levels_text(camera.operating)));
  if (std::ranges::any_of(codes, exceeds_error))
    session.say(
        "factors below 1x: the bound assumes an unbiased decoder and ignores that the unambiguous "
        "range limits the error");
  note_missed_targets(session, codes, options);
}

/// Checks the output before the long work.
void check_output(const std::filesystem::path& path, const Session& session) {
  if (path.empty()) return;
  const std::string extension = path.extension().string();
  if (extension != ".csv" && extension != ".json" && extension != ".html")
    throw UsageError(
        fmt::format("-o {}: unknown extension; expected .csv, .json or .html", path.string()));
  session.check_output(path);
}

/// Evaluates each code, at its best origin if requested, and with moving surfaces or other cameras
/// if the camera describes them. Maximum likelihood is compared with zncc on the same depths and
/// noise.
std::vector<EvaluatedCode> evaluate_all(std::vector<CodeSet>& codes, const Camera& camera,
                                        const EvaluateArguments& arguments) {
  std::vector<EvaluatedCode> evaluated;
  const ProgressParts parts(terminal_progress("evaluating"), codes.size());
  const bool is_compared = arguments.options.method == DecodeMethod::ml;
  const auto& velocity_m_per_s = camera.operating.velocity_m_per_s;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const ProgressParts of_code(
        parts[i],
        {arguments.best_rotation ? 50.0 : 0.0, is_compared ? 40.0 : 50.0, is_compared ? 10.0 : 0.0,
         velocity_m_per_s ? 20.0 : 0.0, camera.operating.interference ? 20.0 : 0.0});
    int rotation = 0;
    if (arguments.best_rotation) {
      rotation = best_rotation(codes[i], camera, arguments.options, of_code[0]).rotation_bin;
      codes[i] = codes[i].rotated(rotation);
    }
    EvaluateOptions options = arguments.options;
    options.draw_every_measurement = is_compared;
    EvaluatedCode code{evaluate(codes[i], camera, options, of_code[1]), rotation};
    if (is_compared) {
      options.method = DecodeMethod::zncc;
      code.zncc_error = evaluate(codes[i], camera, options, of_code[2]);
    }
    if (velocity_m_per_s)
      code.motion =
          motion_error(codes[i], camera, *velocity_m_per_s, arguments.options, of_code[3]);
    if (camera.operating.interference)
      code.interference = interference_error(codes[i], camera, arguments.options, of_code[4]);
    evaluated.push_back(std::move(code));
  }
  return evaluated;
}

/// Evaluates codes on perturbed cameras with the same decoder, seed and number of trials.
void judge_robustness(std::vector<EvaluatedCode>& evaluated, const std::vector<CodeSet>& codes,
                      const Camera& camera, const EvaluateOptions& options,
                      RobustnessOptions perturbed) {
  perturbed.trials = options.trials;
  perturbed.seed = options.seed;
  perturbed.method = options.method;
  perturbed.unwrap_weights = options.unwrap_weights;
  const ProgressParts parts(terminal_progress("perturbing"), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    evaluated[i].robustness = robustness(codes[i], camera, perturbed, parts[i]);
}

void write(const std::filesystem::path& path, const Session& session, const Camera& camera,
           const std::vector<CodeSet>& codes, const std::vector<EvaluatedCode>& evaluated,
           const EvaluateOptions& options) {
  std::string content;
  if (path.extension() == ".csv") {
    content = evaluation_csv(evaluated);
  } else if (path.extension() == ".json") {
    content = evaluation_document(camera, evaluated, options) + "\n";
  } else {
    content = render(evaluation_report(camera, codes, evaluated, session.command_line));
  }
  write_file_atomically(path, content, session.output_policy());
}

void run(EvaluateArguments& arguments, const Session& session) {
  const Camera camera = arguments.distance.at(arguments.camera.load(), session);
  if (arguments.on_bins) arguments.options.depth = DepthSampling::bins;
  arguments.options.method = arguments.method.method();
  arguments.options.unwrap_weights = arguments.method.unwrap_weights();
  arguments.options.validate();
  check_output(arguments.output, session);
  if (arguments.robustness && !arguments.perturb.empty())
    throw UsageError(
        "--robustness and --perturb cannot be combined; --perturb specifies the perturbations");
  std::optional<RobustnessOptions> perturbed;
  if (arguments.robustness) perturbed.emplace();
  if (!arguments.perturb.empty()) perturbed = parse_perturbations(arguments.perturb);
  if (perturbed)
    static_cast<void>(perturbations(camera, *perturbed));  // validates before long work
  const CodeFileOptions file_options = arguments.taps.file_for(arguments.codes);
  std::vector<CodeSet> codes;
  for (const std::string& name : arguments.codes)
    codes.push_back(load_camera_code(name, camera, file_options));
  std::vector<EvaluatedCode> evaluated = evaluate_all(codes, camera, arguments);
  if (perturbed) judge_robustness(evaluated, codes, camera, arguments.options, *perturbed);
  if (!arguments.output.empty())
    write(arguments.output, session, camera, codes, evaluated, arguments.options);
  print(session, camera, evaluated, arguments);
  for (const CodeSet& code : codes)
    if (const auto note = ambiguity_note(make_decoding_table(ForwardModel(code, camera), camera)))
      session.say(fmt::format("note: {}: {}", code.name(), *note));
  if (!arguments.output.empty()) session.say(fmt::format("wrote {}", arguments.output));
}

}  // namespace

void add_evaluate_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand(
      "evaluate",
      "evaluate the depth error of codes at all operating points of a camera, with lower bounds");
  command
      ->add_option("CODE", arguments->codes,
                   "families or code files (.code.json .npz .csv, or a pair LIGHT.npy,GATES.npy)")
      ->required();
  arguments->camera.add_to(*command);
  arguments->camera.add_key_option(*command, "sensor.decoder", "--decoder")->group(for_experts);
  arguments->camera.add_key_option(*command, "operating.velocity_m_per_s", "--velocity");
  arguments->camera.add_key_option(*command, "operating.interference.cameras", "--interference");
  const FieldOptions options(*command, arguments->options);
  options.add("trials");
  options.add("target_standard_error")->transform(share_or_percentage());
  options.add("max_trials")->group(for_experts);
  options.add("seed");
  arguments->method.add_to(*command);
  options.add("outlier_threshold_m", "--outlier-threshold")->group(for_experts);
  command
      ->add_flag(
          "--on-bins", arguments->on_bins,
          "true depths on bins only (underestimates errors; for comparison with other tools)")
      ->group(for_experts);
  options.add("sub_bin", "!--no-sub-bin")->group(for_experts);
  options.add("clip_to_open_sensor")->group(for_experts);
  command
      ->add_flag("--best-rotation", arguments->best_rotation,
                 "shift the depth origin of each code to minimize its linear error")
      ->group(for_experts);
  command->add_flag("--robustness", arguments->robustness,
                    "also evaluate each code on perturbed cameras: bandwidth ±20 %, peak power "
                    "±10 %, 50 ps edge jitter, 2 % tap mismatch");
  command->add_option(
      "--perturb", arguments->perturb,
      "also evaluate each code with each listed perturbation and with all of them together, "
      "such as jitter=50ps,clock=5ns,droop=3%; also bandwidth=20%, peak=10%, mismatch=2% "
      "(docs/calibration.md)");
  arguments->taps.add_to(*command);
  command->add_flag("--every-level", arguments->every_level,
                    "print a row for every light level, not only the mean, the best and the worst");
  arguments->distance.add_to(*command);
  command->add_option("-o,--output", arguments->output,
                      "write a table (.csv .json) or page (.html)");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
