# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A sweep of 20 items, shared by tests of sweeps."""

_TEXT = """set = ["samples=60"]
codes = ["sinusoid-k4", "hamiltonian-k3"]
trials = {trials}

[[axis]]
key = "light.peak_factor"
values = [12, 15]

[[axis]]
key = "signal_e_per_s"
from = 1e3
to = 1e5
count = 5

[[axis]]
key = "ambient_e_per_s"
values = [1e4]
"""
ITEMS = 20


def sweep_text(trials):
    return _TEXT.replace("{trials}", str(trials))
