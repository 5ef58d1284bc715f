# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Cameras: light source, sensor, lens and the light levels at which codes are evaluated."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera_fields import (
    Generator,
    ImpulseResponse,
    Lens,
    LensBlur,
    Light,
    Operating,
    OperatingInterference,
    OperatingMultipath,
    Optics,
    Playback,
    RawMarkers,
    Sensor,
    SensorTemperature,
    SquareLight,
    Temperature,
)
from ._check import Path
from ._notebook import camera_picture


def _tuples(values: Mapping[str, Any]) -> dict[str, Any]:
    return {key: tuple(v) if isinstance(v, list) else v for key, v in values.items()}


def _arm(values: Mapping[str, Any]) -> dict[str, Any]:
    arm = _tuples(values)
    arm["impulse_response"] = ImpulseResponse(**_tuples(arm.get("impulse_response") or {}))
    if arm.get("generator") is not None:
        arm["generator"] = Generator(**arm["generator"])
    return arm


def _toml(value: Any, name: str) -> str:
    """Returns the value as the right side of `key = ...`."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value))
    if isinstance(value, Mapping):
        inner = (f"{key} = {_toml(v, f'{name}.{key}')}" for key, v in value.items())
        return "{ " + ", ".join(inner) + " }"
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(v, name) for v in value) + "]"
    if hasattr(value, "__dataclass_fields__"):
        fields = {key: getattr(value, key) for key in value.__dataclass_fields__}
        return _toml({key: v for key, v in fields.items() if v is not None}, name)
    raise TypeError(
        f"{name}: got {_check.shown(value)}; needs a number, text, bool, list or dict, as in a "
        "camera file"
    )


def _settings(keys: Mapping[str, Any]) -> list[str]:
    """Returns keywords as `key=value`. Keys of light, sensor, raw, optics, operating and
    temperature become separate settings, so that their other keys do not change."""
    settings = []
    for key, value in keys.items():
        if key in ("light", "sensor", "raw", "optics", "operating", "temperature") and isinstance(value, Mapping):
            settings += _settings({f"{key}.{inner}": v for inner, v in value.items()})
        else:
            settings.append(f"{key}={_toml(value, key)}")
    return settings


class Camera:
    """A continuous-wave time-of-flight camera. Immutable; can be pickled.

    Keywords are the keys of a camera file (TOML): `fundamental_frequency_hz`, `exposure_s`,
    `samples`, `light`, `sensor`, `raw`, `lens`, `optics`, `operating`, `playback`, `temperature`;
    see docs/cameras.md. light, sensor, raw, optics, operating and temperature are dicts; keys that
    they do not contain do not change.

    Parameters
    ----------
    name_or_path : str or path, optional
        A built-in camera (`built_in_camera_names()`) or a .toml file. None: the defaults;
        `fundamental_frequency_hz` is then required.
    **keys
        Keys to override.

    Raises
    ------
    OSError
        If there is no such camera, or the file is invalid; names file, line, column.
    ValueError
        For unknown keywords or invalid values.

    Examples
    --------
    >>> camera = Camera("paper-10f0", light={"peak_factor": 5})
    >>> camera.light.peak_factor
    5.0
    """

    _handle: _tofsmith.Camera
    _hash: Optional[int] = None

    def __init__(self, name_or_path: Optional[Path] = None, **keys: Any) -> None:
        settings = _settings(keys)
        if name_or_path is not None:
            source = _check.path(name_or_path, "name_or_path")
            self._handle = _refused(lambda: _tofsmith.Camera.load(source, settings))
        else:
            try:
                self._handle = _tofsmith.Camera.parse("", "camera", settings)
            except OSError as error:  # no file is involved
                raise ValueError(str(error)) from None

    @classmethod
    def _of(cls, handle: _tofsmith.Camera) -> Camera:
        camera = cls.__new__(cls)
        camera._handle = handle
        return camera

    @classmethod
    def from_toml(cls, text: str, source_name: str = "camera.toml") -> Camera:
        """Creates a camera from the text of a camera file.

        Raises
        ------
        OSError
            With `source_name`, line and column.
        """
        text, source_name = _check.text(text, "text"), _check.text(source_name, "source_name")
        return cls._of(_tofsmith.Camera.parse(text, source_name, []))

    def replace(self, **keys: Any) -> Camera:
        """Returns the camera with some keys replaced, as in the constructor.

        Examples
        --------
        >>> Camera("paper-10f0").replace(samples=120).samples
        120
        """
        settings = _settings(keys)
        return Camera._of(_refused(lambda: self._handle.with_settings(settings)))

    def to_toml(self) -> str:
        """Returns the camera as the text of a camera file, with all defaults."""
        return self._handle.to_toml()

    def write(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes a camera file (.toml) for `design`, `evaluate` and `decode`.

        Raises
        ------
        OSError
            If the file exists and `overwrite` is not set, or if it cannot be written.
        """
        self._handle.write(_check.path(path), bool(overwrite))

    @cached_property
    def _fields(self) -> dict[str, Any]:
        return json.loads(self._handle.to_json())

    def _part(self, table: str, part: Any) -> dict[str, Any]:
        """Returns the keys of a table that are attributes of a class."""
        values = self._fields.get(table, {})
        return {key: values[key] for key in part.__dataclass_fields__ if key in values}

    @property
    def name(self) -> str:
        return str(self._fields["name"])

    @property
    def fundamental_frequency_hz(self) -> float:
        """f0 [Hz]: repetition frequency of all codes."""
        return float(self._fields["fundamental_frequency_hz"])

    @property
    def exposure_s(self) -> Union[float, tuple[float, ...]]:
        """Integration time [s]: a total for all exposures, or one per exposure."""
        value = self._fields["exposure_s"]
        return tuple(value) if isinstance(value, list) else float(value)

    @property
    def samples(self) -> int:
        """N, time samples per period."""
        return int(self._fields["samples"])

    @cached_property
    def light(self) -> Light:
        return Light(**_arm(self._part("light", Light)))

    @cached_property
    def square_light(self) -> Optional[SquareLight]:
        """Square waves that the chip can generate, if the camera lists them: the other keys of
        `light`."""
        square = self._part("light", SquareLight)
        return SquareLight(**_tuples(square)) if square else None

    @cached_property
    def sensor(self) -> Sensor:
        return Sensor(**_arm(self._fields["sensor"]))

    @cached_property
    def raw(self) -> RawMarkers:
        """Special raw numbers for saturated or invalid measurements; none by default."""
        lists = self._fields.get("raw", {})
        return RawMarkers(**{key: tuple(map(float, numbers)) for key, numbers in lists.items()})

    @cached_property
    def lens(self) -> Optional[Lens]:
        """The pinhole, if the camera has one."""
        lens = self._part("lens", Lens)
        return Lens(**_tuples(lens)) if lens else None

    @cached_property
    def blur(self) -> Optional[LensBlur]:
        """Blur of the lens, if any: the other keys of `lens`."""
        blur = self._part("lens", LensBlur)
        return LensBlur(**blur) if blur else None

    @cached_property
    def optics(self) -> Optional[Optics]:
        """Conversion of watts and lux to electrons, if specified."""
        optics = self._fields.get("optics")
        return None if optics is None else Optics(**_tuples(optics))

    @cached_property
    def playback(self) -> Optional[Playback]:
        """Differences between the exposures of the camera and of the code, if specified."""
        playback = self._fields.get("playback")
        return None if playback is None else Playback(**_tuples(playback))

    @cached_property
    def temperature(self) -> Optional[Temperature]:
        """Dependence of depth and signal on the temperature, if specified."""
        temperature = self._fields.get("temperature")
        if temperature is None:
            return None
        fields: dict[str, Any] = dict(temperature)
        if fields.get("sensor") is not None:
            fields["sensor"] = SensorTemperature(**fields["sensor"])
        return Temperature(**fields)

    def at_temperature(
        self, temperature_c: float, sensor_temperature_c: Optional[float] = None
    ) -> Camera:
        """Returns the camera at a temperature [degrees C], for simulating and decoding frames
        recorded at this temperature.

        Parameters
        ----------
        temperature_c : float
            Temperature of the camera, or of its light source if it has [temperature.sensor].
        sensor_temperature_c : float, optional
            Temperature of the sensor. By default it does not change.

        Raises
        ------
        ValueError
            If the camera has no [temperature].

        Examples
        --------
        >>> warms = Camera("paper-10f0", temperature={"offset_m_per_c": 1e-3, "reference_c": 30.0})
        >>> warms.at_temperature(42.0).temperature.now_c
        42.0
        """
        if self.temperature is None:
            raise ValueError("temperature_c: the camera has no [temperature]; needs the "
                             "result of calibrate_temperature()")
        now = {"temperature.now_c": _check.number(temperature_c, "temperature_c")}
        if sensor_temperature_c is not None:
            if self.temperature.sensor is None:
                raise ValueError("sensor_temperature_c: the camera has no [temperature.sensor]; "
                                 "needs the result of calibrate_temperature() with "
                                 "sensor_temperature_c")
            now["temperature.sensor.now_c"] = _check.number(
                sensor_temperature_c, "sensor_temperature_c")
        return self.replace(**now)

    def at_distances(
        self,
        distances_m: Union[float, Sequence[float]],
        *,
        albedo: float = 1.0,
        klux: Optional[float] = None,
    ) -> Camera:
        """Returns the camera with operating points for surfaces at these distances, computed by its
        optics, brightest first.

        Parameters
        ----------
        distances_m : float or sequence of float
            Distances [m], > 0.
        albedo : float
            Albedo of the surfaces, in (0, 1].
        klux : float, optional
            Sunlight on the surfaces [klx], overrides that of the optics.

        Raises
        ------
        ValueError
            For a camera without optics, or invalid values.

        Examples
        --------
        >>> optics = {"source_power_w": 0.5, "wavelength_m": 940e-9, "field_of_view_deg": [70, 55],
        ...           "f_number": 1.2, "pixel_pitch_m": 7e-6, "quantum_efficiency": 0.3}
        >>> near = Camera("paper-10f0", optics=optics).at_distances(2.0, albedo=0.3)
        >>> round(near.operating.signal_e_per_s[0])
        310600
        """
        distances = np.atleast_1d(np.asarray(distances_m, dtype=np.float64)).ravel().tolist()
        sun = _check.optional_number(klux, "klux")
        return Camera._of(
            self._handle.at_distances(distances, _check.number(albedo, "albedo"), sun)
        )

    @cached_property
    def operating(self) -> Operating:
        operating = _tuples(self._fields["operating"])
        if operating.get("multipath") is not None:
            operating["multipath"] = OperatingMultipath(**_tuples(operating["multipath"]))
        if operating.get("interference") is not None:
            operating["interference"] = OperatingInterference(**operating["interference"])
        return Operating(**operating)

    @property
    def range_m(self) -> float:
        """Unambiguous range [m]: c / (2 f0)."""
        return self._handle.range_m()

    @property
    def bin_m(self) -> float:
        """Depth of one bin [m]: range / N."""
        return self._handle.bin_m()

    def transfer(self, highest: int) -> npt.NDArray[np.complex128]:
        """Returns the transfer function of the light source (H_m) and the sensor (H_d) together,
        H_d(n f0) conj(H_m(n f0)), for n = 0 to `highest`.

        Returns
        -------
        ndarray of complex128, shape (highest + 1,)
        """
        return self._handle.transfer(_check.whole(highest, "highest", 0, 1_000_000))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and self._handle.is_equal(other._handle)

    def __hash__(self) -> int:
        if self._hash is None:
            self._hash = hash(self.to_toml())
        return self._hash

    def __reduce__(self) -> tuple[Any, ...]:
        return Camera.from_toml, (self.to_toml(), self.name)

    def _repr_html_(self) -> str:
        return camera_picture(self, self.fundamental_frequency_hz, self.transfer(12))

    def __repr__(self) -> str:
        return (
            f"<Camera {self.name}: f0 = {self.fundamental_frequency_hz / 1e6:g} MHz, range "
            f"{self.range_m:.4g} m, N = {self.samples}, p = {self.light.peak_factor:g}, "
            f"taps = {self.sensor.taps}>"
        )


def _refused(make: Any) -> _tofsmith.Camera:
    """Converts errors in keywords to ValueError, because no file is involved."""
    try:
        return make()
    except OSError as error:
        if getattr(error, "place", "").startswith("setting "):
            raise ValueError(str(error)) from None
        raise


#: A camera, or its name or file.
CameraLike = Union[Camera, Path]


def camera_of(camera: CameraLike) -> Camera:
    if isinstance(camera, str) and any(
            camera == name for _, name, _ in _tofsmith.list_families()):
        raise TypeError(f"camera: got {_check.shown(camera)}, a code; needs a camera: does the code "
                        "come first?")
    if isinstance(camera, (str, os.PathLike)):
        return Camera(camera)
    return _check.instance(camera, Camera, "camera")


def built_in_camera_names() -> list[str]:
    """Returns the names of the built-in cameras."""
    return _tofsmith.built_in_camera_names()


def camera_keys() -> list[str]:
    """Returns all keys of camera files, such as "light.impulse_response.f_max_hz"."""
    return _tofsmith.camera_keys()
