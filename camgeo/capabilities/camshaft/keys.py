"""Camshafts: lobes of several recipes on one shaft, phased by cam degrees or by an engine's data."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from camgeo.capabilities.camshaft.extension import writers
from camgeo.formats.tables.tabled import check_step
from camgeo.motions.lift_table import read_path
from camgeo.part.bore import LEAST_SIZE
from camgeo.recipe.export import build_export, export_of
from camgeo.recipe.keys import CORE, UNITS, recipe_table
from camgeo.recipe.machining import COARSEST, FINEST
from camgeo.recipe.own_kind import begin, finish
from camgeo.recipe.recipe import (
    ANGLES,
    Order,
    ShaftOrder,
    Verify,
    file_bytes,
    of_source,
)
from camgeo.registry.formats import FORMATS
from camgeo.schema.errors import RecipeErrors, quote, suggestion
from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm, coordinate, length, mapping
from camgeo.schema.file_bytes import path_fault
from camgeo.schema.lists import list_of
from camgeo.schema.yaml_source import Mapping, entries, read_source
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from camgeo.recipe.document import Document
    from camgeo.recipe.export import Length
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.formats import Format
    from camgeo.schema.errors import RecipeError
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source

MOST_LOBES = 64
MOST_CYLINDERS = 16
DECIMALS = 9  # of a length in mm: what sums of heights are rounded by is cut off
ROUNDING = 1e-9  # mm: far above what sums of heights are rounded by, far below any length that is made
LIFT = 1.27  # mm of tappet lift, 0.050 in, at which events are stated


@dataclass(frozen=True)
class Bar:
    """A round part of a shaft from z `low` to `high`, mm: the shaft itself or a journal."""

    name: str
    low: float
    high: float
    diameter: float


@dataclass(frozen=True)
class Engine:
    """Crank data, rad: lobe centres of intake after and of exhaust before dead centre, and when cylinders fire.

    `firing` is by the number of the cylinder; `lift`, mm, at which events are stated, is the tappet's, or the valve's.
    """

    intake: float
    exhaust: float
    firing: dict[int, float]
    lift: float = LIFT
    at_valve: bool = False

    def centre(self, cylinder: int, valve: str) -> float:
        """Cam angle of a lobe's centre, rad, counted from the firing dead centre of the first cylinder in the order."""
        after = self.intake if valve == "intake" else -self.exhaust
        return 0.5 * (TURN + after + self.firing[cylinder])


@dataclass(frozen=True)
class Lobe:
    """A lobe: its cam's recipe, the heights (mm) between which it stands on the shaft, and its phase.

    Either `at`, the cam angle (rad) by which its zero is turned, or `cylinder` and `valve`, intake or exhaust.
    `direction` (rad) is the angle by which its follower is turned about the shaft from where its own recipe has it.
    Both turn counter-clockwise in a drawing for the rotation `cw`, clockwise for `ccw`.
    """

    name: str
    recipe: Recipe
    low: float
    high: float
    at: float | None = None
    cylinder: int | None = None
    valve: str = ""
    direction: float = 0.0

    @property
    def made(self) -> Recipe:
        """Recipe of the cam as it is made on the shaft: as long as the lobe is, and without chamfers."""
        long = round(self.high - self.low, DECIMALS)
        return replace(self.recipe, part=replace(self.recipe.part.with_sharp_edges(), thickness=long))


@dataclass(frozen=True)
class CamshaftRecipe(ShaftOrder):
    """A recipe of a camshaft; its `bars` are the shaft, the first, and its journals."""

    lobes: tuple[Lobe, ...]
    bars: tuple[Bar, ...]
    bore: float | None = None
    engine: Engine | None = None

    root = "camshaft"
    __repr__ = Order.__repr__

    @property
    def parts(self) -> tuple[Path, ...]:
        """Paths of the lobes' recipes, each once."""
        return tuple(dict.fromkeys(lobe.recipe.path for lobe in self.lobes))

    @property
    def trims(self) -> bool:
        """Whether the undercut of some lobe is cut off."""
        return any(lobe.recipe.trims for lobe in self.lobes)


# --- keys -------------------------------------------------------------------------------------------------------------


