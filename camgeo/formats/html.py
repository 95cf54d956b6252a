"""The page on all other files of a run, and the constructions that it shows over a mechanism; HTML."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.output.extension import Making
from camgeo.registry.formats import Format
from camgeo.schema.errors import quote, suggestion
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, either
from camgeo.schema.yaml_source import Scalar, describe, join

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.extension import RunResults
    from camgeo.output.job import MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node

OVERLAYS = {
    "instant-centres": "plate",
    "chord-polygon": "swings",
    "isoptic": "swings",
    "pedal": "swings",
    "evolute": "",
}
"""Overlays of a page, each with the offer of the cam that it needs, empty for none; a linkage has the evolute alone."""


def _read_overlays(reader: Reader, field: Field, node: Node, path: str) -> tuple[str, ...]:
    """Names of the overlays listed that the cam's family has, each once; the faults of others are noted."""
    linked, unknown = bool(reader.kinds["linkage"]), not reader.kinds["cam"]  # whose fault is noted already
    offers = frozenset(OVERLAYS.values()) if unknown else reader.offers
    available = [name for name, need in OVERLAYS.items() if not need or (need in offers and not linked)]
    names: list[str] = []
    for i, item in enumerate(reader.items(field, node, path, len(OVERLAYS))):
        word = item.text if isinstance(item, Scalar) else ""
        if word in names:
            reader.fault(item.mark, join(path, i), "the same overlay twice", quote(word), "leave one out")
        elif word in available:
            names.append(word)
        elif word in OVERLAYS:
            owner = "a linkage" if linked else f"a cam of kind {reader.kinds['cam']}"
            remedy = f"give {either(tuple(available))}"
            reader.fault(item.mark, join(path, i), f"an overlay that {owner} does not have", quote(word), remedy)
        else:
            remedy = suggestion(word, tuple(available)) or f"give {either(tuple(available))}"
            reader.fault(item.mark, join(path, i), "no overlay", describe(item), remedy)
    return tuple(names)


_OVERLAYS = Field(
    "overlays",
    Kind.OWN,
    "constructions shown over the mechanism, which turn with it, as far as its family has them",
    default="none",
    form=OwnForm(
        "a list of overlays",
        f"a list of {either(tuple(OVERLAYS), 'and')}",
        _read_overlays,
        lambda _: {
            "type": "array",
            "items": {"enum": list(OVERLAYS)},
            "minItems": 1,
            "maxItems": len(OVERLAYS),
            "uniqueItems": True,
        },
    ),
)


def _summarise(run: RunResults, request: FileRequest, path: Path) -> MadeFiles:
    """Write the page on a run, also on one that makes no cam."""
    from camgeo.measures.file_result import FileResult
    from camgeo.output.job import MadeFiles
    from camgeo.output.pipeline import content_of
    from camgeo.report.document import document
    from camgeo.report.page.page import page

    content = content_of(run.recipe, run.design, run.findings, run.clock)
    with run.clock.stage("write html"):
        path.write_bytes(page(run.recipe, content, document(run.recipe, run.findings)).encode("utf-8"))
    return MadeFiles((FileResult(path, request),))


FORMAT = Format(
    name="html",
    options=FieldTable((_OVERLAYS,)),
    contour=False,
    part=False,
    summary=True,
)
MAKING = Making(summarise=_summarise)
