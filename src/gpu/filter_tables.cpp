// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/filter_tables.hpp"

#include <fmt/format.h>

#include <limits>
#include <span>

#include "decode/shared/saturation_level.hpp"
#include "gpu/table_words.hpp"

namespace tofsmith {

namespace {

class Constants {
 public:
  void add(const char* name, int value) { text_ += fmt::format("#define {} {}\n", name, value); }
  /// Enough digits to restore the float; independent of the locale.
  void add(const char* name, float value) {
    text_ += fmt::format("#define {} {:.9e}f\n", name, value);
  }
  void add_steps(const char* name, std::span<const WindowStep> steps) {
    std::string rows, columns;
    for (const WindowStep& step : steps) {
      rows += fmt::format("{}, ", step.rows);
      columns += fmt::format("{}, ", step.columns);
    }
    text_ +=
        fmt::format("constant int {0}_rows[] = {{{1}}};\nconstant int {0}_columns[] = {{{2}}};\n",
                    name, rows, columns);
  }
  void add_bars() {
    std::string lengths, depths, most, enough, scales;
    for (const LitBar& bar : lit_bars) {
      lengths += fmt::format("{}, ", bar.length);
      depths += fmt::format("{}, ", bar.depth);
      most += fmt::format("{:.9e}f, ", bar.max_added_sigma);
      enough += fmt::format("{:.9e}f, ", bar.enough_share / lit_bar_scale(bar, bar.depth));
      for (int rows = 1; rows <= bar.depth; ++rows)
        scales += fmt::format("{:.9e}f, ", lit_bar_scale(bar, rows));
    }
    text_ += fmt::format(
        "constant int lit_lengths[] = {{{}}};\nconstant int lit_depths[] = {{{}}};\n"
        "constant float lit_max_added[] = {{{}}};\nconstant float lit_enough[] = {{{}}};\n"
        "constant float lit_scales[] = {{{}}};\n",
        lengths, depths, most, enough, scales);
    add_steps("lit_point", lit_bar_points());
    add("LIT_BARS", static_cast<int>(lit_bars.size()));
    add("LIT_DIRECTIONS", lit_directions);
    add("LIT_PIXEL_SIGMA", lit_pixel_sigma);
    add("LIT_BAR_SHARE", lit_bar_share);
    add("LIT_AROUND_SIGMA", lit_around_sigma);
    add("LIT_EXCESS_SIGMA", lit_excess_sigma);
    add("LIT_SMALL_BARS", lit_small_bars);
    add("LIT_BRIGHT_SHARE", lit_bright_share);
    add("LIT_BRIGHT_SIGMA", lit_bright_sigma);
    add("LIT_BRIGHT_REACH", lit_bright_reach);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string constants_of(const Filter::Plan& plan, bool fuses) {
  Constants c;
  if (fuses) c.add("FUSES_PRODUCTS", 1);
  c.add("MEASUREMENTS", plan.measurements);
  c.add("RANK", plan.rank);
  c.add("PLANE_USABLE", FilterPlanes::usable);
  c.add("PLANE_VARIANCE", FilterPlanes::variance);
  c.add("PLANE_ENERGY", FilterPlanes::energy);
  c.add("PLANE_INVERSE_SIGMA", FilterPlanes::inverse_sigma);
  c.add("PLANE_SLOPE_X", FilterPlanes::energy);
  c.add("PLANE_SLOPE_Y", FilterPlanes::inverse_sigma);
  c.add("PLANE_DEPTH", FilterPlanes::depth);
  c.add("PLANE_DEPTH_VARIANCE", FilterPlanes::depth_variance);
  c.add("PLANE_SIGNAL", FilterPlanes::signal);
  c.add("PLANE_SIGNAL_NEXT", FilterPlanes::signal_next);
  c.add("PLANE_AMPLITUDE", FilterPlanes::signal_next);
  c.add("PLANE_SHIFT", FilterPlanes::shift);
  c.add("PLANE_REJECTED", FilterPlanes::rejected);
  c.add("PLANE_BEFORE", before_plane(plan.measurements));
  c.add("PATCH_REACH", patch_reach);
  c.add("WINDOW_REACH", window_reach);
  c.add("HALF_WINDOW", static_cast<int>(half_window.size()));
  c.add_steps("half_window", half_window);
  c.add("HALF_RINGS", static_cast<int>(half_rings.size()));
  c.add_steps("half_ring", half_rings);
  c.add("FIRST_FAR_RING", static_cast<int>(first_far_ring));
  c.add("MIN_DEPTH_VARIANCE", min_depth_variance);
  c.add("COMPARED_REACH", compared_reach);
  c.add("COMPARED_STEP", compared_step);
  c.add("LEAST_NOISE_SHARE", least_noise_share);
  c.add("LINE_SIDE", line_side);
  c.add("LINE_STEP", line_step);
  c.add("LINE_DIRECTIONS", static_cast<int>(line_directions.size()));
  c.add_steps("line_direction", line_directions);
  c.add("EXPLAINED_BY_NOISE", explained_by_noise);
  c.add("EXPLAINED_ALONG_LINES", explained_along_lines);
  c.add("HALF_KEPT", half_kept);
  c.add("HALF_KEPT_ALONG_LINES", half_kept_along_lines);
  c.add("KEPT_NOISE", kept_noise);
  c.add("LEAST_ENERGY", least_energy);
  c.add("SLOPE_NOISE_OF_NEAR", slope_noise_of_near);
  c.add("BRIGHT_SIGMA", bright_sigma);
  c.add("EXPLAINED_IN_PATCH", explained_in_patch);
  c.add("BALANCED_LIGHT", balanced_light);
  c.add("SLOPE_ERROR_SHARE", slope_error_share);
  c.add("BALANCED_ENERGY", balanced_energy);
  c.add("EVIDENT_SIGMA", evident_sigma);
  c.add("LIT_ALONE_SHARE", lit_alone_share);
  c.add("LIT_BAR_SIGMA", plan.lit_bar_sigma());
  c.add("EDGE_BIAS_FROM", edge_bias.from);
  c.add("EDGE_BIAS_FULL", edge_bias.full);
  c.add("EDGE_BIAS_NEAR", edge_bias.near);
  c.add("OWN_LIGHT_REACH", own_light_reach);
  c.add("OWN_LIGHT_LEAST_SIGMA", own_light_least_sigma);
  c.add("OWN_LIGHT_LEAST_SHARE", own_light_least_share);
  c.add("OWN_LIGHT_SHARE", own_light_share);
  c.add("OWN_LIGHT_BELOW_MEAN", own_light_below_mean);
  c.add("OWN_LIGHT_NOISE", own_light_noise);
  c.add_bars();
  return c.text();
}

}  // namespace

int light_plane(int set, int measurements) { return FilterPlanes::scalars + set * measurements; }

int before_plane(int measurements) { return light_plane(FilterPlanes::light_sets, measurements); }

FilterTables::FilterTables(const Filter::Plan& plan, bool fuses)
    : source(constants_of(plan, fuses) + std::string(filter_kernels)) {
  TableWords tables(words);
  std::vector<float> dark_e, gain_e_per_raw, dark_raw, raw_per_e;
  for (int k = 0; k < plan.measurements; ++k) {
    const RawScale& scale = plan.scale;
    dark_e.push_back(static_cast<float>(scale.electrons(0.0, k)));
    gain_e_per_raw.push_back(static_cast<float>(scale.electrons(1.0, k) - scale.electrons(0.0, k)));
    dark_raw.push_back(static_cast<float>(scale.raw(0.0, k)));
    raw_per_e.push_back(static_cast<float>(scale.raw(1.0, k) - scale.raw(0.0, k)));
  }
  const FilterOptions& options = plan.options;
  FilterParameters& p = parameters;
  p.to_coordinates = tables.add(plan.to_coordinates);
  p.to_measurements = tables.add(plan.to_measurements);
  p.curve = tables.add(plan.curve);
  p.squares = tables.add(plan.squares);
  p.dark_e = tables.add(dark_e);
  p.gain_e_per_raw = tables.add(gain_e_per_raw);
  p.dark_raw = tables.add(dark_raw);
  p.raw_per_e = tables.add(raw_per_e);
  p.shot_share = tables.add(plan.hidden.shot_share);
  p.samples = plan.samples();
  p.bins_per_m = static_cast<float>(1.0 / plan.decoder.table().row_m());
  const SaturationLevels levels(plan.decoder.table());
  p.lowest = levels.lowest;
  p.highest = levels.highest;
  p.floor_variance_e2 = plan.hidden.floor_variance_e2;
  p.shot_per_signal = plan.hidden.shot_per_signal;
  p.mean_curve_square = plan.hidden.mean_curve_square;
  p.has_own_shot_noise = plan.has_own_shot_noise ? 1 : 0;
  p.inverse_max_difference = 1.0f / static_cast<float>(options.max_difference_sigma);
  p.same_depth_sigma2 = static_cast<float>(options.same_depth_sigma * options.same_depth_sigma);
  p.own_light_sigma = static_cast<float>(options.own_light_sigma);
}

}  // namespace tofsmith
