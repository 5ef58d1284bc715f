# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""PyTorch functions with gradients: measurements of a camera, soft decoding and the Cramer-Rao
bound, using the adjoints of the library, on the CPU. Requires Debian's ``python3-torch``.

Waveforms are converted to a table, from which all other functions compute:

>>> from tofsmith import torch as tst                                   # doctest: +SKIP
>>> table = tst.measurement_table(modulation, demodulation, camera)     # doctest: +SKIP
>>> y = tst.capture(table, camera, depth_m, 1e5, 1e4, seed=1)           # doctest: +SKIP
>>> depth = tst.soft_decode(y, table, camera, temperature_e2=2e3)       # doctest: +SKIP

Waveforms are constant in N cells per period. They may have any real values, even if no camera can
generate them. Tensors are float64 or float32, without mixing. Leading dimensions of waveforms and
tables enumerate codes; leading dimensions of light are broadcast to them. Results are identical for
any number of threads (``tofsmith.set_threads``). Only first-order gradients are supported.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple, Optional, Union

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of

try:
    import torch
    from torch import Tensor
except ImportError as error:
    raise ImportError(
        "tofsmith.torch needs PyTorch, which is not installed. On Debian: apt install "
        f"python3-torch ({error})", name=error.name) from error

from ._torch_functions import Bound, Decode, Electrons, Measure

__all__ = [
    "MeasurementTable",
    "capture",
    "cramer_rao_bound_m",
    "expected_electrons",
    "measurement_table",
    "soft_decode",
    "soft_depth_error_m",
    "variance_e2",
]

#: A tensor, or a number for all pixels.
TensorLike = Union[Tensor, float]


class MeasurementTable(NamedTuple):
    """Measurements of a code on a camera at the N depth bins."""

    correlation: Tensor
    """chi (..., N, K)."""
    ambient_gain: Tensor
    """kappa (..., K): mean gain for ambient light."""
    shot_correlation: Optional[Tensor] = None
    """chi of the collected light for differences of buckets (..., N, K); None: correlation."""
    shot_ambient_gain: Optional[Tensor] = None
    """kappa of the collected light (..., K); None: ambient_gain."""


def measurement_table(
    modulation: Tensor, demodulation: Tensor, camera: CameraLike
) -> MeasurementTable:
    """Computes the correlation functions of waveforms, including both arms, contrast and readout.

    Parameters
    ----------
    modulation : Tensor
        Emitted power over average power, (..., N, E).
    demodulation : Tensor
        Gain of every tap in every exposure, (..., N, E x taps), with the taps of an exposure
        adjacent.
    camera : Camera, or the name of a built-in camera or camera file
        Without rows, generators, playback, temperature and tap_mismatch.

    Returns
    -------
    MeasurementTable
    """
    camera = camera_of(camera)
    _waveforms(modulation, "modulation", "(.., N, E)")
    _same_dtype(_waveforms(demodulation, "demodulation", "(.., N, E x taps)"), "demodulation",
                modulation, "modulation")
    samples, exposures = modulation.shape[-2:]
    needed = (samples, exposures * camera.sensor.taps)
    if tuple(demodulation.shape[-2:]) != needed:
        raise ValueError(
            f"demodulation: got shape {tuple(demodulation.shape)}; needs (.., {needed[0]}, "
            f"{needed[1]}) for modulation of shape {tuple(modulation.shape)} and "
            f"{camera.sensor.taps} taps")
    lead = _broadcast("demodulation", demodulation.shape[:-2], modulation.shape[:-2])
    steps = _steps(camera, samples, exposures)
    return MeasurementTable(*Measure.apply(
        steps, *(waveforms if waveforms.shape[:-2] == lead else waveforms.expand(
            lead + waveforms.shape[-2:]) for waveforms in (modulation, demodulation))))


def expected_electrons(
    table: MeasurementTable, camera: CameraLike, depth_m: TensorLike,
    signal_e_per_s: TensorLike, ambient_e_per_s: TensorLike,
) -> Tensor:
    """Returns the expected measurements [e], equal to `ForwardModel` at any real depth.

    Parameters
    ----------
    table : MeasurementTable
    camera : Camera, or the name of a built-in camera or camera file
    depth_m, signal_e_per_s, ambient_e_per_s : Tensor or float
        Broadcast to (..., P) with the leading dimensions of the table; a table of one code accepts
        pixels of any shape. Light in electrons per second at a gate that is always open.

    Returns
    -------
    Tensor
        (..., P, K); gradients with respect to table, depth and light.
    """
    return _measured(table, camera, depth_m, signal_e_per_s, ambient_e_per_s, "mean")


