// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "calibrate_output.hpp"
#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

/// Arguments of `calibrate correlation --reference`.
struct DepthCalibrationArguments {
  std::vector<std::filesystem::path> frames;
  std::filesystem::path raw_format;  ///< empty: .npy, .npz or .h5
  std::string dataset;
  bool reference_is_z = false;
  std::string reference, table, camera_name;
  CalibrateOutput output;
  std::vector<std::string> codes;
  CodeFileOptions file;
  Camera camera;
};

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

/// Calibrates against reference depth, prints the result and writes the table.
/// @throws UsageError unless there is exactly one code; IoError for invalid files
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

struct CorrelationArguments {
  std::vector<std::string> files;
  DecodeRequest frames;
  DelaySweepOptions sweep;
  std::optional<DepthKind> reference_kind;
  std::string dark, reference, table, offset_map, gain_map;
  std::vector<std::string> codes;
  std::optional<double> target_distance_m;
  CameraArguments camera;
  TapArguments taps;
  CalibrateOutput output;

  const std::string& file() const { return files.front(); }
};

DelaySweep load_sweep(const CorrelationArguments& arguments, const Camera& camera) {
  DelaySweepOptions options = arguments.sweep;
  options.tap_order = arguments.taps.file.tap_order;
  try {
    return read_delay_sweep(arguments.file(), camera, options);
  } catch (const IoError& error) {
    const std::filesystem::path path = arguments.file();
    if (!options.shifts.empty() || path.extension() != ".npy" || !exists(path)) throw;
    throw std::runtime_error(fmt::format(
        "{}; frames at several delays require --shifts, frames of known depth --reference",
        error.what()));
  }
}

CorrelationCalibrationOptions options_for(const CorrelationArguments& arguments,
                                          const Camera& camera, const DelaySweep& sweep) {
  CorrelationCalibrationOptions options = sweep_options(camera, sweep);
  if (!arguments.dark.empty()) options.dark = read_raw_frames(arguments.dark);
  if (!arguments.target_distance_m) return options;
  if (!camera.lens) throw UsageError("--target-distance-m requires the camera's [lens]");
  options.geometry_m = flat_target_geometry_m(*arguments.target_distance_m, camera,
                                              sweep.frames.height, sweep.frames.width);
  return options;
}

std::vector<CodeSet> candidates(const CorrelationArguments& arguments, const Camera& camera,
                                int measurements) {
  std::vector<CodeSet> codes = ideal_codes(camera, measurements);
  if (arguments.codes.empty()) return codes;
  codes.clear();
  Camera open = camera;
  open.light.peak_factor = 1e6;
  for (const std::string& name : arguments.codes)
    codes.push_back(load_code(name, open, arguments.taps.file));
  return codes;
}

std::string brief(const IdealCodeFit& fit) {
  const bool limited = fit.response.kind != ImpulseResponse::Kind::none;
  return fmt::format(
      "{}: residual {:.2f} % ({:.2f} % without a response), delay {:.4f} periods{}{}{}", fit.code,
      100 * fit.residual, 100 * fit.ideal_residual, fit.delay_periods,
      fit.reversed ? ", delay reversed" : "", fit.inverted ? ", signs inverted" : "",
      limited ? fmt::format(", {} on both arms, {} MHz", name_of(fit.response.kind),
                            estimate_text(fit.parameter_hz, 1e6))
              : "");
}

/// Returns the largest range of values of one measurement.
double largest_swing(const Eigen::MatrixXd& correlation) {
  return (correlation.colwise().maxCoeff() - correlation.colwise().minCoeff()).maxCoeff();
}

nlohmann::ordered_json fit_json(const IdealCodeFit& fit) {
  nlohmann::ordered_json harmonics = nlohmann::ordered_json::array();
  for (const HarmonicRatio& h : fit.harmonics)
    harmonics.push_back({{"harmonic", h.harmonic},
                         {"measured", h.measured},
                         {"ideal", h.ideal},
                         {"ratio", estimate_json(h.ratio)}});
  return {{"code", fit.code},
          {"residual", fit.residual},
          {"ideal_residual", fit.ideal_residual},
          {"delay_periods", fit.delay_periods},
          {"reversed", fit.reversed},
          {"inverted", fit.inverted},
          {"exposure", fit.exposure},
          {"scale", fit.scale},
          {"response", name_of(fit.response.kind)},
          {"parameter_hz", estimate_json(fit.parameter_hz)},
          {"harmonics", harmonics}};
}

