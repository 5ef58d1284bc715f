// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate_output.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

struct TemperatureArguments {
  std::string file, temperatures, code;
  std::optional<double> reference_c;
  CameraArguments camera;
  TapArguments taps;
  CalibrateOutput output;
};

nlohmann::ordered_json document_of(const TemperatureDrift& found) {
  return {{"mean_c", found.mean_c},
          {"offset_m_per_c", estimate_json(found.offset_m_per_c)},
          {"signal_per_c", estimate_json(found.signal_per_c)},
          {"offset_m_per_c2", estimate_json(found.offset_m_per_c2)},
          {"signal_per_c2", estimate_json(found.signal_per_c2)},
          {"interval_factor", found.interval_factor},
          {"offset_rms_m", found.offset_rms_m},
          {"signal_rms", found.signal_rms},
          {"temperature_c", found.temperature_c},
          {"offset_m", found.offset_m},
          {"log_signal", found.log_signal},
          {"pixels", found.pixels},
          {"notes", found.notes}};
}

std::string lines_of(const TemperatureDrift& found) {
  const auto line = [&](const char* what, const Estimate& e, double scale, const char* unit) {
    return fmt::format("{:<7} {:+9.4f} ± {:.4f} {} per degree\n", what, scale * e.value,
                       scale * found.interval_factor * e.standard_error, unit);
  };
  return fmt::format("{} frames around {:.1f} degrees C, {} pixels\n", found.offset_m.size(),
                     found.mean_c, found.pixels) +
         line("depth", found.offset_m_per_c, 1e3, "mm") +
         line("signal", found.signal_per_c, 1e2, "%") + note_lines(found.notes);
}

void run(TemperatureArguments& arguments, const Session& session) {
  const Camera camera = arguments.camera.load();
  arguments.output.check(session);
  const CodeSet code = load_camera_code(arguments.code, camera, arguments.taps.file_options());
  const RawFrames frames = read_raw_frames(arguments.file);
  const NumberTable table = read_number_column(arguments.temperatures, "the temperatures");
  TemperatureDrift found;
  try {
    found = calibrate_temperature(frames, {table.values.col(0).begin(), table.values.col(0).end()},
                                  code, camera, terminal_progress("calibrating"));
  } catch (const std::invalid_argument& error) {
    throw wrong_file(error, arguments.file, {{"temperatures", arguments.temperatures}});
  }
  found.notes.insert(found.notes.begin(), table.notes.begin(), table.notes.end());
  session.print_json(document_of(found));
  session.say(lines_of(found));
  arguments.output.write_page(temperature_report(found, arguments.file, session.command_line),
                              session);
  arguments.output.write_camera(
      with_temperature(camera, found, arguments.reference_c), session,
      fmt::format("tofsmith decode RAW --code {} --camera {} --temperature {:.0f}", arguments.code,
                  arguments.output.camera_path, found.mean_c));
}

}  // namespace

void add_calibrate_temperature(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<TemperatureArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "temperature", "drift of depth and signal per degree from frames of a still scene");
  command
      ->add_option("RAW", arguments->file,
                   "raw frames (.npy .npz), (F,H,W,K), of a scene that stands still")
      ->required();
  command
      ->add_option("--temperatures", arguments->temperatures,
                   "text of one column: the temperature of each frame [degrees C]")
      ->required();
  command->add_option("--code", arguments->code, "the code that the camera played")->required();
  command->add_option("--reference-c", arguments->reference_c,
                      "temperature at which the camera was calibrated otherwise, so that nothing "
                      "changes there [degrees C] (the mean of the frames)");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