def _angle(name: str, about: str, least: float, most: float, *, required: bool = False, default: str = "") -> Field:
    return Field(name, Kind.ANGLE, about, required, default=default, at_least=least, at_most=most)


_PATH = OwnForm(
    "the path of a recipe",
    "the path of a lobe's recipe, such as intake.yaml",
    read_path,
    lambda _: {"type": "string", "minLength": 1},
)
LOBE = FieldTable(
    (
        Field("recipe", Kind.OWN, "recipe of the lobe's cam, from this file's folder", required=True, form=_PATH),
        _angle(
            "at",
            "cam degrees by which the lobe's zero is turned counter-clockwise, as drawn with `rotation: cw`",
            -360,
            360,
        ),
        Field("cylinder", Kind.INTEGER, "number of its cylinder, in place of `at`", at_least=1, at_most=MOST_CYLINDERS),
        Field("valve", Kind.CHOICE, "which of the cylinder's valves it opens", choices=("intake", "exhaust")),
        _angle("direction", "angle about the shaft by which its follower is turned likewise", -360, 360, default="0"),
        coordinate("z", "height of the lobe's lower face", required=True),
        length("length", "length of the lobe along the shaft", default="part.thickness of its recipe"),
    ),
    alternatives=(("at", ()), ("cylinder", ("valve",))),
)
JOURNAL = FieldTable(
    (
        coordinate("z", "height of the journal's lower face", required=True),
        length("length", "length along the shaft", required=True),
        length("diameter", "diameter", required=True),
    )
)
ENGINE = FieldTable(
    (
        Field(
            "order", Kind.NUMBERS, "firing order", required=True, unit=Kind.INTEGER, at_least=1, at_most=MOST_CYLINDERS
        ),
        _angle("intake", "centre of the intake lobes, crank degrees after dead centre", 0, 360),
        _angle("exhaust", "centre of the exhaust lobes, crank degrees before dead centre", 0, 360),
        _angle("separation", "mean of both centres, cam degrees between a cylinder's lobes, in their place", 0, 360),
        _angle("advance", "crank degrees by which both stand earlier than that", -180, 180, default="0"),
        length("lift", "lift of the tappet at which events are told", default="1.27 mm"),
        length("valve_lift", "lift of the valve in its place, by `valve` of each lobe's recipe"),
        Field(
            "firing",
            Kind.NUMBERS,
            "crank degrees at which the cylinders of `order` fire",
            default="even",
            unit=Kind.ANGLE,
            at_least=0,
            at_most=720,
        ),
    ),
    alternatives=(("intake", ("exhaust",)), ("separation", ())),
)
CAMSHAFT = Field(
    "camshaft",
    Kind.TABLE,
    "lobes of several recipes on one shaft",
    required=True,
    table=FieldTable(
        (
            mapping(
                "shaft",
                "the shaft between the lobes",
                length("diameter", "diameter", required=True),
                coordinate("from", "height of its lower end", default="0"),
                coordinate("to", "height of its upper end", required=True),
                length("bore", "diameter of a hole all through it", default="none"),
            ),
            list_of("journals", JOURNAL, "its bearings", "[{z: 0, length: 20, diameter: 30}]", MOST_LOBES),
            list_of("lobes", LOBE, "the lobes", "[{recipe: intake.yaml, at: 234, z: 30}]", MOST_LOBES, required=True),
            Field(
                "engine",
                Kind.TABLE,
                "data of a four-stroke engine, for lobes with `cylinder` and `valve`",
                default="none",
                table=ENGINE,
            ),
        )
    ),
)


def _plain(name: str) -> Format:
    """Give the record of a format whose options are unit and tolerance alone."""
    record = FORMATS[name]
    kept = tuple(field for field in record.options.fields if field.name in {"units", "tolerance"})
    return replace(record, options=FieldTable(kept))


def _only(whole: Field, *names: str) -> Field:
    """Give a mapping with some of its keys."""
    return replace(whole, table=FieldTable(tuple(key for key in whole.inner.fields if key.name in names)))


INSPECTION = "inspection"
DIAGRAMS = ("timing", "bars", "cam-wheel", "crank-wheel", "shaft")
OF_AN_ENGINE = frozenset({"cam-wheel", "crank-wheel"})


