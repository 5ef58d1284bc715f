// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recordings/decode_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

/// Errors name the file of the map.
void load_map(const std::filesystem::path& path, const char* name, int height, int width,
              Image<float> PixelMaps::*map, PixelMaps& maps) {
  if (path.empty()) return;
  PixelMaps alone;
  alone.*map = read_float_image(path, name);
  try {
    alone.validate(height, width);
  } catch (const std::invalid_argument& error) {
    throw IoError(path.string(), error.what());
  }
  maps.*map = std::move(alone.*map);
}

bool has_blind_pixels(const Lens& lens) {
  return !lens.rays.empty() || (lens.distortion && lens.distortion->max_radius);
}

PixelMaps load_maps(const DecodeRequest& request, int height, int width) {
  PixelMaps maps;
  load_map(request.offset_map, "offset", height, width, &PixelMaps::delay_offset_m, maps);
  if (request.offset_m != 0.0) {
    require(std::isfinite(request.offset_m), "offset_m", request.offset_m, "must be finite");
    if (maps.delay_offset_m.empty()) maps.delay_offset_m = Image<float>(height, width, 0.0f);
    for (float& offset_m : maps.delay_offset_m.pixels)
      offset_m += static_cast<float>(request.offset_m);
  }
  if (request.lens && has_blind_pixels(*request.lens)) {
    if (maps.delay_offset_m.empty()) maps.delay_offset_m = Image<float>(height, width, 0.0f);
    const PixelRays rays = rays_of(request.lens, view_of(request.lens, width, height));
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        if (std::isnan(rays.radial_per_z(row, column)))
          maps.delay_offset_m(row, column) = std::numeric_limits<float>::quiet_NaN();
  }
  load_map(request.gain_map, "gain", height, width, &PixelMaps::gain, maps);
  return maps;
}

void check_sliding(const DecodeRequest& request) {
  constexpr const char* rule = "is not valid with sliding, which uses single exposures";
  require(request.average == 1, "average", request.average, rule);
  require(request.averaged == 1.0, "averaged", request.averaged, rule);
  require(request.hdr.empty(), "hdr", fmt::format("{} exposures", request.hdr.size()), rule);
  const int look_ahead = request.time_filter ? request.time_filter->look_ahead : 0;
  require(look_ahead == 0, "look_ahead", look_ahead,
          "is not valid with sliding, which decodes each window after its last exposure");
}

}  // namespace

void check_request(const DecodeRequest& request, const DepthDecoder& decoder) {
  const std::filesystem::path& output = request.output;
  check_fields(request);
  require(!request.raw.empty(), "raw", "no file", "must be one file, or one per measurement");
  if (!request.hdr.empty()) {
    check_exposures(request.hdr, "hdr");
    require(request.average == 1, "average", request.average, "cannot be combined with hdr");
  }
  if (request.sliding) check_sliding(request);
  depth_limits(decoder.table(), request.min_depth_m, request.max_depth_m);
  if (request.time_filter) request.time_filter->validate();
  if (request.filter) request.filter->validate();
  require(!request.undistort || request.lens, "undistort", "true",
          "requires a camera with [lens], whose distortion it removes");
  require(!request.undistort || request.lens->rays.empty(), "undistort", "true",
          "cannot be combined with a map of rays");
  require(
      request.lens || request.view_deg || !(holds_points(output) || request.kind == DepthKind::z),
      "view_deg", "none",
      "is required for points and z if the camera has no [lens]: expected an angle of view, such "
      "as 60");
  require(request.frame.value_or(0) >= 0, "frame", request.frame.value_or(0), "must be >= 0");
  require(!request.stack || output.extension() == ".npy", "stack", "true",
          fmt::format("is only valid with a .npy file; the output is {}", output.string()));
  for (const DecodedPlane plane : request.outputs) {
    require(description_of(plane).use != PlaneUse::of_returns || decoder.finds_returns(), "outputs",
            name_of(plane),
            fmt::format("is only valid with two-return or tail; the method is {}",
                        name_of(decoder.method())));
    require(plane == DecodedPlane::depth || !holds_depth_only(output) || request.stack, "outputs",
            name_of(plane),
            fmt::format("a {} file contains only depth; for other planes use .npz, .exr, .ply, or "
                        ".npy with --stack",
                        output.extension().string()));
  }
}

