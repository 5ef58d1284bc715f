// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// All of tofsmith::lab: calibration, waveform formats and generator scripts. Includes
/// tofsmith/report.hpp.

#include "tofsmith/calibrate/calibration_camera.hpp"
#include "tofsmith/calibrate/calibration_reports.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/report.hpp"
#include "tofsmith/waveforms/export_report.hpp"
#include "tofsmith/waveforms/upload_script.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"
#include "tofsmith/waveforms/write_export.hpp"