def _own(name: str, *words: str, more: tuple[Field, ...] = ()) -> Format:
    """Give the record of a format whose forms are a camshaft's own, with more options."""
    about = "which table it is" if name == "csv" else "what is drawn"
    form = Field("as", Kind.CHOICE, about, default=words[0], choices=words)
    return replace(FORMATS[name], options=FieldTable((form, *more)))


DRAWN = "svg"
STEP = Field(
    "step",
    Kind.ANGLE,
    "of inspection, of the shaft between points; 360 degrees are a whole number of it",
    default="by verify.angles",
    at_least=FINEST,
    at_most=COARSEST,
)
SHAFT_FILES = {
    **{name: _plain(name) for name in FORMATS if FORMATS[name].solid},
    "csv": _own("csv", "motion", "events", INSPECTION, more=(STEP,)),
    **{name: FORMATS[name] for name in writers()},
    DRAWN: _own(DRAWN, *DIAGRAMS),
    "html": replace(FORMATS["html"], options=FieldTable(())),
}
SHAFT = FieldTable(
    (
        *(CORE.field(name) for name in ("name", "about", "units", "rotation")),
        CAMSHAFT,
        export_of(SHAFT_FILES, "{csv: {as: events}}", "[stl]"),
        _only(CORE.field("verify"), "angles"),  # the motion of a lobe is judged as its own recipe has it
    )
)


# --- reading ----------------------------------------------------------------------------------------------------------


def read_camshaft(source: Source, path: Path) -> CamshaftRecipe:
    """Read the recipe of a camshaft and those of its lobes.

    Raises RecipeErrors with all faults of the camshaft's own fields, else of the first lobe's recipe that has any, and
    for lobes or journals that overlap or reach beyond the shaft.
    """
    reader, values = begin(source, "camshaft", SHAFT, swings=False)
    reader.errors = [_whole(error) for error in reader.errors]
    return finish(reader, values, path, _check, _built)


def _whole(error: RecipeError) -> RecipeError:
    """The fault of a key `parts`, which solids of a camshaft do not need, said so; any other fault as it is."""
    if error.problem != "unknown key" or error.path.rpartition(".")[2] != "parts":
        return error
    problem = "each solid of a camshaft has shaft, journals and all lobes in one body"
    return replace(error, problem=problem, remedy="leave parts out, as in files: [stl, step]")


def _check(values: Values, reader: Reader) -> None:
    """Note the faults between fields."""
    camshaft = values["camshaft"]
    for file in values.get("export", {}).get("files", []):
        if "step" in file and file["kind"] == "csv" and file.get("as") != INSPECTION:
            reader.fault_at(f"{file['path']}.csv.step", "belongs to a table as inspection", None, "leave it out")
        elif file.get("as") in OF_AN_ENGINE and "engine" not in camshaft:
            remedy = "give camshaft.engine, or {svg: {as: bars}}"
            reader.fault_at(f"{file['path']}.svg.as", "needs the engine's data", f"'{file['as']}'", remedy)
        check_step(file, reader)
    # the engine, then the lobes' cylinders, then the sizes of the shaft
    engine = camshaft.get("engine")
    if engine is not None:
        order, firing, path = engine["order"], engine.get("firing"), "camshaft.engine"
        if len(set(order)) < len(order):
            reader.fault_at(f"{path}.order", "a cylinder fires twice", None, "name each cylinder once")
        if firing is not None and len(firing) != len(order):
            remedy = f"give {len(order)}, one for each cylinder of the order"
            reader.fault_at(f"{path}.firing", f"{len(firing)} angles for {len(order)} cylinders", None, remedy)
        if "valve_lift" in engine and "lift" in engine:
            reader.fault_at(f"{path}.valve_lift", "cannot be combined with lift", None, "give exactly one of them")
        if "advance" in engine and "separation" not in engine:
            reader.fault_at(f"{path}.advance", "needs the lobes' separation", None, "leave it out")
    for i, lobe in enumerate(camshaft["lobes"]):
        path = f"camshaft.lobes[{i}].cylinder"
        if "cylinder" in lobe and engine is None:
            reader.fault_at(path, "needs the engine's data", None, "give camshaft.engine, or `at` in its place")
        elif "cylinder" in lobe and lobe["cylinder"] not in engine["order"]:
            remedy = f"give one of {', '.join(map(str, engine['order']))}"
            reader.fault_at(path, "not in the firing order", str(lobe["cylinder"]), remedy)
    shaft = camshaft.get("shaft")
    if shaft is None:
        mark = reader.marks["camshaft"]
        remedy = "give its diameter and where it ends, such as {diameter: 24, to: 320}"
        reader.fault(mark, "camshaft.shaft", "missing", None, remedy)
        return
    if not shaft.get("from", 0.0) < shaft["to"]:
        reader.fault_at("camshaft.shaft.to", "not above its lower end", None, "give a greater height")
    for key in ("diameter", "bore"):
        if (size := shaft.get(key, LEAST_SIZE)) < LEAST_SIZE:
            remedy = f"give at least {LEAST_SIZE / reader.mm:.3g} {reader.units}"
            reader.fault_at(f"camshaft.shaft.{key}", "smaller than a file can hold", f"{size / reader.mm:g}", remedy)
    if "bore" in shaft and not shaft["bore"] <= shaft["diameter"] - 2.0 * LEAST_SIZE:
        reader.fault_at("camshaft.shaft.bore", "not below the diameter", None, "give a smaller bore, or leave it out")
    for i, journal in enumerate(camshaft.get("journals", [])):
        if not journal["diameter"] > shaft["diameter"]:
            remedy = "give a larger one, or leave the journal out"
            reader.fault_at(f"camshaft.journals[{i}].diameter", "not above the shaft's", None, remedy)


