// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"

namespace tofsmith::apps {

void add_commands(CLI::App& app, Session& session) {
  add_demo_command(app, session);
  add_cameras_command(app, session);
  add_codes_command(app, session);
  add_design_command(app, session);
  add_atlas_command(app, session);
  add_evaluate_command(app, session);
  add_multipath_command(app, session);
  add_require_command(app, session);
  add_export_command(app, session);
  add_upload_command(app, session);
  add_scene_command(app, session);
  add_simulate_command(app, session);
  add_decode_command(app, session);
  add_report_command(app, session);
  add_lab_command(app, session);
  add_sweep_command(app, session);
  add_calibrate_command(app, session);
  add_reproduce_command(app, session);
}

}  // namespace tofsmith::apps
