// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "answer.hpp"
#include "request.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"

// Long calls; each corresponds to the command of the same name.
namespace tofsmith::lab {

struct SceneArguments {
  std::string scene = "table-top";
  int width = 160;
  std::optional<int> height;
  std::string filter = "off";
  std::optional<double> signal, ambient;
  std::optional<std::uint64_t> seed;

  int rows() const { return height.value_or(width * 3 / 4); }
};
auto fields_of(ConstOrNot<SceneArguments> auto& s) {
  return std::tuple(
      Field("scene", s.scene, Help{"built-in scene"}),
      Field("width", s.width, closed(8, 1024), Help{"width of the image in pixels"}),
      Field("height", s.height, closed(8, 1024), Help{"height"}, IfAbsent{"3/4 of the width"}),
      Field("filter", s.filter, Help{"off, or the strength of a filter"}),
      Field("signal", s.signal, at_least(0), Help{"signal [e/s]"}, IfAbsent{"of the camera"}),
      Field("ambient", s.ambient, at_least(0), Help{"ambient [e/s]"}, IfAbsent{"of the camera"}),
      Field("seed", s.seed, Help{"seed of all noise"}, IfAbsent{"1"}));
}

struct DesignArguments {
  std::optional<DesignMethod> method;
  std::optional<double> effort;
  std::optional<int> exposures;
};
auto fields_of(ConstOrNot<DesignArguments> auto& d) {
  return std::tuple(Field("method", d.method, Help{"method"}, IfAbsent{"best"}),
                    Field("effort", d.effort, Help{"work of all searches"}, IfAbsent{"0.1"}),
                    Field("exposures", d.exposures, closed(1, 16), Help{"number of exposures"}));
}

struct DesignTrials {
  std::optional<int> trials;
  std::optional<std::uint64_t> seed;
};
auto fields_of(ConstOrNot<DesignTrials> auto& d) {
  return std::tuple(
      Field("trials", d.trials, closed(1000, 1e8), Help{"trials of the final evaluation"}),
      Field("seed", d.seed, Help{"seed of every random choice"}, IfAbsent{"1"}));
}

enum class Command { camera, codes, evaluate, scene, design, export_ };
constexpr auto words_of(Command /*any*/) {
  return word_list("camera", "codes", "evaluate", "scene", "design", "export");
}

struct CommandArguments {
  std::optional<Command> what;  ///< required
  std::optional<std::string> camera_file;
  std::vector<std::string> codes;
  std::optional<std::int64_t> trials;
  std::optional<std::uint64_t> seed;
};
auto fields_of(ConstOrNot<CommandArguments> auto& a) {
  return std::tuple(Field("what", a.what, Help{"command"}),
                    Field("camera_file", a.camera_file, Help{"name of the saved camera"}),
                    Field("codes", a.codes, Help{"families or names of files"}),
                    Field("trials", a.trials, closed(2, 4e9), Help{"trials of an evaluation"}),
                    Field("seed", a.seed, Help{"seed of all random numbers"}));
}

/// Returns {document: output of `tofsmith evaluate --json`; signal_e_per_s, ambient_e_per_s,
/// error_m, standard_error_m, cramer_rao_mae_m, receiver_bound_mae_m (S, A); notes}. The kind of
/// error is that of the camera's operating range.
Answer evaluate_answer(const CodeArguments& coded, const EvaluateOptions& options,
                       const Progress& progress);

/// Returns {depth_m, true_depth_m, status, standard_deviation_m (H, W), ...}, as by `tofsmith
/// simulate` and `tofsmith decode --filter` for a built-in scene.
Answer scene_answer(const CodeArguments& coded, const SceneArguments& arguments,
                    const Progress& progress);

/// Returns {document: output of `tofsmith design --json`; name, file, error_m, explanation,
/// left_out}.
Answer design_answer(const CameraArguments& camera_arguments, const DesignArguments& arguments,
                     const DesignTrials& trials, const Progress& progress);

/// Returns {command: shell commands that give the same result}. The page passes all arguments; each
/// command uses some of them.
Answer command_answer(const CameraArguments& camera, const CommandArguments& arguments,
                      const SceneArguments& scene, const DesignArguments& design);

}  // namespace tofsmith::lab
