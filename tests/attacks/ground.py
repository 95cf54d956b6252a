"""Tables for grinders by chance, given back altered; pressures in units of all kinds; recipes under odd names."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from attacks.cams import drawn
from attacks.files import ANY, FAILS, PASSES, SHARED
from attacks.outcome import Attack

if TYPE_CHECKING:
    from collections.abc import Callable

    from attacks.outcome import Done

WHEELS = 4  # cams whose tables are altered, of so many attacks
FORMS = ("grinding", "lift")
STEPS = ["1e-9", "1e-4", "0.01", "0.1", "0.5", "1", "7", "90", "360", "400", "0", "-1", "nan", "1/3", "30 min"]
RADII = ["0", "-3", "1e-6", "0.5", "18", "250", "1e9", "1 in", "inf"]


@lru_cache(maxsize=2 * WHEELS)
def tables(share: int, number: int) -> tuple[float, bytes, dict[str, str]]:
    """Tolerance and recipe of a cam that is ground, and its tables by their forms; the same for the same numbers."""
    import camgeo

    for attempt in range(40):
        rng = Random(f"ground {share} {number} {attempt}")
        cam = drawn(rng)
        files = f"{{csv: {{as: grinding, step: 1}}}}, {{csv: {{as: lift, roller: {rng.uniform(4, 40):.2f}, step: 1}}}}"
        text = cam.text(files, f"manufacture: {{wheel: {rng.uniform(20, 300):.1f}}}\n")
        with TemporaryDirectory() as folder:
            path = Path(folder) / "cam.yaml"
            path.write_text(text, encoding="utf-8")
            try:
                report = camgeo.export(path, Path(folder) / "out")
            except camgeo.CamgeoError:
                continue
            if not report.ok or report.path is None:
                continue
            made = [report.path / name for name in ("cam.csv", "cam-lift.csv")]
            return (
                cam.tolerance,
                text.encode(),
                {form: file.read_text() for form, file in zip(FORMS, made, strict=True)},
            )
    raise AssertionError("no cam by chance could be ground")


def ground(rng: Random, number: int) -> Attack:
    """A grinder's table as it was, or with its head, a row, a column or its bytes altered."""
    tolerance, recipe, made = tables(number // SHARED, rng.randrange(WHEELS))
    form = rng.choice(FORMS)
    way = rng.choice(list(CHANGES))
    change, statuses = CHANGES[way]
    text = change(rng, made[form], tolerance)
    files = {"cam.yaml": recipe, "table.csv": text.encode("utf-8", "surrogateescape")}
    if text == made[form]:
        statuses = PASSES
    return Attack(f"{form} {way} {number}", ("verify", "cam.yaml", "table.csv", "--json"), files, statuses)


def _head(rng: Random, text: str, _: float) -> str:
    """Another wheel or roller."""
    return re.sub(
        r"([\d.]+) mm across", lambda spot: f"{float(spot[1]) * rng.choice([0.5, 1.07, 3]):.6g} mm across", text
    )


def _centre(rng: Random, text: str, _: float) -> str:
    """Another distance at lift 0, where the table says it."""
    return re.sub(
        r"centre is ([\d.]+) mm", lambda spot: f"centre is {float(spot[1]) + rng.choice([-1, 1]):.9g} mm", text
    )


def _bare(_: Random, text: str, __: float) -> str:
    """No head at all."""
    return "".join(line for line in text.splitlines(keepends=True) if not line.startswith("#"))


def _row(rng: Random, text: str, tolerance: float) -> str:
    """A distance or a lift that is off by many tolerances."""
    lines = text.splitlines()
    at = rng.randrange(4, len(lines))
    cells = lines[at].split(",")
    cells[1] = repr(float(cells[1]) + rng.choice([-1, 1]) * rng.uniform(20.0, 400.0) * tolerance)
    lines[at] = ",".join(cells)
    return "\n".join(lines) + "\n"


def _normals(rng: Random, text: str, _: float) -> str:
    """Directions in which the metal faces that are off in all rows, of the table that has them."""
    by, lines = rng.choice([-5.0, 3.0]), text.splitlines()
    rows = [line.split(",") for line in lines]
    if len(rows[-1]) < 3:
        return text
    turned = [
        ",".join([*row[:2], repr(float(row[2]) + by)]) if row[0][:1].isdigit() else line
        for row, line in zip(rows, lines, strict=True)
    ]
    return "\n".join(turned) + "\n"


def _cell(rng: Random, text: str, _: float) -> str:
    """A number that is none, or far too large."""
    spots = list(re.finditer(r"-?\d+(\.\d+)?(e-?\d+)?", text))
    spot = rng.choice(spots)
    other = rng.choice(["nan", "inf", "1e999", "", "1_0", "0x1", "\u0661", "-", "1e300", "9" * 400])
    return text[: spot.start()] + other + text[spot.end() :]


def _lines(rng: Random, text: str, _: float) -> str:
    """Rows taken away, there twice, or in another order."""
    lines = text.splitlines(keepends=True)
    at, count = rng.randrange(len(lines)), rng.randrange(1, 30)
    way = rng.randrange(3)
    if way == 0:
        del lines[at : at + count]
    elif way == 1:
        lines[at:at] = lines[at : at + count]
    else:
        lines[4:] = rng.sample(lines[4:], len(lines) - 4)
    return "".join(lines)


CHANGES: dict[str, tuple[Callable[[Random, str, float], str], tuple[int, ...]]] = {
    "as it was": (lambda _rng, text, _tolerance: text, PASSES),
    "head": (_head, FAILS),
    "centre": (_centre, FAILS),
    "bare": (_bare, FAILS),
    "row": (_row, FAILS),
    "normals": (_normals, FAILS),
    "cell": (_cell, ANY),
    "lines": (_lines, ANY),
    "cut short": (lambda rng, text, _tolerance: text[: rng.randrange(len(text))], ANY),
}


# --- what is asked for ------------------------------------------------------------------------------------------------


def tabled_for_a_grinder(rng: Random, number: int) -> Attack:
    """Steps and rollers that make sense and none."""
    form = rng.choice(FORMS)
    options = [f"step: {rng.choice(STEPS)}"] * rng.randrange(2) + [f"roller: {rng.choice(RADII)}"] * (form == "lift")
    wheel = f"manufacture: {{wheel: {rng.choice(['50', '0', '1e6', '320 mm', '12 in', '1e-3'])}}}\n"
    files = f"{{csv: {{{', '.join([f'as: {form}', *options])}}}}}"
    text = drawn(rng).text(files, wheel)
    return Attack(f"{form} {number}", ("export", "cam.yaml"), {"cam.yaml": text.encode()}, (0, 1, 2))


PRESSURES = ["900", "900 MPa", "1.2 GPa", "150000 psi", "900 N/mm²", "900 N/mm2", "900 N/mm^2", "9e8 Pa", "900 bar"]
PRESSURES += [
    "900 lb",
    "1e400 psi",
    "nan MPa",
    "-5 MPa",
    "900 psi psi",
    "",
    "0 psi",
    "1e-300 GPa",
    "900MPa",
    "\u0661 MPa",
]


def pressed(rng: Random, number: int) -> Attack:
    """A limit of the contact pressure, and a figure of the material, in units of pressure that are known and not."""
    material = rng.choice(["steel", f"{{E: {rng.choice(PRESSURES)}, nu: 0.3}}"])
    more = f"dynamics: {{mass: 1, rpm: 300, preload: 500, material: {material}}}\n"
    bound = rng.choice(["at_most", "at_least"])
    more += f"limits: {{contact-pressure: {{{bound}: {rng.choice(PRESSURES)}}}}}\n"
    text = rng.choice(["", "units: inch\n"]) + drawn(rng).text("dxf", more)
    return Attack(f"pressure {number}", ("check", "cam.yaml"), {"cam.yaml": text.encode()}, (0, 1, 2))


NAMES = [
    "\u00e4 \u00f6.yaml",
    "-v.yaml",
    "--json",
    "cam .yaml",
    "CON.yaml",
    "a'b\".yaml",
    "cam.dxf.yaml",
    "..yaml",
    "#1.yaml",
]
NAMES += [
    "x" * 200 + ".yaml",
    "x" * 250 + ".yaml",
    "a\tb.yaml",
    "%s{}.yaml",
    "\u202e.yaml",
    "cam",
    "cam.YAML",
    "$(x).yaml",
]
NAMES += [".yaml", "a\\b.yaml", "cam:1.yaml", "*.yaml", "~.yaml", "\U0001f529.yaml"]
NAMES += ["cam.v2.yaml", "_x.yaml", "1.yaml", "A-b_c.yml", "x" * 60 + ".yaml", "cam-1.yaml"]


def named(rng: Random, number: int) -> Attack:
    """A sound recipe under an odd name, or with an odd `name`: what is written bears it, or it is refused by name."""
    name, text = rng.choice(NAMES), drawn(rng).text("dxf")
    if rng.random() < 0.4:
        shown = rng.choice(NAMES).removesuffix(".yaml").replace("'", "''")
        text, name = f"name: '{shown}'\n{text}", "cam.yaml"

    def judge(done: Done, folder: Path) -> list[str]:
        made = list((folder / "out").rglob("*.dxf")) if done.status == 0 else []
        return ["files: ended with 0 and left no drawing"] if done.status == 0 and not made else []

    words = ("export", "--out", "out", "--", name)
    return Attack(f"name {number}", words, {name: text.encode()}, (0, 1, 2), judge)
