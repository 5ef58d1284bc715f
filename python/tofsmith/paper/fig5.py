# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Fig. 5: Hann windows as impulse responses, and their transfer functions."""

import numpy as np

import tofsmith

from ._study import Study
from ._style import new_figure
from .cameras import paper_camera

LIMITS_IN_F0 = (20, 10, 5)
SAMPLES = 960


def reproduce(study: Study) -> None:
    """Makes the figure: the window in time, its transfer function, and where that is 1/5."""
    figure, (in_time, in_frequency) = new_figure(7.2, 2.6, 1, 2)
    rows = []
    for limit, colour in zip(LIMITS_IN_F0, ("#009e73", "#0072b2", "#d55e00")):
        # 1. Response of an arm to an impulse.
        camera = paper_camera(30, limit)
        impulse = tofsmith.Waveform.binary([[0.5, 0.5 + 1e-6]], 1e6)
        response = tofsmith.arm_output(impulse, camera, arm="light", points=SAMPLES) / SAMPLES
        time_ns = (np.arange(SAMPLES) / SAMPLES - 0.5) / camera.fundamental_frequency_hz * 1e9
        in_time.plot(time_ns, response, color=colour, label=f"f_max = {limit} f0")

        # 2. Its transfer function, from a camera of 0.01 f0 whose sensor has no response.
        fine = camera.replace(fundamental_frequency_hz=camera.fundamental_frequency_hz / 100,
                              sensor={"impulse_response": {"kind": "none"}})
        frequency_in_f0, size = np.arange(4001) / 100, np.abs(fine.transfer(4000))
        in_frequency.plot(frequency_in_f0, size, color=colour, label=f"f_max = {limit} f0")

        # 3. The lowest frequency at which |H| is 1/5, and the response's own transform at f_max.
        k = int(np.argmax(size < 0.2))
        crossing = float(np.interp(-0.2, -size[k - 1:k + 1], frequency_in_f0[k - 1:k + 1]))
        rows.append({"f_max_in_f0": limit, "measured_in_f0": crossing,
                     "attenuation": float(np.abs(np.fft.rfft(response)[limit]))})
    in_frequency.axhline(0.2, color="0.3", ls=":", label="1/5")
    in_time.set(xlabel="time (ns)", ylabel=f"response (per sample, N = {SAMPLES})", xlim=(-16, 16))
    in_frequency.set(xlabel="frequency (f0)", ylabel="|H|", xlim=(0, 40), ylim=(0, 1.02))
    in_time.legend(frameon=False)
    in_frequency.legend(frameon=False)

    study.state(all(abs(row["measured_in_f0"] / row["f_max_in_f0"] - 1) < 1e-3
                    and abs(row["attenuation"] - 0.2) < 1e-3 for row in rows),
                "A Hann window models the arms' impulse response; f_max is the highest frequency that "
                "is not attenuated more than about 5 times.",
                "|H| reaches 1/5 at {:.4f}, {:.4f} and {:.4f} f0 for windows made for 20, 10 and 5 f0; "
                "the responses' own transforms there are {:.4f}, {:.4f} and {:.4f}.".format(
                    *(row[key] for key in ("measured_in_f0", "attenuation") for row in rows)))
    study.picture("response", figure,
                  "Hann windows of three band limits, with sum 1; a period of f0 = 15 MHz is 66.7 ns.")
    study.table("f_max", rows)
