// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "decode_arguments.hpp"
#include "described_options.hpp"
#include "help_pages.hpp"
#include "method_arguments.hpp"
#include "recorded_with.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith::apps {

namespace {

constexpr std::size_t max_lines = 8, first_lines = 3, max_listed = 100'000;

std::string kind_of(const DecodeRequest& request) {
  if (holds_points(request.output)) return "points";
  return request.kind == DepthKind::z ? "z-depth" : "radial distance";
}

/// Returns a text such as "ok 76.10 %, low_signal 3.20 %"; "" without pixels.
std::string status_text(const StatusCounts& statuses) {
  const auto pixels = static_cast<double>(statuses.pixels());
  std::string text;
  for (const PixelStatus status : all_pixel_statuses) {
    const std::int64_t count = statuses.of(status);
    if (count > 0)
      text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name_of(status),
                          100.0 * static_cast<double>(count) / pixels);
  }
  return text;
}

/// Returns "text: status", or only the text if no pixels were counted.
std::string with_status(const std::string& text, const StatusCounts& statuses) {
  const std::string status = status_text(statuses);
  return status.empty() ? text : fmt::format("{}: {}", text, status);
}

std::string plural(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string frame_lines(const DecodeRequest& request, const DecodedRecording& result) {
  const std::size_t frames = result.frames.size();
  const std::size_t listed = frames <= max_lines ? frames : first_lines;
  std::string lines;
  for (std::size_t i = 0; i < listed; ++i)
    lines += with_status(fmt::format("wrote {} ({})", result.files[i].string(), kind_of(request)),
                         result.frames[i]) +
             "\n";
  if (listed < frames)
    lines += fmt::format("... and {} more, up to {}\n", frames - listed,
                         result.files[frames - 1].string());
  return lines;
}

std::string stack_lines(const DecodeRequest& request, const DecodedRecording& result) {
  std::string lines;
  for (std::size_t i = 0; i < result.files.size(); ++i) {
    const DecodedPlane plane = result.outputs[i];
    lines += fmt::format("wrote {} ({})\n", result.files[i].string(),
                         plane == DecodedPlane::depth ? kind_of(request) : name_of(plane));
  }
  return lines;
}

/// Returns a summary for the terminal: one line per frame (only the first ones if there are many),
/// and one with totals and rate.
std::string decode_lines(const DecodeRequest& request, const DecodedRecording& result) {
  return (request.stack ? stack_lines(request, result) : frame_lines(request, result)) +
         with_status(fmt::format("{} of {} x {} in {}, {} frames/s, {} Mpixel/s",
                                 plural(result.frames.size(), "frame"), result.height, result.width,
                                 time_text(result.seconds), rate_text(result.frames_per_s()),
                                 rate_text(result.megapixels_per_s())),
                     result.total());
}

/// Adds frames, files, status counts and rate to a document. The list of frames is omitted beyond
/// 100,000 frames.
void add_decode_summary(const DecodeRequest& request, const DecodedRecording& result,
                        nlohmann::ordered_json& document) {
  const auto add_status = [](nlohmann::ordered_json& to, const StatusCounts& statuses) {
    for (const PixelStatus status : all_pixel_statuses)
      if (statuses.of(status) > 0) to["status"][std::string(name_of(status))] = statuses.of(status);
  };
  document["frame_count"] = result.frames.size();
  if (result.frames.size() <= max_listed) {
    nlohmann::ordered_json& frames = document["frames"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
      nlohmann::ordered_json entry = {{"frame", result.first_frame + static_cast<int>(i)}};
      if (!request.stack) entry["output"] = result.files[i].string();
      add_status(entry, result.frames[i]);
      frames.push_back(std::move(entry));
    }
  }
  if (request.stack)
    for (std::size_t i = 0; i < result.files.size(); ++i)
      document["stack"][std::string(name_of(result.outputs[i]))] = result.files[i].string();
  add_status(document, result.total());
  document["seconds"] = result.seconds;
  document["frames_per_s"] = result.frames_per_s();
  document["megapixels_per_s"] = result.megapixels_per_s();
}

/// Value of RAW and OUTPUT that means standard input and output.
inline constexpr std::string_view pipe_word = "-";

/// Polls in short steps, so that Ctrl-C is handled while no input arrives.
std::size_t read_input(std::span<std::byte> into) {
  constexpr int step_ms = 100;
  std::size_t done = 0;
  while (done < into.size()) {
    if (interrupted()) throw Interrupted();
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, step_ms) <= 0) continue;
    const ssize_t count = ::read(STDIN_FILENO, into.data() + done, into.size() - done);
    if (count < 0 && errno != EINTR && errno != EAGAIN)
      throw IoError("standard input",
                    fmt::format("cannot read: {}", std::generic_category().message(errno)));
    if (count == 0) break;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return done;
}

