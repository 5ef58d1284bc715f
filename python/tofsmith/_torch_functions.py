# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Steps of the compiled module as PyTorch functions, for codes (B, ...) with checked shapes."""

from __future__ import annotations

from typing import Any, Optional

import torch
from torch import Tensor
from torch.autograd.function import once_differentiable

least_variance_e2 = 1e-6  # below, the noise has no gradient


def _arrays(tensors: Any) -> Any:
    """Converts tensors to NumPy arrays with the same memory."""
    return tuple(None if t is None else t.detach().contiguous().numpy() for t in tensors)


def _tensors(arrays: Any, like: Tensor) -> Any:
    return tuple(None if a is None else torch.from_numpy(a).to(like.dtype) for a in arrays)


def _codes_of(tensor: Tensor) -> Any:
    """Returns (..., N, columns) as an array (B, N, columns)."""
    return tensor.detach().contiguous().numpy().reshape((-1,) + tuple(tensor.shape[-2:]))


class Measure(torch.autograd.Function):
    """Maps waveforms (..., N, E), (..., N, D) to the tensors of tables (..., N, K), (..., K)."""

    @staticmethod
    def forward(ctx: Any, steps: Any, modulation: Tensor, demodulation: Tensor) -> Any:
        ctx.steps = steps
        ctx.save_for_backward(modulation, demodulation)
        made = steps.measure(_codes_of(modulation), _codes_of(demodulation))
        lead = modulation.shape[:-2]
        return _tensors((None if a is None else a.reshape(lead + a.shape[1:]) for a in made),
                        modulation)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, *by_table: Optional[Tensor]) -> Any:
        modulation, demodulation = ctx.saved_tensors
        codes = modulation.shape[:-2].numel()
        by_codes = (None if by is None else by.reshape((codes,) + by.shape[by.dim() - own:])
                    for by, own in zip(by_table, (2, 1, 2, 1)))
        arrays = ctx.steps.pull_back(
            _codes_of(modulation), _codes_of(demodulation), _arrays(by_codes))
        return (None, *(by.reshape(of.shape) for by, of in zip(
            _tensors(arrays, modulation), (modulation, demodulation))))


class Electrons(torch.autograd.Function):
    """Maps depths [bin] and light (B, P) and tables to measurements (B, P, K): "mean", "variance",
    or a noisy capture with a generator."""

    @staticmethod
    def forward(ctx: Any, steps: Any, what: Any, *inputs: Any) -> Tensor:
        ctx.steps, ctx.what = steps, what
        light, table = inputs[:3], inputs[3:]
        mean, variance = _tensors(steps.electrons(_arrays(table), *_arrays(light)),
                                  torch.empty(0, dtype=torch.float64))
        scale = None
        if what == "mean":
            values = mean
        elif what == "variance":
            values = variance
        else:
            noise = torch.randn(mean.shape, dtype=torch.float64, generator=what)
            deviation = variance.clamp(min=least_variance_e2).sqrt_()
            values = mean + deviation * noise
            # dy / d variance
            scale = torch.where(variance > least_variance_e2, noise / (2 * deviation), 0.0)
        ctx.save_for_backward(scale, *inputs)
        return values.to(inputs[0].dtype)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, by_values: Tensor) -> Any:
        scale, *inputs = ctx.saved_tensors
        by_values = by_values.to(torch.float64)
        none = torch.zeros_like(by_values)
        by_mean = none if ctx.what == "variance" else by_values
        by_variance = {"mean": none, "variance": by_values}.get(ctx.what, None) if isinstance(
            ctx.what, str) else by_values * scale
        needed = ctx.needs_input_grad
        by_table, *by_light = ctx.steps.pull_back_electrons(
            _arrays(inputs[3:]), *_arrays(inputs[:3]), *_arrays((by_mean, by_variance)),
            any(needed[5:]), any(needed[3:5]), needed[2])
        return (None, None, *_tensors(by_light, inputs[0]), *_tensors(by_table, inputs[0]))


class Decode(torch.autograd.Function):
    """Maps electrons (B, P, K), temperatures (B, P) and tables to depths [bin], or, with true
    depths, to absolute errors (B, P)."""

    @staticmethod
    def forward(ctx: Any, steps: Any, circular: bool, truth: Optional[Tensor], electrons: Tensor,
                temperature: Tensor, *table: Optional[Tensor]) -> Tensor:
        ctx.steps, ctx.circular = steps, circular
        ctx.save_for_backward(truth, electrons, temperature, *table)
        true_bin, y, temperature_e2 = _arrays((truth, electrons, temperature))
        answers = steps.decoded(_arrays(table), y, temperature_e2, circular, true_bin)
        return torch.from_numpy(answers).to(electrons.dtype)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, by_answers: Tensor) -> Any:
        truth, electrons, temperature, *table = ctx.saved_tensors
        true_bin, y, temperature_e2, weight = _arrays((truth, electrons, temperature, by_answers))
        by_table, array = ctx.steps.pull_back_decoded(
            _arrays(table), y, temperature_e2, ctx.circular, true_bin, weight)
        by_electrons = torch.from_numpy(array)
        # S is quadratic in y, so S / temperature is homogeneous of degree 2 in y and -1 in
        # temperature.
        by_temperature = (electrons * by_electrons).sum(-1) / (-2 * temperature)
        return (None, None, None, by_electrons, by_temperature, *_tensors(by_table, electrons))


class Bound(torch.autograd.Function):
    """Maps light (B, L) and tables to standard deviations (B, L, 4 N)."""

    @staticmethod
    def forward(ctx: Any, steps: Any, signal: Tensor, ambient: Tensor,
                *table: Optional[Tensor]) -> Tensor:
        ctx.steps = steps
        ctx.save_for_backward(signal, ambient, *table)
        sigma_m = steps.depth_deviation_m(_arrays(table), *_arrays((signal, ambient)))
        return torch.from_numpy(sigma_m).to(signal.dtype)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, by_sigma: Tensor) -> Any:
        signal, ambient, *table = ctx.saved_tensors
        by_table, *by_light = ctx.steps.pull_back_depth_deviation(
            _arrays(table), *_arrays((signal, ambient, by_sigma)))
        return (None, *_tensors(by_light, signal), *_tensors(by_table, signal))
