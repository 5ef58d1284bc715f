// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/waveforms/export_report.hpp"

namespace tofsmith::apps {

namespace {

struct CodesArguments {
  std::string name;
  int samples = 0;
  std::string output;
  CameraArguments camera;
  TapArguments taps;
};

void list(const Session& session) {
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  std::string text;
  for (const FamilyDescription& family : list_families()) {
    document.push_back(
        {{"name", family.name}, {"example", family.example}, {"description", family.description}});
    text += fmt::format("  {:28} {}\n", family.name, family.description);
  }
  session.print_json(document);
  session.say("Built-in families (a number replaces the capital letter):\n" + text +
              "Show one with `tofsmith codes hamiltonian-k4`.");
}

/// Returns a waveform over one period as one line of characters.
std::string strip(const Waveform& waveform) {
  constexpr int cells = 60;
  const Eigen::VectorXd values = waveform.cell_averages(cells);
  const double least = std::min(values.minCoeff(), 0.0);  // weights of rows may be negative
  const double span = std::max(values.maxCoeff() - least, 1e-12);
  constexpr std::string_view shades = " .:-=+*#";
  std::string text;
  for (int n = 0; n < cells; ++n)
    text += shades[static_cast<std::size_t>(
        std::min(7.0, std::floor(7.999 * (values[n] - least) / span)))];
  return text;
}

/// Returns the number of switching times, or the kind of a waveform that is not binary.
std::string edges_text(const Waveform& waveform) {
  if (waveform.is_binary()) return fmt::format("{}", waveform.edges());
  return waveform.is_sampled() ? "sampled" : "cosines";
}

std::string counted(int count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// Returns headings and one row per tap value. Rows of weights have weights instead of a duty.
std::vector<std::vector<std::string>> waveform_rows(const CodeSet& code, std::string_view value) {
  std::vector<std::vector<std::string>> rows{
      {std::string(value), "mod. duty", "mod. peak", "edges"}};
  if (code.is_rows())
    rows[0].insert(rows[0].end(), {"min weight", "max weight"});
  else if (code.is_signed())
    rows[0].insert(rows[0].end(), {"mean weight", "edges"});
  else
    rows[0].insert(rows[0].end(), {"dem. duty", "edges"});
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform& m = code.modulation_of(i);
    const Waveform& d = code.demodulation(i);
    rows.push_back({fmt::format("{}", i + 1), fmt::format("{:.4f}", m.duty()),
                    fmt::format("{:.3f}", m.peak()), edges_text(m)});
    if (code.is_rows())
      rows.back().insert(rows.back().end(),
                         {fmt::format("{:.4g}", d.minimum()), fmt::format("{:.4g}", d.peak())});
    else
      rows.back().insert(rows.back().end(),
                         {fmt::format("{:.4f}", code.is_signed() ? 2.0 * d.mean() - 1.0 : d.mean()),
                          edges_text(d)});
  }
  return rows;
}

void show(const Session& session, const CodeSet& code, const Camera& camera) {
  const ForwardModel model(code, camera);
  const Eigen::MatrixXd table = model.correlation_table(8 * code.samples());
  // The sensor reads out one measurement per tap value, or differences of pairs.
  const int measurements = model.measurements();
  const bool are_differences = measurements < code.measurements();
  nlohmann::ordered_json document = {{"name", code.name()},
                                     {"samples", code.samples()},
                                     {"exposures", code.exposures()},
                                     {"taps", code.taps()},
                                     {"measurements", measurements},
                                     {"peak", code.peak()},
                                     {"coding_curve_length", coding_curve_length(table)},
                                     {"coding_curve_rank", coding_curve_rank(table)},
                                     {"harmonics_99_percent", harmonics_used(table)}};
  std::string strips;
  for (int i = 0; i < code.measurements(); ++i) {
    const Waveform& m = code.modulation_of(i);
    const Waveform& d = code.demodulation(i);
    document["per_measurement"].push_back({{"modulation_duty", m.duty()},
                                           {"modulation_peak", m.peak()},
                                           {"modulation_edges", m.edges()},
                                           {"demodulation_duty", d.mean()},
                                           {"demodulation_edges", d.edges()}});
    if (code.is_signed())
      document["per_measurement"].back()["demodulation_mean_weight"] = 2.0 * d.mean() - 1.0;
    strips += fmt::format("  m{:<2} |{}|\n  d{:<2} |{}|\n", i + 1, strip(m), i + 1, strip(d));
  }
  const std::vector<GeneratorReport> generators = generator_report(code, camera);
  if (!generators.empty())
    document["generators"] = nlohmann::ordered_json::parse(generators_document(generators));
  session.print_json(document);
  session.say(fmt::format(
      "{} on {}: {}{}, {}, N = {}, peak {:.3g}\n"
      "coding curve: length {:.4g}, rank {}, 99 % of its energy within {}\n\n{}\n{}",
      code.name(), camera.name, counted(measurements, "measurement"),
      are_differences ? fmt::format(" (differences of {} tap values)", code.measurements()) : "",
      counted(code.exposures(), "exposure"), code.samples(), code.peak(),
      coding_curve_length(table), coding_curve_rank(table),
      counted(harmonics_used(table), "harmonic"),
      text_table(waveform_rows(code, are_differences ? "tap value" : "measurement")), strips));
  if (!generators.empty())
    session.say("Nominal and actual waveforms of the generators, before the impulse responses:\n" +
                text_table(generator_report_rows(generators)));
}

void write(const Session& session, const CodeSet& code, const Camera& camera,
           const std::filesystem::path& path, std::optional<TapOrder> order) {
  session.check_output(path);
  if (path.extension() == ".csv")
    write_file_atomically(path, waveforms_to_csv(code, camera.fundamental_frequency_hz),
                          session.output_policy());
  else if (path.extension() == ".html")
    write_file_atomically(path, render(code_page(code, camera, session.command_line)),
                          session.output_policy());
  else
    write_code(path, code, session.output_policy(), order);
}

}  // namespace

void add_codes_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<CodesArguments>();
  CLI::App* command = app.add_subcommand(
      "codes", "list the built-in code families, or print, plot and save one code");
  command->add_option("NAME", arguments->name, "family or code file");
  command
      ->add_option("-N,--samples", arguments->samples, "samples per period (default: the camera's)")
      ->check(integer_in(8, 65536));
  command->add_option("-o,--output", arguments->output,
                      "output file: .code.json, .npz, .csv, or .html (a page with plots)");
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  command->callback([arguments, &session] {
    if (arguments->name.empty()) {
      if (!arguments->output.empty()) throw UsageError("-o requires the NAME of a code");
      return list(session);
    }
    if (arguments->samples > 0)
      arguments->camera.settings.push_back(fmt::format("samples={}", arguments->samples));
    const Camera camera = arguments->camera.load();
    require_no_measured_table(arguments->name);
    const CodeSet code =
        load_code(arguments->name, camera, arguments->taps.file_for({arguments->name}));
    if (!arguments->output.empty())
      write(session, code, camera, arguments->output, arguments->taps.file.tap_order);
    show(session, code, camera);
    if (!arguments->output.empty()) session.say(fmt::format("wrote {}", arguments->output));
  });
}

}  // namespace tofsmith::apps
