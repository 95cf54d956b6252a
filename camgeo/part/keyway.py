"""A keyway in a round bore, by a standard or by its own sizes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.bore import check_bore, diameter_of
from camgeo.part.din6885 import LEAST, MOST, key_for
from camgeo.part.feature import Feature, angle, check_below, size_words
from camgeo.part.iso286 import KEYWAYS, deviations
from camgeo.schema.errors import quote
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, length
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Scalar
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.fit.pieces import ArcSpline
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

STANDARDS = ("din6885", "jis-b1301")  # which have the same widths and depths


@dataclass(frozen=True)
class Keyway:
    """Keyway in a round bore, mm: `depth` is t2 of DIN 6885, from the bore's circle to the keyway's bottom.

    `at` is the direction of its middle, rad. With `standard`, width and depth are those of DIN 6885 for the bore, and
    `fit` is the tolerance class of its width, empty where none is stated; `deeper` is then the upper deviation of
    `depth`. Files have the nominal sizes.
    """

    width: float
    depth: float
    at: float = 0.0
    standard: bool = False
    fit: str = ""
    deeper: float = 0.0

    @property
    def wider(self) -> tuple[float, float]:
        """Lower and upper deviation of its width by its tolerance class, mm; raises KeyError without a class."""
        return deviations(KEYWAYS[self.fit], self.width)


TABLE = FieldTable(
    (
        Field("standard", Kind.CHOICE, "width and depth by the bore, from DIN 6885-1 or JIS B 1301", choices=STANDARDS),
        Field(
            "fit", Kind.CHOICE, "tolerance class of the width, ISO 286", default="none stated", choices=tuple(KEYWAYS)
        ),
        length("width", "width b of the key"),
        length("depth", "depth t2 into the hub, from the bore's circle to the floor"),
        angle("at", "direction of the keyway's middle"),
    ),
    alternatives=(("standard", ("fit",)), ("width", ("depth",))),
)


def read_keyway(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Values of a keyway, from the word of a standard or from a mapping; None where it is faulty, which is noted."""
    if isinstance(node, Scalar):
        if node.text in STANDARDS:
            return {"standard": node.text}
        reader.fault(node.mark, path, "unknown keyway", quote(node.text), reader.wanted(field))
        return None
    return reader.mapping(field, node, path)


FORM = OwnForm(
    "a keyway",
    "din6885, jis-b1301, or a mapping such as {width: 4, depth: 1.8}",
    read_keyway,
    lambda field: {"anyOf": [{"enum": list(STANDARDS)}, table_schema(field.inner)]},
)


def _check(part: Values, reader: Reader) -> None:
    keyway, bore = part["keyway"], diameter_of(part)
    if bore is None:
        return
    if "standard" in keyway and key_for(bore) is None:
        low, high = LEAST / reader.mm, MOST / reader.mm
        remedy = f"the standard has bores from {low:.6g} to {high:.6g} {reader.units}; give width and depth"
        reader.fault_at("part.keyway", "no key of DIN 6885 for this bore", size_words(bore, reader), remedy)
    check_below(reader, "part.keyway.width", keyway.get("width"), bore, "the bore's diameter")


def _make(values: Values, part: Values) -> Keyway:
    if "width" in values:
        return Keyway(**values)
    bore = diameter_of(part)
    row = None if bore is None else key_for(bore)
    assert row is not None  # else the recipe has a fault
    fit = values.get("fit", "")
    return Keyway(row.width, row.hub, values.get("at", 0.0), standard=True, fit=fit, deeper=row.deeper if fit else 0.0)


def _bore(keyway: Keyway, radius: float) -> ArcSpline:
    from camgeo.part.shapes import keyed

    return keyed(radius, keyway.width, keyway.depth, keyway.at)


def _metric(keyway: Keyway) -> str:
    size = f"metric keyway of DIN 6885, {keyway.width:.4g} mm wide"
    return f"{size}; give part.keyway its width and depth for an inch key" if keyway.standard else ""


FEATURE = Feature(
    Keyway,
    Field("keyway", Kind.OWN, "keyway in a round bore", default="none", table=TABLE, form=FORM),
    needs=(("bore", "a keyway is cut into a bore"),),
    of_ring=False,
    locates=True,
    check=_check,
    make=_make,
    bore=_bore,
    metric=_metric,
)


def check_round(part: Values, reader: Reader) -> None:
    """Note faults of the bore of a part whose one feature is a keyway, and of the keyway."""
    name = FEATURE.name
    check_bore(part, reader, [name] if name in part else [])
    if name in part:
        for key, why in FEATURE.needs:
            if key not in part:
                reader.fault_at(f"part.{name}", f"needs part.{key}: {why}", None, f"give part.{key}")
        FEATURE.check(part, reader)
