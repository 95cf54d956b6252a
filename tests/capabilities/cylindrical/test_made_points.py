# needs: made
"""Points measured on the flanks of a drum, by `camgeo verify`.

Holds: camgeo.capabilities.cylindrical.made_points, camgeo.capabilities.cylindrical.made_folder,
camgeo.report.measured_page, kin.cylindrical.measured_flanks, kin.cylindrical.inspected.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from capabilities.cylindrical.made_drums import GROOVE, RIB, TOP, changed
from capabilities.cylindrical.positions import Lift
from capabilities.cylindrical.wound_drums import SPIRAL

import camgeo
from camgeo.cli.main import main
from kin.cylindrical.inspected import read_flank_points
from kin.read.errors import ReadError

PLAY = changed(GROOVE, ("{depth: 12.5}", "{depth: 12.5, clearance: 0.03}"), ("[stl]", "[{csv: {as: flank, step: 2}}]"))
ASKED = f"made: {{profile: 0.03}}\nverify: {{motion_error: 0.01}}\n{PLAY}"


class Flanks:
    """A recipe, and the places and normals of its inspection table."""

    def __init__(self, text: str, folder: Path) -> None:
        self.folder, self.recipe = folder, folder / "drum.yaml"
        self.recipe.write_text(text, encoding="utf-8")
        self.table = camgeo.export(self.recipe, folder).path / "drum.csv"
        rows = np.genfromtxt(self.table, delimiter=",", names=True)
        places, normals, self.shaft, self.names, self.r = [], [], [], [], []
        for name in ("lower", "upper"):
            if f"{name}_r_mm" not in (rows.dtype.names or ()):
                continue
            r, phi = rows[f"{name}_r_mm"], np.radians(rows[f"{name}_phi_deg"])
            places.append(np.stack([r * np.cos(phi), r * np.sin(phi), rows[f"{name}_z_mm"]], axis=-1))
            normals.append(np.stack([rows[f"{name}_n{axis}"] for axis in "xyz"], axis=-1))
            self.names += [name] * len(r)
            self.shaft += rows["shaft_deg"].tolist()
        self.places, self.normals = np.concatenate(places), np.concatenate(normals)

    def written(self, places: np.ndarray, heading: str = "x_mm,y_mm,z_mm,flank") -> Path:
        """A file of points."""
        path = self.folder / "points.csv"
        lines = [heading]
        for row, name in zip(places.tolist(), self.names, strict=True):
            cells = [f"{value:.9f}" for value in row] + ([name] if "flank" in heading else [])
            lines.append(",".join(cells))
        path.write_text("\n".join([*lines, ""]), encoding="utf-8")
        return path

    def verified(self, path: Path, **options: Any) -> Any:
        """The report on a file."""
        return camgeo.verify(self.recipe, path, **options)


@pytest.fixture(scope="module")
def drum(tmp_path_factory: pytest.TempPathFactory) -> Flanks:
    """A drum with a groove of 0.03 mm clearance."""
    return Flanks(ASKED, tmp_path_factory.mktemp("made"))


@pytest.mark.costly("points of whole flanks are found from rollers at all angles")
@pytest.mark.parametrize("text", [PLAY, RIB, TOP], ids=["groove", "rib", "top"])
def test_its_own_inspection_table_is_right(text: str, tmp_path: Path) -> None:
    own = Flanks(changed(text, ("[stl]", "[{csv: {as: flank, step: 2}}]")) if "[stl]" in text else text, tmp_path)
    made = own.verified(own.table)["made"]
    assert max(abs(flank[end]) for flank in made["flanks"] for end in ("least", "most")) < 2e-8
    assert max(abs(ring["worst"]) for ring in made["rings"]) < 2e-8
    assert {ring["flank"] for ring in made["rings"]} == set(own.names)


@pytest.mark.slow
def test_a_cone_on_an_arm_in_inches(tmp_path: Path) -> None:
    """Of a drum that turns the other way; 0.0004 in too large all round is what each point is off."""
    text = changed(
        GROOVE,
        ("from: 38", "from: 38, taper: 3, at: 44, arm: {length: 90, offset: 89.5, pivot: 46}"),
        ("pitch_height: 20", "pitch_height: 33.5"),
        ("[stl]", "[{csv: {as: flank, step: 2}}]"),
        ("rise: 40", "rise: 16"),
        ("return: 40", "return: 16"),
    )
    own = Flanks(f"rotation: ccw\n{text}", tmp_path)
    assert max(abs(flank["worst"]) for flank in own.verified(own.table)["made"]["flanks"]) < 2e-8
    large = own.written((own.places + 0.01016 * own.normals) / 25.4, "x_in,y_in,z_in")
    report = own.verified(large)["made"]
    for flank in report["flanks"]:
        assert [flank["least"], flank["most"]] == pytest.approx([0.01016, 0.01016], abs=2e-5)
    # in the dwell at the top the arm stands aslant by psi, and the flank is level: e/(l cos psi)
    ring = next(each for each in report["rings"] if each["flank"] == "lower")
    assert ring["unit"] == "deg"
    assert 0.01016 / 90.0 < math.radians(ring["mean"]) < 0.01016 / 90.0 * 1.2


@pytest.mark.slow
def test_metal_too_large_with_a_burr(drum: Flanks) -> None:
    """5 um all round lift the roller by 5 um/cos a; a burr of 20 um fails the profile and is left out of the motion."""
    e = np.full(len(drum.places), 0.005)
    burr = 3 * 100 + 1
    e[burr] += 0.020
    report = drum.verified(drum.written(drum.places + e[:, None] * drum.normals), probe_error=0.001)
    made = report["made"]
    lower, upper = made["flanks"]
    assert (lower["worst"], lower["line"]) == (pytest.approx(0.025, abs=1e-6), burr + 2)
    assert (upper["least"], upper["most"]) == (pytest.approx(0.005, abs=1e-6),) * 2
    verdicts = made["verdicts"]
    assert (verdicts["made-profile lower"], verdicts["made-profile upper"]) == ("failed", "ok")
    assert not report.ok
    outer = next(ring for ring in made["rings"] if ring["flank"] == "lower" and burr + 2 in ring["outliers"])
    assert outer["outliers"] == [burr + 2]
    inner = made["rings"][0]
    steepest = math.degrees(math.atan(40.0 * 2.0 / math.radians(120.0) / 38.0))
    assert inner["worst"] == pytest.approx(0.005 / math.cos(math.radians(steepest)), abs=1e-5)
    assert made["rings"][-1]["worst"] < 0.0  # above the roller metal pushes it down
    # both flanks take the play away: 0.03 - 2 times 0.005 in a dwell
    assert made["play"]["least"] == pytest.approx(0.02, abs=1e-5)
    told = {check.name: check.detail for check in report.checks if check.name.startswith("made-")}
    assert "720 points, U = 0.001 mm of a point" not in told["made-motion"]
    assert "U = 0.001 mm of a point" in told["made-motion"]
    assert "mm alone" in told["made-motion"]


def test_points_of_half_a_turn_prove_no_motion(drum: Flanks) -> None:
    """The limit of the motion is not held by the profile alone."""
    lines = drum.table.read_text("utf-8").splitlines()
    path = drum.folder / "half.csv"
    path.write_text("\n".join([*lines[: len(lines) // 2], ""]), encoding="utf-8")
    report = drum.verified(path)
    assert not report.ok
    assert report["made"]["verdicts"]["made-profile lower"] == "ok"
    assert report["made"]["verdicts"]["made-motion"] == "not proved"
    assert [check.name for check in report.checks if not check.ok] == ["made-motion"]


def test_a_flank_without_points_is_not_proved(drum: Flanks) -> None:
    """The roller runs between both."""
    lower = [place for place, name in zip(drum.places.tolist(), drum.names, strict=True) if name == "lower"]
    path = drum.folder / "lower.csv"
    rows = ["x_mm,y_mm,z_mm,flank", *(",".join(f"{value:.9f}" for value in place) + ",lower" for place in lower)]
    path.write_text("\n".join([*rows, ""]), encoding="utf-8")
    report = drum.verified(path)
    unseen = {(check.name, check.surface) for check in report.checks if not check.ok}
    assert unseen == {("made-profile", "upper"), ("made-motion", "upper")}
    assert report["made"]["verdicts"]["made-profile upper"] == "not proved"
    assert report["made"]["verdicts"]["made-motion upper"] == "not proved"


@pytest.mark.slow
def test_shifted_along_its_axis(drum: Flanks) -> None:
    path = drum.written(drum.places + np.array([0.0, 0.0, 0.02]))
    made = drum.verified(path)["made"]
    assert all(ring["mean"] == pytest.approx(0.02, abs=1e-5) for ring in made["rings"])
    assert made["verdicts"]["made-profile lower"] == "failed"
    placed = drum.verified(path, align="height")["made"]
    assert placed["placing"]["shifted along z"]["value"] == pytest.approx(0.02, abs=1e-7)
    assert max(abs(flank["worst"]) for flank in placed["flanks"]) < 1e-6
    assert "turned about z" not in placed["placing"]


@pytest.mark.slow
def test_turned(drum: Flanks) -> None:
    """0.1 degrees counter-clockwise; the motion is late by as much, which moves it by S' at the steepest place."""
    angle = math.radians(0.1)
    turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    path = drum.written(drum.places @ turn.T)
    made = drum.verified(path)["made"]
    steepest = 40.0 * 2.0 / math.radians(120.0)
    assert abs(made["rings"][0]["worst"]) == pytest.approx(angle * steepest, rel=0.02)
    assert made["verdicts"]["made-profile upper"] == "failed"
    assert not any(ring["outliers"] for ring in made["rings"])
    placed = drum.verified(path, align="rotation")["made"]
    assert placed["placing"]["turned about z"]["value"] == pytest.approx(0.1, abs=1e-6)
    assert max(abs(flank["worst"]) for flank in placed["flanks"]) < 1e-6
    every = drum.verified(path, align="best-fit")["made"]["placing"]
    assert every["turned about z"]["value"] == pytest.approx(0.1, abs=1e-5)
    assert abs(every["tilted about x"]["value"]) < 1e-5


