# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Learns a code and a small decoder with PyTorch and the gradients of tofsmith.torch. Compares both
with a code that `optimize` designs for the same camera. Takes one to two minutes on one core.

    PYTHONPATH=BUILD/python /usr/bin/python3 examples/python/learn_a_code.py [STEPS [CODES]]

The initial codes are a family code and random codes. They are optimized as one batch by gradient
descent. After each round, the best codes are kept, and variations of them replace the others. The
best code of the last round is refined together with a decoder: a network of two layers that
computes the temperature of the soft decoder from the measurements of a pixel. The parametrization
limits the light to its peak and mean power and the gates to [0, 1]. The waveforms become steeper
during the optimization until they only switch on and off, as the camera requires.
"""

import sys

import torch

import tofsmith
from tofsmith import torch as tst

camera = tofsmith.Camera(
    "paper-10f0",
    samples=120,
    operating={"signal_e_per_s": [1e3, 1e4, 1e5], "ambient_e_per_s": [1e3, 1e4, 3e4],
               "error": "circular"},
)
exposures, steepest = 4, 8.0
peak = camera.light.peak_factor
lights = torch.tensor([(s, a) for s in camera.operating.signal_e_per_s
                       for a in camera.operating.ambient_e_per_s])


def waveforms(parameters, steepness):
    """Returns light of mean power 1 and gates (..., N, E), logistic functions of the parameters.

    Bisection finds the level that gives the light its mean power. A Newton step makes the level
    differentiable.
    """
    light, gates = (steepness * p for p in parameters)
    mean = 0.9999 / peak
    with torch.no_grad():
        low = light.amin(-2, keepdim=True) - 20
        high = light.amax(-2, keepdim=True) + 20
        for _ in range(30):
            level = (low + high) / 2
            is_bright = torch.sigmoid(light - level).mean(-2, keepdim=True) > mean
            low, high = torch.where(is_bright, level, low), torch.where(is_bright, high, level)
        value = torch.sigmoid(light - level)
        slope = (value * (1 - value)).mean(-2, keepdim=True).clamp(min=1e-6)
    level = level + (torch.sigmoid(light - level).mean(-2, keepdim=True) - mean) / slope
    return peak * torch.sigmoid(light - level), torch.sigmoid(gates)


class Trust(torch.nn.Module):
    """Computes the temperature of the soft decoder [e^2] from measurements (..., K)."""

    def __init__(self) -> None:
        super().__init__()
        self.layers = torch.nn.Sequential(
            torch.nn.Linear(2, 16), torch.nn.Tanh(), torch.nn.Linear(16, 1))

    def forward(self, y):
        noise_e2 = y.mean(-1).clamp(min=1) + camera.sensor.read_noise_e**2
        seen = torch.stack([noise_e2.log() - 9, (y.std(-1) + 1).log() - 5], -1)
        return noise_e2 * self.layers(seen)[..., 0].clamp(-6, 6).exp()


def captured(table, pixels, seed):
    """Returns measurements (..., lights x pixels, K) of random depths, and these depths [m]."""
    places = torch.rand(len(lights) * pixels, generator=torch.Generator().manual_seed(seed))
    depth_m = camera.range_m * places
    signal, ambient = lights.repeat_interleave(pixels, 0).T
    return tst.capture(table, camera, depth_m, signal, ambient, seed=seed), depth_m


def geometric_mean(error_m):
    """Returns the geometric mean over all lights of the mean errors (...), like `evaluate`."""
    return error_m.unflatten(-1, (len(lights), -1)).mean(-1).log().mean(-1).exp()


def circular_error_m(found_m, depth_m):
    error_m = (found_m - depth_m).abs()
    return torch.minimum(error_m, camera.range_m - error_m)


def descend(parameters, steps, pixels, first_seed, trust=None, soft_share=0.4, rate=0.08):
    """Minimizes the error of the soft decoder with Adam, and that of `trust` if one is given.

    The temperature decreases and the waveforms become steeper during the optimization.
    """
    groups = [{"params": parameters}]
    if trust:
        groups.append({"params": list(trust.parameters()), "lr": 0.005})
    optimizer = torch.optim.Adam(groups, lr=rate)
    for step in range(steps):
        done = step / steps
        steepness = steepest ** max(0.0, (done - soft_share) / (1 - soft_share))
        optimizer.param_groups[0]["lr"] = rate * (1 - done) ** 0.5 / steepness**0.5
        table = tst.measurement_table(*waveforms(parameters, steepness), camera)
        y, depth_m = captured(table, pixels, first_seed + step)
        noise_e2 = y.detach().clamp(min=0).mean(-1) + camera.sensor.read_noise_e**2
        error_m = tst.soft_depth_error_m(y, depth_m, table, camera, noise_e2 / 3**done)
        loss = geometric_mean(error_m).log().sum()
        if trust:
            found_m = tst.soft_decode(y, table, camera, trust(y))
            loss = loss + geometric_mean(circular_error_m(found_m, depth_m)).log()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()


def errors_of(parameters, pixels=300):
    """Returns the error [m] of each code with the soft decoder at a low temperature."""
    with torch.no_grad():
        table = tst.measurement_table(*waveforms(parameters, steepest), camera)
        y, depth_m = captured(table, pixels, 2**40)
        found_m = tst.soft_decode(y, table, camera, 1.0)
        return geometric_mean(circular_error_m(found_m, depth_m))


def smooth(codes):
    """Returns random functions (codes, N, E) with six harmonics."""
    turns = 2 * torch.pi * torch.arange(camera.samples) / camera.samples
    waves = torch.stack([f(n * turns) for n in range(1, 7) for f in (torch.cos, torch.sin)], -1)
    values = waves @ torch.randn(codes, waves.shape[-1], exposures)
    return values / values.std(-2, keepdim=True)


def leaves(parameters):
    return [p.detach().clone().requires_grad_() for p in parameters]


def learn(steps, codes):
    """Returns the parameters of the best code and its decoder."""
    family = tofsmith.build_family("hamiltonian-k4", camera)
    parameters = [smooth(codes), smooth(codes)]
    for p, waveform, most in zip(parameters, (family.modulation, family.demodulation), (peak, 1.0)):
        p[0] = torch.as_tensor(waveform) / most * 2 - 1
    rounds, kept = 6, max(1, codes // 6)
    for r in range(rounds):
        parameters = leaves(parameters)
        descend(parameters, steps, 16, r * steps)
        errors_m = errors_of(parameters)
        best = errors_m.argsort()[:kept]
        print(f"round {r + 1}: best code errs {1e3 * errors_m[best[0]]:.1f} mm", file=sys.stderr)
        if r + 1 < rounds:  # keep the best codes and add variations of them
            parameters = [p[best].detach().repeat(-(-codes // kept), 1, 1)[:codes] for p in parameters]
            for p in parameters:
                p[kept:] += 0.7 * smooth(codes - kept)
    parameters = leaves([p[best[0]] for p in parameters])
    trust = Trust()
    descend(parameters, 5 * steps, 100, 10**6, trust, soft_share=0.4, rate=0.03)
    return parameters, trust


def switching(parameters):
    """Returns waveforms that are only on or off, with a mean power of the light of at most 1."""
    light, gates = (w.detach().double() for w in waveforms(parameters, steepest))
    light = peak * (light > peak / 2).double()
    return light / light.mean(0).clamp(min=1.0), (gates > 0.5).double()


def judged(code, pixels, trust=None):
    """Returns the error [m] of a code, measured with `pixels` captured pixels at each light.

    Uses the learned decoder `trust`, or tofsmith's decoder by default.
    """
    with torch.no_grad():
        waves = (torch.as_tensor(w).float() for w in (code.modulation, code.demodulation))
        table = tst.measurement_table(*waves, camera)
        y, depth_m = captured(table, pixels, 2**41)
        if trust:
            found_m = tst.soft_decode(y, table, camera, trust(y))
        else:
            found = tofsmith.Decoder(code, camera).decode(y[None].numpy()).depth_m
            found_m = torch.from_numpy(found[0])
        return geometric_mean(circular_error_m(found_m, depth_m)).item()


def main() -> None:
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    codes = int(sys.argv[2]) if len(sys.argv) > 2 else 24
    torch.manual_seed(1)
    torch.set_num_threads(1)
    parameters, trust = learn(steps, codes)
    learned = tofsmith.CodeSet.from_arrays(*(w.numpy() for w in switching(parameters)), name="learned")
    assert tofsmith.why_not_playable(learned, camera) is None

    result = tofsmith.design(camera, method="optimize", exposures=[exposures],
                             effort=min(1.0, steps / 300))
    designed = result.winner.code.resampled(camera.samples)
    pixels = min(20000, 100 * steps)
    for what, error_m in (
        ("optimize", judged(designed, pixels)), ("learned code", judged(learned, pixels)),
        ("learned code, learned decoder", judged(learned, pixels, trust))):
        print(f"{what}: {1e3 * error_m:.1f} mm")


if __name__ == "__main__":
    main()
