"""Starters: recipes to begin with, each valid as it is, with comments from the schema."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from camgeo.cams.families import FAMILIES
from camgeo.part.features import FEATURES
from camgeo.recipe.cam import CAMS
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.linkage import LINKAGES
from camgeo.recipe.track import OF_A_DISC
from camgeo.registry.gathered import Gathered
from camgeo.registry.root import CAM, reading
from camgeo.registry.slot import EMPTY, Slot
from camgeo.schema.errors import suggestion
from camgeo.schema.fields import Field, FieldTable, Kind, either
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_COMMENT = 40  # column at which comments stand


Given: TypeAlias = dict[str, "str | Given"]  # the text of a field, or the fields of a mapping


@dataclass(frozen=True)
class Starter:
    """A recipe to begin with: its title, the kind of cam, the given fields of the cam, and `more` fields beside it.

    `task` is what somebody says who wants it, in a few words, and `also` are other words by which it is sought.
    `unfit` are fields of the follower, the part or the top level that do not go with the given ones; they are left out
    of the text. `after` names the core's starter behind which a capability's is listed. `root` is the top key of the
    recipe's kind; only `cam` has a cam.
    """

    title: str
    kind: str
    cam: Given
    more: Given = field(default_factory=dict)
    unfit: tuple[str, ...] = ()
    after: str = ""
    root: str = CAM
    task: str = ""
    also: str = ""


@dataclass(frozen=True, kw_only=True)
class Starters:
    """Answers of a capability with recipes to begin with, by name."""

    starters: Mapping[str, Starter] = EMPTY


STARTING = Slot("starter", Starters())


def _roller(title: str, ratio: str, route: str, values: str | Given) -> Starter:
    return Starter(title, "double-roller", {"ratio": ratio, "arm": "60", "roller_radius": "8", route: values})


_DWELLS = (
    "\n    - {{rise: {0}, over: 110, law: modified-sine}}"
    "\n    - {{dwell: 50}}"
    "\n    - {{return: {0}, over: 120, law: cycloidal}}"
    "\n    - {{dwell: 80}}"
)


def _disc(title: str, base: str, stroke: str, follower: Given) -> Starter:
    unfit: tuple[str, ...] = ("offset", "tilt", "width") if "arm" in follower else ()
    unfit += ("conjugate",) if follower["kind"] == "knife-edge" or (unfit and follower["kind"] == "flat") else ()
    cam: Given = {"base_radius": base, "follower": follower, "motion": _DWELLS.format(stroke)}
    return Starter(f"A disc cam for {title}.", "disc", cam, unfit=unfit)


_UNGROOVED = tuple(each.name for each in FEATURES if each.grooved is not None and each.grooved.unless is None)
_SHAFT: Given = {"shaft": "[10, 4]"}
# Figures 9a and 13a of AS 2023: the outputs dwell near 3 pi/2 and pi, as no plain four-bar's does
DWELLING = "25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t)"
FOUR_BAR: Given = {
    "linkage": {"kind": "four-bar", "ground": "80", "coupler": "70", "rocker": "105"},
    "dwell": {"band": "0.1", "at_least": "36"},
}
_EACH = {
    "toy": Starter(
        "The cam of a toy, to print: two bumps of 15 mm a turn, hand cranked.",
        "disc",
        {
            "base_radius": "24",
            "follower": {"kind": "roller", "radius": "6"},
            "motion": 2 * "\n    - {rise: 15, over: 80}\n    - {return: 15, over: 80}\n    - {dwell: 20}",
        },
        {
            "part": {"thickness": "8", "bore": "6"},
            "export": {"tolerance": "0.02", "files": "[stl, 3mf, svg, html]"},
        },
    ),
    "support": Starter("A cam from a formula for its support function.", "support", {"p": "25 + 2*cos(3*t)", **_SHAFT}),
    "fourier": Starter(
        "A cam from a Fourier series; odd harmonics alone give constant breadth.",
        "support",
        {"fourier": {"mean": "25", "cos": "{3: 1.5}", "sin": "{5: 0.3}"}, **_SHAFT},
    ),
    "reuleaux": Starter(
        "A regular Reuleaux polygon with rounded corners.",
        "support",
        {"reuleaux": {"sides": "3", "breadth": "50", "rounding": "5"}, **_SHAFT},
    ),
    "hypocycloid": Starter(
        "The parallel curve of a hypocycloid.",
        "support",
        {"hypocycloid": {"cusps": "3", "size": "2", "breadth": "50"}, **_SHAFT},
    ),
    "constant-breadth": Starter(
        "A cam between two parallel faces, from its motion over one half turn.",
        "constant-breadth",
        {"base_radius": "40", "motion": "\n    - {rise: 20, over: 120, law: modified-sine}\n    - {dwell: 60}"},
    ),
    "disc-roller": _disc(
        "a roller on a stem, the stem's line beside the shaft",
        "36",
        "20",
        {"kind": "roller", "radius": "9", "offset": "8"},
    ),
    "disc-arm": _disc(
        "a roller on an arm, which swings",
        "34",
        "20",
        {"kind": "roller", "radius": "8", "arm": {"length": "65", "pivot": "80"}},
    ),
    "disc-flat": _disc("a flat tappet", "30", "12", {"kind": "flat", "width": "34"}),
    "disc-lobe": Starter(
        "A valve lobe for a flat tappet.",
        "disc",
        {
            "base_radius": "18",
            "follower": {"kind": "flat", "width": "27"},
            "motion": "{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}",
        },
        {"part": {"thickness": "14"}},
        unfit=("conjugate",),
    ),
    "disc-card": Starter(
        "A valve lobe for a flat tappet by its cam card: crank degrees above given lifts.",
        "disc",
        {
            "base_radius": "18",
            "follower": {"kind": "flat", "width": "30"},
            "motion": (
                "\n    lobe:"
                "\n      lift: 9.2"
                "\n      duration: [{at_lift: 1.27, degrees: 228}, {at_lift: 0.15, degrees: 270}]"
            ),
        },
        {"part": {"thickness": "14"}},
        unfit=("conjugate",),
    ),
    "disc-drop": Starter(
        "A disc cam that drops its roller as quickly as its limits allow.",
        "disc",
        {
            "base_radius": "40",
            "follower": {"kind": "roller", "radius": "8"},
            "motion": (
                "\n    - {rise: 20, over: 200, law: cycloidal}"
                "\n    - {dwell: 60}"
                "\n    - {return: 20, over: least, law: modified-sine}"
                "\n    - {dwell: rest}"
            ),
        },
        {"limits": "{pressure-angle: {at_most: 35}, radius-of-curvature: {at_least: 12}}"},
    ),
    "disc-arm-flat": _disc(
        "a flat face on an arm, which swings", "36", "10", {"kind": "flat", "arm": {"pivot": "90", "face": "10"}}
    ),
    "disc-shoe": _disc("a curved shoe on a stem", "30", "10", {"kind": "shoe", "radius": "60"}),
    "disc-knife-edge": _disc("a knife edge on a stem", "30", "12", {"kind": "knife-edge"}),
    "disc-conjugate": Starter(
        "Two discs on one shaft, for a stem with a roller on either side of it.",
        "disc",
        {
            "base_radius": "36",
            "follower": {"kind": "roller", "radius": "9", "offset": "6"},
            "conjugate": {"distance": "120", "radius": "11", "gap": "2"},
            "motion": _DWELLS.format("24"),
        },
        {"part": {"thickness": "12", "bore": "20"}},
        unfit=("track", "length", "angle", "arm", *(feature.name for feature in FEATURES if not feature.of_pair)),
    ),
    "disc-ring": Starter(
        "A ring for a roller that runs inside it, on a stem.",
        "disc",
        {
            "track": "internal",
            "base_radius": "60",
            "follower": {"kind": "roller", "radius": "9"},
            "motion": _DWELLS.format("12"),
        },
        {"part": {"thickness": "8", "outer": "170", "bolts": {"count": "6", "circle": "158", "hole": "5"}}},
        unfit=(*OF_A_DISC, "conjugate"),
    ),
    "disc-groove": Starter(
        "A disc with a groove that pushes a roller on a stem out and back.",
        "disc",
        {
            "base_radius": "36",
            "track": {"groove": {"clearance": "0.03", "depth": "6"}},
            "follower": {"kind": "roller", "radius": "9"},
            "motion": _DWELLS.format("20"),
        },
        {"part": {"thickness": "12", "bore": "16", "outer": "160"}},
        unfit=("undercut", *_UNGROOVED),
    ),
    "constant-diameter": Starter(
        "A cam between two opposite rollers of one frame, from its motion over one half turn.",
        "constant-diameter",
        {
            "base_radius": "28",
            "roller_radius": "8",
            "motion": "\n    - {rise: 12, over: 80, law: modified-sine}\n    - {dwell: 100}",
        },
    ),
    "double-roller": _roller(
        "A single disk that works two rollers on one arm, from a trigonometric polynomial.",
        "4/3",
        "delta",
        {"cos": "{1: 625}"},
    ),
    "double-roller-law": _roller(
        "A single disk that works two rollers on one arm, from its motion.",
        "2",
        "law",
        "\n    - {rise: 8, over: 40, law: cycloidal}\n    - {dwell: 10}\n    - {return: 8, over: 40, law: cycloidal}",
    ),
    "double-roller-arc": _roller(
        "A single disk that works two rollers on one arm, from a circular first arc.", "3", "arc", {"radius": "75"}
    ),
    "double-roller-rosette": _roller(
        "A single disk that works two rollers on one arm, from a leaf of a rosette.",
        "5/3",
        "rosette",
        {"leaf": "8*sin(pi*x)"},
    ),
    "flat-pair": Starter(
        "A single disk that works a rigid pair of flat faces.",
        "flat-pair",
        {"ratio": "2", "arm": "30", "delta": {"cos": "{1: 252}"}},
    ),
    "four-bar": Starter(
        "A cam in a square frame, the frame the coupler of a four-bar that dwells.",
        "support",
        {"p": DWELLING, "shaft": "[18, 8.5]"},
        FOUR_BAR,
    ),
    "inverted-slider-crank": Starter(
        "A cam in a square frame that slides on a rocker, which dwells.",
        "support",
        {"p": DWELLING, "shaft": "[18.5, 8.5]"},
        {
            "linkage": {"kind": "inverted-slider-crank", "ground": "130", "rocker": "70"},
            "dwell": {"band": "0.1", "at_least": "35"},
        },
    ),
    "slider-crank": Starter(
        "A cam in a square frame, the frame the coupler of a slider-crank.",
        "support",
        {"hypocycloid": {"cusps": "3", "size": "2", "breadth": "50"}, **_SHAFT},
        {"linkage": {"kind": "slider-crank", "coupler": "75", "offset": "5"}, "dwell": {"band": "0.1"}},
    ),
}

# in the order of use, the most frequent first: what each is for, and by which other words it is sought
_TASKS = {
    "disc-roller": (
        "one roller, held by a spring",
        "plate disk translating stem rise dwell return fall single lift tappet base radius prime circle",
    ),
    "toy": (
        "two bumps, hand cranked",
        "automata automaton 3d print printed printing crank wood lobes two paper kids simple stl",
    ),
    "disc-flat": ("a flat face, held by a spring", "tappet mushroom plate disk translating stem"),
    "disc-arm": ("a roller on a swinging arm, held by a spring", "oscillating rocker lever pivot plate disk"),
    "disc-lobe": ("valve lobe", "engine motor camshaft intake exhaust bucket tappet poppet"),
    "disc-card": ("valve lobe by its cam card", "engine motor camshaft duration lift degrees intake exhaust grind"),
    "disc-groove": ("a roller in a groove, no spring", "face track slot closed positive desmodromic box"),
    "constant-diameter": (
        "two rollers in one frame, no spring",
        "yoke conjugate positive desmodromic diametral scotch",
    ),
    "constant-breadth": ("two flat faces in one frame, no spring", "yoke width positive desmodromic breadth film"),
    "disc-drop": ("a roller that drops at once", "snap quick fall hammer step snail"),
    "disc-ring": ("a roller inside a ring", "internal inner track hollow"),
    "disc-shoe": ("a curved shoe, held by a spring", "slipper round tip crowned domed mushroom"),
    "disc-knife-edge": ("a knife edge, held by a spring", "point pointed tip pencil needle stylus"),
    "disc-arm-flat": ("a flat face on a swinging arm", "oscillating rocker finger pad lever"),
    "disc-conjugate": (
        "two discs for two rollers, no spring",
        "complementary conjugate double twin positive desmodromic loom",
    ),
    "reuleaux": ("Reuleaux triangle", "constant width breadth polygon square hole drill rounded"),
    "double-roller-law": (
        "Wunderlich: two rollers on one arm, one disc, no spring",
        "positive desmodromic oscillating rocker double roller conjugate base radius prime circle",
    ),
    "double-roller": (
        "Wunderlich, from a polynomial",
        "two rollers one arm disc trigonometric base radius prime circle",
    ),
    "double-roller-arc": ("Wunderlich, from a circular arc", "two rollers one arm disc base radius prime circle"),
    "double-roller-rosette": ("Wunderlich, from a rosette", "two rollers one arm disc leaf base radius prime circle"),
    "flat-pair": ("Wunderlich: two flat faces on one arm", "positive desmodromic oscillating pair"),
    "support": ("a curve by a formula", "support function p(t) convex constant width"),
    "fourier": ("a curve by its harmonics", "fourier series constant width breadth support function"),
    "hypocycloid": ("a rounded hypocycloid", "deltoid astroid constant width parallel"),
    "four-bar": ("a linkage that dwells: four-bar", "square frame coupler rocker long dwell"),
    "inverted-slider-crank": ("a linkage that dwells: rocker", "square frame slides inverted crank"),
    "slider-crank": ("a linkage that dwells: slider-crank", "square frame coupler piston slide"),
}
_CORE = {name: replace(_EACH[name], task=task, also=also) for name, (task, also) in _TASKS.items()}

STARTERS: Gathered[Starters, Starter] = Gathered(_CORE, STARTING, lambda answers: answers.starters)
"""Every starter by its name, the core's and those of capabilities."""

