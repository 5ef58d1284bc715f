// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/photon_transfer.hpp"

namespace tofsmith {

/// @throws std::invalid_argument unless the frames are pairs, of the size of `first`, of enough
///         pixels
void check_pairs(const RawFrames& raw, const RawFrames& first, const char* name);

/// Gain and read noise from the points of `result`, whose black level and buckets are known; with
/// notes. @throws std::invalid_argument if they are too few, or their variance does not rise
void fit_photon_transfer(PhotonTransfer& result);

/// Bits as given, or the fewest usual ones that hold a number, with a note.
void set_adc_bits(const PhotonTransferOptions& options, double highest_dn, PhotonTransfer& result);

}  // namespace tofsmith
