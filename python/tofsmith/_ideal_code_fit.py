# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Ideal codes fitted to measured correlation functions; see docs/calibration.md."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Optional

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._camera_fields import ImpulseResponse
from ._check import FloatArray, Path
from ._code import CodeLike, code_of
from ._correlation_calibration import CalibratedCorrelation
from ._reports import Estimate


@dataclass(frozen=True)
class HarmonicRatio:
    """One harmonic of a measured table and of an ideal code: amplitudes, and the transfer of both
    arms (NaN if the code does not have the harmonic)."""

    harmonic: int
    measured: float
    ideal: float
    ratio: Estimate


@dataclass(frozen=True)
class IdealCodeFit:
    """An ideal code fitted to a measured table.

    Attributes
    ----------
    code : str
    delay_periods : float
        Delay of the measured curves relative to the code.
    reversed, inverted : bool
        Delay runs in the opposite direction; all signs are opposite.
    exposure : list of int
        Exposure of the code for each measured exposure.
    scale : float
        Raw numbers per unit of the code's correlation.
    ideal_residual, residual : float
        Rms residual relative to the rms of the table, without and with a response.
    response : ImpulseResponse
        Response of each arm; both are equal.
    parameter_hz : Estimate
        Its f_max_hz or cutoff_hz [Hz].
    fitted : ndarray, shape (N, K)
        Without means.
    harmonics : list of HarmonicRatio
        1 to 16.
    """

    code: str
    delay_periods: float
    reversed: bool
    inverted: bool
    exposure: list[int]
    scale: float
    ideal_residual: float
    residual: float
    response: ImpulseResponse
    parameter_hz: Estimate
    fitted: FloatArray
    harmonics: list[HarmonicRatio]
    _handle: _tofsmith.IdealCodeFit = field(repr=False, compare=False)
    _found: _tofsmith.CalibratedCorrelation = field(repr=False, compare=False)

    def camera(self, camera: CameraLike) -> Camera:
        """Returns the camera with the fitted response in both arms and the measured tap
        mismatch."""
        return Camera._of(self._handle.camera(camera_of(camera)._handle, self._found))

    def __repr__(self) -> str:
        return (
            f"<IdealCodeFit {self.code}: {100 * self.residual:.2f} % residual "
            f"({100 * self.ideal_residual:.2f} % without a response)>"
        )


def fit_ideal_codes(
    found: CalibratedCorrelation,
    camera: CameraLike,
    codes: Optional[Sequence[CodeLike]] = None,
) -> list[IdealCodeFit]:
    """Fits ideal codes, with a common response of both arms, to a measured table; smallest residual
    first.

    Parameters
    ----------
    found : CalibratedCorrelation
    camera : Camera or its name
    codes : sequence of CodeSet, names or files, optional
        Codes to fit. None: all built-in codes with K measurements.

    Raises
    ------
    ValueError
        If no code has K measurements.
    """
    _check.instance(found, CalibratedCorrelation, "found")
    camera = camera_of(camera)
    handles = None
    if codes is not None:
        ideal = camera.replace(light={"peak_factor": 1e6})
        handles = [code_of(code, ideal)._handle for code in codes]
    fits = _tofsmith.fit_ideal_codes(found._handle, camera._handle, handles)
    return [_fit(handle, found) for handle in fits]


def write_correlation_report(
    path: Path,
    found: CalibratedCorrelation,
    fits: Sequence[IdealCodeFit] = (),
    *,
    source: str = "a sweep",
    overwrite: bool = False,
) -> None:
    """Writes the page of `tofsmith calibrate correlation --report`: table, codes, harmonics, maps.

    Parameters
    ----------
    path : str or path
        .html
    found : CalibratedCorrelation
    fits : sequence of IdealCodeFit
        As returned by fit_ideal_codes(); empty: without codes.
    source : str
        Name of the sweep in the title.
    overwrite : bool

    Raises
    ------
    OSError
        If the page exists and `overwrite` is not set, or cannot be written.
    """
    _check.instance(found, CalibratedCorrelation, "found")
    handles = [_check.instance(fit, IdealCodeFit, "fits")._handle for fit in fits]
    _tofsmith.write_correlation_report(
        _check.path(path), found._handle, handles, _check.text(source, "source"), bool(overwrite)
    )


def _fit(handle: _tofsmith.IdealCodeFit, found: CalibratedCorrelation) -> IdealCodeFit:
    fields = handle.fields()
    fields["response"] = ImpulseResponse(**fields["response"])
    fields["parameter_hz"] = Estimate(*fields["parameter_hz"])
    fields["harmonics"] = [
        HarmonicRatio(**h | {"ratio": Estimate(*h["ratio"])}) for h in fields["harmonics"]
    ]
    return IdealCodeFit(**fields, _handle=handle, _found=found._handle)
