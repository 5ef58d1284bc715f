// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace tofsmith::apps {

struct Session;

/// Adds the subcommands of this program: all, or only `demo` (apps/demo/).
void add_commands(CLI::App& app, Session& session);

/// Each function adds one subcommand. The callback of the subcommand does the work and throws on
/// failure; main() converts exceptions to messages and exit codes.
void add_demo_command(CLI::App& app, Session& session);
void add_cameras_command(CLI::App& app, Session& session);
void add_codes_command(CLI::App& app, Session& session);
void add_atlas_command(CLI::App& app, Session& session);
void add_design_command(CLI::App& app, Session& session);
void add_evaluate_command(CLI::App& app, Session& session);
void add_multipath_command(CLI::App& app, Session& session);
void add_require_command(CLI::App& app, Session& session);
void add_export_command(CLI::App& app, Session& session);
void add_upload_command(CLI::App& app, Session& session);
void add_scene_command(CLI::App& app, Session& session);
void add_simulate_command(CLI::App& app, Session& session);
void add_calibrate_command(CLI::App& app, Session& session);
void add_decode_command(CLI::App& app, Session& session);
void add_report_command(CLI::App& app, Session& session);
void add_lab_command(CLI::App& app, Session& session);
void add_sweep_command(CLI::App& app, Session& session);
void add_reproduce_command(CLI::App& app, Session& session);

}  // namespace tofsmith::apps
