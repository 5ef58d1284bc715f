// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Stored documents, and readers that open files by name: images of scenes and calibration tables.
#include <array>
#include <cmath>

#include "io/images/exr.hpp"
#include "io/images/netpbm.hpp"
#include "reader.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::fuzz {

namespace {

namespace fs = std::filesystem;

Camera small_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 24;
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e4};
  return camera;
}

/// A family's code, and one marked as designed.
DesignResult small_design(const Camera& camera, const DesignOptions& options) {
  DesignResult result;
  for (const char* name : {"hamiltonian-k3", "sinusoid-k3"}) {
    Candidate candidate{.code = build_family(name, camera), .method = "factorize"};
    candidate.error = evaluate(candidate.code, camera, {.trials = 16, .seed = options.seed});
    candidate.target = Eigen::MatrixXd::Zero(camera.samples, 3);
    candidate.per_measurement.resize(3);
    for (MeasurementReport& report : candidate.per_measurement) report.history.resize(2);
    candidate.search = SearchRecord{"candidates", "error", {{1, 2}}, true, "all were looked at"};
    result.candidates.push_back(std::move(candidate));
  }
  result.explanation = {"It won."};
  return result;
}

/// The directory is created once; inputs replace its documents.
const fs::path& design_directory() {
  static const fs::path directory = [] {
    const fs::path path = scratch_file("design");
    const DesignOptions options{.exposures = {3}, .trials = 16};
    const Camera camera = small_camera();
    DesignDirectory(path).write(camera, small_design(camera, options), options,
                                OutputPolicy::overwrite);
    return path;
  }();
  return directory;
}

/// Input: design.json up to a zero byte, then details.json.
void read_design(Input bytes) {
  const fs::path& directory = design_directory();
  write_bytes(directory / "design.json", take_up_to_zero(bytes));
  write_bytes(directory / "details.json", bytes);
  DesignDirectory(directory).read();
}

std::vector<Bytes> design_seeds() {
  Bytes both = bytes_of_file(design_directory() / "design.json");
  both.push_back(std::byte{0});
  const Bytes details = bytes_of_file(design_directory() / "details.json");
  both.insert(both.end(), details.begin(), details.end());
  return {both};
}

const fs::path& scene_directory() {
  static const fs::path directory = [] {
    const fs::path path = scratch_file("scene");
    SceneResult scene{.name = "small"};
    scene.truth.depth_m = Image<float>(2, 3, 1.5f);
    scene.truth.albedo = Image<float>(2, 3, 0.5f);
    scene.truth.cosine = Image<float>(2, 3, 1.0f);
    scene.view = view_of({}, 3, 2);
    SceneCapture capture{.light = "low", .point = {1e4, 1e3}};
    capture.decodings.push_back({.code = "sinusoid-k3", .depth_m = Image<float>(2, 3, 1.5f)});
    capture.decodings.front().filtered =
        FilteredSceneDecoding{Image<float>(2, 3, 1.5f), Image<float>(2, 3, 4.0f), {}};
    scene.captures = {capture};
    write_scene_result(path, scene, OutputPolicy::overwrite);
    return path;
  }();
  return directory;
}

void read_scene(Input bytes) {
  write_bytes(scene_directory() / "scene.json", bytes);
  read_scene_result(scene_directory());
}

constexpr std::array image_names = {"i.npy", "i.npz", "i.png", "i.exr", "i.pfm"};

/// The first byte selects the kind of file, the second the requested data.
void read_scene_image(Input bytes) {
  const std::string name = image_names[take_choice(bytes, image_names.size())];
  const std::size_t wanted = take_choice(bytes, 6);
  const fs::path path = scratch_file(name);
  write_bytes(path, bytes);
  if (wanted == 0) read_albedo(path);
  if (wanted == 1) read_ambient_scale(path);
  if (wanted == 2) read_depth(path);
  if (wanted == 3) read_reference_depth(path);
  if (wanted == 4) read_multipath_returns(path, 2, 3);
  if (wanted == 5)
    read_transients(path, 2, 3,
                    {.bin_s = 1e-10,
                     .origin = TransientOrigin::peak,
                     .background = TransientBackground::median});
}

