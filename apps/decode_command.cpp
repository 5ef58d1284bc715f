// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "depth_output.hpp"
#include "map_arguments.hpp"
#include "method_arguments.hpp"
#include "scene_source.hpp"
#include "table_arguments.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/io/raw_frames_file.hpp"

namespace tofsmith::apps {

namespace {

struct DecodeArguments {
  std::string raw, code, output;
  CameraArguments camera;
  TapArguments taps;
  TableArguments table;
  MapArguments maps;
  MethodArguments method;
  std::vector<std::string> planes = plane_names();
  DecodeOptions options;
  int frame = -1;
  std::string kind = "radial";
};

/// name.npz, frame 3 of 12 -> name-03.npz
std::filesystem::path frame_path(const std::filesystem::path& path, int frame, int frames) {
  if (frames == 1) return path;
  const std::size_t digits = std::to_string(frames - 1).size();
  std::filesystem::path numbered = path;
  numbered.replace_filename(
      fmt::format("{}-{:0{}}{}", path.stem().string(), frame, digits, path.extension().string()));
  return numbered;
}

void run(const DecodeArguments& arguments, const Session& session) {
  const Camera camera = arguments.camera.load();
  const DecodingSource source = arguments.table.load(arguments.code, camera, arguments.taps);
  const AnyDecoder decoder = make_decoder(arguments.method.method(), source.table,
                                          arguments.options, arguments.method.unwrap_weights());
  const RawFrames raw = read_raw_frames(arguments.raw, source.table.measurements());
  const PixelMaps maps = arguments.maps.load(raw.height, raw.width);
  if (arguments.frame >= raw.frames)
    throw UsageError(fmt::format("--frame {}: {} holds {} frame{}, counted from 0", arguments.frame,
                                 arguments.raw, raw.frames, raw.frames == 1 ? "" : "s"));
  const int first = std::max(0, arguments.frame);
  const int last = arguments.frame < 0 ? raw.frames : arguments.frame + 1;
  const PinholeView view = view_of(camera, raw.width, raw.height);
  const std::string extension = std::filesystem::path(arguments.output).extension().string();
  const bool depth_only = extension == ".npy" || extension == ".pfm" || extension == ".png";
  if (depth_only && arguments.planes != plane_names() &&
      arguments.planes != std::vector<std::string>{"depth"})
    throw UsageError(
        fmt::format("--outputs: a {} file holds depth only; .npz, .exr and .ply hold "
                    "other planes",
                    extension));
  for (int frame = first; frame < last; ++frame)
    check_decoded_output(frame_path(arguments.output, frame, last - first), session);
  const Progress progress = terminal_progress("decoding");
  nlohmann::ordered_json outputs = nlohmann::ordered_json::array();
  std::string lines;
  for (int frame = first; frame < last; ++frame) {
    const double count = last - first;
    const Progress part = part_of(progress, (frame - first) / count, (frame - first + 1) / count);
    DepthImage image =
        std::visit([&](const auto& d) { return d.decode(raw, frame, part); }, decoder);
    apply(maps, source.table.range_m, DecodedView::of(image), 0, image.status.size());
    const std::filesystem::path path = frame_path(arguments.output, frame, last - first);
    const bool as_z = arguments.kind == "z" && path.extension() != ".ply";
    if (as_z) image.depth_m = z_from_radial(image.depth_m, view);
    write_decoded(path, image, arguments.planes, view, session.output_policy());
    outputs.push_back(
        {{"frame", frame}, {"output", path.string()}, {"status", status_summary(image)}});
    lines += fmt::format("wrote {} ({}): {}\n", path.string(),
                         path.extension() == ".ply" ? "points"
                         : as_z                     ? "z-depth"
                                                    : "radial distance",
                         status_summary(image));
  }
  report(progress, 1.0, "done");
  session.print_json({{"code", source.name},
                      {"camera", camera.name},
                      {"method", name_of(arguments.method.method())},
                      {"height", raw.height},
                      {"width", raw.width},
                      {"measurements", raw.measurements},
                      {"frames", std::move(outputs)},
                      {"notes", source.notes}});
  for (const std::string& note : source.notes) lines += note + "\n";
  lines.pop_back();
  if (!camera.lens && (extension == ".ply" || arguments.kind == "z"))
    lines += "\nthe camera has no [lens]: its view was taken to be 60 degrees wide";
  session.say(lines);
}

}  // namespace

void add_decode_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DecodeArguments>();
  CLI::App* command = app.add_subcommand("decode", "depth from raw measurements");
  command->add_option("RAW", arguments->raw, "raw frames (.npy .npz): (H,W,K) or (F,H,W,K)")
      ->required();
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
  command
      ->add_option("--outputs", arguments->planes,
                   "planes to write: depth,signal,ambient,confidence,deviation,status")
      ->delimiter(',')
      ->check(CLI::IsMember(plane_names()));
  command
      ->add_option(
          "--kind", arguments->kind,
          "depth to write: radial distance, as the camera measures it, or z along the axis "
          "(what simulate and demo take a depth image for); .ply holds points either way")
      ->check(CLI::IsMember({"radial", "z"}))
      ->capture_default_str();
  command->add_option("--frame", arguments->frame, "decode this frame only, counted from 0")
      ->check(CLI::NonNegativeNumber);
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
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
