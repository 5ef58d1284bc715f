// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <set>

#include "core/shared/random.hpp"
#include "damaged_files.hpp"
#include "io/meshes/polygon_soup.hpp"
#include "sanitizers.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/point_cloud.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;
using testing::StartsWith;

TriangleMesh parse(std::string_view text, std::string_view file) {
  return parse_mesh(bytes_of(text), file);
}

std::string refusal(std::string_view text, std::string_view file) {
  return io_error_of([&] { parse(text, file); });
}

template <typename Value>
std::string raw(Value value, bool big_endian = false) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  if (big_endian) std::ranges::reverse(bytes);
  return bytes;
}

// A unit square of two triangles; four vertices after merging.
const std::string obj_square =
    "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/3/1\nf -4/-4/-1 -2/-2/-1 -1/-1/-1\n";

std::string ply_header(const std::string& format, int vertices = 4,
                       const std::string& type = "float") {
  return "ply\nformat " + format + " 1.0\ncomment a square\nelement vertex " +
         std::to_string(vertices) + "\nproperty " + type + " x\nproperty " + type +
         " y\nproperty " + type +
         " z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
}
const std::string ply_rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
const std::string ply_square = ply_header("ascii") + ply_rows;

/// The square with another last face.
std::string ply_ending(const std::string& face) {
  return ply_square.substr(0, ply_square.size() - std::string("3 0 2 3\n").size()) + face;
}

template <typename Number>
std::string ply_binary_square(const std::string& type, bool big_endian = false) {
  std::string text = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", 4, type);
  for (const int f : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})
    text += raw(static_cast<Number>(f), big_endian);
  for (const int i : {0, 1, 2, 0, 2, 3}) text += (i == 0 ? "\3" : "") + raw(i, big_endian);
  return text;
}

const std::string stl_square =
    "solid square\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid square\n";

std::string stl_binary_square() {
  std::string text(80, ' ');
  text += raw(std::uint32_t{2});
  for (const auto& corners : {std::array<float, 9>{0, 0, 0, 1, 0, 0, 1, 1, 0},
                              std::array<float, 9>{0, 0, 0, 1, 1, 0, 0, 1, 0}}) {
    for (const float f : {0.0f, 0.0f, 1.0f}) text += raw(f);
    for (const float f : corners) text += raw(f);
    text += std::string(2, '\0');
  }
  return text;
}

/// The result does not depend on the vertex order.
std::vector<Eigen::Vector3d> corners(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) points.push_back(mesh.vertices[index]);
  return points;
}

TEST(MeshFile, EveryFormatGivesTheSameSquare) {
  const TriangleMesh square = parse(obj_square, "a.obj");
  EXPECT_EQ(square.vertices.size(), 4u);
  EXPECT_EQ(square.triangles.size(), 2u);
  EXPECT_EQ(corners(square)[4], Eigen::Vector3d(1, 1, 0));
  for (const auto& [text, file] :
       {std::pair(ply_square, "a.ply"), std::pair(ply_binary_square<float>("float"), "b.PLY"),
        std::pair(ply_binary_square<float>("float", true), "c.ply"), std::pair(stl_square, "a.stl"),
        std::pair(stl_binary_square(), "b.stl")}) {
    const TriangleMesh mesh = parse(text, file);
    EXPECT_EQ(mesh.vertices.size(), 4u) << file;
    EXPECT_EQ(corners(mesh), corners(square)) << file;
    EXPECT_TRUE(mesh.texture_coordinates.empty()) << file;
  }
}

TEST(MeshFile, PlyVerticesMayHaveAnyNumberType) {
  const auto square = corners(parse(obj_square, "a.obj"));
  for (const std::string& text :
       {ply_binary_square<std::int8_t>("char"), ply_binary_square<std::uint8_t>("uint8"),
        ply_binary_square<std::int16_t>("short"), ply_binary_square<std::uint16_t>("ushort"),
        ply_binary_square<std::int32_t>("int32"), ply_binary_square<std::uint32_t>("uint"),
        ply_binary_square<float>("float32"), ply_binary_square<double>("double")})
    EXPECT_EQ(corners(parse(text, "a.ply")), square) << text.substr(0, 90);
}