std::vector<Bytes> scene_image_seeds() {
  const Image<float> image(2, 3, 0.5f);
  const auto array = NpyArray::of<float>({2, 3}, image.pixels);
  const auto histograms = NpyArray(NpyType::float32, {2, 3, 4});
  const std::array<Bytes, 5> files = {
      serialize_npy(array), serialize_npz({{"depth", array}}),
      serialize_png({.height = 2, .width = 3, .bit_depth = 16, .values = {0, 1, 2, 3, 4, 65535}}),
      serialize_exr({{"Y", image}}), bytes_of("Pf\n1 1\n-1\n\x01\x02\x03\x04")};
  std::vector<Bytes> all;
  for (std::size_t kind = 0; kind < files.size(); ++kind)
    for (std::size_t wanted = 0; wanted < 4; ++wanted)
      all.push_back(with_choice(kind, with_choice(wanted, files[kind])));
  all.push_back(with_choice(0, with_choice(5, serialize_npy(histograms))));
  // One more return in the first of six pixels.
  const std::vector<double> first = {0, 1, 1, 1, 1, 1, 1}, one = {0.5};
  all.push_back(
      with_choice(1, with_choice(4, serialize_npz({{"first", NpyArray::of<double>({7}, first)},
                                                   {"distance_m", NpyArray::of<double>({1}, one)},
                                                   {"ratio", NpyArray::of<double>({1}, one)}}))));
  return all;
}

constexpr std::array table_names = {"t.npz", "t.npy", "t.csv"};

/// The first byte selects the kind of file, the second the requested data.
void read_table(Input bytes) {
  const std::string name = table_names[take_choice(bytes, table_names.size())];
  const std::size_t wanted = take_choice(bytes, 4);
  const fs::path path = scratch_file(name);
  write_bytes(path, bytes);
  static const Camera camera = small_camera();
  if (wanted == 0) load_decoding_table(path.string(), camera);
  if (wanted == 1) read_measured_table(path, {.keep_end_point = true});
  if (wanted == 2) read_impulse_response(path, 1e-10);
  if (wanted == 3) read_correlation_functions(path);
}

std::vector<Bytes> table_seeds() {
  MeasuredTable table;
  table.correlation.resize(12, 3);
  for (Eigen::Index n = 0; n < 12; ++n)
    for (Eigen::Index k = 0; k < 3; ++k)
      table.correlation(n, k) = 2 + std::cos(2 * 3.14159265 * (n / 12.0 - k / 3.0));
  table.range_m = 10;
  const fs::path path = scratch_file("seed.npz");
  write_calibrated_table(path, table, OutputPolicy::overwrite);
  const std::vector<double> values(36, 0.5), response = {0, 1, 2, 1, 0, 0, 0, 0};
  std::vector<Bytes> all;
  for (std::size_t wanted : {0, 1, 3}) {
    all.push_back(with_choice(0, with_choice(wanted, bytes_of_file(path))));
    all.push_back(
        with_choice(1, with_choice(wanted, serialize_npy(NpyArray::of<double>({12, 3}, values)))));
  }
  all.push_back(with_choice(1, with_choice(2, serialize_npy(NpyArray::of<double>({8}, response)))));
  all.push_back(with_choice(
      2, with_choice(2, bytes_of("time_s,value\n0,0\n1e-10,1\n2e-10,2\n3e-10,1\n4e-10,0\n"))));
  return all;
}

}  // namespace

std::vector<Reader> document_readers() {
  return {{"design-json", &read_design, &design_seeds},
          {"scene-json", &read_scene,
           [] { return std::vector<Bytes>{bytes_of_file(scene_directory() / "scene.json")}; }},
          {"scene-image", &read_scene_image, &scene_image_seeds, Repair::png},
          {"table", &read_table, &table_seeds, Repair::zip}};
}

}  // namespace tofsmith::fuzz
