// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <numeric>

#include "io/documents/shared/lens_document.hpp"
#include "io/images/array_image.hpp"
#include "io/images/exr.hpp"
#include "io/images/netpbm.hpp"
#include "io/images/raw_dump_reader.hpp"
#include "reader.hpp"
#include "tiff_writer.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/scene_toml.hpp"

namespace tofsmith::fuzz {

namespace {

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

std::vector<Bytes> built_in(std::vector<std::string> (*names)(),
                            std::string (*toml)(const std::string&)) {
  std::vector<Bytes> all;
  for (const std::string& name : names()) all.push_back(bytes_of(toml(name)));
  return all;
}

/// Reads all values of a raw file, unless they are too many.
void read_all(Input dump, const RawFormat& format) {
  const RawDumpReader reader(dump, format);
  if (static_cast<double>(format.height) * format.width * format.measurements > 1e6) return;
  std::vector<double> numbers(static_cast<std::size_t>(format.height) *
                              static_cast<std::size_t>(format.width) *
                              static_cast<std::size_t>(format.output_measurements()));
  reader.read_rows(0, 0, format.output_height(), numbers.data());
}

/// Input: a raw-format description up to a zero byte, then the raw file.
void read_described_dump(Input bytes) {
  const Input text = take_up_to_zero(bytes);
  read_all(bytes, parse_raw_format(text_of(text)));
}

/// Input: fourteen bytes that define the packing, then the raw file, truncated or padded to its
/// size.
void read_packed_dump(Input bytes) {
  std::size_t at = 0;
  const auto next = [&](int values) {
    const int byte = at < bytes.size() ? static_cast<int>(bytes[at]) : 0;
    ++at;
    return byte % values;
  };
  RawFormat format;
  format.width = 1 + next(16);
  format.height = 1 + next(4);
  format.measurements = 1 + next(8);
  format.packing = static_cast<RawPacking>(next(4));
  format.bits = 1 + next(32);
  format.align = static_cast<RawAlignment>(next(2));
  format.byte_order = next(2) == 1 ? RawByteOrder::big : RawByteOrder::little;
  format.is_signed = next(2) == 1;
  format.layout = static_cast<RawOrder>(next(3));
  format.taps = next(2) == 1 ? RawTaps::subtract : RawTaps::keep;
  format.header_bytes = next(9);
  format.row_bytes = next(2) * 64;
  format.rotate_deg = 90 * next(4);
  format.negate_rows = static_cast<NegatedLines>(next(3));
  format.validate();
  const Input rest = bytes.subspan(std::min(at, bytes.size()));
  Bytes dump(rest.begin(), rest.end());
  dump.resize(static_cast<std::size_t>(format.header_bytes) + format.frame_bytes());
  read_all(dump, format);
}

const char* const opencv_yaml =
    "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nfisheye_model: 0\n"
    "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
    "   data: [ 5.2e+02, 0., 3.1e+02, 0., 5.2e+02, 2.4e+02, 0., 0., 1. ]\n"
    "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
    "   data: [ -2.8e-01, 9.5e-02, 1.2e-03, -4.0e-04, -1.1e-02 ]\n";
const char* const ros_yaml =
    "height: 240\nwidth: 320\ndistortion_model: rational_polynomial\n"
    "D: [0.42, -2.6, 0.0006, -0.0002, 1.5, 0.31, -2.4, 1.42]\n"
    "K: [225.0, 0.0, 160.5, 0.0, 226.0, 118.0, 0.0, 0.0, 1.0]\nbinning_x: 0\n"
    "roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}\n";
const char* const opencv_xml =
    "<?xml version=\"1.0\"?>\n<opencv_storage>\n<K><rows>3</rows><data>\n"
    "60. 0. 39.5 0. 61. 29.5 0. 0. 1.</data></K>\n<D>0 0 0 0 <!-- none --></D>\n</opencv_storage>";
const char* const kalibr_yaml =
    "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.1, 0.02, 0.001, -0.002]\n"
    "  distortion_model: radtan\n  intrinsics: [60, 61, 39.5, 29.5]\n  resolution: [80, 60]\n";
const char* const azure_kinect_json =
    "{\"CalibrationInformation\":{\"Cameras\":[{\"Intrinsics\":{\"ModelParameters\":"
    "[0.5,0.51,0.49,0.48,0.9,0.5,0.03,1.3,0.8,0.1,0,0,2e-4,-3e-4],\"ModelType\":\"BrownConrady\"},"
    "\"Location\":\"D0\",\"MetricRadius\":1.7,\"SensorHeight\":6,\"SensorWidth\":8}]}}";
const char* const scene_toml =
    "[view]\nwidth = 4\nheight = 3\nfield_of_view_deg = 60\n[[plane]]\n"
    "point_m = [0, 0, 2]\nnormal = [0, 0, -1]\nalbedo = 0.5\n[[sphere]]\n"
    "center_m = [0, 0, 1]\nradius_m = 0.2\n[[box]]\nmin_m = [0, 0, 1]\nmax_m = [1, 1, 2]\n";
const char* const atlas =
    "tofsmith atlas 1\ncode taps 1 exposures 3 peak 4 bandwidth 10 shortest 0 error linear "
    "linear_m 0.2 0.001 circular_m 0.1 0.0005\nlight 0 25000\ngate 0 50000\n"
    "light 0 25000\ngate 33333 83333\nlight 90000 115000\ngate 66667 116667\n";
const char* const ply_square =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::vector<Bytes> tiff_seeds() {
  const Bytes pixels(12, std::byte{7});
  std::vector<Bytes> all;
  for (const std::uint32_t scheme : {1U, 5U, 32773U}) {
    const Bytes packed = scheme == 5   ? pack_lzw(pixels)
                         : scheme == 1 ? pixels
                                       : Bytes{std::byte{0xf5}, std::byte{7}};
    const TiffWriter writer{
        .tags = {{256, {3}}, {257, {2}}, {258, {16}}, {259, {scheme}}, {317, {2}}},
        .blocks = {packed}};
    all.push_back(writer.file());
  }
  return all;
}

}  // namespace

std::vector<Reader> text_readers() {
  return {{"camera-toml", [](Input bytes) { parse_camera_toml(text_of(bytes)); },
           [] { return built_in(&built_in_camera_names, &built_in_camera_toml); }},
          {"scene-toml", [](Input bytes) { parse_scene_toml(text_of(bytes)); },
           seeds({bytes_of(scene_toml)})},
          {"raw-toml", [](Input bytes) { parse_raw_format(text_of(bytes)); },
           [] { return built_in(&built_in_raw_format_names, &built_in_raw_format_toml); }},
          {"lens", [](Input bytes) { parse_lens_calibration(text_of(bytes), "lens.yaml"); },
           seeds({bytes_of(opencv_yaml), bytes_of(ros_yaml), bytes_of(opencv_xml),
                  bytes_of(kalibr_yaml), bytes_of(azure_kinect_json)})},
          {"code-json", [](Input bytes) { parse_code_json(text_of(bytes)); },
           [] {
             return std::vector<Bytes>{bytes_of(code_to_json(small_code("hamiltonian-k3"))),
                                       bytes_of(code_to_json(small_code("sinusoid-k3")))};
           }},
          {"atlas", [](Input bytes) { parse_atlas(text_of(bytes)); }, seeds({bytes_of(atlas)})}};
}

std::vector<Reader> array_readers() {
  const std::vector<float> numbers = {1, 2, 3, 4, 5, 6};
  const auto array = NpyArray::of<float>({1, 2, 3}, numbers);
  Bytes described =
      bytes_of("width = 4\nheight = 1\nmeasurements = 1\nbits = 12\npacking = \"mipi\"\n");
  described.resize(described.size() + 1 + 6);
  return {
      {"raw-dump", &read_described_dump, seeds({described})},
      {"raw-packed", &read_packed_dump,
       seeds({Bytes(60), Bytes(60, std::byte{9}), Bytes(60, std::byte{31})})},
      {"npy", [](Input bytes) { parse_npy(bytes, "a.npy"); },
       seeds({serialize_npy(array), serialize_npy(NpyArray(NpyType::uint16, {4}))}), Repair::npy},
      {"npz", [](Input bytes) { parse_npz(bytes, "a.npz"); },
       seeds({serialize_npz({{"raw", array}}),
              serialize_npz({{"raw", array}}, NpzCompression::deflated)}),
       Repair::zip},
      {"code-npz", [](Input bytes) { parse_code_npz(bytes, "a.npz", {}); },
       seeds({serialize_npz(code_arrays())}), Repair::zip}};
}

std::vector<Reader> image_readers() {
  Image<float> image(2, 3);
  std::iota(image.pixels.begin(), image.pixels.end(), 0.5f);
  PngImage png{.height = 2, .width = 2, .values = {0, 1, 2, 3}};
  PngImage colour{.height = 1,
                  .width = 2,
                  .channels = 4,
                  .bit_depth = 16,
                  .values = {0, 1, 2, 3, 65535, 4, 5, 6}};
  return {{"png", [](Input bytes) { parse_png(bytes, "a.png"); },
           seeds({serialize_png(png), serialize_png(colour)}), Repair::png},
          {"pfm", [](Input bytes) { parse_pfm(bytes, "a.pfm"); },
           seeds({bytes_of("Pf\n1 1\n-1\n\x01\x02\x03\x04")})},
          {"pgm", [](Input bytes) { parse_pgm(bytes, "a.pgm"); },
           seeds({bytes_of("P5 2 1 255 ab"), bytes_of("P2 2 1 4095 7 8")})},
          {"tiff", [](Input bytes) { parse_tiff(bytes, "a.tiff"); }, &tiff_seeds},
          {"exr", [](Input bytes) { parse_exr(bytes, "a.exr"); },
           seeds({serialize_exr({{"Y", image}}), serialize_exr({{"R", image}, {"G", image}})})}};
}

std::vector<Reader> mesh_readers() {
  const auto mesh = [](const char* file) {
    return [file](Input bytes) { parse_mesh(bytes, file); };
  };
  return {{"obj", mesh("a.obj"),
           seeds({bytes_of(
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\nf -4 -2 -1 1\n")})},
          {"ply", mesh("a.ply"), seeds({bytes_of(ply_square)})},
          {"stl", mesh("a.stl"),
           seeds({bytes_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                           "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"),
                  Bytes(84 + 50)})}};
}

}  // namespace tofsmith::fuzz
