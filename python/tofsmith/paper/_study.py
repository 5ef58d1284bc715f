# SPDX-FileCopyrightText: 2026 The tofsmith authors
# SPDX-License-Identifier: Apache-2.0
"""Shared by all figures: options, redesigned codes, findings and output files."""

import csv
import hashlib
import html
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

import tofsmith
from tofsmith import Camera, CodeSet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HOLDS, IN_PART, FAILS = "holds", "holds in part", "does not hold"
Value = TypeVar("Value")


def digest_of(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:12]


@dataclass(frozen=True)
class Finding:
    """A statement of the paper, its verdict (holds, holds in part, does not hold), the measured
    numbers and the reason for a difference."""

    verdict: str
    statement: str
    measured: str
    why: str = ""


@dataclass
class Study:
    """One figure in the making: collects findings and writes pictures and tables. Figures
    take `seed` for all random numbers and `pick()` their effort."""

    name: str
    output: Path
    fast: bool = False
    seed: int = 1
    mesh: str | None = None
    findings: list[Finding] = field(default_factory=list)
    pictures: list[tuple[str, str]] = field(default_factory=list)

    @property
    def directory(self) -> Path:
        return self.output / self.name

    def options(self) -> str:
        """Returns the options that determine this figure."""
        text = f"{'coarse (--fast)' if self.fast else 'full'}, seed {self.seed}"
        if self.name == "fig7" and self.mesh is not None:
            text += f", mesh {Path(self.mesh).name} {digest_of(Path(self.mesh).read_bytes())}"
        return text

    def pick(self, full: Value, coarse: Value) -> Value:
        """Returns `full`, or `coarse` with --fast."""
        return coarse if self.fast else full

    def state(
        self, holds: str | bool | Sequence[bool], statement: str, measured: str, why: str = ""
    ) -> None:
        """Adds a finding. A list of conditions holds in part if some of them are true. `why` is
        omitted if the statement holds."""
        if not isinstance(holds, str):
            each = np.atleast_1d(holds)
            holds = HOLDS if each.all() else IN_PART if each.any() else FAILS
        self.findings.append(Finding(holds, statement, measured, "" if holds == HOLDS else why))

    def picture(self, name: str, figure: "Figure", caption: str) -> None:
        """Writes NAME.png and NAME.pdf with the same layout."""
        figure.savefig(self.directory / f"{name}.png", dpi=200)
        figure.set_layout_engine("none")  # computing the layout again takes longer than drawing
        figure.savefig(self.directory / f"{name}.pdf", dpi=200, metadata={"CreationDate": None})
        self.pictures.append((name, caption))

    def table(self, name: str, rows: Sequence[dict[str, Any]]) -> None:
        """Writes NAME.csv."""
        with open(self.directory / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def redesigned(self, exposures: int, camera: Camera) -> CodeSet:
        """Returns the Hamiltonian code with `exposures` exposures, redesigned for the camera as in
        the paper: its correlation functions are factorized within the camera's limits, and the
        resulting code with the smallest depth error is selected. Stored in `codes` for other
        figures."""
        inputs = f"{tofsmith.__version__} {exposures} {self.fast} {self.seed}\n{camera.to_toml()}"
        name = f"hamiltonian-k{exposures}-{camera.name}-{digest_of(inputs.encode())}.code.json"
        file = self.output / "codes" / name
        if file.exists():
            return tofsmith.read_code(file)
        result = tofsmith.design(
            camera, method="factorize", exposures=exposures, baselines=[], seed=self.seed,
            search_trials=self.pick(4000, 100), trials=self.pick(20000, 1000),
            factorize=self.pick(None, {"random_starts": 4, "refined": 4, "kept": 2}))
        code = result.winner.code.renamed(f"hamiltonian-k{exposures}-redesigned")
        file.parent.mkdir(parents=True, exist_ok=True)
        tofsmith.write_code(file, code, overwrite=True)
        return code

    def codes(self, camera: Camera, exposures: Sequence[int], families: Iterable[str]) -> list[CodeSet]:
        """Returns codes for a camera: redesigned ones, then families."""
        return [self.redesigned(count, camera) for count in exposures] + [
            tofsmith.build_family(name, camera) for name in families]

    def finish(self, title: str) -> None:
        """Writes findings.json, which exists only if all other files are complete."""
        document = {"tofsmith": tofsmith.__version__, "options": self.options(), "title": title,
                    "findings": [asdict(finding) for finding in self.findings],
                    "pictures": self.pictures}
        write_text(self.directory / "findings.json", json.dumps(document, indent=1) + "\n")

    def finished(self) -> dict[str, Any] | None:
        """Returns findings.json if this version has finished the figure."""
        try:
            document = json.loads((self.directory / "findings.json").read_text(encoding="utf-8"))
            [Finding(**finding) for finding in document["findings"]]
            return document if document["tofsmith"] == tofsmith.__version__ else None
        except (OSError, ValueError, KeyError, TypeError):
            return None  # missing or damaged: made again


def write_text(path: Path, text: str) -> None:
    """Writes a temporary file and renames it."""
    partial = path.with_name(path.name + ".part")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


PAGE_MARK = '<meta name="generator" content="tofsmith.paper">'
PAGE_HEAD = f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">{PAGE_MARK}
<meta name="viewport" content="width=device-width"><title>The paper, reproduced</title>
<style>body {{ font: 16px/1.5 sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem }}
img {{ max-width: 100% }}</style></head><body><h1>The paper, reproduced</h1>
<p>Gutierrez-Barragan et al., <i>Practical Coding Function Design for Time-of-Flight Imaging</i>,
CVPR 2019: its figures and statements next to our numbers.</p>
"""


def write_index(output: Path, names: Sequence[str]) -> None:
    """Writes index.html with all finished figures."""
    parts = [PAGE_HEAD]
    for name in names:
        document = Study(name, output).finished()
        if document is None:
            continue
        parts.append(f"<h2>{name}: {html.escape(document['title'])}</h2>\n<ul>\n")
        for finding in document["findings"]:
            verdict, *texts = (html.escape(text) for text in finding.values() if text)
            parts.append(f"<li><b>{verdict}</b>: {'<br>'.join(texts)}</li>\n")
        parts.append("</ul>\n")
        for picture, caption in document["pictures"]:
            parts.append(f'<p><a href="{name}/{picture}.pdf"><img src="{name}/{picture}.png" '
                         f'alt="{picture}"></a><br>{html.escape(caption)}</p>\n')
        parts.append(f"<p>Data: <a href=\"{name}/\">{name}/</a> ({document['options']})</p>\n")
    write_text(output / "index.html", "".join(parts) + "</body></html>\n")
