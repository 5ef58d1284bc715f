// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device_tables.hpp"

#include <fmt/format.h>

#include <limits>
#include <span>

#include "decode/shared/marked_raw.hpp"

namespace tofsmith {

namespace {

class Words : public TableWords {
 public:
  using TableWords::add;
  using TableWords::TableWords;

  int add(const RecordTable& table) { return add(std::span(table.data(), table.size())); }
  /// Without doubles on the device, adds pairs of floats (value and rounding error).
  int add_doubles(const std::vector<double>& table, bool has_doubles) {
    if (has_doubles) return add(table);
    std::vector<float> pairs;
    for (const double value : table) {
      pairs.push_back(static_cast<float>(value));
      pairs.push_back(static_cast<float>(value - pairs.back()));
    }
    return add(pairs);
  }
};

ProjectionParameters parameters_of(const TileProjection& projection, Words& words) {
  const ProjectionView& view = projection.view();
  const auto count = static_cast<std::size_t>(view.measurements),
             rank = static_cast<std::size_t>(view.rank);
  // Half a unit in the last place of floats.
  std::vector<float> of_rounding;
  for (const double error : projection.error_per_rounding())
    of_rounding.push_back(static_cast<float>(0.51 * std::numeric_limits<float>::epsilon() * error));
  return {.ratios = words.add(std::span(view.ratio, count)),
          .weights = words.add(std::span(view.weight, rank * count)),
          .offsets = words.add(std::span(view.offset, rank)),
          .errors_of_difference = words.add(std::span(view.error_of_difference, count)),
          .errors_of_rounding = words.add(of_rounding),
          .reference = view.reference,
          .error_of_reference = view.error_of_reference,
          .error_of_offset = view.error_of_offset};
}

void add_circle(const CircleSearch& circle, Words& words, MatchParameters& p) {
  p.way = by_angle;
  p.pieces = words.add(circle.pieces());
  p.resolution = circle.resolution();
  p.margin = circle.margin();
  p.overlap = CirclePiece::overlap;
}

void add_cells(const CellSearch& cells, Words& words, MatchParameters& p) {
  const CellSearchView& view = cells.view();
  p.way = by_cells;
  p.root_bits = view.root_bits;
  p.cut_bits = view.cut_bits;
  p.roots = words.add(cells.table().roots());
  p.cells = words.add(cells.table().cells());
  p.lists = words.add(cells.table().lists());
  p.directions = view.count;
  p.steps = words.add(cells.steps());
  p.units = words.add(cells.units());
  p.bins = view.bin ? words.add(cells.bins()) : -1;
  p.fit_unit = view.fit_unit;
  p.slack_unit = static_cast<float>(CellRecord::slack_unit);
  p.steepest_fit = view.steepest_fit;
  p.rounding = view.rounding;
  p.reach = static_cast<float>(max_proven_error);
}

void add_arcs(const ArcTable& arcs, const DirectionTable& directions, Words& words,
              MatchParameters& p) {
  const Margins margins = margins_of(arcs.rank());
  const auto block = static_cast<std::size_t>(arcs.rank() + 1) * block_lanes;
  std::vector<float> radii;
  for (std::int32_t w = 0; w < arcs.windows(); ++w) radii.push_back(arcs.window_radius(w));
  p.way = by_arcs;
  p.row_blocks = arcs.row_blocks();
  p.rows = words.add(std::span(arcs.rows(0), static_cast<std::size_t>(p.row_blocks) * block));
  p.window_count = arcs.windows();
  p.windows = words.add(std::span(arcs.window(0), radii.size() * block));
  p.window_radii = words.add(radii);
  p.bins_of_rows = words.add(directions.bins_by_row());
  p.lead = margins.lead;
  p.tie = margins.tie;
}

MatchParameters parameters_of(const BinMatcher& matcher, Words& words) {
  const DirectionTable& directions = matcher.directions();
  MatchParameters p{};
  p.projection = parameters_of(matcher.projection(), words);
  p.samples = directions.samples();
  p.bins_of_points = -1;
  add_arcs(matcher.arcs().table(), directions, words, p);
  if (const auto* circle = std::get_if<CircleSearch>(&matcher.search()))
    add_circle(*circle, words, p);
  else if (const auto* cells = std::get_if<CellSearch>(&matcher.search()))
    add_cells(*cells, words, p);
  return p;
}

OutputParameters parameters_of(const Decoder& decoder, const OutputKernel& kernel,
                               const RawScale& scale, bool has_doubles, Words& words) {
  const OutputConstants& c = kernel.constants();
  const BinRecords& records = kernel.records();
  std::vector<double> dark_raw, gain_e_per_raw;
  for (int k = 0; k < decoder.measurements(); ++k) {
    dark_raw.push_back(scale.dark_raw(k));
    gain_e_per_raw.push_back(scale.gain_e_per_raw(k));
  }
  const SaturationLevels levels(decoder.table());
  OutputParameters p{};
  p.samples = c.samples;
  p.bin_m = c.bin_m;
  p.bin_high_m = c.bin_high_m;
  p.bin_low_m = c.bin_low_m;
  p.range_m = c.range_m;
  p.sees_ambient = c.sees_ambient ? 1 : 0;
  p.ambient_weights = words.add(c.ambient_weight);
  p.typical_ambient = c.typical_ambient;
  p.typical_floor_e2 = c.typical_floor_e2;
  p.low_signal_sigma2 = c.low_signal_sigma2;
  p.sure_lead = sure_lead;
  p.records = words.add(records.records);
  p.record_stride = records.records.stride();
  p.chords = words.add(records.chords);
  p.chord_blocks = ChordLayout::blocks;
  p.chord_quarters = ChordLayout::quarters;
  p.dark_raw = words.add_doubles(dark_raw, has_doubles);
  p.gain_e_per_raw = words.add_doubles(gain_e_per_raw, has_doubles);
  p.lowest = levels.lowest;
  p.highest = levels.highest;
  p.limits = words.add(kernel.limits());
  p.limit_stride = kernel.limits().stride();
  p.off_plane = words.add(c.off_plane);
  p.off_plane_count = c.off_plane_count;
  p.residual_basis = words.add(c.residual_basis);
  p.ambient_direction = words.add(c.ambient_direction);
  p.half_quantile = c.half_quantile;
  p.shot_ambient = words.add(c.shot_ambient);
  p.floor_noise = words.add(c.floor_noise_e2);
  p.least_shot = c.least_shot;
  p.least_shot_ambient = c.least_shot_ambient;
  p.least_floor_e2 = c.least_floor_e2;
  return p;
}

std::string options_of(const RecordLayout& layout, bool has_doubles) {
  std::string options = has_doubles ? "-D HAS_DOUBLES" : "";
  const auto define = [&](std::string_view name, int value) {
    options += fmt::format(" -D {}={}", name, value);
  };
  define("MEASUREMENTS", layout.measurements);
  define("RANK", layout.rank);
  define("RECORD_POINT", layout.point());
  if (layout.is_smooth) {
    define("RECORD_SLOPE", layout.slope());
    define("RECORD_BEND", layout.bend());
    define("RECORD_ASYMMETRY", layout.asymmetry());
    define("RECORD_GROWTH", layout.growth());
  } else {
    define("RECORD_LEFT", layout.left());
    define("RECORD_RIGHT", layout.right());
    define("RECORD_TURN", layout.turn());
    define("RECORD_REACH", layout.reach());
  }
  define("RECORD_AMBIENT", layout.ambient());
  define("RECORD_SIGNAL_NOISE", layout.signal_noise());
  define("RECORD_BOUND", layout.bound());
  define("RECORD_SHOT", layout.shot());
  define("CHORD_FIELDS", ChordLayout::fields);
  define("CHORD_DEPTH_NOISE", ChordLayout::depth_noise);
  define("CHORD_AMBIENT", ChordLayout::ambient);
  for (const PixelStatus status : all_pixel_statuses)
    define(fmt::format("STATUS_{}", name_of(status)), static_cast<int>(status));
  define("LIMIT_VARIANCE", LimitLayout::variance);
  define("LIMIT_ERROR", LimitLayout::error);
  define("LIMIT_ROOT", LimitLayout::root);
  define("LIMIT_PER_FREEDOM", LimitLayout::per_freedom);
  return options;
}

}  // namespace

DecodeTables::DecodeTables(const Decoder& decoder, bool has_doubles) {
  const auto [matcher, kernel] = parts_of(decoder);
  Words words_at(words);
  is_coarse = matcher.is_coarse();
  points = parameters_of(matcher.points(), words_at);
  if (matcher.has_close_lobes()) {
    // Leaves all pixels open: the CPU decoder chooses between the lobes.
    points.way = by_arcs;
    points.lead = std::numeric_limits<float>::infinity();
  }
  bins = is_coarse ? parameters_of(matcher.bins(), words_at) : points;
  if (!matcher.bin_of_point().empty()) {
    points.bins_of_points = words_at.add(matcher.bin_of_point());
  }
  outputs = parameters_of(decoder, kernel, matcher.bins().exact().scale(), has_doubles, words_at);
  outputs.projection = points.projection;
  options = options_of(kernel.records().layout, has_doubles);
}

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
