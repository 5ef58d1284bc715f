# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""What a camera says of its parts, under the keys of a camera file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Union


@dataclass(frozen=True)
class ImpulseResponse:
    """How a light source or a sensor smooths the waveform that drives it.

    Attributes
    ----------
    kind : str
        none, hann, gaussian, lowpass or file.
    f_max_hz : float, optional
        Of hann: where it attenuates by 5 [Hz].
    cutoff_hz : float, optional
        Of gaussian and lowpass: the frequency of -3 dB [Hz].
    samples : tuple of float, optional
        Of file: the measured response in steps of `time_step_s`; scaled to sum 1 where it is used.
    time_step_s : float, optional
        Of `samples` [s].
    file : str, optional
        Where `samples` came from.
    """

    kind: str = "none"
    f_max_hz: Optional[float] = None
    cutoff_hz: Optional[float] = None
    samples: Optional[tuple[float, ...]] = None
    time_step_s: Optional[float] = None
    file: Optional[str] = None


@dataclass(frozen=True)
class Generator:
    """An arm's waveform generator; see docs/formats.md for its keys."""

    sample_rate_hz: Optional[float] = None
    amplitude_bits: Optional[int] = None
    table_points: Optional[int] = None
    edge_grid_s: Optional[float] = None


@dataclass(frozen=True)
class Light:
    """The modulated light source.

    Attributes
    ----------
    peak_factor : float
        p = P_max / P_ave, >= 1.
    binary : bool
        A design for it may only switch on and off.
    impulse_response : ImpulseResponse
    edge_jitter_s : float
        Rms displacement of edges, period to period [s].
    generator : Generator, optional
        Plays the modulation; None: any waveform, exactly.
    """

    peak_factor: float
    binary: bool
    impulse_response: ImpulseResponse
    edge_jitter_s: float
    generator: Optional[Generator] = None


@dataclass(frozen=True)
class Sensor:
    """The demodulating pixel.

    Attributes
    ----------
    taps : int
        Values read out of one exposure: 1; 2 = two-bucket; n = exclusive taps.
    binary : bool
        A design for it may only switch on and off.
    impulse_response : ImpulseResponse
    edge_jitter_s : float
        Rms displacement of edges, period to period [s].
    read_noise_e : float
        Standard deviation per readout [e].
    noise : str
        poisson, or gaussian of the same variance.
    dark_current_e_per_s : float
        Per tap [e/s].
    modulation_contrast : float or tuple of float
        C in (0, 1]; below 1 the taps mix. A tuple: one per exposure or per frequency of the code.
    tap_mismatch : float
        Relative difference in sensitivity of neighbouring taps.
    drain : bool
        Charge may be thrown away; else the taps add to 1.
    readout : str
        separate; difference of two taps; or rows: weighted sums of the light in N time bins of
        one exposure.
    demodulation : str
        gain: of taps, in [0, 1]; or signed: the weight of a mixer, in [-1, 1].
    generator : Generator, optional
        Plays the demodulation; None: any waveform, exactly.
    full_well_e, adc_bits, gain_e_per_dn, black_level_dn, shortest_pulse_s : optional
        Clip [e]; quantize to so many bits; electrons per count [e/DN]; count without light [DN];
        shortest pulse or gap that a design may use [s].
    readout_gap_s, frame_period_s : float, optional
        Dark time after each exposure; time from frame to frame [s]. None: 0; no pause.
    """

    taps: int
    binary: bool
    impulse_response: ImpulseResponse
    edge_jitter_s: float
    read_noise_e: float
    noise: str
    dark_current_e_per_s: float
    modulation_contrast: Union[float, tuple[float, ...]]
    tap_mismatch: float
    drain: bool
    readout: str
    demodulation: str
    generator: Optional[Generator] = None
    full_well_e: Optional[float] = None
    adc_bits: Optional[int] = None
    gain_e_per_dn: Optional[float] = None
    black_level_dn: Optional[float] = None
    shortest_pulse_s: Optional[float] = None
    readout_gap_s: Optional[float] = None
    frame_period_s: Optional[float] = None


@dataclass(frozen=True)
class Lens:
    """A pinhole, ideal unless the lens distorts, or a map of rays; pixel centres are whole numbers.

    Attributes
    ----------
    fx_px, fy_px, cx_px, cy_px : float
        Focal lengths and optical axis [px].
    distortion_model : str, optional
        opencv or fisheye, of `distortion`; None: opencv.
    distortion : tuple of float, optional
        OpenCV's coefficients: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]]; of a fisheye k1 k2 k3 k4.
    width_px, height_px : int, optional
        Of the images that all this is of; None: of any.
    rays : str, optional
        In place of all these, a file of each pixel's ray (.npy): (H, W, 2) of x/z and y/z, or
        (H, W, 3) of directions.
    """

    fx_px: float = 0.0
    fy_px: float = 0.0
    cx_px: float = 0.0
    cy_px: float = 0.0
    distortion_model: Optional[str] = None
    distortion: Optional[tuple[float, ...]] = None
    width_px: Optional[int] = None
    height_px: Optional[int] = None
    rays: Optional[str] = None


