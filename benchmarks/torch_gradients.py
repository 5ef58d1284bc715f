# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Speed of tofsmith.torch relative to the same functions in plain PyTorch, forward and backward.
Target: >= 10x.

    PYTHONPATH=BUILD/python /usr/bin/python3 benchmarks/torch_gradients.py [PIXELS]

Both run alternately on one thread with the same inputs; the result is the median over the rounds of
the ratio of times. The plain versions process whole tensors at once: Fourier transforms for
waveforms, one matrix of cosines and sines times the harmonics within the bandwidth (to 1e-12) for
depths between bins, matrix products and softmax for the decoder, Gram-Schmidt over all depths and
25 light levels for the bound. Values and gradients of both are compared first.
"""

import statistics
import sys
import time

import torch
from torch import fft

import tofsmith
from tofsmith import torch as tst


class Plain:
    """The steps of tofsmith.torch in plain PyTorch, for one tap and limited bandwidth."""

    def __init__(self, camera: tofsmith.Camera, samples: int, exposures: int, dtype) -> None:
        self.camera, self.samples = camera, samples
        images = 8
        n = torch.arange(-images * samples, (images + 1) * samples)
        response = torch.from_numpy(camera.transfer((images + 1) * samples))
        held = torch.where(n >= 0, response[n.abs()], response[n.abs()].conj())
        held = held * torch.sinc(n / samples) ** 2
        grid = torch.zeros(samples, dtype=held.dtype).index_add(0, n % samples, held)
        positive = held[images * samples :]
        kept = int(positive.abs().gt(1e-12).nonzero().max()) + 1
        positive = positive[:kept]
        complex_dtype = torch.complex64 if dtype == torch.float32 else torch.complex128
        self.transfer = (grid[: samples // 2 + 1] / samples).to(complex_dtype)
        self.shares = (positive / grid[torch.arange(kept) % samples]).to(complex_dtype)
        self.exposure_s = camera.exposure_s / exposures
        self.constant_e2 = camera.sensor.read_noise_e**2

    def table(self, modulation, demodulation):
        light = fft.rfft(modulation, dim=0).conj() * self.transfer[:, None]
        chi = fft.irfft(fft.rfft(demodulation, dim=0) * light, n=self.samples, dim=0)
        return chi, demodulation.mean(0)

    def harmonics(self, chi):
        spectrum = fft.fft(chi, dim=0)[torch.arange(len(self.shares)) % self.samples]
        coefficients = spectrum * self.shares[:, None] * (2 / self.samples)
        return torch.cat([coefficients[:1] / 2, coefficients[1:]])

    def electrons(self, chi, kappa, depth_m, signal, ambient):
        harmonics = self.harmonics(chi)
        turns = 2 * torch.pi * depth_m / self.camera.range_m
        angle = turns[:, None] * torch.arange(len(harmonics), dtype=turns.dtype)
        waves = torch.cat([angle.cos(), -angle.sin()], 1)
        values = waves @ torch.cat([harmonics.real, harmonics.imag])
        return self.exposure_s * (signal[:, None] * values + ambient * kappa)

    def capture(self, chi, kappa, depth_m, signal, ambient, seed):
        mean = self.electrons(chi, kappa, depth_m, signal, ambient)
        noise = torch.randn(mean.shape, dtype=torch.float64,
                            generator=torch.Generator().manual_seed(seed)).to(mean.dtype)
        return mean + (mean + self.constant_e2).clamp(min=1e-6).sqrt() * noise

    def chords(self, y, chi, kappa):
        direction = kappa / kappa.norm()
        points = chi - (chi @ direction)[:, None] * direction
        b0 = y @ points.T
        b1 = b0.roll(-1, 1)
        q00 = (points * points).sum(1) + 1e-10
        q11, q01 = q00.roll(-1), (points * points.roll(-1, 0)).sum(1)
        u, v = q11 * b0 - q01 * b1, q00 * b1 - q01 * b0
        inside = (u > 0) & (v > 0)
        end = (b1 * b1.abs() * q00 > b0 * b0.abs() * q11).to(y.dtype)
        t = torch.where(inside, v / torch.where(inside, u + v, 1.0), end)
        s = 1 - t
        match = (s * b0 + t * b1).clamp(min=0)
        score = 0.5 * match * match / (q00 * s * s + q11 * t * t + 2 * q01 * s * t)
        return torch.arange(self.samples, dtype=y.dtype) + t, score

    def soft_decode(self, y, chi, kappa, temperature_e2):
        place, score = self.chords(y, chi, kappa)
        shares = torch.softmax(score / temperature_e2[:, None], 1)
        return (shares * place).sum(1) * (self.camera.range_m / self.samples)

    def soft_depth_error_m(self, y, depth_m, chi, kappa, temperature_e2):
        bin_m = self.camera.range_m / self.samples
        place, score = self.chords(y, chi, kappa)
        shares = torch.softmax(score / temperature_e2[:, None], 1)
        return (shares * (place - depth_m[:, None] / bin_m).abs()).sum(1) * bin_m

    def bound_m(self, chi, kappa, signal, ambient):
        harmonics, points = self.harmonics(chi), 8 * self.samples
        half = torch.cat([harmonics[:1], harmonics[1:] / 2]) * points
        fine = fft.irfft(half, n=points, dim=0) * self.exposure_s
        value, cells = fine[1::2], points // 2
        slope = (fine[::2].roll(-1, 0) - fine[::2]) * cells
        weight = (signal * value + ambient * self.exposure_s * kappa + self.constant_e2).rsqrt()
        by_depth, by_signal = signal * slope * weight, value * weight
        by_ambient = self.exposure_s * kappa * weight
        by_ambient = by_ambient / by_ambient.norm(dim=-1, keepdim=True)
        by_signal = by_signal - (by_signal * by_ambient).sum(-1, keepdim=True) * by_ambient
        by_signal = by_signal / by_signal.norm(dim=-1, keepdim=True)
        by_depth = by_depth - (by_depth * by_ambient).sum(-1, keepdim=True) * by_ambient
        by_depth = by_depth - (by_depth * by_signal).sum(-1, keepdim=True) * by_signal
        return self.camera.range_m / by_depth.norm(dim=-1)


def time_of(step) -> float:
    start = time.process_time()  # CPU time: independent of other load
    step()
    return time.process_time() - start


def compare(name: str, ours, plain, inputs, tolerance: float, rounds: int) -> float:
    """Prints and returns the ratio of both, forward and backward."""
    def differentiated(function):
        value = function(*inputs)
        return value, torch.autograd.grad(value.sum(), inputs)

    for a, b in zip(*(sum(([v], list(g)), []) for v, g in map(differentiated, (ours, plain)))):
        difference = ((a - b).norm() / b.norm()).item()
        assert difference < tolerance, f"{name}: off by {difference}"
    times = [(time_of(lambda: differentiated(plain)), time_of(lambda: differentiated(ours)))
             for _ in range(rounds)]
    ratio = statistics.median(p / o for p, o in times)
    plain_s, ours_s = (min(column) for column in zip(*times))
    print(f"  {name:34} {1e3 * plain_s:8.2f} ms {1e3 * ours_s:8.2f} ms {ratio:6.1f}x", flush=True)
    return ratio


def main() -> None:
    pixels = int(sys.argv[1]) if len(sys.argv) > 1 else 4096
    rounds = 15
    torch.set_num_threads(1)
    tofsmith.set_threads(1)
    camera = tofsmith.Camera("paper-10f0")
    for samples, family in ((240, "hamiltonian-k4"), (240, "hamiltonian-k5"),
                            (960, "hamiltonian-k5")):
        code = tofsmith.build_family(family, camera.replace(samples=samples))
        for dtype in (torch.float64, torch.float32):
            print(f"{family}, N = {samples}, {pixels} pixels, {dtype}: plain, tofsmith, ratio")
            wiggle = torch.Generator().manual_seed(1)
            modulation, demodulation = (
                torch.as_tensor(w, dtype=dtype) + 0.01 * torch.rand(
                    w.shape, generator=wiggle, dtype=torch.float64).to(dtype)
                for w in (code.modulation, code.demodulation))
            exposures = modulation.shape[1]
            plain = Plain(camera, samples, exposures, dtype)
            depth_m = camera.range_m * torch.rand(
                pixels, generator=wiggle, dtype=torch.float64).to(dtype)
            signal = torch.full((pixels,), 1e5, dtype=dtype)
            ambient, ambient_e = torch.tensor(1e4, dtype=dtype), 1e4
            table = tst.measurement_table(modulation, demodulation, camera)
            chi, kappa = table.correlation, table.ambient_gain
            y = tst.capture(table, camera, depth_m, signal, ambient, seed=1)
            temperature = torch.full((pixels,), y.var().item() / 100, dtype=dtype)
            inputs = [modulation, demodulation, chi, kappa, y, signal, depth_m]
            for tensor in inputs[:-1]:
                tensor.requires_grad_()
            made = tst.MeasurementTable
            levels = torch.tensor([(s, a) for s in camera.operating.signal_e_per_s
                                   for a in camera.operating.ambient_e_per_s], dtype=dtype).T
            tolerance = 1e-6 if dtype == torch.float64 else 2e-2

            def whole(m, d):
                table = tst.measurement_table(m, d, camera)
                y = tst.capture(table, camera, depth_m, signal.detach(), ambient, seed=2)
                return tst.soft_depth_error_m(y, depth_m, table, camera, temperature)

            def plain_whole(m, d):
                table = plain.table(m, d)
                y = plain.capture(*table, depth_m, signal.detach(), ambient_e, 2)
                return plain.soft_depth_error_m(y, depth_m, *table, temperature)

            for name, ours, theirs, of in (
                ("measurement_table",
                 lambda m, d: tst.measurement_table(m, d, camera).correlation,
                 lambda m, d: plain.table(m, d)[0], (modulation, demodulation)),
                ("expected_electrons",
                 lambda x, k, s: tst.expected_electrons(made(x, k), camera, depth_m, s, ambient),
                 lambda x, k, s: plain.electrons(x, k, depth_m, s, ambient_e),
                 (chi, kappa, signal)),
                ("capture",
                 lambda x, k, s: tst.capture(made(x, k), camera, depth_m, s, ambient, seed=2),
                 lambda x, k, s: plain.capture(x, k, depth_m, s, ambient_e, 2),
                 (chi, kappa, signal)),
                ("soft_decode",
                 lambda y, x, k: tst.soft_decode(y, made(x, k), camera, temperature),
                 lambda y, x, k: plain.soft_decode(y, x, k, temperature), (y, chi, kappa)),
                ("soft_depth_error_m",
                 lambda y, x, k: tst.soft_depth_error_m(y, depth_m, made(x, k), camera, temperature),
                 lambda y, x, k: plain.soft_depth_error_m(y, depth_m, x, k, temperature),
                 (y, chi, kappa)),
                ("cramer_rao_bound_m",
                 lambda x, k: tst.cramer_rao_bound_m(made(x, k), camera, *levels),
                 lambda x, k: plain.bound_m(x, k, *levels[:, :, None, None]), (chi, kappa)),
                ("waveforms to soft depth error", whole, plain_whole,
                 (modulation, demodulation)),
            ):
                compare(name, ours, theirs, of, tolerance, rounds)


if __name__ == "__main__":
    main()
