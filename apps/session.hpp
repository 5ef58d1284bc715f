// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith::apps {

/// Makes a message safe for a terminal: control bytes and invalid UTF-8 are shown as \xNN, and text
/// beyond `longest` is cut.
std::string printed(std::string_view message, std::size_t longest = 4000);

/// Error in the combination of arguments; the program exits with code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Converts an error that names a field to one that names its option: "--offset-m = nan; ...".
UsageError wrong_option(const std::invalid_argument& error);

/// State shared by all subcommands: flags, printing and output policy.
struct Session {
  bool json = false;                ///< print one JSON document, and nothing else, on stdout
  bool force = false;               ///< overwrite output files
  bool tells_what_is_kept = false;  ///< the command itself reports which output is kept
  int threads = 0;                  ///< 0: all cores
  std::string command_line;         ///< as typed, for reports
  std::vector<std::string> words;   ///< as typed, without the name of the program
  std::filesystem::path directory;  ///< or store that keeps finished work; empty: none

  OutputPolicy output_policy() const {
    return force ? OutputPolicy::overwrite : OutputPolicy::refuse_existing;
  }
  /// Prints human-readable lines, sanitized by printed(); nothing with --json.
  void say(std::string_view line) const;
  /// Prints the document if --json is given. Invalid UTF-8 (in file names) is replaced.
  void print_json(const nlohmann::ordered_json& document) const;
  /// Prints a serialized document if --json is given.
  void print_document(std::string_view document) const;

  /// Checks before long work that an output can be written, and that it is not an input named by
  /// another argument (also through links), which not even --force replaces.
  /// @param policy  overrides the policy of the session
  /// @throws IoError as write_file_atomically() and check_not_input()
  void check_output(const std::filesystem::path& path,
                    std::optional<OutputPolicy> policy = std::nullopt) const;
  /// Checks several outputs that one run writes in this order.
  /// @return the policy for writing each of them, see policy_to_go_on()
  OutputPolicy check_outputs(const std::vector<std::filesystem::path>& paths) const;
};

/// Adds `--set key=value`, which changes keys of a camera.
void add_settings_option(CLI::App& command, std::vector<std::string>& settings);

/// Options that select a camera: a positional or `--camera` (name or file), and `--set key=value`.
struct CameraArguments {
  std::string name = std::string(default_camera_name);
  std::vector<std::string> settings;
  std::optional<double> temperature_c, sensor_temperature_c;
  const CLI::Option* option = nullptr;  ///< `--camera`, if the subcommand has it

  /// Uses the camera file that `simulate` wrote next to raw frames, if it exists and no option
  /// names a camera.
  /// @return note about the camera file; none if it is not used
  std::optional<std::string> take_that_of(const std::filesystem::path& raw);
  /// Returns true if the user chose neither a camera nor its frequency.
  bool is_default() const {
    return option != nullptr && option->count() == 0 && !stood_beside_ &&
           std::ranges::none_of(settings, [](const std::string& setting) {
             return setting.starts_with("fundamental_frequency_hz");
           });
  }

  /// Adds `--camera` and `--set` to a subcommand.
  void add_to(CLI::App& command);
  /// Adds `--temperature` and `--sensor-temperature`.
  void add_temperature_to(CLI::App& command);
  /// Adds an option for one key, a number or a choice, with the help, unit and range of the key.
  /// Its default is the camera's value.
  /// @param key  "operating.velocity_m_per_s"
  CLI::Option* add_key_option(CLI::App& command, const std::string& key, const std::string& name);
  /// Adds a positional CAMERA.
  void add_positional(CLI::App& command);
  /// @throws IoError; UsageError for a temperature if the camera lacks its keys
  Camera load() const;

 private:
  std::vector<std::string> key_settings_;  // of add_key_option()
  bool stood_beside_ = false;
};

/// Returns the file to which `simulate` writes the camera of raw frames: raw.camera.toml next to
/// raw.npy.
std::filesystem::path camera_beside(const std::filesystem::path& raw);

/// Returns a note with the prefix "note: ", unless it already begins with it or with "warning: ".
std::string marked_note(const std::string& note);

/// Returns a duration such as "13.2 ms" or "4.1 s".
std::string time_text(double seconds);

/// Returns a rate with three digits and no exponent: "8.53", "1204".
std::string rate_text(double per_second);

/// Returns a table of text with a header. The first column is aligned to the left, the others to
/// the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace tofsmith::apps
