// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "decode_pipe.hpp"
#include "decode_report.hpp"
#include "described_options.hpp"
#include "device_arguments.hpp"
#include "filter_arguments.hpp"
#include "help_pages.hpp"
#include "method_arguments.hpp"
#include "multipath_arguments.hpp"
#include "number_checks.hpp"
#include "recorded_with.hpp"
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
  std::string code, output;
  CameraArguments camera;
  TapArguments taps;
  TableArguments table;
  MethodArguments method;
  MultipathArguments multipath;
  DeviceArguments device;
  FilterArguments filter;
  std::string rays;
  DecodeOptions options;
};

DecodeRequest request_of(const DecodeArguments& arguments, const Camera& camera,
                         const Session& session) {
  DecodeRequest request = arguments.request;
  request.raw.assign(arguments.raw.begin(), arguments.raw.end());
  request.output = arguments.output;
  if (!request.view_deg) request.lens = camera.lens;
  request.time_filter = arguments.filter.time_options();
  request.filter = arguments.filter.options();
  if (!arguments.rays.empty()) request.lens = Lens{.rays = arguments.rays};
  request.policy = session.output_policy();
  request.other_inputs = {arguments.code, arguments.camera.name};
  return request;
}

/// Decodes all frames. If decoding of several frames fails, prints the number of decoded frames.
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
                 request.stack ? "with --stack, files are written only after all frames are decoded"
                 : result.frames.empty() ? "no files were written"
                                         : "their files are kept");
    throw;
  }
  return result;
}

/// Returns true if frames are read from standard input and written to standard output.
/// @throws UsageError for other uses of `-`
bool reads_pipe(const DecodeArguments& arguments) {
  const bool from_pipe = std::ranges::find(arguments.raw, pipe_word) != arguments.raw.end();
  const bool to_pipe = arguments.output == pipe_word;
  if (from_pipe && arguments.raw.size() > 1)
    throw UsageError("RAW -: cannot be combined with other input files");
  if (from_pipe != to_pipe)
    throw UsageError(
        fmt::format("{}: expected RAW - together with -o -: frames from standard input, planes to "
                    "standard output",
                    from_pipe ? "RAW -" : "-o -"));
  if (from_pipe && arguments.request.raw_format.empty())
    throw UsageError("RAW -: requires --raw-format, a file that describes the frames");
  return from_pipe;
}

void run(DecodeArguments& arguments, Session& session) {
  reads_pipe(arguments);  // reports wrong usage before errors in files
  const std::optional<std::string> camera_source =
      arguments.camera.take_that_of(arguments.raw.front());
  const bool has_recorded_code = arguments.code.empty();
  if (has_recorded_code) arguments.code = recorded_code(arguments.raw.front());
  const Camera camera = arguments.camera.load();
  const DecodingSource source =
      arguments.table.load(arguments.code, camera, arguments.camera.is_default(), arguments.taps);
  const std::unique_ptr<FrameBackend> backend = arguments.device.backend(
      make_decoder(arguments.method.method(), source.table, arguments.options,
                   arguments.method.unwrap_weights(), arguments.multipath.options()));
  DecodeRequest request = request_of(arguments, camera, session);
  request.order = source.order;
  if (reads_pipe(arguments)) {
    for (const std::string& note : source.notes) fmt::print(stderr, "{}\n", marked_note(note));
    return decode_pipe(request, *backend, session);
  }
  const DecodedRecording result = decode_all(request, *backend, session);
  std::vector<std::string> notes = recording_conflicts(arguments.raw.front(), arguments.code,
                                                       camera, arguments.taps.file_options());
  notes.insert(notes.end(), source.notes.begin(), source.notes.end());
  notes.insert(notes.end(), result.notes.begin(), result.notes.end());

  nlohmann::ordered_json document = {
      {"code", source.name},
      {"code_source", arguments.code},
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
  if (request.sliding) document["sliding"] = true;
  document["notes"] = notes;
  session.print_json(document);
  std::string lines = decode_lines(request, result);
  if (backend->device() != "cpu") lines += "\ndevice " + backend->device();
  if (source.tell_range)
    lines += fmt::format("\nrange {:.4g} m ({})", source.table.range_m, source.range_source);
  if (has_recorded_code)
    lines += fmt::format("\ncode {}, next to {} (--code overrides it)", arguments.code,
                         arguments.raw.front());
  if (camera_source) lines += "\ncamera " + *camera_source;
  for (const std::string& note : notes) lines += "\n" + marked_note(note);
  session.say(lines);
}

/// Options of the recording and its code.
void add_recording_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option(
          "RAW", arguments.raw,
          "raw measurements: one file (.npy .npz .h5) with (H,W,K) or (F,H,W,K), for F frames, H "
          "rows, W columns and K measurements per pixel; K files in the order of the measurements, "
          "with (H,W) or (F,H,W) or grey images (.png .tiff .pgm); files that --raw-format "
          "describes; or -: standard input, with --raw-format and -o -")
      ->required();
  const FieldOptions request(command, arguments.request);
  CLI::Option* const layout = request.add("layout", "--layout");
  CLI::Option* const dataset = request.add("dataset", "--dataset")->group(for_experts);
  request.add("raw_format", "--raw-format")->excludes(layout)->excludes(dataset);
  command.add_option("--code", arguments.code,
                     "code that the camera used: a family, a code file or a measured table "
                     "(.npz .npy .csv) (default: the .code.json next to the raw frames)");
}

