"""The motion of a recipe: segments, a formula, a table, points or a lobe; one grammar for every kind of cam.

A kind of cam sets the input over which its motion runs, an angle or a length, and how it goes on beyond, `around`: 1
for a motion that repeats, -1 for one that goes on as S(total) - S(t - total), None for one that ends. With 1 the least
displacement is 0, otherwise S begins at 0, unless the ends are open.
"""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from functools import cache, lru_cache, partial
from typing import TYPE_CHECKING, ClassVar

from camgeo.motions.contour_motion import DRAWING, ContourPlacing, ContourReading, read_contours
from camgeo.motions.inputs import PART, Axes
from camgeo.motions.lift_table import SHEET, SHEET_OF_LENGTHS, TABLE, TABLE_OF_LENGTHS, Rows, read_rows
from camgeo.motions.lobes import ACCELERATION, ORDERS, lobe_field, read_least, read_sides
from camgeo.motions.segments import LEAST, REST, read_pairs, read_segments, segment_table, segments_schema
from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.yaml_source import Mapping, Scalar, entries, join
from kin.numeric.lengths import input_words, marked
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.motions.contour_motion import CamDrawing
    from camgeo.motions.inputs import Input
    from camgeo.motions.lobes import SideShape
    from camgeo.motions.segments import MotionSegment
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.contacts import Contact, Guide, Touch
    from kin.law.sources.motion import Motion
    from kin.law.sources.table import Suspects
    from kin.law.sources.tabled import Rest
    from kin.read.tables import Quantity

_PLACES = 9  # decimals of a degree in angles that are left
_ANGLE = 1e-9  # rad, within which the segments of a motion must fill their angle (as in kin.law.normalised)
_ROUNDING = 1e-9  # share by which rounding may bring the greatest stroke above its bound
_ZERO = 1e-11  # of the greatest displacement: a displacement below this at the start is rounding
MM_PER_INCH = 25.4
MOST_POINTS = 1000
MOST_REPEATS = 100


class MotionSource(ABC):
    """A motion as a recipe gives it, lengths in mm, angles in rad; can be compared, hashed and pickled.

    Its input is an angle, rad, or a length, mm.

    `scale` is the recipe's unit of displacement in mm or rad; `source` ends the path of its field in errors, such as
    .table.
    """

    scale: float
    source: ClassVar[str] = ""

    def motion(self, total: float, field: str, around: int | None, *, open_ends: bool = False) -> Motion:
        """Make the motion over `total`, rad or mm; `around`, 1, -1 or None, is how it goes on beyond (see the module).

        With `open_ends` a motion that ends may begin at any displacement: its least is 0. With repeats the motion runs
        over an equal part of `total`. Raises kin's IntentError, at a path below `field`, for a motion that cannot be
        made, that does not begin at 0 where it must, or whose stroke is too great.
        """
        motion = self._made(total, field, around, open_ends=open_ends)
        self._demand_within(motion, f"{field}{self.source}")
        if around == 1 or open_ends:
            return motion.from_lowest()
        self._demand_start(motion, f"{field}{self.source}")
        return motion

    def _demand_start(self, motion: Motion, field: str) -> None:  # noqa: B027 - for some sources nothing is to be done
        """Raise IntentError for a motion that does not begin at 0; some sources always do."""

    def _demand_within(self, motion: Motion, field: str) -> None:
        """Raise IntentError for a motion whose stroke exceeds MOST of the recipe's units."""
        from kin.law.normalised import IntentError
        from kin.law.sources.peaks import extremes

        least, greatest = motion.range
        stroke = (greatest - least) / self.scale
        if stroke > MOST * (1.0 + _ROUNDING):
            at = extremes(motion.motion, 0)[-1]
            raise IntentError(
                f"a motion over {stroke:.10g} in all, to its greatest displacement at {input_words(at)}; "
                f"give displacements that differ by {MOST:.0f} at most",
                field,
                math.degrees(at),
            )

    def for_follower(self, contact: Callable[[], Contact[Guide, Touch]], within: int) -> MotionSource:  # noqa: ARG002
        """The motion for a follower: itself, unless it is given by a contour, on which the follower runs.

        The follower's contour lies within `within` others round the shaft, 0 for the outermost, -1 for a ring's.
        `contact` makes the follower's contact; it is called only where the motion depends on it, as a cam that is being
        sized has no place of its follower yet.
        """
        return self

    @property
    def covered(self) -> float | None:
        """Input that the source fills, rad or mm, without repeats; None for a source that fills any."""
        return None

    @property
    def last(self) -> float | None:
        """Last input that the source gives, rad or mm; None for a source that fills any."""
        return self.covered

    @property
    def repeats(self) -> int:
        """Number of times that the motion repeats over its input."""
        return 1

    @property
    def open(self) -> Open | None:
        """Angles that the recipe leaves open; None where all are numbers."""
        return None

    @abstractmethod
    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion: ...


