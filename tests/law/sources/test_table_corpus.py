"""A corpus of tables: laws at rows of any step, rounded to any digits in any unit, are followed.

A thin diagonal runs quickly, all of it with the slow tests. `python tests/law/sources/test_table_corpus.py` writes the
figures of docs/accuracy.md.
"""

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2]))

from support.table_corpus import LAWS, PLACES, STEPS, TURN, UNITS, drawn, tables

from kin.law.sources.table import from_table

COUNT, QUICK = 240, 24
UNEVEN = 120
NOISES = (0.1, 3.0, 30.0)
MARK = "<!-- tables by step and decimals -->"
EVERY = [table for table in tables(COUNT) if table.stroke * 10**table.places >= 4]
DIAGONAL = {k * len(EVERY) // QUICK for k in range(QUICK)}


def thin(tables_of, quick):
    """Cases by number, all but some of them slow."""
    return [pytest.param(table, marks=[] if k in quick else [pytest.mark.slow]) for k, table in enumerate(tables_of)]


def peak(motion):
    return np.abs(motion.derivatives((np.arange(3600) + 0.5) * TURN / 3600, 2)[2]).max()


def test_the_corpus_has_every_law_step_unit_and_number_of_decimals():
    assert {table.law for table in EVERY} == set(LAWS)
    assert {table.step for table in EVERY} == set(STEPS)
    assert {table.unit for table in EVERY} == set(UNITS)
    assert {table.places for table in EVERY} == set(PLACES)
    assert {bool(table.top) for table in EVERY} == {True, False}
    assert len({(table.step, table.places) for table in EVERY}) == 36


@pytest.mark.thin(4)
@pytest.mark.parametrize("table", thin(EVERY, DIAGONAL), ids=str)
def test_a_law_is_followed_within_its_digits(table):
    motion = from_table(table.rows, table.reading).demand_joined()
    assert motion.kept.distance <= table.reading
    made = motion.from_lowest().derivatives(table.rows.theta, 0)[0]
    assert np.abs(made - table.rows.s).max() <= table.reading * (1 + 1e-6) + 1e-9 * table.stroke * table.scale
    assert motion.range[0] >= -1e-9 * table.stroke * table.scale
    assert peak(motion) <= 1.5 * peak(table.motion)
    if table.places >= 3 and table.rows_a_stroke >= 12:
        assert table.error(motion) <= 0.05
        if table.smooth:
            assert peak(motion) == pytest.approx(peak(table.motion), rel=0.1)
            assert table.greatest(motion)[1] <= (0.1 if table.places == 3 else 0.06)


@pytest.mark.thin(4)
@pytest.mark.parametrize("table", thin(list(tables(UNEVEN, seed=32, uneven=True)), set(range(0, UNEVEN, 30))), ids=str)
def test_uneven_steps_are_followed(table):
    if table.stroke * 10**table.places >= 4:
        motion = from_table(table.rows, table.reading)
        assert motion.kept.distance <= table.reading


@pytest.mark.thin(3)
@pytest.mark.parametrize("noise", NOISES)
def test_noise_is_followed_and_remarked_where_it_is_more_than_the_digits(noise):
    rng, remarked = np.random.default_rng(17), []
    for law in ("cycloidal", "modified-sine", "polynomial-345"):
        table = next(long_strokes(rng, law, 1, noise))
        motion = from_table(table.rows, table.reading)
        # noise beyond the digits takes the least row below 0 by more than its reading: the rows are lowered as a whole
        kept = motion.kept.distance if noise <= 1.0 else motion.kept.distance_lowered
        assert kept <= table.reading
        remarked.append("table-noise" in {remark.name for remark in motion.kept.remarks})
    assert remarked == [noise > 1.0] * 3


def long_strokes(rng, law, step, noise=0.0):
    """Tables of a law with strokes over 110 degrees and more: in shorter ones rows tell less."""
    while True:
        table = drawn(rng, law, "mm", step, 3, noise=noise)
        if min(table.up, table.down) >= 110.0:
            yield table


def figures():
    """Errors of the acceleration by step and decimals, of smooth laws and of laws with jumps, of ten tables each."""
    rng, errors = np.random.default_rng(41), defaultdict(list)
    for step in STEPS:
        for places in PLACES:
            for k in range(2 * len(LAWS)):
                table = drawn(rng, LAWS[k % len(LAWS)], "mm", step, places)
                motion = from_table(table.rows, table.reading)
                figure = (table.error(motion), peak(motion) / peak(table.motion), *table.greatest(motion))
                errors[table.smooth, step, places].append(figure)
                if table.smooth and table.rows_a_stroke >= 12:
                    errors["no kinks" if not table.jumps(3).size else "kinks", step, places].append(figure)
    return errors


def page(errors):
    """The tables of docs/accuracy.md."""
    lines = []
    for smooth, what in ((True, "smooth laws"), (False, "laws whose acceleration jumps")):
        lines += ["", f"| {what}: rows each | " + " | ".join(f"{places} decimals" for places in PLACES) + " |"]
        lines += ["| --- |" + " --- |" * len(PLACES)]
        for step in STEPS:
            cells = []
            for places in PLACES:
                rows = np.array(errors[smooth, step, places])
                cells.append(f"{100 * np.median(rows[:, 0]):.2g}, {100 * rows[:, 0].max():.2g}; {rows[:, 1].max():.3g}")
            lines.append(f"| {step}° | " + " | ".join(cells) + " |")
    lines += ["", "| greatest error anywhere: rows each | " + " | ".join(f"{k} decimals" for k in (3, 4, 5)) + " |"]
    lines += ["| --- |" + " --- |" * 3]
    for step in STEPS[:4]:
        cells = []
        for places in (3, 4, 5):
            plain, kinked = (np.array(errors[kind, step, places]).reshape(-1, 4) for kind in ("no kinks", "kinks"))
            alone = f"{100 * plain[:, 2].max():.2g}" if len(plain) else "-"
            cells.append(f"{alone}; {100 * kinked[:, 3].max():.2g}, {100 * kinked[:, 2].max():.2g}")
        lines.append(f"| {step}° | " + " | ".join(cells) + " |")
    return "\n".join([MARK, *lines[1:], "<!-- end -->"])


if __name__ == "__main__":
    path = Path(__file__).parents[3] / "docs" / "accuracy.md"
    text = path.read_text(encoding="utf-8")
    begin, end = text.index(MARK), text.index("<!-- end -->", text.index(MARK)) + len("<!-- end -->")
    path.write_text(text[:begin] + page(figures()) + text[end:], encoding="utf-8")
