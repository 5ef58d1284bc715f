// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/error.hpp"
#include "work_calls.hpp"

namespace tofsmith::lab {

namespace {

/// Quotes a word for a POSIX shell.
std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+@%";
  const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Returns the name of the built-in camera, or of the file to which the camera was saved.
std::string camera_name(const Request& request) {
  return request.has("camera_file") ? request.text("camera_file") : request.text("built_in", "");
}

/// Returns `--set ...` for every changed key.
std::string settings_words(const Request& request) {
  std::string words;
  for (const Change& change : request.changes())
    words += " --set " + shell_word(change.key + "=" + change.value.value_or(""));
  return words;
}

/// Returns `--camera X --set ...` for everything that differs from the defaults.
std::string camera_words(const Request& request) {
  const std::string name = camera_name(request);
  return (name.empty() ? "" : " --camera " + shell_word(name)) + settings_words(request);
}

std::string option(const Request& request, const char* argument, const char* name) {
  const std::optional<double> number = request.optional_number(argument);
  return number ? fmt::format(" {} {}", name, *number) : "";
}

std::string scene_commands(const Request& request, const std::string& code,
                           const std::string& camera) {
  std::string simulate = fmt::format("tofsmith simulate {} --code {}{}",
                                     shell_word(request.text("scene", "table-top")), code, camera);
  if (request.has("width")) {
    const auto width = request.integer("width", 8, 1024);
    simulate += fmt::format(" --width {} --height {}", width,
                            request.integer("height", 8, 1024, width * 3 / 4));
  }
  simulate += option(request, "signal", "--signal") + option(request, "ambient", "--ambient") +
              option(request, "seed", "--seed") + " -o raw.npy";
  std::string decode = fmt::format("tofsmith decode raw.npy --code {}{}", code, camera);
  if (const std::string filter = request.text("filter", "off"); filter != "off")
    decode += " --filter " + shell_word(filter);
  return simulate + "\n" + decode + " -o depth.npy";
}

}  // namespace

Answer command_answer(const Request& request) {
  const std::string what = request.text("what");
  const std::string camera = camera_words(request);
  std::vector<std::string> codes = request.texts("codes");
  for (std::string& code : codes) code = shell_word(code);
  const auto first_code = [&] {
    require(!codes.empty(), "codes", "[]", "expected a code");
    return codes.front();
  };
  std::string command;
  if (what == "camera") {
    const std::string name = camera_name(request);
    command = "tofsmith cameras " +
              shell_word(name.empty() ? std::string(default_camera_name) : name) +
              settings_words(request);
  } else if (what == "codes") {
    command = "tofsmith codes " + first_code() + camera;
  } else if (what == "evaluate") {
    first_code();
    command = fmt::format("tofsmith evaluate {}{}", fmt::join(codes, " "), camera) +
              option(request, "trials", "--trials") + option(request, "seed", "--seed");
  } else if (what == "scene") {
    command = scene_commands(request, first_code(), camera);
  } else if (what == "design") {
    command = "tofsmith design" + camera;
    if (request.has("method")) command += " --method " + shell_word(request.text("method"));
    command += option(request, "exposures", "--exposures") + option(request, "effort", "--effort") +
               option(request, "trials", "--trials") + option(request, "seed", "--seed") +
               " -o design";
  } else if (what == "export") {
    command = fmt::format("tofsmith export {}{} -o waveforms.csv", first_code(), camera);
  } else {
    reject("what", what, "expected camera, codes, evaluate, scene, design or export");
  }
  Answer answer;
  answer["command"] = command;
  return answer;
}

}  // namespace tofsmith::lab
