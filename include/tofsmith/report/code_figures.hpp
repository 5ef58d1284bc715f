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

/// An id for a figure about something named freely: bytes other than letters, digits and dashes
/// become their hexadecimal code, so that "a/b" and "a b" differ.
std::string figure_id(const std::string& prefix, const std::string& name);

/// Modulation, demodulation and correlation function of every measurement, one row each: as
/// designed (dotted, where a generator changes them), as generated, and after the camera's impulse
/// responses.
/// @param target  what the correlation functions were designed for (N, K), drawn dotted; may be
///                empty
Figure waveform_figure(FigureText text, const CodeSet& code, const Camera& camera,
                       const Eigen::MatrixXd& target = {});

/// The correlation functions of a code as the generators play it, and as designed (dotted).
Figure correlation_figure(FigureText text, const CodeSet& code, const Camera& camera);

/// The coding curves of some codes in their three directions of largest extent, coloured by depth.
Figure coding_curve_figure(FigureText text, const std::vector<CodeSet>& codes,
                           const Camera& camera);

/// The camera in words and numbers.
KeyValueList camera_description(const Camera& camera);
/// The same as a section, with a figure of how often depths occur where they are not all alike.
Section camera_section(const Camera& camera);

/// Which depths a camera's codes are judged at: "anywhere in the range", "from 1 to 3 m, as often
/// as 20 weights say".
std::string true_depths_in_words(const Camera& camera);

/// A page that shows one code on one camera.
/// @param command_line  as typed, to be shown on the page; may be empty
Page code_page(const CodeSet& code, const Camera& camera, const std::string& command_line);

}  // namespace tofsmith
