// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "work_calls.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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

/// Returns the name of the built-in camera, or of the file to which the camera was saved.
std::string camera_name(const Request& request) {
  return request.has("camera_file") ? request.text("camera_file") : request.text("built_in", "");
}

/// Returns `--set ...` for every changed key.
std::string settings_words(const Request& request) {
  std::string words;
  for (const Change& change : request.changes())
    words += " --set " + shell_word(change.key + "=" + change.value.value_or(""));
  return words;
}

/// Returns `--camera X --set ...` for everything that differs from the defaults.
std::string camera_words(const Request& request) {
  const std::string name = camera_name(request);
  return (name.empty() ? "" : " --camera " + shell_word(name)) + settings_words(request);
}

std::string option(const Request& request, const char* argument, const char* name) {
  const std::optional<double> number = request.optional_number(argument);
  return number ? fmt::format(" {} {}", name, *number) : "";
}

std::string scene_commands(const Request& request, const std::string& code,
                           const std::string& camera) {
  std::string simulate = fmt::format("tofsmith simulate {} --code {}{}",
                                     shell_word(request.text("scene", "table-top")), code, camera);
  if (request.has("width")) {
    const auto width = request.integer("width", 8, 1024);
    simulate += fmt::format(" --width {} --height {}", width,
                            request.integer("height", 8, 1024, width * 3 / 4));
  }
  simulate += option(request, "signal", "--signal") + option(request, "ambient", "--ambient") +
              option(request, "seed", "--seed") + " -o raw.npy";
  std::string decode = fmt::format("tofsmith decode raw.npy --code {}{}", code, camera);
  if (const std::string filter = request.text("filter", "off"); filter != "off")
    decode += " --filter " + shell_word(filter);
  return simulate + "\n" + decode + " -o depth.npy";
}

constexpr std::int64_t max_seed = std::int64_t{1} << 53;  // larger integers are not exact in JSON

std::uint64_t seed_of(const Request& request) {
  return static_cast<std::uint64_t>(request.integer("seed", 0, max_seed, 1));
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

Answer evaluate_answer(const Request& request, const Progress& progress) {
  const Camera camera = request.camera();
  const CodeSet code = request.code(camera);
  EvaluateOptions options;
  options.trials = request.integer("trials", 2, 1'000'000'000, options.trials);
  options.seed = seed_of(request);
  options.validate();
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

Answer scene_answer(const Request& request, const Progress& progress) {
  const Camera camera = request.camera();
  const CodeSet code = request.code(camera);
  const std::string name = request.text("scene", built_in_scene_names().front());
  const int width = static_cast<int>(request.integer("width", 8, 1024, 160));
  const int height = static_cast<int>(request.integer("height", 8, 1024, width * 3 / 4));
  const std::string filter_word = request.text("filter", "off");
  std::optional<FilterOptions> filter_options;
  if (filter_word != "off")
    filter_options = FilterOptions::of(parse_word<FilterStrength>("filter strength", filter_word));
  CaptureOptions options;
  const OperatingPoint usual = capture_light(camera, options.reference_distance_m);
  options.signal_e_per_s = request.optional_number("signal").value_or(usual.signal_e_per_s);
  options.ambient_e_per_s = request.optional_number("ambient").value_or(usual.ambient_e_per_s);
  options.seed = seed_of(request);
  options.validate();

  const ProgressParts parts(progress, {30.0, filter_options ? 70.0 : 10.0});
  const StagedScene scene = built_in_scene(name, width, height);
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
  answer["scene"] = name;
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

Answer design_answer(const Request& request, const Progress& progress) {
  const Camera camera = request.camera();
  DesignOptions options;
  options.method = parse_word<DesignMethod>("method", request.text("method", "best"));
  const double effort = request.optional_number("effort").value_or(0.1);
  options = with_effort(std::move(options), effort);
  if (request.has("exposures"))
    options.exposures = {static_cast<int>(request.integer("exposures", 1, 8))};
  options.trials = static_cast<int>(request.integer("trials", 1000, 1'000'000, options.trials));
  options.seed = seed_of(request);
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

Answer command_answer(const Request& request) {
  const std::string what = request.text("what");
  const std::string camera = camera_words(request);
  std::vector<std::string> codes = request.texts("codes");
  for (std::string& code : codes) code = shell_word(code);
  const auto first_code = [&] {
    require(!codes.empty(), "codes", "[]", "expected a code");
    return codes.front();
  };
  std::string command;
  if (what == "camera") {
    const std::string name = camera_name(request);
    command = "tofsmith cameras " +
              shell_word(name.empty() ? std::string(default_camera_name) : name) +
              settings_words(request);
  } else if (what == "codes") {
    command = "tofsmith codes " + first_code() + camera;
  } else if (what == "evaluate") {
    first_code();
    command = fmt::format("tofsmith evaluate {}{}", fmt::join(codes, " "), camera) +
              option(request, "trials", "--trials") + option(request, "seed", "--seed");
  } else if (what == "scene") {
    command = scene_commands(request, first_code(), camera);
  } else if (what == "design") {
    command = "tofsmith design" + camera;
    if (request.has("method")) command += " --method " + shell_word(request.text("method"));
    command += option(request, "exposures", "--exposures") + option(request, "effort", "--effort") +
               option(request, "trials", "--trials") + option(request, "seed", "--seed") +
               " -o design";
  } else if (what == "export") {
    command = fmt::format("tofsmith export {}{} -o waveforms.csv", first_code(), camera);
  } else {
    reject("what", what, "expected camera, codes, evaluate, scene, design or export");
  }
  Answer answer;
  answer["command"] = command;
  return answer;
}

}  // namespace tofsmith::lab
