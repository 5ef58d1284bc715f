# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Filters of depth and phasors for picture_filters.py, each with a small grid of parameters.

Depth: median filter, bilateral filter and non-local means (OpenCV). Phasors, for sinusoids:
re-implementations of libfreenect2's bilateral and edge-aware filters, and unwrapping by kernel
density (Jaremo Lawin, Forssen and Ovren, "Efficient Multi-Frequency Phase Unwrapping using Kernel
Density Estimation", ECCV 2016).
"""

import itertools

import cv2
import numpy as np

RANGE_M = 299792458 / 2 / 15e6  # range of paper-10f0
# Frequencies of each sinusoid code, in units of the fundamental.
HARMONICS = {"sinusoid-k4": (1,), "multifrequency-k5": (1, 7)}
NAMES = ("median", "bilateral", "nlm", "phasors", "density")


def linear_image(path):
    """Mean of the channels in linear light, (H, W)."""
    if path.suffix == ".npy":
        return np.load(path).mean(-1)
    encoded = cv2.imread(str(path)).astype(np.float64) / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return linear.mean(-1)


def spread(image, kept):
    """Replaces pixels that are not kept by the nearest kept pixel."""
    if kept.all() or not kept.any():
        return image
    _, labels = cv2.distanceTransformWithLabels((~kept).astype(np.uint8), cv2.DIST_L2, 5,
                                                labelType=cv2.DIST_LABEL_PIXEL)
    value = np.zeros(labels.max() + 1, image.dtype)
    value[labels[kept]] = image[kept]
    return value[labels]


def planes(z, clearance_px):
    """Pixels whose neighbours up to `clearance_px` away are on the same plane: 1 / z is linear."""
    inverse = 1 / np.where(np.isfinite(z) & (z > 0), z, 1e3)
    bent = np.ones(z.shape, np.uint8)  # including the region beyond the border
    inner = slice(2, -2)
    bends = [
        np.abs(np.roll(inverse, apart, axis) - 2 * inverse + np.roll(inverse, -apart, axis))
        for axis in (0, 1) for apart in (1, 2)]
    bent[inner, inner] = (np.max(bends, axis=0) > 3e-6 * inverse)[inner, inner]
    size = 2 * clearance_px + 1
    return cv2.dilate(bent, np.ones((size, size), np.uint8)) == 0


def of_depth(depth):
    """Name of each filter, with parameters and depth for each point of its grid."""
    depth = depth.astype(np.float32)
    passes = [depth]
    for _ in range(16):
        passes.append(cv2.medianBlur(passes[-1], 5))
    bilateral, nlm = [], []
    for before in (0, 1, 3):
        steps = np.clip(passes[before] / RANGE_M, 0, 1) * 65535
        steps = np.round(steps).astype(np.uint16)
        for space_px, depth_m in itertools.product((2, 5), (0.03, 0.1, 0.3, 1)):
            bilateral.append((f"{before} medians, {space_px} px, {depth_m} m",
                              cv2.bilateralFilter(passes[before], -1, depth_m, space_px)))
        for h_m in (0.01, 0.03, 0.1, 0.3, 1):
            h = h_m / RANGE_M * 65535
            smooth = cv2.fastNlMeansDenoising(steps, [h], None, 5, 15, cv2.NORM_L1)
            nlm.append((f"{before} medians, h {h_m} m", smooth * (RANGE_M / 65535)))
    median = [(f"{n} times 5 x 5", passes[n]) for n in (1, 2, 4, 8, 16)]
    return {"median": median, "bilateral": bilateral, "nlm": nlm}


def windows(radius, shape):
    """Offsets except (0, 0), with the corresponding slices of an image padded by `radius`."""
    for dy, dx in itertools.product(range(-radius, radius + 1), repeat=2):
        if dy or dx:
            yield dy, dx, tuple(slice(radius + d, radius + d + n) for d, n in zip((dy, dx), shape))


def bilateral(phasor, radius, space_px, exponent, threshold):
    """libfreenect2's bilateral filter for one frequency, and the sum of differences (window of 9).

    A pixel below the threshold is replaced by the mean of the window; other pixels ignore
    neighbours below the threshold.
    """
    strength = np.abs(phasor)
    direction = phasor / np.maximum(strength, 1e-30)
    weak = strength < threshold
    strictness = np.where(weak, 0, exponent).astype(np.float32)
    padded = [np.pad(a, radius, mode="edge") for a in (phasor, direction, strength)]
    total, weights, edge = phasor.copy(), np.ones_like(strength), np.zeros_like(strength)
    for dy, dx, there in windows(radius, phasor.shape):
        other = padded[1][there]
        apart = 0.5 * (1 - direction.real * other.real - direction.imag * other.imag)
        w = np.exp(-(dy * dy + dx * dx) / (2 * space_px**2) - strictness * apart)
        w *= weak | (padded[2][there] >= threshold)
        total += w * padded[0][there]
        weights += w
        edge += apart
    return total / weights, edge * 9 / (2 * radius + 1) ** 2


def edges(depth, strength, differences):
    """Pixels kept by libfreenect2's edge-aware filter with its thresholds."""
    size = np.ones((3, 3), np.uint8)
    depth, strength = depth.astype(np.float32), strength.astype(np.float32)
    mean = cv2.blur(strength, (3, 3))
    variance = np.maximum(cv2.blur(strength**2, (3, 3)) - mean**2, 0)
    contrast = np.sqrt(variance) / np.maximum(mean, 1e-30)
    below, above = depth - cv2.erode(depth, size), cv2.dilate(depth, size) - depth
    flying = (contrast >= 0.05) & (below > 0.05) & (above > 0.03) & (np.maximum(below, above) > 0.1)
    return ~flying & (differences < 2.5)


class Phasors:
    """Phasors of a sinusoid code, and depth from their phases."""

    def __init__(self, table, harmonics):
        samples = len(table)
        phase = 2 * np.pi * np.arange(samples) / samples
        waves = [np.ones(samples)]
        for harmonic in harmonics:
            waves += [np.cos(harmonic * phase), np.sin(harmonic * phase)]
        response, *_ = np.linalg.lstsq(np.stack(waves, 1), table, rcond=None)
        self.inverse = np.linalg.pinv(response)  # (K, 1 + 2 F)
        self.harmonics, self.depth_m = harmonics, np.arange(samples + 1) * RANGE_M / samples
        # The table's own phases avoid a bias of waveforms that are not sinusoidal.
        self.phase = []
        for harmonic, own in zip(harmonics, self.of(table)):
            unwrapped = np.unwrap(np.angle(own))
            self.phase.append(np.append(unwrapped, unwrapped[0] + 2 * np.pi * harmonic))

    def of(self, measurements):
        """Phasors (H, W) of each frequency."""
        parts = measurements @ self.inverse
        waves = range(1, 1 + 2 * len(self.harmonics), 2)
        return [parts[..., w] + 1j * parts[..., w + 1] for w in waves]

    def deviation(self, measurements):
        """Standard deviation of each component [e], from shot noise and 20 e of read noise."""
        variance = np.maximum(measurements, 0) + 20.0**2
        return [np.sqrt((variance @ self.inverse[:, 1 + 2 * f: 3 + 2 * f] ** 2).mean(-1))
                for f in range(len(self.harmonics))]

    def depth(self, phasor, f, lobe):
        """Depth [m] for the phase of frequency f in a given lobe of its harmonic."""
        h, known = self.harmonics[f], self.phase[f]
        turn = np.angle(phasor) - known[0] + 2 * np.pi * lobe
        return np.interp(turn % (2 * np.pi * h), known - known[0], self.depth_m)

    def hypotheses(self, phasors, deviations, count=1):
        """Depth and cost (count, H, W), lowest cost first; cost: disagreement / variance."""
        coarse = self.depth(phasors[0], 0, 0)
        if len(phasors) == 1:
            return coarse[None], np.zeros_like(coarse)[None]
        metres = [RANGE_M / (2 * np.pi * h) for h in self.harmonics]
        parts = zip(metres, deviations, phasors)
        variances = [(m * d / np.maximum(np.abs(p), 1e-30)) ** 2 for m, d, p in parts]
        lobe = np.round((coarse - self.depth(phasors[1], 1, 0)) / (RANGE_M / self.harmonics[1]))
        depths, costs = [], []
        for _ in range(count):
            fine = self.depth(phasors[1], 1, lobe)
            apart = (coarse - fine + RANGE_M / 2) % RANGE_M - RANGE_M / 2
            depths.append((fine + apart * variances[1] / (variances[0] + variances[1])) % RANGE_M)
            costs.append(apart**2 / (variances[0] + variances[1]))
            lobe = lobe + np.where(apart < 0, -1, 1)
        return np.stack(depths), np.stack(costs)

    def filters(self, measurements, seen):
        """Name of each filter, with parameters and depth for each point of its grid."""
        deviations = self.deviation(measurements)
        raw = [spread(p, seen).astype(np.complex64) for p in self.of(measurements)]
        found, density = [], []
        starts = {}
        grid = [(1, 5, 3), *itertools.product((2,), (1.5, 5, 15), (0, 3))]
        for radius, exponent, sigmas in grid:
            phasors, least = raw, [sigmas * d for d in deviations]
            for n in range(1, 9):
                both = [bilateral(p, radius, radius, exponent, t) for p, t in zip(phasors, least)]
                phasors = [p for p, _ in both]
                if n not in (1, 2, 4, 8):
                    continue
                size = f"{2 * radius + 1} px, exponent {exponent}, threshold {sigmas} sigma"
                label = f"{n} times {size}"
                depth = self.hypotheses(phasors, deviations)[0][0]
                found.append((label, depth))
                kept = edges(depth, sum(map(np.abs, phasors)), np.max([e for _, e in both], axis=0))
                found.append((label + ", edges", spread(depth, kept & seen)))
                if (radius, exponent, sigmas, n) in ((1, 5, 3, 1), (2, 15, 3, 2), (2, 1.5, 0, 4)):
                    starts[label] = phasors
        if len(raw) > 1:
            for (label, phasors), kernel_m in itertools.product(starts.items(), (0.1, 0.4)):
                depth = by_density(*self.hypotheses(phasors, deviations, 2), kernel_m)
                density.append((f"{label}, kernel {kernel_m} m", depth))
        return {"phasors": found, **({"density": density} if density else {})}


def by_density(depth, cost, kernel_m, radius=5):
    """Selects one of two depths per pixel by the density of depths in 11 x 11 pixels."""
    depth, cost = depth.astype(np.float32), cost.astype(np.float32)
    likely = np.exp(-(cost - cost[:1]) / 2)
    likely /= likely.sum(0)
    shape = depth.shape[1:]
    around = ((0, 0), (radius, radius), (radius, radius))
    padded = [np.pad(a, around, mode="edge") for a in (depth, likely)]
    density = likely.copy()
    for dy, dx, there in windows(radius, shape):
        w = np.float32(np.exp(-(dy * dy + dx * dx) / (2 * (radius / 2) ** 2)))
        for j in range(2):
            z, p = padded[0][j][there], w * padded[1][j][there]
            for i in range(2):
                apart = (depth[i] - z) * np.float32(1 / kernel_m)
                density[i] += p * np.exp(-0.5 * apart * apart)
    return np.where(density[0] >= density[1], depth[0], depth[1])
