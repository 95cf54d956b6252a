"""The tables of docs/linkages.md, measured: `python tests/validation/linkage_page.py` writes them anew."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from ledger import ROOT, Workshop

from camgeo.recipe.loading import load
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from kin.linkage.mechanism import Mechanism

PAGE = ROOT / "docs" / "linkages.md"
BANDS = (0.05, 0.1, 0.2, 0.5)
# the paper's lengths, deg, and where it states them
DWELLING = {"as-figure-9-2a": (45, "3.1, Figure 9a"), "as-figure-13-2a": (40, "3.2, Figure 13a")}
POSES = {"as-figure-8": (0, 100, 280), "as-figure-12": (55, 120, 230)}
PAPER = (
    "as-figure-8",
    *(f"as-figure-9-{cam}" for cam in ("1", "2a", "2c", "2d")),
    "as-figure-12",
    *(f"as-figure-13-{cam}" for cam in ("1", "2a", "2b", "2d")),
)
OURS = ("oscillating-yoke", "six-bar", "slider-crank")
TURN = 2 * np.pi


@dataclass(frozen=True, eq=False)
class Scene:
    """A shipped recipe's exact mechanism."""

    mechanism: Mechanism

    @classmethod
    @cache
    def of(cls, name):
        recipe = load(ROOT / "recipes" / f"{name}.yaml")
        return cls(designed(recipe).driven.mechanism)

    def relative(self, band):
        """Longest dwell over the relative angle, radians."""
        return self.mechanism.dwells(band, "relative")[0]

    def shaft(self, band):
        """Longest dwell over the shaft angle, radians."""
        return self.mechanism.dwells(band, "shaft")[0]


def window(dwell):
    start = np.degrees(dwell.start)
    return f"{start:.2f} to {start + np.degrees(dwell.length):.2f}", f"{np.degrees(dwell.length):.2f}"


def dwell_table(_):
    """Dwells of cam 2a by band, over either angle."""
    lines = []
    for name, (printed, _) in DWELLING.items():
        scene = Scene.of(name)
        for band in BANDS:
            both = (window(of(np.radians(band))) for of in (scene.relative, scene.shaft))
            lines.append([name, f"about {printed}", f"{band}", *(cell for cells in both for cell in cells)])
    return lines


def pose_table(_):
    """Positions of Figures 8 and 12."""
    lines = []
    for name, degrees in POSES.items():
        mechanism = Scene.of(name).mechanism
        at = mechanism.at(np.radians(degrees), 0)
        for i, theta in enumerate(degrees):
            angles = np.degrees([at.shaft[0, i], at.frame[0, i], at.output[0, i]])
            lines.append([name, f"{theta}", *(f"{x:.2f}" for x in angles), *(f"{x:.2f}" for x in at.joint[:, 0, i])])
    return lines


def span(low, high, digits):
    return f"{low:.{digits}f} to {high:.{digits}f}"


def figure_table(_):
    """Swing, peaks, angles and margins of every shipped linkage; lengths in mm."""
    lines = []
    for name in (*PAPER, *OURS):
        mechanism = Scene.of(name).mechanism
        found, mobile = mechanism.figures(), mechanism.mobility()
        scale = 1.0 if mechanism.unit == "mm" else np.degrees(1.0)
        peaks = [found.velocity_relative, found.velocity, found.acceleration_relative, found.acceleration]
        lines.append(
            [
                name,
                span(scale * found.least.value, scale * found.greatest.value, 2),
                *(f"{abs(peak.value):.3f}" for peak in peaks),
                *(f"{np.degrees(angle.value):.1f}" for angle in (found.transmission_least, found.force_least)),
                f"{mobile.margin:.2f}",
                f"{mobile.least_rate:.3f}",
                ", ".join(f"{np.degrees(place.relative):.1f}" for place in found.dead_centres),
            ]
        )
    return lines


def file_table(workshop):
    """What the DXF of each linkage makes of its output, in thousandths of a degree or of a millimetre."""
    lines = []
    for name in (*PAPER, *OURS):
        made = workshop.shipped(name)
        linkage = made.report["linkage"]
        file = linkage["files"][0]
        size = 1.0 if linkage["error"]["unit"] == "deg" else made.recipe.mm
        plays = [file[f"backlash_{way}"] for way in ("across", "along")]
        scale = 1e3 * made.recipe.mm
        dwells = {
            one["from"] == "intended": f"{one['length_deg']:.2f}"
            for one in reversed(linkage["dwells"])
            if one["over"] == "shaft"
        }
        lines.append(
            [
                name,
                f"{1e3 * size * file['error']['max']:.2f}",
                f"{1e3 * size * linkage['error']['limit']:.2f}",
                f"{1e3 * size * file['centred']['max']:.2f}",
                *(span(scale * play["min"], scale * play["max"], 1) for play in plays),
                f"{linkage['dwells'][0]['band']:g}" if dwells else "",
                *(dwells.get(intended, "") for intended in (True, False)),
            ]
        )
    return lines


# in the order of the page
TABLES = {"dwells": dwell_table, "positions": pose_table, "figures": figure_table, "files": file_table}
HEADS = {
    "figures": (
        "recipe",
        "output",
        "ω over θ",
        "ω over shaft",
        "α over θ",
        "α over shaft",
        "transmission",
        "force",
        "margin",
        "rate",
        "dead centres",
    ),
    "files": (
        "recipe",
        "error",
        "limit",
        "centred",
        "backlash across",
        "backlash along",
        "band",
        "dwell intended",
        "in the file",
    ),
    "positions": ("recipe", "θ", "shaft", "θ₃", "θ₄", "D_x", "D_y"),
    "dwells": ("recipe", "paper", "band", "over θ: from, to", "length", "over the shaft: from, to", "length"),
}


def table(mark, workshop):
    lines = [HEADS[mark], ["---"] * len(HEADS[mark]), *TABLES[mark](workshop)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def cells(text, mark):
    """Rows of a table of the page, as lists of cells."""
    block = text.split(f"<!-- {mark} -->\n")[1].split("\n<!-- end -->")[0]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in block.splitlines()[2:]]


# A fit that meets its tolerance as well by other pieces is as good: errors and plays by as much, the dwell likewise.
SLACK = {"files": (0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.5)}
NUMBER = re.compile(r"(?<![\w.-])-?\d+(?:\.\d+)?(?:e-?\d+)?")


def same(one, other, slack=0.0):
    """Whether two cells agree: their words exactly, their numbers within one unit of the last digit, or the slack."""
    if NUMBER.sub("#", one) != NUMBER.sub("#", other):
        return False
    return all(
        abs(float(a) - float(b)) <= max(1.001 * unit(a), slack)
        for a, b in zip(NUMBER.findall(one), NUMBER.findall(other), strict=True)
    )


def unit(number):
    """Worth of the last digit."""
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def main():
    text = PAGE.read_text(encoding="utf-8")
    with TemporaryDirectory() as folder:
        workshop = Workshop(Path(folder))
        for mark in TABLES:
            before, rest = text.split(f"<!-- {mark} -->\n")
            text = f"{before}<!-- {mark} -->\n{table(mark, workshop)}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
