// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "commands.hpp"
#include "described_options.hpp"
#include "design_output.hpp"
#include "fresh_directory.hpp"
#include "scene_source.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {

namespace {

namespace fs = std::filesystem;

struct DemoArguments {
  CameraArguments camera;
  SceneSource scene{.scene = "table-top"};
  DesignOptions options;
  double effort = 1.0;
  std::string output = "tofsmith-demo";
};

/// Returns the light of the captures: the lowest, middle and highest signal of the camera's
/// operating points, with its middle ambient light.
std::vector<NamedLight> lights_of(const Camera& camera) {
  const OperatingPoint middle = camera.operating.middle();
  const auto [weakest, strongest] = std::ranges::minmax(camera.operating.signal_e_per_s);
  return {{"low", {weakest, middle.ambient_e_per_s}},
          {"medium", middle},
          {"high", {strongest, middle.ambient_e_per_s}}};
}

constexpr std::array depth_files = {"depth.npy", "depth.npz", "depth.exr", "depth.pfm",
                                    "depth.png"};

std::vector<CodeSet> codes_for_scene(const DesignResult& result) {
  std::vector<CodeSet> codes{result.winner().code};
  for (const char* name : {"sinusoid-k4", "multifrequency-k5"})
    if (const Candidate* c = result.find(name); c && c != &result.winner())
      codes.push_back(c->code);
  return codes;
}

SceneResult capture_scene(LoadedScene loaded, std::uint64_t seed, const Camera& camera,
                          const DesignResult& result, const Progress& progress) {
  SceneResult scene{.name = loaded.name, .truth = std::move(loaded.image), .view = loaded.view};
  scene.reference_distance_m = median_depth_m(scene.truth);
  capture_and_decode(scene, codes_for_scene(result), camera, lights_of(camera), seed,
                     FilterOptions{}, progress);
  return scene;
}

/// Writes the winner's raw frames and depth in every format, and all waveforms.
void write_products(const fs::path& directory, const SceneResult& scene, const Camera& camera,
                    const DesignResult& result, std::uint64_t seed, OutputPolicy policy) {
  const CodeSet& best = result.winner().code;
  const NamedLight light = lights_of(camera).back();
  const RawFrames raw = capture(scene.truth, best, camera,
                                {.signal_e_per_s = light.point.signal_e_per_s,
                                 .ambient_e_per_s = light.point.ambient_e_per_s,
                                 .reference_distance_m = scene.reference_distance_m,
                                 .seed = seed});
  const Decoder decoder(make_decoding_table(ForwardModel(best, camera), camera));
  const DepthImage image = decoder.decode(raw);
  write_raw_frames(directory / "raw.npy", raw, policy);
  for (const char* name : depth_files)
    write_decoded(directory / name, image, usual_planes(), scene.view, policy);
  write_decoded(directory / "points.ply", image, {DecodedPlane::signal, DecodedPlane::confidence},
                scene.view, policy);
  make_output_directory(directory / "waveforms");
  for (const Candidate& c : result.candidates) {
    const fs::path path = directory / "waveforms" / (file_name_of(c.code.name()) + ".csv");
    write_file_atomically(path, waveforms_to_csv(c.code, camera.fundamental_frequency_hz), policy);
  }
}

double scene_gain(const SceneCapture& capture, std::size_t other) {
  return capture.decodings[other].error.mean_m / capture.decodings[0].error.mean_m;
}

void print_summary(const Session& session, const fs::path& directory, const Camera& camera,
                   const DesignResult& result, const SceneResult& scene, double seconds) {
  const DepthErrorMeasure measure = camera.operating.measure();
  const Candidate& winner = result.winner();
  const double best_m = geometric_mean_error_m(winner.error, measure);
  session.say(fmt::format("winner on {}: {} ({} exposures)", camera.name, winner.code.name(),
                          winner.code.exposures()));
  session.say(fmt::format("  {} depth error {}, geometric mean over {} light levels (N = {})",
                          name_of(measure), length_text(best_m), winner.error.points.size(),
                          camera.samples));
  std::string gains;
  for (const char* name :
       {"sinusoid-k3", "sinusoid-k4", "square-k4", "multifrequency-k5", "pulsed-multifrequency-k5"})
    if (const Candidate* c = result.find(name); c && c != &winner)
      gains += fmt::format("{}{:.2f}x better than {}", gains.empty() ? "" : ", ",
                           geometric_mean_error_m(c->error, measure) / best_m, name);
  session.say("  " + gains);
  for (const SceneCapture& capture : scene.captures) {
    std::string line = fmt::format("scene {}, {} light: mean error {}", scene.name, capture.light,
                                   length_text(capture.decodings[0].error.mean_m));
    for (std::size_t i = 1; i < capture.decodings.size(); ++i)
      line += fmt::format(", {} with {} ({:.2f}x)", length_text(capture.decodings[i].error.mean_m),
                          capture.decodings[i].code, scene_gain(capture, i));
    if (const auto& filtered = capture.decodings[0].filtered)
      line += fmt::format("; filtered {}", length_text(filtered->error.mean_m));
    session.say(line);
  }
  if (const std::string remark = beyond_range_remark(scene_extent(scene.truth, camera));
      !remark.empty())
    session.say(remark);
  session.say(fmt::format("codes: {}, waveforms: {}", (directory / "codes").string(),
                          (directory / "waveforms").string()));
  session.say(fmt::format("depth: {} (.npz .exr .pfm .png), point cloud: {}",
                          (directory / "depth.npy").string(), (directory / "points.ply").string()));
  session.say(fmt::format("report: {}", (directory / "report.html").string()));
  session.say(fmt::format("done in {}", time_text(seconds)));
}

void run(const DemoArguments& arguments, const Session& session) {
  const auto begin = std::chrono::steady_clock::now();
  // 1. Load the camera and the scene, and prepare the directory.
  const Camera camera = arguments.camera.load();
  LoadedScene loaded = scene_of(arguments.scene, camera);
  const DesignOptions options = with_effort(arguments.options, arguments.effort);
  const FreshDirectory cleanup(arguments.output);
  const DesignDirectory directory(arguments.output);
  if (directory.holds_design() && !session.force)
    throw IoError((directory.path() / "design.json").string(),
                  "already exists; use --force to replace the finished demo, or another -o DIR");
  for (const char* name : {"camera.toml", "details.json", "report.html", "raw.npy", "points.ply"})
    if (fs::exists(directory.path() / name)) session.check_output(directory.path() / name);
  for (const char* name : depth_files)
    if (fs::exists(directory.path() / name)) session.check_output(directory.path() / name);
  const Progress progress = terminal_progress("demo");
  const ProgressParts parts(progress, {80, 15, 5});

  // 2. Design codes and compare them with the standard ones.
  const DesignResult result = design(camera, options, parts[0], directory.store(camera, options));

  // 3. Capture the scene at three light levels and decode it.
  const SceneResult scene =
      capture_scene(std::move(loaded), arguments.options.seed, camera, result, parts[1]);

  // 4. Write everything, the report last.
  const OutputPolicy policy = session.output_policy();
  write_scene_result(directory.path() / "scene", scene, policy);
  write_products(directory.path(), scene, camera, result, arguments.options.seed, policy);
  directory.write(camera, result, options, policy);
  write_report(session, directory.path(), policy);
  report(progress, 1.0, "done");
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  if (session.json)
    session.print_document(design_document(camera, result, options));
  else
    print_summary(session, directory.path(), camera, result, scene, seconds.count());
}

}  // namespace

void add_demo_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command = app.add_subcommand(
      "demo", "design and compare codes, simulate and decode a scene, write a report");
  arguments->camera.add_to(*command);
  command->add_option("-o,--output", arguments->output, "output directory")->capture_default_str();
  command->add_option("--depth", arguments->scene.scene, scene_help)->capture_default_str();
  add_scene_options(*command, arguments->scene);
  const FieldOptions options(*command, arguments->options);
  options.add("seed");
  options.add("trials");
  add_effort(*command, arguments->effort);
  command->callback([arguments, &session] {
    session.directory = arguments->output;
    run(*arguments, session);
  });
}

}  // namespace tofsmith::apps
