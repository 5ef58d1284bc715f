# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Raw frames, decoded and true depth of many scenes; see docs/datasets.md."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import Any, Optional, Union

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._scene import Scene, centred_lens, lens_dict, scene_named, scene_planes

#: As of capture(), or a function that returns one when its turn comes.
SceneLike = Union[Scene, str, npt.NDArray[Any], Callable[[], Any]]


@dataclass(frozen=True)
class TrainingSetRun:
    """What became of a training set.

    Attributes
    ----------
    scenes, written, kept : int
        Of this shard, written now, and found finished.
    failures : list of str
        "name: problem" of scenes that could not be simulated.
    index : pathlib.Path
        The list of all that is finished.
    """

    scenes: int
    written: int
    kept: int
    failures: list[str]
    index: FilePath


def write_training_set(
    directory: Path,
    scenes: Mapping[str, SceneLike],
    code: CodeLike,
    camera: CameraLike,
    *,
    signal_range: Optional[tuple[float, float]] = None,
    ambient_range: Optional[tuple[float, float]] = None,
    reference_distance_m: Optional[float] = None,
    falloff: Optional[bool] = None,
    seed: Optional[int] = None,
    frames: Optional[int] = None,
    shard: Optional[tuple[int, int]] = None,
    progress: Progress = None,
) -> TrainingSetRun:
    """Captures and decodes every scene; writes KEY.npz (raw, depth_m, true_depth_m, albedo) and
    KEY.json (parameters) of each, and an index, as `tofsmith simulate` of many scenes does.

    Parameters
    ----------
    directory : str or path
        Made if it is missing; what is finished there stays.
    scenes : mapping of names to scenes
        Each as capture() takes it, or a function that returns such a scene when its turn comes, in
        any thread. Without a lens it is seen through the camera's, or 60 degrees wide.
    code : CodeSet, name of a family or file
    camera : Camera or its name
    signal_range, ambient_range : (float, float), optional
        [e/s], drawn log-uniformly for every scene; None: the middle operating point's.
    reference_distance_m, falloff, frames : optional
        As of capture().
    seed : int, optional
        Of the whole set (1): noise and light depend on it and the scene's name and content alone.
    shard : (index, count), optional
        One part of the work, from 1, by the scenes' names.
    progress : callable, optional
        What is finished when it stops the work is kept.

    Raises
    ------
    ValueError
        For options that break a rule. A scene that fails is listed in `failures`.
    OSError
        If a file cannot be written.

    Examples
    --------
    >>> scenes = {name: name for name in built_in_scene_names()}  # doctest: +SKIP
    >>> run = write_training_set("set", scenes, "hamiltonian-k4", "paper-10f0")  # doctest: +SKIP
    """
    known = camera_of(camera)
    options = {
        "signal_range": None if signal_range is None else list(signal_range),
        "ambient_range": None if ambient_range is None else list(ambient_range),
        "reference_distance_m": reference_distance_m,
        "falloff": falloff,
        "seed": seed,
        "frames": frames,
        "shard": None if shard is None else list(shard),
    }
    if not isinstance(scenes, Mapping) or not scenes:
        raise TypeError(f"scenes: got {_check.shown(scenes)}; needs a dict of names and scenes")
    names = sorted(_check.text(name, "scenes") for name in scenes)

    def load(name: str) -> dict[str, Any]:
        given = scenes[name]
        scene = scene_named(given() if callable(given) else given, known.lens)
        planes: dict[str, Any] = dict(scene_planes(scene))
        height, width = planes["depth_m"].shape
        lens = scene.lens or known.lens or centred_lens(width, height)
        return planes | {"lens": lens_dict(lens)}

    folder = _check.path(directory, "directory")
    handle = code_of(code, known)._handle
    callback = _check.progress(progress)
    values = _tofsmith.write_training_set(
        folder, names, load, handle, known._handle, options, callback
    )
    values["index"] = FilePath(values["index"])
    return TrainingSetRun(**values)
