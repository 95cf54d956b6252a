# needs: follow
"""The motion of a drum of unknown origin: `camgeo follow --drum`.

Holds: camgeo.capabilities.cylindrical.follow, camgeo.capabilities.cylindrical.followed,
camgeo.capabilities.cylindrical.followed_recipe, kin.cylindrical.running, kin.cylindrical.unknown.
"""

from __future__ import annotations

import json
from contextlib import redirect_stdout
from io import StringIO
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import yaml
from capabilities.cylindrical.made_drums import GROOVE, RIB, TOP, changed
from capabilities.cylindrical.positions import Lift

import camgeo
from camgeo.cli.main import main

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

THETA = np.arange(720) * (2.0 * np.pi / 720)
PLAY = changed(GROOVE, ("{depth: 12.5}", "{depth: 12.5, clearance: 0.03}"), ("tolerance: 0.02", "tolerance: 0.01"))
MOTION = yaml.safe_load(GROOVE)["cam"]["motion"]
LIFT = Lift(
    [
        ("rise", 40.0, 120.0, "cycloidal"),
        ("dwell", 0.0, 60.0, ""),
        ("return", 40.0, 120.0, "polynomial-345"),
        ("dwell", 0.0, 60.0, ""),
    ]
)


@pytest.fixture(scope="module")
def grooved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The STL of a drum with a groove."""
    return made(PLAY, tmp_path_factory.mktemp("grooved"))


def made(text: str, folder: Path) -> Path:
    """The first file of a drum's export."""
    (folder / "drum.yaml").write_text(text, encoding="utf-8")
    report = camgeo.export(folder / "drum.yaml", folder)
    assert report.ok
    return next(path for path in sorted(report.path.iterdir()) if path.suffix in {".stl", ".3mf", ".step", ".ply"})