@dataclass(frozen=True)
class Open:
    """Segments with angles left open: one takes the least angle that the limits allow, a dwell the rest of the turn."""

    motion: Segments

    def index(self, word: str) -> int:
        """Index of the segment that has `word`, least or rest, in place of its angle."""
        return next(i for i, segment in enumerate(self.motion.segments) if segment.free == word)

    @property
    def remaining(self) -> float:
        """Angle that the other segments leave for the two open ones together, degrees."""
        stated = math.fsum(segment.over for segment in self.motion.segments)
        return round(360.0 / self.motion.repeat - math.degrees(stated), _PLACES)

    def with_least(self, least: float) -> tuple[Segments, float]:
        """The motion with its least angle set to `least`, degrees, and the angle of its dwell, degrees."""
        rest = round(self.remaining - least, _PLACES)
        angles = {"": 0.0, LEAST: math.radians(least), REST: math.radians(rest)}
        segments = (replace(s, over=s.over + angles[s.free], free="") for s in self.motion.segments)
        return replace(self.motion, segments=tuple(segments)), rest


@dataclass(frozen=True)
class Segments(MotionSource):
    """Motion programme of segments one after another, `repeat` times a turn."""

    segments: tuple[MotionSegment, ...]
    repeat: int = 1
    scale: float = field(default=1.0, compare=False)

    @property
    def repeats(self) -> int:
        """Number of times that the segments follow one another in the turn: `repeat` of the recipe."""
        return self.repeat

    @property
    def covered(self) -> float | None:
        """Sum of the angles of the segments, rad, without repeats; None where a segment's angle is left open."""
        return None if self.open else math.fsum(segment.over for segment in self.segments)

    @property
    def open(self) -> Open | None:
        """Angles that words stand for in these segments (`least`, `rest`); None where every angle is a number."""
        return Open(self) if any(segment.free for segment in self.segments) else None

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:  # noqa: ARG002
        from kin.law.sources.programme import programme

        field = field if self.repeat == 1 else f"{field}.segments"
        steps = [segment.step(f"{field}[{i}]") for i, segment in enumerate(self.segments)]
        return programme(steps, total / self.repeat, around=around, field=field)


@dataclass(frozen=True)
class FormulaMotion(MotionSource):
    """Motion by a formula in t, the angle in rad, or another letter; its values times `scale` are mm or rad.

    One of the letter's values is `unit` rad or mm of the input. `over` is the input that it fills, None for any.
    """

    text: str
    scale: float
    variable: str = "t"
    unit: float = 1.0
    over: float | None = None
    source: ClassVar[str] = ".formula"

    @property
    def covered(self) -> float | None:
        """Input that the formula fills, rad or mm; None for any."""
        return self.over

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:  # noqa: ARG002
        from kin.law.formula.formula import Formula
        from kin.law.sources.whole_turn import from_formula

        formula = Formula(self.text, (self.variable,))
        field = f"{field}.formula"
        return from_formula(formula, total / self.unit, scale=self.scale, around=around, field=field).stretched(
            self.unit
        )

    def _demand_start(self, motion: Motion, field: str) -> None:
        _demand_zero(float(motion.at_start(0)[0]), max(map(abs, motion.range)) * _ZERO, self.scale, field)


