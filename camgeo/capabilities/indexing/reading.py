"""Reading the recipe of an indexing cam: its faults between keys, and its value."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

from camgeo.capabilities.indexing.forms import Barrel, Globoid
from camgeo.capabilities.indexing.index_recipe import Drive, IndexRecipe
from camgeo.capabilities.indexing.keys import EXAMPLE, FILES, FLOOR_GAP, NO_PROGRAM, RECIPE, SOLID_OF_IT
from camgeo.capabilities.indexing.turrets import BarrelTurret, GloboidTurret, Roller, reaching
from camgeo.common.rounding import downward, upward
from camgeo.formats.turned import programs_in
from camgeo.motions.motion import check_filled
from camgeo.part import bore
from camgeo.part.keyway import FEATURE as KEYWAY
from camgeo.part.keyway import check_round
from camgeo.part.part import Part
from camgeo.recipe.export import build_export, check_files
from camgeo.recipe.figure_bounds import build_bounds, check_bounds
from camgeo.recipe.own_kind import begin, finish
from camgeo.recipe.recipe import Verify
from kin.numeric.angles import TURN
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.turrets import Turret
    from camgeo.recipe.document import Document
    from camgeo.schema.errors import RecipeError
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source

ANGLES = 1  # what a disc would be judged at: such a cam is judged at all angles
NOT_YET = {
    "cam.sizing": "give the radius of the blank, turret.radius and turret.roller",
    "manufacture": f"a program of a barrel has its cutter and feeds beside its axes, {{gcode: {{{EXAMPLE}}}}}",
    "made": "measured points of an indexing cam are not judged",
}
"""Keys of what is not made, each with what is."""
FORMATS_NOT_YET = ("svg", "step")
RIDGE = 0.02  # mm by which what two cuts along the groove clear is wider than that
NOTHING = 1e-9  # mm: a length below it is none
APART = 0.8  # of the distance in a globoid's throat from a roller's axis to the next one, that a roller may fill
LEAST_ROLLER = 0.01  # of a barrel's radius or a globoid's distance: the time of a proof grows with its inverse
STEEPEST_END = math.sin(math.radians(80.0))  # of a globoid's end face, seen from the turret's axis


def reader_of(source: Source) -> tuple[Reader, Values]:
    """Reader that has read the text of an indexing cam, but for faults between its keys; and its values."""
    reader, values = begin(source, "indexing", RECIPE, swings=True)
    reader.errors = [_not_yet(error) for error in reader.errors]
    return reader, values


def read_indexing(source: Source, path: Path) -> IndexRecipe:
    """Read the recipe of an indexing cam; raises RecipeErrors with all its faults."""
    return finish(*reader_of(source), path, _check, _built)


def _not_yet(error: RecipeError) -> RecipeError:
    """The fault of a key or a format that is not made, said so; any other fault as it is."""
    unknown = error.problem == "unknown key" or error.problem.endswith(f" takes no {error.path}")
    if unknown and error.path in NOT_YET:
        return replace(error, problem="not made yet", remedy=f"leave it out: {NOT_YET[error.path]}")
    for word in FORMATS_NOT_YET:
        if error.problem.endswith(f" takes no {word}"):
            return replace(error, problem=f"{word} is not made yet of an indexing cam", remedy="give stl, 3mf or ply")
    return error


def _shown(value: float, reader: Reader) -> str:
    return f"{value / reader.mm:.9g} {reader.units}"


def _less(value: float, reader: Reader) -> str:
    """A length a little below a bound, mm, in the recipe's unit."""
    return f"{downward(value / reader.mm, 5)} {reader.units}"


def _more(value: float, reader: Reader) -> str:
    return f"{upward(value / reader.mm, 5)} {reader.units}"