TEST(MeshFile, TextureCoordinatesStayWithTheirVertices) {
  const TriangleMesh mesh = parse(obj_square, "a.obj");
  ASSERT_EQ(mesh.texture_coordinates.size(), mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_EQ(mesh.texture_coordinates[i], mesh.vertices[i].head<2>());
}

TEST(MeshFile, TextureCoordinatesOfSomeFacesOnlyAreIgnored) {
  const TriangleMesh mesh = parse(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\no a\nf 1/1 2/1 3/1\no b\nf 1 3 4\n", "a.obj");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_TRUE(mesh.texture_coordinates.empty());
}

TEST(MeshFile, PolygonsAreTriangulatedAndGroupsMerged) {
  const TriangleMesh mesh = parse(
      "o a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\n3 4\no b\nv 5 0 0\nf 1 2 5\n", "a.obj");
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.vertices.size(), 5u);
}

TEST(MeshFile, TinyMeshesKeepTheirVertices) {
  const TriangleMesh mesh = parse("v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(mesh.vertices.size(), 3u);
}

TEST(MeshFile, PlyTextureCoordinatesBelongToVertices) {
  const TriangleMesh mesh = parse(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty float s\nproperty float t\n"
      "element face 1\nproperty uchar flags\nproperty list uchar uint vertex_index\n"
      "end_header\n0 0 0 9 .25 0\n1 0 0 9 1 .5\n0 1 0 9 0 1\n7 3 0 1 2\n",
      "a.ply");
  ASSERT_EQ(mesh.texture_coordinates.size(), 3u);
  EXPECT_EQ(mesh.texture_coordinates[1], Eigen::Vector2d(1.0, 0.5));
}

TEST(MeshFile, NoOtherFileIsNeeded) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a.obj") << "mtllib /etc/passwd\nusemtl skin\n" << obj_square;
  EXPECT_EQ(read_mesh(directory / "a.obj").triangles.size(), 2u);
}

struct BadMesh {
  const char* file;
  std::string text;
  const char* message;
};

class MeshFileRefuses : public testing::TestWithParam<BadMesh> {};

TEST_P(MeshFileRefuses, WithPlaceAndWhatWasExpected) {
  const std::string message = refusal(GetParam().text, GetParam().file);
  EXPECT_THAT(message, StartsWith(GetParam().file));
  EXPECT_THAT(message, HasSubstr(GetParam().message));
}

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Obj, MeshFileRefuses,
    testing::Values(
        BadMesh{"a.obj", "", "empty file"},
        BadMesh{"a.obj", three, "found no faces; expected triangles or polygons"},
        BadMesh{"a.obj", std::string("mtllib 00\0a00000", 16), "found no faces"},
        BadMesh{"a.obj", three + "vt x\nf 1 2 3\n", "a.obj:4: found the coordinate 'x'"},
        BadMesh{"a.obj", "hello, this is a text and no mesh at all\n", "a.obj"},
        BadMesh{"a.obj", three + "f 1 2 4\n", "a.obj:4: found the vertex index 4; expected 1 to 3"},
        BadMesh{"a.obj", three + "f 0 1 2\n", "a.obj:4: found the vertex index 0"},
        BadMesh{"a.obj", three + "f -1 -2 -4\n", "a.obj:4: found the vertex index -4"},
        BadMesh{"a.obj", three + "f -9223372036854775808 1 2\n",
                "a.obj:4: found the vertex index -9223372036854775808"},
        BadMesh{"a.obj", three + "f 1 2 9999999999999999999999\n", "a.obj:4: found '9999"},
        BadMesh{"a.obj", three + "vt 0 0\nf 1/1 2/1 3/7\n",
                "a.obj:5: found the texture coordinate index 7; expected 1 to 1"},
        BadMesh{"a.obj", three + "f 1//1 2//1 3//1\n", "a.obj:4: found the normal index 1"},
        BadMesh{"a.obj", three + "f 1 2\n", "a.obj:4: found a face of 2 corners"},
        BadMesh{"a.obj", three + "f a b c\n", "a.obj:4: found 'a' in a face"},
        BadMesh{"a.obj", three + "f 1x 2 3\n", "a.obj:4: found '1x' in a face"},
        BadMesh{"a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "a.obj:1: found the coordinate 'nan'; expected a finite number"},
        BadMesh{"a.obj", "v 0 0 0\nv 1 1e99 0\nv 0 1 0\nf 1 2 3\n", "a.obj:2: found the coord"},
        BadMesh{"a.obj", "v +1 0 0\nv 1 +-1 0\nv 0 1 0\nf 1 2 3\n",
                "a.obj:2: found the coordinate '+-1'"},
        BadMesh{"a.obj", "v 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n",
                "a.obj:1: found a vertex of 2 numbers"},
        BadMesh{"a.fbx", three, "found the extension '.fbx'; expected one of .obj, .ply, .stl"},
        BadMesh{"mesh", three, "found no extension; expected one of .obj, .ply, .stl"}));

INSTANTIATE_TEST_SUITE_P(
    Ply, MeshFileRefuses,
    testing::Values(
        BadMesh{"a.ply", "", "empty file"}, BadMesh{"a.ply", "plx\n", "byte 0: expected 'ply'"},
        BadMesh{"a.ply", ply_ending("3 0 2 4\n"),
                "face 1: found the vertex index 4; expected 0 to 3"},
        BadMesh{"a.ply", ply_ending("3 0 2 -1\n"), "face 1: found the vertex index -1"},
        BadMesh{"a.ply", ply_ending("3 0 2 4294967296\n"), "found 4294967296 in a list of whole"},
        BadMesh{"a.ply", ply_ending("3 0 2 1.5\n"), "found 1.5 in a list of whole numbers"},
        BadMesh{"a.ply", ply_ending("3 0 2 nan\n"), "found nan in a list of whole numbers"},
        BadMesh{"a.ply", ply_header("ascii") + "0 0 0\nnan 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
                "vertex 1: found (nan, 0, 0); expected finite numbers"},
        BadMesh{"a.ply", ply_ending(""), "the file ends here; expected face"},
        BadMesh{"a.ply", ply_header("ascii") + "0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n",
                "found 2 values for one vertex; expected 3"},
        BadMesh{"a.ply", ply_ending("0\n"), "face 1: found 0 corners; expected 3 or more"},
        BadMesh{"a.ply", ply_header("ascii", 400000000) + ply_rows, "400000000 rows announced"},
        BadMesh{"a.ply", ply_header("ascii", 3) + ply_rows, "a.ply: byte "},
        BadMesh{"a.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "element vertex 9\nproperty float x\nend_header\n",
                "found a second element 'vertex'; expected each once"},
        BadMesh{"a.ply",
                "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                "property float y\nproperty float z\nproperty list uint float w\nend_header\n" +
                    std::string(12, '\0') + "\xff\xff\xff\x7f",
                "found a list of 2147483647 numbers, but the file has only 0 bytes more"},
        BadMesh{"a.ply",
                "ply\nformat ascii 1.0\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n3 0 1 2\n",
                "expected vertices with x, y and z"},
        BadMesh{"a.ply", ply_square + "3 0 1 2\n", "8 bytes more than the header announces"},
        BadMesh{"a.ply", ply_header("binary_little_endian") + ply_rows, "a.ply: byte "},
        BadMesh{"a.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                "property float z\nend_header\n0 0 0\n",
                "found no faces"}));

INSTANTIATE_TEST_SUITE_P(
    Stl, MeshFileRefuses,
    testing::Values(
        BadMesh{"a.stl", "", "empty file"}, BadMesh{"a.stl", "solid a\nendsolid a\n", "a.stl"},
        BadMesh{"a.stl", "nothing", "found 7 bytes; expected 'solid' or a header of 84 bytes"},
        BadMesh{"a.stl", stl_square.substr(0, stl_square.find("endsolid")),
                "the file ends here; expected endsolid"},
        BadMesh{"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n",
                "a.stl:5: found a loop of 1 corners; expected 3 or more"},
        BadMesh{"a.stl", "solid a\nouter loop\nvertex 0 0 0\nendfacet\n",
                "a.stl:4: found 'endfacet'; expected endloop"},
        BadMesh{"a.stl", "solid a\nvertex 0 0 q\n", "a.stl:2: found the coordinate 'q'"},
        BadMesh{"a.stl", "solid a\nvertex 0 +1 +-1\n", "a.stl:2: found the coordinate '+-1'"},
        BadMesh{"a.stl", "solid a\nfacets\n", "a.stl:2: found 'facets'; expected facet"},
        BadMesh{"a.stl", stl_binary_square() + "x",
                "found 185 bytes; expected 184 for the 2 triangles announced"},
        BadMesh{"a.stl",
                "solid a\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\n"
                "vertex 1 1 0\nendloop\nendfacet\nendsolid a\n",
                "found (nan, 0, 0)"}));

FileParser parser_for(const char* file) {
  return [file](std::span<const std::byte> bytes) { parse_mesh(bytes, file); };
}

TEST(MeshFile, TruncatedBinaryFilesAreRejected) {
  expect_truncations_refused(bytes_of(ply_binary_square<float>("float")), parser_for("a.ply"));
  expect_truncations_refused(bytes_of(stl_binary_square()), parser_for("a.stl"));
}

TEST(MeshFile, EveryPrefixOfATextIsReadOrRejected) {
  for (const auto& [text, file] : {std::pair(obj_square, "a.obj"), std::pair(ply_square, "a.ply"),
                                   std::pair(stl_square, "a.stl")})
    for (std::size_t length = 0; length < text.size(); ++length) {
      try {
        parse(text.substr(0, length), file);
      } catch (const IoError& error) {
        EXPECT_THAT(error.what(), StartsWith(file));
      }
    }
}

using Corners = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles cut(const Corners& corners) {
  Triangles triangles;
  cut_into_triangles(corners, triangles);
  return triangles;
}

Eigen::Vector3d at(const Corners& corners, std::size_t i) {
  const auto& p = corners[i % corners.size()];
  return {p[0], p[1], p[2]};
}

/// Twice the area, as a vector along the normal.
Eigen::Vector3d area_of(const Corners& corners) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) area += at(corners, i).cross(at(corners, i + 1));
  return area;
}