@dataclass(frozen=True)
class TableMotion(MotionSource):
    """Motion by rows of a table, each kept within `reading`, mm or rad; `file` names the table in errors.

    A `reading` of None is each row's own rounding. `rest` is what fills the turn beyond the rows: a dwell, the rows
    again (cycle) or backwards (mirror); None for a dwell if the ends agree. `suspect` is what becomes of rows that
    stand out. `over` is the length that the rows cover, mm, None for rows over an angle.
    """

    file: str
    rows: Rows
    reading: float | None
    scale: float
    rest: Rest | None = None
    suspect: Suspects = "keep"
    over: float | None = None
    source: ClassVar[str] = ".table"

    @property
    def covered(self) -> float | None:
        """Length that the rows cover, mm; None for rows over an angle, which fill any."""
        return self.over

    @property
    def last(self) -> float | None:
        """Input of the last row, rad or mm."""
        return self.rows.theta[-1] if self.rows.theta else None

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:
        return _kept(self, total, field, around, open_ends)

    def _demand_start(self, motion: Motion, field: str) -> None:  # noqa: ARG002 - rows are asked, not what keeps them
        if self.rows.s:
            first = f"{self.file}, line {self.rows.lines[0]}: "
            _demand_zero(self.rows.s[0], self.reading or self.rows.rounding[0], self.rows.unit, field, first)


@lru_cache(maxsize=8)
def _kept(table: TableMotion, total: float, field: str, around: int | None, open_ends: bool) -> Motion:
    """Motion that keeps the rows of a table; made once, as it takes long."""
    from kin.law.normalised import IntentError
    from kin.law.sources.table import from_table
    from kin.law.sources.tabled import TableError

    field, samples = f"{field}.table", table.rows.samples()
    try:
        return from_table(
            samples,
            table.reading,
            total,
            around=around,
            rest=table.rest,
            suspect=table.suspect,
            open_ends=open_ends,
            field=field,
        )
    except TableError as error:
        raise IntentError(f"{table.file}, {marked(error.message)}", field, error.at, error.at_unit) from error


@dataclass(frozen=True)
class ContourMotion(MotionSource):
    """Motion of the follower in contact with a drawing's contour, within `reading`, mm or rad.

    `contact` is None until the motion is made for a follower; the contour lies within `within` others.
    """

    drawing: CamDrawing
    reading: float
    scale: float
    contact: Contact[Guide, Touch] | None = None
    within: int = 0
    source: ClassVar[str] = ".contour"

    def for_follower(self, contact: Callable[[], Contact[Guide, Touch]], within: int) -> ContourMotion:
        """Copy of the motion with its follower's contact, on the contour within `within` others, -1 for a ring's."""
        return replace(self, contact=contact(), within=within)

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:  # noqa: ARG002
        from camgeo.motions.contour_motion import motion_on_drawing
        from kin.law.normalised import IntentError

        field = f"{field}.contour"
        if self.contact is None or around != 1 or abs(total - 2.0 * math.pi) > _ANGLE:
            raise IntentError("a contour gives the motion of one follower on a disc over a whole turn", field)
        return motion_on_drawing(self.drawing, self.contact, self.within, self.reading, field)


