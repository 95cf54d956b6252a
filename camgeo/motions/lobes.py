"""The lobe of a valve train in a recipe: by its powers, or by its cam card, and its two sides."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, mapping
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import Mapping, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.sources.cam_card import Mixture, SideCard
    from kin.law.sources.motion import Motion

MOST_DURATIONS = 3
_BOTH, _ALONE = 4.0, 2.0  # degrees of the crank by degrees of the cam from the nose, of both sides together or one
_SIDES = ("opening", "closing")
ACCELERATION, VELOCITY, FACE = "acceleration", "velocity", "face"
ORDERS = {ACCELERATION: 2, VELOCITY: 1, FACE: 1}
"""Order of the derivative whose peak is least: on a flat face the contact runs out by the velocity."""


@dataclass(frozen=True)
class SideShape:
    """A side of a lobe, opening or closing, as a recipe gives it; lengths in mm, angles in rad.

    `half` is the cam angle from foot to nose, `powers` are the powers of its polynomial. Instead of powers, `durations`
    are pairs of a lift and the crank angle for which the lobe is above it; a crank angle is `crank` times the cam angle
    from the crossing to the nose. `ramp` is height, mm, and velocity, mm/rad; None without. `field` is the path of the
    side's own keys below the lobe's, such as .opening, empty for keys that both sides share.
    """

    half: float | None = None
    powers: tuple[float, ...] | None = None
    durations: tuple[tuple[float, float], ...] = ()
    crank: float = _BOTH
    ramp: tuple[float, float] | None = None
    field: str = ""


def lobe_motion(
    lift: float,
    sides: tuple[SideShape, SideShape],
    total: float,
    *,
    nose: float,
    around: int | None,
    order: int,
    field: str,
) -> Motion:
    """Motion of a lobe of a lift, mm or rad, over `total` rad, with the sides `sides`, opening and closing.

    `nose` is the angle of its greatest lift, rad. `around`, 1, -1 or None, is how the motion goes on beyond `total`, as
    in `camgeo.motions.motion`. Of the lobes that meet a card the one is taken whose derivative of `order`, 1 or 2, has
    the least peak. Raises IntentError, at `field` or a path below it, where no such lobe exists.
    """
    from kin.law.normalised import IntentError
    from kin.law.sources.cam_card import sides_of_card
    from kin.law.sources.lobe import demand_lift, lobe_of
    from kin.law.sources.motion import Kept, TableRemark
    from kin.numeric.records import replace

    demand_lift(lift, field)
    opening, closing = (_side_card(lift, side, total, field) for side in sides)
    if opening.known is not None and closing.known is not None:
        return lobe_of(opening.known, closing.known, total, nose=nose, around=around, field=field)
    if around != 1 and nose != 0.0:
        raise IntentError("the nose stands in the middle where the motion does not repeat each turn", f"{field}.nose")
    first, second = sides_of_card(lift, opening, closing, 0.5 * total, order=order)
    motion = lobe_of(first.side, second.side, total, nose=nose, around=around, field=field)
    mixtures = {
        name: _mixture_words(mixture) for name, mixture in zip(_SIDES, (first, second), strict=True) if mixture.members
    }
    if first == second:
        mixtures = {"either": mixtures["opening"]}
    sentence = "; ".join(f"{words} on the {name} side" for name, words in mixtures.items())
    sentence += "" if order == ORDERS[ACCELERATION] else ", of least peak velocity"
    return replace(motion, kept=Kept(None, 0, (TableRemark("cam-card", sentence.replace("the either", "either")),)))


def _side_card(lift: float, side: SideShape, total: float, field: str) -> SideCard:
    """A side in kin's form: known by its powers, or to be found from its cam card; IntentError for faults of it."""
    from kin.law.sources.cam_card import Crossing, SideCard
    from kin.law.sources.lobe import Ramp, demand_ramp, side_of

    ramp = None if side.ramp is None else Ramp(*side.ramp)
    field += side.field
    if side.powers is not None and side.half is not None:
        return SideCard(known=side_of(lift, side.half, side.powers, ramp, total=total, field=field))
    if ramp is not None:
        demand_ramp(lift, ramp, field)
    crossings = tuple(Crossing(height, crank / side.crank) for height, crank in side.durations)
    return SideCard(crossings, side.half, ramp, crank=side.crank, field=field)


def _mixture_words(mixture: Mixture) -> str:
    """Words for a side found from its card: its polynomials' weights and powers, its angle, and what it misses."""
    shares = " + ".join(f"{weight:.4g} x {'-'.join(map(str, powers))}" for powers, weight in mixture.members)
    within = f" within {mixture.off:.2g} degrees" if mixture.off else ""
    half = math.degrees(mixture.side.half)
    return f"the card is met{within} by the polynomials (weight x powers) {shares} over {half:.6g} degrees of the cam"


# --- in a recipe ------------------------------------------------------------------------------------------------------


