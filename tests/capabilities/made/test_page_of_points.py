"""The page of measured points: plots that show the whole turn, and a drawing with its scale and its angles."""

from __future__ import annotations

import re

import numpy as np
from support.measured import RECIPES, bump, measured

import camgeo
from camgeo.report.measured_page import HIGH, RIGHT, WIDE, plot

LIMITED = RECIPES["roller on a stem"] + "\nmade: {profile: 0.04, datum: part}\n"


def test_a_plot_goes_from_0_to_360_and_its_numbers_are_not_cut():
    x = np.arange(0.5, 360.0)
    drawn = plot(x, 0.01 * np.sin(np.radians(x)) + 0.002, np.full(360, 0.001))
    texts = re.findall(r'<text x="([\d.]+)" y="[\d.]+" text-anchor="middle" font-size="12">(\d+)</text>', drawn)
    assert [words for _, words in texts] == ["0", "60", "120", "180", "240", "300", "360"]
    assert float(texts[-1][0]) + 0.5 * 3 * 8.0 < WIDE  # three figures of 8 px at most
    (curve,) = re.findall(r'<path d="M([^"]*)" stroke="#b3261e"', drawn)
    ends = [tuple(map(float, place.split(","))) for place in (curve.split("L")[0], curve.split("L")[-1])]
    assert (ends[0][0], ends[1][0]) == (70.0, WIDE - RIGHT)
    assert ends[0][1] == ends[1][1]  # the turn closes
    assert all(0.0 <= float(y) <= HIGH for y in re.findall(r",([\d.-]+)", curve))


def test_the_drawing_says_its_scale_and_its_angles(tmp_path):
    recipe, (file,) = measured(tmp_path, LIMITED, bump(0.015), noise=0.0005)
    camgeo.verify(recipe, file, out=tmp_path / "out")
    drawn = (tmp_path / "out" / "part-made.svg").read_text("utf-8")
    words = re.findall(r'<text x="([\d.-]+)" y="([\d.-]+)" font-size="([\d.]+)"[^>]*>([^<]*)</text>', drawn)
    marks, (*_, scale) = words[:-1], words[-1]
    assert [mark[3] for mark in marks] == [str(degrees) for degrees in range(0, 360, 30)]
    bar, magnified = re.fullmatch(r"([\d.]+) mm; deviation magnified (\d+) times; angles of .*", scale).groups()
    assert 0.005 < float(bar) < 0.05
    (long,) = re.findall(r"M[\d.-]+,[\d.-]+v[\d.-]+v[\d.-]+h([\d.]+)v", drawn)
    assert float(long) == float(f"{float(bar) * float(magnified):.5g}")
    left, low, wide, high = map(float, re.search(r'viewBox="([^"]*)"', drawn)[1].split())
    assert all(left < float(x) < left + wide and low < float(y) < low + high for x, y, *_ in words)