@dataclass(frozen=True)
class PointsMotion(MotionSource):
    """Motion through points (input, displacement), mm or rad, with rising inputs.

    Neighbours of equal displacement enclose a dwell. `over` is the input that they fill, None for any.
    """

    points: tuple[tuple[float, float], ...]
    scale: float
    over: float | None = None
    source: ClassVar[str] = ".points"

    @property
    def covered(self) -> float | None:
        """Input that the points fill, rad or mm; None for any."""
        return self.over

    @property
    def last(self) -> float | None:
        """Input of the last point, rad or mm."""
        return self.points[-1][0]

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:  # noqa: ARG002
        from kin.law.sources.points import from_points
        from kin.law.sources.programme import Dwell, programme

        field = f"{field}.points"
        if len({s for _, s in self.points}) == 1:
            return programme([Dwell(total)], total, around=around, field=field)
        points, dwells = self._ends_of_dwells(total, around)
        theta, s = zip(*points, strict=True)
        return from_points(theta, s, total, dwells=dwells, around=around, field=field, unit=self.scale)

    def _demand_start(self, motion: Motion, field: str) -> None:  # noqa: ARG002 - the first point is asked
        _demand_zero(self.points[0][1], 0.0, self.scale, f"{field}[0]")

    def _ends_of_dwells(
        self, total: float, around: int | None
    ) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
        """Points but for those inside a dwell, and the dwells (start, end), rad."""
        points = list(self.points)
        closed = around == 1 and points[-1][0] - points[0][0] > total - _ANGLE
        if closed and points[-1][1] == points[0][1]:
            points.pop()
        n = len(points)
        same = [points[i][1] == points[(i + 1) % n][1] and (i + 1 < n or around == 1) for i in range(n)]
        kept = [point for i, point in enumerate(points) if not (same[i] and same[i - 1])]
        later = [*kept[1:], (kept[0][0] + total, kept[0][1])][: len(kept) if around == 1 else -1]
        dwells = [(a, b) for (a, s), (b, s_next) in zip(kept, later, strict=False) if s == s_next]
        return kept, dwells


@dataclass(frozen=True)
class LobeMotion(MotionSource):
    """Motion by the lobe of a valve train: its lift, mm or rad, its two sides, and the shaft angle of its nose, rad.

    `least` is what is least of all lobes that meet a cam card.
    """

    lift: float
    sides: tuple[SideShape, SideShape]
    nose: float = 0.0
    least: str = ACCELERATION
    scale: float = field(default=1.0, compare=False)
    source: ClassVar[str] = ".lobe"

    def _made(self, total: float, field: str, around: int | None, *, open_ends: bool) -> Motion:  # noqa: ARG002
        from camgeo.motions.lobes import lobe_motion

        order = ORDERS[self.least]
        lobe = f"{field}.lobe"
        return lobe_motion(self.lift, self.sides, total, nose=self.nose, around=around, order=order, field=lobe)


def _demand_zero(value: float, within: float, scale: float, field: str, where: str = "") -> None:
    from kin.law.normalised import IntentError

    if abs(value) > within:
        less = f"{abs(value) / scale:.9g} {'less' if value > 0 else 'more'}"
        raise IntentError(
            f"{where}the motion begins at {value / scale:.9g}; S(0) must be 0: make every displacement {less}", field
        )


# --- in a recipe ------------------------------------------------------------------------------------------------------


def motion_field(name: str, stroke: Kind, about: str, *, over: Input = PART, required: bool = False) -> Field:
    """Make the field `name` of a motion over an input; `stroke` is the kind of its displacements, lengths or angles."""
    axes = Axes(stroke, over)
    sources = _sources(axes)
    form = OwnForm(
        "a list of motion segments",
        "a list of segments such as [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]",
        partial(_read, axes),
        lambda field: {"anyOf": [segments_schema(field), table_schema(sources)]},
        instead=sources,
    )
    return Field(name, Kind.OWN, about, required, table=segment_table(stroke, over), form=form)


def _read_reading(reader: Reader, field: Field, node: Node, path: str) -> float | str | None:
    """Read a length or an angle, or `auto`."""
    if isinstance(node, Scalar) and node.text == "auto":
        return "auto"
    value: float | None = reader.readers[field.kind](reader, replace(field, form=None), node, path)
    return value


_READING = OwnForm(
    "a stroke, or auto",
    "a stroke above 0, or auto for half the last digit of each row",
    _read_reading,
    lambda field: {"anyOf": [number_schema(replace(field, form=None)), {"const": "auto"}]},
)


