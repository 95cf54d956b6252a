"""Rises, dwells and returns of lobes, from motions of any source."""

import math

import numpy as np
import pytest

import camgeo
from camgeo.capabilities.camshaft.events import stretches
from camgeo.common.clock import Clock
from camgeo.synthesis.design import designed

MATCHED = (
    "{rise: 2, over: 40, law: match}, {rise: 6, over: 60, law: constant-velocity}, {rise: 2, over: 40, law: match}"
)
LOBE = "{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}"
SOURCES = {
    "lobe": (LOBE, 235, [("return", 235, 303), ("dwell", 303, 527), ("rise", 167, 235)]),
    "formula": ("{formula: 5*(1 - cos(t))}", 30, [("rise", 30, 210), ("return", 210, 390)]),
    "one rise of three segments": (
        f"[{MATCHED}, {{dwell: 40}}, {{return: 10, over: 180, law: cycloidal}}]",
        0,
        [("rise", 0, 140), ("dwell", 140, 180), ("return", 180, 360)],
    ),
    "rise and fall": (
        "[{rise_fall: 5, over: 90}, {dwell: 270}]",
        0,
        [("rise", 0, 45), ("return", 45, 90), ("dwell", 90, 360)],
    ),
    "two a turn": (
        "{repeat: 2, segments: [{rise: 5, over: 60, law: harmonic}, {to: 0, over: 60, law: harmonic}, {dwell: 60}]}",
        350,
        [
            (name, at + turn, at + turn + 60)
            for turn in (350, 170)
            for name, at in (("rise", 0), ("return", 60), ("dwell", 120))
        ],
    ),
    "a whole dwell": ("[{dwell: 360}]", 20, [("dwell", 0, 360)]),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize(("motion", "zero", "expected"), SOURCES.values(), ids=SOURCES)
def test_stretches_of_any_source(motion: str, zero: float, expected: list[tuple[str, float, float]]) -> None:
    text = f"cam: {{kind: disc, base_radius: 30, follower: {{kind: roller, radius: 8}}, motion: {motion}}}\n"
    exact = designed(camgeo.load(text), Clock()).exact
    found = [tuple(stretch) for stretch in stretches(exact, math.radians(zero))]
    right = [(phase, begin % 360, begin % 360 + end - begin) for phase, begin, end in expected]
    assert [phase for phase, *_ in found] == [phase for phase, *_ in right]
    assert np.array([ends for _, *ends in found]) == pytest.approx(np.array([ends for _, *ends in right]), abs=1e-4)


def test_waves_of_a_base_circle_are_a_dwell() -> None:
    """Forty waves of 0.3 micrometres beside a lift of 8 mm; those of 30 are drawn."""
    motion = "{formula: 8*((1 - cos(t))/2)**8 + %s*cos(40*t)}"
    text = f"cam: {{kind: disc, base_radius: 60, follower: {{kind: flat}}, motion: {motion}}}\n"
    small, large = (stretches(designed(camgeo.load(text % wave), Clock()).exact, 0.0) for wave in ("0.0003", "0.03"))
    assert [stretch.phase for stretch in small] == ["rise", "return", "dwell"]
    rise, back, dwell = small
    assert rise.end == back.begin == pytest.approx(180.0, abs=1e-6)
    assert dwell.begin == back.end
    assert dwell.end == pytest.approx(360.0 + rise.begin, abs=1e-9)
    assert 60.0 < rise.begin < 120.0
    assert len(large) > 20