nlohmann::ordered_json document_of(const CalibratedCorrelation& found,
                                   const std::vector<IdealCodeFit>& fits) {
  nlohmann::ordered_json mismatch = nlohmann::ordered_json::array();
  for (const Estimate& m : found.tap_mismatch) mismatch.push_back(estimate_json(m));
  nlohmann::ordered_json codes = nlohmann::ordered_json::array();
  for (const IdealCodeFit& fit : fits) codes.push_back(fit_json(fit));
  return {{"samples", found.table.samples()},
          {"measurements", found.table.columns()},
          {"noise_rms", found.noise_rms},
          {"noise_source", found.noise_source},
          {"largest_standard_error", found.standard_error.maxCoeff()},
          {"model_error_percent", found.table.model_error_percent},
          {"swing", largest_swing(found.table.correlation)},
          {"dead_pixels", found.dead.total()},
          {"drift_known", found.drift_known},
          {"drift_corrected", found.drift_corrected},
          {"light_drift", found.drift_known ? estimate_json(found.light_drift) : nullptr},
          {"level_drift", found.drift_known ? estimate_json(found.level_drift) : nullptr},
          {"tap_mismatch", mismatch},
          {"offset_standard_error_m", number_json(found.delay_error_m)},
          {"gain_standard_error", number_json(found.gain_error)},
          {"ideal_codes", codes},
          {"notes", found.notes}};
}

void check_outputs(CorrelationArguments& arguments, const Session& session) {
  arguments.output.check(session, {arguments.table, arguments.offset_map, arguments.gain_map});
  if (!arguments.table.empty() && std::filesystem::path(arguments.table).extension() != ".npz")
    throw UsageError(fmt::format("--table {}: unknown extension; expected .npz", arguments.table));
}

void write_maps(const CorrelationArguments& arguments, const CalibratedCorrelation& found,
                const Session& session) {
  const auto write = [&](const std::string& path, const Image<float>& map, const char* name) {
    if (path.empty()) return;
    if (map.empty())
      throw UsageError(
          fmt::format("{}: a table of means has no pixels; expected a stack of frames", path));
    write_float_image(path, map, name, arguments.output.policy);
    session.say(fmt::format("wrote {}", path));
  };
  write(arguments.offset_map, found.maps.delay_offset_m, "offset");
  write(arguments.gain_map, found.maps.gain, "gain");
}

