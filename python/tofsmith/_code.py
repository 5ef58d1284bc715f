# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Coding functions: modulation of the light and demodulation of the sensor."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import Camera, CameraLike, camera_of
from ._check import FloatArray, Path
from ._notebook import code_picture
from ._waveform import Waveform


class CodeSet:
    """A set of coding functions: E modulations and K = E x taps demodulations. Immutable,
    picklable.

    Measurement i belongs to exposure i // taps and tap i % taps. The modulation is the emitted
    power over average power (mean at most 1). The demodulation is the sensor gain in [0, 1], or the
    weight of a mixer in [-1, 1].

    See Also
    --------
    build_family, load_code, CodeSet.from_arrays, CodeSet.from_waveforms, CodeSet.from_rows
    """

    _handle: _tofsmith.CodeSet

    def __init__(self, *_: object, **__: object) -> None:
        raise TypeError(
            "CodeSet: use build_family(name, camera), load_code(name_or_path, camera), "
            "CodeSet.from_arrays(modulation, demodulation) or CodeSet.from_waveforms(..)"
        )

    @classmethod
    def _of(cls, handle: _tofsmith.CodeSet) -> CodeSet:
        code = cls.__new__(cls)
        code._handle = handle
        return code

    @classmethod
    def from_arrays(
        cls,
        modulation: npt.ArrayLike,
        demodulation: npt.ArrayLike,
        *,
        taps: int = 1,
        name: str = "code",
        signed: bool = False,
    ) -> CodeSet:
        """Creates a code from samples. Columns with two levels, the lower of which is 0, become
        binary.

        Parameters
        ----------
        modulation : array_like, shape (N, E)
            Values >= 0 with mean at most 1 in every column.
        demodulation : array_like, shape (N, E * taps)
            Values in [0, 1], with the taps of an exposure adjacent; for mixers weights in [-1, 1].
        taps : int
            Measurements per exposure.
        name : str
        signed : bool
            For cameras with `sensor.demodulation` = "signed": weights of a mixer, with one tap.
            Columns of -1 and 1 become binary.

        Raises
        ------
        ValueError
            Naming the array and the violated rule.
        """
        light = _check.finite_array(modulation, "modulation", "(N, E)")
        sensor = _check.finite_array(demodulation, "demodulation", "(N, K)")
        for array, what, axes in ((light, "modulation", "(N, E)"), (sensor, "demodulation", "(N, K)")):
            if array.shape[0] < array.shape[1]:
                raise ValueError(f"{what}: got shape {array.shape}; needs {axes}, a row for each of N "
                                 "samples: turn it over (.T)")
        return cls._of(
            _tofsmith.CodeSet.from_arrays(
                _check.text(name, "name"),
                light,
                sensor,
                _check.whole(taps, "taps", 1, 1 if signed else 64),
                bool(signed),
            )
        )

    @classmethod
    def from_rows(
        cls, light: npt.ArrayLike, rows: npt.ArrayLike, *, name: str = "rows"
    ) -> CodeSet:
        """Creates rows of one exposure: K weighted sums of the light in N time bins.

        For cameras with `sensor.readout` = "rows".

        Parameters
        ----------
        light : array_like, shape (N,)
            Values >= 0 of any scale; scaled to a mean of 1.
        rows : array_like, shape (N, K) or (K, N)
            Weights of the time bins, of any sign and scale, K up to 16.
        name : str

        Raises
        ------
        ValueError
            Naming light or row and the violated rule.
        """
        return cls._of(
            _tofsmith.CodeSet.from_rows(
                _check.text(name, "name"),
                _check.finite_array(light, "light", "(N,)").reshape(-1, 1),
                _check.finite_array(rows, "rows", "(N, K)"),
            )
        )

    @classmethod
    def from_waveforms(
        cls,
        modulation: Sequence[Waveform],
        demodulation: Sequence[Waveform],
        *,
        samples: int,
        taps: int = 1,
        name: str = "code",
    ) -> CodeSet:
        """Creates a code from E modulations and E * taps demodulations, with `samples` per
        period."""
        return cls._of(
            _tofsmith.CodeSet.create(
                _check.text(name, "name"),
                _check.whole(samples, "samples", 1),
                _check.whole(taps, "taps", 1, 64),
                [_check.instance(m, Waveform, "modulation")._handle for m in modulation],
                [_check.instance(d, Waveform, "demodulation")._handle for d in demodulation],
            )
        )

    @classmethod
    def from_json(cls, text: str, file: str = "code.json") -> CodeSet:
        """Reads a code from the text of a .code.json file; `file` is its name in errors."""
        return cls._of(
            _tofsmith.CodeSet.parse(_check.text(text, "text"), _check.text(file, "file"))
        )

    def to_json(self) -> str:
        """Returns the code as the text of a .code.json file; numbers are read back exactly."""
        return self._handle.to_json()

    @property
    def name(self) -> str:
        return self._handle.name()

    @property
    def samples(self) -> int:
        """N, samples per period."""
        return self._handle.samples()

    @property
    def taps(self) -> int:
        """Measurements per exposure; for rows, their number."""
        return self._handle.taps()

    @property
    def is_rows(self) -> bool:
        """True if the measurements are weighted sums of the light of one exposure."""
        return self._handle.is_rows()

    @property
    def is_signed(self) -> bool:
        """True if the demodulations are weights of a mixer, in [-1, 1]."""
        return self._handle.is_signed()

    @property
    def exposures(self) -> int:
        """E, number of exposures."""
        return self._handle.exposures()

    @property
    def exposure_shares(self) -> tuple[float, ...]:
        """Share of the total integration time of each exposure (E); empty: equal shares."""
        return tuple(self._handle.exposure_shares())

    @property
    def measurements(self) -> int:
        """K = E x taps, number of measurements."""
        return self._handle.measurements()

    @property
    def peak(self) -> float:
        """Peak factor of the modulation."""
        return self._handle.peak()

    @property
    def modulation(self) -> FloatArray:
        """Cell averages of the modulation (N, E)."""
        return self._handle.modulation_samples()

    @property
    def demodulation(self) -> FloatArray:
        """Cell averages (N, K) of the demodulation: gains in [0, 1], mixer weights in [-1, 1], or
        rows."""
        return self._handle.demodulation_samples()

    def modulation_waveforms(self) -> list[Waveform]:
        """Returns the E modulation functions."""
        return [Waveform._of(self._handle.modulation(e)) for e in range(self.exposures)]

    def demodulation_waveforms(self) -> list[Waveform]:
        """Returns the K demodulation functions; for a mixer its drive (w + 1) / 2 in [0, 1]."""
        return [Waveform._of(self._handle.demodulation(i)) for i in range(self.measurements)]

    @property
    def provenance(self) -> dict[str, Any]:
        """Origin of the code: method, camera, seed, version, residuals, depth_error_m."""
        return self._handle.provenance()

    def renamed(self, name: str) -> CodeSet:
        return CodeSet._of(self._handle.renamed(_check.text(name, "name")))

    def resampled(self, samples: int) -> CodeSet:
        """Returns the same waveforms with another number of samples."""
        return CodeSet._of(self._handle.resampled(_check.whole(samples, "samples", 1)))

    def rotated(self, rotation_bin: int) -> CodeSet:
        """Returns the code with another origin of depth: correlation'(z) = correlation(z +
        rotation_bin)."""
        return CodeSet._of(
            self._handle.rotated(_check.whole(rotation_bin, "rotation_bin", -(2**31)))
        )

    def with_exposure_shares(self, shares: Sequence[float]) -> CodeSet:
        """Returns the same code with exposures of different length.

        Parameters
        ----------
        shares : sequence of float, shape (E,)
            Share of the total integration time of each exposure, > 0, of sum 1; empty: equal
            shares.

        Raises
        ------
        ValueError
            Naming the share and the violated rule.
        """
        return CodeSet._of(self._handle.with_exposure_shares([float(share) for share in shares]))

    def with_signed_weights(self) -> CodeSet:
        """Returns the code for a mixer: every gain d becomes the weight 2 d - 1. Requires taps =
        1."""
        return CodeSet._of(self._handle.with_signed_weights())

    def with_two_buckets(self) -> CodeSet:
        """Returns the code with the complement of every demodulation as second tap of the same
        exposure. Requires taps = 1."""
        return CodeSet._of(self._handle.with_two_buckets())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CodeSet) and self.to_json() == other.to_json()

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __reduce__(self) -> tuple[Any, ...]:
        return CodeSet.from_json, (self.to_json(),)

    def __repr__(self) -> str:
        return (
            f"<CodeSet {self.name}: E = {self.exposures}, taps = {self.taps}, "
            f"K = {self.measurements}, N = {self.samples}>"
        )

    def _repr_html_(self) -> str:
        return code_picture(self, self.modulation, self.demodulation, self.taps)


