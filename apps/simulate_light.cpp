// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate_light.hpp"

#include <fmt/format.h>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"

namespace tofsmith::apps {

namespace {

/// Parses "delta=1.0,ratio=0.3", in any order.
MultipathReturn parse_multipath_return(const std::string& text) {
  std::optional<float> delay_m, ratio;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    float value = 0.0f;
    const bool is_number =
        equals != std::string::npos && CLI::detail::lexical_cast(part.substr(equals + 1), value);
    if (!is_number || (key != "delta" && key != "ratio"))
      throw UsageError(fmt::format("--multipath {}: found '{}'; expected delta=METRES,ratio=NUMBER",
                                   text, part));
    (key == "delta" ? delay_m : ratio) = value;
  }
  if (!delay_m || !ratio)
    throw UsageError(fmt::format("--multipath {}: found no {}; expected delta=METRES,ratio=NUMBER",
                                 text, delay_m ? "ratio" : "delta"));
  return {*delay_m, *ratio};
}

}  // namespace

void MultipathLightArguments::add_to(CLI::App& command) {
  command.add_option("--multipath", multipath_,
                     "add a second return to every pixel: delta=METRES,ratio=NUMBER (repeatable, "
                     "in order of delay)");
  CLI::Option* tail =
      command
          .add_option("--tail", tail_m_,
                      "add an exponential tail to every pixel, with this mean delay [m]")
          ->check(positive_number())
          ->group(for_experts);
  command
      .add_option("--tail-ratio", tail_ratio_, "light of the tail relative to the direct return")
      ->check(number_from_0_on())
      ->capture_default_str()
      ->needs(tail)
      ->group(for_experts);
  command
      .add_option("--multipath-file", returns_,
                  "multipath returns of every pixel: an .npz file with three arrays, named first, "
                  "distance_m and ratio")
      ->group(for_experts);
  CLI::Option* transient = command
                               .add_option("--transient", transient_,
                                           "histogram of arrival times (.npy), over which the "
                                           "signal of a pixel is distributed: (T,) for all "
                                           "pixels, or (H,W,T)")
                               ->group(for_experts);
  const FieldOptions options(command, transients_);
  transient_bin_ = options.add("bin_s", "--transient-bin-s");
  transient_bin_->default_str("")->needs(transient)->group(for_experts);
  options.add("origin", "--transient-origin")->needs(transient)->group(for_experts);
  options.add("background", "--transient-background")->needs(transient)->group(for_experts);
  CLI::Option* bounces = command
                             .add_option("--bounces", bounces_,
                                         "1: add light reflected by one other surface of the "
                                         "scene, computed by ray tracing; 0: none")
                             ->check(integer_in(0, 1))
                             ->capture_default_str();
  add_field_option(command, bounce_, "rays", "--bounce-rays")->needs(bounces)->group(for_experts);
  command
      .add_option("--truth-multipath", truth_,
                  "also write the true distance and signal of every return (.npz)")
      ->group(for_experts);
}

MultipathReturns MultipathLightArguments::bounced(const LoadedScene& scene,
                                                  const Camera& camera) const {
  if (!multipath_.empty() || !returns_.empty() || !transient_.empty())
    throw UsageError(
        "--bounces: found together with --multipath, --multipath-file or --transient; expected one "
        "of them");
  return bounced_light_of(scene, camera, bounce_, terminal_progress("gathering light"));
}

SceneLight MultipathLightArguments::load(const LoadedScene& loaded, const Camera& camera) const {
  const SceneImage& scene = loaded.image;
  if (!transient_.empty() && (!multipath_.empty() || tail_m_ || !returns_.empty()))
    throw UsageError(
        "--transient: found together with --multipath, --tail or --multipath-file; expected none "
        "of them, because --transient contains all light of a pixel");
  if (!returns_.empty() && !multipath_.empty())
    throw UsageError("--multipath-file: found together with --multipath; expected one of them");
  if (!transient_.empty() && transient_bin_->count() == 0)
    throw UsageError(
        "--transient: found no --transient-bin-s; expected the duration of one bin in seconds");
  SceneLight light;
  if (!multipath_.empty()) {
    std::vector<MultipathReturn> behind;
    for (const std::string& text : multipath_) behind.push_back(parse_multipath_return(text));
    light.returns = behind_every_pixel(scene, behind);
  }
  if (!returns_.empty())
    light.returns = read_multipath_returns(returns_, scene.height(), scene.width());
  if (bounces_ > 0) light.returns = bounced(loaded, camera);
  if (tail_m_) light.tail = ExponentialTail{*tail_m_, tail_ratio_};
  if (!transient_.empty())
    light.transients = read_transients(transient_, scene.height(), scene.width(), transients_);
  light.validate(scene, camera);
  return light;
}

}  // namespace tofsmith::apps
