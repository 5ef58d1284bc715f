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
  std::string toml;              ///< right side of `key = ...`, on one line
  std::string text;              ///< same as `toml`, but strings are without quotes
  std::optional<double> number;  ///< value of an integer or of a finite float
  std::string place;             ///< location, for error messages
};

/// Settings that override keys of a file, in TOML syntax: "light.peak_factor=5", "exposure_s=[0.1,
/// 0.2]", "sensor.readout=difference" (a single word needs no quotes). "sensor.full_well_e="
/// removes the key. Settings are applied before any validation. If a key is set several times, the
/// last setting is used.
using Settings = std::span<const std::string>;

/// Reads a camera from TOML. Keys are the names of the fields; all except fundamental_frequency_hz
/// are optional. Light levels default to the levels of the paper, the name to the stem of the file.
/// An impulse response of kind "file" is read from a file relative to this one, see
/// read_impulse_response().
/// @param source_name  path, or name for error messages
/// @throws IoError "file:line:column: ..." (or "setting '...': ...") for invalid TOML, unknown keys
///         (with the most similar known key), wrong types, missing or contradictory keys, values
///         that are not finite, and violations of Camera::validate()
Camera parse_camera_toml(std::string_view text, std::string_view source_name = "camera.toml",
                         Settings settings = {});
/// @throws IoError as parse_camera_toml(), or if the file cannot be read
Camera read_camera_toml(const std::filesystem::path& path, Settings settings = {});

/// Returns a built-in camera or reads one from a file, with some keys overridden.
/// @throws IoError as read_camera_toml(), or if `name_or_path` is neither
Camera load_camera(const std::string& name_or_path, Settings settings = {});

/// Returns the camera with some keys overridden. @throws IoError as parse_camera_toml()
Camera with_settings(const Camera& camera, Settings settings);

/// Returns the descriptions of all keys of camera files, as they apply to the camera.
std::vector<KeyDescription> describe_camera_keys(const Camera& camera);
/// Returns the names of all keys of camera files.
std::vector<std::string> camera_keys();
/// Returns the descriptions as a JSON list, in the order of a camera file. Each entry has `key`
/// (the name), `part` (the table), `type`, `unit`, `help`, `range`, `condition`, `example` (of
/// required keys), `default` (null: none) and `words`.
std::string camera_keys_json();

/// Returns the camera as TOML with all defaults filled in, so that
/// parse_camera_toml(camera_to_toml(c)) == c.
/// @throws std::invalid_argument if the camera is invalid
std::string camera_to_toml(const Camera& camera);
/// Returns a lens as JSON on one line, with the keys of a camera file.
std::string lens_to_json(const Lens& lens);
/// Inverse of lens_to_json(). Checks the keys and their types, but not the values.
/// @throws IoError "lens:line:column: ..." for a missing or unknown key or a wrong type
Lens lens_from_json(const std::string& json);
/// Returns the rays of a lens's map (Lens::rays), or of the view if the lens has no map.
/// @throws IoError if the map cannot be read, has another shape or type, or contains a ray that
///         does not point forward
PixelRays rays_of(const std::optional<Lens>& lens, const PinholeView& view);
/// Returns a built-in camera as TOML, with the source of every value, or "assumed", as a comment:
/// parse_camera_toml(built_in_camera_toml(n)) == built_in_camera(n).
/// @throws std::invalid_argument for an unknown name, with the most similar known one
std::string built_in_camera_toml(const std::string& name);
/// Writes camera_to_toml(). @throws IoError as AtomicFile
void write_camera_toml(const std::filesystem::path& path, const Camera& camera,
                       OutputPolicy policy);
/// Returns the same document as JSON.
std::string camera_to_json(const Camera& camera);

}  // namespace tofsmith