#: A code, or the name of a family or file.
CodeLike = Union[CodeSet, Path]


def code_of(code: CodeLike, camera: CameraLike) -> CodeSet:
    if isinstance(code, Camera) or (
            isinstance(code, str) and code in _tofsmith.built_in_camera_names()):
        raise TypeError(f"code: got {_check.shown(code)}, a camera; needs a code: does the camera "
                        "come second?")
    if isinstance(code, (str, os.PathLike)):  # as the command line does, with the camera's samples
        loaded, samples = load_code(code, camera), camera_of(camera).samples
        return loaded if loaded.samples == samples else loaded.resampled(samples)
    return _check.instance(code, CodeSet, "code")


def handles_of(code: CodeLike, camera: CameraLike) -> tuple[_tofsmith.CodeSet, _tofsmith.Camera]:
    """Returns the compiled objects of a code and its camera."""
    camera = camera_of(camera)
    return code_of(code, camera)._handle, camera._handle


def list_families() -> list[tuple[str, str, str]]:
    """Returns all built-in families: name pattern, an example, description."""
    return _tofsmith.list_families()


def build_family(name: str, camera: CameraLike) -> CodeSet:
    """Builds a family for the camera, with its peak factor, samples and taps.

    Raises
    ------
    ValueError
        For an unknown family, with the most similar known one, or one the camera does not support.
    """
    return CodeSet._of(
        _tofsmith.build_family(_check.text(name, "name"), camera_of(camera)._handle)
    )


