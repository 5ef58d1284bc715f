# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes, and captures of them by a camera."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, Optional, Union, Unpack

import numpy as np
import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._camera_fields import Lens
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._light import ExponentialTail, MultipathReturns, Transients, light_dict
from ._notebook import depth_picture
from ._option_fields import CaptureOptions, SceneSource
from ._options import takes

FloatImage = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False, repr=False)
class Scene:
    """A scene as seen by a camera; all planes are (H, W).

    Attributes
    ----------
    depth_m : ndarray
        Radial distance from the camera [m], > 0; NaN without return. radial_from_z() computes it
        from depth along the axis.
    albedo : ndarray or float, optional
        Reflectance, [0, 1]; None: 1. A number applies to all pixels.
    cosine : ndarray or float, optional
        Cosine of the angle of incidence, [0, 1]; None: 1.
    ambient_scale : ndarray or float, optional
        Ambient light relative to that of the capture, >= 0; None: 1.
    lens : Lens, optional
        Pinhole projection and distortion of the view.
    """

    depth_m: npt.NDArray[Any]
    albedo: Union[npt.NDArray[Any], float, None] = None
    cosine: Union[npt.NDArray[Any], float, None] = None
    ambient_scale: Union[npt.NDArray[Any], float, None] = None
    lens: Optional[Lens] = None

    def _planes(self) -> dict[str, npt.NDArray[Any]]:
        names = ("depth_m", "albedo", "cosine", "ambient_scale")
        return {name: np.asarray(getattr(self, name)) for name in names
                if getattr(self, name) is not None}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        mine, others = self._planes(), other._planes()
        return self.lens == other.lens and mine.keys() == others.keys() and all(
            np.array_equal(plane, others[name], equal_nan=plane.dtype.kind == "f")
            for name, plane in mine.items())

    __hash__ = None  # type: ignore[assignment]  # arrays are mutable

    def __repr__(self) -> str:
        depth_m = np.asarray(self.depth_m)
        shape = " x ".join(str(n) for n in depth_m.shape)
        parts = []
        if depth_m.dtype.kind == "f" and np.isfinite(depth_m).any():
            parts.append(f"{np.nanmin(depth_m):.4g} .. {np.nanmax(depth_m):.4g} m")
        return f"<Scene {shape}: {', '.join([*parts, *self._planes()])}>"

    def _repr_html_(self) -> str:
        return depth_picture(self, np.asarray(self.depth_m))


def built_in_scene_names() -> list[str]:
    """Returns the names of the built-in scenes."""
    return _tofsmith.built_in_scene_names()


def built_in_scene(
    name: str,
    width: Optional[int] = None,
    height: Optional[int] = None,
    *,
    lens: Optional[Lens] = None,
    time_s: Optional[float] = None,
) -> Scene:
    """Loads a built-in scene as seen through a lens, such as `camera.lens`; see load_scene()."""
    return load_scene(_check.text(name, "name"), lens, width=width, height=height, time_s=time_s)


@takes(SceneSource)
def load_scene(
    scene: Path,
    lens: Optional[Lens] = None,
    **options: Unpack[SceneSource],
) -> Scene:
    """Loads a scene by name or file and casts its rays, as `tofsmith simulate`.

    Parameters
    ----------
    scene : str or path
        A built-in scene, a file of shapes and a pinhole (.toml), a mesh (.obj .ply .stl), or a
        depth image (.npy .npz .exr .pfm, .png in mm).
    lens : Lens, optional
        View of a built-in scene, a mesh or a depth image, such as `camera.lens`. Default: the view
        of the scene, or a centred pinhole with a horizontal view of 60 degrees.
    **options
        As in SceneSource.

    Raises
    ------
    ValueError
        Naming the option that does not apply to the scene.
    OSError
        For an unknown scene, with the most similar name, or a file that cannot be read.
    """
    given: dict[str, Any] = dict(options)
    for file in {"image", "ambient_image"} & given.keys():
        given[file] = None if given[file] is None else _check.path(given[file], file)
    name = _check.path(scene, "scene")
    seen = _tofsmith.load_scene(name, None if lens is None else lens_dict(lens), given)
    view = lens_from(seen.pop("lens"))
    return Scene(**seen, lens=view)


