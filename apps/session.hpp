// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith::apps {

/// Wrong usage that only shows once the arguments are looked at together: exit 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the library refuses by a field's name, by that of its option: "--offset-m = nan; ..".
UsageError wrong_option(const std::invalid_argument& error);

/// What every subcommand shares: flags, how to print, how to write.
struct Session {
  bool json = false;                ///< one JSON document on stdout and nothing else there
  bool force = false;               ///< overwrite output files
  bool tells_what_is_kept = false;  ///< the command says what an interrupt leaves, if anything
  int threads = 0;                  ///< 0 = every core
  std::string command_line;         ///< as typed, for reports
  std::vector<std::string> words;   ///< as typed, after the program
  std::filesystem::path directory;  ///< or store in which finished work is kept, if it is

  OutputPolicy output_policy() const {
    return force ? OutputPolicy::overwrite : OutputPolicy::refuse_existing;
  }
  /// Prints lines for people, as printed() shows them; nothing with --json.
  void say(std::string_view line) const;
  /// Prints the document with --json. Text that is not UTF-8 (a file's name) is made so.
  void print_json(const nlohmann::ordered_json& document) const;
  /// Prints a finished document with --json.
  void print_document(std::string_view document) const;

  /// Fails before long work, not after it, when its output could not be written, or is a file that
  /// another word of the command names, also through links: not even --force replaces that.
  /// @throws IoError as write_file_atomically() would, or check_not_input()
  /// @param policy  other than that of the session
  void check_output(const std::filesystem::path& path,
                    std::optional<OutputPolicy> policy = std::nullopt) const;
  /// The same for outputs that one run writes one after the other.
  /// @return how each is to be written: see policy_to_go_on()
  OutputPolicy check_outputs(const std::vector<std::filesystem::path>& paths) const;
};

/// `--set key=value`, which changes keys of a camera.
void add_settings_option(CLI::App& command, std::vector<std::string>& settings);

/// The options that name a camera: a positional or `--camera` name or file, and `--set key=value`.
struct CameraArguments {
  std::string name = std::string(default_camera_name);
  std::vector<std::string> settings;
  std::optional<double> temperature_c, sensor_temperature_c;
  const CLI::Option* option = nullptr;  ///< `--camera`, if the subcommand has it

  /// Uses the camera file that `simulate` wrote next to raw frames, if there is one and no option
  /// names a camera. @return a note about it
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
  /// Adds `--temperature` and `--sensor-temperature`, too.
  void add_temperature_to(CLI::App& command);
  /// Adds a positional CAMERA.
  void add_positional(CLI::App& command);
  /// @throws IoError; UsageError for a temperature without the keys for it in the camera
  Camera load() const;

 private:
  bool stood_beside_ = false;
};

/// Returns the file to which `simulate` writes the camera of raw frames: raw.camera.toml next to
/// raw.npy.
std::filesystem::path camera_beside(const std::filesystem::path& raw);

/// Returns a note with the prefix "note: ", unless it already begins with it or with "warning: ".
std::string marked_note(const std::string& note);

/// "13.2 ms", "4.1 s".
std::string time_text(double seconds);

/// Returns a rate with three digits and no exponent: "8.53", "1204".
std::string rate_text(double per_second);

/// Returns a table of text with a header. The first column is left-aligned, the others to the
/// right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace tofsmith::apps
