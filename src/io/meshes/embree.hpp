// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Embree 3 (Debian 12) and 4 (Debian 13) have different functions for ray packets. CMake also
// prefers version 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tofsmith {

/// Finds the nearest hit of each active ray (-1; inactive: 0) in a packet of similar rays.
inline void intersect_coherent(const int* active, RTCScene scene, RTCRayHit8& packet) {
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect8(active, scene, &packet, &arguments);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(active, scene, &context, &packet);
#endif
}

}  // namespace tofsmith