def lens_dict(lens: Lens) -> dict[str, Any]:
    """Returns a lens with the keys of a camera file."""
    _check.instance(lens, Lens, "lens")
    if lens.rays:  # replaces all other keys
        return {"rays": lens.rays}
    keys = {key: getattr(lens, key) for key in lens.__dataclass_fields__}
    return {key: value for key, value in keys.items() if value is not None}


def lens_from(keys: dict[str, Any]) -> Lens:
    """Inverse of lens_dict()."""
    fields: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in keys.items()}
    return Lens(**fields)


def centred_lens(width: int, height: int, horizontal_angle_rad: float = pi / 3) -> Lens:
    """Returns a lens with square pixels, a centred axis and a given angle between the outer edges
    of the image."""
    size = _check.whole(width, "width", 1), _check.whole(height, "height", 1)
    angle = _check.number(horizontal_angle_rad, "horizontal_angle_rad")
    return lens_from(_tofsmith.centred_lens(*size, angle))


def radial_from_z(z_m: npt.ArrayLike, lens: Lens) -> FloatImage:
    """Returns radial distance [m] for depth along the axis [m], both (H, W); NaN is kept."""
    return _tofsmith.radial_from_z(_check.real_array(z_m, "z_m", "(H, W)"), lens_dict(lens))


def z_from_radial(radial_m: npt.ArrayLike, lens: Lens) -> FloatImage:
    """Returns depth along the axis [m] for radial distance [m], both (H, W); NaN is kept."""
    return _tofsmith.z_from_radial(_check.real_array(radial_m, "radial_m", "(H, W)"), lens_dict(lens))


def points_m(radial_m: npt.ArrayLike, lens: Lens) -> FloatImage:
    """Returns points in the camera's frame (x right, y down, z forward) [m] for radial distance.

    Parameters
    ----------
    radial_m : array_like, shape (H, W)
    lens : Lens

    Returns
    -------
    ndarray of float32, shape (H, W, 3)
        NaN without depth.
    """
    return _tofsmith.points_m(_check.real_array(radial_m, "radial_m", "(H, W)"), lens_dict(lens))


