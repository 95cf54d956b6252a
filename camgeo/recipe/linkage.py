"""The linkage of a recipe, its dyads and the dwells of its output."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeVar

from camgeo.schema.fields import MOST, MOST_DYADS, Field, FieldTable, Kind, OwnForm, coordinate, either, length
from camgeo.schema.json_schema import one_of_schema, table_schema
from camgeo.schema.readers import form_of_kinds
from camgeo.schema.yaml_source import Scalar, describe, join
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    import kin.linkage.dyad
    import kin.linkage.four_bar
    from camgeo.cams.family import Cam
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


MOST_TRACES = 20  # points that a recipe may trace
Links = TypeVar("Links", bound="kin.linkage.four_bar.Linkage | kin.linkage.dyad.Dyad")


class TracedPoint(NamedTuple):
    """A point (x, y), mm, in the axes of the link `on`: coupler, output, or dyads[k] for that dyad's output link."""

    on: str
    point: tuple[float, float]

    def name(self, mm: float) -> str:
        """Name of the point's path, with coordinates in a unit of `mm` mm."""
        x, y = (f"{value / mm:.6g}" for value in self.point)
        return f"path of {self.on} [{x}, {y}]"


class Linkage(NamedTuple):
    """The links of a recipe: the word of their kind, the `loop` that the frame drives, and the dyads in their order.

    The output link is the last dyad's, or the loop's without dyads. `traces` are points whose paths are shown.
    """

    kind: str
    loop: kin.linkage.four_bar.Linkage
    dyads: tuple[kin.linkage.dyad.Dyad, ...] = ()
    traces: tuple[TracedPoint, ...] = ()

    def shaped(self, cam: Cam) -> Cam:
        """The cam with the links of an inverted slider crank, by which its shape follows from the frame's swing.

        It is the cam itself for another kind of linkage, and for a cam whose recipe gives no swing.
        """
        from kin.linkage.four_bar import InvertedSliderCrank
        from kin.linkage.loop import side_of

        loop = self.loop
        if not isinstance(loop, InvertedSliderCrank):
            return cam
        return cam.in_frame(loop.ground, loop.rocker - loop.joint_offset, side_of(loop.assembly))


def with_other_lengths(linkage: Linkage, loop: int, factor: float) -> Iterator[tuple[str, float, Linkage]]:
    """For each length of a loop, that length times `factor`: path below `linkage`, new length, mm, and the linkage.

    Loop 0 is the linkage's own, loop k its k-th dyad. Lengths are rounded to six digits; a length of 0 is passed over.
    """
    if loop == 0:
        for name, size, changed in _with_other(linkage.loop, factor):
            yield name, size, linkage._replace(loop=changed)
        return
    dyads = linkage.dyads
    for name, size, dyad in _with_other(dyads[loop - 1], factor):
        changed_dyads = (*dyads[: loop - 1], dyad, *dyads[loop:])
        yield f"dyads[{loop - 1}].{name}", size, linkage._replace(dyads=changed_dyads)


def _with_other(part: Links, factor: float) -> Iterator[tuple[str, float, Links]]:
    """Name, such as links[0], new length and changed part, for each length of a loop or dyad times a factor."""
    for name in part.lengths:
        key, _, index = name.partition("[")
        own = getattr(part, key)
        size = float(f"{factor * (own[int(index[0])] if index else own):.6g}")
        if size > 0.0:
            pair = tuple(size if str(i) == index[0] else length for i, length in enumerate(own)) if index else ()
            changes: dict[str, Any] = {key: pair or size}
            yield name, size, replace(part, **changes)


def output_slides(linkage: Linkage) -> bool:
    """Whether the output of a linkage, by its last dyad if it has dyads, is a length and not an angle."""
    return (linkage.dyads[-1] if linkage.dyads else linkage.loop).unit == "mm"


@dataclass(frozen=True)
class DwellLimits:
    """Dwells of a linkage's output: within a dwell the output stays in a range `band`, rad, or mm where it slides.

    `at_least` is the least length that the longest dwell must have, rad of the angle `over`, the shaft's or the
    relative angle of cam and frame; None without a check.
    """

    band: float
    at_least: float | None = None
    over: Literal["shaft", "relative"] = "shaft"


