# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Design of codes for a camera."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Optional, Union, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import FloatArray, Path, Progress
from ._code import CodeSet
from ._option_fields import DesignOptions, RequirementOptions
from ._options import takes
from ._reports import DepthErrorReport, OperatingMultipathReport
from ._result_fields import (
    ExposureOrder,
    InterferenceReport,
    MeasurementReport,
    RobustnessReport,
    SearchRecord,
)
from ._results import result_of


@dataclass(frozen=True)
class Candidate:
    """A candidate code for the camera.

    Attributes
    ----------
    code : CodeSet
    method : str
        family, naive, reference, atlas, factorize, optimize, search or frequencies.
    ranking_error_m : float
        Ranking criterion [m]: depth error, including robustness, multipath and interference.
    error : DepthErrorReport
    rotation_bin : int
        Rotation of the origin of depth.
    iterations : int
    seconds : float
        Duration of the design [s].
    target : ndarray, shape (N, K) or (0, 0)
        Target of the factorization.
    per_measurement : list of MeasurementReport
        For designed codes.
    search : SearchRecord, optional
        For optimized and searched codes.
    message : str
        One line on the result.
    robustness : RobustnessReport, optional
    multipath : OperatingMultipathReport, optional
        For cameras with `operating.multipath`.
    interference : InterferenceReport, optional
        For cameras with `operating.interference`.
    exposure_order : ExposureOrder, optional
        For cameras with `operating.velocity_m_per_s`.
    """

    code: CodeSet
    method: str
    ranking_error_m: float
    error: DepthErrorReport
    rotation_bin: int
    iterations: int
    seconds: float
    target: FloatArray
    per_measurement: list[MeasurementReport]
    search: Optional[SearchRecord]
    message: str
    robustness: Optional[RobustnessReport]
    multipath: Optional[OperatingMultipathReport]
    interference: Optional[InterferenceReport]
    exposure_order: Optional[ExposureOrder]

    @property
    def is_designed(self) -> bool:
        """True for codes designed for this camera, not a family, reference or naive code."""
        return bool(self.per_measurement)

    def __repr__(self) -> str:
        return f"<Candidate {self.code.name} ({self.method}): {self.ranking_error_m * 1e3:.4g} mm>"


