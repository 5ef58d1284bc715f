# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The cameras and light levels of the paper."""

from dataclasses import dataclass

import tofsmith
from tofsmith import Camera

OPTICAL_DENSITIES = (1.0, 2.0, 3.0)  # of the prototype's neutral density filters
SIGNAL_AT_OD0_E_PER_S = 1e6  # of albedo 1 for 1 mW of average source power: our assumption
SCAN_POWER_MW = 10.0  # of Figs. 10 and 11; 1 mW behind O.D. 3 is insufficient for all codes


@dataclass(frozen=True)
class Light:
    """Signal and ambient light on a pixel [e/s]."""

    signal_e_per_s: float
    ambient_e_per_s: float


def paper_camera(peak_factor: float, f_max_in_f0: float = 0.0) -> Camera:
    """Returns a camera of the paper's simulations: f0 = 15 MHz, 300 ms in total, read noise 20 e,
    Gaussian noise, 5 x 5 light levels, and Hann windows with this band limit on both arms; 0:
    none."""
    name = f"p{peak_factor:g}" + (f"-{f_max_in_f0:g}f0" if f_max_in_f0 else "")
    camera = Camera("paper-30x", name=name, light={"peak_factor": peak_factor})
    if not f_max_in_f0:
        return camera
    hann = {"kind": "hann", "f_max_hz": f_max_in_f0 * camera.fundamental_frequency_hz}
    return camera.replace(light={"impulse_response": hann}, sensor={"impulse_response": hann})


def light_behind_filter(optical_density: float, power_mw: float = 1.0) -> Light:
    """Returns the light on the prototype's detector. The filter is at the source and attenuates
    only the signal."""
    return Light(power_mw * SIGNAL_AT_OD0_E_PER_S * 10**-optical_density, 1e3)