def read_dyads(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read the list of dyads, each by the table of its kind; None where a dyad is faulty."""
    dyad = Field("", Kind.OWN, "", form=_DYAD)
    items = reader.items(field, node, path, MOST_DYADS)
    values = [reader.one_of(dyad, item, join(path, i)) for i, item in enumerate(items)]
    return [value for value in values if value is not None] if None not in values else None


def _dyads_schema(_: Field) -> Schema:
    return {"type": "array", "items": one_of_schema("dyad", DYADS), "minItems": 1, "maxItems": MOST_DYADS}


_ASSEMBLY = Field(
    "assembly",
    Kind.CHOICE,
    "which of the two ways to put the links together; open is Figure 7 of AS 2023",
    default="open",
    choices=("open", "crossed"),
)


_ON = Field(
    "on",
    Kind.CHOICE,
    "the link that carries the dyad's first joint; previous is the output link of the dyad before",
    default="output",
    choices=("output", "coupler", "previous"),
)


_POINT = Field("point", Kind.POINT, "the first joint [x, y] in the axes of that link", required=True)


_PIVOT = Field("ground", Kind.POINT, "the fixed pivot [x, y] in the fixed axes, the shaft at [0, 0]", required=True)


DYADS: dict[str, FieldTable] = {
    "rrr": FieldTable(
        (
            _ON,
            _POINT,
            _PIVOT,
            Field("links", Kind.PAIR, "lengths of the two links, the one on the fixed pivot last", required=True),
            replace(
                _ASSEMBLY, about="open: seen from the fixed pivot towards the first joint, the second lies to the left"
            ),
        )
    ),
    "rrp": FieldTable(
        (
            _ON,
            _POINT,
            length("link", "length of the link from the first joint to the slide", required=True),
            Field(
                "through", Kind.POINT, "a point [x, y] of the slide's line, from which it is measured", required=True
            ),
            Field("direction", Kind.ANGLE, "direction of the slide's line", required=True, at_least=-360, at_most=360),
            replace(_ASSEMBLY, about="open: of two places on the line the slide takes the one farther along it"),
        )
    ),
    "rpr": FieldTable(
        (
            _ON,
            _POINT,
            _PIVOT,
            coordinate(
                "offset",
                "distance of the slot's line from the fixed pivot, positive where the block lies to its left",
                default="0",
            ),
        )
    ),
}


_DYAD = form_of_kinds("dyad", DYADS)
_LIST = OwnForm(
    "a list of dyads",
    "a list of dyads such as [{kind: rrr, point: [80, 0], ground: [140, 80], links: [100, 30]}]",
    read_dyads,
    _dyads_schema,
    tables=DYADS,
    group="a dyad of kind",
)


_DYADS = Field("dyads", Kind.OWN, "further links; the last dyad's output is the linkage's", default="none", form=_LIST)


_LINK = re.compile(r"coupler|output|dyads\[[0-9]+\]")


def _read_link(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Read the name of a moving link; None after a fault."""
    if isinstance(node, Scalar) and _LINK.fullmatch(node.text):
        return node.text
    reader.fault(node.mark, path, "no moving link", describe(node), reader.wanted(field))
    return None


def read_traces(reader: Reader, field: Field, node: Node, path: str) -> list[TracedPoint] | None:
    """Read the list of points to be traced; None where a point is faulty."""
    item = Field("", Kind.TABLE, "", table=_TRACE)
    values = [
        reader.field(item, point_node, join(path, i))
        for i, point_node in enumerate(reader.items(field, node, path, MOST_TRACES))
    ]
    if any(value is None or len(value) < len(_TRACE.fields) for value in values):
        return None
    return [TracedPoint(value["on"], value["point"]) for value in values]


_TRACE = FieldTable(
    (
        Field(
            "on",
            Kind.OWN,
            "the link that carries the point; dyads[k], from 0, is the output link of a dyad",
            required=True,
            form=OwnForm(
                "a link",
                "coupler, output or dyads[k]",
                _read_link,
                lambda _: {"type": "string", "pattern": f"^({_LINK.pattern})$"},
            ),
        ),
        Field("point", Kind.POINT, "the point [x, y] in the axes of that link", required=True),
    )
)
_TRACES = Field(
    "trace",
    Kind.OWN,
    "points of moving links whose paths are shown: on the page, in DXF for reference, in tables",
    default="none",
    table=_TRACE,
    form=OwnForm(
        "a list of points",
        "a list of points such as [{on: coupler, point: [40, 10]}]",
        read_traces,
        lambda _: {"type": "array", "items": table_schema(_TRACE), "minItems": 1, "maxItems": MOST_TRACES},
    ),
)


_GROUND = length("ground", "distance r1 of the fixed pivot from the shaft, along +x", required=True)


_COUPLER = length("coupler", "length r3 from the middle of the frame's side to the joint", required=True)


_JOINT_OFFSET = coordinate(
    "joint_offset",
    "distance of the joint from the frame's mid-line, positive towards the face whose lift the cam's law gives",
    default="0",
)


LINKAGES: dict[str, FieldTable] = {
    "four-bar": FieldTable(
        (
            _GROUND,
            _COUPLER,
            length("rocker", "length r4 of the rocker", required=True),
            _JOINT_OFFSET,
            _ASSEMBLY,
            _DYADS,
            _TRACES,
        )
    ),
    "inverted-slider-crank": FieldTable(
        (
            _GROUND,
            Field(
                "rocker",
                Kind.LENGTH,
                "length r4 of the rocker, from its pivot square to the slide; 0 makes an oscillating yoke",
                required=True,
                at_least=0,
                at_most=MOST,
            ),
            replace(_JOINT_OFFSET, about=_JOINT_OFFSET.about.replace("the joint", "the slide's line")),
            _ASSEMBLY,
            _DYADS,
            _TRACES,
        )
    ),
    "slider-crank": FieldTable(
        (
            _COUPLER,
            coordinate("offset", "distance of the slide's line from the shaft, along +y", required=True),
            _JOINT_OFFSET,
            _ASSEMBLY,
            _DYADS,
            _TRACES,
        )
    ),
}


TURNING = ("inverted-slider-crank",)  # kinds of linkage whose frame may be given a swing, from which the lift follows
SLIDING = ("slider-crank", "rrp")  # kinds of linkage and of dyad whose output is a length


LINKAGE = form_of_kinds("linkage", LINKAGES, "linkage of kind")


DWELL = (
    Field(
        "band",
        Kind.OUTPUT,
        "greatest less least output within a dwell, in degrees, or a length where it slides",
        required=True,
        above=0,
        at_most=MOST,
    ),
    Field("at_least", Kind.ANGLE, "a check: least length of the longest dwell", default="none", above=0, at_most=360),
    Field(
        "over",
        Kind.CHOICE,
        "the angle that the check takes: the shaft's, or the cam's against the frame",
        default="shaft",
        choices=("shaft", "relative"),
    ),
)


def check_linkage(values: Values, reader: Reader) -> None:
    """Note the faults between a linkage, its dwells and the cam that drives it."""
    swings = "swing" in values.get("cam", {})  # as the cam's kind has that key
    if swings and reader.kinds["linkage"] not in TURNING:
        remedy = "give linkage: {kind: inverted-slider-crank, ground: 80, rocker: 0}, or motion in its place"
        reader.fault_at("cam.swing", "needs a linkage of kind inverted-slider-crank", None, remedy)
    if "linkage" not in reader.marks:
        for path in ("dwell", "verify.output_error"):
            if path in reader.marks:
                reader.fault_at(path, "needs a linkage", None, "give a linkage, or leave it out")
        return
    if reader.kinds["cam"] and "plate" not in reader.offers:
        remedy = "a frame around a cam of kind support or constant-breadth drives it"
        reader.fault_at("linkage", f"cannot be combined with a cam of kind {reader.kinds['cam']}", None, remedy)
    for part, harmonics in values.get("cam", {}).get("fourier", {}).items():
        for j, value in harmonics if part in {"cos", "sin"} else ():
            if j % 2 == 0 and value:
                remedy = "a frame needs constant breadth: odd harmonics alone"
                reader.fault_at(f"cam.fourier.{part}", "an even harmonic under a linkage", str(j), remedy)
    dyads: list[Values] = values.get("linkage", {}).get("dyads", [])
    traces: list[TracedPoint] = values.get("linkage", {}).get("trace", [])
    links = ("coupler", "output", *(f"dyads[{k}]" for k in range(len(dyads))))
    for i, trace in enumerate(traces):
        if trace.on not in links:
            reader.fault_at(f"linkage.trace[{i}].on", "there is no such link", f"'{trace.on}'", f"give {either(links)}")
    if dyads and dyads[0].get("on") == "previous":
        remedy = "give output or coupler"
        reader.fault_at("linkage.dyads[0].on", "there is no dyad before the first", "'previous'", remedy)


def build_linkage(linkage: Values) -> Linkage:
    """Build the linkage from values of a recipe without faults."""
    from kin.linkage.dyad import RPR, RRP, RRR
    from kin.linkage.four_bar import FourBar, InvertedSliderCrank, SliderCrank

    loops = {"four-bar": FourBar, "inverted-slider-crank": InvertedSliderCrank, "slider-crank": SliderCrank}
    dyads = {"rrr": RRR, "rrp": RRP, "rpr": RPR}
    kind, loop_values = linkage["kind"], {key: value for key, value in linkage.items() if key not in {"dyads", "trace"}}
    dyad_values = ({"on": "output", **dyad} for dyad in linkage.get("dyads", []))
    traces = tuple(linkage.get("trace", ()))
    return Linkage(kind, _of_kind(loops, loop_values), tuple(_of_kind(dyads, dyad) for dyad in dyad_values), traces)


def _of_kind(classes: Mapping[str, Callable[..., Links]], values: Values) -> Links:
    return classes[values["kind"]](**{key: value for key, value in values.items() if key != "kind"})