def _built(values: Values, document: Document, reader: Reader) -> CamshaftRecipe:
    """Make the recipe of values in which there is no fault; the lobes' recipes are read here."""
    camshaft, mm = values["camshaft"], reader.mm
    shaft, rotation = camshaft["shaft"], values.get("rotation", "cw")
    rows, bars = camshaft["lobes"], camshaft.get("journals", [])
    low, high = shaft.get("from", 0.0), shaft["to"]
    # stated heights first: sums that differ from them by rounding are then replaced by them
    level = ShaftHeights([low, high, *(row["z"] for row in (*rows, *bars))])
    low, high = level(low), level(high)
    journals = [
        Bar(f"journal {i + 1}", level(row["z"]), level(row["z"] + row["length"]), row["diameter"])
        for i, row in enumerate(bars)
    ]
    cams: dict[str, Recipe] = {}
    for i, row in enumerate(rows):
        if row["recipe"] not in cams:
            cams[row["recipe"]] = _cam(document, row["recipe"], f"camshaft.lobes[{i}].recipe")
    names = _names(rows, cams)
    lobes = []
    for i, (row, name) in enumerate(zip(rows, names, strict=True)):
        cam = cams[row["recipe"]]
        long = row.get("length", cam.part.thickness)
        if long is None:
            where, remedy = f"camshaft.lobes[{i}].length", f"give it, or part.thickness in {row['recipe']}"
            raise document.error(where, "missing, as the lobe's recipe has no thickness", None, remedy)
        own = replace(cam, rotation=rotation, units=values.get("units", "mm"), mm=mm)
        stated = {key: row[key] for key in ("at", "cylinder", "valve", "direction") if key in row}
        lobes.append(Lobe(name, own, level(row["z"]), level(row["z"] + long), **stated))
    _demand_apart(document, lobes, journals, (low, high), values.get("units", "mm"))
    return CamshaftRecipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=mm,
        rotation=rotation,
        export=build_export({"files": [{"kind": "stl"}], **values.get("export", {})}),
        verify=Verify(**{"angles": ANGLES, **values.get("verify", {})}),
        lobes=tuple(lobes),
        bars=(Bar("shaft", low, high, shaft["diameter"]), *journals),
        bore=shaft.get("bore"),
        engine=_engine(camshaft.get("engine")),
        **vars(document),
    )


