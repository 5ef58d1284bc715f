// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// How the paper is reproduced.
struct ReproduceOptions {
  /// Coarse: few trials, small scenes, seconds instead of minutes. Verdicts stay, errors grow.
  bool fast = false;
  std::uint64_t seed = 1;
  /// For Fig. 7, instead of the hand that tofsmith models; in any unit, scaled to the hand's size.
  std::optional<TriangleMesh> mesh;
  std::string mesh_name;  ///< what the report calls it
};

/// Redesigned codes, each made once: figures share them, and a later run finds them in files.
class CodeShelf {
 public:
  /// Keeps codes in memory only.
  CodeShelf() = default;
  /// Keeps codes in `directory`, too, as NAME.code.json; it is made when the first one is.
  explicit CodeShelf(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// The Hamiltonian code of so many exposures, redesigned for the camera as the paper does: its
  /// correlation functions factorized within the camera's limits. The best by the camera's depth
  /// error among the candidates of design(), without baselines.
  /// @throws IoError if a file cannot be written, std::invalid_argument as design(), Interrupted
  const CodeSet& redesigned(int exposures, const Camera& camera, const ReproduceOptions& options,
                            const Progress& progress = {});

 private:
  std::filesystem::path directory_;
  std::map<std::string, CodeSet> codes_;
};

/// What every figure is given.
struct ReproduceContext {
  ReproduceOptions options;
  CodeShelf& shelf;

  /// `full`, or `coarse` with options.fast.
  template <typename Value>
  Value pick(Value full, Value coarse) const {
    return options.fast ? coarse : full;
  }
};

/// A camera as the paper simulates it: f0 = 15 MHz, 300 ms in all, read noise 20 e, Gaussian noise,
/// the 5 x 5 grid of light levels, peak factor `p` and, unless `f_max_in_f0` is 0, Hann windows of
/// that band limit on both arms. Named after both: "p15-10f0", "p30".
Camera paper_camera(double peak_factor, double f_max_in_f0);
/// The same with two buckets.
Camera two_bucket_camera(double peak_factor, double f_max_in_f0);

}  // namespace tofsmith
