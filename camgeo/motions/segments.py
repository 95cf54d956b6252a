"""Segments of a motion in a recipe, with their laws."""

from __future__ import annotations

import math
from functools import cache, lru_cache, partial
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from camgeo.motions.inputs import PART
from camgeo.motions.lift_table import COLUMNS, TABLE, read_rows
from camgeo.schema.errors import quote, suggestion
from camgeo.schema.fields import MOST, MOST_SEGMENTS, Field, FieldTable, Kind, OwnForm, mapping
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.yaml_source import Scalar, Sequence, describe, join
from kin.numeric.lengths import input_number, input_words
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.motions.inputs import Axes, Input
    from camgeo.motions.lift_table import Rows
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.normalised import Law
    from kin.law.sources.programme import Step


@dataclass(frozen=True)
class SccaLaw:
    """A member of the SCCA family, by the shares of its accelerating half that have sine or constant acceleration.

    `velocity` is the share of the segment at constant velocity.
    """

    sine: float = 0.0
    constant: float = 0.0
    velocity: float = 0.0

    def law(self, over: float, field: str) -> Law:  # noqa: ARG002 - its shares are of any angle
        """The law over the unit angle; raises IntentError, at a path below `field`, for shares out of bounds."""
        from kin.law.sources.laws import scca

        return scca(self.sine, self.constant, self.velocity, f"{field}.scca")


@dataclass(frozen=True)
class UniformLaw:
    """Constant velocity between two blends, at the begin and the end, rad or mm of the input."""

    blend: tuple[float, float]

    def law(self, over: float, field: str) -> Law:
        """The law of a segment over `over`, rad or mm; raises IntentError, below `field`, for longer blends."""
        from kin.law.normalised import IntentError
        from kin.law.sources.laws import blended

        whole, both = (round(math.degrees(angle), _PLACES) for angle in (over, sum(self.blend)))
        if both > whole:
            whole_words = input_number(over, "g")
            raise IntentError(
                f"both blends together take {input_words(sum(self.blend), 'g')}, their segment {whole_words}; "
                f"give blends of up to {whole_words}",
                f"{field}.uniform.blend",
            )
        first, last = (angle / over for angle in self.blend)
        return blended(first, last, f"{field}.uniform.blend")


@dataclass(frozen=True)
class PointsLaw:
    """Points (u, s) of a spline, shares of the segment's angle and stroke, from (0, 0) to (1, 1)."""

    points: tuple[tuple[float, float], ...]

    def law(self, over: float, field: str) -> Law:  # noqa: ARG002 - u is a share of any angle
        """Law through the points, a spline; raises IntentError for points through which no law passes."""
        from kin.law.sources.laws import through_points

        return through_points(self.points, f"{field}.points")


@dataclass(frozen=True)
class TableLaw:
    """Rows (u, s) of a table, shares of the segment's angle and stroke, each kept within `reading`, a share of s.

    A `reading` of None is each row's own rounding.
    """

    file: str
    rows: Rows
    reading: float | None

    def law(self, over: float, field: str) -> Law:  # noqa: ARG002 - u is a share of any angle
        """Law through the rows, within the reading; raises IntentError for rows from which no law follows."""
        return _law_of_rows(self, f"{field}.table")


@lru_cache(maxsize=8)
def _law_of_rows(table: TableLaw, field: str) -> Law:
    from kin.law.normalised import IntentError
    from kin.law.sources.laws import from_rows

    try:
        return from_rows(table.rows.samples(), table.reading, field)
    except IntentError as error:
        raise IntentError(f"{table.file}, {error.message}", field) from error


OwnLaw: TypeAlias = SccaLaw | UniformLaw | PointsLaw | TableLaw
_PLACES = 9  # decimals of a degree: more are rounding of sums of angles
DEFAULT_LAW = "modified-sine"  # of a segment without one
MATCH = "match"  # the law that takes its neighbours' velocity and acceleration


