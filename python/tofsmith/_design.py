# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Codes designed for a camera."""

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
from ._reports import DepthErrorReport, RobustnessReport, OperatingMultipathReport, report_of


@dataclass(frozen=True)
class MeasurementReport:
    """One measurement of a designed code and, if it has one, how it compares with its target. The
    arrays (iterations,) are of the random start that came closest."""

    residual_rms: float
    smallest_residual_rms: float
    demodulation_duty: float
    modulation_duty: float
    peak: float
    edges: int
    start: str
    objective: FloatArray
    relaxed_residual_rms: FloatArray
    playable_residual_rms: FloatArray


@dataclass(frozen=True)
class SearchRecord:
    """How a code was searched for: `error_m` (steps,) as it fell over `work` (steps,), whether no
    other code of the searched kind is better (`proved`), and an account of what was searched."""

    work_unit: str
    error_name: str
    work: FloatArray
    error_m: FloatArray
    proved: bool
    account: str


@dataclass(frozen=True)
class Candidate:
    """A code that competes for the camera.

    Attributes
    ----------
    code : CodeSet
    method : str
        family, naive, reference, atlas, factorize, optimize or search.
    ranking_error_m : float
        What candidates are ranked by [m]: depth error, robustness and multipath weighed in.
    error : DepthErrorReport
    rotation_bin : int
        How far the origin of depth was moved.
    iterations : int
    seconds : float
        Time it took to design.
    target : ndarray, shape (N, K) or (0, 0)
        What it was factorized for.
    per_measurement : list of MeasurementReport
        Of designed codes.
    search : SearchRecord, optional
        Of optimized and searched codes.
    message : str
        One line on how it came out.
    robustness : RobustnessReport, optional
    multipath : OperatingMultipathReport, optional
        On cameras with `operating.multipath`.
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

    @property
    def is_designed(self) -> bool:
        """Made for this camera; not a family, a reference or a naive code."""
        return bool(self.per_measurement)

    def __repr__(self) -> str:
        return f"<Candidate {self.code.name} ({self.method}): {self.ranking_error_m * 1e3:.4g} mm>"


@dataclass(frozen=True)
class DesignResult:
    """All candidates of a camera, and which one has the least `ranking_error_m`.

    Attributes
    ----------
    candidates : list of Candidate
    best : int
        Index of the winner.
    left_out : list of str
        Codes and methods that the camera cannot use, with the reason.
    explanation : list of str
        Why the winner won.
    """

    candidates: list[Candidate]
    best: int
    left_out: list[str]
    explanation: list[str]
    _handle: Optional[_tofsmith.FinishedDesign] = field(default=None, repr=False, compare=False)

    def write(self, directory: Path, *, overwrite: bool = False) -> None:
        """Writes the directory that `tofsmith design -o` does: codes, figures and report.html.

        Raises
        ------
        OSError
            If it holds a design and `overwrite` is not set, or cannot be written.
        ValueError
            Of a result that was pickled, which keeps its figures only.
        """
        self._finished().write(_check.path(directory, "directory"), bool(overwrite))

    def write_report(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the report page alone (.html); raises as write()."""
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
        """All candidates, the least error first."""
        return sorted(self.candidates, key=lambda c: c.ranking_error_m)

    def __getitem__(self, name: str) -> Candidate:
        """The candidate of that name; KeyError names those there are."""
        for candidate in self.candidates:
            if candidate.code.name == name:
                return candidate
        names = ", ".join(c.code.name for c in self.candidates)
        raise KeyError(f"no candidate '{name}'; there are {names}")

    def __repr__(self) -> str:
        return f"<DesignResult: {self.winner!r} of {len(self.candidates)} candidates>"


#: A family, a code file, a code, or correlation functions (N, K).
Target = Union[CodeSet, Path, npt.NDArray[Any]]


def _candidate(values: dict[str, Any], camera: Camera) -> Candidate:
    values["code"] = CodeSet._of(values["code"])
    values["error"] = report_of(values["error"], camera)
    values["per_measurement"] = [MeasurementReport(**m) for m in values["per_measurement"]]
    if values["search"] is not None:
        values["search"] = SearchRecord(**values["search"])
    if values["robustness"] is not None:
        values["robustness"] = RobustnessReport(**values["robustness"])
    if values["multipath"] is not None:
        values["multipath"] = OperatingMultipathReport(**values["multipath"])
    return Candidate(**values)


def target_of(target: Target, camera: Camera, normalize: bool) -> _tofsmith.TargetSet:
    if isinstance(target, np.ndarray):
        table = _check.finite_array(target, "target", "(N, K)")
        return _tofsmith.targets_from_table("target", table, camera.samples, normalize)
    if isinstance(target, (str, os.PathLike)):
        return _tofsmith.load_target(_check.path(target, "target"), camera._handle, normalize)
    if normalize:
        raise ValueError("normalize: goes with a target that is a table; codes are as they are")
    code = _check.instance(target, CodeSet, "target").resampled(camera.samples)
    return _tofsmith.targets_of(code._handle)


