// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// Value of a TOML key.
struct SettingValue {
  std::string toml;  ///< right side of `key = ...`, on one line
  std::string text;
  std::optional<double> number;
  std::string place;
};

/// Settings that override keys of a file, in TOML syntax: "light.peak_factor=5", "exposure_s=[0.1,
/// 0.2]", "sensor.readout=difference" (a single word needs no quotes). "sensor.full_well_e="
/// removes the key. The last setting of a key is used.
using Settings = std::span<const std::string>;

/// Reads a camera from TOML, see docs/cameras.md. Files of impulse responses are relative to this
/// file.
/// @param source_name  path, or name for error messages
/// @throws IoError "file:line:column: ..." (or "setting '...': ...") for invalid TOML, keys or
///         values
Camera parse_camera_toml(std::string_view text, std::string_view source_name = "camera.toml",
                         Settings settings = {});
/// @throws IoError as parse_camera_toml(), or if the file cannot be read
Camera read_camera_toml(const std::filesystem::path& path, Settings settings = {});

/// Returns a built-in camera or reads a file.
/// @throws IoError as read_camera_toml(), or if `name_or_path` is neither
Camera load_camera(const std::string& name_or_path, Settings settings = {});

/// Returns the camera with some keys overridden. @throws IoError as parse_camera_toml()
Camera with_settings(const Camera& camera, Settings settings);

std::vector<KeyDescription> describe_camera_keys(const Camera& camera);
/// Returns the names of all keys of camera files.
std::vector<std::string> camera_keys();
/// Returns a camera key with the same last part, such as "sensor.taps" for "taps" or
/// "light.taps"; the -3 dB frequency of an impulse response for a bandwidth; "" for other keys.
std::string similar_camera_key(std::string_view key);
/// Returns the descriptions as a JSON list with the members `key`, `part` (table), `type`, `unit`,
/// `help`, `range`, `condition`, `example` (of required keys), `default` (null: none) and `words`.
std::string camera_keys_json();

/// Returns the camera as TOML with all defaults: parse_camera_toml(camera_to_toml(c)) == c.
/// @throws std::invalid_argument if the camera is invalid
std::string camera_to_toml(const Camera& camera);
/// Returns a calibrated camera as TOML without optional keys that equal their default, so that the
/// file contains no values that nobody specified. If it has the name of a built-in camera, values
/// of that camera have the comment "not measured".
std::string calibrated_camera_toml(const Camera& camera);
/// Returns a lens as JSON on one line, with the keys of a camera file.
std::string lens_to_json(const Lens& lens);
/// Inverse of lens_to_json(); does not check the values.
/// @throws IoError "lens: ..." for invalid JSON, or a wrong key or type
Lens lens_from_json(const std::string& json);
/// Returns the rays of Lens::rays, or of the view if the lens has no map.
/// @throws IoError if the map cannot be read, or has another shape or rays that do not point
///         forward
PixelRays rays_of(const std::optional<Lens>& lens, const PinholeView& view);
/// Returns a built-in camera as TOML, with the source of every value as a comment.
/// @throws std::invalid_argument for an unknown name
std::string built_in_camera_toml(const std::string& name);
/// Writes camera_to_toml(). @throws IoError as AtomicFile
void write_camera_toml(const std::filesystem::path& path, const Camera& camera,
                       OutputPolicy policy);
/// Returns the document of camera_to_toml() as JSON.
std::string camera_to_json(const Camera& camera);

}  // namespace tofsmith
