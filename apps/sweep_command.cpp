// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "described_options.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {

namespace {

constexpr std::size_t max_rows = 1000;
constexpr std::size_t max_maps = 10, max_map_codes = 6, max_map_side = 64;
constexpr std::size_t max_written_cells = 100;
constexpr double wide_ratio = 30.0;  // axes with at least this ratio are logarithmic

/// Returns true if an axis gets a figure. Linked axes share the figure of the axis to which they
/// are linked.
bool can_be_drawn(const SweepAxis& axis) {
  return !axis.linked && axis.values.size() > 1 && axis.key != "seed" &&
         std::ranges::all_of(axis.values,
                             [](const SettingValue& value) { return value.number.has_value(); });
}

bool is_wide(const SweepAxis& axis) {
  const auto [low, high] =
      std::ranges::minmax(axis.values, {}, [](const SettingValue& value) { return *value.number; });
  return *low.number > 0.0 && *high.number / *low.number >= wide_ratio;
}

/// Errors of one code at one value of an axis, for all values of the other axes.
struct Group {
  std::vector<Estimate> linear_m, circular_m;
};

/// Returns the keys of an axis and of the axes linked to it.
std::string label_of(const SweepSpec& spec, std::size_t a) {
  std::string label = spec.axes[a].key;
  for (std::size_t i = a + 1; i < spec.axes.size() && spec.axes[i].linked; ++i)
    label += ", " + spec.axes[i].key;
  return label;
}

/// Returns an id of a figure: other characters than letters and digits become dashes.
std::string figure_id(std::string id) {
  constexpr std::string_view letters_and_digits =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  for (std::size_t i = 0; (i = id.find_first_not_of(letters_and_digits, i)) != std::string::npos;)
    id[i++] = '-';
  return id;
}

Series series_of(const std::string& code, const SweepAxis& axis,
                 const std::map<std::size_t, Group>& groups, std::vector<Estimate> Group::*errors_m,
                 const LineStyle& style) {
  std::size_t whole = 0;
  for (const auto& [index, group] : groups) whole = std::max(whole, group.linear_m.size());
  std::vector<std::pair<double, Estimate>> points;
  for (const auto& [index, group] : groups) {
    Estimate mean = geometric_mean_of(group.*errors_m);
    // Incomplete means are not comparable; leave a gap until all items are finished.
    if (group.linear_m.size() < whole) mean.value = std::numeric_limits<double>::quiet_NaN();
    points.emplace_back(*axis.values[index].number, mean);
  }
  std::ranges::sort(points, {}, [](const auto& point) { return point.first; });
  Series series{.name = code, .mark = Mark::line_and_markers, .style = style};
  for (const auto& [x, mean] : points) {
    series.x.push_back(x);
    series.y.push_back(1e3 * mean.value);
    series.y_error.push_back(1e3 * mean.standard_error);
  }
  return series;
}

Figure axis_figure(const WorkList& list, std::span<const SweepResult> results, std::size_t a,
                   ColourAssignment& colours) {
  const SweepAxis& axis = list.spec().axes[a];
  std::vector<std::string> codes;
  std::map<std::string, std::map<std::size_t, Group>> groups;
  for (const SweepResult& result : results) {
    const std::string& code = result.error.code;
    if (!groups.contains(code)) codes.push_back(code);
    Group& group = groups[code][list.spec().value_indices(result.item)[a]];
    group.linear_m.push_back(result.error.linear.geometric_mean_m);
    group.circular_m.push_back(result.error.circular.geometric_mean_m);
  }
  const std::string label = label_of(list.spec(), a);
  const Axis x{.label = label, .logarithmic = is_wide(axis)};
  const auto column = [&](const char* title) {
    return PanelColumn{title, x, {.label = "mean depth error", .unit = "mm", .logarithmic = true}};
  };
  PanelRow row{"", {{}, {}}};
  for (const std::string& code : codes) {
    const LineStyle style = colours.style(code);
    row.panels[0].push_back(series_of(code, axis, groups[code], &Group::linear_m, style));
    row.panels[1].push_back(series_of(code, axis, groups[code], &Group::circular_m, style));
  }
  return small_multiples(
      {.id = figure_id("axis-" + axis.key),
       .title = "Depth error over " + label,
       .caption = "Geometric mean over operating points and over all values of the other axes, "
                  "with one standard error."},
      {column("linear"), column("circular")}, {row});
}

/// Returns the indices of an axis' values, sorted by number.
std::vector<std::size_t> in_order(const SweepAxis& axis) {
  std::vector<std::size_t> order(axis.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return *axis.values[i].number; });
  return order;
}