def lobe_field(stroke: Kind, most: float) -> Field:
    """Field of a lobe; `stroke` is the kind of its lifts, lengths or angles, up to `most`."""
    nose = Field(
        "nose",
        Kind.ANGLE,
        "shaft angle of the nose of a motion over a whole turn",
        default="0",
        at_least=0,
        at_most=360,
    )
    lift = Field("lift", stroke, "greatest displacement, its ramp included", required=True, above=0, at_most=most)
    alone = "what its side has of its own, a duration from the crossing to the nose"
    least = Field(
        "least",
        Kind.CHOICE,
        "what is least of all lobes that meet a card; face, the width of a flat face on a stem, goes by velocity",
        default=ACCELERATION,
        choices=tuple(ORDERS),
    )
    both = _side_fields(stroke, most)
    sides = tuple(mapping(name, alone, *both) for name in _SIDES)
    return mapping("lobe", "the lobe of valve trains, by its powers or its cam card", lift, *both, nose, least, *sides)


def _side_fields(stroke: Kind, most: float) -> tuple[Field, ...]:
    crossing = FieldTable(
        (
            Field("at_lift", stroke, "a lift, from the lowest place", required=True, above=0, at_most=most),
            Field(
                "degrees",
                Kind.ANGLE,
                "crank degrees for which the lobe is above it",
                required=True,
                above=0,
                at_most=720,
            ),
        )
    )
    durations = OwnForm(
        "a list of durations",
        "up to three durations such as [{at_lift: 1.27 mm, degrees: 228}]",
        partial(_read_durations, crossing),
        partial(_durations_schema, crossing),
    )
    return (
        Field(
            "half",
            Kind.ANGLE,
            "angle from the foot, or from the ramp's end, to the nose",
            default="by the durations",
            above=0,
            at_most=180,
        ),
        Field("powers", Kind.NUMBERS, "2 and four more powers, such as [2, 8, 14, 20, 26]", default="by the durations"),
        Field("duration", Kind.OWN, "what a cam card says, in place of powers", table=crossing, form=durations),
        mapping(
            "ramp",
            "lash ramps beyond `half` on both sides",
            Field("height", stroke, "displacement at which the lobe begins", required=True, above=0, at_most=most),
            Field("velocity", stroke, "up to there, a degree of the cam", required=True, above=0, at_most=most),
        ),
    )


def _durations_schema(table: FieldTable, _: Field) -> Schema:
    alone = table_schema(table)
    return {"anyOf": [alone, {"type": "array", "items": alone, "minItems": 1, "maxItems": MOST_DURATIONS}]}


def _read_durations(
    table: FieldTable, reader: Reader, field: Field, node: Node, path: str
) -> tuple[tuple[float, float], ...] | None:
    """Read lifts and the angles of the crank for which a lobe is above them; None after a fault."""
    row = Field("", Kind.TABLE, field.about, table=table)
    if isinstance(node, Mapping):
        rows = [reader.mapping(row, node, path)]
    else:
        items = reader.items(field, node, path, MOST_DURATIONS)
        rows = [reader.mapping(row, item, join(path, i)) for i, item in enumerate(items)]
    whole = [(values["at_lift"], values["degrees"]) for values in rows if values is not None and len(values) == 2]
    return tuple(whole) if rows and len(whole) == len(rows) else None


def read_least(values: Values, path: str, reader: Reader) -> str:
    """What is to be least of a lobe by its card; notes a face of a follower without one, and a lobe without a card."""
    least: str = values.get("least", ACCELERATION)
    place = join(path, "least")
    if "least" in values and not any("duration" in side for side in (values, *(values.get(k, {}) for k in _SIDES))):
        reader.fault_at(place, "belongs to a lobe by its durations", None, "leave it out, or give duration")
    elif least == FACE and "stem-face" not in reader.offers:
        remedy = f"give {VELOCITY} or {ACCELERATION}"
        reader.fault_at(place, "the follower has no flat face on a stem", f"'{FACE}'", remedy)
    return least


def read_sides(values: Values, path: str, reader: Reader) -> tuple[SideShape, SideShape] | None:
    """The two sides of a lobe, opening and closing, from its values; after a fault, which is noted, None."""
    sides = []
    for name in _SIDES:
        own, place = values.get(name, {}), join(path, name) if name in values else path
        # powers and durations exclude one another: a side's own replace the shared ones of either form
        shared = {key: values[key] for key in ("half", "powers", "duration", "ramp") if key in values}
        if "powers" in own or "duration" in own:
            shared = {
                key: value for key, value in shared.items() if key == "ramp" or (key == "half" and "powers" in own)
            }
        side = {**shared, **own}
        if "powers" in side and "duration" in side:
            fault_path = join(place, "duration") if "duration" in own else join(path, "duration")
            reader.fault_at(fault_path, "cannot be combined with powers", None, "give exactly one of them")
            return None
        if "powers" not in side and "duration" not in side:
            remedy = "give half and powers, or duration: [{at_lift: 1.27 mm, degrees: 228}]"
            reader.fault_at(place, "needs powers or duration", None, remedy)
            return None
        if "powers" in side and "half" not in side:
            reader.fault_at(place, "powers need half", None, "give half, an angle above 0 up to 180 in degrees")
            return None
        ramp = side.get("ramp")
        sides.append(
            SideShape(
                side.get("half"),
                side.get("powers"),
                side.get("duration", ()),
                _ALONE if "duration" in own else _BOTH,
                None if ramp is None else (ramp["height"], ramp["velocity"] / math.radians(1.0)),
                f".{name}" if name in values else "",
            )
        )
    opening, closing = sides
    return opening, closing
