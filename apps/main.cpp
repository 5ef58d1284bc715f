// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The command line: tofsmith COMMAND. Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted.

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <system_error>

#include "commands.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/build_info.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace {

using namespace tofsmith;
using namespace tofsmith::apps;

constexpr int exit_failed = 1, exit_usage = 2;

std::string as_typed(int argc, char** argv) {
  std::string line = "tofsmith";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    line += word.find_first_of(" \"'$\\") == std::string::npos ? " " + word : " '" + word + "'";
  }
  return line;
}

/// Returns the selected subcommand, or the program itself.
const CLI::App& chosen(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() ? app : chosen(*subcommands.front());
}

/// Adds the names of all options with a value, of the program and of all its subcommands.
void add_options_with_values(const CLI::App& app, std::set<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_type_size() == 0) continue;
    const std::vector<std::string> dashed = dashed_names(*option);
    names.insert(dashed.begin(), dashed.end());
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    add_options_with_values(*command, names);
}

/// Rejects empty values: commands treat an empty file name as missing, and CLI11 uses the next word
/// as the value of `--output=`.
void refuse_empty_values(const CLI::App& app, int argc, char** argv) {
  std::set<std::string> options;
  add_options_with_values(app, options);
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    const bool ends_open = word.ends_with('=');
    if (ends_open) word.pop_back();
    if (options.contains(word) && (ends_open || (i + 1 < argc && argv[i + 1][0] == '\0')))
      throw UsageError(fmt::format("{}: found an empty value; expected a value", word));
  }
}

/// Returns the names to suggest for an unknown word: options or commands.
std::vector<std::string> known_words(const CLI::App& app, bool options) {
  std::vector<std::string> words;
  for (const CLI::App* scope : {&chosen(app), &app})
    for (const CLI::Option* option : scope->get_options())
      for (const std::string& name : option->get_lnames())
        if (options && !option->get_group().empty()) words.push_back("--" + name);
  if (!options)
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      words.push_back(command->get_name());
  return words;
}

/// Returns the camera key with the name of an option, such as "sensor.taps" for "--taps"; "" if no
/// key matches.
std::string camera_key_of(std::string option) {
  option = option.substr(0, option.find('='));
  option.erase(0, option.find_first_not_of('-'));
  std::ranges::replace(option, '-', '_');
  return similar_camera_key(option);
}

/// Returns the name similar to an unknown option, command or subcommand; "" if none is similar.
std::string similar_name(std::string_view word, const std::vector<std::string>& known) {
  if (!word.starts_with("--")) return nearest_word(word, known);
  std::vector<std::string> names;  // the dashes, which all options share, are not similarities
  for (const std::string& name : known) names.push_back(name.substr(2));
  const std::string near = nearest_word(word.substr(2), names);
  return near.empty() ? near : "--" + near;
}

/// Returns the description of a wrong number or type of values in the words of this program.
/// @param text  of CLI11, such as "Could not convert: --order = 0-3"
std::string value_problem(const CLI::App& app, const std::string& text) {
  constexpr std::string_view prefix = "Could not convert: ", sign = " = ";
  if (text.starts_with(prefix)) {
    const std::size_t end = text.find(sign);
    const std::string option = text.substr(prefix.size(), end - prefix.size());
    const CLI::Option* found = chosen(app).get_option_no_throw(option);
    if (found == nullptr) found = app.get_option_no_throw(option);
    const bool is_whole =
        found != nullptr && found->get_type_name().find("INT") != std::string::npos;
    return fmt::format("{}: found {}; expected {}", option, text.substr(end + sign.size()),
                       is_whole ? "an integer" : "a number");
  }
  const std::string option = text.substr(0, text.find(':'));
  if (text.ends_with(" missing")) return fmt::format("{}: found no value; expected one", option);
  constexpr std::string_view received = " required but received ";  // "At least 2" precedes it
  const std::size_t at = text.find(received);
  if (at == std::string::npos) return text;
  const std::size_t number = text.rfind(' ', at - 1) + 1;
  return fmt::format("{}: found {} value(s); expected {}", option,
                     text.substr(at + received.size()), text.substr(number, at - number));
}

/// Returns a one-sentence description of the error in the arguments.
std::string usage_problem(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> rest = app.remaining(true);
  const bool lacks_command =
      dynamic_cast<const CLI::RequiredError*>(&error) != nullptr &&
      std::string_view(error.what()).find("subcommand") != std::string_view::npos;
  if (lacks_command && (rest.empty() || rest.front().starts_with('-')))
    return fmt::format("found no subcommand; expected one of {}",
                       fmt::join(known_words(chosen(app), false), ", "));
  if (!lacks_command && (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr || rest.empty()))
    return value_problem(app, error.what());
  const std::string& word = rest.front();
  const bool option = word.size() > 1 && word.front() == '-';
  const bool command = !option && (&chosen(app) == &app || lacks_command);
  const std::vector<std::string> known = known_words(option ? app : chosen(app), option);
  if (option && std::ranges::find(known, "--set") != known.end())
    if (const std::string key = camera_key_of(word); !key.empty())
      return fmt::format("unknown option '{}'; it is a key of the camera: --set {}=...", word, key);
  std::string near;
  if (option || command) near = similar_name(word, known);
  std::string text = fmt::format("{} '{}'",
                                 option    ? "unknown option"
                                 : command ? "unknown command"
                                           : "unexpected argument",
                                 word);
  if (!near.empty()) return text + fmt::format("; did you mean {}?", near);
  return command ? text + fmt::format("; expected one of {}", fmt::join(known, ", ")) : text;
}

