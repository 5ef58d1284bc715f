// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "request.hpp"

#include <fmt/format.h>

#include <array>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::lab {

Camera CameraArguments::load() const {
  require(changes.size() <= 1000, "changes", changes.size(), "expected at most 1000");
  Camera loaded = built_in ? load_camera(*built_in) : parse_camera_toml(camera);
  for (const Change& change : changes) loaded = changed(loaded, change).first;
  return loaded;
}

CodeSet CodeSource::load(const Camera& camera) const {
  require(name || file, "code", "nothing",
          "expected {\"name\": a family} or {\"file\": text of a code file}");
  if (!file) return load_code(*name, camera);
  CodeSet code = parse_code_json(*file, "code.json");  // the page saves it under this name
  require_fits(code, camera);
  return code;
}

std::pair<Camera, Change> changed(const Camera& camera, const Change& change) {
  // An empty text would remove the key; the page uses null for that.
  require(!change.value || change.value->find_first_not_of(" \t") != std::string::npos, change.key,
          "nothing", "expected a value");
  constexpr std::string_view kind = ".impulse_response.kind";
  Change resolved = change;
  if (change.value && change.key.ends_with(kind)) {
    resolved.key = change.key.substr(0, change.key.size() - std::string(".kind").size());
    const bool is_light = resolved.key.starts_with("light");
    const ImpulseResponse& before =
        is_light ? camera.light.impulse_response : camera.sensor.impulse_response;
    const double limit_hz = before.f_max_hz > 0.0    ? before.f_max_hz
                            : before.cutoff_hz > 0.0 ? before.cutoff_hz
                                                     : 10.0 * camera.fundamental_frequency_hz;
    std::string word = *change.value;
    std::erase(word, '"');
    if (word == "hann")
      resolved.value = fmt::format("{{ kind = \"hann\", f_max_hz = {} }}", limit_hz);
    else if (word == "gaussian" || word == "lowpass")
      resolved.value = fmt::format("{{ kind = \"{}\", cutoff_hz = {} }}", word, limit_hz);
    else
      resolved.value = fmt::format("{{ kind = \"{}\" }}", word);
  }
  const std::array settings = {resolved.key + "=" + resolved.value.value_or("")};
  return {with_settings(camera, settings), resolved};
}

}  // namespace tofsmith::lab