@dataclass(frozen=True)
class LensBlur:
    """How simulations blur light before it falls on pixels; keys of `lens`, see docs/scenes.md.

    Attributes
    ----------
    blur : str
        none, gaussian, or disc of confusion.
    pixel_samples : int
        n of n x n rays over a pixel's square, of scenes of shapes.
    blur_sigma_px : float, optional
        Of gaussian: standard deviation [px].
    focal_length_m, f_number, focus_distance_m, pixel_pitch_m : float, optional
        Of disc: a thin lens.
    """

    blur: str
    pixel_samples: int
    blur_sigma_px: Optional[float] = None
    focal_length_m: Optional[float] = None
    f_number: Optional[float] = None
    focus_distance_m: Optional[float] = None
    pixel_pitch_m: Optional[float] = None


@dataclass(frozen=True)
class Optics:
    """What turns watts and lux into electrons; docs/optics.md.

    Attributes
    ----------
    source_power_w : float
        Mean optical power of the modulated light [W].
    wavelength_m : float
        [m].
    field_of_view_deg : tuple of two floats
        Full angles that the light fills, across and down [degrees].
    f_number, pixel_pitch_m : float
        Of the lens; distance between centres of pixels [m].
    quantum_efficiency, transmission, fill_factor : float
        Electrons per photon; of lens and filter; share of a pixel that is sensitive. In (0, 1].
    filter_width_m : float, optional
        Band that the filter passes [m]; with sunlight.
    sunlight_klux : float, optional
        Illuminance of surfaces by the sun [klx]; between 800 and 1000 nm.
    sunlight_w_per_m2_nm : float, optional
        Instead: what falls on them within the filter's band [W / m2 / nm].
    """

    source_power_w: float
    wavelength_m: float
    field_of_view_deg: tuple[float, float]
    f_number: float
    pixel_pitch_m: float
    quantum_efficiency: float
    transmission: float = 1.0
    fill_factor: float = 1.0
    filter_width_m: Optional[float] = None
    sunlight_klux: Optional[float] = None
    sunlight_w_per_m2_nm: Optional[float] = None


@dataclass(frozen=True)
class OperatingMultipath:
    """Multipath that a camera meets: second returns, uniform between limits; docs/multipath.md.

    Attributes
    ----------
    ratio, delay_m : tuple of two floats
        S2 / S1, in [0, 1], and the delay behind the direct return [m].
    weight : float
        Designs minimize E1^(1 - weight) E2^weight, with E1 the error of single returns and E2
        that with such a second one; in (0, 1).
    """

    ratio: tuple[float, float]
    delay_m: tuple[float, float]
    weight: float


@dataclass(frozen=True)
class Operating:
    """Where a code is judged: every pair of signal and ambient light.

    Attributes
    ----------
    signal_e_per_s, ambient_e_per_s : tuple of float
        Photo-electron rates were the sensor fully open [e/s].
    error : str
        linear or circular: which difference between true and decoded depth counts.
    albedo : float or str
        Scales the signal; "uniform": a fresh draw in (0, 1) for every trial.
    neighbours : int
        Pixels of one depth that a filter adds before it decodes: codes are judged on such sums.
    multipath : OperatingMultipath, optional
        What designs take into account; None: light comes back once.
    working_distance_m : tuple of two floats, optional
        Where depths lie, nearest and farthest [m]; None: anywhere in the unambiguous range.
    depths : tuple of float, optional
        How often depths occur: weights of equal parts of the working distance, or of the range,
        such as a scene's histogram; None: all depths alike.
    """

    signal_e_per_s: tuple[float, ...]
    ambient_e_per_s: tuple[float, ...]
    error: str
    albedo: Union[float, str]
    neighbours: int = 1
    multipath: Optional[OperatingMultipath] = None
    working_distance_m: Optional[tuple[float, float]] = None
    depths: Optional[tuple[float, ...]] = None


@dataclass(frozen=True)
class RawMarkers:
    """Special raw numbers, which a sensor or its driver writes in place of a measurement.

    Attributes
    ----------
    saturated : tuple of float
        The measurement is clipped. NaN and infinity are allowed.
    invalid : tuple of float
        There is no measurement, for example of a dead pixel. NaN and infinity are allowed.
    """

    saturated: tuple[float, ...] = ()
    invalid: tuple[float, ...] = ()


@dataclass(frozen=True)
class Playback:
    """How what is played differs from what the code says; `calibrate` finds it.

    Attributes
    ----------
    order : tuple of int
        Exposure of the code that is played first, second, ..; empty: as the code has them.
    reversed, inverted : bool
        Delay runs backwards; signs are opposite, taps swapped.
    offset_m : float
        Everything looks so much farther [m].
    """

    order: tuple[int, ...] = ()
    reversed: bool = False
    inverted: bool = False
    offset_m: float = 0.0


@dataclass(frozen=True)
class Temperature:
    """How depth and signal change with the camera's temperature; `calibrate temperature` finds it.

    Attributes
    ----------
    reference_c : float
        Where nothing changes [degrees C]; measured tables are those of this temperature.
    offset_m_per_c : float
        Everything looks so much farther per degree [m].
    signal_per_c : float
        d log(signal) per degree: 0.01 is about 1 % more.
    now_c : float, optional
        That the camera has [degrees C]; None: the reference. See Camera.at_temperature().
    """

    reference_c: float = 25.0
    offset_m_per_c: float = 0.0
    signal_per_c: float = 0.0
    now_c: Optional[float] = None