int refuse_usage(const CLI::App& app, const std::string& problem) {
  fmt::print(stderr, "tofsmith: {}\nSee `tofsmith{} --help`.\n", printed(problem),
             command_words(chosen(app)));
  return exit_usage;
}

/// Flushes standard output. A full disk may be detected only here.
int finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  fmt::print(stderr, "tofsmith: standard output: cannot write: {}\n",
             std::generic_category().message(errno));
  return exit_failed;
}

/// Returns which output an interrupted command keeps.
std::string what_is_kept(const Session& session) {
  std::error_code ignored;
  const bool kept = std::filesystem::is_directory(session.directory, ignored) &&
                    !std::filesystem::is_empty(session.directory, ignored);
  const bool stored = std::filesystem::is_regular_file(session.directory, ignored);
  if (kept || stored)
    return fmt::format("; finished {} are kept in {}{}", kept ? "files" : "items",
                       session.directory.string(),
                       session.force ? "" : ", and the same command resumes from there");
  return session.tells_what_is_kept ? "" : "; nothing was written";
}

int stop_interrupted(const Session& session, bool is_done) {
  fmt::print(stderr, "tofsmith: interrupted{}\n",
             is_done ? "; all work was already done" : what_is_kept(session));
  return exit_interrupted;
}

/// Selects the instruction set named by TOFSMITH_TARGET, so that different machines give
/// bit-identical results.
void pin_target() {
  const char* const name = std::getenv("TOFSMITH_TARGET");
  if (name == nullptr || *name == '\0') return;
  try {
    pin_dispatch_target(name);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("TOFSMITH_TARGET: {}", error.what()));
  }
}

int run(int argc, char** argv) {
  pin_target();
  Session session;
  session.command_line = as_typed(argc, argv);
  session.words.assign(argv + std::min(argc, 1), argv + argc);
  CLI::App app{
      "tofsmith designs, evaluates, simulates and decodes the coding functions of "
      "continuous-wave time-of-flight cameras."};
  app.name("tofsmith");
  app.formatter(std::make_shared<HelpPages>());
  app.set_help_flag("-h,--help", "print the common options and exit");
  app.set_help_all_flag("--help-all", "print all options, including advanced ones, and exit");
  app.set_version_flag(
      "--version", [] { return to_text(build_info()); }, "print the version and exit");
  bool list_commands = false;
  app.add_flag("--list-commands", list_commands)->group("");  // input for the manual pages
  app.require_subcommand(0, 1);
  app.fallthrough();
  app.add_flag("--json", session.json, "print one JSON document, and nothing else, on stdout");
  app.add_flag_callback("--quiet", silence_progress, "do not print progress on standard error");
  app.add_flag("--force", session.force, "overwrite existing output files");
  app.add_option("--threads", session.threads, "number of threads; 0: all cores")
      ->check(integer_in(0, 1024));
  std::unique_ptr<ThreadLimit> thread_limit;
  app.parse_complete_callback(
      [&] { thread_limit = std::make_unique<ThreadLimit>(session.threads); });

  add_commands(app, session);
  add_examples(app);
  refuse_empty_values(app, argc, argv);
  if (app.get_subcommands([](const CLI::App*) { return true; }).size() > 1)
    app.footer("Try: tofsmith demo -o out    tofsmith codes    tofsmith design paper-10f0 -o out");

  bool is_done = false;
  try {
    app.parse(argc, argv);
    is_done = true;
    if (interrupted()) throw Interrupted();
    if (list_commands) fmt::print("{}\n", command_listing(app).dump(1));
    if (list_commands || !app.get_subcommands().empty()) return finish_output();
    fmt::print(stderr, "{}", app.help());
    return exit_usage;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success))
      return refuse_usage(app, usage_problem(app, error));
    app.exit(error);  // --help, --version
    return finish_output();
  } catch (const Interrupted&) {
    return stop_interrupted(session, is_done);
  }
}

/// Destructors of JSON allocate memory; a failed allocation there terminates the program.
[[noreturn]] void stop_without_memory() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view message = "tofsmith: out of memory\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(exit_failed);
  } catch (...) {
    std::abort();  // a bug in the program
  }
  std::abort();  // no exception is handled
}

int run_and_tell(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    fmt::print(stderr, "tofsmith: {}\n", printed(error.what()));
    return exit_usage;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "tofsmith: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "tofsmith: {}\n", printed(error.what()));
  }
  return interrupted() ? exit_interrupted : exit_failed;
}

/// Pixel tiles are stored on the stack. If the stack is small (`ulimit -s`), runs the program in a
/// thread with a stack of the usual size.
int run_on_enough_stack(int argc, char** argv) {
  constexpr std::size_t enough_bytes = std::size_t{1} << 21, usual_bytes = std::size_t{1} << 23;
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= enough_bytes)
    return run_and_tell(argc, argv);
  struct Work {
    int argc;
    char** argv;
    int code;
  } work{argc, argv, exit_failed};
  const auto start = [](void* given) -> void* {
    auto* const its = static_cast<Work*>(given);
    its->code = run_and_tell(its->argc, its->argv);
    return nullptr;
  };
  pthread_attr_t attributes;
  pthread_t thread;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, usual_bytes);
#ifdef __GLIBC__
  ::pthread_setattr_default_np(&attributes);  // also for the threads that it starts
#endif
  const bool started = ::pthread_create(&thread, &attributes, start, &work) == 0;
  ::pthread_attr_destroy(&attributes);
  if (!started) return run_and_tell(argc, argv);
  ::pthread_join(thread, nullptr);
  return work.code;
}

}  // namespace

int main(int argc, char** argv) {
  catch_interrupts();
  std::set_terminate(stop_without_memory);
  return run_on_enough_stack(argc, argv);
}