PinholeView view_of_frames(const DecodeRequest& request, const std::string& source, int width,
                           int height) {
  try {
    if (!request.lens && request.view_deg)
      return PinholeView::centred(width, height, *request.view_deg * std::numbers::pi / 180.0);
    PinholeView view = view_of(request.lens, width, height);
    if (request.lens) view.validate();
    return view;
  } catch (const InvalidArgument& error) {
    if (error.field() != "lens.distortion" && error.field() != "image size") throw;
    throw IoError(source,
                  fmt::format("found frames of {} x {} pixels; {}", height, width, error.what()));
  }
}

std::optional<Undistortion> undistortion_of(const DecodeRequest& request, const PinholeView& view) {
  if (!request.undistort || !view.distortion) return std::nullopt;
  return Undistortion(view);
}

std::vector<DecodedPlane> planes_to_write(const DecodeRequest& request,
                                          const DepthDecoder& decoder) {
  if (request.outputs.empty())
    return holds_depth_only(request.output) ? std::vector{DecodedPlane::depth}
                                            : usual_planes(decoder.finds_returns());
  std::vector<DecodedPlane> planes;
  for (const DecodedPlane plane : request.outputs)
    if (std::ranges::find(planes, plane) == planes.end()) planes.push_back(plane);
  return planes;
}

std::optional<Filter> filter_of(const DecodeRequest& request, const DecodingTable& table) {
  return request.filter ? std::optional<Filter>(std::in_place, table, *request.filter)
                        : std::nullopt;
}

int sliding_exposures(const DecodeRequest& request, const DecodingTable& table) {
  const int exposures = table.exposure_count();
  return request.sliding && exposures > 1 ? exposures : 0;
}

Preparation preparation_of(const DecodeRequest& request, const DecodingTable& table,
                           const std::optional<Filter>& filter) {
  const PlaneCorrections corrections{
      .mixed = request.mixed,
      .limits = depth_limits(table, request.min_depth_m, request.max_depth_m)};
  Preparation preparation{
      .steps = {.average = request.average,
                .averaged = request.averaged,
                .time_filter = request.time_filter,
                .filter = filter ? &*filter : nullptr,
                .keeps_filtered = must_keep_filtered(corrections, request.outputs)},
      .find_mixed = request.mixed.has_value(),
      .undistort = request.undistort,
      .hdr = request.hdr,
      .sliding = sliding_exposures(request, table)};
  if (preparation.steps.time_filter && filter) preparation.steps.time_filter->before_filter = true;
  if (!request.stray_light.empty())
    preparation.stray_kernel = read_stray_light(request.stray_light);
  return preparation;
}

PlaneCorrections corrections_of(const DecodeRequest& request, const DecodingTable& table,
                                const std::string& source, int height, int width) {
  PlaneCorrections corrections{load_maps(request, height, width), request.mixed,
                               depth_limits(table, request.min_depth_m, request.max_depth_m)};
  if (const auto& correction = table.correction)
    if (correction->height != height || correction->width != width)
      throw IoError(source, fmt::format("found frames of {} x {} pixels; expected {} x {}, the "
                                        "size of the table's depth correction",
                                        height, width, correction->height, correction->width));
  return corrections;
}

bool decode_next(PreparedFrames& input, const PlaneCorrections& corrections, const Band& band,
                 const DecodeTarget& target, DepthImage& planes, const Progress& progress) {
  const ProgressParts parts(progress, {input.effort(), input.decode_effort()});
  if (!input.next(band.frame, parts[0])) return false;
  const DecodedView decoded = DecodedView::of(planes).from(target.first_pixel(band));
  decode_frame(input.pipeline(), corrections, band.first_row, band.rows, decoded, parts[1]);
  if (target.as_z && decoded.depth_m)
    turn_into_z(decoded.depth_m, band.first_row, band.rows, target.pixel_rays);
  return true;
}

}  // namespace tofsmith
