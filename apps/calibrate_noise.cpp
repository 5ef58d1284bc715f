// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate_output.hpp"
#include "described_options.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

struct NoiseArguments {
  std::vector<std::string> files;
  std::string dark, code;
  PhotonTransferOptions given;
  CameraArguments camera;
  TapArguments taps;
  CalibrateOutput output;
};

nlohmann::ordered_json document_of(const PhotonTransfer& found) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const PhotonTransferPoint& p : found.points)
    points.push_back({{"mean_dn", p.mean_dn},
                      {"variance_dn2", estimate_json(p.variance_dn2)},
                      {"dark", p.dark},
                      {"saturated", p.saturated}});
  nlohmann::ordered_json document = {{"gain_e_per_dn", estimate_json(found.gain_e_per_dn)},
                                     {"read_noise_e", estimate_json(found.read_noise_e)},
                                     {"black_level_dn", estimate_json(found.black_level_dn)},
                                     {"full_well_e", nullptr},
                                     {"adc_bits", found.adc_bits},
                                     {"buckets", found.buckets},
                                     {"reduced_chi2", found.reduced_chi2},
                                     {"points", points},
                                     {"notes", found.notes}};
  if (found.full_well_e) document["full_well_e"] = estimate_json(*found.full_well_e);
  return document;
}

void run(NoiseArguments& arguments, const Session& session) {
  const Camera base = arguments.camera.load();
  arguments.output.check(session);
  const bool reads_differences = base.sensor.readout == Readout::difference;
  if (reads_differences && arguments.code.empty())
    throw UsageError(
        "calibrate noise: the camera reads differences, whose mean does not determine the shot "
        "noise; expected --code, the code that the camera used, or frames of single taps (--set "
        "sensor.readout=separate)");
  if (!reads_differences && !arguments.code.empty())
    throw UsageError("--code: is only valid with cameras that read differences (sensor.readout)");
  PhotonTransferOptions options = noise_options(base, !arguments.dark.empty());
  options.averaged = arguments.given.averaged;
  if (arguments.given.black_level_dn) options.black_level_dn = arguments.given.black_level_dn;
  std::vector<RawFrames> levels;
  for (const std::string& file : arguments.files) levels.push_back(read_raw_frames(file));
  RawFrames dark;
  if (!arguments.dark.empty()) dark = read_raw_frames(arguments.dark);
  if (arguments.dark.empty() && !options.black_level_dn && !reads_differences)
    throw UsageError(
        "calibrate noise: the black level is unknown; expected --dark FILE, frames with the light "
        "off, or --black-level DN");
  PhotonTransfer found;
  try {
    if (reads_differences) {
      const CodeSet code =
          load_camera_code(arguments.code, base, arguments.taps.file_for({arguments.code}));
      found = photon_transfer(levels, dark, make_decoding_table(ForwardModel(code, base), base),
                              options);
    } else {
      found = photon_transfer(levels, dark, options);
    }
  } catch (const std::invalid_argument& error) {
    throw IoError(arguments.files.front(), error.what());
  }
  session.print_json(document_of(found));
  session.say(text_table(noise_rows(found)));
  session.say(note_lines(found.notes));
  arguments.output.write_page(noise_report(found, session.command_line), session);
  arguments.output.write_camera(with_noise(base, found), session);
}

}  // namespace

void add_calibrate_noise(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<NoiseArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "noise", "gain, read noise, black level and full well from pairs of frames");
  command
      ->add_option("RAW", arguments->files,
                   "raw frames (.npy .npz), (F,H,W,K), in consecutive pairs of equal light; "
                   "several light levels, in one or several files")
      ->required();
  command->add_option("--dark", arguments->dark, "pairs of frames with the light off");
  const FieldOptions options(*command, arguments->given);
  options.add("black_level_dn", "--black-level");
  command->add_option("--code", arguments->code,
                      "code that the camera used; required if the camera reads out differences "
                      "of taps");
  options.add("averaged");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