def test_a_tilted_drum_turned_the_other_way(tmp_path: Path) -> None:
    """Placing is told in the axes of the file."""
    own = Flanks(f"rotation: ccw\n{PLAY}", tmp_path)
    a = math.radians(0.05)
    tilt = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    path = own.written(own.places @ tilt.T + [0.03, -0.02, 0.0])
    placing = own.verified(path, align="best-fit")["made"]["placing"]
    assert placing["tilted about x"]["value"] == pytest.approx(0.05, abs=1e-4)
    assert placing["shifted along x"]["value"] == pytest.approx(0.03, abs=2e-4)
    assert placing["shifted along y"]["value"] == pytest.approx(-0.02, abs=2e-4)


@pytest.mark.parametrize(("lift", "told"), [("40.05", "failed"), ("36", None)])
def test_a_flank_of_another_lift(lift: str, told: str | None, drum: Flanks, tmp_path: Path) -> None:
    other = Flanks(PLAY.replace("rise: 40", f"rise: {lift}").replace("return: 40", f"return: {lift}"), tmp_path)
    if told is None:
        with pytest.raises(camgeo.CallError, match="these points are of another drum: one of ten is"):
            drum.verified(other.table)
        return
    made = drum.verified(other.table)["made"]
    assert set(made["verdicts"].values()) == {told}
    assert made["rings"][0]["worst"] == pytest.approx(0.05, abs=5e-4)


