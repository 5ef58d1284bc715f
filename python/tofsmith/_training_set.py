# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Datasets of raw frames, decoded and true depth of many scenes; see docs/datasets.md."""

from __future__ import annotations

import functools
import os
import pickle
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, Union, Unpack

import numpy.typing as npt

from . import _check, _tofsmith
from ._camera import CameraLike, camera_of
from ._camera_fields import Lens
from ._check import Path, Progress
from ._code import CodeLike, code_of
from ._executor import Dispatcher, ExecutorLike, require_build
from ._option_fields import TrainingSetOptions
from ._options import takes
from ._result_fields import TrainingSetRun
from ._scene import Scene, centred_lens, lens_dict, scene_named, scene_planes

#: As in capture(), or a function that returns a scene when called.
SceneLike = Union[Scene, str, npt.NDArray[Any], Callable[[], Any]]


#: Name, entry of the index, problem, and whether it was written in this run.
_Outcome = tuple[str, str, str, bool]


def _planes(scenes: Mapping[str, SceneLike], lens: Optional[Lens], name: str) -> dict[str, Any]:
    """Returns the planes and the lens of a scene."""
    given = scenes[name]
    scene = scene_named(given() if callable(given) else given, lens)
    planes: dict[str, Any] = dict(scene_planes(scene))
    height, width = planes["depth_m"].shape
    return planes | {"lens": lens_dict(scene.lens or lens or centred_lens(width, height))}


@functools.lru_cache(maxsize=1)
def _set_in_worker(plan: bytes) -> tuple[_tofsmith.TrainingSet, Optional[Lens]]:
    folder, code, camera, options = pickle.loads(plan)
    return _tofsmith.TrainingSet(folder, code._handle, camera._handle, options), camera.lens


def _write_scenes(
    plan: bytes, build: tuple[str, str], threads: int, items: Sequence[tuple[str, SceneLike]]
) -> Sequence[_Outcome]:
    """Runs in a worker of an executor."""
    require_build(build)
    training_set, lens = _set_in_worker(plan)
    load = functools.partial(_planes, dict(items), lens)
    return training_set.write([name for name, _ in items], load, threads)


def _write_on_executor(
    plan: tuple[Any, ...], scenes: Mapping[str, SceneLike], names: Sequence[str],
    executor: ExecutorLike, threads: int, progress: Progress
) -> dict[str, Any]:
    """Returns the fields of TrainingSetRun."""
    folder, code, camera, options = plan
    training_set = _tofsmith.TrainingSet(folder, code._handle, camera._handle, options)
    names = training_set.names_of_shard(names)
    waiting = list(reversed(names))
    outcomes: dict[str, _Outcome] = {}

    def claim(max_items: int) -> Sequence[tuple[str, SceneLike]]:
        claimed = [waiting.pop() for _ in range(min(max_items, len(waiting)))]
        return [(name, scenes[name]) for name in claimed]

    def report() -> None:
        step = f"{len(outcomes)} of {len(names)} scenes"
        if progress and progress(len(outcomes) / max(1, len(names)), step) is False:
            raise _tofsmith.Interrupted("interrupted")

    def keep(written: Sequence[_Outcome]) -> None:
        outcomes.update((outcome[0], outcome) for outcome in written)

    compute = functools.partial(
        _write_scenes, pickle.dumps(plan), _tofsmith.worker_build(), threads)
    Dispatcher(executor, compute, claim, lambda: len(waiting), keep).run(report)
    return training_set.write_index([outcomes[name] for name in names])


@takes(TrainingSetOptions)
def write_training_set(
    directory: Path,
    scenes: Mapping[str, SceneLike],
    code: CodeLike,
    camera: CameraLike,
    *,
    executor: Optional[ExecutorLike] = None,
    threads: int = 1,
    progress: Progress = None,
    **options: Unpack[TrainingSetOptions],
) -> TrainingSetRun:
    """Captures and decodes every scene. Writes KEY.npz (raw, depth_m, true_depth_m, albedo) and
    KEY.json (parameters) for each, and an index, as `tofsmith simulate` for many scenes.

    Parameters
    ----------
    directory : str or path
        Created if missing; finished scenes are kept.
    scenes : mapping of names to scenes
        Each as in capture(), or a function that returns a scene, which is called in any thread.
        Scenes without a lens use the camera's, or a view 60 degrees wide.
    code : CodeSet, name of a family or file
    camera : Camera or its name
        Its [optics], or its middle operating point, gives the light if there is no range.
    executor : concurrent.futures.Executor or a function that starts one, optional
        Writes the scenes, as in run_sweep(). Its workers must see the directory under the same
        path, and functions among the scenes must be picklable.
    threads : int, optional
        Threads of each worker of the executor; 0: one per core.
    progress : callable, optional
        Finished scenes are kept if it cancels.
    **options
        As in TrainingSetOptions. Noise and light depend only on `seed` and the scene's name and
        content.

    Raises
    ------
    ValueError
        For invalid options. Scenes that fail are listed in `failures`.
    OSError
        If a file cannot be written.
    RuntimeError
        If the executor breaks or a piece of the work fails four times. Finished scenes are kept.

    Examples
    --------
    >>> scenes = {name: name for name in built_in_scene_names()}  # doctest: +SKIP
    >>> run = write_training_set("set", scenes, "hamiltonian-k4", "paper-10f0")  # doctest: +SKIP
    """
    known = camera_of(camera)
    given = dict(options)
    if not isinstance(scenes, Mapping) or not scenes:
        raise TypeError(f"scenes: got {_check.shown(scenes)}; needs a dict of names and scenes")
    names = sorted(_check.text(name, "scenes") for name in scenes)
    folder = _check.path(directory, "directory")
    known_code = code_of(code, known)
    callback = _check.progress(progress)
    if executor is None:
        load = functools.partial(_planes, scenes, known.lens)
        values = _tofsmith.write_training_set(
            folder, names, load, known_code._handle, known._handle, given, callback
        )
    else:
        _check.whole(threads, "threads", 0, 65536)
        plan = (os.path.abspath(folder), known_code, known, given)
        values = _write_on_executor(plan, scenes, names, executor, threads, callback)
    return TrainingSetRun(**values)
