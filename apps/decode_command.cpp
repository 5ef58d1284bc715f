// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "decode_pipe.hpp"
#include "decode_report.hpp"
#include "device_arguments.hpp"
#include "filter_arguments.hpp"
#include "help_pages.hpp"
#include "method_arguments.hpp"
#include "multipath_arguments.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "table_arguments.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

namespace {

struct DecodeArguments {
  DecodeRequest request;
  std::vector<std::string> raw;
  std::string raw_format, offset_map, gain_map, code, output;
  CameraArguments camera;
  TapArguments taps;
  TableArguments table;
  MethodArguments method;
  MultipathArguments multipath;
  DeviceArguments device;
  FilterArguments filter;
  std::string stray_light, rays;
  std::vector<std::string> planes;
  DecodeOptions options;
  std::string kind = "radial";
  std::string layout = "interleaved";
  std::string mixed;
};

DecodeRequest request_of(const DecodeArguments& arguments, const Camera& camera,
                         const Session& session) {
  DecodeRequest request = arguments.request;
  request.raw.assign(arguments.raw.begin(), arguments.raw.end());
  request.layout = parse_raw_layout(arguments.layout);
  request.raw_format = arguments.raw_format;
  request.output = arguments.output;
  for (const std::string& plane : arguments.planes)
    request.outputs.push_back(parse_decoded_plane(plane));
  request.kind = parse_depth_kind(arguments.kind);
  request.lens = camera.lens;
  request.time_filter = arguments.filter.time_options();
  request.filter = arguments.filter.options();
  if (!arguments.mixed.empty()) request.mixed = parse_mixed_pixels(arguments.mixed);
  request.offset_map = arguments.offset_map;
  request.gain_map = arguments.gain_map;
  request.stray_light = arguments.stray_light;
  if (!arguments.rays.empty()) request.lens = Lens{.rays = arguments.rays};
  request.policy = session.output_policy();
  request.other_inputs = {arguments.code, arguments.camera.name};
  return request;
}

/// Decodes all frames; if it does not come to the end of several, says how far it came.
DecodedRecording decode_all(const DecodeRequest& request, const FrameBackend& backend,
                            Session& session) {
  DecodedRecording result;
  try {
    decode_recording(request, backend, terminal_progress("decoding"), result);
  } catch (const std::invalid_argument& error) {
    throw wrong_option(error);
  } catch (...) {
    session.tells_what_is_kept = result.frame_count > 1;
    if (session.tells_what_is_kept)
      fmt::print(stderr, "tofsmith: decoded {} of {} frames; {}\n", result.frames.size(),
                 result.frame_count,
                 request.stack           ? "with --stack nothing is kept unless all are decoded"
                 : result.frames.empty() ? "nothing is kept"
                                         : "their files are kept");
    throw;
  }
  return result;
}

/// Whether frames come from standard input and go to standard output.
bool reads_pipe(const DecodeArguments& arguments) {
  const bool from_pipe = std::ranges::find(arguments.raw, pipe_word) != arguments.raw.end();
  const bool to_pipe = arguments.output == pipe_word;
  if (from_pipe && arguments.raw.size() > 1) throw UsageError("RAW -: expected it alone, or files");
  if (from_pipe != to_pipe)
    throw UsageError(
        fmt::format("{}: expected RAW - together with -o -: frames from standard input, planes to "
                    "standard output",
                    from_pipe ? "RAW -" : "-o -"));
  if (from_pipe && arguments.raw_format.empty())
    throw UsageError("RAW -: --raw-format is needed, a file that says how frames run");
  return from_pipe;
}

void run(DecodeArguments& arguments, Session& session) {
  reads_pipe(arguments);  // wrong usage comes before what files hold
  const std::optional<std::string> camera_source =
      arguments.camera.take_that_of(arguments.raw.front());
  const Camera camera = arguments.camera.load();
  const DecodingSource source =
      arguments.table.load(arguments.code, camera, arguments.camera.is_default(), arguments.taps);
  const std::unique_ptr<FrameBackend> backend = arguments.device.backend(
      make_decoder(arguments.method.method(), source.table, arguments.options,
                   arguments.method.unwrap_weights(), arguments.multipath.options()));
  const DecodeRequest request = request_of(arguments, camera, session);
  if (reads_pipe(arguments)) {
    for (const std::string& note : source.notes) fmt::print(stderr, "{}\n", note);
    return decode_pipe(request, *backend, session);
  }
  const DecodedRecording result = decode_all(request, *backend, session);
  std::vector<std::string> notes = source.notes;
  notes.insert(notes.end(), result.notes.begin(), result.notes.end());

  nlohmann::ordered_json document = {
      {"code", source.name},
      {"camera", camera.name},
      {"camera_source", camera_source.value_or(arguments.camera.name)},
      {"range_m", source.table.range_m},
      {"range_source", source.range_source},
      {"method", name_of(arguments.method.method())},
      {"device", backend->device()},
      {"average", request.average},
      {"averaged", request.averaged},
      {"hdr", request.hdr},
      {"time_filter", request.time_filter ? nlohmann::ordered_json(request.time_filter->max_frames)
                                          : nlohmann::ordered_json("off")},
      {"look_ahead", request.time_filter ? request.time_filter->look_ahead : 0},
      {"filter", arguments.filter.name()},
      {"mixed", request.mixed ? name_of(*request.mixed) : "off"},
      {"undistort", request.undistort},
      {"height", result.height},
      {"width", result.width},
      {"measurements", result.measurements}};
  if (session.json) add_decode_summary(request, result, document);
  document["notes"] = notes;
  session.print_json(document);
  std::string lines = decode_lines(request, result);
  if (backend->device() != "cpu") lines += "\ndevice " + backend->device();
  if (source.tell_range)
    lines += fmt::format("\nrange {:.4g} m ({})", source.table.range_m, source.range_source);
  if (camera_source) lines += "\ncamera " + *camera_source;
  for (const std::string& note : notes) lines += "\n" + note;
  if (!request.lens && (holds_points(request.output) || request.kind == DepthKind::z))
    lines += "\nthe camera has no [lens]: its view was taken to be 60 degrees wide";
  session.say(lines);
}

std::vector<std::string> mixed_words() {
  std::vector<std::string> words;
  for (const MixedPixels mixed : all_mixed_pixels) words.emplace_back(name_of(mixed));
  return words;
}

std::vector<std::string> all_plane_names() {
  std::vector<std::string> names;
  for (const DecodedPlane plane : all_decoded_planes) names.emplace_back(name_of(plane));
  return names;
}

/// Options of the recording and its code.
void add_recording_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option(
          "RAW", arguments.raw,
          "raw frames (.npy .npz .h5): (H,W,K) or (F,H,W,K); any dump with --raw-format; or "
          "K files, one a measurement in their order, (H,W) or (F,H,W) each; or - for frames "
          "of --raw-format from standard input, with -o -")
      ->required();
  CLI::Option* const layout =
      command
          .add_option(
              "--layout", arguments.layout,
              "how RAW runs: interleaved, or planar for (K,H,W) and (F,K,H,W); never guessed")
          ->check(one_of({"interleaved", "planar"}))
          ->capture_default_str();
  CLI::Option* const dataset =
      command
          .add_option("--dataset", arguments.request.dataset,
                      "which array of an .npz, or data set of an .h5, RAW is (the one called "
                      "raw, or the only one)")
          ->group(for_experts);
  command
      .add_option("--raw-format", arguments.raw_format,
                  "RAW is a sensor's dump without header, as this .raw.toml file describes it "
                  "(docs/raw_formats.md)")
      ->excludes(layout)
      ->excludes(dataset);
  command
      .add_option(
          "--code", arguments.code,
          "the code that the camera used: a family or a file; or a measured table (.npz .npy .csv)")
      ->required();
}