@takes(CaptureOptions)
def capture(
    scene: Union[Scene, str, npt.NDArray[Any]],
    code: CodeLike,
    camera: CameraLike,
    *,
    signal_e_per_s: Optional[float] = None,
    ambient_e_per_s: Optional[float] = None,
    stray_light: Optional[npt.ArrayLike] = None,
    returns: Union[MultipathReturns, Sequence[tuple[float, float]], None] = None,
    tail: Optional[ExponentialTail] = None,
    transients: Optional[Transients] = None,
    bounces: int = 0,
    bounce_rays: int = 256,
    progress: Progress = None,
    **options: Unpack[CaptureOptions],
) -> npt.NDArray[np.float32]:
    """Simulates raw measurements of a scene.

    Parameters
    ----------
    scene : Scene, name of a built-in scene, .toml file, or radial distance [m] (H, W)
        Depth beyond the unambiguous range wraps. capture_staged() captures scenes given by name or
        file, through the camera's lens; these may move. Scene objects and arrays have one ray per
        pixel and are static.
    code : CodeSet, name of a family or file
    camera : Camera or its name
    signal_e_per_s : float, optional
        S [e/s] of a white surface that faces the camera at the reference distance. Default: the
        middle operating point.
    ambient_e_per_s : float, optional
        A [e/s], with the same default.
    stray_light : array_like, shape (2 R + 1, 2 Q + 1), optional
        Kernel of stray light: the share of a pixel's light that the lens scatters to each pixel
        around it. The pixel itself is at the centre. remove_stray_light() corrects stray light.
    returns : MultipathReturns or sequence of (delay_m, ratio), optional
        Multipath returns: individual for each pixel, or the same for all pixels.
    tail : ExponentialTail, optional
        Tail of every direct return.
    transients : Transients, optional
        Distributes the signal of each pixel over a histogram, instead of the direct return; cannot
        be combined with `returns` or `tail`.
    bounces, bounce_rays : int, optional
        If `bounces` is 1 (default 0), adds indirect light over one other surface, sampled by
        `bounce_rays` rays per pixel; see bounced_light(). Only for scenes given by name or file.
    progress : callable, optional
    **options
        As in CaptureOptions.

    Returns
    -------
    ndarray of float32, shape (H, W, K), or (F, H, W, K) if `frames` is given
        Electrons, or counts if the sensor has an ADC.

    Raises
    ------
    ValueError
        Naming the invalid argument.
    OSError
        For an unknown scene.
    """
    given: dict[str, Any] = {
        **options,
        "signal_e_per_s": signal_e_per_s,
        "ambient_e_per_s": ambient_e_per_s,
        "stray_light": stray_light,
    }
    raw: npt.NDArray[np.float32]
    if isinstance(scene, (str, os.PathLike)):
        raw = capture_staged(
            scene, code, camera, returns=returns, tail=tail, transients=transients,
            bounces=bounces, bounce_rays=bounce_rays, progress=progress, **given
        ).raw
    else:
        if _bounce_rays(bounces, bounce_rays, returns, transients):
            raise ValueError("bounces: got 1 together with planes; needs the name or file of a "
                             "scene, which has surfaces outside the view")
        camera = camera_of(camera)
        seen = scene_named(scene, camera.lens)
        raw = _tofsmith.capture(
            scene_planes(seen),
            light_dict(returns, tail, transients, seen.depth_m),
            code_of(code, camera)._handle,
            camera._handle,
            given,
            _check.progress(progress),
        )
    return raw[0] if options.get("frames") is None else raw


@dataclass(frozen=True)
class StagedCapture:
    """Raw measurements of a scene of shapes, with the ground truth.

    Attributes
    ----------
    raw : ndarray of float32, shape (F, H, W, K)
        Electrons, or counts if the sensor has an ADC.
    depth_m : ndarray of float32, shape (F, H, W), or (1, H, W) for a static scene
        Radial distance along the ray through a pixel's centre, in the middle of each frame [m];
        NaN without return.
    near_m, far_m : ndarray of float32, as depth_m
        Range of the distances that a pixel sees through the lens in all exposures; a large range
        means mixed light.
    """

    raw: npt.NDArray[np.float32]
    depth_m: npt.NDArray[np.float32]
    near_m: npt.NDArray[np.float32]
    far_m: npt.NDArray[np.float32]


def capture_staged(
    scene: Path,
    code: CodeLike,
    camera: CameraLike,
    *,
    width: Optional[int] = None,
    height: Optional[int] = None,
    returns: Union[MultipathReturns, Sequence[tuple[float, float]], None] = None,
    tail: Optional[ExponentialTail] = None,
    transients: Optional[Transients] = None,
    bounces: int = 0,
    bounce_rays: int = 256,
    progress: Progress = None,
    **options: Any,
) -> StagedCapture:
    """Simulates raw measurements of shapes through the camera's lens, including motion.

    The scene is evaluated in the middle of each exposure. Exposures are separated by
    `sensor.readout_gap_s`, frames start every `sensor.frame_period_s`.

    Parameters
    ----------
    scene : name of a built-in scene, .toml file, mesh, or depth image
        A depth image has one ray per pixel and is static.
    code : CodeSet, name of a family or file
    camera : Camera or its name
    width, height : int, optional
        For a built-in scene or a mesh [px] (320 x 240).
    returns, tail, transients, bounces, bounce_rays, progress
        As in capture(). Lists have one entry per ray; each pixel has `lens.pixel_samples` squared
        rays.
    **options
        signal_e_per_s, ambient_e_per_s, reference_distance_m, falloff, seed, frames, stray_light
        as in capture().

    Examples
    --------
    >>> from tofsmith import Camera
    >>> lens = {"blur": "gaussian", "blur_sigma_px": 0.5, "pixel_samples": 3}
    >>> made = capture_staged("ball", "sinusoid-k4", Camera("paper-10f0", lens=lens), width=32,
    ...                       height=24)
    >>> made.raw.shape, made.depth_m.shape
    ((1, 24, 32, 4), (1, 24, 32))
    """
    camera = camera_of(camera)
    source = _check.path(scene, "scene")
    rays = _bounce_rays(bounces, bounce_rays, returns, transients)
    light: dict[str, Any] = {}
    if returns is not None or tail is not None or transients is not None:
        light = light_dict(returns, tail, transients, scene_named(source, camera.lens).depth_m)
    made = _tofsmith.capture_staged(
        source,
        {"width": width, "height": height},
        light,
        rays,
        code_of(code, camera)._handle,
        camera._handle,
        options,
        _check.progress(progress),
    )
    return StagedCapture(**made)


