// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>

#include "commands.hpp"
#include "design_effort.hpp"
#include "design_output.hpp"
#include "fresh_directory.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/optimize.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/result_document.hpp"

namespace tofsmith::apps {
namespace {

/// Multipath that designed codes shall stand: `--multipath`, `--multipath-weight`,
/// `--two-return-weight`.
class OperatingMultipathArguments {
 public:
  void add_to(CLI::App& command);
  /// Puts what was asked for into operating.multipath, over what the camera says there.
  /// @throws UsageError for what cannot be read or be
  void apply_to(Camera& camera) const;
  /// @throws UsageError for a weight of two returns on a camera that meets none
  void apply_to(OptimizeOptions& options, const Camera& camera) const;

 private:
  std::string returns_;
  std::optional<double> weight_, two_return_weight_;
};

/// One number, or two with a colon between: least and largest. Whether it is either.
bool read_limits(const std::string& text, std::array<double, 2>& limits) {
  if (text.find(':') != std::string::npos) return read_number_pair(text, ':', limits[0], limits[1]);
  if (!CLI::detail::lexical_cast(text, limits[0])) return false;
  limits[1] = limits[0];
  return true;
}

void read_multipath(const std::string& text, OperatingMultipath& returns) {
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    const bool is_known = key == "ratio" || key == "delta";
    if (!is_known || !read_limits(value, key == "ratio" ? returns.ratio : returns.delay_m))
      throw UsageError(fmt::format(
          "--multipath {}: found '{}'; expected ratio=a:b,delta=a:b (metres)", text, part));
  }
}

void require_operating_multipath(const Camera& camera, const char* option) {
  if (!camera.operating.multipath)
    throw UsageError(fmt::format(
        "{}: found no multipath; expected --multipath or a camera with [operating.multipath]",
        option));
}

void OperatingMultipathArguments::add_to(CLI::App& command) {
  command.add_option("--multipath", returns_,
                     "count with multipath, pixels that have a second return: "
                     "ratio=.1:.5,delta=.5:3 (metres), each uniform between its limits; over "
                     "[operating.multipath]");
  command
      .add_option("--multipath-weight", weight_,
                  "w of E1^(1-w) E2^w, the errors without and with multipath, in (0, 1)")
      ->check(number_that("in (0, 1)", [](double w) { return w > 0.0 && w < 1.0; }));
  command
      .add_option("--two-return-weight", two_return_weight_,
                  fmt::format("weight of the error decoded as two returns in the search, so that "
                              "codes can be decoded so; 0: none (default: {})",
                              OptimizeOptions{}.two_return_weight))
      ->check(number_from_0_on());
}

void OperatingMultipathArguments::apply_to(Camera& camera) const {
  std::optional<OperatingMultipath>& multipath = camera.operating.multipath;
  if (!returns_.empty()) {
    if (!multipath) multipath.emplace();
    read_multipath(returns_, *multipath);
    try {
      multipath->validate(camera.range_m());
    } catch (const std::invalid_argument& error) {
      throw UsageError(fmt::format("--multipath {}: {}", returns_, error.what()));
    }
  }
  if (!weight_) return;
  require_operating_multipath(camera, "--multipath-weight");
  multipath->weight = *weight_;
}

void OperatingMultipathArguments::apply_to(OptimizeOptions& options, const Camera& camera) const {
  if (!two_return_weight_) return;
  require_operating_multipath(camera, "--two-return-weight");
  options.two_return_weight = *two_return_weight_;
}

struct DesignArguments {
  CameraArguments camera;
  std::string method = "best";
  std::string target;
  bool normalize = false;
  std::vector<int> exposures;  // none: those of DesignOptions
  double effort = 1.0;
  int atlas_cameras = DesignOptions{}.atlas_cameras;
  bool robust = false;
  OperatingMultipathArguments multipath;
  std::uint64_t seed = 1;
  int trials = 20000;
  double outlier_threshold_m = DesignOptions{}.outlier_threshold_m;
  std::string output;
};

DesignOptions options_for(const DesignArguments& arguments, const Camera& camera) {
  DesignOptions options;
  if (!arguments.target.empty() && !arguments.exposures.empty())
    throw UsageError("--exposures goes with Hamiltonian targets; a --target says how many it has");
  options.method = parse_design_method(arguments.method);
  options.robust = arguments.robust;
  if (arguments.robust && options.method != DesignMethod::optimize &&
      options.method != DesignMethod::best)
    throw UsageError("--robust goes with --method optimize or best");
  if (!arguments.target.empty() && options.method != DesignMethod::factorize &&
      options.method != DesignMethod::best)
    throw UsageError("--target goes with --method factorize or best");
  if (arguments.normalize && !is_correlation_table(arguments.target))
    throw UsageError("--normalize goes with a --target that is a table; codes are as they are");
  if (camera.operating.multipath && options.robust)
    throw UsageError(
        "--robust: found beside multipath (--multipath or [operating.multipath]); "
        "expected one of them");
  options.exposures = arguments.exposures;
  if (arguments.effort == 0.0 && !arguments.target.empty())
    throw UsageError("--effort 0 designs nothing: it goes without --target");
  if (arguments.effort == 0.0 && options.method != DesignMethod::best &&
      options.method != DesignMethod::atlas)
    throw UsageError(
        fmt::format("--effort 0 searches nothing: it goes without --method {}", arguments.method));
  options = with_effort(std::move(options), arguments.effort);
  arguments.multipath.apply_to(options.optimize, camera);
  options.atlas_cameras = arguments.atlas_cameras;
  options.seed = arguments.seed;
  options.trials = arguments.trials;
  options.outlier_threshold_m = arguments.outlier_threshold_m;
  if (!arguments.target.empty())
    options.target = load_target(arguments.target, camera, arguments.normalize);
  return options;
}

void run(const DesignArguments& arguments, const Session& session) {
  Camera camera = arguments.camera.load();
  arguments.multipath.apply_to(camera);
  const DesignOptions options = options_for(arguments, camera);
  if (arguments.output.empty()) {
    const DesignResult result = design(camera, options, terminal_progress("designing"));
    print_design(session, camera, result, options);
    return;
  }
  const FreshDirectory cleanup(arguments.output);
  const DesignDirectory directory(arguments.output);
  if (directory.holds_design() && !session.force)
    throw IoError((directory.path() / "design.json").string(),
                  "already exists; use --force to replace the finished design, or another -o DIR "
                  "(`tofsmith report` makes its page again)");
  // Without its last file but with codes under way the directory is that of a run that was stopped,
  // perhaps while it wrote its results: this one goes on.
  const bool goes_on =
      !directory.holds_design() && std::filesystem::exists(directory.path() / "finished");
  const OutputPolicy policy = goes_on ? OutputPolicy::overwrite : session.output_policy();
  for (const char* name : {"camera.toml", "details.json", "report.html"})
    if (std::filesystem::exists(directory.path() / name))
      session.check_output(directory.path() / name, policy);
  const DesignResult result =
      design(camera, options, terminal_progress("designing"), directory.store(camera, options));
  directory.write(camera, result, options, policy);
  write_report(session, directory.path(), policy);
  print_design(session, camera, result, options);
  session.say(fmt::format("wrote {}", (directory.path() / "report.html").string()));
}

}  // namespace

