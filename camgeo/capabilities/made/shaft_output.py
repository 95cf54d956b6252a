"""The folder of a measured shaft: the files of each cam as of one alone, and a page of the shaft."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.made.output import document, write
from camgeo.capabilities.made.reading import label_of
from camgeo.capabilities.made.text import shaft_rows
from camgeo.common.errors import SurroundingsError
from camgeo.files.markup import one_line
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.capabilities.made.reading import Call
    from camgeo.capabilities.made.shaft import ShaftMade
    from camgeo.recipe.recipe import Order


def write_shaft(recipe: Order, result: ShaftMade, section: dict[str, Any], call: Call) -> list[str]:
    """Write the files; returns their paths. Raises SurroundingsError as the disk does not do what it should."""
    folder = Path(call.out or "")
    written, pages = [], []
    for lobe, entry in zip(result.cams, section["lobes"], strict=True):
        cam = lobe.points.cam
        named = replace(cam.recipe, name=f"{recipe.name}-{label_of(cam.name)}")
        paths = write(named, lobe.result, entry, call)
        pages.append((cam.name, f"{named.name}-made.html"))
        written += paths
    path = folder / f"{recipe.name}-made.html"
    part = path.with_name(f".{path.name}.partial")
    try:
        part.write_text(_page(recipe.name, section, pages), encoding="utf-8", newline="\n")
        part.replace(path)
    except OSError as error:
        raise SurroundingsError(error.strerror or str(error), folder) from error
    return [str(path), *written]


def _page(name: str, section: dict[str, Any], pages: list[tuple[str, str]]) -> str:
    verdicts = "".join(f"<p><b>{one_line(key)}: {one_line(word)}</b></p>" for key, word in section["verdicts"].items())
    rows = "".join(
        f"<tr><td>{one_line(label)}</td><td>{one_line(value)}</td></tr>"
        for label, value in shaft_rows(section, everything=False)
    )
    remarks = "".join(f"<li>{one_line(text)}</li>" for text in section["remarks"])
    links = "".join(f'<li><a href="{one_line(page)}">{one_line(title)}</a></li>' for title, page in pages)
    files = one_line(", ".join(section["files"]))
    body = f"<h1>{one_line(name)}</h1><p>{files}</p>{verdicts}<table>{rows}</table><ul>{remarks}</ul>"
    return document(name, f"{body}\n<h2>Each lobe</h2><ul>{links}</ul>")
