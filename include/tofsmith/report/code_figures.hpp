// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Returns a figure id for an arbitrary name. Bytes other than letters, digits and dashes become
/// hexadecimal, so that "a/b" and "a b" differ.
std::string figure_id(const std::string& prefix, const std::string& name);

/// Modulation, demodulation and correlation function of every measurement: as designed (dotted,
/// where a generator changes them), as generated, and after the camera's impulse responses.
/// @param target  target correlation functions (N, K), dotted; may be empty
Figure waveform_figure(FigureText text, const CodeSet& code, const Camera& camera,
                       const Eigen::MatrixXd& target = {});

/// Correlation functions as generated and as designed (dotted).
Figure correlation_figure(FigureText text, const CodeSet& code, const Camera& camera);

/// Coding curves along three principal axes, coloured by depth.
Figure coding_curve_figure(FigureText text, const std::vector<CodeSet>& codes,
                           const Camera& camera);

/// Properties of the camera as text.
KeyValueList camera_description(const Camera& camera);
/// Returns the camera as a section, with a plot of the depth distribution unless it is uniform.
Section camera_section(const Camera& camera);

/// Returns the depths at which codes are evaluated: "anywhere in the range", "from 1 to 3 m, ...".
std::string true_depths_in_words(const Camera& camera);

/// A page about one code. @param command_line  shown on the page; may be empty
Page code_page(const CodeSet& code, const Camera& camera, const std::string& command_line);

}  // namespace tofsmith
