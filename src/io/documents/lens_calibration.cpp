// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/lens_calibration.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/shared/text_numbers.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// A calibration file, which knows its own name.
class CalibrationFile {
 public:
  CalibrationFile(std::string_view text, std::string_view name) : name_(name) {
    try {
      root_ = YAML::Load(std::string(text));
    } catch (const YAML::Exception& error) {
      throw IoError(place_of(error.mark), fmt::format("is no YAML: {}", error.msg));
    }
    if (!root_.IsMap())
      throw IoError(name_,
                    "found no keys; expected the YAML of a lens's calibration: "
                    "camera_matrix and distortion_coefficients, or K and D");
  }

  /// The value of the first of these keys that is there.
  YAML::Node find(std::initializer_list<const char*> keys) const {
    for (const char* key : keys)
      if (const YAML::Node value = root_[key]) return value;
    return YAML::Node(YAML::NodeType::Undefined);
  }

  /// The numbers of a list, or of the `data` of a matrix.
  std::vector<double> numbers(const YAML::Node& node, const std::string& key) const {
    const YAML::Node data = node.IsMap() ? node["data"] : node;
    if (!data || !data.IsSequence())
      fail(node, fmt::format("{}: expected a list of numbers, or a matrix with its data", key));
    std::vector<double> values;
    for (const YAML::Node& entry : data) values.push_back(number(entry, key));
    return values;
  }

  double number(const YAML::Node& node, const std::string& key) const {
    const std::optional<double> value = node.IsScalar() ? number_in(node.Scalar()) : std::nullopt;
    if (!value || !std::isfinite(*value))
      fail(node, fmt::format("{}: found {}; expected a finite number", key,
                             node.IsScalar() ? node.Scalar() : "no number"));
    return *value;
  }

  std::optional<int> whole(std::initializer_list<const char*> keys) const {
    const YAML::Node node = find(keys);
    if (!node) return std::nullopt;
    const double value = number(node, *keys.begin());
    constexpr double largest = 1e6;
    if (!(value >= 0.0 && value <= largest && value == std::floor(value)))
      fail(node, fmt::format("{}: found {}; expected a whole number from 0 to {}", *keys.begin(),
                             value, largest));
    return static_cast<int>(value);
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& problem) const {
    throw IoError(place_of(node.Mark()), problem);
  }
  [[noreturn]] void missing(const std::string& what) const {
    throw IoError(name_, fmt::format("found no {}", what));
  }

 private:
  std::string place_of(const YAML::Mark& mark) const {
    return mark.is_null() ? name_ : fmt::format("{}:{}:{}", name_, mark.line + 1, mark.column + 1);
  }

  std::string name_;
  YAML::Node root_;
};

void read_matrix(const CalibrationFile& file, Lens& lens) {
  const YAML::Node node = file.find({"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"});
  if (!node) file.missing("camera_matrix, or K; expected the nine numbers of a pinhole");
  const std::vector<double> k = file.numbers(node, "camera_matrix");
  if (k.size() != 9)
    file.fail(node, fmt::format("camera_matrix: found {} numbers; expected 9", k.size()));
  if (!(k[0] > 0.0 && k[4] > 0.0))
    file.fail(node, fmt::format("camera_matrix: found focal lengths {} and {}; expected them > 0",
                                k[0], k[4]));
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    file.fail(node, "camera_matrix: expected [fx 0 cx; 0 fy cy; 0 0 1]: pixels without skew");
  lens.fx_px = k[0], lens.cx_px = k[2], lens.fy_px = k[4], lens.cy_px = k[5];
}

/// What the file says of its model, if anything.
std::optional<DistortionModel> model_of(const CalibrationFile& file) {
  if (const YAML::Node node = file.find({"distortion_model"})) {
    const std::string word = node.IsScalar() ? node.Scalar() : "";
    if (word == "plumb_bob" || word == "rational_polynomial" || word == "opencv")
      return DistortionModel::opencv;
    if (word == "equidistant" || word == "fisheye") return DistortionModel::fisheye;
    if (!word.empty())
      file.fail(node, fmt::format("distortion_model: found {}; expected plumb_bob, "
                                  "rational_polynomial, equidistant or fisheye",
                                  word));
  }
  if (const auto is_fisheye = file.whole({"fisheye_model"}))
    return *is_fisheye > 0 ? DistortionModel::fisheye : DistortionModel::opencv;
  return std::nullopt;
}

void read_distortion(const CalibrationFile& file, std::optional<DistortionModel> model,
                     Lens& lens) {
  const YAML::Node node = file.find({"distortion_coefficients", "Distortion_Coefficients",
                                     "dist_coeffs", "distCoeffs", "D", "d"});
  if (!node) file.missing("distortion_coefficients, or D; expected OpenCV's numbers, 0 for none");
  LensDistortion distortion{model_of(file).value_or(model.value_or(DistortionModel::opencv)),
                            file.numbers(node, "distortion_coefficients")};
  std::vector<double>& c = distortion.coefficients;
  constexpr std::size_t with_tilt = 14;
  if (c.size() == with_tilt && distortion.model == DistortionModel::opencv) {
    if (c[12] != 0.0 || c[13] != 0.0)
      file.fail(node, fmt::format("distortion_coefficients: found a sensor tilted by {} and {}; "
                                  "expected the first twelve numbers alone, or 0 there",
                                  c[12], c[13]));
    c.resize(12);
  }
  const bool is_none = std::all_of(c.begin(), c.end(), [](double number) { return number == 0.0; });
  if (is_none && distortion.model == DistortionModel::opencv) return;
  try {
    distortion.validate("distortion_coefficients");
  } catch (const std::invalid_argument& error) {
    file.fail(node, error.what());
  }
  lens.distortion = std::move(distortion);
}

/// Pixels of calibrations are those of whole images.
void check_whole_images(const CalibrationFile& file) {
  for (const char* key : {"binning_x", "binning_y"})
    if (file.whole({key}).value_or(0) > 1)
      file.fail(file.find({key}),
                fmt::format("{}: expected at most 1: images that are not binned", key));
  const YAML::Node part = file.find({"roi"});
  if (!part || !part.IsMap()) return;
  for (const char* key : {"x_offset", "y_offset"})
    if (const YAML::Node offset = part[key]; offset && file.number(offset, key) != 0.0)
      file.fail(offset, fmt::format("roi.{}: expected 0: images that are not cut", key));
}

}  // namespace

Lens parse_lens_calibration(std::string_view text, std::string_view source_name,
                            std::optional<DistortionModel> model) {
  const CalibrationFile file(text, source_name);
  Lens lens;
  read_matrix(file, lens);
  read_distortion(file, model, lens);
  check_whole_images(file);
  lens.width_px = file.whole({"image_width", "image_Width", "width"});
  lens.height_px = file.whole({"image_height", "image_Height", "height"});
  // ROS writes 0 where it does not know.
  if (lens.width_px.value_or(0) == 0 || lens.height_px.value_or(0) == 0)
    lens.width_px = lens.height_px = std::nullopt;
  return lens;
}

Lens read_lens_calibration(const std::filesystem::path& path,
                           std::optional<DistortionModel> model) {
  return parse_lens_calibration(read_text_file(path, max_settings_file_bytes), path.string(),
                                model);
}

}  // namespace tofsmith
