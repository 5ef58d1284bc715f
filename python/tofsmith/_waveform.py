# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""One period of a modulation or demodulation function."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._check import FloatArray


class Waveform:
    """One period of a modulation or demodulation function. Immutable.

    Binary waveforms are stored as switching times and sums of cosines as Fourier coefficients, both
    independent of any grid; all others as N samples, each constant in its cell [n, n + 1) / N.
    """

    _handle: _tofsmith.Waveform

    def __init__(self) -> None:
        raise TypeError("Waveform: use Waveform.binary(), Waveform.cosines() or Waveform.sampled()")

    @classmethod
    def _of(cls, handle: _tofsmith.Waveform) -> Waveform:
        waveform = cls.__new__(cls)
        waveform._handle = handle
        return waveform

    @classmethod
    def binary(cls, on_intervals: npt.ArrayLike, level: float = 1.0) -> Waveform:
        """Creates a waveform with `level` inside the intervals and 0 elsewhere.

        Parameters
        ----------
        on_intervals : array_like, shape (intervals, 2)
            Rise and fall of each [periods], sorted, disjoint; 0 <= rise < 1, fall <= rise + 1.
        level : float
            > 0.

        Raises
        ------
        ValueError
        """
        on = _check.finite_array(on_intervals, "on_intervals", "(intervals, 2)")
        return cls._of(_tofsmith.Waveform.binary(on, _check.number(level, "level")))

    @classmethod
    def sampled(cls, samples: npt.ArrayLike) -> Waveform:
        """Creates a waveform from values (N,), each constant in a cell of the period."""
        return cls._of(_tofsmith.Waveform.sampled(_check.finite_array(samples, "samples", "(N,)")))

    @classmethod
    def cosines(cls, coefficients: npt.ArrayLike) -> Waveform:
        """Creates x(t) = c_0 + 2 Re sum_n c_n exp(2 pi i n t), t in periods.

        Parameters
        ----------
        coefficients : array_like of complex, shape (harmonics + 1,)
            c_0 (real), c_1, ...

        Raises
        ------
        ValueError
        """
        c = np.atleast_1d(np.asarray(coefficients, np.complex128))
        return cls._of(_tofsmith.Waveform.cosines(c))

    @property
    def is_binary(self) -> bool:
        return self._handle.is_binary()

    @property
    def on_intervals(self) -> FloatArray:
        """Rise and fall of a binary waveform [periods], (intervals, 2); else (0, 2)."""
        return self._handle.on_intervals()

    @property
    def level(self) -> float:
        """Level of a binary waveform while it is on."""
        return self._handle.level()

    @property
    def samples(self) -> FloatArray:
        """Samples (N,) of a waveform that is neither binary nor a sum of cosines; else (0,)."""
        return self._handle.samples()

    @property
    def coefficients(self) -> npt.NDArray[np.complex128]:
        """Fourier coefficients c_0, c_1, ... of a sum of cosines; else (0,)."""
        return self._handle.coefficients()

    @property
    def mean(self) -> float:
        return self._handle.mean()

    @property
    def peak(self) -> float:
        return self._handle.peak()

    @property
    def duty(self) -> float:
        """Share of the period above half the peak."""
        return self._handle.duty()

    @property
    def edges(self) -> int:
        """Number of jumps in one period."""
        return self._handle.edges()

    def cell_averages(self, samples: int) -> FloatArray:
        """Returns means over N cells of the period, (samples,)."""
        return self._handle.cell_averages(_check.whole(samples, "samples", 1, 2**24))

    def delayed(self, periods: float) -> Waveform:
        """Returns the waveform delayed by `periods`."""
        return Waveform._of(self._handle.delayed(_check.number(periods, "periods")))

    def complement(self) -> Waveform:
        """Returns 1 - x, the waveform of the other bucket of a two-bucket sensor."""
        return Waveform._of(self._handle.complement())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Waveform) and self._handle.is_equal(other._handle)

    def __repr__(self) -> str:
        if self.is_binary:
            kind = "binary"
        elif len(self.coefficients):
            kind = f"cosines up to harmonic {len(self.coefficients) - 1}"
        else:
            kind = f"{len(self.samples)} samples"
        return f"<Waveform: {kind}, duty {self.duty:.4g}, peak {self.peak:.4g}, {self.edges} edges>"
