// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tofsmith/instrument/scpi_session.hpp"

namespace tofsmith {

/// Messages over VXI-11: queries and writes of at most `max_vxi11_bytes`.
inline constexpr std::size_t max_vxi11_bytes = 16384;
std::unique_ptr<InstrumentConnection> connect_vxi11(const InstrumentAddress& address,
                                                    double deadline_s);

}  // namespace tofsmith
