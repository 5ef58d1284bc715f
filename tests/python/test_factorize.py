# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Bindings of factorize(), alternate() and the actual waveforms of a camera."""

import numpy as np
import pytest

import tofsmith as ts

few = {"random_starts": 2, "refined": 2, "kept": 2}


def test_factorizes_all_or_selected_measurements():
    found = ts.factorize("hamiltonian-k3", "paper-30x", seed=1, **few)
    assert len(found) == 3
    only, = ts.factorize("hamiltonian-k3", "paper-30x", measurements=[2], seed=1, **few)
    assert np.array_equal(only.target, found[2].target)
    assert only.best.modulation == found[2].best.modulation
    residuals = [pair.residual_rms for pair in only.pairs]
    assert residuals == sorted(residuals) and len(only.iterations_per_start) == 2
    # The residual must equal that of the forward model's correlation function.
    code = ts.CodeSet.from_waveforms([only.best.modulation], [only.best.demodulation], samples=240)
    chi = ts.ForwardModel(code, "paper-30x").correlation_table()[:, 0]
    assert np.sqrt(np.mean((chi - only.target) ** 2)) == pytest.approx(only.best.residual_rms, abs=1e-6)


def test_accepts_tables_as_targets():
    table = np.zeros((240, 1))
    table[:120, 0] = 1
    found, = ts.factorize(table, "paper-5f0", **few)
    assert found.target_variation_rms == pytest.approx(0.5)


def test_alternation_has_relaxed_and_playable_waveforms():
    one = ts.alternate("hamiltonian-k3", "paper-30x", measurement=0, total_variation_weight=0.0,
                       max_iterations=5, objective_tolerance=0.0)
    assert [len(waveform.samples) for waveform in one.relaxed] == [240, 240]
    assert all(waveform.is_binary for waveform in one.playable)
    assert len(one.objective) == len(one.playable_residual_rms) <= 5


def test_actual_waveforms_equal_those_of_the_generators():
    camera = ts.Camera("prototype")
    code = ts.build_family("hamiltonian-k5", camera)
    modulation, demodulation = ts.actual_waveforms(code, camera)
    assert len(modulation) == code.exposures and len(demodulation) == code.measurements
    reports = ts.generator_report(code, camera)
    assert reports[0].arm == "light" and reports[0].points_per_period == 100
    assert reports[0].duty_actual == pytest.approx(modulation[0].duty)
    assert max(report.largest_edge_move_s for report in reports) > 0
    assert ts.generator_report("hamiltonian-k3", "paper-30x") == []


def test_arm_output_is_the_smoothed_waveform():
    pulse = ts.Waveform.binary([[0.25, 0.75]])
    plain = ts.arm_output(pulse, "paper-30x", arm="light", points=8)
    assert np.array_equal(plain, pulse.cell_averages(8))
    smooth = ts.arm_output(pulse, "paper-5f0", arm="sensor", points=240)
    assert smooth.mean() == pytest.approx(0.5) and 0 < np.abs(np.diff(smooth)).max() < 0.2


@pytest.mark.parametrize("call, said", [
    (lambda: ts.factorize("hamiltonian-k3", "paper-30x", measurements=[3]), "measurement: got 3"),
    (lambda: ts.factorize("hamiltonian-k3", "paper-30x", kept=0), "FactorizeOptions::kept"),
    (lambda: ts.factorize(np.full((4, 1), 2.0), "paper-30x", random_starts="many"), "random_starts"),
    (lambda: ts.alternate("hamiltonian-k3", "paper-30x", measurement=0, total_variation_weight=-1),
     "total_variation_weight"),
    (lambda: ts.arm_output(ts.Waveform.sampled([1.0]), "paper-30x", arm="lens"), "light, sensor"),
    (lambda: ts.actual_waveforms("sinusoid-k4", "nowhere.toml"), "nowhere.toml"),
])
def test_rejects_bad_input_by_name(call, said):
    with pytest.raises((ValueError, TypeError, OSError), match=said):
        call()