_REST: Given = {
    "units": "mm",
    "rotation": "cw",
    "part": {"thickness": "8", "bore": "10"},
    "export": {"tolerance": "0.001", "files": "[dxf, svg, stl, csv, html]"},
    "verify": {"angles": "3600"},
}


def starters_for(kind: str) -> tuple[str, ...]:
    """Names of the starters of a kind of cam, such as disc; empty for a word that is no kind."""
    return tuple(name for name, entry in STARTERS.items() if entry.root == CAM and entry.kind == kind)


def starter(kind: str) -> str:
    """Text of the starter named `kind`; raises ValueError for a name that is none of STARTERS."""
    if kind not in STARTERS:
        meant = starters_for(kind) or tuple(name for name, one in STARTERS.items() if kind.lower() in one.also.split())
        known = f"there is {either(meant or tuple(STARTERS), 'and')}"
        hint = known if meant else suggestion(kind, STARTERS) or known
        raise ValueError(f"no starter for {kind!r}; {hint}")
    chosen = STARTERS[kind]
    fields: Given = {**_REST, "cam": {"kind": chosen.kind, **chosen.cam}, **chosen.more}
    lines = _lines(_recipe(kind, chosen) if chosen.root == CAM else reading(chosen.root).table(), fields, "")
    return "\n".join([f"# {chosen.title} Lengths in mm, angles in degrees.", *lines, ""])


