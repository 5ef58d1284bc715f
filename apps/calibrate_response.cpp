// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate_output.hpp"
#include "described_options.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith::apps {

namespace {

struct ResponseArguments {
  std::string file;
  CameraArguments camera;
  CalibrateOutput output;
  ResponseRecordOptions record;
  ResponseCalibrationOptions options;
  std::string time_unit, arm = "light", as = "file";
};

nlohmann::ordered_json document_of(const CalibratedResponse& result) {
  nlohmann::ordered_json fits = nlohmann::ordered_json::array();
  for (const ParametricResponse& fit : result.fits)
    fits.push_back({{"kind", name_of(fit.response.kind)},
                    {"parameter_hz", estimate_json(fit.parameter_hz)},
                    {"bandwidth_hz", estimate_json(fit.bandwidth_hz)},
                    {"residual_rms", fit.residual_rms}});
  nlohmann::ordered_json peaks = nlohmann::ordered_json::array();
  for (const ResponsePeak& peak : result.peaks)
    peaks.push_back({{"time_s", peak.time_s}, {"height", peak.height}});
  return {{"excitation", name_of(result.excitation)},
          {"falling", result.falling},
          {"background", result.background},
          {"height", result.height},
          {"noise_rms", result.noise_rms},
          {"snr_db", number_json(result.snr_db)},
          {"delay_s", result.delay_s},
          {"response_centre_s", result.response_centre_s},
          {"time_step_s", result.response.time_step_s},
          {"samples", result.response.samples.size()},
          {"bandwidth_hz", estimate_json(result.bandwidth_hz)},
          {"fits", fits},
          {"fit_is_good", result.fit_is_good()},
          {"peaks", peaks},
          {"notes", result.notes}};
}

void run(ResponseArguments& arguments, const Session& session) {
  const Camera base = arguments.camera.load();
  const ImpulseResponse::Kind kind = parse_response_kind(arguments.as);
  const bool measured = kind == ImpulseResponse::Kind::file;
  const bool writes_camera = !arguments.output.camera_path.empty();
  arguments.output.check(
      session,
      {measured && writes_camera ? response_path(arguments.output.camera_path).string() : ""});
  if (!arguments.time_unit.empty())
    arguments.record.time_unit_s = seconds_per_unit(arguments.time_unit);
  ResponseRecord record = read_response_record(arguments.file, arguments.record);
  if (record.time_step_s > 1.0 / base.fundamental_frequency_hz)
    throw IoError(arguments.file,
                  fmt::format("found steps of {:.4g} s, longer than the camera's period of {:.4g} "
                              "s; expected --time-step, the time between two values [s], or "
                              "--time-unit if the times have another unit",
                              record.time_step_s, 1.0 / base.fundamental_frequency_hz));
  arguments.options.fundamental_frequency_hz = base.fundamental_frequency_hz;
  arguments.options.samples = base.samples;
  CalibratedResponse result;
  try {
    result = calibrate_impulse_response(std::move(record), arguments.options);
  } catch (const std::invalid_argument& error) {
    throw IoError(arguments.file, error.what());
  }

  ImpulseResponse response = response_of(result, kind);
  if (writes_camera)
    response = write_response_beside(arguments.output.camera_path, std::move(response),
                                     arguments.output.policy);
  session.print_json(document_of(result));
  session.say(fmt::format("{}: a {}{}, {:.1f} dB above its noise\n\n{}", arguments.file,
                          result.falling ? "falling " : "", name_of(result.excitation),
                          result.snr_db, text_table(response_rows(result))));
  if (measured)
    session.say(
        fmt::format("the centre of the response is {:.4g} ns after its first sample; on a real "
                    "camera this is a constant depth offset of {}, which calibration removes",
                    1e9 * result.response_centre_s,
                    length_text(0.5 * speed_of_light_m_per_s * result.response_centre_s)));
  session.say(note_lines(result.notes));
  arguments.output.write_page(response_report(result, arguments.file, session.command_line),
                              session);
  arguments.output.write_camera(with_response(base, response, parse_response_arm(arguments.arm)),
                                session);
}

}  // namespace

void add_calibrate_response(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<ResponseArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "impulse-response",
      "bandwidth and impulse response of the light source or sensor, from its recorded response "
      "to a pulse or step");
  command
      ->add_option("FILE", arguments->file,
                   "oscilloscope CSV (time, value), or a histogram (.npy, or text with values "
                   "only)")
      ->required();
  arguments->camera.add_to(*command);
  add_field_option(*command, arguments->options, "excitation");
  const FieldOptions fields(*command, arguments->record);
  fields.add("column");
  fields.add("time_step_s", "--time-step");
  command->add_option("--time-unit", arguments->time_unit, "unit of the time column")
      ->check(one_of({"s", "ms", "us", "ns", "ps"}));
  fields.add("decimal");
  command
      ->add_option("--arm", arguments->arm,
                   "measured part of the camera; system: light source and sensor together, stored "
                   "as response of the light source")
      ->check(one_of<ResponseArm>())
      ->capture_default_str();
  command
      ->add_option("--as", arguments->as,
                   "form of the response in the camera file: file (the measured response, "
                   "stored next to the camera file) or the name of a fit")
      ->check(one_of({"file", "hann", "gaussian", "lowpass"}))
      ->capture_default_str();
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
