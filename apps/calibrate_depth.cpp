// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate_depth.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "calibrate_output.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

nlohmann::ordered_json document_of(const CalibratedDepth& found) {
  nlohmann::ordered_json terms = nlohmann::ordered_json::array();
  for (const CalibratedTerm& term : found.terms)
    terms.push_back({{"name", term.name},
                     {"value_m", term.value_m.value},
                     {"standard_error_m", term.value_m.standard_error}});
  nlohmann::ordered_json frequencies = nlohmann::ordered_json::array();
  for (const CalibratedFrequency& its : found.frequencies) {
    nlohmann::ordered_json harmonics = nlohmann::ordered_json::array();
    for (const CalibratedHarmonic& h : its.harmonics)
      harmonics.push_back({{"harmonic", h.harmonic},
                           {"in_phase", estimate_json(h.in_phase)},
                           {"quadrature", estimate_json(h.quadrature)}});
    frequencies.push_back({{"frequency_hz", its.frequency_hz},
                           {"offset_m", estimate_json(its.offset_m)},
                           {"contrast", estimate_json(its.contrast)},
                           {"harmonics", harmonics}});
  }
  return {{"pixels", found.pixels},
          {"frequencies", frequencies},
          {"reversed", found.reversed},
          {"known_share", found.known_share},
          {"mean_error_m", found.mean_error_m},
          {"rms_before_m", found.rms_before_m},
          {"rms_m", number_json(found.rms_m.value_or(NAN))},
          {"far_rms_m", number_json(found.far_rms_m.value_or(NAN))},
          {"skipped_folds", found.skipped_folds},
          {"outlier_share", found.outlier_share},
          {"model_error_percent", number_json(found.model_error_percent.value_or(NAN))},
          {"terms", terms},
          {"far_terms", found.far_terms},
          {"notes", found.notes}};
}

std::string lines_of(const CalibratedDepth& found) {
  std::string lines = fmt::format("{} pixels: {}\n", found.pixels, depth_error_text(found));
  const auto frequencies = frequency_rows(found);
  for (std::size_t i = 1; i < frequencies.size(); ++i) {
    const auto& row = frequencies[i];
    lines += fmt::format("{} MHz: offset {} {} mm, contrast {} {}, harmonics {}\n", row[0], row[1],
                         row[2], row[3], row[4], row[5]);
  }
  const auto rows = depth_term_rows(found);
  for (std::size_t i = 1; i < rows.size(); ++i)
    lines += rows[i][1].empty()
                 ? rows[i][0] + "\n"
                 : fmt::format("{:<18} {:>10} {} mm\n", rows[i][0], rows[i][1], rows[i][2]);
  if (found.model_error_percent)
    lines += fmt::format("model error: {:.2g} % of the signal\n", *found.model_error_percent);
  lines += fmt::format("the reference covers {:.0f} % of the range", 100.0 * found.known_share);
  if (found.known_share < 0.999)
    lines += fmt::format("; elsewhere the correction is extrapolated by {}",
                         fmt::join(found.far_terms, ", "));
  if (found.known_share < 0.999 && found.far_rms_m)
    lines += fmt::format(": {} rms on held-out parts of the range", length_text(*found.far_rms_m));
  return lines + "\n" + note_lines(found.notes);
}

}  // namespace

void calibrate_by_reference(const DepthCalibrationArguments& arguments, const Session& session) {
  const CalibrateOutput& output = arguments.output;
  if (arguments.codes.size() != 1)
    throw UsageError("--reference requires --code, the code that the camera used");
  const CodeSet code = load_camera_code(arguments.codes.front(), arguments.camera, arguments.file);
  RawReadOptions reading;
  reading.dataset = arguments.dataset;
  reading.marking = raw_marking_of(arguments.camera);
  if (!arguments.raw_format.empty()) reading.format = read_raw_format(arguments.raw_format);
  const RawFrames frames = read_raw_frames(arguments.frames, reading);
  ReferenceDepth reference = read_reference_depth(arguments.reference);
  reference.is_z = arguments.reference_is_z;
  CalibratedDepth found;
  try {
    found = calibrate_depth(frames, reference, code, arguments.camera,
                            terminal_progress("calibrating"));
  } catch (const std::invalid_argument& error) {
    throw wrong_file(error, arguments.frames.front().string(),
                     {{"reference", arguments.reference}});
  }
  session.print_json(document_of(found));
  session.say(lines_of(found));
  std::string next;
  if (!arguments.table.empty()) {
    write_calibrated_table(arguments.table, found.table, output.policy);
    session.say(fmt::format("wrote {}", arguments.table));
    next = fmt::format("tofsmith decode RAW --code {} --camera {} -o depth.npy", arguments.table,
                       !output.camera_path.empty() ? output.camera_path : arguments.camera_name);
  }
  output.write_page(depth_report(found, arguments.frames.front().string(), session.command_line),
                    session);
  if (!output.camera_path.empty())
    output.write_camera(with_depth(arguments.camera, found), session, next);
  else if (!next.empty())
    session.say("next: " + next);
}

}  // namespace tofsmith::apps
