// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/photon_transfer.hpp"

namespace tofsmith {

/// @throws std::invalid_argument unless the frames are pairs of the size of `first` with enough
///         pixels
void check_pairs(const RawFrames& raw, const RawFrames& first, const char* name);

/// Fits gain and read noise to the points of `result`, whose black level and buckets are set.
/// @throws std::invalid_argument for too few points, or if their variance does not increase
void fit_photon_transfer(PhotonTransfer& result);

/// Sets the given bits, or the smallest usual number for `highest_dn`, with a note.
void set_adc_bits(const PhotonTransferOptions& options, double highest_dn, PhotonTransfer& result);

}  // namespace tofsmith