@pytest.mark.slow
def test_noise_has_an_uncertainty(drum: Flanks) -> None:
    """Of random errors of 2 um the smoothed motion shows less, and its uncertainty covers nearly all of it."""
    noise = np.random.default_rng(1).normal(0.0, 0.002, len(drum.places))
    made = drum.verified(drum.written(drum.places + noise[:, None] * drum.normals), probe_error=0.004)["made"]
    for ring in made["rings"]:
        assert ring["noise"] == pytest.approx(0.002, rel=0.15)
        assert abs(ring["worst"]) < 2.5 * ring["uncertainty"] < 0.01
    # 0.03 wide, and the farthest point 7 um off with 4: neither is certain of a narrower zone
    text = ASKED.replace("profile: 0.03", "profile: 0.017")
    drum.recipe.with_name("narrow.yaml").write_text(text, encoding="utf-8")
    report = camgeo.verify(drum.recipe.with_name("narrow.yaml"), drum.folder / "points.csv", probe_error=0.004)
    assert "not proved" in report["made"]["verdicts"].values()
    assert not report.ok


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("change", "heading", "told"),
    [
        (lambda p: p / 25.4, "x,y,z", "they were in inches, and are read as mm: head their columns x_in"),
        (lambda p: p / 25.4, "x_mm,y_mm,z_mm", "they were in inches, and are read as mm"),
        (lambda p: p * 25.4, "x,y,z", "they were in mm, and are read as inches"),
        (lambda p: p * [1.0, -1.0, 1.0], "x,y,z", "they were mirrored: change rotation"),
        (lambda p: p[:, [1, 0, 2]] * [-1.0, 1.0, 1.0], "x,y,z", "turned by about 90 degrees"),
        (lambda p: p + np.array([0.0, 0.0, 5.0]), "x,y,z", "shifted along z by about 5 mm"),
        (lambda p: p * [0.5, 0.5, 1.0], "x,y,z", "another drum: they lie 19"),
        (
            lambda p: p,
            "a,b,c",
            "no columns of points of a flank, in its heading: a, b, c; x, y, z or phi_deg, r, z are read",
        ),
        (lambda p: p, "x_mm,y_in,z_mm", "different units of length"),
    ],
)
def test_wrong_files(drum: Flanks, change: Any, heading: str, told: str) -> None:
    with pytest.raises(camgeo.CallError) as raised:
        drum.verified(drum.written(change(drum.places), heading))
    assert told in str(raised.value)
    assert len(raised.value.faults) == 1


