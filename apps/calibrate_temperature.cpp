// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate_output.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

struct TemperatureArguments {
  std::string file, temperatures, light_column, sensor_column, code;
  std::optional<double> reference_c, sensor_reference_c;
  CameraArguments camera;
  TapArguments taps;
  CalibrateOutput output;
};

nlohmann::ordered_json document_of(const TemperatureDrift& found) {
  nlohmann::ordered_json document = {{"mean_c", found.mean_c},
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
  if (found.sensor)
    document["sensor"] = {{"mean_c", found.sensor->mean_c},
                          {"offset_m_per_c", estimate_json(found.sensor->offset_m_per_c)},
                          {"signal_per_c", estimate_json(found.sensor->signal_per_c)},
                          {"temperature_c", found.sensor->temperature_c}};
  if (found.hysteresis_m) document["hysteresis_m"] = estimate_json(*found.hysteresis_m);
  return document;
}

std::string lines_of(const TemperatureDrift& found) {
  const auto lines = [&](const auto& drift, const char* of_what) {
    const auto line = [&](const char* what, const Estimate& e, double scale, const char* unit) {
      return fmt::format("{:<7} {:+9.4f} ± {:.4f} {} per degree{}\n", what, scale * e.value,
                         scale * found.interval_factor * e.standard_error, unit, of_what);
    };
    return line("depth", drift.offset_m_per_c, 1e3, "mm") +
           line("signal", drift.signal_per_c, 1e2, "%");
  };
  return fmt::format("{} frames around {:.1f} degrees C, {} pixels\n", found.offset_m.size(),
                     found.mean_c, found.pixels) +
         lines(found, found.sensor ? " of the light source" : "") +
         (found.sensor ? lines(*found.sensor, " of the sensor") : "") + note_lines(found.notes);
}

std::vector<double> column(const NumberTable& table, Eigen::Index index) {
  return {table.values.col(index).begin(), table.values.col(index).end()};
}

/// Temperatures of the frames, and notes about the interpretation of their file.
struct ReadTemperatures {
  FrameTemperatures of_frames;
  std::vector<std::string> notes;
};

/// Reads the only column, or the named ones. The column of the light source is by default the only
/// other one.
ReadTemperatures read_temperatures(const TemperatureArguments& arguments) {
  const std::string& file = arguments.temperatures;
  if (arguments.light_column.empty() && arguments.sensor_column.empty()) {
    const NumberTable table = read_number_column(
        file, "the temperatures, or --light-column and --sensor-column with their names");
    return {.of_frames = {.of_camera_c = column(table, 0), .of_sensor_c = {}},
            .notes = table.notes};
  }
  const NumberTable table = read_number_table(file, {.min_columns = 2});
  ReadTemperatures result{.of_frames = {}, .notes = table.notes};
  std::optional<Eigen::Index> sensor;
  if (!arguments.sensor_column.empty()) {
    sensor = table.column_of(arguments.sensor_column, file);
    result.of_frames.of_sensor_c = column(table, *sensor);
  }
  if (arguments.light_column.empty() && table.values.cols() != 2)
    throw IoError(file, fmt::format("found {}; expected --light-column to select the temperatures "
                                    "of the light source",
                                    table.describe_columns()));
  const Eigen::Index light =
      arguments.light_column.empty() ? 1 - *sensor : table.column_of(arguments.light_column, file);
  if (light == sensor)
    throw UsageError(
        fmt::format("--sensor-column: {} is also the --light-column; expected another one",
                    arguments.sensor_column));
  result.of_frames.of_camera_c = column(table, light);
  return result;
}

void run(TemperatureArguments& arguments, const Session& session) {
  const Camera camera = arguments.camera.load();
  arguments.output.check(session);
  const CodeSet code =
      load_camera_code(arguments.code, camera, arguments.taps.file_for({arguments.code}));
  const RawFrames frames = read_raw_frames(arguments.file);
  const ReadTemperatures read = read_temperatures(arguments);
  TemperatureDrift found;
  try {
    found = calibrate_temperature(frames, read.of_frames, code, camera,
                                  terminal_progress("calibrating"));
  } catch (const std::invalid_argument& error) {
    throw wrong_file(error, arguments.file,
                     {{"temperatures", arguments.temperatures},
                      {"sensor_temperatures", arguments.temperatures}});
  }
  found.notes.insert(found.notes.begin(), read.notes.begin(), read.notes.end());
  session.print_json(document_of(found));
  session.say(lines_of(found));
  arguments.output.write_page(temperature_report(found, arguments.file, session.command_line),
                              session);
  // Without a drift of the sensor, its reference is not valid.
  const std::optional<double> sensor_reference_c =
      found.sensor ? arguments.sensor_reference_c : std::nullopt;
  arguments.output.write_camera(
      with_temperature(camera, found, arguments.reference_c, sensor_reference_c), session,
      fmt::format(
          "tofsmith decode RAW --code {} --camera {} --temperature {:.0f}{}", arguments.code,
          arguments.output.camera_path, found.mean_c,
          found.sensor ? fmt::format(" --sensor-temperature {:.0f}", found.sensor->mean_c) : ""));
}

}  // namespace

void add_calibrate_temperature(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<TemperatureArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "temperature", "temperature drift of depth and signal, from frames of a static scene");
  command
      ->add_option("RAW", arguments->file, "raw frames (.npy .npz), (F,H,W,K), of a static scene")
      ->required();
  command
      ->add_option("--temperatures", arguments->temperatures,
                   "text file with the temperature of each frame [degrees C] in one column; with "
                   "--sensor-column or --light-column, several columns")
      ->required();
  CLI::Option* const sensor_column = command->add_option(
      "--sensor-column", arguments->sensor_column,
      "name or number (from 1) of the column with the temperature of the sensor, if the drifts "
      "of sensor and light source are fitted separately");
  command->add_option("--light-column", arguments->light_column,
                      "name or number (from 1) of the column with the temperature of the light "
                      "source or of the camera (default: the only other column)");
  command->add_option("--code", arguments->code, "code that the camera used")->required();
  command->add_option("--reference-c", arguments->reference_c,
                      "reference temperature [degrees C], at which depth and signal are not "
                      "corrected; use the temperature of the other calibrations (default: the "
                      "mean of the frames)");
  command
      ->add_option("--sensor-reference-c", arguments->sensor_reference_c,
                   "reference temperature of the sensor [degrees C] (default: the mean of the "
                   "frames)")
      ->needs(sensor_column);
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
