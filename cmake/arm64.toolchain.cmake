# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Builds for 64-bit Arm with Debian's cross compiler. Libraries come from the arm64 root that
# scripts/arm64.sh creates (TOFSMITH_ARM64_ROOT) or, without it, from packages such as
# libfmt-dev:arm64 on this system. The results run under qemu-user.

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

if(NOT TOFSMITH_ARM64_ROOT)
  return()
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TOFSMITH_ARM64_ROOT)
set(CMAKE_SYSROOT "${TOFSMITH_ARM64_ROOT}")
set(CMAKE_FIND_ROOT_PATH "${TOFSMITH_ARM64_ROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64-static;-L;${TOFSMITH_ARM64_ROOT}")
