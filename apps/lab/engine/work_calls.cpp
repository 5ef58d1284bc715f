// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "work_calls.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/decode/frame_pipeline.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/simulate/scene_result.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

namespace tofsmith::lab {

namespace {

/// Quotes a word for a POSIX shell.
std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Returns `--set ...` for every changed key.
std::string settings_words(const CameraArguments& camera) {
  std::string words;
  for (const Change& change : camera.changes)
    words += " --set " + shell_word(change.key + "=" + change.value.value_or(""));
  return words;
}

template <typename Number>
std::string option(const char* name, const std::optional<Number>& number) {
  return number ? fmt::format(" {} {}", name, *number) : "";
}

std::string scene_commands(const SceneArguments& scene, const std::string& code,
                           const std::string& camera) {
  const std::string filter = scene.filter == "off" ? "" : " --filter " + shell_word(scene.filter);
  return fmt::format("tofsmith simulate {} --code {}{} --width {} --height {}",
                     shell_word(scene.scene), code, camera, scene.width, scene.rows()) +
         option("--signal", scene.signal) + option("--ambient", scene.ambient) +
         option("--seed", scene.seed) +
         fmt::format(" -o raw.npy\ntofsmith decode raw.npy --code {}{}{} -o depth.npy", code,
                     camera, filter);
}

/// Adds one number per operating point, (S, A).
template <typename Number>
void add_map(Answer& answer, std::string_view name, const DepthErrorReport& report,
             const OperatingRange& range, Number&& number) {
  std::vector<double> values;
  for (const PointDepthError& point : report.points) values.push_back(number(point));
  answer.add(name, std::move(values), {range.signal_e_per_s.size(), range.ambient_e_per_s.size()});
}

}  // namespace

Answer evaluate_answer(const CodeArguments& coded, const EvaluateOptions& options,
                       const Progress& progress) {
  const Camera camera = coded.camera.load();
  const CodeSet code = coded.code.load(camera);
  const std::array evaluated = {
      EvaluatedCode{evaluate(code, camera, options, progress), 0, {}, {}}};
  const DepthErrorReport& report = evaluated.front().error;

  Answer answer;
  answer["document"] = Json::parse(evaluation_document(camera, evaluated, options));
  const OperatingRange& range = camera.operating;
  answer.add("signal_e_per_s", range.signal_e_per_s, {range.signal_e_per_s.size()});
  answer.add("ambient_e_per_s", range.ambient_e_per_s, {range.ambient_e_per_s.size()});
  add_map(answer, "error_m", report, range, [&](const auto& p) { return p.of(range.error).value; });
  add_map(answer, "standard_error_m", report, range,
          [&](const auto& p) { return p.of(range.error).standard_error; });
  add_map(answer, "cramer_rao_mae_m", report, range,
          [](const auto& p) { return p.cramer_rao_mae_m; });
  add_map(answer, "receiver_bound_mae_m", report, range,
          [](const auto& p) { return p.receiver_bound_mae_m; });
  Json& notes = answer["notes"] = Json::array();
  if (const auto note = ambiguity_note(make_decoding_table(ForwardModel(code, camera), camera)))
    notes.push_back(*note);
  return answer;
}

Answer scene_answer(const CodeArguments& coded, const SceneArguments& arguments,
                    const Progress& progress) {
  const Camera camera = coded.camera.load();
  const CodeSet code = coded.code.load(camera);
  const int width = arguments.width, height = arguments.rows();
  std::optional<FilterOptions> filter_options;
  if (arguments.filter != "off")
    filter_options =
        FilterOptions::of(parse_word<FilterStrength>("filter strength", arguments.filter));
  CaptureOptions options;
  const OperatingPoint usual = capture_light(camera, options.reference_distance_m);
  options.signal_e_per_s = arguments.signal.value_or(usual.signal_e_per_s);
  options.ambient_e_per_s = arguments.ambient.value_or(usual.ambient_e_per_s);
  options.seed = arguments.seed.value_or(options.seed);
  options.validate();

  const ProgressParts parts(progress, {30.0, filter_options ? 70.0 : 10.0});
  const StagedScene scene = built_in_scene(arguments.scene, width, height);
  const StagedCapture captured = capture(scene, code, camera, options, {}, parts[0]);
  const auto backend = cpu_backend(
      std::make_unique<Decoder>(make_decoding_table(ForwardModel(code, camera), camera)));
  std::optional<Filter> filter;
  if (filter_options) filter.emplace(backend->decoder().table(), *filter_options);
  DepthImage decoded(height, width);
  const auto pipeline = backend->prepare(
      {.filter = filter ? &*filter : nullptr,
       .keeps_filtered = must_keep_filtered({}, DecodedView::of(decoded).planes())},
      height, width);
  pipeline->submit(view_of_frame(captured.raw, 0));
  decode_frame(*pipeline, {}, 0, height, DecodedView::of(decoded), parts[1]);
  const SceneImage& truth = captured.truth.front();
  const SceneError error = scene_error(decoded.depth_m, truth, camera, DepthErrorKind::circular);

  Answer answer;
  answer["scene"] = arguments.scene;
  answer["width"] = width;
  answer["height"] = height;
  answer["signal_e_per_s"] = options.signal_e_per_s;
  answer["ambient_e_per_s"] = options.ambient_e_per_s;
  answer["range_m"] = camera.range_m();
  answer["mean_error_m"] = error.mean_m;
  answer["median_error_m"] = error.median_m;
  answer["outlier_rate"] = error.outlier_rate;
  answer["outlier_threshold_m"] = error.outlier_threshold_m;
  answer["decoded_share"] = error.decoded_share;
  std::vector<std::uint8_t> status;
  double ok = 0.0;
  for (const PixelStatus s : decoded.status.pixels) {
    status.push_back(static_cast<std::uint8_t>(s));
    ok += s == PixelStatus::ok ? 1.0 : 0.0;
  }
  answer["ok_share"] = ok / static_cast<double>(status.size());
  Json& words = answer["status_words"] = Json::array();
  for (const PixelStatus s : all_pixel_statuses) words.push_back(name_of(s));
  const std::vector<std::size_t> shape = {static_cast<std::size_t>(height),
                                          static_cast<std::size_t>(width)};
  answer.add("status", std::move(status), shape);
  answer.add("depth_m", decoded.depth_m);
  answer.add("true_depth_m", wrapped_depth_m(truth, camera));
  answer.add("deviation_m",
             depth_difference_m(decoded.depth_m, truth, camera, DepthErrorKind::circular));
  answer.add("standard_deviation_m", decoded.deviation_m);
  return answer;
}

Answer design_answer(const CameraArguments& camera_arguments, const DesignArguments& arguments,
                     const DesignTrials& trials, const Progress& progress) {
  const Camera camera = camera_arguments.load();
  DesignOptions options;
  options.method = arguments.method.value_or(options.method);
  options = with_effort(std::move(options), arguments.effort.value_or(0.1));
  if (arguments.exposures) options.exposures = {*arguments.exposures};
  options.trials = trials.trials.value_or(options.trials);
  options.seed = trials.seed.value_or(options.seed);
  options.validate();
  const DesignResult result = design(camera, options, progress);
  const Candidate& winner = result.winner();

  Answer answer;
  answer["document"] = Json::parse(design_document(camera, result, options));
  answer["name"] = winner.code.name();
  answer["method"] = winner.method;
  answer["file"] = code_to_json(winner.code);
  answer["error_m"] = geometric_mean_error_m(winner.error, camera.operating.measure());
  answer["explanation"] = result.explanation;
  answer["left_out"] = result.left_out;
  return answer;
}

Answer command_answer(const CameraArguments& camera, const CommandArguments& arguments,
                      const SceneArguments& scene, const DesignArguments& design) {
  require(arguments.what.has_value(), "what", "nothing",
          fmt::format("expected {}", fmt::join(all_words<Command>, ", ")));
  const std::string name = arguments.camera_file.value_or(camera.built_in.value_or(""));
  const std::string settings = settings_words(camera);
  const std::string camera_words = (name.empty() ? "" : " --camera " + shell_word(name)) + settings;
  const std::string seed = option("--seed", arguments.seed);
  std::vector<std::string> codes = arguments.codes;
  for (std::string& code : codes) code = shell_word(code);
  const auto first_code = [&] {
    require(!codes.empty(), "codes", "[]", "expected a code");
    return codes.front();
  };
  std::string command;
  if (arguments.what == Command::camera) {
    command = "tofsmith cameras " +
              shell_word(name.empty() ? std::string(default_camera_name) : name) + settings;
  } else if (arguments.what == Command::codes) {
    command = "tofsmith codes " + first_code() + camera_words;
  } else if (arguments.what == Command::evaluate) {
    first_code();
    command = fmt::format("tofsmith evaluate {}{}", fmt::join(codes, " "), camera_words) +
              option("--trials", arguments.trials) + seed;
  } else if (arguments.what == Command::scene) {
    command = scene_commands(scene, first_code(), camera_words);
  } else if (arguments.what == Command::design) {
    command = "tofsmith design" + camera_words;
    if (design.method) command += fmt::format(" --method {}", name_of(*design.method));
    command += option("--exposures", design.exposures) + option("--effort", design.effort) + seed +
               " -o design";
  } else {
    command = fmt::format("tofsmith export {}{} -o waveforms.csv", first_code(), camera_words);
  }
  Answer answer;
  answer["command"] = command;
  return answer;
}

}  // namespace tofsmith::lab