def _check(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values["part"]
    why = "a turn of the cam advances the turret once"
    check_filled(cam["motion"], "cam.motion", TURN, "the whole turn, 360 degrees", reader, why=why)
    _check_turret(cam, reader)
    _check_drive(cam.get("drive", {}), reader)
    check_round(part, reader)
    check_files(values, reader, FILES)
    if reader.errors:
        return
    (_check_barrel if "barrel" in cam else _check_globoid)(values, reader)
    if reader.errors:
        return
    _check_roller(values, reader)
    _check_developments(values, reader)
    _check_programs(values, reader)
    _check_limits(values, reader)


def _check_turret(cam: Values, reader: Reader) -> None:
    """Note keys of the turret that do not go together, or not with the form of the cam."""
    turret, path = cam["turret"], "cam.turret"
    if "barrel" in cam and "radius" not in turret:
        remedy = "give the distance of the rollers' axes from the turret's"
        reader.fault(reader.marks[path], f"{path}.radius", "missing, needed with a barrel", None, remedy)
    if "globoid" in cam:
        for key, why in (("radius", "its rollers are radial"), ("side", "it has no side")):
            if key in turret:
                remedy = f"leave it out: {why}"
                reader.fault_at(f"{path}.{key}", "does not go with a globoid", None, remedy)
    if "preload" in turret:
        if "clearance" in turret:
            reader.fault_at(f"{path}.preload", "does not go with clearance", None, "leave one of them out")
        if not turret["preload"] < turret["roller"]:
            remedy = f"give a few hundredths of a mm, less than {_shown(turret['roller'], reader)}"
            problem = "no less than the radius of the roller"
            reader.fault_at(f"{path}.preload", problem, _shown(turret["preload"], reader), remedy)


def _check_drive(drive: Values, reader: Reader) -> None:
    for key in ("material", "roller_material"):
        if key in drive and not _loaded(drive):
            problem = "cannot stand without load, or rpm and inertia"
            reader.fault_at(f"cam.drive.{key}", problem, None, "give load beside it, or leave it out")
    if "roller_material" in drive and "material" not in drive:
        remedy = "give material beside it"
        reader.fault_at("cam.drive.roller_material", "cannot stand without material", None, remedy)
    if "inertia" in drive and "rpm" not in drive:
        remedy = "give rpm beside it, or leave it out"
        reader.fault_at("cam.drive.inertia", "cannot stand without rpm", None, remedy)


def _loaded(drive: Values) -> bool:
    """Whether the drive says what torque the turret takes."""
    return "load" in drive or ("inertia" in drive and "rpm" in drive)


def _check_barrel(values: Values, reader: Reader) -> None:
    """Note a floor that the rollers of a barrel do not pass."""
    cam = values["cam"]
    most = cam["barrel"]["radius"] - _largest(cam["turret"])
    if not cam["depth"] < most:
        problem = "the floor is no farther from the axis than the radius of the roller"
        remedy = f"give less than {_less(most, reader)}, or a smaller roller"
        remedy = remedy if most > NOTHING else "give a smaller roller, or a larger blank"
        reader.fault_at("cam.depth", problem, _shown(cam["depth"], reader), remedy)


def _check_globoid(values: Values, reader: Reader) -> None:
    """Note a globoid without a core, and one whose ends lie beside its throat."""
    cam, length = values["cam"], values["part"]["length"]
    form, height = cam["globoid"], _height(values)
    least = form["radius"] + cam["depth"] + _largest(cam["turret"])
    if not form["distance"] > least:
        problem = "the floor is no farther from the cam's axis than the radius of the roller"
        remedy = f"give more than {_more(least, reader)}, or a smaller globoid.radius or depth"
        reader.fault_at("cam.globoid.distance", problem, _shown(form["distance"], reader), remedy)
    most = STEEPEST_END * form["radius"]
    if not max(abs(height), abs(length - height)) < most:
        problem = "the ends of the cam lie beside the throat, which is an arc about the turret's axis"
        remedy = f"give less than {_less(2.0 * most, reader)}, with the turret's axis in the middle of it"
        reader.fault_at("part.length", problem, _shown(length, reader), remedy)


def _largest(turret: Values) -> float:
    """The larger radius of a roller, mm, of those of both flanks."""
    return float(turret["roller"] + turret.get("clearance", 0.0))


def _height(values: Values) -> float:
    """Height of the turret's axis over the lower face, mm."""
    return float(values["cam"]["turret"].get("height", 0.5 * values["part"]["length"]))


def _ends(cam: Values) -> tuple[float, float]:
    """Where a roller begins and ends to bear, mm."""
    turret, depth = cam["turret"], cam["depth"]
    if "barrel" in cam:
        blank = cam["barrel"]["radius"]
        inner, outer = blank - depth + FLOOR_GAP, blank
    else:
        blank = cam["globoid"]["radius"]
        inner, outer = blank, reaching(blank + depth - FLOOR_GAP, turret["roller"])
    return turret.get("from", inner), turret.get("to", outer)


def _check_roller(values: Values, reader: Reader) -> None:
    """Note rollers that reach the floor, bear nowhere, or stand in one another's way."""
    cam = values["cam"]
    turret, path, (begins, ends) = cam["turret"], "cam.turret", _ends(cam)
    barrel = "barrel" in cam
    blank = cam["barrel" if barrel else "globoid"]["radius"]
    floor = blank - cam["depth"] if barrel else blank + cam["depth"]
    deepest = floor if barrel else reaching(floor, turret["roller"])
    if barrel and not begins > floor:
        remedy = f"give more than {_shown(floor, reader)}, or a greater depth"
        reader.fault_at(f"{path}.from", "the roller's end stands on the floor", _shown(begins, reader), remedy)
    elif not barrel and "to" in turret and not ends < deepest:
        remedy = f"give less than {_less(deepest, reader)}, or a greater depth"
        problem = "the rim of the roller's end stands on the floor"
        reader.fault_at(f"{path}.to", problem, _shown(ends, reader), remedy)
    elif not ends > begins or (not begins < blank if barrel else not ends > blank):
        at = next((f"{path}.{key}" for key in ("from", "to") if key in turret), "cam.depth")
        low, high = min(deepest, blank), max(deepest, blank)
        remedy = f"let it bear between {_shown(low, reader)} and {_less(high, reader)}"
        rim = 0.0 if barrel else math.hypot(begins, turret["roller"]) - begins
        remedy = remedy if at != "cam.depth" else f"give more than {_more(FLOOR_GAP + rim, reader)}"
        reader.fault_at(at, "the roller bears nowhere", None, remedy)
    least = LEAST_ROLLER * (blank if barrel else cam["globoid"]["distance"])
    if turret["roller"] < least:
        problem = f"too small beside the cam: it is less than {100.0 * LEAST_ROLLER:g} percent of "
        problem += "the blank's radius" if barrel else "the distance of both axes"
        remedy = f"give at least {_more(least, reader)}"
        reader.fault_at(f"{path}.roller", problem, _shown(turret["roller"], reader), remedy)
    half = math.pi / turret["stops"]
    if barrel:
        room = turret["radius"] * math.sin(half)
    else:
        room = min(begins * math.sin(half), APART * blank * math.sin(min(2.0 * half, 0.5 * math.pi)))
    if not turret["roller"] < room:
        problem = "neighbouring rollers of the turret touch one another"
        remedy = f"give less than {_less(room, reader)}, or fewer stops"
        reader.fault_at(f"{path}.roller", problem, _shown(turret["roller"], reader), remedy)


def _check_developments(values: Values, reader: Reader) -> None:
    """Note developments of a globoid, and radii of a development that lie on no flank."""
    cam = values["cam"]
    for file in values.get("export", {}).get("files", []):
        if file["kind"] != "dxf":
            continue
        if "globoid" in cam:
            remedy = "give stl, 3mf or ply: a torus is not unrolled without stretching"
            reader.fault_at(file["path"], "a globoid has no development", None, remedy)
            continue
        low, high = cam["barrel"]["radius"] - cam["depth"], cam["barrel"]["radius"]
        for i, radius in enumerate(file.get("at", ())):
            if not isinstance(radius, str) and not low - NOTHING <= radius <= high + NOTHING:
                remedy = f"give one from {_shown(low, reader)} to {_shown(high, reader)}"
                where = f"{file['path']}.{file['kind']}.at[{i}]"
                reader.fault_at(where, "no flank there", _shown(radius, reader), remedy)


def _check_programs(values: Values, reader: Reader) -> None:
    """Note programs of a globoid, what a program lacks, and a cutter that does not leave the flanks, or the groove."""
    cam, turret = values["cam"], values["cam"]["turret"]
    if "globoid" in cam:
        for file in values.get("export", {}).get("files", []):
            if FILES[file["kind"]].program:
                reader.fault_at(file["path"], NO_PROGRAM, None, SOLID_OF_IT)
        return
    play = turret.get("clearance", 0.0) - turret.get("preload", 0.0)
    smaller = turret["roller"] + min(play, 0.0)
    narrowest = turret["roller"] + 0.5 * play + RIDGE
    for file in programs_in(values, reader, EXAMPLE):
        path, told = f"{file['path']}.{file['kind']}", _shown(file["cutter"], reader)
        if "Y" not in file["axes"]:
            problem = "a barrel's rollers stand beside its axis, and so does the cutter"
            reader.fault_at(f"{path}.axes", problem, ", ".join(file["axes"]), "give [X, Y, A]")
        allowance = file.get("allowance", 0.0)
        widest = 2.0 * (smaller - allowance)
        if file["cutter"] > widest + NOTHING and widest <= narrowest:
            remedy = f"give an allowance below {_less(smaller - 0.5 * narrowest, reader)}"
            reader.fault_at(f"{path}.allowance", "leaves no room for a cutter", _shown(allowance, reader), remedy)
        elif file["cutter"] > widest + NOTHING:
            what = "the smaller roller less the allowance on both flanks" if allowance else "the smaller roller"
            problem, remedy = (
                f"a cutter wider than {what} cuts the flanks away",
                f"give at most {_shown(widest, reader)}",
            )
            reader.fault_at(f"{path}.cutter", problem, told, remedy)
        elif file["cutter"] < narrowest - NOTHING:
            remedy = f"give at least {_more(narrowest, reader)}"
            reader.fault_at(f"{path}.cutter", "does not clear the groove along both flanks", told, remedy)


def _check_limits(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values["part"]
    drive = cam.get("drive", {})
    driven, loaded = ("rpm" in drive, "cam.drive.rpm"), (_loaded(drive), "cam.drive.load, or rpm and inertia")
    there = {
        "play": (cam["turret"].get("clearance", 0.0) > 0.0, "cam.turret.clearance"),
        "velocity": driven,
        "acceleration": driven,
        "turret-torque": loaded,
        "torque": loaded,
        "contact-force": loaded,
        "contact-pressure": ("material" in drive, "cam.drive.load and material"),
        "mass": ("density" in part, "part.density"),
    }
    check_bounds(values.get("limits", {}), there, reader)


def _built(values: Values, document: Document, reader: Reader) -> IndexRecipe:
    """Make the recipe of values in which there is no fault."""
    cam, part = values["cam"], values["part"]
    keyway, given = KEYWAY.build(part), cam["turret"]
    inner, outer = _ends(cam)
    return IndexRecipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=reader.mm,
        rotation=values.get("rotation", "cw"),
        export=build_export(values.get("export", {}), FILES, "stl"),
        verify=Verify(angles=ANGLES, **values.get("verify", {})),
        turret=_turret(values),
        roller=Roller(given["roller"], inner, outer),
        stops=given["stops"],
        start=given.get("start", -math.pi / given["stops"]),
        clearance=given.get("clearance", 0.0) - given.get("preload", 0.0),
        motion=cam["motion"],
        part=Part(
            thickness=part["length"],
            wall=part.get("wall"),
            density=part.get("density"),
            features=() if keyway is None else (keyway,),
            **bore.build_bore(part),
        ),
        drive=Drive(**cam.get("drive", {})),
        limits=build_bounds(values.get("limits", {})),
        **vars(document),
    )


def _turret(values: Values) -> Turret:
    """The turret, with the form of the cam beside it."""
    cam, length, height = values["cam"], values["part"]["length"], _height(values)
    given = cam["turret"]
    common: dict[str, Any] = {"depth": cam["depth"], "height": height, "length": length}
    if "globoid" in cam:
        distance = cam["globoid"]["distance"]
        return GloboidTurret(Globoid(radius=cam["globoid"]["radius"], distance=distance, **common))
    side: Literal[-1, 1] = -1 if given.get("side") == "leading" else 1
    pitch = given["radius"]
    usual = 0.5 * side * pitch * (1.0 + math.cos(math.pi / given["stops"]))
    offset = cam["barrel"].get("offset", usual)
    return BarrelTurret(Barrel(radius=cam["barrel"]["radius"], offset=offset, pitch=pitch, side=side, **common))