@dataclass(frozen=True)
class DesignResult:
    """All candidates for a camera, ranked by `ranking_error_m`.

    Attributes
    ----------
    candidates : list of Candidate
    best : int
        Index of the best candidate.
    left_out : list of str
        Codes and methods that the camera does not support, with the reason.
    explanation : list of str
        Why the best candidate was chosen.
    """

    candidates: list[Candidate]
    best: int
    left_out: list[str]
    explanation: list[str]
    _handle: Optional[_tofsmith.FinishedDesign] = field(default=None, repr=False, compare=False)

    def write(self, directory: Path, *, overwrite: bool = False) -> None:
        """Writes the directory of `tofsmith design -o`: codes, figures and report.html.

        Raises
        ------
        OSError
            If it contains a design and `overwrite` is not set, or cannot be written.
        ValueError
            For a result that was pickled: pickling keeps only the numbers.
        """
        self._finished().write(_check.path(directory, "directory"), bool(overwrite))

    def write_report(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes only the report page (.html); raises as write()."""
        self._finished().write_report(_check.path(path), bool(overwrite))

    def _finished(self) -> _tofsmith.FinishedDesign:
        if self._handle is None:
            raise ValueError("DesignResult: got one that was pickled or put together; needs one "
                             "that design() returned")
        return self._handle

    def __getstate__(self) -> dict[str, Any]:
        return vars(self) | {"_handle": None}

    @property
    def winner(self) -> Candidate:
        return self.candidates[self.best]

    def by_ranking_error(self) -> list[Candidate]:
        """Returns all candidates by increasing error."""
        return sorted(self.candidates, key=lambda c: c.ranking_error_m)

    def __getitem__(self, name: str) -> Candidate:
        """Returns the candidate with a name; KeyError lists the existing names."""
        for candidate in self.candidates:
            if candidate.code.name == name:
                return candidate
        names = ", ".join(c.code.name for c in self.candidates)
        raise KeyError(f"no candidate '{name}'; there are {names}")

    def __repr__(self) -> str:
        return f"<DesignResult: {self.winner!r} of {len(self.candidates)} candidates>"


#: A family, a code file, a code, or correlation functions (N, K).
Target = Union[CodeSet, Path, npt.NDArray[Any]]


def target_of(target: Target, camera: Camera, normalize: bool) -> _tofsmith.TargetSet:
    if isinstance(target, np.ndarray):
        table = _check.finite_array(target, "target", "(N, K)")
        return _tofsmith.targets_from_table("target", table, camera.samples, normalize)
    if isinstance(target, (str, os.PathLike)):
        return _tofsmith.load_target(_check.path(target, "target"), camera._handle, normalize)
    if normalize:
        raise ValueError("normalize: is only valid with a target that is a table")
    code = _check.instance(target, CodeSet, "target").resampled(camera.samples)
    return _tofsmith.targets_of(code._handle)


def suggested_exposures(camera: CameraLike, method: str = "best") -> list[int]:
    """Returns suitable numbers of exposures for a design method on a camera."""
    return _tofsmith.suggested_exposures(camera_of(camera)._handle, _check.text(method, "method"))


@takes(DesignOptions)
def design(
    camera: CameraLike,
    *,
    target: Optional[Target] = None,
    normalize: bool = False,
    effort: Optional[float] = None,
    progress: Progress = None,
    **options: Unpack[DesignOptions],
) -> DesignResult:
    """Designs codes for a camera and ranks them with standard codes by the camera's depth error.

    Parameters
    ----------
    camera : Camera or its name
    target : str, path, CodeSet or ndarray (N, K), optional
        Correlation functions to factorize instead of Hamiltonian ones: a family, a code, an array
        (N, K), or a file with a code (.code.json) or an array (.csv, .txt, .npy, or .npz with
        `corrfs`). Arrays contain values at equal steps of depth over one period without its end
        point.
    normalize : bool
        Rescale the columns of a table to [0, 1].
    effort : float, optional
        Search effort, 0.01 to 100 (1): e.g. 0.1 for a first look, 3 for small improvements; 0: no
        search, method "atlas". Explicit options of the methods are not scaled.
    progress : callable, optional
    **options
        As in DesignOptions; `optimize={"starts": 4, "hops": 0}` for a quick look.

    Returns
    -------
    DesignResult

    Raises
    ------
    ValueError
        For invalid options, or a target that the camera does not support.
    """
    camera = camera_of(camera)
    given: dict[str, Any] = {**options, "effort": effort}
    targets = None if target is None else target_of(target, camera, normalize)
    result = _tofsmith.design(camera._handle, given, targets, _check.progress(progress))
    for candidate in result["candidates"]:
        candidate["error"]["kind"] = camera.operating.error
    return result_of(DesignResult, result)


@dataclass(frozen=True)
class AtlasEntry:
    """The best code found for a camera of the atlas: 15 MHz, 0.3 s total exposure, 20 e read noise,
    light levels of the paper.

    Attributes
    ----------
    code : CodeSet
    taps, exposures : int
    peak_factor : float
    bandwidth_f0 : float
        Bandwidth of both arms, relative to f0; 0: no limit.
    shortest_pulse_periods : float
        Relative to the period; 0: any.
    error : str
        Design criterion, linear or circular.
    linear_m, circular_m : float
        Geometric means over the light levels [m].
    """

    code: CodeSet
    taps: int
    exposures: int
    peak_factor: float
    bandwidth_f0: float
    shortest_pulse_periods: float
    error: str
    linear_m: float
    circular_m: float


def atlas() -> list[AtlasEntry]:
    """Returns the atlas of best codes, as listed by `tofsmith atlas`. `design(camera, effort=0)`
    selects the best code of the most similar cameras in the atlas."""
    return [result_of(AtlasEntry, fields) for fields in _tofsmith.atlas()]


@dataclass(frozen=True)
class Sufficiency:
    """Required value of one quantity, with the other properties of the camera unchanged.

    Attributes
    ----------
    quantity : str
        bandwidth, power or exposure.
    factor : float, optional
        Smallest sufficient multiple of the camera's value; None: `max_factor` is not sufficient.
    error_m : float
        Error at this factor, or at `max_factor` [m].
    code : CodeSet
        Code that reaches the error.
    camera : Camera, optional
        Camera with the required value.
    excluded_below : float, optional
        Factor below which no code can be sufficient; None: the bound excludes nothing.
    """

    quantity: str
    factor: Optional[float]
    error_m: float
    code: CodeSet
    camera: Optional[Camera]
    excluded_below: Optional[float]


@dataclass(frozen=True)
class RequirementMap:
    """Depth error (bandwidth, power) [m] of the best code found for each factor of bandwidth and
    power."""

    bandwidth: FloatArray
    power: FloatArray
    error_m: FloatArray


@dataclass(frozen=True)
class Requirements:
    """Result of find_requirements().

    Attributes
    ----------
    error_m : float
        Error of the unchanged camera with `code` [m].
    code : CodeSet
    receiver_bound_mae_m : float, optional
        Lower bound for any code on the unchanged camera [m].
    varied : list of Sufficiency
    map : RequirementMap, optional
    """

    error_m: float
    code: CodeSet
    receiver_bound_mae_m: Optional[float]
    varied: list[Sufficiency]
    map: Optional[RequirementMap]
    _handle: Optional[_tofsmith.FoundRequirements] = field(default=None, repr=False, compare=False)

    def write(self, directory: Path, *, overwrite: bool = False) -> None:
        """Writes the directory of `tofsmith require -o`: codes, cameras, numbers and report.html.

        Raises
        ------
        OSError
            If files exist and `overwrite` is not set, or cannot be written.
        """
        if self._handle is None:
            raise ValueError("these requirements were not found here: only results of "
                             "find_requirements() can be written")
        self._handle.write(_check.path(directory), bool(overwrite))


@takes(RequirementOptions)
def find_requirements(
    camera: CameraLike,
    error_m: float,
    *,
    progress: Progress = None,
    **options: Unpack[RequirementOptions],
) -> Requirements:
    """Finds the smallest bandwidth, power and exposure, each varied separately, with which a code
    reaches a depth error, and the values below which no code can reach it.

    Parameters
    ----------
    camera : Camera or its name
        E.g. `camera.at_distances(5, albedo=0.3, klux=50)` for the light at a distance.
    error_m : float
        Required circular depth error [m], > 0.
    progress : callable, optional
    **options
        As in RequirementOptions.

    Returns
    -------
    Requirements

    Raises
    ------
    ValueError
        For invalid options, or for bandwidth if neither arm has a limit.
    """
    given: dict[str, Any] = {**options, "error_m": error_m}
    handle = camera_of(camera)._handle
    return result_of(
        Requirements, _tofsmith.find_requirements(handle, given, _check.progress(progress)))
