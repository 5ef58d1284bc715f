// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Every reader of files under libFuzzer: bytes are read or refused, nothing else happens.
//   readers --reader=NAME [flags of libFuzzer] CORPUS     --reader=list names them
// scripts/fuzz.sh builds and runs it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/images/exr.hpp"
#include "io/images/pfm.hpp"
#include "io/images/raw_dump_reader.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/scene_toml.hpp"

namespace tofsmith {
namespace {

using Bytes = std::vector<std::byte>;

struct Reader {
  std::string name;
  std::function<void(std::span<const std::byte>)> read;
  std::vector<Bytes> seeds;
};

Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

CodeSet small_code(const std::string& family) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 24;
  return build_family(family, camera);
}

NpzArrays code_arrays() {
  const std::vector<double> wave = {0, 2, 0, 2};
  return {{"modfs", NpyArray::of<double>({4, 1}, wave)},
          {"demodfs", NpyArray(NpyType::float32, {4, 1})}};
}

std::vector<Reader> text_readers() {
  std::vector<Bytes> cameras, raw_formats;
  for (const std::string& name : built_in_camera_names())
    cameras.push_back(bytes_of(built_in_camera_toml(name)));
  for (const std::string& name : built_in_raw_format_names())
    raw_formats.push_back(bytes_of(built_in_raw_format_toml(name)));
  return {
      {"camera-toml", [](auto bytes) { parse_camera_toml(text_of(bytes)); }, std::move(cameras)},
      {"scene-toml",
       [](auto bytes) { parse_scene_toml(text_of(bytes)); },
       {bytes_of("[view]\nwidth = 4\nheight = 3\nfield_of_view_deg = 60\n[[plane]]\n"
                 "point_m = [0, 0, 2]\nnormal = [0, 0, -1]\nalbedo = 0.5\n[[sphere]]\n"
                 "center_m = [0, 0, 1]\nradius_m = 0.2\n[[box]]\nmin_m = [0, 0, 1]\n"
                 "max_m = [1, 1, 2]\n")}},
      {"raw-toml", [](auto bytes) { parse_raw_format(text_of(bytes)); }, std::move(raw_formats)},
      {"code-json",
       [](auto bytes) { parse_code_json(text_of(bytes)); },
       {bytes_of(code_to_json(small_code("hamiltonian-k3"))),
        bytes_of(code_to_json(small_code("sinusoid-k3")))}},
      {"csv",
       [](auto bytes) { parse_csv(text_of(bytes), "a.csv"); },
       {bytes_of("a,b\n1,2.5\n\"x, y\",-3e9\n")}}};
}

std::vector<Reader> array_readers() {
  const std::vector<float> numbers = {1, 2, 3, 4, 5, 6};
  const auto array = NpyArray::of<float>({1, 2, 3}, numbers);
  return {{"npy",
           [](auto bytes) { parse_npy(bytes, "a.npy"); },
           {serialize_npy(array), serialize_npy(NpyArray(NpyType::uint16, {4}))}},
          {"npz",
           [](auto bytes) { parse_npz(bytes, "a.npz"); },
           {serialize_npz({{"raw", array}}),
            serialize_npz({{"raw", array}}, NpzCompression::deflated)}},
          {"code-npz",
           [](auto bytes) { parse_code_npz(bytes, "a.npz", {}); },
           {serialize_npz(code_arrays())}}};
}

std::vector<Reader> image_readers() {
  Image<float> image(2, 3);
  std::iota(image.pixels.begin(), image.pixels.end(), 0.5f);
  PngImage png;
  png.height = 2;
  png.width = 2;
  png.values = {0, 1, 2, 3};
  return {{"png", [](auto bytes) { parse_png(bytes, "a.png"); }, {serialize_png(png)}},
          {"pfm",
           [](auto bytes) { parse_pfm(bytes, "a.pfm"); },
           {bytes_of("Pf\n1 1\n-1\n\x01\x02\x03\x04")}},
          {"exr",
           [](auto bytes) { parse_exr(bytes, "a.exr"); },
           {serialize_exr({{"Y", image}}), serialize_exr({{"R", image}, {"G", image}})}}};
}

const char* const ply_square =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::vector<Reader> mesh_readers() {
  const auto mesh = [](const char* file) {
    return [file](std::span<const std::byte> bytes) { parse_mesh(bytes, file); };
  };
  PointCloud cloud;
  cloud.points_m = {{0, 0, 1}, {1, 0, 1}};
  cloud.scalars = {{"signal", {1, 2}}};
  return {{"obj",
           mesh("a.obj"),
           {bytes_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf -4 -2 -1 1\n")}},
          {"ply", mesh("a.ply"), {bytes_of(ply_square)}},
          {"stl",
           mesh("a.stl"),
           {bytes_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                     "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"),
            Bytes(84 + 50)}},
          {"points", [](auto bytes) { parse_ply(bytes, "a.ply"); }, {serialize_ply(cloud)}}};
}

/// A description of a dump up to a zero byte, and the dump.
void read_dump(std::span<const std::byte> bytes) {
  const auto end = std::ranges::find(bytes, std::byte{0});
  const auto text = static_cast<std::size_t>(end - bytes.begin());
  RawFormat format = parse_raw_format(text_of(bytes.first(text)));
  const std::span<const std::byte> dump = bytes.subspan(std::min(bytes.size(), text + 1));
  const RawDumpReader reader(dump, format);
  if (static_cast<double>(format.height) * format.width * format.measurements > 1e6) return;
  std::vector<double> numbers(static_cast<std::size_t>(format.height) *
                              static_cast<std::size_t>(format.width) *
                              static_cast<std::size_t>(format.output_measurements()));
  reader.read_rows(0, 0, format.height, numbers.data());
}

std::vector<Reader> all_readers() {
  Bytes dump = bytes_of("width = 4\nheight = 1\nmeasurements = 1\nbits = 12\npacking = \"mipi\"\n");
  dump.resize(dump.size() + 1 + 6);
  std::vector<Reader> all = {{"raw-dump", &read_dump, {dump}}};
  for (auto&& some : {text_readers(), array_readers(), image_readers(), mesh_readers()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

const Reader* chosen = nullptr;

/// Writes the seeds of a reader, which the library itself makes.
void write_seeds(const Reader& reader, const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  for (std::size_t i = 0; i < reader.seeds.size(); ++i)
    std::ofstream(directory / fmt::format("seed-{}", i), std::ios::binary)
        .write(reinterpret_cast<const char*>(reader.seeds[i].data()),
               static_cast<std::streamsize>(reader.seeds[i].size()));
}

}  // namespace
}  // namespace tofsmith

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace tofsmith;
  static const std::vector<Reader> readers = all_readers();
  for (int i = 1; i < *argc; ++i) {
    const std::string_view word = (*argv)[i];
    if (word == "--reader=list") {
      for (const Reader& reader : readers) fmt::print("{}\n", reader.name);
      std::exit(0);
    }
    if (word.starts_with("--reader="))
      for (const Reader& reader : readers)
        if (reader.name == word.substr(9)) chosen = &reader;
    if (word.starts_with("--seeds=") && chosen != nullptr) {
      write_seeds(*chosen, word.substr(8));
      std::exit(0);
    }
  }
  if (chosen != nullptr) return 0;
  fmt::print(stderr, "expected --reader=NAME, one of --reader=list\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tofsmith::chosen->read(std::as_bytes(std::span(data, size)));
  } catch (const tofsmith::IoError&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