def suggested_exposures(camera: CameraLike, method: str = "best") -> list[int]:
    """Numbers of exposures that suit a method of design on a camera."""
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
    """Designs codes for a camera, lets baselines compete, and picks by the camera's depth error.

    Parameters
    ----------
    camera : Camera or its name
    target : str, path, CodeSet or ndarray (N, K), optional
        Correlation functions to factorize instead of Hamiltonian ones: a family, a code, a file of
        either kind (.code.json; .csv, .txt, .npy or .npz with `corrfs`), or values at equal steps of
        depth over one period, end point left out.
    normalize : bool
        Rescale the columns of a table to [0, 1].
    effort : float, optional
        How long to search, 0.01 .. 100 (1): 0.1 for a first look, 3 for the last percent; 0: not at
        all, method "atlas". Options of the methods below are not scaled.
    progress : callable, optional
    **options
        As DesignOptions; `optimize={"starts": 4, "hops": 0}` for a quick look.

    Returns
    -------
    DesignResult

    Raises
    ------
    ValueError
        For bad options, or a target that the camera cannot play.
    """
    camera = camera_of(camera)
    given: dict[str, Any] = {**options, "effort": effort}
    targets = None if target is None else target_of(target, camera, normalize)
    result = _tofsmith.design(camera._handle, given, targets, _check.progress(progress))
    result["candidates"] = [_candidate(c, camera) for c in result["candidates"]]
    return DesignResult(**result)


@dataclass(frozen=True)
class AtlasEntry:
    """The best code found for a camera of the atlas: 15 MHz, 0.3 s in all, read noise of 20 e, the
    paper's light levels.

    Attributes
    ----------
    code : CodeSet
    taps, exposures : int
    peak_factor : float
    bandwidth_f0 : float
        Of both arms [f0]; 0: no limit.
    shortest_pulse_periods : float
        Of the period; 0: any.
    error : str
        That it was designed for, linear or circular.
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
    """The atlas of best codes, as `tofsmith atlas` lists it. `design(camera, effort=0)` takes the best
    of the nearest for a camera."""
    def entry_of(fields: dict[str, Any]) -> AtlasEntry:
        code = CodeSet._of(fields.pop("code"))
        return AtlasEntry(code=code, **fields)

    return [entry_of(dict(fields)) for fields in _tofsmith.atlas()]


@dataclass(frozen=True)
class Sufficiency:
    """How much of one quantity suffices, all else as the camera has it.

    Attributes
    ----------
    quantity : str
        bandwidth, power or exposure.
    factor : float, optional
        Times the camera's: the least that suffices; None: not even `max_factor` does.
    error_m : float
        There, or at `max_factor` [m].
    code : CodeSet
        That reaches it.
    camera : Camera, optional
        With as much of the quantity.
    excluded_below : float, optional
        Below this factor no code can; None: the bound excludes nothing.
    """

    quantity: str
    factor: Optional[float]
    error_m: float
    code: CodeSet
    camera: Optional[Camera]
    excluded_below: Optional[float]


@dataclass(frozen=True)
class RequirementMap:
    """Error (bandwidth, power) [m] of the best code found at each bandwidth, over factors of bandwidth
    and power."""

    bandwidth: FloatArray
    power: FloatArray
    error_m: FloatArray


@dataclass(frozen=True)
class Requirements:
    """What it takes of a camera to measure depth as well as asked.

    Attributes
    ----------
    error_m : float
        That the camera reaches as it is [m], with `code`.
    code : CodeSet
    receiver_bound_mae_m : float, optional
        What no code undercuts on the camera as it is [m].
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
        """Writes the directory that `tofsmith require -o` does: codes, cameras, numbers and
        report.html.

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
    """The least bandwidth, power and exposure, each by itself, with which a code reaches an error,
    and below what no code can.

    Parameters
    ----------
    camera : Camera or its name
        `camera.at_distances(5, albedo=0.3, klux=50)` for the light at a distance.
    error_m : float
        Circular depth error that is asked for [m], > 0.
    progress : callable, optional
    **options
        As RequirementOptions.

    Returns
    -------
    Requirements

    Raises
    ------
    ValueError
        For bad options, or for bandwidth where neither arm has a limit.
    """
    given: dict[str, Any] = {**options, "error_m": error_m}
    handle = camera_of(camera)._handle
    found = _tofsmith.find_requirements(handle, given, _check.progress(progress))
    found["code"] = CodeSet._of(found["code"])
    for s in found["varied"]:
        s["code"] = CodeSet._of(s["code"])
        s["camera"] = None if s["camera"] is None else Camera._of(s["camera"])
    found["varied"] = [Sufficiency(**s) for s in found["varied"]]
    found["map"] = None if found["map"] is None else RequirementMap(**found["map"])
    return Requirements(**found)