CategoryAxis category_axis(const SweepSpec& spec, std::size_t a) {
  CategoryAxis axis{.label = label_of(spec, a)};
  for (const std::size_t i : in_order(spec.axes[a]))
    axis.ticks.push_back(fmt::format("{:.4g}", *spec.axes[a].values[i].number));
  return axis;
}

using Cells = std::map<std::pair<std::size_t, std::size_t>, Group>;

/// Returns errors over two axes; NaN where no item is finished.
HeatMap map_of(const SweepSpec& spec, std::size_t x, std::size_t y, const Cells& cells,
               std::vector<Estimate> Group::*errors_m, std::string title) {
  const std::vector<std::size_t> columns = in_order(spec.axes[x]), rows = in_order(spec.axes[y]);
  HeatMap map{std::move(title),
              Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(rows.size()),
                                        static_cast<Eigen::Index>(columns.size()), std::nan(""))};
  std::size_t whole = 0;
  for (const auto& [place, group] : cells) whole = std::max(whole, (group.*errors_m).size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c)
      // Incomplete means are not comparable.
      if (const auto cell = cells.find({columns[c], rows[r]});
          cell != cells.end() && (cell->second.*errors_m).size() == whole)
        map.values(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
            1e3 * geometric_mean_of(cell->second.*errors_m).value;
  return map;
}

/// Returns a map of the depth error over two axes; none if they do not form a grid (zipped axes).
std::optional<Figure> map_figure(const SweepSpec& spec, std::span<const SweepResult> results,
                                 std::size_t x, std::size_t y) {
  std::vector<std::string> codes;
  std::map<std::string, Cells> cells;
  std::set<std::pair<std::size_t, std::size_t>> places;
  for (const SweepResult& result : results) {
    const std::string& code = result.error.code;
    if (!cells.contains(code)) codes.push_back(code);
    const std::vector<std::size_t> indices = spec.value_indices(result.item);
    Group& group = cells[code][{indices[x], indices[y]}];
    group.linear_m.push_back(result.error.linear.geometric_mean_m);
    group.circular_m.push_back(result.error.circular.geometric_mean_m);
    places.emplace(indices[x], indices[y]);
  }
  const std::size_t width = spec.axes[x].values.size(), height = spec.axes[y].values.size();
  if (places.size() <= std::max(width, height)) return std::nullopt;
  const std::size_t shown = std::min(codes.size(), max_map_codes);
  std::vector<HeatMap> maps;
  for (std::size_t i = 0; i < shown; ++i) {
    const Cells& of_code = cells[codes[i]];
    maps.push_back(map_of(spec, x, y, of_code, &Group::linear_m, codes[i] + ", linear"));
    maps.push_back(map_of(spec, x, y, of_code, &Group::circular_m, codes[i] + ", circular"));
  }
  const std::string over = label_of(spec, x) + " and " + label_of(spec, y);
  std::string caption =
      "Geometric mean over operating points and over all values of the other axes.";
  if (shown < codes.size())
    caption += fmt::format(" The first {} of {} codes.", shown, codes.size());
  return heat_map_figure({.id = figure_id("map-" + spec.axes[x].key + "-" + spec.axes[y].key),
                          .title = "Depth error over " + over,
                          .caption = std::move(caption)},
                         maps, category_axis(spec, x), category_axis(spec, y),
                         {.label = "mean depth error", .unit = "mm", .logarithmic = true},
                         {.columns = 2, .show_values = width * height <= max_written_cells});
}

/// Returns maps for all pairs of numeric axes, up to a maximum number.
std::vector<Block> map_figures(const SweepSpec& spec, std::span<const SweepResult> results) {
  std::vector<Block> figures;
  const auto fits = [&](const SweepAxis& axis) {
    return can_be_drawn(axis) && axis.values.size() <= max_map_side;
  };
  for (std::size_t y = 0; y < spec.axes.size(); ++y)
    for (std::size_t x = y + 1; x < spec.axes.size(); ++x)
      if (fits(spec.axes[x]) && fits(spec.axes[y]) && figures.size() < max_maps)
        if (auto figure = map_figure(spec, results, x, y)) figures.emplace_back(*std::move(figure));
  return figures;
}

