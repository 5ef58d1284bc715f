// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The requests of tests/python/test_three_ways.py, written like a user of the C++ library. Files
// are written to the working directory: three_ways_cli REQUEST
#include <fmt/format.h>

#include <exception>
#include <functional>
#include <map>
#include <string>

#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/waveforms/write_export.hpp"

using namespace tofsmith;

namespace {

constexpr OutputPolicy policy = OutputPolicy::overwrite;

Camera small_camera() {
  const std::string setting = "samples=120";
  return load_camera("paper-10f0", {&setting, 1});
}

void codes() {
  const Camera camera = small_camera();
  write_code("code.json", load_code("hamiltonian-k4", camera), policy);
  write_code("code.npz", load_code("hamiltonian-k4", camera), policy);
}

void simulate() {
  const Camera camera = small_camera();
  const StagedScene scene = built_in_scene("table-top", 40, 30);
  const SceneImage image = ray_cast(scene.shapes, scene.view, scene.camera_to_world);
  const CodeSet code = load_code("hamiltonian-k4", camera);
  write_raw_frames("raw.npy",
                   capture(image, code, camera,
                           {.signal_e_per_s = 1e6, .ambient_e_per_s = 1e4, .seed = 5, .frames = 3}),
                   policy);
}

std::unique_ptr<FrameBackend> backend_of(DecodeMethod method, const std::string& code) {
  return cpu_backend(make_decoder(method, load_decoding_table(code, small_camera()).table));
}

void decode() {
  const std::unique_ptr<FrameBackend> backend = backend_of(DecodeMethod::zncc, "hamiltonian-k4");
  for (const char* output : {"d.npy", "d.npz", "d.exr", "d.pfm", "d.png", "d.ply", "d.pcd"})
    decode_recording({.raw = {"raw.npy"}, .output = output, .view_deg = 60.0, .policy = policy},
                     *backend);
  decode_recording({.raw = {"raw.npy"},
                    .output = "z.npz",
                    .outputs = {DecodedPlane::bin, DecodedPlane::depth, DecodedPlane::deviation},
                    .kind = DepthKind::z,
                    .view_deg = 60.0,
                    .frame = 1,
                    .policy = policy},
                   *backend);
  decode_recording({.raw = {"raw.npy"},
                    .output = "stack.npy",
                    .outputs = {DecodedPlane::depth, DecodedPlane::status},
                    .stack = true,
                    .offset_map = "offset.npy",
                    .gain_map = "gain.npy",
                    .memory_mb = 0.05,
                    .policy = policy},
                   *backend_of(DecodeMethod::ml, "hamiltonian-k4"));
  decode_recording({.raw = {"planar.npy"},
                    .layout = RawLayout::planar,
                    .output = "measured.npy",
                    .policy = policy},
                   *backend_of(DecodeMethod::zncc, "table.npy"));
  decode_recording(
      {.raw = {"dump.bin"}, .raw_format = "dump.raw.toml", .output = "dump.npz", .policy = policy},
      *backend);
  decode_recording({.raw = {"p0.npy", "p1.npy", "p2.npy", "p3.npy"},
                    .output = "phases.npz",
                    .averaged = 12.5,
                    .policy = policy},
                   *backend);
  FilterOptions options = FilterOptions::of(FilterStrength::strong);
  options.trusted_pixels = 8.0;
  decode_recording({.raw = {"raw.npy"},
                    .output = "filtered.npz",
                    .outputs = {DecodedPlane::depth, DecodedPlane::averaged},
                    .average = 2,
                    .filter = options,
                    .policy = policy},
                   *backend);
  decode_recording({.raw = {"raw.npy"},
                    .output = "added.npz",
                    .outputs = {DecodedPlane::depth, DecodedPlane::averaged},
                    .time_filter = TimeFilterOptions{.max_frames = 2, .max_difference_sigma = 4.0},
                    .policy = policy},
                   *backend);
  decode_recording({.raw = {"raw.npy"},
                    .output = "snapped.npz",
                    .outputs = {DecodedPlane::depth, DecodedPlane::status},
                    .mixed = MixedPixels::snap,
                    .policy = policy},
                   *backend);
}

void evaluate_codes() {
  const Camera camera = small_camera();
  const EvaluateOptions options{.trials = 500, .seed = 3};
  const EvaluatedCode evaluated{
      evaluate(load_code("hamiltonian-k4", camera), camera, options), 0, {}, {}};
  write_file_atomically("evaluation.json",
                        evaluation_document(camera, {&evaluated, 1}, options) + "\n", policy);
}

void design_codes() {
  const Camera camera = small_camera();
  DesignOptions options;
  options.method = DesignMethod::factorize;
  options.exposures = {3};
  options.trials = 1000;
  options = with_effort(options, 0.01);
  const DesignDirectory directory("design");
  directory.write(camera, design(camera, options, {}, directory.store(camera, options)), options,
                  policy);
}

void export_code() {
  const Camera camera = small_camera();
  ExportRequest request;
  request.policy = policy;
  request.options.format = "csv";
  request.options.samples = 60;
  for (const char* output : {"export", "one.csv"}) {
    request.output = output;
    write_export(load_code("square-k4", camera), camera, request);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, std::function<void()>> requests = {
      {"codes", codes},         {"simulate", simulate},
      {"decode", decode},       {"evaluate", evaluate_codes},
      {"design", design_codes}, {"export", export_code}};
  try {
    requests.at(argc == 2 ? argv[1] : "")();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
