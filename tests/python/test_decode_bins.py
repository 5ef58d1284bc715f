# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""A few of the random codes that scripts/differential.sh tests for hours."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import decode_bins  # noqa: E402


@pytest.mark.parametrize("item", range(12))
def test_bins_of_random_codes_equal_brute_force(item):
    assert decode_bins.check_item(seed=7, item=item, pixels=4000) in (0, 4000)


def test_a_wrong_bin_is_detected():
    rng = np.random.default_rng(1)
    table = rng.normal(size=(50, 4))
    raw = decode_bins.random_frame(rng, table, 300)
    raw[~np.isfinite(raw)] = 0
    centred = raw[0] - raw[0].mean(axis=1, keepdims=True)
    unit = table - table.mean(axis=1, keepdims=True)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    best = (centred.astype(float) @ unit.T).argmax(axis=1)[None]
    assert decode_bins.wrong_bins(table, raw, best).size == 0
    best[0, 17] = (best[0, 17] + 1) % 50
    best[0, 40] = -1
    assert list(decode_bins.wrong_bins(table, raw, best)) == [17, 40]
