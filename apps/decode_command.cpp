// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "decode_output.hpp"
#include "decode_report.hpp"
#include "decode_stream.hpp"
#include "map_arguments.hpp"
#include "method_arguments.hpp"
#include "multipath_arguments.hpp"
#include "number_checks.hpp"
#include "one_of.hpp"
#include "scene_source.hpp"
#include "table_arguments.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/io/raw_frames_reader.hpp"

namespace tofsmith::apps {

namespace {

struct DecodeArguments {
  std::string raw, code, output;
  CameraArguments camera;
  TapArguments taps;
  TableArguments table;
  MapArguments maps;
  MethodArguments method;
  MultipathArguments multipath;
  std::vector<std::string> planes;  // empty: as many of the usual ones as the format holds
  DecodeOptions options;
  int frame = -1;
  std::string kind = "radial";
  std::string layout = "interleaved";
  std::string raw_format;
  bool stack = false;
  double memory_mb = 256;
};

void check_frame(const DecodeArguments& arguments, int frames) {
  if (arguments.frame >= frames)
    throw UsageError(fmt::format("--frame {}: {} holds {} frame{}, counted from 0", arguments.frame,
                                 arguments.raw, frames, frames == 1 ? "" : "s"));
}

/// The planes to write; every plane once.
std::vector<std::string> planes_to_write(const DecodeArguments& arguments) {
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  if (arguments.stack && extension != ".npy")
    throw UsageError(
        fmt::format("--stack: found the output {}; expected a .npy file", arguments.output));
  if (!arguments.method.is_multipath())
    for (const std::string& plane : arguments.planes)
      if (is_multipath_plane(plane))
        throw UsageError(fmt::format(
            "--outputs {}: found --method {}; expected two-return or tail, which alone fill it",
            plane, name_of(arguments.method.method())));
  const bool depth_only = extension == ".npy" || extension == ".pfm" || extension == ".png";
  if (arguments.planes.empty())
    return depth_only ? std::vector<std::string>{"depth"}
                      : plane_names(arguments.method.is_multipath());
  if (depth_only && !arguments.stack && arguments.planes != std::vector<std::string>{"depth"})
    throw UsageError(
        fmt::format("--outputs: a {} file holds depth only; .npz, .exr and .ply hold "
                    "other planes, and .npy does with --stack",
                    extension));
  std::vector<std::string> planes;
  for (const std::string& plane : arguments.planes)
    if (std::ranges::find(planes, plane) == planes.end()) planes.push_back(plane);
  return planes;
}

DecodeTarget target_of(const DecodeArguments& arguments, const Camera& camera,
                       const RawFramesReader& reader) {
  check_frame(arguments, reader.frames());
  const std::filesystem::path path = arguments.output;
  return {.path = path,
          .stack = arguments.stack,
          .planes = planes_to_write(arguments),
          .count_statuses =
              arguments.planes.empty() || std::ranges::count(arguments.planes, "status") > 0,
          .as_z = arguments.kind == "z" && path.extension() != ".ply",
          .first_frame = std::max(0, arguments.frame),
          .frames = arguments.frame < 0 ? reader.frames() : 1,
          .view = view_of(camera, reader.width(), reader.height())};
}

/// Whole numbers that nothing was said about.
std::optional<std::string> electrons_note(const RawFramesReader& reader,
                                          const DecodingTable& table) {
  if (!reader.holds_integers() || table.saturation_level ||
      (table.gain_e_per_raw.array() != 1.0).any() || (table.black_level.array() != 0.0).any())
    return std::nullopt;
  return "raw numbers are taken as electrons: no gain, black level or saturation is set (--set "
         "sensor.adc_bits=.. --set sensor.gain_e_per_dn=.. --set sensor.black_level_dn=..)";
}

/// Before any frame is decoded.
void check_range_fits(const std::filesystem::path& path, double range_m) {
  constexpr double largest_m = 65.535;
  if (path.extension() == ".png" && range_m > largest_m)
    throw IoError(path.string(),
                  fmt::format("found a range of {:.4g} m; expected at most {} m, all "
                              "that 16 bits of millimetres hold (write .npy, .exr "
                              "or .pfm)",
                              range_m, largest_m));
}

/// Not even --force may replace what is being read.
void check_inputs_are_kept(const DecodeArguments& arguments, const DecodeTarget& target) {
  const std::vector<std::string> inputs = {arguments.raw,         arguments.raw_format,
                                           arguments.code,        arguments.camera.name,
                                           arguments.maps.offset, arguments.maps.gain};
  for (const std::filesystem::path& path : target.paths()) check_not_input(path, inputs);
}

/// Decodes all frames; if it does not come to the end of several, says how far it came.
DecodeSummary decode_all(const RawFramesReader& reader, int rows, const DecodeRows& decode_rows,
                         DecodeOutput& output) {
  const DecodeTarget& target = output.target();
  DecodeSummary summary;
  try {
    decode_frames(reader, rows, decode_rows, output, terminal_progress("decoding"), summary);
  } catch (...) {
    if (target.frames > 1)
      fmt::print(stderr, "tofsmith: decoded {} of {} frames; {}\n", summary.frames.size(),
                 target.frames,
                 target.stack             ? "with --stack nothing is kept unless all are decoded"
                 : summary.frames.empty() ? "nothing is kept"
                                          : "their files are kept");
    throw;
  }
  return summary;
}

std::optional<RawFormat> described_format(const DecodeArguments& arguments) {
  if (arguments.raw_format.empty()) return std::nullopt;
  return read_raw_format(arguments.raw_format);
}

void run(const DecodeArguments& arguments, Session& session) {
  const Camera camera = arguments.camera.load();
  DecodingSource source =
      arguments.table.load(arguments.code, camera, arguments.camera.is_default(), arguments.taps);
  const AnyDecoder decoder =
      make_decoder(arguments.method.method(), source.table, arguments.options,
                   arguments.method.unwrap_weights(), arguments.multipath.options());
  const double memory_bytes = 1e6 * arguments.memory_mb;
  const RawFramesReader reader(arguments.raw,
                               {.measurements = source.table.measurements(),
                                .layout = parse_raw_layout(arguments.layout),
                                .largest_in_memory = static_cast<std::uint64_t>(memory_bytes),
                                .format = described_format(arguments)});
  if (const auto note = electrons_note(reader, source.table)) source.notes.push_back(*note);
  const PixelMaps maps = arguments.maps.load(reader.height(), reader.width());
  const DecodeRows decode_rows = [&](const RawView& raw, int first_row, const DecodedView& decoded,
                                     const Progress& progress) {
    std::visit([&](const auto& d) { d.decode(raw, decoded, progress); }, decoder);
    apply(maps, source.table.range_m, decoded,
          static_cast<std::size_t>(first_row) * static_cast<std::size_t>(raw.width),
          static_cast<std::size_t>(raw.pixels()));
  };
  const DecodeTarget target = target_of(arguments, camera, reader);
  check_inputs_are_kept(arguments, target);
  check_range_fits(target.path, source.table.range_m);
  DecodeOutput output(target, session);
  const int rows = rows_at_a_time(reader, target, memory_bytes);
  session.tells_what_is_kept = target.frames > 1;
  const DecodeSummary summary = decode_all(reader, rows, decode_rows, output);
  if (const auto note = no_depth_note(summary.total())) source.notes.push_back(*note);

  nlohmann::ordered_json document = {{"code", source.name},
                                     {"camera", camera.name},
                                     {"range_m", source.table.range_m},
                                     {"range_source", source.range_source},
                                     {"method", name_of(arguments.method.method())},
                                     {"height", reader.height()},
                                     {"width", reader.width()},
                                     {"measurements", reader.measurements()}};
  if (session.json) add_decode_summary(target, summary, document);
  document["notes"] = source.notes;
  session.print_json(document);
  std::string lines = decode_lines(target, summary);
  if (source.tell_range) lines += "\n" + source.range_line();
  for (const std::string& note : source.notes) lines += "\n" + note;
  if (!camera.lens && (target.path.extension() == ".ply" || arguments.kind == "z"))
    lines += "\nthe camera has no [lens]: its view was taken to be 60 degrees wide";
  session.say(lines);
}

}  // namespace

void add_decode_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand("decode", "depth from raw measurements");
  command
      ->add_option("RAW", arguments->raw,
                   "raw frames (.npy .npz): (H,W,K) or (F,H,W,K); any dump with --raw-format")
      ->required();
  CLI::Option* const layout =
      command
          ->add_option(
              "--layout", arguments->layout,
              "how RAW runs: interleaved, or planar for (K,H,W) and (F,K,H,W); never guessed")
          ->check(one_of({"interleaved", "planar"}))
          ->capture_default_str();
  command
      ->add_option("--raw-format", arguments->raw_format,
                   "RAW is a sensor's dump without header, as this .raw.toml file describes it "
                   "(docs/raw_formats.md)")
      ->excludes(layout);
  command
      ->add_option(
          "--code", arguments->code,
          "the code that was played: a family or a file; or a measured table (.npz .npy .csv)")
      ->required();
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  arguments->table.add_to(*command);
  arguments->maps.add_to(*command);
  arguments->method.add_to(*command);
  arguments->multipath.add_to(*command);
  command
      ->add_option(
          "--outputs", arguments->planes,
          "planes to write: depth,signal,ambient,confidence,deviation,status (by default as "
          "many as OUTPUT holds), bin; of two-return and tail also delay, ratio and returns (0 "
          "none, 1 single, 2 two, 3 unresolved); others are not computed")
      ->delimiter(',')
      ->check(one_of(all_plane_names()));
  command
      ->add_option(
          "--kind", arguments->kind,
          "depth to write: radial distance, as the camera measures it, or z along the axis "
          "(what simulate and demo take a depth image for); .ply holds points either way")
      ->check(one_of({"radial", "z"}))
      ->capture_default_str();
  command->add_option("--frame", arguments->frame, "decode this frame only, counted from 0")
      ->check(number_from_0_on());
  command
      ->add_option("--low-signal-sigma", arguments->options.low_signal_sigma,
                   "signals below this many standard deviations are marked low_signal")
      ->capture_default_str();
  command
      ->add_option("--minimum-confidence", arguments->options.minimum_confidence,
                   "pixels below are marked ambiguous")
      ->capture_default_str();
  command
      ->add_option("-o,--output", arguments->output,
                   "depth: .npy .npz .exr .pfm .png (16 bits, mm) .ply; several frames get numbers")
      ->required();
  command->add_flag("--stack", arguments->stack,
                    "all frames in one .npy, (F,H,W), written as they come; with --outputs each "
                    "plane but depth in a file of its own, NAME-PLANE.npy");
  command
      ->add_option("--memory-mb", arguments->memory_mb,
                   "memory for frames under way [MB]; larger frames go in bands of rows. The "
                   "program itself takes some 50 MB more")
      ->check(positive_number(1e9))
      ->capture_default_str();
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