@cache
def _sources(axes: Axes) -> FieldTable:
    """Table of the keys of a motion that is no list of segments."""
    stroke, over = axes
    points = OwnForm(
        "a list of points",
        f"a list of points [{_noun(over)}, displacement]",
        partial(_read_points, axes),
        _points,
    )
    through = Field(
        "points", Kind.OWN, "points for a spline to go through, with a dwell between equal ones", form=points
    )
    of_angle = over.kind is Kind.ANGLE
    what = "the motion's angle in radians" if of_angle else f"the {over.noun} in the recipe's unit"
    about = f"displacement at {over.variable}, {what}"
    formula = Field("formula", Kind.FORMULA, about, unit=stroke, variable=over.variable)
    most = 180 if stroke is Kind.ANGLE else MOST
    noun = _noun(over)
    table = Field(
        "table",
        Kind.OWN,
        f"file with a row for each {noun}, its path as seen from the recipe, or rows",
        form=TABLE if of_angle else TABLE_OF_LENGTHS,
    )
    units = Field(
        "units",
        Kind.CHOICE,
        "unit of the table's displacements",
        default="the heading's, else the recipe's",
        choices=("mm", "inch", "thou"),
    )
    reading = Field(
        "reading",
        stroke,
        "greatest distance of the motion from a row of the table",
        default="auto",
        above=0,
        at_most=most,
        form=_READING,
    )
    suspect = Field(
        "suspect",
        Kind.CHOICE,
        "whether a row that stands out is kept, left out or refused",
        default="keep",
        choices=("keep", "drop", "refuse"),
    )
    of_units = () if stroke is Kind.ANGLE else (units,)
    if not of_angle:
        whole = Field("over", over.kind, f"{over.noun} that the motion covers", above=0, at_most=over.most)
        return FieldTable(
            (formula, table, *SHEET_OF_LENGTHS, *of_units, reading, suspect, through, whole),
            (("formula", ("over",)), ("table", ()), ("points", ("over",))),
        )
    rest = Field(
        "rest",
        Kind.CHOICE,
        "what fills the rest of a turn: the table's last displacement, its rows again, or backwards",
        default="a dwell, where its ends agree",
        choices=("dwell", "cycle", "mirror"),
    )
    fields = (
        formula,
        table,
        *SHEET,
        *of_units,
        reading,
        rest,
        suspect,
        through,
        lobe_field(stroke, most),
    )
    alternatives = tuple((key, ()) for key in ("formula", "table", "points", "lobe"))
    if not over.turn:
        return FieldTable(fields, alternatives)
    contour = Field(
        "contour", Kind.OWN, "drawing of a cam, or points, whose motion under the follower is taken", form=DRAWING
    )
    curve = Field(
        "curve",
        Kind.CHOICE,
        "what the contour is: the cam's own, or the pitch curve of the follower's centre",
        default="cam",
        choices=("cam", "pitch"),
    )
    gap = Field(
        "gap",
        Kind.LENGTH,
        "join ends of the drawing this near",
        default="its digits', or 1e-7 of its size",
        above=0,
        at_most=MOST,
    )
    across = Field(
        "across",
        Kind.CHOICE,
        "close the contour where it is open, or a slot reaches the shaft",
        choices=("arc", "chord"),
    )
    mirror = Field("mirror", Kind.CHOICE, "axis in which the contour is mirrored", choices=("x", "y"))
    turn = Field(
        "turn", Kind.ANGLE, "turns the contour counter-clockwise, after that", default="0", at_least=-360, at_most=360
    )
    of_contour = (contour, curve, gap, across, mirror, turn)
    repeat = Field("repeat", Kind.INTEGER, "how often the segments fill a turn", at_least=1, at_most=MOST_REPEATS)
    read = partial(_read_segments, axes)
    form = OwnForm("a list of motion segments", "a list of segments", read, segments_schema)
    inner = segment_table(stroke, over)
    segments = Field("segments", Kind.OWN, "the segments of 360/repeat degrees", table=inner, form=form)
    return FieldTable(
        (repeat, segments, *fields, *of_contour), (("segments", ("repeat",)), *alternatives, ("contour", ()))
    )