def variance_e2(
    table: MeasurementTable, camera: CameraLike, depth_m: TensorLike,
    signal_e_per_s: TensorLike, ambient_e_per_s: TensorLike,
) -> Tensor:
    """Returns the variance of the measurements [e^2] before clipping; see `expected_electrons`."""
    return _measured(table, camera, depth_m, signal_e_per_s, ambient_e_per_s, "variance")


def capture(
    table: MeasurementTable, camera: CameraLike, depth_m: TensorLike,
    signal_e_per_s: TensorLike, ambient_e_per_s: TensorLike, *, seed: int,
) -> Tensor:
    """Returns noisy measurements [e]: y = mean + sqrt(variance) x with x standard normal. The
    gradient includes the dependence of the noise on light and code.

    Mean and variance agree with `tofsmith.capture` with poisson=False, but without clipping;
    quantization only adds its variance. Arguments are as in `expected_electrons`.

    Parameters
    ----------
    table, camera, depth_m, signal_e_per_s, ambient_e_per_s
    seed : int
        From 0 to 2^63 - 1, for a `torch.Generator`: equal shapes get equal noise.

    Returns
    -------
    Tensor
        (..., P, K)
    """
    noise = torch.Generator().manual_seed(_check.whole(seed, "seed", 0, 2**63 - 1))
    return _measured(table, camera, depth_m, signal_e_per_s, ambient_e_per_s, noise)


def soft_decode(
    electrons: Tensor, table: MeasurementTable, camera: CameraLike, temperature_e2: TensorLike
) -> Tensor:
    """Returns the expected depth [m] of the soft decoder of `optimize`: zero-mean normalized
    cross-correlation on chords between bins, each chosen with probability exp(S / temperature),
    S = 1/2 max(<y, p>, 0)^2 / |p|^2 at its best point p.

    If the camera's `operating.error` is "circular", the mean is that of wrapped differences from
    the best match.

    Parameters
    ----------
    electrons : Tensor
        (..., P, K) with the leading dimensions of the table, or any shape (..., K) for one code.
    table : MeasurementTable
        For float32 electrons, the decoder uses float32, which is twice as fast.
    camera : Camera, or the name of a built-in camera or camera file
    temperature_e2 : Tensor or float
        > 0, broadcast to (..., P). With the noise variance, weights are likelihoods.

    Returns
    -------
    Tensor
        (..., P); gradients with respect to electrons, table and temperature.
    """
    return _decoded(electrons, table, camera, temperature_e2, None)


def soft_depth_error_m(
    electrons: Tensor, depth_m: TensorLike, table: MeasurementTable, camera: CameraLike,
    temperature_e2: TensorLike,
) -> Tensor:
    """Returns the expected absolute depth error [m] of the soft decoder, the loss of `optimize`:
    linear or circular, from the camera's `operating.error`.

    Parameters
    ----------
    electrons : Tensor
        As in `soft_decode`.
    depth_m : Tensor or float
        True depths, broadcast to (..., P), without gradient.
    table, camera, temperature_e2
        As in `soft_decode`.

    Returns
    -------
    Tensor
        (..., P)
    """
    return _decoded(electrons, table, camera, temperature_e2, depth_m)


def cramer_rao_bound_m(
    table: MeasurementTable, camera: CameraLike, signal_e_per_s: TensorLike,
    ambient_e_per_s: TensorLike,
) -> Tensor:
    """Returns the minimum standard deviation of depth [m] at 4 N depths, with unknown signal and
    ambient light, as `CramerRaoBound.sigma_m`.

    Parameters
    ----------
    table : MeasurementTable
    camera : Camera, or the name of a built-in camera or camera file
    signal_e_per_s, ambient_e_per_s : Tensor or float
        Numbers, or broadcast to (..., L) with the leading dimensions of the table.

    Returns
    -------
    Tensor
        (..., 4 N) for numbers, else (..., L, 4 N); gradients with respect to table and light, zero
        where the result is infinite.
    """
    camera, tables, lead = _table(table, camera)
    lights = [_light(light, name, tables[0]) for light, name in (
        (signal_e_per_s, "signal_e_per_s"), (ambient_e_per_s, "ambient_e_per_s"))]
    shape, tables = _shape(tables, lead, lights, ("signal_e_per_s", "ambient_e_per_s"))
    flat = [_pixels(light, shape, len(tables[0])) for light in lights]
    sigma_m = Bound.apply(_steps_of(camera, tables[0]), *flat, *tables)
    cells = (4 * tables[0].shape[1],)
    return sigma_m.reshape((lead if _are_numbers(lights) else shape) + cells)


