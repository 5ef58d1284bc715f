# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
# Lists the components, with the folders of src/ that form each and the components it needs. Each
# component is a library, an export and a pair of Debian packages. All other files use this list.

set(TOFSMITH_ALL_COMPONENTS core gpu design io report lab sweep)

set(tofsmith_core_folders core code camera scene decode simulate)
set(tofsmith_gpu_folders gpu)
set(tofsmith_design_folders design)
set(tofsmith_io_folders io)
set(tofsmith_report_folders report)
set(tofsmith_lab_folders waveforms calibrate)
set(tofsmith_sweep_folders sweep)

set(tofsmith_core_needs)
set(tofsmith_gpu_needs core)
set(tofsmith_design_needs core)
set(tofsmith_io_needs design)
set(tofsmith_report_needs io)
set(tofsmith_lab_needs report)  # for the pages of calibrations and exports
set(tofsmith_sweep_needs io)

set(tofsmith_core_about "codes, cameras, decoding and simulation")
set(tofsmith_gpu_about "averaging, filtering and decoding on OpenCL devices")
set(tofsmith_design_about "the search for codes")
set(tofsmith_io_about "files, images and meshes")
set(tofsmith_report_about "figures and HTML pages")
set(tofsmith_lab_about "calibration, waveform formats and scripts for signal generators")
set(tofsmith_sweep_about "sweeps of many conditions")

set(TOFSMITH_COMPONENTS "" CACHE STRING
    "Components to build, with what they stand on: some of ${TOFSMITH_ALL_COMPONENTS}; empty: all")

set(wanted_components ${TOFSMITH_COMPONENTS})
if(NOT wanted_components)
  set(wanted_components ${TOFSMITH_ALL_COMPONENTS})
endif()
foreach(component IN LISTS wanted_components)
  if(NOT component IN_LIST TOFSMITH_ALL_COMPONENTS)
    message(FATAL_ERROR "TOFSMITH_COMPONENTS: there is no component '${component}'; there are "
                        "${TOFSMITH_ALL_COMPONENTS}")
  endif()
endforeach()
# Selects all components needed by the selected ones, from the top down.
foreach(component IN ITEMS sweep lab report io design gpu)
  if(component IN_LIST wanted_components)
    list(APPEND wanted_components ${tofsmith_${component}_needs})
  endif()
endforeach()
# The components to build, each after the components it needs.
set(TOFSMITH_BUILT_COMPONENTS)
foreach(component IN LISTS TOFSMITH_ALL_COMPONENTS)
  set(TOFSMITH_HAS_${component} OFF)
  if(component IN_LIST wanted_components)
    set(TOFSMITH_HAS_${component} ON)
    list(APPEND TOFSMITH_BUILT_COMPONENTS ${component})
  endif()
endforeach()
set(TOFSMITH_HAS_ALL OFF)
if(TOFSMITH_BUILT_COMPONENTS STREQUAL TOFSMITH_ALL_COMPONENTS)
  set(TOFSMITH_HAS_ALL ON)
endif()