def _read(axes: Axes, reader: Reader, field: Field, node: Node, path: str) -> MotionSource | None:
    """Read a motion: a list of segments, or a mapping with another source."""
    if isinstance(node, Scalar) and re.search(rf"\b{axes.over.variable}\b", node.text):
        shown = quote(node.text)
        reader.fault(node.mark, path, "a formula stands in a mapping", shown, f"give {{formula: {shown[1:-1]}}}")
        return None
    if not isinstance(node, Mapping):
        return _read_segments(axes, reader, field, node, path)
    stroke, over = axes
    if field.form is None or field.form.instead is None:
        raise AssertionError(field.name)
    faults = len(reader.errors)
    values = reader.table(field.form.instead, node, path)
    of_contours = {"units", "reading"} if "contour" in values else set()
    sheet = SHEET if over.kind is Kind.ANGLE else SHEET_OF_LENGTHS
    for key in (*(field.name for field in sheet), "units", "reading", "rest", "suspect"):
        if key in values and f"{path}.table" not in reader.marks and key not in of_contours:
            reader.fault_at(f"{path}.{key}", "cannot stand without a table", None, "leave it out")
    for key in ("curve", "gap", "across", "mirror", "turn"):
        if f"{path}.{key}" in reader.marks and "contour" not in values:
            reader.fault_at(f"{path}.{key}", "cannot stand without a contour", None, "leave it out")
    if "units" in values and stroke in reader.angular and "contour" not in values:
        reader.fault_at(f"{path}.units", "the follower swings: its table is in degrees", None, "leave it out")
    if len(reader.errors) > faults:
        return None
    scale = reader.scale(stroke)
    if "segments" in values:
        segments: Segments = values["segments"]
        return replace(segments, repeat=values["repeat"])
    if "formula" in values:
        unit = 1.0 if over.kind is Kind.ANGLE else reader.scale(over.kind)
        return FormulaMotion(values["formula"], scale, over.variable, unit, values.get("over"))
    if "points" in values:
        return PointsMotion(values["points"], scale, values.get("over"))
    if "lobe" in values:
        lobe = values["lobe"]
        sides = read_sides(lobe, join(path, "lobe"), reader)
        least = read_least(lobe, join(path, "lobe"), reader)
        if sides is None:
            return None
        return LobeMotion(lobe["lift"], sides, lobe.get("nose", 0.0), least, scale=scale)
    if "contour" in values:
        return _contour(reader, values, join(path, "contour"), scale)
    return _table(axes, reader, values, join(path, "table"))


def _contour(reader: Reader, values: Values, path: str, scale: float) -> ContourMotion | None:
    """Read the contours of a drawing now, so that the recipe needs no file any more."""
    reading = values.get("reading")
    if reading is None or reading == "auto":
        reader.fault_at(path, "a contour shows no digits", None, "give reading beside it, such as reading: 0.02")
        return None
    root = reader.source.root
    rotation = entries(root).get("rotation") if isinstance(root, Mapping) else None
    mirrored = isinstance(rotation, Scalar) and rotation.text == "ccw"
    unit = {"mm": 1.0, "inch": MM_PER_INCH, "thou": 1e-3 * MM_PER_INCH}[values.get("units", reader.units)]
    placing = ContourPlacing(values.get("mirror"), values.get("turn", 0.0), mirrored)
    pitch = values.get("curve") == "pitch"
    how = ContourReading(unit, placing, pitch, values.get("gap"), values.get("across"))
    drawing = read_contours(reader, values["contour"], path, how)
    return None if drawing is None else ContourMotion(drawing, reading, scale)


def _read_segments(axes: Axes, reader: Reader, field: Field, node: Node, path: str) -> Segments | None:
    segments = read_segments(reader, field, node, path, axes)
    return Segments(segments, scale=reader.scale(axes.stroke)) if segments else None