/// Options of maps and stray light.
void add_map_options(const FieldOptions<DecodeRequest>& request) {
  request.add("offset_map", "--offset-map");
  request.add("offset_m", "--offset-m")->group(for_experts);
  request.add("gain_map", "--gain-map")->group(for_experts);
  request.add("stray_light", "--stray-light")->group(for_experts);
}

/// Options that select and combine frames.
void add_frame_options(const FieldOptions<DecodeRequest>& request) {
  request.add("min_depth_m", "--min-depth");
  request.add("max_depth_m", "--max-depth");
  request.add("mixed", "--mixed");
  request.add("average", "--average");
  request.add("hdr", "--hdr")->group(for_experts);
  request.add("averaged", "--averaged")->group(for_experts);
  request.add("sliding", "--sliding");
  request.add("frame", "--frame")->group(for_experts);
}

/// Thresholds of the statuses.
void add_status_options(const FieldOptions<DecodeOptions>& options) {
  options.add("low_signal_sigma", "--low-signal-sigma")->group(for_experts);
  options.add("min_confidence", "--min-confidence")->group(for_experts);
  options.add("false_alarm_rate", "--false-alarm-rate")->group(for_experts);
  options.add("model_error_percent", "--model-error-percent")->group(for_experts);
}

/// Options of the output.
void add_output_options(CLI::App& command, DecodeArguments& arguments) {
  command
      .add_option("-o,--output", arguments.output,
                  "depth file: .npy .npz .exr .pfm .png (16 bits, mm) .ply .pcd, numbered if "
                  "there are several frames; -: write the planes of each frame, by default only "
                  "depth, to standard output, as in a .npy file but without header")
      ->required();
  command
      .add_option("--rays", arguments.rays,
                  "ray of each pixel (.npy) for points and z, instead of the camera's [lens]: "
                  "(H,W,2) with x/z and y/z, or (H,W,3) with directions")
      ->group(for_experts);
  const FieldOptions request(command, arguments.request);
  request.add("all_points", "--all-points")->group(for_experts);
  request.add("view_deg", "--view-deg")->group(for_experts);
  request.add("undistort", "--undistort")->group(for_experts);
  request.add("stack", "--stack");
  request.add("memory_mb", "--memory-mb")->group(for_experts);
}

}  // namespace

void add_decode_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand("decode", "decode depth from raw measurements");
  add_recording_options(*command, *arguments);
  arguments->camera.add_to(*command);
  arguments->camera.add_key_option(*command, "sensor.decoder", "--decoder")->group(for_experts);
  arguments->camera.add_temperature_to(*command);
  arguments->taps.add_to(*command);
  arguments->table.add_to(*command);
  const FieldOptions request(*command, arguments->request);
  add_map_options(request);
  arguments->method.add_to(*command);
  arguments->multipath.add_to(*command);
  arguments->device.add_to(*command);
  request.add("outputs", "--outputs")->allow_extra_args();
  request.add("kind", "--kind");
  arguments->filter.add_to(*command);
  add_frame_options(request);
  add_status_options(FieldOptions(*command, arguments->options));
  add_output_options(*command, *arguments);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
