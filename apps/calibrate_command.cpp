// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "calibrate_output.hpp"
#include "commands.hpp"
#include "session.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::apps {

void CalibrateOutput::add_to(CLI::App& command) {
  command.add_option(
      "-o,--output", camera_path,
      "write the calibrated camera (.toml), for design, evaluate and other commands");
  command.add_option("--report", page_path, "write a page with figures (.html)");
}

void CalibrateOutput::check(const Session& session, const std::vector<std::string>& others) {
  std::vector<std::filesystem::path> outputs;
  const auto add = [&](const std::string& path, const char* option, const char* extension) {
    if (path.empty()) return;
    if (std::filesystem::path(path).extension() != extension)
      throw UsageError(
          fmt::format("{} {}: unknown extension; expected {}", option, path, extension));
    outputs.push_back(path);
  };
  // Paths in the order of writing.
  for (const std::string& path : others)
    if (!path.empty()) outputs.push_back(path);
  add(page_path, "--report", ".html");
  add(camera_path, "-o", ".toml");
  policy = session.check_outputs(outputs);
}

void CalibrateOutput::write_camera(const Camera& camera, const Session& session,
                                   const std::string& next) const {
  if (camera_path.empty()) return;
  write_file_atomically(camera_path, calibrated_camera_toml(camera), policy);
  session.say(fmt::format(
      "wrote {} (values that were not fitted are from camera {})\nnext: {}", camera_path,
      camera.name,
      next.empty() ? fmt::format("tofsmith design {} -o designed", camera_path) : next));
}

void CalibrateOutput::write_page(const Page& page, const Session& session) const {
  if (page_path.empty()) return;
  write_file_atomically(page_path, render(page), policy);
  session.say(fmt::format("wrote {}", page_path));
}

IoError wrong_file(const std::invalid_argument& error, const std::string& file,
                   const std::map<std::string, std::string>& by_field) {
  const auto* const broken = dynamic_cast<const InvalidArgument*>(&error);
  const auto place = broken ? by_field.find(broken->field()) : by_field.end();
  return {place == by_field.end() ? file : place->second, error.what()};
}

nlohmann::ordered_json number_json(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json estimate_json(const Estimate& estimate) {
  return {{"value", number_json(estimate.value)},
          {"standard_error", number_json(estimate.standard_error)}};
}

std::string note_lines(const std::vector<std::string>& notes) {
  std::string lines;
  for (const std::string& note : notes) lines += fmt::format("note: {}\n", note);
  return lines;
}

void add_calibrate_command(CLI::App& app, Session& session) {
  CLI::App* command =
      app.add_subcommand("calibrate",
                         "calibrate a camera from measurements: impulse responses, correlation "
                         "functions, noise, temperature drift, stray light");
  command->require_subcommand(1);
  command->footer(
      "Try: tofsmith calibrate impulse-response scope.csv -o mine.toml\n"
      "     tofsmith calibrate correlation sweep.npy --shifts shifts.txt -o mine.toml\n"
      "     tofsmith calibrate noise level*.npy --dark dark.npy -o mine.toml\n"
      "     tofsmith calibrate temperature raw.npy --code sinusoid-k4 --temperatures t.txt "
      "-o mine.toml\n"
      "     tofsmith calibrate stray-light spot.npy --dark dark.npy -o kernel.npy");
  add_calibrate_response(*command, session);
  add_calibrate_correlation(*command, session);
  add_calibrate_noise(*command, session);
  add_calibrate_temperature(*command, session);
  add_calibrate_stray_light(*command, session);
}

}  // namespace tofsmith::apps
