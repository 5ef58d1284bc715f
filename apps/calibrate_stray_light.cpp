// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calibrate_output.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::apps {

namespace {

struct StrayLightArguments {
  std::string file, dark, kernel, page;
  CameraArguments camera;
};

nlohmann::ordered_json document_of(const CalibratedStrayLight& found) {
  nlohmann::ordered_json shares = nlohmann::ordered_json::array();
  for (const Estimate& share : found.share) shares.push_back(estimate_json(share));
  return {{"total", estimate_json(found.total)},
          {"radius_px", found.radius_px},
          {"share", shares},
          {"target_pixels", found.target_pixels},
          {"pixels", found.pixels},
          {"notes", found.notes}};
}

void run(const StrayLightArguments& arguments, const Session& session) {
  const Camera camera = arguments.camera.load();
  CalibrateOutput output{.camera_path = "", .page_path = arguments.page};
  output.check(session, {arguments.kernel});
  const RawFrames frames = read_raw_frames(arguments.file);
  RawFrames dark;
  if (!arguments.dark.empty()) dark = read_raw_frames(arguments.dark);
  CalibratedStrayLight found;
  try {
    found = calibrate_stray_light(frames, dark, camera, terminal_progress("calibrating"));
  } catch (const std::invalid_argument& error) {
    throw wrong_file(error, arguments.file, {{"dark size", arguments.dark}});
  }
  session.print_json(document_of(found));
  session.say(fmt::format(
      "{:.3f} % ± {:.3f} of all light is scattered, up to {:.0f} pixels away, estimated from {} "
      "pixels around a target of {} pixels\n{}",
      100.0 * found.total.value, 196.0 * found.total.standard_error, found.radius_px.back(),
      found.pixels, found.target_pixels, note_lines(found.notes)));
  if (!arguments.kernel.empty()) {
    write_float_image(arguments.kernel, found.kernel, "kernel", output.policy);
    session.say(fmt::format("wrote {}\nnext: tofsmith decode RAW --code CODE --stray-light {}",
                            arguments.kernel, arguments.kernel));
  }
  output.write_page(stray_light_report(found, arguments.file, session.command_line), session);
}

}  // namespace

void add_calibrate_stray_light(CLI::App& calibrate, Session& session) {
  auto arguments = std::make_shared<StrayLightArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "stray-light", "stray light of the lens, from frames of a small bright target");
  command
      ->add_option("RAW", arguments->file,
                   "raw frames (.npy .npz .h5), (H,W,K) or (F,H,W,K), of a small, bright, "
                   "unsaturated target on a black background")
      ->required();
  command->add_option("--dark", arguments->dark, "frames with the target covered");
  arguments->camera.add_to(*command);
  command->add_option("-o,--output", arguments->kernel,
                      "write the kernel (.npy .npz .exr .pfm), for decode --stray-light; it "
                      "contains the share of a pixel's light that each other pixel receives");
  command->add_option("--report", arguments->page, "write a page with figures (.html)");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
