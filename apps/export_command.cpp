// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands.hpp"
#include "described_options.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/waveforms/export_report.hpp"
#include "tofsmith/waveforms/write_export.hpp"

namespace tofsmith::apps {

namespace {

struct ExportArguments {
  std::string code, output;
  CameraArguments camera;
  TapArguments taps;
  ExportRequest request;
  EvaluateOptions evaluate{.trials = 2000};
  bool no_loss = false;
};

/// Converts invalid arguments to usage errors.
bool is_one_file(const ExportRequest& request) {
  try {
    return request.is_one_file();
  } catch (const InvalidArgument& error) {
    throw UsageError(fmt::format("--{}", error.what()));
  }
}

void say_report(const Session& session, const ExportedCode& exported) {
  session.say("Nominal and actual waveforms of the hardware, before the impulse responses:\n" +
              text_table(generator_report_rows(exported.generators)));
  if (!exported.loss) return;
  const DepthErrorKind kind = exported.actual.operating.error;
  session.say(fmt::format("{} depth error, {} trials each, same depths and noise:\n{}",
                          kind == DepthErrorKind::linear ? "Linear" : "Circular",
                          exported.loss->nominal.trials,
                          text_table(generator_loss_rows(*exported.loss, kind))));
}

/// Returns a text such as "3 SCPI scripts, "; empty for 0.
std::string script_count(std::size_t scripts) {
  if (scripts == 0) return "";
  return fmt::format("{} SCPI script{}, ", scripts, scripts == 1 ? "" : "s");
}

void run(ExportArguments& arguments, const Session& session) {
  ExportRequest& request = arguments.request;
  request.output = arguments.output;
  request.policy = session.output_policy();
  if (!arguments.no_loss) request.loss = arguments.evaluate;
  request.page = [&](const ExportedCode& exported) {
    return render(export_page(exported, session.command_line));
  };
  const bool one_file = is_one_file(request);
  if (one_file) session.check_output(request.output);
  const Camera camera = arguments.camera.load();
  require_no_measured_table(arguments.code);
  const ExportedCode exported =
      write_export(load_code(arguments.code, camera, arguments.taps.file_for({arguments.code})),
                   camera, request, terminal_progress("evaluating"));
  session.print_document(export_document(exported));
  say_report(session, exported);
  const std::size_t scripts = exported.scripts.size();
  const std::size_t tables = exported.files.size() - scripts - 2;  // manifest.json, report.html
  session.say(one_file ? fmt::format("wrote {}", arguments.output)
                       : fmt::format("wrote {} file{} of {}, {}manifest.json and report.html to {}",
                                     tables, tables == 1 ? "" : "s", request.options.format,
                                     script_count(scripts), arguments.output));
  for (const std::string& note : exported.notes) session.say("note: " + note);
}

std::string format_list() {
  std::string text = "Formats:\n";
  for (const WaveformFormat& format : waveform_formats()) {
    text += fmt::format("  {:15} {}\n", format.name, format.description);
    if (format.variants.empty()) continue;
    std::string names;
    for (const FormatVariant& variant : format.variants)
      names += (names.empty() ? "" : ", ") + variant.name;
    text += fmt::format("  {:15} --variant {}\n", "", names);
  }
  return text;
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export",
                         "write waveform files for generators and pattern memories, and "
                         "evaluate how the limits of this hardware change the depth error");
  ExportOptions& options = arguments->request.options;
  command->add_option("CODE", arguments->code, "family or code file (.code.json .npz .csv)")
      ->required();
  const FieldOptions fields(*command, options);
  fields.add("format")->required();
  fields.add("variant");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  fields.add("samples");
  fields.add("bits");
  fields.add("sample_rate_hz", "--rate");
  fields.add("edge_grid_s", "--edge-grid");
  fields.add("periods");
  add_volts_option(*command, options);
  const FieldOptions evaluate(*command, arguments->evaluate);
  evaluate.add("trials")->description("trials per operating point");
  evaluate.add("seed");
  command->add_flag("--no-loss", arguments->no_loss,
                    "do not evaluate the depth error with the exported waveforms");
  command
      ->add_option("-o,--output", arguments->output,
                   "directory for all files, manifest.json and report.html; or one file, for "
                   "formats with all waveforms in one file")
      ->required();
  command->footer(format_list());
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
