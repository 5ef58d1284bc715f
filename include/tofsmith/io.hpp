// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// Includes all headers of tofsmith::io (files, images, meshes) and tofsmith/design.hpp.

#include "tofsmith/design.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/csv.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/depth_kind.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/number_table.hpp"
#include "tofsmith/io/point_cloud.hpp"
#include "tofsmith/io/raw_format.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_toml.hpp"