def _recipe(name: str, chosen: Starter) -> FieldTable:
    """Table of a starter's recipe, with the keys of its kinds of cam and linkage.

    Without a linkage the starter's `unfit` fields, `dwell` and `verify.output_error` are left out, and `linkage` too
    for a cam that cannot drive one.
    """
    linkage = chosen.more.get("linkage")
    kinds = {"cam": _with_forms(_kind_table("the kind of cam", CAMS, chosen.kind), chosen)}
    if isinstance(linkage, dict):
        kinds["linkage"] = _kind_table("the kind of linkage", LINKAGES, str(linkage["kind"]))
    fields = (
        replace(item, table=kinds.get(item.name, item.table))
        for item in recipe_table().fields
        if name not in item.unshown
    )
    if linkage:
        return FieldTable(tuple(fields))
    unfit = {*chosen.unfit, "dwell", "output_error"}
    unfit |= set() if "plate" in FAMILIES[chosen.kind].arrangement.offers else {"linkage"}
    return FieldTable(tuple(_leave_out(item, unfit) for item in fields if item.name not in unfit))


def _with_forms(table: FieldTable, chosen: Starter) -> FieldTable:
    """The table in which each field with kinds has the keys of the starter's kind."""

    def shown(item: Field) -> Field:
        value = chosen.cam.get(item.name)
        if not isinstance(value, dict) or item.form is None or not item.form.tables:
            return item
        table_of_kind = _kind_table(f"the kind of {item.name}", item.form.tables, str(value["kind"]))
        return replace(item, table=_without(table_of_kind, set(chosen.unfit)))

    return replace(table, fields=tuple(map(shown, table.fields)))


