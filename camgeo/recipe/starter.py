"""Recipes to start from: each one valid as it stands, its comments taken from the schema."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from camgeo.recipe.errors import suggestion
from camgeo.recipe.spec import Field, Kind, Table, either
from camgeo.recipe.table_cam import CAMS
from camgeo.recipe.tables import FILES, RECIPE

if TYPE_CHECKING:
    from collections.abc import Iterator

_COMMENT = 40  # column at which comments stand


Given: TypeAlias = dict[str, "str | Given"]  # the text of a field, or the fields of a mapping


@dataclass(frozen=True)
class _Starter:
    """A title, the kind of cam, and the fields of the cam that are given."""

    title: str
    kind: str
    cam: Given


def _roller(title: str, ratio: str, route: str, given: str | Given) -> _Starter:
    return _Starter(title, "double-roller", {"ratio": ratio, "arm": "60", "roller_radius": "8", route: given})


_PIVOT: Given = {"pivot": "[10, 4]"}
_STARTERS = {
    "support": _Starter(
        "A cam from a formula for its support function.", "support", {"p": "25 + 2*cos(3*t)", **_PIVOT}
    ),
    "fourier": _Starter(
        "A cam from a Fourier series; odd harmonics alone give constant breadth.",
        "support",
        {"fourier": {"mean": "25", "cos": "{3: 1.5}", "sin": "{5: 0.3}"}, **_PIVOT},
    ),
    "reuleaux": _Starter(
        "A regular Reuleaux polygon with rounded corners.",
        "support",
        {"reuleaux": {"sides": "3", "breadth": "50", "rounding": "5"}, **_PIVOT},
    ),
    "hypocycloid": _Starter(
        "The parallel curve of a hypocycloid.",
        "support",
        {"hypocycloid": {"cusps": "3", "size": "2", "breadth": "50"}, **_PIVOT},
    ),
    "constant-breadth": _Starter(
        "A cam between two parallel faces, from its motion over one half turn.",
        "constant-breadth",
        {
            "base_radius": "40",
            "motion": "\n    - {rise: 20, over: 120, law: modified-sine}\n    - {dwell: 60}",
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
    "flat-pair": _Starter(
        "A single disk that works a rigid pair of flat faces.",
        "flat-pair",
        {"ratio": "2", "arm": "30", "delta": {"cos": "{1: 252}"}},
    ),
}

KINDS = tuple(_STARTERS)

_REST: Given = {
    "units": "mm",
    "rotation": "cw",
    "part": {"thickness": "8", "bore": "10"},
    "export": {"tolerance": "0.001", "files": f"[{', '.join(FILES)}]"},
    "verify": {"angles": "3600"},
}


def starter(kind: str) -> str:
    """Write a recipe to start from; raises ValueError for a kind that is not one of KINDS."""
    if kind not in _STARTERS:
        hint = suggestion(kind, KINDS) or f"there is {either(KINDS, 'and')}"
        raise ValueError(f"no starter for {kind!r}; {hint}")
    chosen = _STARTERS[kind]
    cam = Table((Field("kind", Kind.CHOICE, f"the kind of cam: {either(tuple(CAMS))}"), *CAMS[chosen.kind].fields))
    cam = replace(cam, alternatives=CAMS[chosen.kind].alternatives)
    recipe = Table(tuple(replace(field, table=cam) if field.name == "cam" else field for field in RECIPE.fields))
    lines = _lines(recipe, {**_REST, "cam": {"kind": chosen.kind, **chosen.cam}}, "")
    return "\n".join([f"# {chosen.title} Lengths in mm, angles in degrees.", *lines, ""])


def _lines(table: Table, given: Given, indent: str) -> Iterator[str]:
    """Write the fields of a table: those given, the others as comments, rival alternatives in one line."""
    rivals = tuple(name for name, _ in table.alternatives if name not in given)
    chosen = tuple(name for name, _ in table.alternatives if name in given)
    for field in table.fields:
        about, value = field.about + _note(field), given.get(field.name)
        if isinstance(value, str):
            yield _line(f"{indent}{field.name}", value, about)
        elif value is not None and field.table is not None:
            yield _line(f"{indent}{field.name}", "", about)
            yield from _lines(field.table, value, f"{indent}  ")
        elif field.name not in rivals:
            yield _line(f"{indent}# {field.name}", "", f"{about}; default: {field.default or 'none'}")
    if rivals:
        yield f"{indent}# instead of {either(chosen)}: {either(rivals)}"


def _note(field: Field) -> str:
    if field.name != "kind" and field.choices:
        return f": {either(field.choices)}"
    return ", mm" if field.kind in {Kind.LENGTH, Kind.POINT} else ""


def _line(key: str, text: str, comment: str) -> str:
    first, *more = text.split("\n")
    head = f"{key}: {first}".rstrip()
    return "\n".join([f"{head:<{_COMMENT}}# {comment}", *more])