void add_design_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand(
      "design", "find the modulation and demodulation functions that suit a camera");
  arguments->camera.add_positional(*command);
  arguments->camera.add_to(*command);
  command
      ->add_option("--method", arguments->method,
                   "factorize: factorize correlation functions; optimize: minimize depth error "
                   "itself; search: all codes on a chip clock, with proof; best: all that suit the "
                   "camera, with every baseline as a competitor; atlas: nothing is searched, "
                   "codes of the atlas and standard codes are judged")
      ->check(one_of({"factorize", "optimize", "search", "best", "atlas"}))
      ->capture_default_str();
  command->add_option("--target", arguments->target,
                      "correlation functions to factorize: a family, a code file, or a table "
                      "(.csv .npy .npz); default: Hamiltonian codes");
  command->add_flag("--normalize", arguments->normalize,
                    "rescale a table's columns to [0, 1] before use");
  command
      ->add_option(
          "--exposures", arguments->exposures,
          "numbers of exposures to try (3,4,5), or of rows; default: what suits the camera")
      ->delimiter(',')
      ->check(CLI::Range(1, 16));
  add_effort(*command, arguments->effort);
  command
      ->add_option("--atlas-cameras", arguments->atlas_cameras,
                   "how many of the nearest cameras of the atlas lend codes, which compete and are "
                   "where searches start; 0: none")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_flag("--robust", arguments->robust,
                    "optimize for the worst of ±20 % bandwidth, ±10 % peak, 50 ps edge jitter "
                    "and 2 % tap mismatch");
  arguments->multipath.add_to(*command);
  command->add_option("--seed", arguments->seed, "seed of every random choice")
      ->capture_default_str();
  command->add_option("--trials", arguments->trials, "trials per operating point for final figures")
      ->check(CLI::Range(1000, 100000000))
      ->capture_default_str();
  command
      ->add_option("--outlier-threshold", arguments->outlier_threshold_m,
                   "circular errors beyond this many metres are outliers in final figures")
      ->check(number_from_0_on())
      ->capture_default_str()
      ->group(for_experts);
  command->add_option("-o,--output", arguments->output,
                      "directory for codes, figures and the report; an interrupted run resumes");
  command->callback([arguments, &session] {
    session.directory = arguments->output;
    run(*arguments, session);
  });
}

}  // namespace tofsmith::apps