def require_fits(code: CodeSet, camera: CameraLike) -> None:
    """Raises ValueError, with the reason, unless the camera supports `code`."""
    _tofsmith.require_fits(
        _check.instance(code, CodeSet, "code")._handle, camera_of(camera)._handle
    )


def why_not_playable(code: CodeSet, camera: CameraLike) -> Optional[str]:
    """Returns the reason why the camera does not support `code`; None if it does."""
    return _tofsmith.why_not_playable(
        _check.instance(code, CodeSet, "code")._handle, camera_of(camera)._handle
    )


def load_code(
    name_or_path: Path,
    camera: CameraLike,
    *,
    taps: Optional[int] = None,
    tap_order: Optional[str] = None,
) -> CodeSet:
    """Builds a family for the camera, or reads a code from a file without changing it.

    Parameters
    ----------
    name_or_path : str or path
        Family, .code.json or .npz (modfs, demodfs, each (N, K)).
    camera : Camera or its name
    taps : int, optional
        For .npz: measurements per exposure; None: the camera's.
    tap_order : {"blocked", "interleaved"}, optional
        Order of the columns; required for .npz with several taps.

    Raises
    ------
    OSError
        Naming the file and the position of the error.
    ValueError
        For a family that the camera does not support.
    """
    return CodeSet._of(
        _tofsmith.load_code(
            _check.path(name_or_path, "name_or_path"),
            camera_of(camera)._handle,
            None if taps is None else _check.whole(taps, "taps", 1, 64),
            tap_order,
        )
    )


def read_code(path: Path, *, taps: int = 1, tap_order: Optional[str] = None) -> CodeSet:
    """Reads a code from a .code.json or .npz file; see load_code()."""
    return CodeSet._of(
        _tofsmith.read_code(_check.path(path), _check.whole(taps, "taps", 1, 64), tap_order)
    )


def write_code(
    path: Path, code: CodeSet, *, overwrite: bool = False, tap_order: Optional[str] = None
) -> None:
    """Writes a code by extension: .json, or .npz, which needs `tap_order` for several taps.

    Raises
    ------
    OSError
        If the file exists and `overwrite` is not set, or cannot be written.
    """
    handle = _check.instance(code, CodeSet, "code")._handle
    _tofsmith.write_code(_check.path(path), handle, bool(overwrite), tap_order)