def test_units_of_a_bare_heading(drum: Flanks, capsys: pytest.CaptureFixture[str]) -> None:
    """The remedy for inches does what it says."""
    path = drum.written(drum.places / 25.4, "x,y,z")
    assert main(["verify", str(drum.recipe), str(path), "--units", "inch"]) == 0
    assert "flank upper" in capsys.readouterr().out


def test_several_turns_are_refused(drum: Flanks) -> None:
    path = drum.folder / "spiral.yaml"
    path.write_text(SPIRAL, encoding="utf-8")
    with pytest.raises(camgeo.CallError, match="points of a drum of several turns are not judged; give a solid of it"):
        camgeo.verify(path, drum.table)


def test_options_of_discs_are_refused(drum: Flanks) -> None:
    with pytest.raises(camgeo.CallError, match="--spans: it is for points of discs"):
        drum.verified(drum.table, spans=30)
    with pytest.raises(camgeo.CallError, match=r"--align: one of none, rotation, height, .*, not 'all'"):
        drum.verified(drum.table, align="all")


def test_columns_as_inspection_tables_have_them(tmp_path: Path) -> None:
    """Polar angles, in degrees or radians, radius and z, of one flank or two; empty cells are left out."""
    path = tmp_path / "points.csv"
    rows = [f"{k},10,{k / 10},{'' if k == 3 else 5}" for k in range(20)]
    path.write_text("\n".join(["Phi [deg];R [mm];Z [mm];upper_z".replace(";", ","), *rows]), encoding="utf-8")
    read = read_flank_points(path)
    assert (len(read.lines), read.unit, set(read.flank.tolist())) == (20, 1.0, {-1})
    assert read.places[9] == pytest.approx([10 * math.cos(math.radians(9)), 10 * math.sin(math.radians(9)), 0.9])
    rows = [f"{k / 10},10,{k},{'' if k == 3 else 5},10,1" for k in range(20)]
    path.write_text("\n".join(["lower_phi_rad,lower_r_in,lower_z_in,upper_phi_deg,upper_r_in,upper_z_in", *rows]))
    read = read_flank_points(path)
    assert (len(read.lines), read.unit, read.flank.tolist().count(1)) == (39, 25.4, 19)
    assert read.places[5] == pytest.approx([10 * math.cos(0.5), 10 * math.sin(0.5), 5])
    path.write_text("\n".join(["x,y,z,flank", *[f"{k},1,2,{'side' if k == 4 else 'lower'}" for k in range(20)]]))
    with pytest.raises(ReadError, match="line 6: a flank is lower or upper, not 'side'"):
        read_flank_points(path)


