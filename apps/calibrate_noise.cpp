// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate_output.hpp"
#include "number_checks.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/raw_frames_file.hpp"
#include "tofsmith/report/colours.hpp"
#include "tofsmith/report/line_figure.hpp"

namespace tofsmith::apps {

namespace {

struct NoiseArguments {
  std::vector<std::string> files;
  std::string dark;
  std::optional<double> black_level_dn;
  CameraArguments camera;
  CalibrateOutput output;
};

std::vector<std::vector<std::string>> rows_of(const PhotonTransfer& found) {
  std::vector<std::vector<std::string>> rows{{"quantity", "found"}};
  rows.push_back({"sensor.gain_e_per_dn", estimate_text(found.gain_e_per_dn, 1)});
  rows.push_back({"sensor.read_noise_e", estimate_text(found.read_noise_e, 1)});
  rows.push_back({"sensor.black_level_dn", estimate_text(found.black_level_dn, 1)});
  rows.push_back({"sensor.full_well_e",
                  found.full_well_e ? estimate_text(*found.full_well_e, 1) : "not reached"});
  rows.push_back({"sensor.adc_bits", fmt::format("{}", found.adc_bits)});
  rows.push_back({"chi^2 per freedom", fmt::format("{:.3g}", found.reduced_chi2)});
  return rows;
}

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
                                     {"reduced_chi2", found.reduced_chi2},
                                     {"points", points},
                                     {"notes", found.notes}};
  if (found.full_well_e) document["full_well_e"] = estimate_json(*found.full_well_e);
  return document;
}

Page page_of(const PhotonTransfer& found) {
  ColourAssignment colours;
  Series used{.name = "pairs of frames", .mark = Mark::markers, .style = colours.style("pairs")};
  Series left{.name = "saturated", .mark = Mark::markers, .style = colours.style("saturated")};
  double brightest = found.black_level_dn.value;
  for (const PhotonTransferPoint& p : found.points) {
    Series& series = p.saturated ? left : used;
    series.x.push_back(p.mean_dn);
    series.y.push_back(p.variance_dn2.value);
    series.y_error.push_back(p.variance_dn2.standard_error);
    brightest = std::max(brightest, p.mean_dn);
  }
  Series line{.name = "fit", .style = reference_style()};
  const double gain = found.gain_e_per_dn.value, read_dn = found.read_noise_e.value / gain;
  for (const double mean : {found.black_level_dn.value, brightest}) {
    line.x.push_back(mean);
    line.y.push_back(read_dn * read_dn + (mean - found.black_level_dn.value) / gain + 1.0 / 12);
  }
  std::vector<Series> series{used, line};
  if (!left.x.empty()) series.push_back(left);
  Table table{.caption = "Found, with standard errors.", .columns = {{"key"}, {"value", true}}};
  const auto rows = rows_of(found);
  table.rows.assign(rows.begin() + 1, rows.end());
  Section section{"Noise", {std::move(table)}};
  section.blocks.push_back(line_figure(
      {.id = "photon-transfer",
       .title = "Photon transfer",
       .caption = "Variance in time of each pair and measurement over its mean. The slope is one "
                  "over the gain, the height at black the read noise."},
      series, {.label = "mean", .unit = "DN"},
      {.label = "variance", .unit = "DN^2", .from_zero = true}));
  return {.title = "Noise of a sensor", .sections = {section, notes_section(found.notes)}};
}

void run(const NoiseArguments& arguments, const Session& session) {
  const Camera base = arguments.camera.load();
  std::vector<std::string> inputs = arguments.files;
  inputs.push_back(arguments.dark);
  inputs.push_back(arguments.camera.name);
  arguments.output.check(session, inputs);
  PhotonTransferOptions options;
  try {
    options = noise_options(base, !arguments.dark.empty());
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("calibrate noise: {}", error.what()));
  }
  if (arguments.black_level_dn) options.black_level_dn = arguments.black_level_dn;
  std::vector<RawFrames> levels;
  for (const std::string& file : arguments.files) levels.push_back(read_raw_frames(file));
  RawFrames dark;
  if (!arguments.dark.empty()) dark = read_raw_frames(arguments.dark);
  if (arguments.dark.empty() && !options.black_level_dn)
    throw UsageError(
        "calibrate noise: the black level is not known; expected --dark FILE, frames "
        "with the light off, or --black-level DN");
  PhotonTransfer found;
  try {
    found = photon_transfer(levels, dark, options);
  } catch (const std::invalid_argument& error) {
    throw IoError(arguments.files.front(), error.what());
  }
  session.print_json(document_of(found));
  session.say(text_table(rows_of(found)));
  session.say(note_lines(found.notes));
  arguments.output.write_page(page_of(found), session);
  arguments.output.write_camera(with_noise(base, found), session);
}

}  // namespace

void add_calibrate_noise(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<NoiseArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "noise", "gain, read noise, black level and full well from pairs of frames");
  command
      ->add_option("RAW", arguments->files,
                   "raw frames (.npy .npz), (F,H,W,K): each two that follow one another of the "
                   "same light; several levels of light in one file or several")
      ->required();
  command->add_option("--dark", arguments->dark, "pairs of frames with the light off");
  command->add_option("--black-level", arguments->black_level_dn, "black level [DN], if known")
      ->check(number_from_0_on());
  arguments->camera.add_to(*command);
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
