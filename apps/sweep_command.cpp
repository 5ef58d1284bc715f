// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "commands.hpp"
#include "session.hpp"
#include "sweep_page.hpp"
#include "sweep_shard.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/sweep/run_sweep.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith::apps {
namespace {

constexpr std::int64_t max_items_unasked = 10'000'000;

struct SweepArguments {
  std::string sweep, store, report, shard;
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
  const SweepRunOptions options{.shard = parse_shard(arguments.shard)};
  const OutputPolicy policy = check_outputs(arguments, session);
  const WorkList list = read_list(arguments);
  const Progress progress = terminal_progress("sweep");
  const std::vector<std::string> keys = list.keys(progress);
  SweepStore store =
      arguments.status ? SweepStore::read(arguments.store) : SweepStore::open(arguments.store);
  SweepRun done;
  if (!arguments.status) {
    session.directory = arguments.store;
    done = run_sweep(list, keys, store, options, progress);
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
  command->add_option("--shard", arguments->shard,
                      "i/n: compute only the i-th of n parts; sweep merge combines their stores");
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
