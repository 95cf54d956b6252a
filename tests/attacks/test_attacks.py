"""Attacks by chance find nothing, and whoever looks for findings finds those that are planted."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from support.brute_disc import Touching
from support.heavy import ezdxf

from attacks import cams, runner, valves
from attacks.cams import Cam, wrong_verdict
from attacks.files import exported
from attacks.generator import WAYS, attack_of
from attacks.outcome import Attack, Done, findings

if TYPE_CHECKING:
    from pathlib import Path

SEED = 22
QUICK, SLOW = len(WAYS), 120
COST = ("time:", "memory:")  # those are for the command, on a machine that has nothing else to do

CAM = Cam(
    Touching("roller", 6.0, offset=3.0),
    40.0,
    ((8.0, 120, "cycloidal"), (0.0, 40, ""), (-8.0, 110, "polynomial-345"), (0.0, 90, "")),
    "cw",
    0.002,
)


def wrong(told: runner.Told) -> list[str]:
    return [f"{told.number} {told.name} {told.words}: {text}" for text in told.findings if not text.startswith(COST)]


@pytest.mark.costly("what an attack does is by chance")
@pytest.mark.thin(5)
@pytest.mark.parametrize(
    "number",
    [
        pytest.param(
            # sizing a lobe by its card is long, and a way that was there before is for the slow run
            number,
            marks=pytest.mark.slow if way is valves.carded or way in WAYS[:number] else (),
        )
        for number, way in enumerate(WAYS)
    ],
)
def test_attacks_find_nothing(number: int) -> None:
    assert wrong(runner.made(attack_of(SEED, number), number)) == []


@pytest.mark.slow
def test_many_attacks_in_processes_that_are_watched_find_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    every: list[runner.Told] = []
    monkeypatch.setattr(runner, "MANY", 64)  # so that several workers share them
    runner.run(SEED, range(QUICK, QUICK + SLOW), every.append)
    assert [one.number for one in every] == list(range(QUICK, QUICK + SLOW))
    assert [text for one in every for text in wrong(one)] == []
    assert {one.status for one in every} >= {0, 1, 2}


@pytest.mark.slow
def test_an_attack_is_the_same_for_the_same_seed() -> None:
    for number in range(len(WAYS)):
        one, other, another = attack_of(3, number), attack_of(3, number), attack_of(4, number)
        assert (one.name, one.words, one.files, one.statuses) == (other.name, other.words, other.files, other.statuses)
        assert (one.words, one.files) != (another.words, another.files) or one.name.startswith("call")


# --- what is planted is found -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def drawing(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """A sound drawing of CAM, and its report."""
    folder = tmp_path_factory.mktemp("attacks")
    (folder / "cam.yaml").write_text(CAM.text("dxf"))
    done = runner.call(("export", str(folder / "cam.yaml"), "--out", str(folder / "out"), "--json"))
    assert done.status == 0
    return folder / "out" / "cam" / "cam.dxf", json.loads(done.out)[0]


def printed(report: dict[str, Any], **other: Any) -> Done:
    return Done(0 if other.get("ok", report["ok"]) else 1, json.dumps({**report, **other}), "")


def test_brute_force_agrees_with_a_sound_verdict(drawing: tuple[Path, dict[str, Any]]) -> None:
    path, report = drawing
    (motion,) = (check["value"] for check in report["checks"] if check["name"] == "motion")
    assert CAM.error(path) == pytest.approx(motion, abs=CAM.margin)
    assert wrong_verdict(CAM, printed(report), path) == []


def test_a_wrong_verdict_is_found(drawing: tuple[Path, dict[str, Any]], monkeypatch: pytest.MonkeyPatch) -> None:
    path, report = drawing
    motion = [check for check in report["checks"] if check["name"] == "motion"]
    failed = [{**check, "ok": False, "limit": 2.0 * check["limit"]} for check in motion]
    (found,) = wrong_verdict(CAM, printed(report, ok=False, checks=failed), path)
    assert found.startswith("verdict: called wrong")
    monkeypatch.setattr(cams, "motion", lambda rows, degrees: 1.003 * motion_of(rows, degrees))
    (found,) = wrong_verdict(Cam(**vars_of(CAM)), printed(report), path)
    assert found.startswith("verdict: called right")


motion_of = cams.motion


def vars_of(cam: Cam) -> dict[str, Any]:
    return {name: getattr(cam, name) for name in cam.__dataclass_fields__}


@pytest.mark.parametrize(
    ("done", "kind"),
    [
        (Done(1, "", "", traceback="ValueError"), "traceback"),
        (Done(0, "", "", seconds=5.1), "time"),
        (Done(0, "", "", megabytes=2049.0), "memory"),
        (Done(3, "", "no disk"), "status"),
        (Done(2, "", ""), "words"),
        (Done(1, "Traceback (most recent call last)", ""), "words"),
        (Done(1, "", "got <class 'NoneType'>"), "words"),
    ],
)
def test_each_kind_of_finding(tmp_path: Path, done: Done, kind: str) -> None:
    attack = Attack("planted", ("laws",), statuses=(0, 1, 2))
    assert findings(attack, done, tmp_path)[0].partition(":")[0] == kind
    assert findings(attack, Done(1, "", ""), tmp_path) == []


def test_an_exception_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: object) -> int:
        raise RuntimeError("planted")

    monkeypatch.setattr("camgeo.cli.main.main", broken)
    told = runner.made(Attack("planted", ("laws",)), 0)
    assert "RuntimeError: planted" in told.findings[0]


def test_sound_cams_are_exported_with_every_kind_of_file() -> None:
    _, files = exported(0, 1)
    assert {"yaml", "dxf", "svg", "stl", "3mf"} <= set(files)
    assert "ngc" in files  # needs: milling


# needs: linear
def test_a_long_edge_of_a_plate_has_points_as_near_as_is_asked_for(tmp_path: Path) -> None:
    from attacks.plates import flank

    drawing = ezdxf.new()
    corners = [(0.0, 0.0), (200.0, 0.0), (200.0, 30.0), (0.0, 30.0)]
    drawing.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": "CUT"})
    drawing.saveas(tmp_path / "plate.dxf")
    apart = np.hypot(*np.diff(flank(tmp_path / "plate.dxf", 0.02), axis=0).T)
    assert apart[:10_000] == pytest.approx(0.02)  # the longest edge
    assert apart.max() <= 0.15 + 1e-9  # an edge of 30 in 200 steps
