"""Segments of a motion in a recipe, with their laws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from camgeo.schema.errors import shown, suggestion
from camgeo.schema.fields import MOST, MOST_SEGMENTS, Field, Form, Kind, Table, either, mapping
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Scalar, join
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    import kin.law.programme
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.sources.programme import Step


@dataclass(frozen=True)
class SccaLaw:
    """A member of the SCCA family: shares of sine and constant acceleration, and of constant velocity."""

    sine: float = 0.0
    constant: float = 0.0
    velocity: float = 0.0


MATCH = "match"  # the law that takes its neighbours' velocity and acceleration


@dataclass(frozen=True)
class MotionSegment:
    """One segment of a motion programme.

    `over` in rad; `stroke` in mm for a plate, in rad for a follower that swings: of a rise, a return and a rise_fall
    their height, of `to` the displacement at the end, 0 for a dwell. `law` is a name, the coefficients c0, c1, ... of
    a polynomial in u, or shares. `formula` is a displacement in u, its values times `scale`. `at_end` holds v and a at
    the end of a matched segment, per rad.
    """

    kind: Literal["rise", "return", "to", "rise_fall", "displacement", "dwell"]
    over: float
    stroke: float = 0.0
    law: str | tuple[float, ...] | SccaLaw | None = None
    split: float | None = None
    at_end: tuple[float, float] | None = None
    formula: str = ""
    scale: float = 1.0

    def step(self, field: str = "motion") -> Step:
        """Give the segment with its law looked up, as `kin.law.sources.programme` takes it.

        Raises kin's IntentError where a split or an end does not go with the law, with its field.
        """
        from kin.law.programme import IntentError
        from kin.law.sources.laws import split
        from kin.law.sources.programme import Dwell, Given, Matched, Move, RiseAndFall, State

        if self.kind == "dwell":
            return Dwell(self.over)
        if self.kind == "rise_fall":
            return RiseAndFall(self.over, self.stroke)
        if self.kind == "displacement":
            from kin.law.formula.formula import Formula

            return Given(self.over, Formula(self.formula, ("u",)), self.scale)
        by = {"rise": self.stroke, "return": -self.stroke}.get(self.kind)
        to = self.stroke if self.kind == "to" else None
        if self.law == MATCH:
            if self.split is not None:
                raise IntentError("a matched segment takes no split", f"{field}.split")
            state = None if self.at_end is None else State(*self.at_end)
            return Move(self.over, Matched(at_end=state), by, to)
        if self.at_end is not None:
            raise IntentError("only a matched segment takes a state at its end", f"{field}.at_end")
        law = self._law(field)
        return Move(self.over, law if self.split is None else split(law, self.split, field), by, to)

    def _law(self, field: str) -> kin.law.programme.Law:
        from kin.law.programme import polynomial_law
        from kin.law.sources.laws import named, scca

        if isinstance(self.law, str):
            return named(self.law)
        if isinstance(self.law, SccaLaw):
            return scca(self.law.sine, self.law.constant, self.law.velocity, f"{field}.law.scca")
        return polynomial_law(self.law or (), f"{field}.law")


_LAW = Table(
    (
        Field("polynomial", Kind.NUMBERS, "coefficients c0, c1, ... of u, from 0 to 1 as u does"),
        mapping(
            "scca",
            "sine, constant and cosine acceleration by their shares, and constant velocity",
            Field("sine", Kind.NUMBER, "share of sine in the accelerating half", default="0", at_least=0, at_most=1),
            Field("constant", Kind.NUMBER, "share of constant acceleration", default="0", at_least=0, at_most=1),
            Field(
                "velocity", Kind.NUMBER, "share of the segment at constant velocity", default="0", at_least=0, at_most=1
            ),
        ),
    ),
    alternatives=(("polynomial", ()), ("scca", ())),
)


def read_law(reader: Reader, field: Field, node: Node, path: str) -> str | tuple[float, ...] | SccaLaw | None:
    """Read the name of a motion law, the coefficients of a polynomial, or the shares of a member of the SCCA family."""
    from kin.law.programme import IntentError, polynomial_law
    from kin.law.sources.laws import NAMES, scca

    names = (*NAMES, MATCH)
    if isinstance(node, Scalar):
        if node.text in names:
            return node.text
        remedy = suggestion(node.text, names) or f"give {either(names)}, {{polynomial: [...]}} or {{scca: {{...}}}}"
        reader.fault(node.mark, path, "unknown motion law", shown(node.text), remedy)
        return None
    values = reader.mapping(field, node, path) or {}
    if "scca" in values:
        shares = SccaLaw(**values["scca"])
        try:
            scca(shares.sine, shares.constant, shares.velocity)
        except IntentError as error:
            remedy = "let `sine` and `constant` together be at most 1, and `velocity` below 1"
            reader.fault(node.mark, join(path, "scca"), error.message, None, remedy)
            return None
        return shares
    coefficients: tuple[float, ...] | None = values.get("polynomial")
    if coefficients is None:
        return None
    try:
        polynomial_law(coefficients)
    except IntentError as error:
        reader.fault(node.mark, path, error.message, None, "let c0 be 0 and the sum of all coefficients 1")
        return None
    return coefficients


def read_segments(
    reader: Reader, field: Field, node: Node, path: str, stroke: Kind = Kind.LENGTH
) -> tuple[MotionSegment, ...] | None:
    """Read the segments of a motion, or None where one is faulty; `field` has the table of a segment."""
    found = len(reader.errors)
    items = reader.items(field, node, path, MOST_SEGMENTS)
    segment = Field("", Kind.TABLE, "", table=field.table)
    values = [reader.field(segment, item, join(path, i)) for i, item in enumerate(items)]
    if len(reader.errors) > found:
        return None
    for i, value in enumerate(values):
        for key in ("split", "at_end"):
            if key in value and "law" not in value:
                reader.fault_at(f"{path}[{i}].{key}", "needs a law", None, "leave it out")
    return tuple(_segment(value, reader.scale(stroke)) for value in values)


def _law_schema(field: Field) -> Schema:
    from kin.law.sources.laws import NAMES

    return {"anyOf": [{"enum": [*NAMES, MATCH]}, table_schema(field.inner)]}


def segments_schema(field: Field) -> Schema:
    """Make the JSON schema of a list of segments."""
    return {"type": "array", "items": table_schema(field.inner), "minItems": 1, "maxItems": MOST_SEGMENTS}


LAW = Form("a motion law", "a motion law", read_law, _law_schema)


def segment_table(stroke: Kind, over: int = 180) -> Table:
    """Make the table of a segment whose stroke is a length or an angle; `over` degrees are the longest."""
    most = 180 if stroke is Kind.ANGLE else MOST
    strokes = [Field(key, stroke, f"stroke of the {key}", above=0, at_most=most) for key in ("rise", "return")]
    angle = Field("over", Kind.ANGLE, "shaft angle of the segment", above=0, at_most=over)
    return Table(
        (
            *strokes,
            Field("to", stroke, "displacement at the end of the segment", at_least=-most, at_most=most),
            Field("rise_fall", stroke, "height of a rise and fall by 64 u³ (1 - u)³", above=0, at_most=most),
            Field(
                "displacement",
                Kind.FORMULA,
                "displacement from the segment's start, u from 0 to 1 over the segment",
                variable="u",
                unit=stroke,
            ),
            replace(angle, name="dwell", about="shaft angle of a rest"),
            angle,
            Field(
                "law",
                Kind.OWN,
                "motion law by name, match, {polynomial: [c0, c1, ...]} or {scca: ...}",
                table=_LAW,
                form=LAW,
            ),
            Field(
                "split",
                Kind.NUMBER,
                "share of the segment that accelerates",
                default="0.5",
                at_least=0.01,
                at_most=0.99,
            ),
            mapping(
                "at_end",
                "state at the end of a segment with law match",
                Field("v", stroke, "velocity there, per radian", default="0", at_least=-MOST, at_most=MOST),
                Field("a", stroke, "acceleration there, per radian²", default="0", at_least=-MOST, at_most=MOST),
            ),
        ),
        alternatives=(
            *((key, ("over", "law")) for key in ("rise", "return", "to")),
            ("rise_fall", ("over",)),
            ("displacement", ("over",)),
            ("dwell", ()),
        ),
    )


def _segment(segment: Values, scale: float) -> MotionSegment:
    if "dwell" in segment:
        return MotionSegment("dwell", segment["dwell"])
    if "displacement" in segment:
        return MotionSegment("displacement", segment["over"], formula=segment["displacement"], scale=scale)
    kinds: tuple[Literal["rise", "return", "to", "rise_fall"], ...] = ("rise", "return", "to", "rise_fall")
    kind = next(kind for kind in kinds if kind in segment)
    end = segment.get("at_end")
    state = None if end is None else (end.get("v", 0.0), end.get("a", 0.0))
    return MotionSegment(kind, segment["over"], segment[kind], segment.get("law"), segment.get("split"), state)