class ShaftHeights:
    """Heights along a shaft, mm, of which two that differ by rounding alone are made equal.

    A lobe that ends where the next begins is given by a sum, such as 20.1 + 12.3, that need not round to the 32.4 of
    the next. Heights that are stated come first, so that a sum is replaced by a stated height and not the other way
    round.
    """

    def __init__(self, stated: Iterable[float]) -> None:
        self._heights: list[float] = []
        for height in stated:
            self(height)

    def __call__(self, height: float) -> float:
        """First known height, mm, within ROUNDING of `height`, else `height`, which is then known."""
        for known in self._heights:
            if abs(known - height) <= ROUNDING:
                return known
        self._heights.append(height)
        return height


def _engine(values: Values | None) -> Engine | None:
    if values is None:
        return None
    order = values["order"]
    firing = values.get("firing") or [2.0 * TURN * k / len(order) for k in range(len(order))]
    advance = values.get("advance", 0.0)
    intake = values["intake"] if "intake" in values else values["separation"] - advance
    exhaust = values["exhaust"] if "exhaust" in values else values["separation"] + advance
    at_valve = "valve_lift" in values
    lift = values["valve_lift"] if at_valve else values.get("lift", LIFT)
    return Engine(intake, exhaust, dict(zip(order, firing, strict=True)), lift, at_valve)


def _cam(document: Document, name: str, field: str) -> Recipe:
    """Read a lobe's recipe; raises RecipeErrors at the field for each fault in it, and for a file that is no lobe's.

    No message repeats text of a file that is no recipe: its reader need not be allowed to read the file.
    """
    path, remedy = document.path.parent / name, "give the recipe of a cam"
    if fault := path_fault(path):
        raise document.error(field, fault, quote(name), f"give the path of a recipe from {path.parent}")
    try:
        source = read_source(file_bytes(path), str(path))
        top = entries(source.root) if isinstance(source.root, Mapping) else {}
        if "camshaft" in top:
            raise document.error(field, "a camshaft is no lobe", f"'{name}'", remedy)
        known = recipe_table().keys
        if not any(key in known or suggestion(key, known) for key in top):
            raise document.error(field, "no recipe", f"'{name}'", remedy)
        recipe = of_source(source, path)
    except RecipeErrors as errors:
        raise of_a_lobe(document, field, errors) from None
    if recipe.linkage is not None:
        raise document.error(field, "a lobe drives no linkage", f"'{name}'", "give a recipe without one")
    return recipe


def of_a_lobe(document: Document, field: str, errors: RecipeErrors) -> RecipeErrors:
    """Faults of a lobe's recipe as faults of the camshaft's `field` that names it; the camshaft's own stay."""
    own = str(document.path)
    placed = (
        [error] if error.file == own else document.error(field, error.statement, error.value, error.remedy).errors
        for error in errors.errors
    )
    return RecipeErrors(error for faults in placed for error in faults)


def _names(rows: list[Values], cams: dict[str, Recipe]) -> list[str]:
    """Name each lobe: by cylinder and valve, or by its recipe; equal names are numbered."""
    names = [
        f"cylinder {row['cylinder']} {row['valve']}" if "cylinder" in row else cams[row["recipe"]].name for row in rows
    ]
    return [f"{name} {names[: i + 1].count(name)}" if names.count(name) > 1 else name for i, name in enumerate(names)]


def _demand_apart(
    document: Document, lobes: list[Lobe], journals: list[Bar], ends: tuple[float, float], units: Length
) -> None:
    """Raise RecipeErrors where a lobe or a journal reaches beyond the shaft, or into another."""
    fields = [f"camshaft.lobes[{i}].z" for i in range(len(lobes))]
    fields += [f"camshaft.journals[{i}].z" for i in range(len(journals))]
    parts: list[Lobe | Bar] = [*lobes, *journals]
    placed = list(zip(fields, parts, strict=True))

    def span(low: float, high: float) -> str:
        return f"from {low / UNITS[units]:.9g} to {high / UNITS[units]:.9g}"

    for field, part in placed:
        if part.low < ends[0] or part.high > ends[1]:
            problem = f"it reaches {span(part.low, part.high)} {units}, the shaft {span(*ends)} {units}"
            raise document.error(field, problem, None, "give another z, or a longer shaft")
    for (_, part), (field, other) in combinations(placed, 2):
        if part.low < other.high and other.low < part.high:
            problem = f"{other.name} overlaps {part.name}, which reaches {span(part.low, part.high)} {units}"
            raise document.error(field, problem, None, "give another z or a shorter length")
