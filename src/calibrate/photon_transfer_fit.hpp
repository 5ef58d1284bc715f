// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/photon_transfer.hpp"

namespace tofsmith {

/// @throws std::invalid_argument unless the frames are pairs, have the size of `first` and enough
///         pixels
void check_pairs(const RawFrames& raw, const RawFrames& first, const char* name);

/// Fits gain and read noise to the points of `result`, whose black level and buckets are set; adds
/// notes. @throws std::invalid_argument if there are too few points or their variance does not
/// increase
void fit_photon_transfer(PhotonTransfer& result);

/// Sets the bits as given, or the smallest usual number that can represent `highest_dn`, with a
/// note.
void set_adc_bits(const PhotonTransferOptions& options, double highest_dn, PhotonTransfer& result);

}  // namespace tofsmith