void run(CorrelationArguments& arguments, const Session& session) {
  const Camera base = arguments.camera.load();
  check_outputs(arguments, session);
  if (!arguments.reference.empty()) {
    calibrate_by_reference({{arguments.files.begin(), arguments.files.end()},
                            arguments.frames.raw_format,
                            arguments.frames.dataset,
                            depth_kind_of(arguments.reference, arguments.reference_kind,
                                          DepthKind::radial) == DepthKind::z,
                            arguments.reference,
                            arguments.table,
                            arguments.camera.name,
                            arguments.output,
                            arguments.codes,
                            arguments.taps.file,
                            base},
                           session);
    return;
  }
  if (arguments.files.size() > 1)
    throw UsageError("several files, one per measurement, require --reference; expected one SWEEP");
  const DelaySweep sweep = load_sweep(arguments, base);
  CalibratedCorrelation found;
  try {
    found = calibrate_correlation(sweep, options_for(arguments, base, sweep),
                                  terminal_progress("calibrating"));
  } catch (const std::invalid_argument& error) {
    throw IoError(arguments.file(), error.what());
  }
  const std::vector<CodeSet> codes = candidates(arguments, base, found.table.columns());
  std::vector<IdealCodeFit> fits;
  if (codes.empty())
    found.notes.push_back(
        fmt::format("no built-in code has {} measurements with {} taps; specify a code to compare "
                    "with (--code)",
                    found.table.columns(), base.sensor.taps));
  else
    fits = fit_ideal_codes(found.table.correlation, found.standard_error, base, codes);
  if (!fits.empty() && fits.front().residual > 0.1)
    found.notes.push_back(fmt::format(
        "no ideal code fits: the best has a residual of {:.0f} %; specify another code (--code)",
        100 * fits.front().residual));

  session.print_json(document_of(found, fits));
  session.say(
      fmt::format("table of {} x {}: standard errors up to {:.3g}, values span {:.5g} raw numbers "
                  "(noise {:.3g} per number, from {}), model error {:.2g} % of the signal",
                  found.table.samples(), found.table.columns(), found.standard_error.maxCoeff(),
                  largest_swing(found.table.correlation), found.noise_rms, found.noise_source,
                  found.table.model_error_percent));
  if (!found.maps.empty())
    session.say(
        fmt::format("maps of {} x {} pixels: standard error of offsets {}, of gains {:.2g} %",
                    found.maps.gain.width, found.maps.gain.height, length_text(found.delay_error_m),
                    100 * found.gain_error));
  for (const IdealCodeFit& fit : fits) session.say(brief(fit));
  session.say(note_lines(found.notes));
  if (!arguments.table.empty()) {
    write_calibrated_table(arguments.table, found, arguments.output.policy);
    session.say(fmt::format(
        "wrote {}\nnext: tofsmith decode RAW --code {} --camera {} -o depth.npy", arguments.table,
        arguments.table,
        arguments.output.camera_path.empty() ? "CAMERA.toml" : arguments.output.camera_path));
  }
  write_maps(arguments, found, session);
  arguments.output.write_page(
      correlation_report(found, fits, arguments.file(), session.command_line), session);
  if (!arguments.output.camera_path.empty()) {
    if (fits.empty())
      throw UsageError("-o: no code was fitted, so the impulse responses are unknown");
    arguments.output.write_camera(with_fit(base, fits.front(), found.tap_mismatch), session);
  }
}

}  // namespace

void add_calibrate_correlation(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<CorrelationArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "correlation",
      "correlation functions, pixel maps and impulse responses from a flat target at known delays");
  command
      ->add_option("SWEEP", arguments->files,
                   "a table with delay and K measurements per row (.csv .txt), an array (N,K) "
                   "with N equal steps of delay over one period (.npy .npz), or a stack of F "
                   "frames (F,H,W,K) with --shifts; with --reference, raw frames as for decode, "
                   "in one file or one file per measurement")
      ->required();
  const FieldOptions sweep(*command, arguments->sweep);
  sweep.add("shifts");
  sweep.add("unit", "--shift-unit");
  CLI::Option* reference = command->add_option(
      "--reference", arguments->reference,
      "calibrate with reference depth instead of delays: true depth in m (.npy .npz .exr .pfm "
      ".png; NaN or 0: unknown), or one distance per frame (.npy); requires --code");
  add_option_of(*command,
                Field("reference_kind", arguments->reference_kind,
                      Help{"kind of --reference: depth along the ray (radial) or along the optical "
                           "axis (z), which is converted with the camera's [lens]"},
                      IfAbsent{"as stated in the file, otherwise radial"}),
                "--reference-kind")
      ->needs(reference);
  const FieldOptions frames(*command, arguments->frames);
  frames.add("raw_format")->needs(reference);
  frames.add("dataset")->needs(reference)->group(for_experts);
  command->add_option("--dark", arguments->dark,
                      "frames with the light off, under the same ambient light as the sweep");
  command
      ->add_option("--target-distance-m", arguments->target_distance_m,
                   "distance of a flat target perpendicular to the optical axis, whose depth "
                   "variation is removed from the offset map")
      ->check(positive_number())
      ->group(for_experts);
  command
      ->add_option("--code", arguments->codes,
                   "codes to compare with: families or files (default: all built-in codes)")
      ->delimiter(',');
  sweep.add("decimal")->group(for_experts);
  sweep.add("table_axes")->group(for_experts);
  sweep.add("keep_end_point")->group(for_experts);
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  command->add_option("--table", arguments->table,
                      "write the measured table (.npz), for decode --code");
  command->add_option("--offset-map", arguments->offset_map,
                      "write each pixel's offset in metres (.npy .npz .exr .pfm)");
  command->add_option("--gain-map", arguments->gain_map, "write each pixel's gain");
  arguments->output.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