@pytest.fixture
def follow(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """What a call prints, its recipe and its table."""

    def call(path: Path, *words: str) -> Any:
        files = ["--recipe", str(tmp_path / "new.yaml"), "--table", str(tmp_path / "motion.csv")]
        assert main(["follow", str(path), "--json", *words, *files]) == 0
        told = json.loads(capsys.readouterr().out)
        rows = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
        return told, yaml.safe_load((tmp_path / "new.yaml").read_text("utf-8")), rows

    return call


BEARS = ("--drum", "auto", "--roller", "10", "--from", "38", "--to", "49")


@pytest.fixture(scope="module")
def told_of(grooved: Path) -> Any:
    """What the command tells of the groove, the text of its recipe, and its table."""
    files = [grooved.with_name(name) for name in ("new.yaml", "motion.csv")]
    with redirect_stdout(StringIO()) as said:
        words = ["--json", *BEARS, "--recipe", str(files[0]), "--table", str(files[1])]
        assert main(["follow", str(grooved), *words]) == 0
    return json.loads(said.getvalue()), files[0].read_text("utf-8"), np.genfromtxt(files[1], delimiter=",", names=True)


@pytest.mark.costly("a solid is made and followed at all angles")
def test_a_groove_gives_its_recipe_back(
    grooved: Path, told_of: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Laws, lifts and dwells are those of the recipe, and the motion is the law's within what is told."""
    told, text, rows = told_of
    recipe = yaml.safe_load(text)
    assert (told["drum"], told["unit"], told["no_programme"]) == ("groove", "mm", "")
    cam = recipe["cam"]
    assert cam["motion"] == MOTION
    assert cam["track"] == {"groove": {"depth": 12.5, "clearance": 0.03}}
    assert (cam["radius"], cam["pitch_height"]) == (50, 20)
    assert cam["follower"] == {"radius": 10, "from": 38, "to": 49}
    assert recipe["part"] == {"length": 80, "bore": 24}
    off = rows["position_mm"] - (20.0 + LIFT(THETA))
    assert 1e-3 < np.abs(off).max() < told["error"] < 0.02
    # exact play is clearance/cos a at the inner end, where tan a = S'/rho
    play = told["play"]
    assert play["least"] == pytest.approx(0.03, abs=told["error"])
    assert play["greatest"] == pytest.approx(0.03 / np.cos(np.radians(45.13)), abs=told["error"])
    assert told["pressure_angle"]["value"] == pytest.approx(45.15, abs=0.1)
    # made again, with its bore named, it moves alike
    (tmp_path / "new.yaml").write_text(text.replace("bore: 24}", "bore: 24, keyway: din6885}"), encoding="utf-8")
    assert main(["verify", str(tmp_path / "new.yaml"), str(grooved)]) == 0
    assert "ok" in capsys.readouterr().out


@pytest.mark.costly("a solid is followed at all angles")
def test_the_library_follows_a_drum(grooved: Path) -> None:
    """`bears_from` and `bears_to` stand for --from and --to."""
    followed = camgeo.follow(grooved, drum="auto", roller=10, bears_from=38, bears_to=49)
    assert isinstance(followed, camgeo.FollowedDrum)
    assert followed.unit == "mm"
    assert np.abs(followed.position - 20.0 - LIFT(followed.theta)).max() < followed.run.error
    assert followed.lift == pytest.approx(40.0, abs=followed.run.error)
    # over three steps to both sides: within h^2/6 of the third derivative, 40 (2 pi)^2/(2 pi/3)^3 at a cycloidal's ends
    step = 3.0 * 2.0 * np.pi / 720
    slope = (LIFT(THETA + 1e-5) - LIFT(THETA - 1e-5)) / 2e-5
    most = step**2 / 6.0 * 40.0 * (2.0 * np.pi) ** 2 / (2.0 * np.pi / 3.0) ** 3 + followed.run.error / step
    assert np.abs(followed.velocity - slope).max() < most
    # tan a = S'/rho at the inner end
    assert np.abs(np.tan(followed.pressure_angle)).max() == pytest.approx(slope.max() / 38.0, rel=2e-3)
    assert [rest.level for rest in followed.rests] == pytest.approx([60.0, 20.0], abs=0.01)
    assert followed.play is not None
    assert followed.play.min() == pytest.approx(0.03, abs=followed.run.error)
    assert followed.lifts() is None


@pytest.mark.slow  # a solid is followed at all angles twice, and its laws found
def test_the_library_tells_what_the_command_tells(grooved: Path, told_of: Any) -> None:
    followed = camgeo.follow(grooved, drum="auto", roller=10, bears_from=38, bears_to=49)
    assert isinstance(followed, camgeo.FollowedDrum)
    told, recipe, rows = told_of
    assert rows["position_mm"] == pytest.approx(followed.position, rel=1e-11)  # of twelve digits
    assert json.loads(json.dumps(followed.document())) == told
    assert yaml.safe_load(followed.recipe("new.csv")) == yaml.safe_load(recipe)


@pytest.mark.parametrize(
    ("words", "error", "told"),
    [
        ({"drum": "auto", "roler": 10}, TypeError, r"follow\(\) got an unexpected keyword argument 'roler'"),
        ({"drum": "auto", "bears_from": "38", "roller": 10}, TypeError, "bears_from must be a number, not str"),
        ({"drum": 1, "roller": 10}, TypeError, "drum must be a str, not int"),
        ({"drum": "auto", "roller": 10, "taper": "x"}, TypeError, "taper must be a number, not str"),
        ({"drum": "auto", "roller": 10, "turns": 1.5}, TypeError, "turns must be an int, not float"),
        ({"drum": "drum", "roller": 10}, camgeo.CallError, "is one of auto, groove, rib, top, bottom, not 'drum'"),
        ({"drum": "auto", "roller": 10, "axis": "w"}, camgeo.CallError, "axis of a drum is one of x, y, z, not 'w'"),
        ({"drum": "auto", "roller": 10, "flat": True}, camgeo.CallError, "are not of drums"),
        ({"drum": "auto", "roller": 10, "steps": 360}, camgeo.CallError, "steps are of discs: leave steps out"),
        ({"drum": "auto"}, camgeo.CallError, "give --roller with its radius, or --width of a shoe"),
        (
            {"roller": 10, "bears_from": 38},
            camgeo.CallError,
            "bears_from goes with drum: give both, or leave bears_from",
        ),
    ],
)
def test_wrong_calls_of_the_library(grooved: Path, words: Any, error: type[Exception], told: str) -> None:
    with pytest.raises(error, match=told):
        camgeo.follow(grooved, **words)


@pytest.mark.slow  # booleans of a whole groove
def test_level_faces_of_another_kernel_have_triangles_along_the_rim(tmp_path: Path, follow: Callable[..., Any]) -> None:
    """A blank less a roller's way, by booleans: triangles of its ends have all their corners on the blank."""
    manifold3d, trimesh = pytest.importorskip("manifold3d"), pytest.importorskip("trimesh")
    theta = np.arange(181) * (2.0 * np.pi / 180)
    roller = manifold3d.Manifold.cylinder(14.5, 10.0, 10.0, 64).rotate([0, 90, 0]).translate([37.5, 0, 0])
    ways = [
        roller.rotate([0, 0, angle]).translate([0, 0, 20.0 + lift])
        for angle, lift in zip(np.degrees(theta).tolist(), LIFT(theta).tolist(), strict=True)
    ]
    way = [manifold3d.Manifold.batch_hull(list(pair)) for pair in pairwise(ways)]
    blank, core = (manifold3d.Manifold.cylinder(length, r, r, 180) for length, r in ((80.0, 50.0), (90.0, 12.0)))
    taken = manifold3d.Manifold.batch_boolean([core.translate([0, 0, -5]), *way], manifold3d.OpType.Add)
    solid = (blank - taken).to_mesh()
    places = np.asarray(solid.vert_properties)[:, :3]
    trimesh.Trimesh(places, solid.tri_verts, process=False).export(tmp_path / "made.stl")
    told, _, rows = follow(tmp_path / "made.stl", "--drum", "auto", "--roller", "10", "--from", "38.5")
    assert told["drum"] == "groove"
    lift = rows[rows.dtype.names[1]] - 20.0 - LIFT(np.radians(rows[rows.dtype.names[0]]))
    assert np.abs(lift).max() < 0.05  # a side of the roller stands 10 (1 - cos(pi/64)) = 0.012 off


@pytest.mark.slow  # a finer mesh, and surfaces
@pytest.mark.parametrize(("form", "tolerance"), [("stl", "0.003"), ("step", "0.01"), ("3mf", "0.01")])
def test_other_files_give_it_back(form: str, tolerance: str, tmp_path: Path, follow: Callable[..., Any]) -> None:
    text = changed(PLAY, ("tolerance: 0.01", f"tolerance: {tolerance}"), ("[stl]", f"[{form}]"))
    told, recipe, rows = follow(made(text, tmp_path), "--drum", "groove", "--roller", "10", "--from", "38")
    assert recipe["cam"]["motion"] == MOTION
    assert recipe["cam"]["track"]["groove"] == {"depth": 12.5, "clearance": pytest.approx(0.03, abs=6e-4)}
    # facets tell how far they are off; splines are off by the tolerance, which moves the roller by e/cos a at most
    within = float(tolerance) / np.cos(np.radians(45.15)) if form == "step" else told["error"]
    assert np.abs(rows["position_mm"] - (20.0 + LIFT(THETA))).max() < within


@pytest.mark.slow  # solids are made and followed at all angles
@pytest.mark.parametrize(
    "case",
    [
        (RIB, ("--roller", "10"), {"rib": {"distance": 50, "depth": 12}}, 40),
        (TOP, ("--roller", "10", "--from", "38"), {"end": "top"}, 20),
        (
            changed(GROOVE, ("from: 38", "from: 38, taper: 4, at: 44")),
            ("--roller", "10", "--from", "38", "--taper", "4,44"),
            {"groove": {"depth": 12.5, "clearance": 0}},
            20,
        ),
    ],
    ids=["rib", "top", "cone"],
)
def test_other_tracks_give_theirs_back(
    case: tuple[str, tuple[str, ...], Any, float], tmp_path: Path, follow: Callable[..., Any]
) -> None:
    text, words, track, height = case
    told, recipe, rows = follow(made(text, tmp_path), "--drum", "auto", *words)
    cam = recipe["cam"]
    assert (cam["motion"], cam["track"], cam["pitch_height"]) == (MOTION, track, height)
    assert np.abs(rows["position_mm"] - height - LIFT(THETA)).max() < told["error"] < 0.05


@pytest.mark.slow  # a solid is made and followed at all angles
def test_an_arm_on_a_drum_that_turns_the_other_way(tmp_path: Path, follow: Callable[..., Any]) -> None:
    """Swings are degrees; an arm's lengths are those of the call."""
    motion = (
        "[{rise: 16, over: 120, law: modified-sine}, {dwell: 60}, {return: 16, over: 120, law: cycloidal}, {dwell: 60}]"
    )
    text = changed(
        GROOVE,
        (yaml_motion(), motion),
        ("from: 38", "from: 38, arm: {length: 90, offset: 89.5, pivot: 46}"),
        ("pitch_height: 20", "pitch_height: 33.5"),
    )
    path = made(f"rotation: ccw\n{text}", tmp_path)
    words = ("--roller", "10", "--from", "38", "--arm", "90,89.5,46", "--rotation", "ccw")
    told, recipe, _ = follow(path, "--drum", "auto", *words)
    assert (told["unit"], recipe["cam"]["motion"]) == ("deg", yaml.safe_load(motion))
    assert recipe["cam"]["follower"]["arm"] == {"length": 90, "offset": 89.5, "pivot": 46, "side": "trailing"}
    assert recipe["cam"]["pitch_height"] == pytest.approx(33.5, abs=0.01)


def yaml_motion() -> str:
    """The motion as the recipe of a groove has it."""
    return GROOVE.split("motion: ")[1].split("\n")[0]


# --- foreign walls ----------------------------------------------------------------------------------------------------


def radial(
    path: Path, *, clearance: float = 0.0, shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[Any, Any]:
    """A groove with walls along radii, as one cuts it from its development; the lines of its walls on the blank."""
    lift = LIFT(THETA_FINE)
    slope = (LIFT(THETA_FINE + 1e-5) - LIFT(THETA_FINE - 1e-5)) / 2e-5
    lines = []
    for side, radius in ((-1, 10.0), (1, 10.0 + clearance)):
        w = np.hypot(50.0, slope)
        at, height = THETA_FINE - side * radius * slope / w / 50.0, 20.0 + lift + side * radius * 50.0 / w
        lines.append(np.interp(THETA_FINE, at, height, period=2.0 * np.pi))
    corners = [(12.0, 0.0), (50.0, 0.0), (50.0, lines[0]), (37.5, lines[0]), (37.5, lines[1]), (50.0, lines[1])]
    corners += [(50.0, 80.0), (12.0, 80.0)]
    rings = [
        np.stack([r * np.cos(THETA_FINE), r * np.sin(THETA_FINE), np.broadcast_to(z, THETA_FINE.shape)], axis=-1)
        for r, z in corners
    ]
    parts = []
    for a, b in zip(rings, [*rings[1:], rings[0]], strict=True):
        a1, b1 = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
        parts += [np.stack([a, a1, b], axis=1), np.stack([b, a1, b1], axis=1)]
    triangles = np.concatenate(parts) + shift
    rows = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    rows["v"] = triangles
    path.write_bytes(b"\0" * 80 + np.uint32(len(triangles)).tobytes() + rows.tobytes())
    return lines[0], lines[1]


THETA_FINE = np.arange(1440) * (2.0 * np.pi / 1440)


@pytest.mark.slow  # a solid is made and followed at all angles
def test_radial_walls_pinch_where_they_are_steep(tmp_path: Path, follow: Callable[..., Any]) -> None:
    """By brute force over points of both walls; the roller touches at its inner end, where the groove is too narrow."""
    low, high = radial(tmp_path / "cut.stl", clearance=0.2)
    told, recipe, rows = follow(tmp_path / "cut.stl", "--drum", "auto", "--roller", "10", "--from", "38")
    fine = np.arange(14400) * (2.0 * np.pi / 14400)
    low, high = (np.interp(fine, THETA_FINE, line, period=2.0 * np.pi) for line in (low, high))
    for k in range(0, 720, 24):
        across = np.angle(np.exp(1j * (fine - THETA[k])))
        lower, upper = -np.inf, np.inf
        for r in np.linspace(38.0, 50.0, 13):
            y, along = r * np.sin(across), r * np.cos(across)
            own = (np.abs(y) < 10.0) & (along > 38.0 - 1e-9) & (along < 50.0)
            # a wall that is cut off at the roller's end is touched there
            lower = max(lower, (low[own] + np.sqrt(100.0 - y[own] ** 2)).max(initial=-np.inf))
            upper = min(upper, (high[own] - np.sqrt(100.0 - y[own] ** 2)).min(initial=np.inf))
        for radius in np.linspace(38.0, 39.5, 61):
            y, along = radius * np.sin(across), radius * np.cos(across)
            own = (np.abs(y) < 10.0) & (along > 38.0 - 1e-9)
            lower = max(lower, (low[own] + np.sqrt(100.0 - y[own] ** 2)).max(initial=-np.inf))
            upper = min(upper, (high[own] - np.sqrt(100.0 - y[own] ** 2)).min(initial=np.inf))
        assert rows["lower_mm"][k] == pytest.approx(lower, abs=0.012)
        assert rows["upper_mm"][k] == pytest.approx(upper, abs=0.012)
    assert told["play"]["greatest"] == pytest.approx(0.2, abs=0.01)
    assert told["play"]["least"] < -2.0
    # no law is near, so that lifts stand beside
    assert told["programme"] is None
    assert recipe["cam"]["motion"] == {"table": "new.csv", "reading": 0.01}
    assert "the laws that fit best leave" in told["no_programme"]


@pytest.mark.slow  # a solid is made and followed at all angles
def test_where_the_axis_lies_is_asked(tmp_path: Path, follow: Callable[..., Any], capsys: Any) -> None:
    """Beside the origin and above z = 0 it is followed where it lies."""
    radial(tmp_path / "cut.stl")
    words = ("--drum", "groove", "--roller", "9.5", "--from", "38")
    rows = follow(tmp_path / "cut.stl", *words)[2]
    radial(tmp_path / "beside.stl", shift=(5.0, -3.0, 7.0))
    assert main(["follow", str(tmp_path / "beside.stl"), *words]) == 2
    assert "no cylinder about z; give axis z and at 5,-3" in capsys.readouterr().err
    for name in ("new.yaml", "new.csv", "motion.csv"):
        (tmp_path / name).unlink(missing_ok=True)
    moved = follow(tmp_path / "beside.stl", *words, "--at", "5,-3")[2]
    assert np.abs(moved["position_mm"] - rows["position_mm"]).max() < 1e-4


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--roller", "0"), "give --roller with its radius"),
        (("--roller", "10", "--flat"), "are not of drums"),
        (
            ("--roller", "10", "--from", "50"),
            "the roller bears from 50 to 50 mm; give from and to between floor and blank",
        ),
        (
            ("--roller", "10", "--from", "30"),
            "the floor is at 37.5 mm and the blank at 50, and the roller bears from 30 to 50 mm",
        ),
        (("--roller", "10", "--from", "45", "--to", "40"), "give from below to"),
        (("--roller", "10", "--arm", "90,80"), "the arm of a drum has its length, and y and height of its pivot"),
        (("--roller", "10", "--leading"), "only an arm leads"),
        (("--roller", "10", "--taper", "60"), "a taper lies above 0 and below 45 degrees"),
        (("--roller", "10", "--axis", "x"), "no cylinder about x; give axis z"),
        (("--roller", "10", "--at", "1,0"), "no cylinder about z; give axis z"),
        (("--roller", "10", "--drum", "rib"), "no rib that goes round the turn and closes is found"),
        (("--roller", "10", "--reading", "0"), "a reading is a length above 0"),
        pytest.param(
            ("--roller", "10", "--turn", "9", "--page", "new.html"),
            "leave axis, at and turn out, or page",
            marks=pytest.mark.slow,  # it is followed first
        ),
    ],
)
def test_wrong_calls(grooved: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], told: str) -> None:
    drum = () if "--drum" in words else ("--drum", "auto")
    assert main(["follow", str(grooved), *drum, *words]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--from", "38"), "--from goes with --drum: give both, or leave --from out"),
        (("--axis", "x"), "--axis goes with --drum"),
    ],
)
def test_options_of_drums_alone(
    grooved: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], told: str
) -> None:
    assert main(["follow", str(grooved), "--roller", "10", *words]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.slow  # a solid is made and followed at all angles
def test_a_turn_that_begins_in_a_stroke_has_a_table(grooved: Path, follow: Callable[..., Any]) -> None:
    told, recipe, _ = follow(grooved, "--drum", "auto", "--roller", "10", "--turn=-60")
    assert "table" in recipe["cam"]["motion"]
    remedy = float(told["no_programme"].split("--turn=")[1].split()[0])
    assert remedy == pytest.approx(-150.0, abs=2.0)


@pytest.mark.slow  # a solid is made and followed at all angles
def test_the_page_judges_the_file_by_its_recipe(grooved: Path, tmp_path: Path) -> None:
    words = ("--drum", "auto", "--roller", "10", "--from", "38")
    assert main(["follow", str(grooved), *words, "--page", str(tmp_path / "drum.html")]) == 0
    page = (tmp_path / "drum.html").read_text("utf-8")
    assert "<svg" in page
    assert "drum.stl" in page


def test_an_end_cam_is_no_disc(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its section is a circle, whose facets moved a roller by 0.01 mm once."""
    path = made(TOP, tmp_path)
    assert main(["follow", str(path), "--roller", "10"]) == 2
    said = capsys.readouterr().err
    assert "no disc, its section is round, and its faces lean beside that" in said
    assert "follow a drum by --drum auto and --roller with its radius" in said
