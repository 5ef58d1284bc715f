// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/decode_tables.hpp"

#include <fmt/format.h>

#include <limits>
#include <span>

#include "decode/shared/saturation_level.hpp"
#include "gpu/table_words.hpp"

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
  const auto define = [&](const char* name, int value) {
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
  define("STATUS_OK", static_cast<int>(PixelStatus::ok));
  define("STATUS_INVALID", static_cast<int>(PixelStatus::invalid));
  define("STATUS_NO_RETURN", static_cast<int>(PixelStatus::no_return));
  define("STATUS_SATURATED", static_cast<int>(PixelStatus::saturated));
  define("STATUS_LOW_SIGNAL", static_cast<int>(PixelStatus::low_signal));
  define("STATUS_INCONSISTENT", static_cast<int>(PixelStatus::inconsistent));
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

}  // namespace tofsmith