@dataclass(frozen=True)
class MotionSegment:
    """One segment of a motion programme.

    over     its extent, rad or mm of the input; 0 while a word stands in its place
    stroke   mm, or rad for a follower that swings: height of a rise, return or rise_fall, displacement at the end for
             `to`, 0 for a dwell
    law      a name, the coefficients c0, c1, ... of a polynomial in u, or a law of the recipe's own
    split    share of the segment that accelerates; None for the law's own
    at_end   velocity and acceleration at the end of a matched segment, by the input; None for rest
    formula  displacement in u from 0 to 1; its values times `scale` are mm or rad
    free     the word in place of its angle: least for the least that the limits allow, rest for the rest of the turn
    """

    kind: Literal["rise", "return", "to", "rise_fall", "displacement", "dwell"]
    over: float
    stroke: float = 0.0
    law: str | tuple[float, ...] | OwnLaw | None = None
    split: float | None = None
    at_end: tuple[float, float] | None = None
    formula: str = ""
    scale: float = 1.0
    free: Literal["", "least", "rest"] = ""

    def step(self, field: str = "motion") -> Step:
        """The segment with its law, as `kin.law.sources.programme` takes it.

        Raises kin's IntentError, at a path below `field`, where a split or a state at the end does not go with the law,
        and where the law cannot be made.
        """
        from kin.law.normalised import IntentError
        from kin.law.sources.laws import split
        from kin.law.sources.programme import Dwell, Given, JointState, Matched, Move, RiseAndFall

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
            state = None if self.at_end is None else JointState(*self.at_end)
            return Move(self.over, Matched(at_end=state), by, to)
        if self.at_end is not None:
            raise IntentError("only a matched segment takes a state at its end", f"{field}.at_end")
        law = self._law(field)
        return Move(self.over, law if self.split is None else split(law, self.split, field), by, to)

    def _law(self, field: str) -> Law:
        from kin.law.normalised import polynomial_law
        from kin.law.sources.laws import named

        if isinstance(self.law, str):
            return named(self.law)
        if self.law is None or isinstance(self.law, tuple):
            return polynomial_law(self.law or (), f"{field}.law")
        return self.law.law(self.over, f"{field}.law")


LEAST: Literal["least"] = "least"  # in place of the angle of a segment: the least that the recipe's limits allow
REST: Literal["rest"] = "rest"  # in place of the angle of a dwell: what the other segments leave of the turn


def _angle_or(word: str, about: str, field: Field) -> Field:
    """The field of an angle, which takes `word` too; `about` says in texts what the word stands for."""

    def read(reader: Reader, field: Field, node: Node, path: str) -> float | str | None:
        if isinstance(node, Scalar) and node.text == word:
            return word
        value: float | None = reader.field(replace(field, form=None), node, path)
        return value

    wanted = f"{field.wanted()}, or {word} for {about}"
    return replace(field, form=OwnForm(f"an angle, or {word}", wanted, read, partial(_angle_or_schema, word)))


def _angle_or_schema(word: str, field: Field) -> Schema:
    return {"anyOf": [*number_schema(replace(field, form=None))["anyOf"], {"const": word}]}


