"""The folder of a measured part: page, drawing and table, whole and as the file is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from support.measured import RECIPES, bump, measured

from camgeo.cli.main import main

LIMITED = RECIPES["roller on a stem"] + "\nmade: {profile: 0.04, datum: part}\n"


def test_a_folder_of_page_drawing_and_table(tmp_path, capsys):
    recipe, files = measured(tmp_path, LIMITED, bump(0.015), noise=0.001)
    out = tmp_path / "out"
    assert main(["verify", str(recipe), *map(str, files), "--out", str(out)]) == 0
    told = capsys.readouterr().out
    assert "part: ok  points-1.csv" in told
    assert sorted(path.name for path in out.iterdir()) == ["part-made.csv", "part-made.html", "part-made.svg"]
    page = (out / "part-made.html").read_text("utf-8")
    assert page.count("<svg") == 3
    assert "What to take off" in page
    rows = np.genfromtxt(out / "part-made.csv", delimiter=",", names=True)
    assert len(rows) == 720
    worst = int(np.argmax(rows["deviation_mm"]))
    assert rows["shaft_deg"][worst] == pytest.approx(50.0, abs=3.0)
    foot = np.hypot(rows["x_mm"] - rows["foot_x_mm"], rows["y_mm"] - rows["foot_y_mm"])
    assert foot == pytest.approx(np.abs(rows["deviation_mm"]), abs=1e-9)
