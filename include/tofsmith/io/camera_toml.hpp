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

/// What a key of a TOML file can be set to.
struct SettingValue {
  std::string toml;              ///< as the right side of `key = ..`, on one line
  std::string text;              ///< the same without the quotes of a text
  std::optional<double> number;  ///< of an integer or a finite number
  std::string place;             ///< where it was written, as errors name it
};

/// Keys that replace those of a file, each as the file would say it: "light.peak_factor=5",
/// "exposure_s=[0.1, 0.2]", "sensor.readout=difference" (quotes around one word may be left out).
/// "sensor.full_well_e=" leaves the key out, as if the file did not have it. They are laid over the
/// file before anything is checked; the last one of a key counts.
using Settings = std::span<const std::string>;

/// Reads a camera from TOML. Keys are the names of the fields; all but fundamental_frequency_hz
/// may be left out. Light levels default to the paper's, the name to that of the file.
/// An impulse response of kind "file" names a file beside this one, see read_impulse_response().
/// @param source_name  path of the file, or what errors shall call it
/// @throws IoError "file:line:column: .." (or "setting '..': ..") for what is no TOML, unknown
///         keys (with the nearest known one), wrong types, missing and contradictory keys, values
///         that are not finite or break a rule of Camera::validate()
Camera parse_camera_toml(std::string_view text, std::string_view source_name = "camera.toml",
                         Settings settings = {});
/// @throws IoError as parse_camera_toml(), or if the file cannot be read
Camera read_camera_toml(const std::filesystem::path& path, Settings settings = {});

/// A built-in camera or a file, with some keys replaced.
/// @throws IoError as read_camera_toml(), or if `name_or_path` is neither
Camera load_camera(const std::string& name_or_path, Settings settings = {});

/// The camera with some keys replaced. @throws IoError as parse_camera_toml()
Camera with_settings(const Camera& camera, Settings settings);

/// Descriptions of all keys that a camera file can contain, each as it applies to the camera.
std::vector<KeyDescription> describe_camera_keys(const Camera& camera);
/// Names of all keys that a camera file can contain.
std::vector<std::string> camera_keys();
/// The descriptions as a JSON list, in the order of a camera file: of each key its name `key`, its
/// `part` of the table, `type`, `unit`, `help`, `range`, `condition`, `example` (of required keys),
/// `default` (null: none) and `words`.
std::string camera_keys_json();

/// The camera as TOML, every default filled in: parse_camera_toml(camera_to_toml(c)) == c.
/// @throws std::invalid_argument if the camera is invalid
std::string camera_to_toml(const Camera& camera);
/// A lens under the keys of a camera file, as JSON on one line.
std::string lens_to_json(const Lens& lens);
/// The same back, unchecked but for its keys.
/// @throws IoError "lens:line:column: .." for a key that is missing, unknown or of another type
Lens lens_from_json(const std::string& json);
/// The rays of a lens's map (Lens::rays), or of the view where it has none.
/// @throws IoError if the map cannot be read, is of another shape or type, or holds a ray that does
///         not go forward
PixelRays rays_of(const std::optional<Lens>& lens, const PinholeView& view);
/// A built-in camera as such TOML, with the source of every value as a comment beside it, or
/// "assumed": parse_camera_toml(built_in_camera_toml(n)) == built_in_camera(n).
/// @throws std::invalid_argument for an unknown name, with the nearest known one
std::string built_in_camera_toml(const std::string& name);
/// Writes that, named after the file. @throws IoError as AtomicFile does
void write_camera_toml(const std::filesystem::path& path, Camera camera, OutputPolicy policy);
/// The same document as JSON.
std::string camera_to_json(const Camera& camera);

}  // namespace tofsmith