def _table(axes: Axes, reader: Reader, values: Values, path: str) -> TableMotion | None:
    """Read the rows of a table now, so that the recipe needs no file any more."""
    stroke, over = axes
    angular, of_angle = stroke in reader.angular, over.kind is Kind.ANGLE
    quantity: Quantity = "angle" if angular else "length"
    instead, length = "degrees" if angular else reader.units, None if of_angle else reader.units
    rows = read_rows(reader, values, path, quantity=quantity, instead=instead, length=length)
    if rows is None:
        return None
    whole = None if of_angle else max(rows.theta, default=0.0) - min(rows.theta, default=0.0)
    if whole is not None and over.most * reader.scale(over.kind) < whole < math.inf:
        problem = f"{values['table'].name}: a {over.noun} above {over.most:.0f}"
        reader.fault_at(path, problem, None, "give a table of a shorter one")
        return None
    largest, line = max(zip(map(abs, rows.s), rows.lines, strict=True), default=(0.0, 0))
    if MOST * reader.scale(stroke) < largest < math.inf:  # what is not finite is refused with the other faults of rows
        problem = f"{values['table'].name}, line {line}: a displacement above {MOST:.0f}"
        reader.fault_at(path, problem, None, "give a table of smaller ones")
        return None
    if values["table"].text is not None and "reading" not in values:
        remedy = "give reading beside them, or reading: auto for half of it"
        reader.fault_at(path, "rows in a recipe show no last digit", None, remedy)
        return None
    reading = values.get("reading", "auto")
    reading = None if reading == "auto" else reading
    scale, suspect = reader.scale(stroke), values.get("suspect", "keep")
    return TableMotion(values["table"].name, rows, reading, scale, values.get("rest"), suspect, whole)


def _noun(over: Input) -> str:
    """Noun of the input of a point: angle or length."""
    return over.kind.value.partition(" ")[2]


def _read_points(
    axes: Axes, reader: Reader, field: Field, node: Node, path: str
) -> tuple[tuple[float, float], ...] | None:
    """Read a list of inputs and displacements."""
    stroke, over = axes
    place = Field("", over.kind, "", at_least=0, at_most=360 if over.kind is Kind.ANGLE else over.most)
    value = Field("", stroke, "", at_least=-MOST, at_most=MOST)
    row = f"[{_noun(over)}, displacement]"
    return read_pairs(reader, field, node, path, parts=(place, value), most=MOST_POINTS, row=row)


def _points(_: Field) -> Schema:
    point = {"type": "array", "items": number_schema(unit=Kind.MOTION), "minItems": 2, "maxItems": 2}
    return {"type": "array", "items": point, "minItems": 1, "maxItems": MOST_POINTS}


def check_filled(motion: MotionSource, path: str, angle: float, remedy: str, reader: Reader, *, why: str) -> None:
    """Note segments that do not fill `angle`, rad; `remedy` names that angle, `why` says why no more fits."""
    if motion.covered is None or abs(motion.covered - angle) <= _ANGLE:
        return
    value = f"{math.degrees(motion.covered):.10g} degrees"
    more = why if motion.covered > angle else "an angle may be a fraction such as 180/7"
    reader.fault_at(path, "the segments do not fill their angle", value, f"let them cover {remedy}; {more}")


def check_whole_turn(motion: MotionSource, path: str, reader: Reader) -> None:
    """Note segments that do not fill the turn, or an equal part of it if they repeat, or that leave no open angle."""
    repeat = motion.repeats
    if motion.open is not None and motion.open.remaining <= 0.0:
        remedy = f"let all the others cover less than {360 / repeat:.10g} degrees"
        reader.fault_at(path, f"nothing is left for over: {LEAST} and dwell: {REST}", None, remedy)
    part = "the whole turn, 360 degrees" if repeat == 1 else f"360/{repeat} degrees"
    check_filled(motion, path, 2.0 * math.pi / repeat, part, reader, why="the next turn begins there")
