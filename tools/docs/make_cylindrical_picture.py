# needs: cylindrical
"""Picture of docs/cylindrical.md, a groove cut radially: `python tools/docs/make_cylindrical_picture.py`.

The section is that of the page's own recipe through the axis, where its groove is steepest.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import numpy as np
from drawing import BLUE, CONSTRUCTION, INK, METAL, QUIET, RED, Look, Sheet, keep

from camgeo.capabilities.cylindrical.exact import designed
from camgeo.capabilities.cylindrical.figures import at_angle, steepest
from camgeo.capabilities.cylindrical.reading import read_cylindrical
from camgeo.common.clock import Clock
from camgeo.schema.yaml_source import read_source

DOCS = Path(__file__).parents[2] / "docs"
NAME = "cylindrical-walls"
WRONG = Look("link", "", opacity=0.6)
WIDE, HIGH = 760.0, 430.0
TYPE = 24.0  # px: at 390 px, half the width of the picture, words are 11 px high


def figures() -> dict[str, str]:
    """The section by its name."""
    found = re.search(r"^```yaml\n(.*?)^```", (DOCS / "cylindrical.md").read_text("utf-8"), re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit("docs/cylindrical.md has no recipe")
    design = designed(read_cylindrical(read_source(found[1].encode(), "drum.yaml"), Path("drum.yaml")), Clock())
    recipe = design.recipe
    _, at = steepest(design)
    r = np.linspace(recipe.floor, recipe.radius, 61)
    middle = recipe.level + float(design.law.derivatives(np.array([at]), 0)[0, 0])

    def wall(name: str) -> np.ndarray:
        flank = design.flanks[name]
        places = [flank.on(at_angle(flank, np.array([at]), radius, np.array([at])), radius).z[0] for radius in r]
        return np.array(places) - middle

    low, high = wall("lower"), wall("upper")
    reach = 1.35 * max(-low.min(), high.max())
    sheet = Sheet(
        "A groove cut radially from its drawing, and the right one, in a section through the axis", WIDE, HIGH
    )
    panel = sheet.panel((50.0, 40.0, 640.0, 350.0), (-reach, recipe.floor - 4.0, reach, recipe.radius + 4.0))
    bottom = recipe.floor - 3.0
    outline = [
        (-reach, bottom),
        (reach, bottom),
        (reach, r[-1]),
        *zip(high[::-1], r[::-1], strict=True),
        *zip(low, r, strict=True),
        (-reach, r[-1]),
    ]
    panel.line(outline, METAL, closed=True)
    for right in (low, high):
        wrapped = np.full_like(right, right[-1])
        panel.line([*zip(right, r, strict=True), *zip(wrapped[::-1], r[::-1], strict=True)], WRONG, closed=True)
        panel.line(list(zip(wrapped, r, strict=True)), RED)
        panel.line(list(zip(right, r, strict=True)), BLUE)
    panel.line([(0.0, bottom), (0.0, recipe.radius + 3.0)], CONSTRUCTION)
    for radius, text in ((recipe.radius, f"{recipe.radius:g}"), (recipe.roller.inner, f"{recipe.roller.inner:g}")):
        panel.line([(-reach, radius), (reach, radius)], CONSTRUCTION)
        panel.letter((-reach, radius), text, (-24.0, 0.0), TYPE)
    inner = float(np.interp(recipe.roller.inner, r, high))
    panel.arrow((high[-1], recipe.roller.inner - 1.2), (inner, recipe.roller.inner - 1.2), INK, both=True)
    panel.letter((high[-1], recipe.roller.inner - 1.5), f"{inner - high[-1]:.2f} mm", (-56.0, 0.0), TYPE)
    panel.letter((0.0, recipe.radius + 3.0), "roller's axis", (0.0, 16.0), TYPE)
    sheet.write(0.5 * WIDE, HIGH - 14.0, "along the drum's axis; upward is outward", size=TYPE)
    panel.letter((0.0, 0.5 * (recipe.floor + recipe.radius)), "groove", (0.0, 0.0), TYPE)
    panel.line([(-reach, bottom), (reach, bottom)], QUIET)
    return {NAME: sheet.text()}


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(DOCS / "figures", figures(), "cylindrical-")
