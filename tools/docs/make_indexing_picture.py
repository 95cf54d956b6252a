# needs: indexing
"""Picture of docs/indexing.md, both forms beside their turrets: `python tools/docs/make_indexing_picture.py`.

The cams are those of the first two recipes of the page, turned by 60 degrees.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from drawing import Sheet, keep

from camgeo.capabilities.indexing.exact import designed
from camgeo.capabilities.indexing.reading import read_indexing
from camgeo.capabilities.indexing.ribs import layers
from camgeo.capabilities.indexing.turning import scene
from camgeo.common.clock import Clock
from camgeo.report.page.scene import STEPS
from camgeo.report.page.svg import still
from camgeo.schema.yaml_source import read_source

DOCS = Path(__file__).parents[2] / "docs"
NAME = "indexing-forms"
TURNED = STEPS // 6
DEEP = 3  # layers of a cam: more make a file that is too large for a page
TYPE = 24.0  # px: at 390 px, half the width of the picture, names are 11 px high
WIDE, HIGH, FOOT = 380.0, 330.0, 34.0  # px of one form, and below both


def figures() -> dict[str, str]:
    """Both forms by the picture's name."""
    found = re.findall(r"^```yaml\n(.*?)^```", (DOCS / "indexing.md").read_text("utf-8"), re.MULTILINE | re.DOTALL)
    sheet = Sheet("A barrel and a globoid, each with its turret, seen along the turret's axis", 2.0 * WIDE, HIGH + FOOT)
    for k, text in enumerate(found[:2]):
        recipe = read_indexing(read_source(text.encode(), "index.yaml"), Path("index.yaml"))
        design = designed(recipe, Clock())
        drawn = still(scene(design, TURNED, layers(design, DEEP)), TURNED, recipe.turret.word)
        drawn = re.sub(r' d="[^"]*"', lambda path: re.sub(r"-?[\d.]+", _tenth, path[0]), drawn)
        place = f'<svg x="{k * WIDE:g}" width="{WIDE:g}" height="{HIGH:g}"'
        sheet.add(re.sub(r'<svg xmlns="[^"]*" width="[^"]*" height="[^"]*"', place, drawn, count=1))
        sheet.write((k + 0.5) * WIDE, HIGH + 0.5 * FOOT, recipe.turret.word, size=TYPE)
    return {NAME: sheet.text()}


def _tenth(number: re.Match[str]) -> str:
    """The number to a tenth of a mm, a quarter of a px here."""
    return f"{round(float(number[0]), 1):g}"


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    keep(DOCS / "figures", figures(), "indexing-")
