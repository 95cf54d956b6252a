"""Command lines by chance: every command and option, with names and numbers that make sense and none."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from attacks.outcome import Attack
from camgeo.recipe.starter import STARTERS
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

SMALL = b"cam: {kind: support, p: 9 + cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf]}\nverify: {angles: 60}\n"
NAMES = [
    "cam.yaml",
    "cam.yaml",
    "cam.yaml",
    "other.yaml",
    "none.yaml",
    "",
    ".",
    "folder",
    "cam.dxf",
    "-",
    "a\nb",
    "x" * 300,
]
NAMES += ["cam.yaml/", "/", "\u00fc.yaml", "empty.yaml", "/dev/null", "..", "cam.dxf.yaml", " ", "\udcff.yaml"]
LENGTHS = [
    "0.01",
    "0",
    "-1",
    "nan",
    "inf",
    "1e400",
    "0.0005in",
    "1 furlong",
    "",
    "1_0",
    "\u0661",
    "1e-12",
    "10",
    "1 mm mm",
]
FOLLOWED = ["roller", "shoe", "width", "offset", "arm", "track", "at", "units", "rotation", "reading"]
FOLLOWED += ["table", "recipe", "page"]
OPTIONS: dict[str, list[list[str]]] = {
    "export": [["-v"], ["--json"], ["--only"], ["--out"], ["--tolerance"], ["--jobs"], ["--nothing"]],
    "check": [["-v"], ["--json"], ["--out"], ["--tolerance"], ["--jobs"]],
    "verify": [
        ["-v"],
        ["--json"],
        ["--units"],
        ["--tolerance"],
        ["--gap"],
        ["--second-opinion"],
        ["--page"],
        ["--align"],
        ["--spans"],
    ],
    "report": [["--out"], ["--picture"], ["--at"], ["--check"]],
    "laws": [["--picture"], ["--json"], ["--only"]],
    "new": [],
    "schema": [["--json"]],
    # needs: follow
    "follow": [
        ["--flat"],
        ["--yoke"],
        ["--leading"],
        ["--json"],
        *([f"--{name}"] for name in FOLLOWED),
    ],
    "study": [["--help"]],
    "sweep": [["--help"]],
    "budget": [["--json"], ["--out"]],  # needs: budget
}
GIVEN = {
    "--only": [*FORMATS, "dwg", ""],
    "--out": ["out", "folder", "cam.yaml", "", "/dev/null/out", "a/b/c", "."],
    "--tolerance": LENGTHS,
    "--gap": LENGTHS,
    "--align": ["none", "rotation", "best-fit", "sideways", ""],
    "--spans": ["12", "36", "-1", "x", ""],
    "--page": ["page.html", "cam.yaml", "", "a/b/c", "."],
    "--table": ["turn.csv", "cam.yaml", "", "/dev/null/out"],
    "--recipe": ["found.yaml", "cam.yaml", "found", "a/b/c", "."],
    "--roller": LENGTHS,
    "--shoe": LENGTHS,
    "--width": [*LENGTHS, "60"],
    "--track": ["internal", "groove", "external", "inside", ""],
    "--offset": LENGTHS,
    "--reading": LENGTHS,
    "--arm": [*LENGTHS, "30,20", "30,20,10", ",", "1e400,2", "30"],
    "--at": ["0,0", "1", "x,y", "1,2,3", "nan,0", "60", "nan", "x", "1e400", "-720", ""],
    "--rotation": ["cw", "ccw", "left", ""],
    "--jobs": ["1", "0", "-1", "x", "1.5", "\u0661", ""],
    "--units": ["mm", "inch", "cm", "furlong", ""],
    "--picture": ["svg", "png", "gif", "", "laws.svg", "folder"],
}


ROUND = (
    b'<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="-30 -30 60 60">'
    b'<circle cx="4" cy="0" r="20" fill="none" stroke="black"/></svg>'
)


def called(rng: Random, number: int) -> Attack:
    """One command line of words by chance."""
    command = rng.choice([*OPTIONS, "export", "check", "verify", "report", "nonsense", ""])
    words = [command] if rng.random() < 0.97 else []
    wanted = {"verify": rng.randrange(1, 4), "new": rng.randrange(3), "laws": 0, "schema": 0}.get(
        command, rng.randrange(3)
    )
    names = [rng.choice(NAMES) for _ in range(wanted)]
    if command == "new" and names:
        names[0] = rng.choice([*STARTERS, "disc", "disc-rollr", "", "DISC", "support "])
    if command in {"verify", "report", "check", "export"} and names:
        names[0] = rng.choice(["cam.yaml", names[0]])
    if command == "follow" and names:
        names[0] = rng.choice(["round.svg", "cam.dxf", names[0]])
    words += names
    for option in rng.sample(OPTIONS.get(command, []), min(len(OPTIONS.get(command, [])), rng.randrange(3))):
        words += option
        if option[0] in GIVEN and rng.random() < 0.95:
            words.append(rng.choice(GIVEN[option[0]]))
    if command in {"study", "sweep"} and "--help" not in words:
        words.append("--help")
    drawing = b"0\nEOF\n"
    files = {
        "round.svg": ROUND,
        "cam.yaml": SMALL,
        "other.yaml": SMALL.replace(b"9 +", b"10 +"),
        "empty.yaml": b"",
        "cam.dxf": drawing,
    }
    return Attack(f"call {number}", tuple(words), {**files, "folder/kept.txt": b"kept"})


DISC = "cam: {kind: disc, base_radius: 36, follower: {kind: roller, radius: 9}, motion: MOTION}\n"
RISE = "[{rise: 4, over: 180, law: cycloidal}, {return: 4, over: 180, law: cycloidal}]"
NAMING = [
    DISC.replace("MOTION", "{contour: FILE, reading: 0.01}"),
    DISC.replace("MOTION", "{table: FILE}"),
    DISC.replace("MOTION", RISE) + "made: {profile: 0.03, points: [FILE]}\n",  # needs: made
    DISC.replace("MOTION", RISE) + "dynamics: {mass: 1, rpm: 9, preload: 9, load: {table: FILE}}\n",  # needs: dynamics
    DISC.replace("MOTION", RISE) + "valve: {ratio: {table: FILE}}\n",  # needs: valve
    "camshaft: {shaft: {diameter: 9, to: 50}, lobes: [{recipe: FILE, at: 0, z: 9, length: 9}]}\n",  # needs: camshaft
]
"""Recipes that name a file."""
MISSING = ["x" * 300, "x" * 5000, "folder", "/dev/null", "/dev/stdout", "none", "folder/none", "cam.yaml/none"]
"""Names, but for their suffix, of what is no file."""


def misnamed(rng: Random, number: int) -> Attack:
    """A name of no file, in a recipe and in a call: refused in a line with the place."""
    name = rng.choice(MISSING) + rng.choice(["", ".csv", ".svg", ".dxf", ".yaml", ".stl"])
    text = rng.choice(NAMING).replace("FILE", f"'{name}'")
    words = rng.choice(
        [
            ("check", "cam.yaml"),
            ("check", "cam.yaml"),
            ("verify", "small.yaml", name),
            ("follow", name, "--roller", "8"),  # needs: follow
            ("new", "--from", name, "small.yaml", "new.yaml"),  # needs: made
        ]
    )

    def judge(done: Done, _: Path) -> list[str]:
        begins = ("cam.yaml:", "camgeo: ")
        return [f"words: no place in {line[:200]!r}" for line in done.err.splitlines() if not line.startswith(begins)]

    files = {"cam.yaml": text.encode(), "small.yaml": SMALL, "folder/kept.txt": b"kept"}
    return Attack(f"misnamed {number}", words, files, (2,), judge)


SOUND = {
    "disc": ["--roller 8", "--roller 0 --offset 2", "--shoe 60", "--flat", "--flat --width 60", "--roller 1000"],
    "arm": ["--roller 8 --arm 80,65", "--shoe 30 --arm 80,65 --leading", "--flat --arm 90", "--roller 0 --arm 900,890"],
    "yoke": ["--flat --yoke", "--roller 8 --yoke", "--flat --yoke --reading 50"],
    "ring": ["--roller 2 --track internal", "--roller 8 --offset 3 --track internal"],
    "groove": ["--roller 4 --track groove", "--roller 80 --track groove", "--roller 4 --arm 80,60 --track groove"],
}
"""Followers that go together, by what they run on."""


# needs: follow
def followed(rng: Random, number: int) -> Attack:
    """A follower of any kind on contours by chance: a lobed disc, a ring, a groove, off their places now and then."""
    lobes, lift, radius = (
        rng.randrange(1, 7),
        rng.choice([0.0, 0.1, 1.0, 6.0, 18.0]),
        rng.choice([20.0, 20.0, 30.0, 3.0, 400.0]),
    )
    count, off = rng.choice([3, 40, 360, 1500]), rng.choice([0.0] * 7 + [2.0, 50.0])

    def path(reach: float) -> str:
        angles = [2.0 * math.pi * k / count for k in range(count)]
        rows = [(reach + lift * math.cos(lobes * angle) * reach / 20.0, angle) for angle in angles]
        points = " L ".join(f"{off + r * math.cos(a):.6f} {r * math.sin(a):.6f}" for r, a in rows)
        return f'<path d="M {points} Z"/>'

    kind = rng.choice([*SOUND, *SOUND, "any"])
    nested = [[1.0], [1.0, 1.8], [1.0, 1.4, 2.0], [0.3, 1.0], [0.1, 0.2, 0.3, 1.0]]
    shapes = [path(radius * scale) for scale in {"ring": nested[1], "groove": nested[2]}.get(kind, rng.choice(nested))]
    size = rng.choice(['width="99mm" height="99mm" viewBox="0 0 99 99"'] * 12 + ['viewBox="0 0 99 99"', ""])
    drawing = f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{"".join(shapes)}</svg>'
    follower = rng.choice(
        SOUND.get(kind, [" ".join(rng.choice(words) for words in zip(*SOUND.values(), strict=False))])
    )
    more = rng.choice([[], ["--recipe", "found.yaml"], ["--page", "page.html"], ["--table", "turn.csv", "--json"]])
    words = ["follow", "cam.svg", *follower.split(), *more]
    words += rng.choice([[], [], ["--rotation", "ccw"], ["--reading", "0.2"], ["--at", "2,0"]])
    words += rng.choice([[]] * 9 + [["--units", "inch"]])
    odd = ["--across arc", "--across chord", "--mirror y", "--turn 40", "--turn 1e9", "--gap 1", "--gap 0", "--body 2"]
    words += rng.choice([[]] * 8 + [rng.choice(odd).split()])
    return Attack(f"follower {number}", tuple(words), {"cam.svg": drawing.encode()})


# needs: follow
def followed_by_name(rng: Random, number: int) -> Attack:
    """A sound contour under an odd name, with the page of its recipe: what is named does not matter."""
    name = rng.choice(["my cam", "Nocken-\u00e4", "-x", ".x", "a:b", "NUL", "x" * 200, "{x}", "#1", "cam.rejected"])
    words = ("follow", "--roller", "8", "--page", "page.html", "--", f"{name}.svg")
    return Attack(f"call of a name {number}", words, {f"{name}.svg": ROUND}, (0,))
