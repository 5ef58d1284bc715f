// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

// Arguments of several calls. Members with FieldMark::in_place are arguments themselves.
namespace tofsmith::lab {

/// Changed key of the camera, as for `--set`. Without a value the key is removed, which no
/// command-line option can do.
struct Change {
  std::string key;
  std::optional<std::string> value;
};
auto fields_of(ConstOrNot<Change> auto& c) {
  return std::tuple(Field("key", c.key, Help{"camera key"}),
                    Field("value", c.value, Help{"value in TOML"}, IfAbsent{"removes the key"}));
}

struct CameraArguments {
  std::optional<std::string> built_in;
  std::string camera;
  std::vector<Change> changes;

  /// @throws IoError as parse_camera_toml()
  Camera load() const;
};
auto fields_of(ConstOrNot<CameraArguments> auto& c) {
  return std::tuple(Field("built_in", c.built_in, Help{"name of a camera"}),
                    Field("camera", c.camera, Help{"text of a camera file if there is no name"}),
                    Field("changes", c.changes, Help{"changed keys, at most 1000"}));
}

struct CodeSource {
  std::optional<std::string> name, file;

  /// @throws IoError as load_code() and parse_code_json(); InvalidArgument for a code that the
  ///   camera does not support
  CodeSet load(const Camera& camera) const;
};
auto fields_of(ConstOrNot<CodeSource> auto& c) {
  return std::tuple(Field("name", c.name, Help{"family, built for the camera"}),
                    Field("file", c.file, Help{"text of a code file, which is used first"}));
}

struct CodeArguments {
  CameraArguments camera;
  CodeSource code;
};
auto fields_of(ConstOrNot<CodeArguments> auto& a) {
  return std::tuple(Field("camera", a.camera, FieldMark::in_place), Field("code", a.code));
}

/// Returns the camera with one key changed. If the kind of impulse response changes, missing
/// numbers become 10 f0.
/// @return the camera, and the change as for `--set`
std::pair<Camera, Change> changed(const Camera& camera, const Change& change);

}  // namespace tofsmith::lab
