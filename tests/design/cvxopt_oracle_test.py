# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the circulant total-variation solver with cvxopt's interior-point QP.

usage: cvxopt_oracle_test.py PATH_TO_circulant_tv_cli
Exits 77 (skipped) where cvxopt is not installed.
"""

import json
import random
import subprocess
import sys

try:
    from cvxopt import matrix, solvers, spmatrix
except ImportError:
    print("skipped: python3-cvxopt is not installed")
    sys.exit(77)

RELATIVE_TOLERANCE = 1e-7
INSTANCES = 24


def smoothed(signal):
    size = len(signal)
    return [(signal[n - 1] + 2 * signal[n] + signal[(n + 1) % size]) / 4 for n in range(size)]


def make_problem(seed):
    """A binary waveform against a noisy trapezoid, as in the alternating design."""
    draw = random.Random(seed)
    samples = draw.randrange(24, 61)
    waveform = [0.0] * samples
    for _ in range(draw.randrange(1, 4)):
        start, length = draw.randrange(samples), draw.randrange(2, samples // 2)
        for n in range(start, start + length):
            waveform[n % samples] = 1.0
    for _ in range(draw.randrange(3)):
        waveform = smoothed(waveform)
    target = [max(0.0, min(0.5, abs(2 * n / samples - 1)) * 2) for n in range(samples)]
    target = [value + 0.02 * draw.gauss(0, 1) for value in target]
    peak = draw.choice([1, 2, 4, 8, 15])
    return {
        "kernel": [value / samples for value in waveform],
        "target": target,
        "total_variation_weight": draw.choice([2e-4, 2e-5, 2e-6]) * samples,
        "upper_bound": peak,
        "budget": None if peak == 1 else samples,
    }


def residual(problem, x):
    kernel, target = problem["kernel"], problem["target"]
    size = len(kernel)
    return [
        sum(kernel[i - j] * x[j] for j in range(size)) - target[i] for i in range(size)
    ]  # negative indices close the circle


def objective(problem, x):
    variation = sum(abs(x[n] - x[n - 1]) for n in range(len(x)))
    squares = 0.5 * sum(r * r for r in residual(problem, x))
    return squares + problem["total_variation_weight"] * variation


def solve_by_cvxopt(problem):
    """The QP in (x, t), t the absolute jumps, with every value in units of its bound."""
    kernel, target = problem["kernel"], problem["target"]
    size, peak = len(kernel), problem["upper_bound"]
    operator = matrix([[peak * kernel[(i - j) % size] for i in range(size)] for j in range(size)])
    quadratic = matrix(0.0, (2 * size, 2 * size))
    quadratic[:size, :size] = operator.T * operator
    linear = matrix(0.0, (2 * size, 1))
    linear[:size] = -operator.T * matrix(target)
    linear[size:] = problem["total_variation_weight"] * peak

    entries = []  # (row, column, value) of G; G (x, t) <= h
    limits = []
    for n in range(size):
        for sign in (1, -1):
            entries += [(len(limits), n, sign), (len(limits), (n - 1) % size, -sign)]
            entries += [(len(limits), size + n, -1)]
            limits.append(0.0)
        entries.append((len(limits), n, 1))
        limits.append(1.0)
        entries.append((len(limits), n, -1))
        limits.append(0.0)
    if problem["budget"] is not None:
        entries += [(len(limits), n, 1) for n in range(size)]
        limits.append(problem["budget"] / peak)
    rows, columns, values = zip(*entries)
    constraints = spmatrix([float(v) for v in values], rows, columns, (len(limits), 2 * size))

    solvers.options.update(
        {"show_progress": False, "abstol": 1e-11, "reltol": 1e-11, "feastol": 1e-11}
    )
    solution = solvers.qp(quadratic, linear, constraints, matrix(limits))
    x = [peak * value for value in solution["x"][:size]]
    return 0.5 * sum(b * b for b in target) + solution["primal objective"], x


def main():
    solver = sys.argv[1]
    failures = 0
    worst = 0.0
    for seed in range(INSTANCES):
        problem = make_problem(seed)
        finished = subprocess.run(
            [solver], input=json.dumps(problem), capture_output=True, text=True, check=True
        )
        ours = json.loads(finished.stdout)
        theirs, _ = solve_by_cvxopt(problem)
        difference = abs(ours["objective"] - theirs) / theirs
        recomputed = abs(objective(problem, ours["x"]) - ours["objective"]) / theirs
        worst = max(worst, difference)
        if max(difference, recomputed) > RELATIVE_TOLERANCE or ours["termination"] != "converged":
            failures += 1
            print(
                f"seed {seed}, N = {len(problem['kernel'])}: ours {ours['objective']:.12g} "
                f"({ours['termination']}), recomputed off by {recomputed:.2g}, "
                f"cvxopt {theirs:.12g}, relative difference {difference:.2g}"
            )
    print(f"{INSTANCES} instances, {failures} failed, largest relative difference {worst:.2g}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