/// Options of maps and stray light.
void add_map_options(CLI::App& command, DecodeArguments& arguments) {
  command.add_option("--offset-map", arguments.offset_map,
                     "how much too far each pixel decodes in metres (.npy .npz .exr .pfm), taken "
                     "off its depth; NaN marks a dead pixel");
  command
      .add_option("--offset-m", arguments.request.offset_m,
                  "how much too far every pixel decodes in metres, taken off its depth")
      ->capture_default_str()
      ->group(for_experts);
  command
      .add_option("--gain-map", arguments.gain_map,
                  "response of each pixel over that of a usual one, taken out of signal and "
                  "ambient; NaN marks a dead pixel")
      ->group(for_experts);
  command
      .add_option("--stray-light", arguments.stray_light,
                  "light that the lens scatters, of calibrate stray-light (.npy .npz .exr "
                  ".pfm), taken off the raw numbers before all else")
      ->group(for_experts);
}

/// Options of the planes to write.
void add_plane_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option(
          "--outputs", arguments.planes,
          "planes to write: depth,signal,ambient,confidence,deviation,status (by default as "
          "many as OUTPUT holds), bin, averaged (measurements added), residual (chi-square per "
          "degree of freedom); of two-return and tail also "
          "delay, ratio and returns (0 "
          "none, 1 single, 2 two, 3 unresolved); others are not computed")
      ->delimiter(',')
      ->check(one_of(all_plane_names()));
  command
      .add_option(
          "--kind", arguments.kind,
          "depth to write: radial distance, as the camera measures it, or z along the axis "
          "(what simulate and demo take a depth image for); .ply and .pcd hold points either way")
      ->check(one_of({"radial", "z"}))
      ->capture_default_str();
}