# --- centres of a ball ------------------------------------------------------------------------------------------------

LIFT = Lift(
    [
        ("rise", 40.0, 120.0, "cycloidal"),
        ("dwell", 0.0, 60.0, ""),
        ("return", 40.0, 120.0, "polynomial-345"),
        ("dwell", 0.0, 60.0, ""),
    ]
)


def centres(ball: float, off: float, rho: float = 44.0) -> list[str]:
    """Rows of centres of a ball on both flanks, whose metal is `off` too much, by the line of contact of a cylinder.

    At the place rho along the roller tan a = S'/rho, and the metal lies R from the roller's axis, ahead of it below and
    behind it above; R is 10, and 10.03 above.
    """
    theta = np.radians(np.arange(0.0, 360.0, 2.0))
    slope = (LIFT(theta + 1e-6) - LIFT(theta - 1e-6)) / 2e-6
    sine, cosine = slope / np.hypot(slope, rho), rho / np.hypot(slope, rho)
    rows = []
    for side, name, radius in ((-1.0, "lower", 10.0), (1.0, "upper", 10.03)):
        far = radius - ball - off
        x, y, z = rho + 0.0 * theta, -side * far * sine, 20.0 + LIFT(theta) + side * far * cosine
        places = np.stack([x * np.cos(theta) - y * np.sin(theta), x * np.sin(theta) + y * np.cos(theta), z], axis=1)
        rows += [f"{','.join(f'{value:.9f}' for value in row)},{name}" for row in places.tolist()]
    return ["x_mm,y_mm,z_mm,flank", *rows]


@pytest.mark.costly("points of whole flanks are found from rollers at all angles, five times")
def test_centres_of_a_ball(drum: Flanks) -> None:
    """A ball of 3 mm touches metal that is 5 um too much; the points are 3.005 mm off without its radius."""
    path = drum.folder / "ball.csv"
    path.write_text("\n".join([*centres(3.0, 0.005), ""]), encoding="utf-8")
    made = drum.verified(path, probe_radius=3, probe_error=0.001)["made"]
    for flank in made["flanks"]:
        assert [flank["least"], flank["most"]] == pytest.approx([0.005, 0.005], abs=2e-6)
    assert set(made["verdicts"].values()) == {"ok"}
    lower = next(ring for ring in made["rings"] if ring["flank"] == "lower")
    steepest = math.atan(40.0 * 2.0 / math.radians(120.0) / 44.0)
    assert lower["worst"] == pytest.approx(0.005 / math.cos(steepest), abs=1e-5)
    with pytest.raises(camgeo.CallError, match=r"look 3\.005 mm too large all round: `--probe-radius` of the ball\?"):
        drum.verified(path)
    path.write_text("\n".join([*centres(0.0, 0.0), ""]), encoding="utf-8")
    with pytest.raises(camgeo.CallError, match="look 3 mm too small all round: leave `--probe-radius` out"):
        drum.verified(path, probe_radius=3)
    with pytest.raises(camgeo.CallError, match="a ball of radius 12 mm does not go where a roller of 10 mm does"):
        drum.verified(path, probe_radius=12)
    with pytest.raises(camgeo.CallError, match=r"--probe-radius: a length such as 0\.002 is expected, not -1"):
        drum.verified(path, probe_radius=-1)


