# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Properties of a code on a camera, or of a measured table, that decoding requires."""

from __future__ import annotations

import os
from typing import Any, Optional, Unpack

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import FloatArray, Path
from ._code import CodeLike, code_of
from ._notebook import table_picture
from ._option_fields import TableOptions
from ._options import takes


class DecodingTable:
    """Properties of a code on a camera that a decoder requires.

    See Also
    --------
    DecodingTable.load, DecodingTable.of_code, DecodingTable.of_measured
    """

    _handle: _tofsmith.DecodingTable
    _notes: list[str] = []
    #: Input files of the table, which no output may replace.
    _inputs: list[str] = []
    #: Construction, for pickle: name of a class method, its arguments and keywords.
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
    @takes(TableOptions)
    def load(
        cls,
        code: Path,
        camera: CameraLike,
        **options: Unpack[TableOptions],
    ) -> DecodingTable:
        """Loads the table of a family, a code file, or a file of measured correlation functions, as
        `tofsmith decode --code`.

        Parameters
        ----------
        code : str or path
            Name of a family, or a file: .json or .npz for a code; .npz, .npy or .csv for measured
            tables.
        camera : Camera or its name
        **options
            As in TableOptions.

        Returns
        -------
        DecodingTable
            With warnings in `notes`.

        Raises
        ------
        OSError
            If the file cannot be read, or its table does not distinguish any depths.
        ValueError
            If options for measured tables are given for a code.
        """
        name = _check.path(code, "code")
        handle, _, notes = _tofsmith.load_decoding_table(name, camera_of(camera)._handle,
                                                         dict(options))
        table = cls._of(handle)
        table._made = ("load", (name, camera_of(camera)), dict(options))
        table._notes = notes
        table._inputs = [name]
        if isinstance(camera, (str, os.PathLike)):
            table._inputs.append(os.fspath(camera))
        return table

    @classmethod
    def of_code(cls, code: CodeLike, camera: CameraLike) -> DecodingTable:
        """Returns the table of a code on a camera."""
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
        """Returns the table of measured correlation functions.

        Parameters
        ----------
        correlation : array_like, shape (N, K)
            chi up to a common factor, row n at depth_bin = n, without the end point, with the taps
            of an exposure adjacent.
        camera : Camera or its name, optional
            Its range, exposure, noise, saturation and readout are used. None: equal exposures, raw
            numbers without read noise.
        range_m : float, optional
            Unambiguous range of the table [m]; required without a camera.
        taps : int
            Columns per exposure.
        ambient : {"equal", "mean", "none"}, optional
            Response of the columns to constant light: equal (the default), proportional to their
            mean, or zero.

        Raises
        ------
        ValueError
            If depths cannot be distinguished, or table and camera are inconsistent.
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
        depth_m = _check.optional_number(range_m, "range_m")
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
        """Warnings from loading the table: ambiguous depths, a last sample that was dropped,
        ambient gains that were assumed to be equal."""
        return list(self._notes)

    @property
    def correlation(self) -> FloatArray:
        """Correlation functions chi (N, K)."""
        return self._handle.correlation()

    @property
    def ambient_gain(self) -> FloatArray:
        """Ambient gains kappa (K,)."""
        return self._handle.ambient_gain()

    @property
    def exposure_s(self) -> FloatArray:
        """Exposure times T [s] (K,)."""
        return self._handle.exposure_s()

    @property
    def range_m(self) -> float:
        """Unambiguous range [m]."""
        return self._handle.range_m()

    def ambiguous_depths(self) -> FloatArray:
        """Returns pairs of indistinguishable depths [m], (pairs, 2); decoders return the first."""
        return self._handle.ambiguous_depths()


def _remade(name: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> DecodingTable:
    """Restores a pickled table, reading its file again if it has one."""
    return getattr(DecodingTable, name)(*arguments, **keywords)


def table_of(code: CodeLike | DecodingTable, camera: Optional[CameraLike]) -> DecodingTable:
    """Returns the table itself, or that of a code or file on a camera."""
    if isinstance(code, DecodingTable):
        return code
    if camera is None:
        raise TypeError("camera: got None; needs a tofsmith.Camera or its name")
    if isinstance(code, (str, os.PathLike)):
        return DecodingTable.load(code, camera)
    return DecodingTable.of_code(code, camera)
