"""Write docs/gallery.md and pictures of shipped recipes, docs/gallery/*.svg: `python tools/docs/make_gallery.py`."""

from __future__ import annotations

import argparse
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from drawing import keep

from camgeo.cams.double_roller import DoubleRollerCam
from camgeo.cams.flat_pair import FlatPairCam
from camgeo.capabilities.cylindrical.exact import designed as drum_of
from camgeo.capabilities.cylindrical.turning import scene as drum_scene
from camgeo.capabilities.indexing.exact import designed as indexer_of
from camgeo.capabilities.indexing.turning import scene as indexer_scene
from camgeo.capabilities.linear.design import designed
from camgeo.capabilities.linear.plate_page import scene
from camgeo.common.clock import Clock
from camgeo.output.pipeline import check_and_show
from camgeo.recipe.loading import load, load_order
from camgeo.report.page.scene import STEPS
from camgeo.report.page.svg import still

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

ROOT = Path(__file__).parents[2]
LINEAR, DRUMS, INDEXERS = "Linear cams", "Cylindrical cams", "Indexing cams"
FAMILIES = ("Flat faces and yokes", "Linkages", "Double rollers", "Flat pairs", "Disc cams", LINEAR, DRUMS, INDEXERS)
DISC = ("disc", "constant-diameter")
SHAFT_DEG = 60.0
COLUMNS = 3
HEAD = """\
# Gallery

Choose a recipe to begin with. These are all shipped recipes, with the shaft turned by 60 degrees. To see one move, use
`camgeo report RECIPE` ([page.md](page.md)), or open it from the examples of [the page in a browser](tab.md). AS, SW
and W are [papers](validation.md). `python tools/docs/make_gallery.py` writes this page.
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
    turned = round(SHAFT_DEG / 360.0 * STEPS)
    for folder_name, heading, drawn in (
        ("linear", LINEAR, lambda plate: still(scene(designed(plate, Clock())), STEPS // 3, plate.name)),
        ("cylindrical", DRUMS, lambda drum: still(drum_scene(drum_of(drum, Clock()), turned), turned, drum.name)),
        ("indexing", INDEXERS, lambda cam: still(indexer_scene(indexer_of(cam, Clock()), turned), turned, cam.name)),
    ):
        for path in sorted((ROOT / "recipes" / folder_name).glob("*.yaml")):
            order = load_order(path)
            name = path.stem
            pictures[name] = drawn(order)
            cells[heading].append(
                f'<td align="center" valign="bottom"><img src="gallery/{name}.svg" width="260" alt="{name}"><br>'
                f'<a href="../recipes/{folder_name}/{path.name}">{name}</a><br><sub>{escape(order.about)}</sub></td>'
            )
    total = keep(folder, pictures)
    text = [HEAD]
    for name, found_cells in cells.items():
        rows = [found_cells[i : i + COLUMNS] for i in range(0, len(found_cells), COLUMNS)]
        table = "\n".join("<tr>\n" + "\n".join(row) + "\n</tr>" for row in rows)
        needs = {LINEAR: "linear", DRUMS: "cylindrical", INDEXERS: "indexing"}.get(name)
        mark = f"<!-- needs: {needs} -->\n" if needs else ""
        text.append(f"{mark}## {name}\n\n<table>\n{table}\n</table>\n")
    (ROOT / "docs" / "gallery.md").write_text("\n".join(text), encoding="utf-8")
    print(f"{len(pictures)} pictures, {total} bytes in all")


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    main()
