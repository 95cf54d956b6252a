"""Reading the recipe of a linear cam: its faults between keys, and its value."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.linear.keys import (
    FILES,
    RADIAL,
    RECIPE,
    Arm,
    CrankDrive,
    Drive,
    Ends,
    Follower,
    Groove,
    Hole,
    LinearRecipe,
    PlacedMark,
    Plate,
    Slot,
)
from camgeo.part.mark import Mark
from camgeo.recipe.export import build_export, check_files
from camgeo.recipe.figure_bounds import check_bounds
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from camgeo.recipe.machining import build_manufacture
from camgeo.recipe.materials import check_materials
from camgeo.recipe.own_kind import begin, common_values, entry_at, finish
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.document import Document
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source

PROGRAM_NEEDS = ("cutter", "feed", "plunge", "spindle", "depth_of_cut", "safe_height")


def reader_of(source: Source) -> tuple[Reader, Values]:
    """Reader that has read the text of a linear cam, but for faults between its keys; and its values."""
    return begin(source, "linear", RECIPE, swings=entry_at(source.root, "cam", "follower", "arm") is not None)


def read_linear(source: Source, path: Path) -> LinearRecipe:
    """Read the recipe of a linear cam; raises RecipeErrors with all its faults."""
    return finish(*reader_of(source), path, _check, _built)


def _check(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values.get("part", {})
    _check_follower(cam, reader)
    _check_ends(cam, reader)
    _check_track(cam, part, reader)
    _check_drive(cam.get("drive", {}), reader)
    _check_part(part, reader)
    check_files(values, reader, FILES)
    _check_files(values, reader)
    _check_limits(values, reader)


def _check_follower(cam: Values, reader: Reader) -> None:
    follower, path = cam.get("follower", {}), "cam.follower"
    kind = follower.get("kind", "roller")
    where = path if path in reader.marks else "cam"
    if kind in RADIAL and "radius" not in follower:
        reader.fault(reader.marks[where], f"{path}.radius", "missing", None, f"give the radius of the {kind}")
    if kind not in RADIAL and "radius" in follower:
        reader.fault_at(f"{path}.radius", "a knife edge has no radius", None, "leave it out, or give kind: roller")
    arm = follower.get("arm")
    if arm is None:
        return
    if "lean" in follower:
        reader.fault_at(f"{path}.lean", "an arm has no lean", None, "leave it out; the pivot's height sets it")
    height = cam["base"] + follower.get("radius", 0.0) - arm["pivot"]
    if not abs(height) < arm["length"]:
        low, high = (cam["base"] + follower.get("radius", 0.0) + sign * arm["length"] for sign in (-1.0, 1.0))
        remedy = f"give a pivot between {low / reader.mm:.6g} and {reader.shown(high, 6)}"
        shown = reader.shown(arm["pivot"])
        reader.fault_at(f"{path}.arm.pivot", "the arm does not reach the plate at lift 0", shown, remedy)


def _check_ends(cam: Values, reader: Reader) -> None:
    endless = cam.get("endless", False)
    repeat = cam["motion"][1]
    if not endless and "ends" not in cam:
        remedy = "give ends: {overrun: 5}, the metal beyond the contacts, or endless: true"
        reader.fault(reader.marks["cam"], "cam.ends", "missing", None, remedy)
    if endless and "ends" in cam:
        reader.fault_at("cam.ends", "an endless plate has none", None, "leave one of the two out")
    if not endless and repeat > 1:
        remedy = "give endless: true, or the segments one after another"
        reader.fault_at("cam.motion.repeat", "only an endless motion repeats", f"{repeat}", remedy)


def _check_track(cam: Values, part: Values, reader: Reader) -> None:
    groove = cam.get("track", {}).get("groove")
    if "track" in cam and groove is None:
        reader.fault_at("cam.track", "no groove is given", None, "give groove: {clearance: 0.03}, or leave track out")
    if groove is None:
        if "height" in part:
            reader.fault_at(
                "part.height", "belongs to a plate with a groove", None, "leave it out: the flank is the edge"
            )
        return
    kind = cam.get("follower", {}).get("kind", "roller")
    if kind != "roller":
        remedy = "give a roller, or leave track out"
        reader.fault_at("cam.follower.kind", "does not run in a groove", f"'{kind}'", remedy)
    if cam.get("undercut") == "trim":
        reader.fault_at("cam.undercut", "a groove is not trimmed", "'trim'", "leave it out")
    if "height" not in part:
        at = reader.marks.get("part", reader.marks["cam.track"])
        reader.fault(at, "part.height", "missing, needed with cam.track", None, "give the height of the plate")
    if "depth" in groove and "thickness" in part and not groove["depth"] < part["thickness"]:
        remedy = "give a depth below part.thickness: the plate would fall apart"
        reader.fault_at("cam.track.groove.depth", "not below the thickness", None, remedy)
    if cam.get("endless", False):
        problem = "an endless groove runs out of its plate at both edges, so that no file holds it as one outline"
        reader.fault_at("cam.track", problem, None, "give ends in place of endless, or leave track out")
    if "chamfer" in part:
        reader.fault_at("part.chamfer", "the edges of a groove are not chamfered", None, "leave it out")


def _check_drive(drive: Values, reader: Reader) -> None:
    path = "cam.drive"
    if "crank" in drive:
        for key in ("forth", "back"):
            if key in drive:
                reader.fault_at(f"{path}.{key}", "cannot be combined with crank", None, "give exactly one of them")
        if "cam.endless" in reader.marks:
            reader.fault_at(f"{path}.crank", "does not drive an endless plate", None, "give forth, its speed")
        crank = drive["crank"]
        if not crank["rod"] > crank["radius"]:
            remedy = "give a longer rod: its big end would not come past the dead centre"
            reader.fault_at(f"{path}.crank.rod", "not above the crank's radius", None, remedy)
    if "back" in drive and "forth" not in drive:
        reader.fault_at(f"{path}.back", "cannot stand without forth", None, "give forth beside it, or leave it out")
    check_materials(drive, reader, loaded="load" in drive, keys=("width", "material", "roller_material"))


def _check_part(part: Values, reader: Reader) -> None:
    thickness = part.get("thickness")
    if "chamfer" in part:
        if thickness is None:
            reader.fault_at("part.chamfer", "cannot stand without a thickness", None, "give part.thickness")
        elif not 2.0 * part["chamfer"] < thickness:
            remedy = f"give less than {reader.shown(0.5 * thickness, 6)}"
            reader.fault_at("part.chamfer", "not below half the thickness", None, remedy)
    for i, slot in enumerate(part.get("slots", [])):
        if not slot["width"] < slot["length"]:
            reader.fault_at(f"part.slots[{i}].width", "not below its length", None, "give a smaller width, or a hole")
    mark = part.get("mark")
    if mark is None:
        return
    own = Mark()
    if not mark.get("width", own.width) < mark.get("length", own.length):
        reader.fault_at("part.mark", "not longer than wide", None, "give a longer or a narrower mark")
    if mark.get("as") == "cut":
        if "depth" in mark:
            reader.fault_at("part.mark.depth", "a mark that is cut through has no depth", None, "leave it out")
    elif thickness is not None and not mark.get("depth", own.depth) < thickness:
        at = "part.mark.depth" if "depth" in mark else "part.mark"
        reader.fault_at(
            at, "an engraved mark is as deep as the plate is thick", None, "give a depth below part.thickness"
        )


def _check_files(values: Values, reader: Reader) -> None:
    cam, part, milled = values["cam"], values.get("part", {}), values.get("manufacture", {})
    groove = cam.get("track", {}).get("groove")
    for file in values.get("export", {}).get("files", []):
        kind, path = file["kind"], file["path"]
        if groove is not None and (FORMATS[kind].solid or FORMATS[kind].program) and "depth" not in groove:
            remedy = f"give cam.track.groove.depth, or leave {kind} out"
            reader.fault_at(path, f"{kind} needs the depth of the groove", None, remedy)
        if "kerf" in file and groove is not None:
            remedy = "leave it out; cam.track.groove.clearance is the play of the roller"
            reader.fault_at(f"{path}.{kind}.kerf", "a groove is made to its nominal size", None, remedy)
        if FORMATS[kind].program:
            lacking = [name for name in PROGRAM_NEEDS if name not in milled]
            if lacking:
                remedy = f"give manufacture with {', '.join(PROGRAM_NEEDS)}"
                reader.fault_at(path, f"{kind} needs manufacture.{lacking[0]}", None, remedy)
            if "thickness" not in part:
                reader.fault_at(path, f"{kind} needs a thickness", None, f"give part.thickness, or leave {kind} out")
    if milled and "cutter" not in milled:
        reader.fault_at("manufacture", "no cutter is given", None, "give manufacture.cutter, its diameter")


def _check_limits(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values.get("part", {})
    drive, follower = cam.get("drive", {}), cam.get("follower", {})
    driven = "crank" in drive or "forth" in drive
    thick = "width" in drive or "thickness" in part
    there = {
        "lost-motion": (cam.get("undercut") == "trim", "undercut: trim"),
        "shoe-travel": (follower.get("kind") == "shoe", "a shoe"),
        "play": ("track" in cam, "a groove"),
        "velocity": (driven, "cam.drive with a speed or a crank"),
        "acceleration": (driven, "cam.drive with a speed or a crank"),
        "contact-force": ("load" in drive, "cam.drive.load"),
        "drive-force": ("load" in drive, "cam.drive.load"),
        "contact-pressure": ("material" in drive and thick, "cam.drive.load and material, and a width or a thickness"),
        LEAST_WALL: (bool({"holes", "slots", "mark", "height"} & part.keys()), "a part with openings"),
    }
    check_bounds(values.get("limits", {}), there, reader)


def _built(values: Values, document: Document, reader: Reader) -> LinearRecipe:
    """Make the recipe of values in which there is no fault."""
    cam, part = values["cam"], values.get("part", {})
    source, periods = cam["motion"]
    follower = dict(cam.get("follower", {}))
    arm = follower.pop("arm", None)
    touch = Follower(
        follower.get("kind", "roller"),
        follower.get("radius", 0.0),
        follower.get("lean", 0.0),
        None if arm is None else Arm(**arm),
    )
    ends, groove = cam.get("ends"), cam.get("track", {}).get("groove")
    drive = dict(cam.get("drive", {}))
    crank = drive.pop("crank", None)
    milling, _ = build_manufacture(values.get("manufacture", {}))
    sizing = cam.get("sizing", {}).get(PRESSURE_ANGLE)
    return LinearRecipe(
        export=build_export(values.get("export", {})),
        base=cam["base"],
        follower=touch,
        motion=source,
        ends=None if ends is None else Ends(ends["overrun"], ends.get("as", "tangent") == "tangent"),
        plate=_plate(part),
        travel=cam.get("travel", "left"),
        periods=periods,
        groove=None if groove is None else Groove(**groove),
        undercut=cam.get("undercut", "refuse"),
        steepest=None if sizing is None else sizing["at_most"],
        drive=Drive(**{"back": drive.get("forth"), **drive, "crank": None if crank is None else CrankDrive(**crank)}),
        manufacture=milling,
        **common_values(values, document, reader),
    )


def _plate(part: Values) -> Plate:
    given: dict[str, Any] = dict(part)
    mark = given.get("mark")
    if mark is not None:
        shape = {"kind" if key == "as" else key: value for key, value in mark.items() if key != "at"}
        given["mark"] = PlacedMark(mark["at"], Mark(**shape))
    given["holes"] = tuple(Hole(**row) for row in part.get("holes", []))
    given["slots"] = tuple(Slot(**row) for row in part.get("slots", []))
    return Plate(**given)
