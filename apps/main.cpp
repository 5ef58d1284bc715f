// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The command line: tofsmith COMMAND. Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "interrupt.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/version.hpp"

namespace {

using namespace tofsmith;
using namespace tofsmith::apps;

constexpr int exit_failed = 1, exit_usage = 2, exit_interrupted = 130;

std::string as_typed(int argc, char** argv) {
  std::string line = "tofsmith";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    line += word.find_first_of(" \"'$\\") == std::string::npos ? " " + word : " '" + word + "'";
  }
  return line;
}

int run(int argc, char** argv) {
  Session session;
  session.command_line = as_typed(argc, argv);
  CLI::App app{
      "tofsmith designs, evaluates, simulates and decodes the coding functions of "
      "continuous-wave time-of-flight cameras."};
  app.set_version_flag("--version", "tofsmith " TOFSMITH_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.add_flag("--json", session.json, "print one JSON document on stdout and nothing else there");
  app.add_flag("--force", session.force, "overwrite existing output files");
  app.add_option("--threads", session.threads, "threads to use; 0 = every core")
      ->check(CLI::Range(0, 1024));
  app.footer("Try: tofsmith demo -o out    tofsmith codes    tofsmith design paper-10f0 -o out");
  std::unique_ptr<ThreadLimit> thread_limit;
  app.parse_complete_callback(
      [&] { thread_limit = std::make_unique<ThreadLimit>(session.threads); });

  add_demo_command(app, session);
  add_codes_command(app, session);
  add_design_command(app, session);
  add_evaluate_command(app, session);
  add_simulate_command(app, session);
  add_decode_command(app, session);
  add_report_command(app, session);

  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    app.exit(error);
    return exit_usage;
  }
}

}  // namespace

int main(int argc, char** argv) {
  catch_interrupts();
  try {
    return run(argc, argv);
  } catch (const Interrupted&) {
    fmt::print(stderr, "tofsmith: interrupted; finished files are kept\n");
    return exit_interrupted;
  } catch (const UsageError& error) {
    fmt::print(stderr, "tofsmith: {}\n", error.what());
    return exit_usage;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "tofsmith: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "tofsmith: {}\n", error.what());
  }
  return interrupted() ? exit_interrupted : exit_failed;
}