void write_output(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR)
      throw IoError("standard output",
                    fmt::format("cannot write: {}", std::generic_category().message(errno)));
    if (count > 0) bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

/// Implements `decode - ... -o -`: decodes frames from standard input to standard output. Messages
/// go to standard error.
/// @throws UsageError as decode_all(); Interrupted, also while waiting for a frame
void decode_pipe(const DecodeRequest& request, const FrameBackend& backend, Session& session) {
  if (session.json)
    throw UsageError(
        "--json: standard output contains the frames of -o -; expected an output file");
  if (isatty(STDOUT_FILENO) != 0)
    throw UsageError("-o -: standard output is a terminal; expected a pipe or a file");
  // A large pipe buffer avoids transferring a frame in many small pieces. Failure is harmless.
  constexpr int pipe_bytes = 1 << 20;
  static_cast<void>(fcntl(STDIN_FILENO, F_SETPIPE_SZ, pipe_bytes));
  static_cast<void>(fcntl(STDOUT_FILENO, F_SETPIPE_SZ, pipe_bytes));
  DecodedStream result;
  const auto tell = [&] {
    fmt::print(stderr, "decoded {} frame{}{}\n", result.frames, result.frames == 1 ? "" : "s",
               result.seconds > 0.0
                   ? fmt::format(", {} frames/s as received",
                                 rate_text(static_cast<double>(result.frames) / result.seconds))
                   : "");
  };
  try {
    decode_stream(request, backend, read_input, write_output, terminal_progress("decoding"),
                  result);
  } catch (const std::invalid_argument& error) {
    throw wrong_option(error);
  } catch (...) {
    session.tells_what_is_kept = true;
    tell();
    throw;
  }
  tell();
}

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
  std::vector<std::string> notes =
      recording_conflicts(arguments.raw.front(), arguments.code, camera, arguments.taps.file);
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
  CLI::Option* const layout = request.add("layout");
  CLI::Option* const dataset = request.add("dataset")->group(for_experts);
  request.add("raw_format")->excludes(layout)->excludes(dataset);
  command.add_option("--code", arguments.code,
                     "code that the camera used: a family, a code file or a measured table "
                     "(.npz .npy .csv) (default: the .code.json next to the raw frames)");
}

/// Options of maps and stray light.
void add_map_options(const FieldOptions<DecodeRequest>& request) {
  request.add("offset_map");
  request.add("offset_m")->group(for_experts);
  request.add("gain_map")->group(for_experts);
  request.add("stray_light")->group(for_experts);
}

/// Options that select and combine frames.
void add_frame_options(const FieldOptions<DecodeRequest>& request) {
  request.add("min_depth_m", "--min-depth");
  request.add("max_depth_m", "--max-depth");
  request.add("mixed");
  request.add("average");
  request.add("hdr")->group(for_experts);
  request.add("averaged")->group(for_experts);
  request.add("sliding");
  request.add("frame")->group(for_experts);
}

/// Thresholds of the statuses.
void add_status_options(const FieldOptions<DecodeOptions>& options) {
  options.add("low_signal_sigma")->group(for_experts);
  options.add("min_confidence")->group(for_experts);
  options.add("false_alarm_rate")->group(for_experts);
  options.add("model_error_percent")->group(for_experts);
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
  request.add("all_points")->group(for_experts);
  request.add("view_deg")->group(for_experts);
  request.add("undistort")->group(for_experts);
  request.add("stack");
  request.add("memory_mb")->group(for_experts);
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
  request.add("outputs")->allow_extra_args();
  request.add("kind");
  arguments->filter.add_to(*command);
  add_frame_options(request);
  add_status_options(FieldOptions(*command, arguments->options));
  add_output_options(*command, *arguments);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
