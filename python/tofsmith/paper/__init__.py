# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of Gutierrez-Barragan, Reza, Velten and Gupta, *Practical Coding Function Design for
Time-of-Flight Imaging*, CVPR 2019, reproduced with the public interface of tofsmith and matplotlib.

    python3 -m tofsmith.paper fig4 -o out

Each figure has a module, which is a sequence of commented steps to copy from. `cameras`, `pairs`
(waveforms), `surfaces` (error over light levels) and `bench` (scans) are shared by several figures.
"""

import difflib
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

from ._study import PAGE_MARK, Finding, Study, write_index

__all__ = ["Finding", "UsageError", "items", "reproduce"]

#: Names and titles of everything that can be reproduced, in the paper's order.
items = {
    "fig2": "From a target to functions that hardware can generate",
    "fig3": "Hamiltonian codes at falling peak power",
    "fig4": "Mean depth error over signal and ambient light",
    "fig5": "Impulse responses and their band limits",
    "fig6": "Two K = 5 codes at 10 f0",
    "fig7": "A hand under loose and tight limits",
    "fig8": "Two-bucket cameras",
    "fig9": "A single pixel on the bench",
    "fig10": "Scenes scanned by the prototype",
    "fig11": "A wall scanned by the prototype",
    "table1": "The bench's parameters",
    "text": "Statements in the text",
}


class UsageError(ValueError):
    """An argument of reproduce() that is not valid."""


def reproduce(
    names: str | Sequence[str], directory: str | Path, *, fast: bool = False, seed: int = 1,
    mesh: str | None = None, overwrite: bool = False,
    on_item: Callable[[str, list[Finding], bool], None] | None = None,
) -> dict[str, list[Finding]]:
    """Makes figures of the paper in a directory: pictures, data and an index page.

    Parameters
    ----------
    names : str or sequence of str
        Keys of `items`, or "all".
    directory : str or path
        Created if missing; finished figures are not made again.
    fast, seed, mesh, overwrite
        As the options --fast, --seed, --mesh and --force of the command.
    on_item : callable, optional
        Called for each figure with name, findings, and whether it was already finished.

    Raises UsageError for an unknown name, and OSError if the directory contains pages of another
    program or figures made with other options.
    """
    import matplotlib

    from ._style import style

    chosen = _names_of([names] if isinstance(names, str) else names)
    if mesh is not None and "fig7" not in chosen:
        raise UsageError("--mesh: only fig7 shows a mesh")
    output = Path(directory)
    studies = {name: Study(name, output, fast, seed, mesh) for name in items}
    if not overwrite:
        _require_ours(studies)
    results = {}
    for name in chosen:
        study = studies[name]
        done = None if overwrite else study.finished()
        if done is None:
            study.directory.mkdir(parents=True, exist_ok=True)
            (study.directory / "findings.json").unlink(missing_ok=True)
            with matplotlib.rc_context(style):
                import_module(f"{__name__}.{name}").reproduce(study)
            study.finish(items[name])
        else:
            study.findings = [Finding(**finding) for finding in done["findings"]]
        results[name] = study.findings
        write_index(output, list(items))
        if on_item is not None:
            on_item(name, study.findings, done is not None)
    return results


def _names_of(names: Sequence[str]) -> list[str]:
    if not names:
        raise UsageError('names: got none; needs "all" or some of ' + ", ".join(items))
    for name in names:
        if name != "all" and name not in items:
            near = difflib.get_close_matches(name, items, 1)
            raise UsageError(f"figure: got {name!r}; must be all or one of {', '.join(items)}"
                             + (f"; did you mean {near[0]}?" if near else ""))
    return list(items) if "all" in names else list(names)


def _require_ours(studies: dict[str, Study]) -> None:
    """Raises OSError if files of other options or another program would be replaced."""
    for study in studies.values():
        document = study.finished()
        if document is not None and document["options"] != study.options():
            raise OSError(f"{study.directory / 'findings.json'}: was made with other options "
                          f"({document['options']}; now {study.options()}); use --force to replace "
                          "it, or another -o")
    page = studies["fig2"].output / "index.html"
    if page.exists() and PAGE_MARK not in page.read_text(encoding="utf-8", errors="replace"):
        raise OSError(f"{page}: was not written by tofsmith.paper and would be replaced; use "
                      "--force, or another -o")