Table results_table(const WorkList& list, std::span<const SweepResult> results) {
  const SweepSpec& spec = list.spec();
  Table table{.caption = "Geometric means over the operating points of each item."};
  if (results.size() > max_rows)
    table.caption +=
        fmt::format(" The first {} of {} items; --export writes all.", max_rows, results.size());
  table.columns = {{"item", true}, {"code"}};
  for (const SweepAxis& axis : spec.axes)
    if (axis.key != "code") table.columns.push_back({axis.key, true});
  for (const char* header : {"linear (mm)", "circular (mm)", "outliers (%)"})
    table.columns.push_back({header, true});
  for (const SweepResult& result : results.first(std::min(results.size(), max_rows))) {
    std::vector<std::string> row = {fmt::format("{}", result.item + 1), result.error.code};
    const std::vector<std::size_t> indices = spec.value_indices(result.item);
    for (std::size_t a = 0; a < spec.axes.size(); ++a)
      if (spec.axes[a].key != "code") row.push_back(spec.axes[a].values[indices[a]].text);
    double outliers = 0.0;
    for (const PointDepthError& point : result.error.points) outliers += point.outlier_rate.value;
    row.push_back(estimate_mm_text(result.error.linear.geometric_mean_m));
    row.push_back(estimate_mm_text(result.error.circular.geometric_mean_m));
    row.push_back(
        fmt::format("{:.2f}", 100 * outliers / static_cast<double>(result.error.points.size())));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Returns a sweep as a page: its progress, a figure for every numeric axis, a map for every pair
/// of numeric axes, and a table of all errors.
Page sweep_page(const WorkList& list, std::span<const SweepResult> results,
                const SweepCounts& counts, const std::string& command_line) {
  const SweepSpec& spec = list.spec();
  Page page{.title = "Sweep", .subtitle = spec.source_name, .footer = "tofsmith " TOFSMITH_VERSION};
  KeyValueList settings{{{"camera", spec.camera}}};
  for (const std::string& setting : spec.settings) settings.entries.push_back({"set", setting});
  settings.entries.push_back({"trials", fmt::format("{}", spec.options.trials)});
  settings.entries.push_back({"seed", fmt::format("{}", spec.options.seed)});
  settings.entries.push_back({"decoder", std::string(name_of(spec.options.method))});
  for (std::size_t a = 0; a < spec.axes.size(); ++a)
    if (!spec.axes[a].linked)
      settings.entries.push_back(
          {"axis", fmt::format("{}: {} values", label_of(spec, a), spec.axes[a].values.size())});
  page.sections.push_back({"Items",
                           {KeyNumbers{{{"items", fmt::format("{}", list.size())},
                                        {"finished", fmt::format("{}", results.size())},
                                        {"computing time", time_text(counts.seconds)}}},
                            std::move(settings), CodeBlock{command_line}}});
  if (results.empty()) return page;
  ColourAssignment colours;
  Section figures{"Depth error over each axis", {}};
  for (std::size_t a = 0; a < spec.axes.size(); ++a)
    if (can_be_drawn(spec.axes[a]))
      figures.blocks.push_back(axis_figure(list, results, a, colours));
  if (!figures.blocks.empty()) page.sections.push_back(std::move(figures));
  if (std::vector<Block> maps = map_figures(spec, results); !maps.empty())
    page.sections.push_back({"Depth error over two axes", std::move(maps)});
  page.sections.push_back({"All items", {results_table(list, results)}, SectionLayout::folded});
  return page;
}

constexpr std::int64_t max_items_unasked = 10'000'000;

struct SweepArguments {
  std::string sweep, store, report;
  SweepRunOptions options;
  std::vector<std::string> exports;
  bool status = false, yes = false;
};

struct MergeArguments {
  std::string output;
  std::vector<std::filesystem::path> parts;
};

OutputPolicy check_outputs(const SweepArguments& arguments, const Session& session) {
  std::vector<std::filesystem::path> outputs(arguments.exports.begin(), arguments.exports.end());
  for (const auto& path : outputs)
    if (const auto kind = path.extension(); kind != ".csv" && kind != ".json" && kind != ".npz")
      throw UsageError(fmt::format("--export {}: unknown extension; expected .csv, .json or .npz",
                                   path.string()));
  if (!arguments.report.empty()) {
    outputs.emplace_back(arguments.report);
    if (outputs.back().extension() != ".html")
      throw UsageError(fmt::format("--report {}: expected .html", arguments.report));
  }
  return session.check_outputs(outputs);
}

WorkList read_list(const SweepArguments& arguments) {
  WorkList list(read_sweep_toml(arguments.sweep));
  if (list.size() > max_items_unasked && !arguments.yes)
    throw UsageError(fmt::format("{}: found {:.3g} items; expected at most {:.3g}, or --yes",
                                 arguments.sweep, static_cast<double>(list.size()),
                                 static_cast<double>(max_items_unasked)));
  return list;
}

void write_export(const std::filesystem::path& path, const WorkList& list,
                  std::span<const SweepResult> results, const SweepStore& store,
                  OutputPolicy policy) {
  if (path.extension() == ".csv")
    write_file_atomically(path, sweep_csv(list, results), policy);
  else if (path.extension() == ".json")
    write_file_atomically(path, sweep_json(list, results, store.target()), policy);
  else
    write_npz(path, sweep_arrays(list, results), policy);
}

void write_outputs(const SweepArguments& arguments, const WorkList& list,
                   std::span<const std::string> keys, SweepStore& store, const SweepCounts& counts,
                   OutputPolicy policy, const Session& session) {
  if (arguments.exports.empty() && arguments.report.empty()) return;
  const std::vector<SweepResult> results = sweep_results(list, keys, store);
  for (const std::string& path : arguments.exports)
    write_export(path, list, results, store, policy);
  if (!arguments.report.empty())
    write_file_atomically(arguments.report,
                          render(sweep_page(list, results, counts, session.command_line)), policy);
}

void print(const SweepArguments& arguments, std::int64_t items, const SweepCounts& counts,
           const SweepRun& run, const Session& session) {
  session.print_json(
      {{"tofsmith", TOFSMITH_VERSION},
       {"store", arguments.store},
       {"items", items},
       {"distinct", counts.finished + counts.failed + counts.running + counts.pending},
       {"finished", counts.finished},
       {"failed", counts.failed},
       {"running", counts.running},
       {"pending", counts.pending},
       {"seconds", counts.seconds},
       {"computed", run.computed}});
  std::string line =
      fmt::format("{}: {} items: {} finished", arguments.store, items, counts.finished);
  if (counts.running > 0) line += fmt::format(", {} running", counts.running);
  if (counts.failed > 0) line += fmt::format(", {} failed", counts.failed);
  if (counts.pending > 0) line += fmt::format(", {} to do", counts.pending);
  line += fmt::format(" ({} of computing time)", time_text(counts.seconds));
  if (!arguments.status) line += fmt::format("; {} computed now", run.computed);
  session.say(line);
  for (const std::string& path : arguments.exports) session.say("export: " + path);
  if (!arguments.report.empty()) session.say("report: " + arguments.report);
}

void run(const SweepArguments& arguments, Session& session) {
  if (arguments.sweep.empty()) throw UsageError("SWEEP is required");
  if (arguments.store.empty()) throw UsageError("--store is required");
  const OutputPolicy policy = check_outputs(arguments, session);
  const WorkList list = read_list(arguments);
  const Progress progress = terminal_progress("sweep");
  const std::vector<std::string> keys = list.keys(progress);
  SweepStore store =
      arguments.status ? SweepStore::read(arguments.store) : SweepStore::open(arguments.store);
  SweepRun done;
  if (!arguments.status) {
    session.directory = arguments.store;
    done = run_sweep(list, keys, store, arguments.options, progress);
  }
  report(progress, 1.0, "done");
  const SweepCounts counts = store.count(keys);
  write_outputs(arguments, list, keys, store, counts, policy, session);
  print(arguments, list.size(), counts, done, session);
  if (!done.failures.empty())
    throw std::runtime_error(fmt::format("{} of {} items failed; first failure: {}",
                                         done.failures.size(), list.size(), done.failures.front()));
}

void merge(const MergeArguments& arguments, Session& session) {
  session.check_output(arguments.output);
  AtomicFile file(arguments.output, session.output_policy());
  try {
    SweepStore::merge(file.temporary_path(), arguments.parts);
  } catch (const IoError& error) {
    if (error.place() != file.temporary_path()) throw;
    throw IoError(arguments.output, error.problem());
  }
  file.commit();
  session.print_json({{"tofsmith", TOFSMITH_VERSION},
                      {"store", arguments.output},
                      {"merged", arguments.parts.size()}});
  session.say(fmt::format("{}: {} stores merged", arguments.output, arguments.parts.size()));
}

}  // namespace

void add_sweep_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand(
      "sweep",
      "evaluate depth errors over cameras, codes, light levels and seeds, and store the results "
      "in an SQLite file");
  command->add_option(
      "SWEEP", arguments->sweep,
      "sweep file (.toml) with camera, codes and an [[axis]] for each varied quantity");
  command->add_option("--store", arguments->store,
                      "SQLite file for results; finished items (combinations of axis values) are "
                      "not computed again");
  command->add_flag("--status", arguments->status,
                    "only list, export and report finished items, without computing others");
  command->add_option("--export", arguments->exports, "write results (.csv .json .npz; repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--report", arguments->report, "write a page (.html)");
  add_field_option(*command, arguments->options, "shard");
  command->add_flag("--yes", arguments->yes, "allow more than 1e7 items");

  auto merging = std::make_shared<MergeArguments>();
  CLI::App* merger = command->add_subcommand("merge", "merge several stores into one");
  merger->add_option("OUT", merging->output, "new store")->required();
  merger->add_option("STORE", merging->parts, "stores to merge")->required();
  merger->callback([merging, &session] { merge(*merging, session); });
  command->callback([arguments, command, &session] {
    if (command->get_subcommands().empty()) run(*arguments, session);
  });
}

}  // namespace tofsmith::apps
