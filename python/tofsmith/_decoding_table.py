# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What a decoder needs to know of a code on a camera, or of a measured table."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Optional

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Path
from ._code import CodeLike, code_of
from ._notebook import table_picture


class DecodingTable:
    """Everything a decoder needs to know of a code on a camera.

    See Also
    --------
    DecodingTable.load, DecodingTable.of_code, DecodingTable.of_measured
    """

    _handle: _tofsmith.DecodingTable
    _notes: list[str] = []
    #: Files it was read from, which no output may replace.
    _inputs: list[str] = []
    #: How it was made, for pickle: a class method's name, its arguments and keywords.
    _made: Optional[tuple[str, tuple[Any, ...], dict[str, Any]]] = None

    def __init__(self) -> None:
        raise TypeError(
            "DecodingTable: use DecodingTable.of_code(code, camera) or "
            "DecodingTable.of_measured(correlation, camera)"
        )

    @classmethod
    def _of(cls, handle: _tofsmith.DecodingTable) -> DecodingTable:
        table = cls.__new__(cls)
        table._handle = handle
        return table

    @classmethod
    def load(
        cls,
        code: Path,
        camera: CameraLike,
        *,
        range_m: Optional[float] = None,
        ambient: Optional[str] = None,
        axes: Optional[str] = None,
        keep_end_point: bool = False,
        taps: Optional[int] = None,
        tap_order: Optional[str] = None,
        order: Optional[Sequence[int]] = None,
        reversed: bool = False,
    ) -> DecodingTable:
        """The table of a family, of a code's file, or of a file of measured correlation functions,
        as `tofsmith decode --code` takes them.

        Parameters
        ----------
        code : str or path
            Name of a family, or a file: .json .npz of a code; .npz .npy .csv of a measured table.
        camera : Camera or its name
        range_m : float, optional
            Depth of a measured table [m]; None: the camera's.
        ambient : {"equal", "mean", "none"}, optional
            What constant light adds to the columns of a measured table; None: what the file says,
            or the same to all.
        axes : {"nk", "kn"}, optional
            Of a measured table: samples by measurements, or the other way.
        keep_end_point : bool
            Keep a measured table's last sample though it equals the first.
        taps : int, optional
            Of an .npz file; None: the camera's.
        tap_order : {"blocked", "interleaved"}, optional
            How the columns of an .npz file run; never guessed.
        order : sequence of int, optional
            Exposures of the code or table in the order in which frames have them.
        reversed : bool
            Delay runs against what code, camera or table say.

        Returns
        -------
        DecodingTable
            With what should be known of it in `notes`.

        Raises
        ------
        OSError
            If the file cannot be read, or its table distinguishes no depths.
        ValueError
            If a code is given what only measured tables need.
        """
        options = {
            "range_m": range_m,
            "ambient": ambient,
            "axes": axes,
            "keep_end_point": bool(keep_end_point),
            "taps": taps,
            "tap_order": tap_order,
            "order": None if order is None else [int(e) for e in order],
            "reversed": bool(reversed),
        }
        name = _check.path(code, "code")
        handle, _, notes = _tofsmith.load_decoding_table(name, camera_of(camera)._handle, options)
        table = cls._of(handle)
        table._made = ("load", (name, camera_of(camera)), options)
        table._notes = notes
        table._inputs = [name]
        if isinstance(camera, (str, os.PathLike)):
            table._inputs.append(os.fspath(camera))
        return table

    @classmethod
    def of_code(cls, code: CodeLike, camera: CameraLike) -> DecodingTable:
        """The table of a code on a camera."""
        camera = camera_of(camera)
        handle = code_of(code, camera)._handle
        table = cls._of(_tofsmith.DecodingTable.of_code(handle, camera._handle))
        table._made = ("of_code", (code_of(code, camera), camera), {})
        return table

    @classmethod
    def of_measured(
        cls,
        correlation: npt.ArrayLike,
        camera: Optional[CameraLike] = None,
        *,
        range_m: Optional[float] = None,
        taps: int = 1,
        ambient: Optional[str] = None,
    ) -> DecodingTable:
        """The table of measured correlation functions.

        Parameters
        ----------
        correlation : array_like, shape (N, K)
            chi up to one common factor, row n at depth_bin = n, the end point left out, the taps of
            an exposure side by side.
        camera : Camera or its name, optional
            Gives range, exposure, noise, saturation and read-out. None: equal exposures, raw
            numbers without read noise.
        range_m : float, optional
            Depth of the whole table [m]; needed without a camera.
        taps : int
            Columns per exposure.
        ambient : {"equal", "mean", "none"}, optional
            What constant light adds: the same to all columns (the default), as much as the mean of
            the column, or nothing.

        Raises
        ------
        ValueError
            If depths cannot be distinguished, or table and camera do not fit.
        """
        table = _check.finite_array(correlation, "correlation", "(N, K)")
        if camera is None:
            if range_m is None:
                raise ValueError("range_m: got None; needs the depth of the table in metres, or a "
                                 "camera that says it")
            if ambient is not None or taps != 1:
                raise ValueError("camera: got None; ambient and taps need the camera")
            metres = _check.number(range_m, "range_m")
            plain = cls._of(_tofsmith.DecodingTable.of_correlation(table, metres))
            plain._made = ("of_measured", (table,), {"range_m": metres})
            return plain
        camera = camera_of(camera)
        depth_m = None if range_m is None else _check.number(range_m, "range_m")
        measured = cls._of(_tofsmith.DecodingTable.of_measured(
            table, camera._handle, {"taps": taps, "ambient": ambient, "range_m": depth_m}))
        measured._made = ("of_measured", (table, camera),
                          {"range_m": range_m, "taps": taps, "ambient": ambient})
        return measured

    def __copy__(self) -> DecodingTable:
        return self  # immutable

    def __deepcopy__(self, memo: object) -> DecodingTable:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        if self._made is None:
            raise TypeError("a DecodingTable that a calibration made cannot be pickled: write it "
                            "with write_table(), and load it with DecodingTable.load()")
        return _remade, self._made

    def __repr__(self) -> str:
        samples, measurements = self.correlation.shape
        return f"<DecodingTable: K = {measurements}, N = {samples}, range {self.range_m:.4g} m>"

    def _repr_html_(self) -> str:
        return table_picture(self, self.correlation, self.range_m)

    @property
    def notes(self) -> list[str]:
        """What should be known of it, where it was loaded: depths that look the same, a last sample
        that was dropped, ambient light that was taken to be equal."""
        return list(self._notes)

    @property
    def correlation(self) -> FloatArray:
        """chi, (N, K)."""
        return self._handle.correlation()

    @property
    def ambient_gain(self) -> FloatArray:
        """kappa (K,)."""
        return self._handle.ambient_gain()

    @property
    def exposure_s(self) -> FloatArray:
        """T [s] (K,)."""
        return self._handle.exposure_s()

    @property
    def range_m(self) -> float:
        """Depth of a whole period [m]."""
        return self._handle.range_m()

    def ambiguous_depths(self) -> FloatArray:
        """Pairs of depths that look the same [m], (pairs, 2); decoders answer with the first."""
        return self._handle.ambiguous_depths()


def _remade(name: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> DecodingTable:
    """A pickled table: its file is read again, if it had one."""
    table: DecodingTable = getattr(DecodingTable, name)(*arguments, **keywords)
    return table


def table_of(code: CodeLike | DecodingTable, camera: Optional[CameraLike]) -> DecodingTable:
    """What a decoder is made of: a table as it is, a code or a file on a camera."""
    if isinstance(code, DecodingTable):
        return code
    if camera is None:
        raise TypeError("camera: got None; needs a tofsmith.Camera or its name")
    if isinstance(code, (str, os.PathLike)):
        return DecodingTable.load(code, camera)
    return DecodingTable.of_code(code, camera)