def _leave_out(item: Field, unfit: set[str]) -> Field:
    if item.name not in {"verify", "part"} or item.table is None:
        return item
    return replace(item, table=_without(item.table, unfit))


def _without(table: FieldTable, unfit: set[str]) -> FieldTable:
    return replace(table, fields=tuple(item for item in table.fields if item.name not in unfit))


def _kind_table(about: str, tables: Mapping[str, FieldTable], kind: str) -> FieldTable:
    """Table of one kind with the field `kind` before the others."""
    first = Field("kind", Kind.CHOICE, f"{about}: {either(tuple(tables))}")
    return replace(tables[kind], fields=(first, *tables[kind].fields))


def _lines(table: FieldTable, values: Given, indent: str) -> Iterator[str]:
    """Lines of a table's fields: given ones with their values, others as comments, rival alternatives in one line."""
    rivals = tuple(name for name, _ in table.alternatives if name not in values)
    chosen = tuple(name for name, _ in table.alternatives if name in values)
    for item in table.fields:
        about, value = item.about + _note(item), values.get(item.name)
        if isinstance(value, str):
            yield _line(f"{indent}{item.name}", value, about)
        elif value is not None and item.table is not None:
            yield _line(f"{indent}{item.name}", "", about)
            yield from _lines(item.table, value, f"{indent}  ")
        elif item.name not in rivals:
            yield _line(f"{indent}# {item.name}", "", f"{about}; default: {item.default or 'none'}")
    if rivals:
        yield f"{indent}# instead of {either(chosen)}: {either(rivals)}"


def _note(item: Field) -> str:
    if item.name != "kind" and item.choices:
        return f": {either(item.choices)}"
    return ", mm" if item.kind in {Kind.LENGTH, Kind.POINT} else ""


def _line(key: str, text: str, comment: str) -> str:
    first, *more = text.split("\n")
    head = f"{key}: {first}".rstrip()
    return "\n".join([f"{head:<{_COMMENT - 1}} # {comment}", *more])