def _bounce_rays(bounces: int, rays: int, returns: Any, transients: Any) -> int:
    """Returns the rays per pixel for bounced light; 0: none."""
    if bounces not in (0, 1):
        raise ValueError(f"bounces: got {bounces}; needs 0 or 1")
    if bounces and (returns is not None or transients is not None):
        raise ValueError("bounces: got 1 together with returns or transients; needs one of them")
    return _check.whole(rays, "bounce_rays", 1) if bounces else 0


def bounced_light(
    scene: Path,
    camera: CameraLike,
    *,
    width: Optional[int] = None,
    height: Optional[int] = None,
    rays: int = 256,
    progress: Progress = None,
) -> MultipathReturns:
    """Computes the light that reaches each pixel over one other surface, as `simulate --bounces 1`:
    surfaces are Lambertian, the source is at the camera's centre.

    Parameters
    ----------
    scene : name of a built-in scene, .toml file, or mesh
    camera : Camera or its name
        Its lens and unambiguous range are used; longer paths wrap.
    width, height : int, optional
        For a built-in scene or a mesh [px] (320 x 240).
    rays : int, optional
        Rays per pixel, in [16, 65536].
    progress : callable, optional

    Examples
    --------
    >>> found = bounced_light("corner", "paper-10f0", width=8, height=6, rays=32)
    >>> raw = capture(load_scene("corner", width=8, height=6), "hamiltonian-k5", "paper-10f0",
    ...               returns=found)
    >>> len(found.first), bool((found.ratio > 0).all())
    (49, True)
    """
    camera = camera_of(camera)
    return MultipathReturns(
        *_tofsmith.bounced_light(
            _check.path(scene, "scene"),
            {"width": width, "height": height},
            camera._handle,
            _check.whole(rays, "rays", 1),
            _check.progress(progress),
        )
    )


def scene_planes(scene: Scene) -> dict[str, Optional[npt.NDArray[Any]]]:
    """Returns the planes of a scene by name, each (H, W)."""
    names = ("depth_m", "albedo", "cosine", "ambient_scale")
    planes = {name: getattr(scene, name) for name in names}
    for name in names[1:]:
        if planes[name] is not None and np.ndim(planes[name]) == 0:
            number = _check.number(planes[name], name)
            planes[name] = np.full(np.shape(scene.depth_m), number, np.float32)
    return {
        name: None if plane is None else _check.real_array(plane, name, "(H, W)")
        for name, plane in planes.items()
    }


def scene_named(scene: Any, lens: Optional[Lens]) -> Scene:
    """Returns a Scene from a Scene, depths, or a name or file viewed through a lens."""
    if isinstance(scene, np.ndarray):
        return Scene(scene)
    if isinstance(scene, (str, os.PathLike)):
        return load_scene(scene, lens)
    return _check.instance(scene, Scene, "scene")
