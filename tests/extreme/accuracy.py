"""Rows of docs/accuracy.md: what was asked, what was reached, why it holds or where it ends.

`python tests/extreme/accuracy.py` measures all of it and writes the page's tables; `test_accuracy_page.py` holds the
page against them.
"""

from __future__ import annotations

import re
import signal
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from extreme_oracle import worst

from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.read.files import read_drawing, read_solid

PAGE = Path(__file__).parents[2] / "docs" / "accuracy.md"
TOPICS = (
    "test_curvature_to_nothing",
    "test_harmonics_and_sizes",
    "test_strokes_and_jumps",
    "test_cancelling_formulas",
    "test_folded_and_many_lobed",
)
HEAD = "| case | asked | reached | at most | why |\n| --- | --- | --- | --- | --- |"
SECONDS = 60  # a case that takes longer hangs
ANGLES = 2.0 * np.pi * np.mod(0.1234 + 0.6180339887498949 * np.arange(24), 1.0)


@dataclass(frozen=True)
class Row:
    """One line: `reached` is a number with its bound `most`, or a refusal's words, with `most` what they must hold.

    Numbers at the level of rounding differ between machines; what is promised is the bound.
    """

    case: str
    asked: str
    reached: float | str
    most: float | str
    why: str

    @property
    def holds(self):
        if isinstance(self.reached, str):
            return str(self.most) in self.reached
        return 0.0 <= self.reached <= self.most

    @property
    def key(self):
        return self.case, self.asked

    def line(self):
        if isinstance(self.reached, str):
            figures = (f"refused: {self.reached}", "-")
        else:
            figures = (f"{self.reached:.1e}", f"{self.most:.0e}")
        told = [cell.replace("|", "\\|") for cell in (self.case, self.asked, *figures, self.why)]
        return f"| {' | '.join(told)} |"


class TookTooLongError(Exception):
    """Not an OSError, as TimeoutError is: nothing may take it for trouble with the disk."""


@contextmanager
def in_time(seconds=SECONDS):
    """Raise TookTooLong where the body takes more processor time: a hang fails its case, not the run.

    What a busy machine makes a sound case wait does not count.
    """

    def late(*_):
        raise TookTooLongError(f"more than {seconds} s of processor time")

    before = signal.signal(signal.SIGPROF, late)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def recipe(cam, *, tolerance=1e-3, files="dxf", units="mm", thickness=None, motion_error=None, name="case"):
    """A recipe of one cam; `cam` as lines of YAML or of flow mappings."""
    part = "" if thickness is None else f"part: {{thickness: {thickness!r}}}\n"
    lines = "".join(f"  {line}\n" for line in cam.strip().splitlines())
    part += "" if motion_error is None else f"verify: {{motion_error: {motion_error!r}}}\n"
    text = f"units: {units}\ncam:\n{lines}{part}export:\n  tolerance: {tolerance:.25f}\n  files: [{files}]\n"
    return read(text.encode(), f"{name}.yaml")


@dataclass(frozen=True)
class Made:
    """What came of a recipe: its report, or the words of its refusal; contours as read back, by file name."""

    report: dict | None
    refusal: str
    contours: dict

    @property
    def failed(self):
        return [] if self.report is None else [check for check in self.report["checks"] if not check["ok"]]

    def check(self, name):
        return next(check for check in self.report["checks"] if check["name"] == name)

    def used(self):
        """Greatest share of its tolerance that a file uses, as proved and as judged; inf where any check fails."""
        if self.report is None or self.failed:
            return float("inf")
        files = [f for f in self.report["files"] if f["geometry_error"] is not None]
        return max(max(f["geometry_error"], f["measured_error"]) / f["tolerance"] for f in files)


def made(asked):
    """Export a recipe and read its files back, in bounded time; a refusal is kept without place and path."""
    with TemporaryDirectory() as folder, in_time():
        try:
            outcome = pipeline.export(asked, Path(folder))
        except RecipeErrors as errors:
            return Made(None, re.sub(r"^[^ ]*: ", "", str(errors)), {})
        found = {}
        for file in sorted(Path(outcome.folder).iterdir()):
            if file.suffix == ".dxf":
                found[file.name] = read_drawing(file).contour
            if file.suffix == ".stl":
                found[file.name] = read_solid(file).contour
        return Made(outcome.report, "", found)