/// The star has concave corners and a random orientation.
Corners star(RandomStream& random, int count) {
  const Eigen::Quaterniond turned(
      Eigen::Vector4d(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized());
  Corners corners;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count, radius = 0.2 + random.uniform();
    const Eigen::Vector3d p =
        turned * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    corners.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return corners;
}

TEST(PolygonCutter, TrianglesCoverThePolygonOnceWithItsOrientation) {
  RandomStream random(5, 1);
  for (int round = 0; round < 300; ++round) {
    const Corners corners = star(random, 3 + round % 40);
    const Eigen::Vector3d whole = area_of(corners), normal = whole.normalized();
    const Triangles triangles = cut(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles) {
      const double area =
          normal.dot((at(corners, b) - at(corners, a)).cross(at(corners, c) - at(corners, a)));
      EXPECT_GE(area, -1e-6) << round;  // no triangle is flipped, so none overlaps another
      sum += area;
    }
    EXPECT_NEAR(sum, whole.norm(), 1e-5) << round;
  }
}

TEST(PolygonCutter, AFlatOrCrossedPolygonIsTriangulated) {
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).size(), 2u);
  EXPECT_EQ(cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).size(), 3u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
}

TEST(PolygonCutter, EveryCornerOfALongPolygonIsInATriangle) {
  RandomStream random(6, 1);
  const Corners corners = star(random, repetitions(100'000));
  std::set<std::uint32_t> used;
  for (const auto& triangle : cut(corners)) used.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(used.size(), corners.size());
}

PointCloud test_cloud() {
  PointCloud cloud;
  cloud.points_m = {{1.0f, -2.0f, 0.0f}};
  cloud.scalars = {{"intensity", {0.5f}}};
  cloud.colours = {{1, 2, 255}};
  return cloud;
}

TEST(PointCloud, TheFileFollowsTheFormat) {
  EXPECT_EQ(serialize_ply(test_cloud()),
            bytes_of(std::string("ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property float intensity\nproperty uchar red\n"
                                 "property uchar green\nproperty uchar blue\nend_header\n") +
                     std::string("\0\0\x80\x3f\0\0\0\xc0\0\0\0\0\0\0\0\x3f\1\2\xff", 19)));
}

TEST(PointCloud, RejectsWritingInvalidClouds) {
  PointCloud cloud = test_cloud();
  cloud.colours.push_back({3, 2, 1});
  EXPECT_THROW(serialize_ply(cloud), std::invalid_argument);
  for (const char* name : {"x", "red", "intensity", "two words", ""}) {
    cloud = test_cloud();
    cloud.scalars.push_back({name, {1.0f}});
    EXPECT_THROW(serialize_ply(cloud), std::invalid_argument) << name;
  }
  cloud = test_cloud();
  cloud.scalars[0].values.push_back(1.0f);
  EXPECT_THROW(serialize_ply(cloud), std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith
