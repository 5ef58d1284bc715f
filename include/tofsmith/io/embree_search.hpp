// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/scene/mesh_search.hpp"

namespace tofsmith {

/// Searches meshes through Embree's hierarchy of bounding boxes; the triangle found is then
/// intersected in double precision. For RayCaster, ray_cast and bounced_light of scenes with
/// meshes.
///
/// Agrees with trying every triangle but for rays that pass an edge of a mesh closer than about
/// 1e-6 of the mesh's (not the scene's) size: those may see the triangle beside it. What it makes
/// throws std::runtime_error or std::bad_alloc if a hierarchy cannot be set up.
MeshSearchMaker embree_search();

}  // namespace tofsmith
