// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "multipath_evaluation.hpp"

#include <fmt/format.h>

#include "number_checks.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/multipath_document.hpp"
#include "tofsmith/report/multipath_section.hpp"

namespace tofsmith::apps {

void MultipathEvaluation::add_to(CLI::App& command) {
  CLI::Option* multipath = command.add_flag(
      "--multipath", asked_,
      "instead: bias and error of direct depth behind a second return or a tail, single-path "
      "against two-return decoding, with the Cramer-Rao bound");
  const auto list = [&](const char* name, std::vector<double>& values, const char* help) {
    command.add_option(name, values, help)->delimiter(',')->capture_default_str()->needs(multipath);
  };
  list("--delays", options_.delay_m, "delays of the second return [m]");
  list("--ratios", options_.ratio, "its ratios to the direct one");
  list("--tails", options_.tail_m, "mean delays of tails [m]");
  list("--signals", options_.signal_e_per_s, "signals of the direct return [e/s]");
  command.add_option("--multipath-ambient", options_.ambient_e_per_s, "ambient light [e/s]")
      ->capture_default_str()
      ->needs(multipath);
  command
      .add_option("--threshold", options_.decoding.threshold,
                  "how much chi^2 must fall for a second return to count")
      ->check(number_from_0_on())
      ->capture_default_str()
      ->needs(multipath);
}

void MultipathEvaluation::run(const std::vector<CodeSet>& codes, const Camera& camera,
                              std::int64_t trials, std::uint64_t seed, const std::string& output,
                              const Session& session) const {
  MultipathErrorOptions options = options_;
  if (trials > 0) options.trials = trials;
  options.seed = seed;
  options.validate(camera.range_m());
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".csv")
    throw UsageError(
        fmt::format("-o {}: found .csv; expected .json or .html with --multipath", output));
  std::vector<MultipathErrorReport> reports;
  const Progress progress = terminal_progress("evaluating");
  const double count = static_cast<double>(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    reports.push_back(multipath_error(
        codes[i], camera, options,
        part_of(progress, static_cast<double>(i) / count, static_cast<double>(i + 1) / count)));
  if (extension == ".json")
    write_file_atomically(output, multipath_document(camera, reports, options) + "\n",
                          session.output_policy());
  if (extension == ".html") {
    const Page page{.title = "Where light comes back twice",
                    .subtitle = "camera " + camera.name,
                    .sections = {multipath_section(reports)},
                    .footer = fmt::format("{} trials per place, seed {}", options.trials, seed)};
    write_file_atomically(output, render(page), session.output_policy());
  }
  if (session.json) return session.print_document(multipath_document(camera, reports, options));
  session.say(text_table(multipath_rows(reports)));
  for (const MultipathErrorReport& report : reports)
    if (!report.why_no_two_returns.empty())
      session.say(
          fmt::format("{}: no two-return decoding: {}", report.code, report.why_no_two_returns));
  session.say(fmt::format(
      "{} trials per place, seed {}, A = {:.3g} e/s, N = {}; 1: single-path, 2: two returns or "
      "tail; gain: error 1 over error 2",
      options.trials, seed, options.ambient_e_per_s, camera.samples));
}

}  // namespace tofsmith::apps
