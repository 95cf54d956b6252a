"""Write docs/gallery.md and a picture of every shipped recipe, docs/gallery/*.svg: `python docs/make_gallery.py`."""

from __future__ import annotations

import argparse
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from drawing import keep

from camgeo.cams.double_roller import DoubleRollerCam
from camgeo.cams.flat_pair import FlatPairCam
from camgeo.output.pipeline import check_and_show
from camgeo.recipe.loading import load
from camgeo.report.page.scene import STEPS
from camgeo.report.page.svg import still

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

ROOT = Path(__file__).parents[1]
FAMILIES = ("Flat faces and yokes", "Linkages", "Double rollers", "Flat pairs", "Disc cams")
DISC = ("disc", "constant-diameter")
SHAFT_DEG = 60.0
COLUMNS = 3
HEAD = """\
# Gallery

To choose a recipe to begin with. Every shipped recipe with the shaft turned by 60 degrees, the cam as its first file
draws it. Drawn and written by `python docs/make_gallery.py`; a page that moves comes from
`camgeo report RECIPE` ([page.md](page.md)).
"""


def family(recipe: Recipe) -> str:
    """The heading under which a recipe stands."""
    if recipe.linkage is not None:
        return "Linkages"
    if recipe.cam.kind in DISC:
        return "Disc cams"
    if isinstance(recipe.cam, DoubleRollerCam):
        return "Double rollers"
    return "Flat pairs" if isinstance(recipe.cam, FlatPairCam) else "Flat faces and yokes"


def main() -> None:
    """Draw all recipes, and put them on one page."""
    folder = ROOT / "docs" / "gallery"
    cells: dict[str, list[str]] = {name: [] for name in FAMILIES}
    pictures = {}
    for path in sorted((ROOT / "recipes").glob("*.yaml")):
        recipe = load(path)
        _, found = check_and_show(recipe)
        pictures[path.stem] = still(found.scene, round(SHAFT_DEG / 360.0 * STEPS), recipe.name)
        cells[family(recipe)].append(
            f'<td align="center" valign="bottom"><img src="gallery/{path.stem}.svg" width="260" '
            f'alt="{recipe.name}"><br>'
            f'<a href="../recipes/{path.name}">{recipe.name}</a><br><sub>{escape(recipe.about)}</sub></td>'
        )
    total = keep(folder, pictures)
    text = [HEAD]
    for name, found_cells in cells.items():
        rows = [found_cells[i : i + COLUMNS] for i in range(0, len(found_cells), COLUMNS)]
        table = "\n".join("<tr>\n" + "\n".join(row) + "\n</tr>" for row in rows)
        text.append(f"## {name}\n\n<table>\n{table}\n</table>\n")
    (ROOT / "docs" / "gallery.md").write_text("\n".join(text), encoding="utf-8")
    print(f"{len(pictures)} pictures, {total} bytes in all")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
