// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "commands.hpp"
#include "described_options.hpp"
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

/// Options of multipath for which codes are designed: `--multipath`, `--multipath-weight`,
/// `--two-return-weight`.
class OperatingMultipathArguments {
 public:
  /// @param options  receives the weight of two returns
  void add_to(CLI::App& command, OptimizeOptions& options);
  /// Overrides operating.multipath of the camera by the given options.
  /// @throws UsageError for invalid values, and for a weight on a camera without multipath
  void apply_to(Camera& camera) const;

 private:
  std::string returns_;
  std::optional<double> weight_;
  const CLI::Option* two_return_weight_ = nullptr;
};

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

void OperatingMultipathArguments::add_to(CLI::App& command, OptimizeOptions& options) {
  command.add_option(
      "--multipath", returns_,
      "design for pixels with a second return; its ratio and delay [m] are uniformly distributed "
      "in the given ranges, such as ratio=0.1:0.5,delta=0.5:3; overrides [operating.multipath]");
  command
      .add_option("--multipath-weight", weight_,
                  fmt::format("weight w in the objective E1^(1-w) E2^w; E1 is the error without "
                              "multipath, E2 the error with multipath (default: the camera's "
                              "operating.multipath.weight, otherwise {})",
                              OperatingMultipath().weight))
      ->check(number_that("in (0, 1)", [](double w) { return w > 0.0 && w < 1.0; }));
  two_return_weight_ = add_field_option(command, options, "two_return_weight");
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
  if (two_return_weight_->count() > 0) require_operating_multipath(camera, "--two-return-weight");
  if (!weight_) return;
  require_operating_multipath(camera, "--multipath-weight");
  multipath->weight = *weight_;
}

struct DesignArguments {
  CameraArguments camera;
  std::string target;
  bool normalize = false;
  double effort = 1.0;
  DesignOptions options;
  OperatingMultipathArguments multipath;
  std::string output;
};

DesignOptions options_for(const DesignArguments& arguments, const Camera& camera) {
  DesignOptions options = arguments.options;
  if (!arguments.target.empty() && !options.exposures.empty())
    throw UsageError(
        "--exposures is only valid with Hamiltonian targets; a --target determines its number of "
        "exposures");
  if (options.robust && options.method != DesignMethod::optimize &&
      options.method != DesignMethod::best)
    throw UsageError("--robust is only valid with --method optimize or best");
  if (!arguments.target.empty() && options.method != DesignMethod::factorize &&
      options.method != DesignMethod::best)
    throw UsageError("--target is only valid with --method factorize or best");
  if (arguments.normalize && !is_correlation_table(arguments.target))
    throw UsageError("--normalize is only valid with a --target that is a table");
  if (camera.operating.multipath && options.robust)
    throw UsageError(
        "--robust: found together with multipath (--multipath or [operating.multipath]); expected "
        "one of them");
  if (camera.operating.interference && options.robust)
    throw UsageError(
        "--robust: found together with [operating.interference]; expected one of them");
  if (arguments.effort == 0.0 && !arguments.target.empty())
    throw UsageError("--effort 0 does not design codes: it cannot be combined with --target");
  if (arguments.effort == 0.0 && options.method != DesignMethod::best &&
      options.method != DesignMethod::atlas)
    throw UsageError(
        fmt::format("--effort 0 does not search: it cannot be combined with --method {}",
                    name_of(options.method)));
  options = with_effort(std::move(options), arguments.effort);
  if (!arguments.target.empty())
    options.target = load_target(arguments.target, camera, arguments.normalize);
  return options;
}

/// Returns the first of tofsmith-design, tofsmith-design-2, ... without a finished design.
std::string default_output() {
  std::string name = "tofsmith-design";
  for (int i = 2; std::filesystem::exists(std::filesystem::path(name) / "design.json"); ++i)
    name = fmt::format("tofsmith-design-{}", i);
  return name;
}

void run(const DesignArguments& arguments, const Session& session) {
  Camera camera = arguments.camera.load();
  arguments.multipath.apply_to(camera);
  const DesignOptions options = options_for(arguments, camera);
  const FreshDirectory cleanup(arguments.output);
  const DesignDirectory directory(arguments.output);
  if (directory.holds_design() && !session.force)
    throw IoError((directory.path() / "design.json").string(),
                  "already exists; use --force to replace the finished design, or another -o DIR "
                  "(`tofsmith report` rebuilds its page)");
  // A directory with finished codes but without design.json, which is written last, belongs to an
  // interrupted run. This run resumes it.
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
  const std::string folder = directory.path().string();
  session.say(
      fmt::format("wrote {0}/report.html\nnext: tofsmith export {0}/codes/{1}.code.json --camera "
                  "{0}/camera.toml --format FORMAT -o waveforms",
                  folder, result.winner().code.name()));
}

}  // namespace

void add_design_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command =
      app.add_subcommand("design", "design modulation and demodulation functions for a camera");
  arguments->camera.add_to(*command);
  arguments->camera.add_positional(*command);
  const FieldOptions options(*command, arguments->options);
  options.add("method");
  command->add_option("--target", arguments->target,
                      "target correlation functions to factorize: a family, a code file or a "
                      "table (.csv .npy .npz) (default: Hamiltonian codes)");
  command->add_flag("--normalize", arguments->normalize,
                    "rescale the columns of a target table to [0, 1]");
  options.add("exposures")->allow_extra_args();
  add_effort(*command, arguments->effort);
  options.add("atlas_cameras");
  arguments->camera.add_key_option(*command, "sensor.decoder", "--decoder")->group(for_experts);
  options.add("robust");
  options.add("split_exposures");
  arguments->multipath.add_to(*command, arguments->options.optimize);
  options.add("seed");
  options.add("trials");
  options.add("outlier_threshold_m", "--outlier-threshold")->group(for_experts);
  add_field_option(*command, arguments->options.search, "metric", "--search-metric")
      ->group(for_experts);
  options.add_others({"best_rotation", "search_trials", "outlier_threshold_m"});
  command->add_option(
      "-o,--output", arguments->output,
      "output directory for codes and report; repeating the command resumes an interrupted run "
      "(default: tofsmith-design; if it contains a finished design, tofsmith-design-2, ...)");
  command->callback([arguments, &session] {
    if (arguments->output.empty()) arguments->output = default_output();
    session.directory = arguments->output;
    run(*arguments, session);
  });
}

}  // namespace tofsmith::apps