@pytest.mark.costly("points of whole flanks are found from rollers at all angles")
def test_a_ball_on_the_flank_of_a_cone(tmp_path: Path) -> None:
    """Places moved along their normals are those of a parallel surface."""
    text = changed(
        GROOVE,
        ("from: 38", "from: 38, taper: 8, at: 44, arm: {length: 90, offset: 89.5, pivot: 46}"),
        ("pitch_height: 20", "pitch_height: 33.5"),
        ("[stl]", "[{csv: {as: flank, step: 2}}]"),
        ("rise: 40", "rise: 16"),
        ("return: 40", "return: 16"),
    )
    own = Flanks(f"rotation: ccw\n{text}", tmp_path)
    path = own.written(own.places + 2.0 * own.normals)
    for flank in own.verified(path, probe_radius=2)["made"]["flanks"]:
        assert abs(flank["worst"]) < 1e-7


# --- files ------------------------------------------------------------------------------------------------------------


def test_a_page_a_drawing_and_a_table_of_points(drum: Flanks, tmp_path: Path) -> None:
    """A burr of 20 um is the first of the farthest points, the longest stroke of the drawing, and an outlier."""
    e = np.full(len(drum.places), 0.005)
    burr = 3 * 100 + 1
    e[burr] += 0.020
    path = drum.written(drum.places + e[:, None] * drum.normals)
    report = drum.verified(path, out=str(tmp_path / "measured"))["made"]
    page, svg, table = report["written"]
    rows = np.genfromtxt(table, delimiter=",", names=True)
    assert len(rows) == len(drum.places)
    at = rows[(rows["line"] == burr + 2)][0]
    places = [at["x_mm"], at["y_mm"], at["z_mm"]]
    assert places == pytest.approx((drum.places + e[:, None] * drum.normals)[burr].tolist(), abs=1e-8)
    # the foot is within e^2/R, as the distance is
    feet = [at[f"foot_{axis}_mm"] for axis in "xyz"]
    assert feet == pytest.approx(drum.places[burr].tolist(), abs=0.025**2 / 10.0)
    assert (at["surface"], at["file_"], at["outlier"]) == (1, 1, 1)
    assert at["shaft_deg"] == pytest.approx(drum.shaft[burr], abs=0.02)  # e over the lever, about
    assert at["deviation_mm"] == pytest.approx(0.025, abs=1e-6)
    assert np.delete(rows["deviation_mm"], burr) == pytest.approx(0.005, abs=1e-6)
    assert rows["outlier"].sum() == 1
    text = Path(page).read_text("utf-8")
    first = re.search(r"<tr><td>([^<]*)</td><td>([^<]*)</td><td>([^<]*)</td>", text.partition("deviation</th>")[2])
    assert first is not None
    assert first[1] == "+0.025"
    assert f"<td>points.csv</td><td>{burr + 2}</td>" in text
    assert text.count("Error of the motion by the") == len(report["rings"])
    drawn = Path(svg).read_text("utf-8")
    strokes = re.findall(r"M([\d.e-]+),([\d.e-]+)L([\d.e-]+),([\d.e-]+)", drawn)
    lengths = sorted(float(a[1]) - float(a[3]) for a in strokes)
    magnified = float(re.search(r"magnified ([\d.e+]+) times", drawn)[1])
    # in its own axes y points down: metal on a lower flank points up
    assert lengths[-1] == pytest.approx(0.025 * magnified, rel=1e-2)
    assert lengths[-2] == pytest.approx(0.005 * magnified, rel=5e-2)
    assert lengths[0] == pytest.approx(-0.005 * magnified, rel=5e-2)


@pytest.mark.slow
def test_points_of_a_drum_that_turns_the_other_way_stand_in_the_axes_of_their_file(tmp_path: Path) -> None:
    own = Flanks(f"rotation: ccw\n{PLAY}", tmp_path)
    written = own.verified(own.table, out=str(tmp_path / "measured"))["made"]["written"]
    rows = np.genfromtxt(written[2], delimiter=",", names=True)
    assert rows["y_mm"] == pytest.approx(own.places[:, 1], abs=1e-8)
    assert rows["foot_y_mm"] == pytest.approx(own.places[:, 1], abs=1e-6)