def _read_blend(part: Field, reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Read the extents of two blends, each of the field `part`, or one for both, rad or mm; None after a fault."""
    if isinstance(node, Scalar):
        extent: float | None = reader.field(part, node, path)
        return None if extent is None else (extent, extent)
    items = reader.items(field, node, path, 2)
    extents = [reader.field(part, item, join(path, i)) for i, item in enumerate(items)]
    if len(extents) == 1:
        reader.fault(node.mark, path, f"not two {_plural(part)}", None, reader.wanted(field))
    return None if len(extents) < 2 or None in extents else (extents[0], extents[1])


def _blend(over: Input) -> OwnForm[Any]:
    """Form of the extents of two blends."""
    part = Field("", over.kind, "", at_least=0, at_most=360 if over.kind is Kind.ANGLE else over.most)

    def schema(_: Field) -> Schema:
        pair = {"type": "array", "items": number_schema(part), "minItems": 2, "maxItems": 2}
        return {"anyOf": [number_schema(part), pair]}

    wanted = f"{part.wanted()}, or two, such as [10, 20]"
    return OwnForm(f"{_plural(part)} of blends", wanted, partial(_read_blend, part), schema)


def _plural(field: Field) -> str:
    return f"{field.kind.value.partition(' ')[2]}s"


MOST_LAW_POINTS = 200


def read_pairs(
    reader: Reader, field: Field, node: Node, path: str, *, parts: tuple[Field, Field], most: int, row: str
) -> tuple[tuple[float, float], ...] | None:
    """Read a list of at most `most` pairs, whose numbers are of the fields `parts`; None where a pair is faulty.

    `row` is the form of a pair in remedies.
    """
    points = []
    for i, item in enumerate(reader.items(field, node, path, most)):
        below = join(path, i)
        if not isinstance(item, Sequence) or len(item.items) != 2:
            reader.fault(item.mark, below, "not a point", describe(item), f"give a list {row}")
            continue
        cells = enumerate(zip(parts, item.items, strict=True))
        points.append(tuple(reader.field(part, cell, join(below, k)) for k, (part, cell) in cells))
    return tuple(points) if points and not any(None in point for point in points) else None


def _read_points(reader: Reader, field: Field, node: Node, path: str) -> tuple[tuple[float, float], ...] | None:
    """Read a list of pairs of numbers from -10 to 10."""
    number = Field("", Kind.NUMBER, "", at_least=-10, at_most=10)
    return read_pairs(reader, field, node, path, parts=(number, number), most=MOST_LAW_POINTS, row="[u, s]")


_POINTS = OwnForm(
    "a list of points",
    "a list of points such as [[0, 0], [0.4, 0.25], [1, 1]]",
    _read_points,
    lambda _: {
        "type": "array",
        "items": {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
        "minItems": 3,
        "maxItems": MOST_LAW_POINTS,
    },
)


@cache
def _law_table(over: Input) -> FieldTable:
    """Table of the keys of a law of the recipe's own."""
    blend = _blend(over)
    return FieldTable(
        (
            Field("polynomial", Kind.NUMBERS, "coefficients c0, c1, ... of u, from 0 to 1 as u does"),
            mapping(
                "scca",
                "sine, constant and cosine acceleration by their shares, and constant velocity",
                Field(
                    "sine", Kind.NUMBER, "share of sine in the accelerating half", default="0", at_least=0, at_most=1
                ),
                Field("constant", Kind.NUMBER, "share of constant acceleration", default="0", at_least=0, at_most=1),
                Field(
                    "velocity",
                    Kind.NUMBER,
                    "share of the segment at constant velocity",
                    default="0",
                    at_least=0,
                    at_most=1,
                ),
            ),
            mapping(
                "uniform",
                "constant velocity between two blends",
                Field(
                    "blend",
                    Kind.OWN,
                    "angles at its beginning and end over which it comes to that velocity and to rest; 0 for none",
                    True,
                    form=blend,
                ),
            ),
            Field("points", Kind.OWN, "points [u, s] from [0, 0] to [1, 1] for a spline to go through", form=_POINTS),
            Field("table", Kind.OWN, "file with a row for each u and its s, from 0;0 to 1;1, or rows", form=TABLE),
            COLUMNS,
            Field(
                "reading",
                Kind.NUMBER,
                "greatest distance of the law from a row of the table",
                default="half the last digit",
                above=0,
                at_most=1,
            ),
        ),
        alternatives=(("polynomial", ()), ("scca", ()), ("uniform", ()), ("points", ()), ("table", ())),
    )


def read_law(reader: Reader, field: Field, node: Node, path: str) -> str | tuple[float, ...] | OwnLaw | None:
    """Read the name of a motion law, the coefficients of a polynomial, or a law of the recipe's own.

    None after a fault.
    """
    from kin.law.normalised import IntentError, polynomial_law
    from kin.law.sources.laws import NAMES, scca

    names = (*NAMES, MATCH)
    if isinstance(node, Scalar):
        if node.text in names:
            return node.text
        own = "{polynomial: [...]}, {scca: {...}}, {uniform: {blend: 10}}, {points: [...]} or {table: s.csv}"
        remedy = suggestion(node.text, names) or f"give {', '.join(names)}, {own}"
        reader.fault(node.mark, path, "unknown motion law", quote(node.text), remedy)
        return None
    faults = len(reader.errors)
    values = reader.mapping(field, node, path) or {}
    if len(reader.errors) > faults:
        return None
    for key in ("columns", "reading"):
        if key in values and "table" not in values:
            reader.fault_at(join(path, key), "cannot stand without a table", None, "leave it out")
            return None
    if "uniform" in values:
        return UniformLaw(values["uniform"]["blend"])
    if "points" in values:
        return _check_law(reader, node, join(path, "points"), PointsLaw(values["points"]))
    if "table" in values:
        return _table_law(reader, node, join(path, "table"), values)
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


def _check_law(reader: Reader, node: Node, path: str, law: OwnLaw) -> OwnLaw | None:
    """The law; where it cannot be made, note the fault and return None."""
    from kin.law.normalised import IntentError

    try:
        law.law(1.0, "law")
    except IntentError as error:
        reader.fault(node.mark, path, error.message, None, "let it lead from 0 to 1, u rising")
        return None
    return law


def _table_law(reader: Reader, node: Node, path: str, values: Values) -> OwnLaw | None:
    """Read the rows of a law now, so that the recipe needs no file any more."""
    raw = {**values, "angle": "radians"}
    rows = read_rows(reader, raw, path, quantity="share", instead="")
    if rows is None:
        return None
    if values["table"].text is not None and "reading" not in values:
        reader.fault_at(path, "rows in a recipe show no last digit", None, "give reading beside them")
        return None
    return _check_law(reader, node, path, TableLaw(values["table"].name, rows, values.get("reading")))


def read_segments(reader: Reader, field: Field, node: Node, path: str, axes: Axes) -> tuple[MotionSegment, ...] | None:
    """Read the segments of a motion; None where a segment is faulty. `field` has the table of a segment."""
    faults = len(reader.errors)
    items = reader.items(field, node, path, MOST_SEGMENTS)
    segment = Field("", Kind.TABLE, "", table=field.table)
    values = [reader.field(segment, item, join(path, i)) for i, item in enumerate(items)]
    if len(reader.errors) > faults:
        return None
    for i, value in enumerate(values):
        for key in ("split", "at_end"):
            if key in value and "law" not in value:
                reader.fault_at(f"{path}[{i}].{key}", "needs a law", None, "leave it out")
    _check_free(reader, values, path)
    if len(reader.errors) > faults:
        return None
    # derivatives are per rad, or per unit of length
    unit = 1.0 if axes.over.kind is Kind.ANGLE else reader.scale(axes.over.kind)
    return tuple(_segment(value, reader.scale(axes.stroke), unit) for value in values)


def _check_free(reader: Reader, values: list[Values], path: str) -> None:
    """Note `least` or `rest` that stands twice, or without the other."""
    least = [f"{path}[{i}].over" for i, value in enumerate(values) if value.get("over") == LEAST]
    rest = [f"{path}[{i}].dwell" for i, value in enumerate(values) if value.get("dwell") == REST]
    for first, *others in filter(None, (least, rest)):
        for other in others:
            reader.fault_at(other, f"{first} is found already", None, "give an angle")
    if least and not rest:
        reader.fault_at(least[0], "no dwell takes the rest of the turn", LEAST, "write one dwell as {dwell: rest}")
    if rest and not least:
        remedy = "give its angle, or one segment with over: least"
        reader.fault_at(rest[0], "every other angle is given", REST, remedy)


def _law_schema(field: Field) -> Schema:
    from kin.law.sources.laws import NAMES

    return {"anyOf": [{"enum": [*NAMES, MATCH]}, table_schema(field.inner)]}


def segments_schema(field: Field) -> Schema:
    """Make the JSON schema of a list of segments."""
    return {"type": "array", "items": table_schema(field.inner), "minItems": 1, "maxItems": MOST_SEGMENTS}


LAW = OwnForm("a motion law", "a motion law", read_law, _law_schema)


@cache
def segment_table(stroke: Kind, over: Input = PART) -> FieldTable:
    """Table of a segment over an input; `stroke` is the kind of its stroke, a length or an angle.

    In a whole turn a word may stand in place of its angle.
    """
    most = 180 if stroke is Kind.ANGLE else MOST
    strokes = [
        Field(key, stroke, f"stroke of the {key}", above=0, at_most=most, slips=slips)
        for key, slips in (("rise", ("raise",)), ("return", ("fall", "drop", "lower")))
    ]
    angle = Field("over", over.kind, f"{over.noun} of the segment", above=0, at_most=over.most)
    dwell = replace(angle, name="dwell", about=f"{over.noun} of a rest", slips=("rest", "hold", "pause"))
    per = "radian" if over.kind is Kind.ANGLE else "unit of length"
    if over.turn:
        angle = _angle_or(LEAST, "the quickest that all limits allow", angle)
        dwell = _angle_or(REST, "what the others leave of the turn", dwell)
    return FieldTable(
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
            dwell,
            angle,
            Field(
                "law",
                Kind.OWN,
                "motion law by name, match, or one of its own",
                default=DEFAULT_LAW,
                table=_law_table(over),
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
                Field("v", stroke, f"velocity there, per {per}", default="0", at_least=-MOST, at_most=MOST),
                Field("a", stroke, f"acceleration there, per {per}²", default="0", at_least=-MOST, at_most=MOST),
            ),
        ),
        alternatives=(
            *((key, ("over", "law")) for key in ("rise", "return", "to")),
            ("rise_fall", ("over",)),
            ("displacement", ("over",)),
            ("dwell", ()),
        ),
    )


def _segment(segment: Values, scale: float, unit: float) -> MotionSegment:
    """Segment of its values; `unit` is the unit of input, rad or mm, over which a state at the end is stated."""
    angle = segment["dwell" if "dwell" in segment else "over"]
    free: Literal["", "least", "rest"] = angle if angle in {LEAST, REST} else ""
    over = 0.0 if free else angle
    if "dwell" in segment:
        return MotionSegment("dwell", over, free=free)
    if "displacement" in segment:
        return MotionSegment("displacement", over, formula=segment["displacement"], scale=scale, free=free)
    kinds: tuple[Literal["rise", "return", "to", "rise_fall"], ...] = ("rise", "return", "to", "rise_fall")
    kind = next(kind for kind in kinds if kind in segment)
    end = segment.get("at_end")
    state = None if end is None else (end.get("v", 0.0) / unit, end.get("a", 0.0) / unit**2)
    law = None if kind == "rise_fall" else segment.get("law", DEFAULT_LAW)
    return MotionSegment(kind, over, segment[kind], law, segment.get("split"), state, free=free)