def refused(cam, **kw):
    """The words that refuse a recipe; 'nothing was said' where it was made."""
    with in_time():
        try:
            asked = recipe(cam, **kw)
        except RecipeErrors as errors:
            return re.sub(r"^[^ ]*: ", "", str(errors))
    return made(asked).refusal or "nothing was said"


def off_profile(asked, oracle, angles=ANGLES):
    """Greatest error of points and radii of curvature as a share of the size, and of normals: against 50 digits."""
    with in_time():
        curve = designed(asked).only_surface.surface.curve
        at = curve.sample(angles)
    frames = [oracle.frame(t) for t in angles]
    size = curve.size
    points = worst(at.point, [f[0] for f in frames]) / size
    normals = worst(at.normal, [f[1] for f in frames])
    radii = worst(at.speed / at.turn, [[f[2]] for f in frames]) / max(size, float(np.abs(at.speed).max()))
    return max(points, normals, radii)


def off_motion(lift, oracle, angles=ANGLES):
    """Greatest error of p, p', p'', p''', each as a share of its own greatest value, against 50 digits."""
    found = lift.derivatives(angles, 3)
    exact = [oracle.derivatives(t) for t in map(_exact, angles)]
    shares = []
    for k in range(4):
        most = max(float(np.abs(found[k]).max()), 1e-300)
        shares.append(worst(found[k], [[row[k]] for row in exact]) / most)
    return max(shares)


def _exact(t):
    import mpmath as mp

    return mp.mpf(float(t))


def off_file(contour, oracle, tolerance, angles=ANGLES):
    """Greatest distance of a convex contour's support function from p in 50 digits, as a share of the tolerance."""
    found = contour.support(angles).q
    return worst(found, [[oracle.derivatives(t)[0]] for t in map(_exact, angles)]) / tolerance


@cache
def measured(topic, name):
    """Rows of one case of a topic, measured once."""
    return tuple(import_module(topic).cases()[name]())


def rows_of(topic):
    """Rows of one topic, in the order of the page."""
    return [row for name in import_module(topic).cases() for row in measured(topic, name)]


def names(cases, slow):
    """Names of cases for parametrisation: nothing is measured before its test runs; those in `slow` are marked."""
    assert set(slow) <= set(cases)
    return [pytest.param(name, marks=pytest.mark.slow) if name in slow else name for name in cases]


def shown_as_measured(module, name):
    """Every row of a case of a test's module holds, and the page has its lines, in their order, with their bounds.

    Figures of rounding differ between machines: of those that the page shows, only their bound is held.
    """
    topic = module.rpartition(".")[2]
    rows = measured(topic, name)
    assert rows
    assert [row.line() for row in rows if not row.holds] == []
    keys = [row.key for row in rows]
    lines = [line for line in shown(topic) if tuple(line[:2]) in keys]
    assert [tuple(line[:2]) for line in lines] == keys
    for line, row in zip(lines, rows, strict=True):
        written, now = line[2:], cells(row.line())[2:]
        assert written[1:] == now[1:], line
        if isinstance(row.reached, str):
            assert without_figures(written[0]) == without_figures(now[0])
        else:
            assert float(written[0]) <= row.most * 1.05, line


def without_figures(words):
    return re.sub(r"-?[0-9.]+(e[-+]?\d+)?", "#", words)


def shown(topic):
    """Rows of a table of the page, as lists of cells."""
    block = PAGE.read_text(encoding="utf-8").split(f"<!-- {topic} -->\n")[1].split("\n<!-- end -->")[0]
    return [cells(line) for line in block.splitlines()[2:]]


def cells(line):
    """Cells of a line of a table."""
    return [cell.strip().replace("\\|", "|") for cell in line.removeprefix("|").removesuffix("|").split(" | ")]


def main():
    text = PAGE.read_text(encoding="utf-8")
    for topic in TOPICS:
        table = "\n".join([HEAD, *(row.line() for row in rows_of(topic))])
        before, rest = text.split(f"<!-- {topic} -->\n")
        text = before + f"<!-- {topic} -->\n{table}\n<!-- end -->" + rest.split("<!-- end -->", 1)[1]
    PAGE.write_text(text, encoding="utf-8")
    wrong = [row for topic in TOPICS for row in rows_of(topic) if not row.holds]
    for row in wrong:
        print(row.line())
    return len(wrong)


if __name__ == "__main__":
    sys.exit(main())
