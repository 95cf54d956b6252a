"""The keys of a recipe; its values are read here, and faults between them are noted."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from camgeo.cams.families import FAMILIES
from camgeo.part.part import PART, check_part
from camgeo.recipe.cam import CAM, CAMS, check_cam, check_tappet
from camgeo.recipe.discs import check_discs
from camgeo.recipe.export import EXPORT, check_files, export_of
from camgeo.recipe.extension import KEYS, Keys
from camgeo.recipe.limits import LIMITS, check_limits
from camgeo.recipe.linkage import DWELL, DYADS, LINKAGE, LINKAGES, SLIDING, check_linkage
from camgeo.recipe.machining import MANUFACTURE, check_allowance, check_cutter
from camgeo.recipe.preload import check_preload
from camgeo.recipe.track import check_track
from camgeo.registry.formats import FORMATS
from camgeo.registry.gathered import Gathered
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, mapping
from camgeo.schema.reader import kind_of
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, describe, entries

if TYPE_CHECKING:
    from collections.abc import Collection

    from camgeo.schema.reader import Reader, Values

MOST_ANGLES = 1_000_000  # shaft angles of a turn at which files may be judged
UNITS = {"mm": 1.0, "inch": 25.4}  # units of length, mm

CORE = FieldTable(
    (
        Field("name", Kind.NAME, "name of the output folder and of the files in it", default="the file's stem"),
        Field("about", Kind.TEXT, "a note that travels into the files", default="none"),
        Field("units", Kind.CHOICE, "unit of lengths that carry none", default="mm", choices=("mm", "inch")),
        Field(
            "rotation",
            Kind.CHOICE,
            "sense in which the shaft turns, seen as drawn",
            default="cw",
            choices=("cw", "ccw"),
        ),
        Field("cam", Kind.OWN, "the cam, of exactly one kind", required=True, form=CAM),
        Field(
            "linkage",
            Kind.OWN,
            "the linkage whose coupler is the square frame around the cam",
            default="none",
            form=LINKAGE,
        ),
        PART,
        EXPORT,
        mapping(
            "verify",
            "how each file is judged",
            Field(
                "angles",
                Kind.INTEGER,
                "number of shaft angles at which each file is judged",
                default="3600",
                at_least=8,
                at_most=MOST_ANGLES,
            ),
            Field(
                "motion_error",
                Kind.ERROR,
                "greatest motion error permitted: a length, or degrees where the follower swings",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
            Field(
                "output_error",
                Kind.OUTPUT,
                "greatest error permitted of the linkage's output, in degrees, or a length where it slides",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
            Field(
                "openings",
                Kind.CHOICE,
                "what is done about openings of a file that the part does not name",
                default="judge",
                choices=("judge", "ignore"),
            ),
        ),
        LIMITS,
        mapping("dwell", "dwells of the linkage's output", *DWELL),
        Field("manufacture", Kind.TABLE, "how the part is milled", default="none", table=MANUFACTURE),
    )
)


_KEYS: Gathered[Keys, Field] = Gathered(
    {field.name: field for field in CORE.fields}, KEYS, lambda keys: {field.name: field for field in keys.fields()}
)


def recipe_table(capabilities: Collection[str] | None = None) -> FieldTable:
    """Table of a recipe's keys: the core's, and the keys of the named capabilities, or of all for None."""
    return _table(KEYS.answering() if capabilities is None else tuple(capabilities))


@cache
def _table(capabilities: tuple[str, ...]) -> FieldTable:
    more = [
        option for keys in KEYS.of(capabilities) for option in (keys.variant, keys.alteration) if option is not None
    ]
    fields = _KEYS.among(capabilities)
    if more:
        fields[EXPORT.name] = export_of(FORMATS, more=more)
    return FieldTable(tuple(fields.values()))


def read_units(reader: Reader) -> None:
    """Set the reader's unit to that of its recipe, wherever it stands; survey the whole text first."""
    root = reader.source.root
    reader.survey(root, "")
    units = entries(root).get("units") if isinstance(root, Mapping) else None
    if isinstance(units, Scalar) and units.text in UNITS:
        reader.units, reader.mm = units.text, UNITS[units.text]


def read_values(reader: Reader, capabilities: Collection[str]) -> Values:
    """Read the whole recipe with the keys of these capabilities, and note faults between its fields.

    Values come back by key, lengths in mm, angles in the form of their field; `mm` is the recipe's unit, mm. They are
    empty for what is no mapping. Keys that decide how others are read come first, wherever they stand: the unit, and
    the kinds of cam and linkage, by which follower and output swing or slide.
    """
    read_units(reader)
    root = reader.source.root
    if not isinstance(root, Mapping):
        reader.fault(root.mark, "", "a recipe is a mapping", describe(root), "begin with the key `cam:`")
        return {}
    top = entries(root)
    # kinds of cam and linkage; the output of a linkage is that of its last dyad
    linkage = top.get("linkage")
    reader.kinds = {"cam": kind_of(top.get("cam"), CAMS), "linkage": kind_of(linkage, LINKAGES)}
    output_kind = reader.kinds["linkage"]
    dyads = entries(linkage).get("dyads") if isinstance(linkage, Mapping) else None
    if isinstance(dyads, Sequence) and dyads.items:
        output_kind = kind_of(dyads.items[-1], DYADS)
    # kinds of values that are angles in this recipe
    if (family := FAMILIES.get(reader.kinds["cam"])) is not None:
        arrangement = family.of(top["cam"])
        own = (
            (Kind.STROKE, arrangement.unit),
            (Kind.ERROR, arrangement.unit),
            (Kind.BACKLASH, arrangement.backlash_unit),
        )
        reader.angular |= {kind for kind, unit in own if unit == "deg"}
        reader.offers = arrangement.offers
    if output_kind not in SLIDING:
        reader.angular |= {Kind.OUTPUT}
    if (Kind.OUTPUT if reader.kinds["linkage"] else Kind.ERROR) in reader.angular:
        reader.angular |= {Kind.MOTION}
    values = {"mm": reader.mm, **reader.table(reader.root, root, "")}
    _check(values, reader)
    for keys in KEYS.of(capabilities):
        keys.check(values, reader)
    return values


def _check(values: Values, reader: Reader) -> None:
    """Note faults between fields that need no geometry.

    Each check uses the values that were read, and is silent where a value is missing or faulty, as that is noted
    already.
    """
    check_tappet(values, reader)
    check_cam(values.get("cam", {}), reader)
    check_linkage(values, reader)
    check_part(values.get("part", {}), reader)
    check_track(values, reader)
    check_preload(values, reader)
    check_discs(values, reader)
    check_files(values, reader)
    check_cutter(reader)
    check_allowance(values.get("manufacture", {}), reader)
    check_limits(values.get("limits", []), reader)
    if values.get("verify", {}).get("openings") == "ignore" and "thickness" in values.get("part", {}):
        problem = "cannot go with part.thickness, as the openings of a solid count in its volume"
        reader.fault_at("verify.openings", problem, None, "leave one of them out")