/// Options of the frames: which ones, and how they are combined.
void add_frame_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option("--mixed", arguments.mixed,
                  "find pixels at edges of depth that see two surfaces: label (status mixed, the "
                  "depth stays), snap (to the depth of the one that gives more light) or drop (no "
                  "depth) (off)")
      ->check(one_of(mixed_words()));
  command
      .add_option("--average", arguments.request.average,
                  "decode the means of so many consecutive frames; the last one is of those left")
      ->check(number_that(">= 1", [](double value) { return value >= 1.0; }))
      ->capture_default_str();
  command
      .add_option("--hdr", arguments.request.hdr,
                  "RAW holds groups of frames at these exposures over the shortest, which is the "
                  "camera's, such as 1,4,16: each group is decoded as one frame, of what is not "
                  "saturated, by its noise")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(for_experts);
  command
      .add_option("--averaged", arguments.request.averaged,
                  "RAW holds means of so many equal measurements already: their noise is so much "
                  "smaller")
      ->check(positive_number(1e9))
      ->capture_default_str()
      ->group(for_experts);
  command
      .add_option(
          "--frame", arguments.request.frame,
          "decode this frame only, counted from 0; with --average this mean; with --time-filter "
          "frames before it count in")
      ->check(number_from_0_on())
      ->group(for_experts);
}

/// Thresholds of the statuses.
void add_status_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option("--low-signal-sigma", arguments.options.low_signal_sigma,
                  "signals below this many standard deviations are marked low_signal")
      ->capture_default_str()
      ->group(for_experts);
  command
      .add_option("--min-confidence", arguments.options.min_confidence,
                  "pixels below are marked ambiguous")
      ->capture_default_str()
      ->group(for_experts);
  command
      .add_option("--false-alarm-rate", arguments.options.false_alarm_rate,
                  "share of consistent pixels that are marked inconsistent; 0: no pixel is")
      ->capture_default_str()
      ->group(for_experts);
  command
      .add_option("--model-error-percent", arguments.options.model_error_percent,
                  "error of the camera model, such as wiggling, that is not marked inconsistent, "
                  "in percent of the signal's part of the measurements; a larger one of the table "
                  "replaces it")
      ->capture_default_str()
      ->group(for_experts);
}

/// Options of the output.
void add_output_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option(
          "-o,--output", arguments.output,
          "depth: .npy .npz .exr .pfm .png (16 bits, mm) .ply .pcd; several frames get numbers; - "
          "writes the --outputs (depth) of each frame to standard output, as they are in "
          ".npy without its header")
      ->required();
  command
      .add_option("--rays", arguments.rays,
                  "rays of points and z as the maker gives them, in place of the camera's "
                  "[lens] (.npy): (H,W,2) of x/z and y/z, or (H,W,3) of directions")
      ->group(for_experts);
  command
      .add_flag("--all-points", arguments.request.all_points,
                "in .ply and .pcd also points of pixels that are not ok")
      ->group(for_experts);
  command
      .add_flag("--undistort", arguments.request.undistort,
                "planes without the distortion of the camera's lens: each pixel takes the values "
                "of the nearest one; those that the lens does not see are invalid")
      ->group(for_experts);
  command.add_flag("--stack", arguments.request.stack,
                   "all frames in one .npy, (F,H,W), written as they come; with --outputs each "
                   "plane but depth in a file of its own, NAME-PLANE.npy");
  command
      .add_option("--memory-mb", arguments.request.memory_mb,
                  "memory for frames under way [MB]; larger frames go in bands of rows. The "
                  "program itself takes some 50 MB more")
      ->check(positive_number(1e9))
      ->capture_default_str()
      ->group(for_experts);
}

}  // namespace

void add_decode_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand("decode", "depth from raw measurements");
  add_recording_options(*command, *arguments);
  arguments->camera.add_to(*command);
  arguments->camera.add_temperature_to(*command);
  arguments->taps.add_to(*command);
  arguments->table.add_to(*command);
  add_map_options(*command, *arguments);
  arguments->method.add_to(*command);
  arguments->multipath.add_to(*command);
  arguments->device.add_to(*command);
  add_plane_options(*command, *arguments);
  arguments->filter.add_to(*command);
  add_frame_options(*command, *arguments);
  add_status_options(*command, *arguments);
  add_output_options(*command, *arguments);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