@lru_cache(maxsize=32)
def _steps(camera: Camera, samples: int, exposures: int) -> _tofsmith.CodeGradients:
    return _tofsmith.CodeGradients(camera._handle, samples, exposures)


def _steps_of(camera: Camera, correlation: Tensor) -> _tofsmith.CodeGradients:
    samples, measurements = correlation.shape[-2:]
    taps = 1 if camera.sensor.readout == "difference" else camera.sensor.taps
    if measurements % taps:
        raise ValueError(f"table.correlation: got {measurements} measurements; needs a multiple "
                         f"of the {taps} taps of the camera")
    return _steps(camera, samples, measurements // taps)


def _tensor(value: Any, name: str, axes: str) -> Tensor:
    """Checks a real tensor on the CPU with finite numbers."""
    if not isinstance(value, Tensor):
        raise TypeError(f"{name}: got {_check.shown(value)}; needs a torch.Tensor, {axes}")
    if value.device.type != "cpu" or value.layout != torch.strided:
        raise ValueError(f"{name}: got a tensor on {value.device}, layout {value.layout}; needs a "
                         "dense one on the CPU: .cpu()")
    if value.dtype not in (torch.float64, torch.float32):
        raise ValueError(f"{name}: got {value.dtype}; needs torch.float64 or torch.float32")
    if value.numel() == 0:
        raise ValueError(f"{name}: got shape {tuple(value.shape)}, which is empty; needs {axes}")
    # Fast path: one pass if all numbers are finite; a sum may overflow even if they are.
    if not math.isfinite(value.detach().sum().item()):
        infinite = (~torch.isfinite(value.detach())).nonzero()
        if len(infinite):
            place = tuple(int(i) for i in infinite[0])
            raise ValueError(f"{name}: got {value[place].item()} at {place}; needs finite numbers")
    return value


def _same_dtype(value: Tensor, name: str, other: Tensor, other_name: str) -> Tensor:
    if value.dtype != other.dtype:
        raise ValueError(f"{name}: got {value.dtype}; needs {other.dtype}, as {other_name}")
    return value


def _waveforms(value: Any, name: str, axes: str) -> Tensor:
    if _tensor(value, name, axes).dim() < 2:
        raise ValueError(f"{name}: got shape {tuple(value.shape)}; needs {axes}")
    return value


def _table(
    table: MeasurementTable, camera: CameraLike
) -> tuple[Camera, list[Any], tuple[int, ...]]:
    """Returns the checked tensors of a table, and its leading dimensions."""
    camera = camera_of(camera)
    if not isinstance(table, MeasurementTable):
        raise TypeError(f"table: got {_check.shown(table)}; needs what measurement_table() returns")
    correlation = _waveforms(table.correlation, "table.correlation", "(.., N, K)")
    lead, (samples, measurements) = correlation.shape[:-2], correlation.shape[-2:]
    is_difference = camera.sensor.readout == "difference"
    tensors: list[Any] = [correlation]
    for name, value in zip(table._fields[1:], table[1:]):
        if name.startswith("shot_") and not is_difference:
            if value is not None:
                raise ValueError(f"table.{name}: got a tensor; needs None where the camera reads "
                                 "no differences")
            tensors.append(None)
            continue
        needed = lead + ((samples,) if name.endswith("correlation") else ()) + (measurements,)
        _same_dtype(_tensor(value, f"table.{name}", str(tuple(needed))), f"table.{name}",
                    correlation, "table.correlation")
        if value.shape != needed:
            raise ValueError(f"table.{name}: got shape {tuple(value.shape)}; needs "
                             f"{tuple(needed)}, as table.correlation")
        tensors.append(value)
    return camera, tensors, tuple(lead)


def _light(value: TensorLike, name: str, like: Tensor, least: Optional[float] = 0.0) -> Tensor:
    """Checks the light of pixels; converts a number to a tensor of the table's dtype."""
    if not isinstance(value, Tensor):
        value = torch.tensor(_check.number(value, name), dtype=like.dtype)
    _same_dtype(_tensor(value, name, "(.., P)"), name, like, "table.correlation")
    if least is not None and not (value.detach() >= least).all():
        raise ValueError(f"{name}: got {value.detach().min().item()}; needs numbers >= {least:g}")
    return value


def _broadcast(name: str, *shapes: Any) -> tuple[int, ...]:
    if all(shape == shapes[0] for shape in shapes):
        return tuple(shapes[0])
    try:
        return tuple(torch.broadcast_shapes(*shapes))
    except RuntimeError:
        raise ValueError(f"{name}: got leading dimensions "
                         f"{' and '.join(str(tuple(s)) for s in shapes)}; needs some that "
                         "broadcast") from None


def _are_numbers(lights: list[Tensor]) -> bool:
    return all(light.dim() == 0 for light in lights)


def _shape(
    tables: list[Any], lead: tuple[int, ...], lights: list[Tensor], names: tuple[str, ...],
) -> tuple[tuple[int, ...], list[Any]]:
    """Returns the shape (..., P) of pixels, and the tables as (B, N, K), (B, K). A table of one
    code accepts pixels of any shape, one of several codes only matching shapes."""
    shape = _broadcast(", ".join(names), lead + (1,), *(light.shape for light in lights))
    if lead and len(shape) != len(lead) + 1:
        raise ValueError(f"{', '.join(names)}: got {len(shape)} dimensions; needs "
                         f"{len(lead) + 1}, (.., P), where tables of several codes have leading "
                         f"dimensions {lead}")
    codes = shape[:-1] if lead else ()
    return shape, [None if t is None else _codes(t, codes, t.dim() - len(lead)) for t in tables]


def _codes(value: Tensor, lead: tuple[int, ...], own: int) -> Tensor:
    """Broadcasts (..., own axes) to (B, own axes)."""
    own_shape = value.shape[value.dim() - own:]
    return value.expand(lead + own_shape).reshape((-1,) + own_shape)


def _pixels(value: Tensor, shape: tuple[int, ...], codes: int) -> Tensor:
    return value.expand(shape).reshape(codes, -1)


def _measured(
    table: MeasurementTable, camera: CameraLike, depth_m: TensorLike, signal: TensorLike,
    ambient: TensorLike, what: Any,
) -> Tensor:
    camera, tables, lead = _table(table, camera)
    names = ("depth_m", "signal_e_per_s", "ambient_e_per_s")
    lights = [_light(light, name, tables[0], None if name == "depth_m" else 0.0)
              for light, name in zip((depth_m, signal, ambient), names)]
    shape, tables = _shape(tables, lead, lights, names)
    flat = [_pixels(light, shape, len(tables[0])) for light in lights]
    flat[0] = flat[0] / (camera.range_m / tables[0].shape[1])
    values = Electrons.apply(_steps_of(camera, tables[0]), what, *flat, *tables)
    measurements = values.shape[-1:]
    return values.reshape((lead if _are_numbers(lights) else shape) + measurements)


def _decoded(
    electrons: Tensor, table: MeasurementTable, camera: CameraLike, temperature_e2: TensorLike,
    depth_m: Optional[TensorLike],
) -> Tensor:
    camera, tables, lead = _table(table, camera)
    correlation = tables[0]
    _same_dtype(_tensor(electrons, "electrons", "(.., P, K)"), "electrons", correlation,
                "table.correlation")
    if electrons.shape[-1:] != correlation.shape[-1:]:
        raise ValueError(f"electrons: got shape {tuple(electrons.shape)}; needs (.., "
                         f"{correlation.shape[-1]}), as many measurements as table.correlation")
    if correlation.shape[-1] < 2:
        raise ValueError("table.correlation: got 1 measurement; needs 2 or more to decode")
    temperature = _light(temperature_e2, "temperature_e2", correlation)
    if not (temperature.detach() > 0).all():
        raise ValueError("temperature_e2: got 0; needs numbers > 0")
    lights = [temperature]
    names: tuple[str, ...] = ("electrons", "temperature_e2")
    if depth_m is not None:
        depth = _light(depth_m, "depth_m", correlation, None)
        if depth.requires_grad:
            raise ValueError("depth_m: got a tensor that requires a gradient; true depths have "
                             "none: needs .detach()")
        lights, names = [temperature, depth], ("electrons", "temperature_e2", "depth_m")
    of_pixels = electrons[..., 0].detach()
    shape, tables = _shape(tables, lead, [of_pixels, *lights], names)
    codes = len(tables[0])
    steps = _steps_of(camera, correlation)
    light_e = electrons - torch.as_tensor(steps.dark_electrons(), dtype=electrons.dtype)
    flat = light_e.expand(shape + electrons.shape[-1:]).reshape(codes, -1, electrons.shape[-1])
    bin_m = camera.range_m / correlation.shape[-2]
    truth = None
    if depth_m is not None:
        truth = torch.remainder(_pixels(depth, shape, codes), camera.range_m) / bin_m
    answers = Decode.apply(steps, camera.operating.error == "circular", truth, flat,
                            _pixels(temperature, shape, codes), *tables)
    is_one = electrons.dim() == 1 and _are_numbers(lights)
    return bin_m * answers.reshape(lead if is_one else shape)
