"""Reading the recipe of a cylindrical cam: its faults between keys, and its value."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.capabilities.cylindrical.drum_recipe import Drive, DrumRecipe, Roller
from camgeo.capabilities.cylindrical.guide import Arm, Carriage
from camgeo.capabilities.cylindrical.keys import APEX, FILES, FLOOR_GAP, RECIPE
from camgeo.capabilities.cylindrical.tracks import End, Groove, Rib
from camgeo.common.rounding import downward
from camgeo.formats.turned import programs_in
from camgeo.motions.motion import check_filled
from camgeo.part.keyway import check_round
from camgeo.recipe.export import build_export, check_files
from camgeo.recipe.figure_bounds import check_bounds
from camgeo.recipe.materials import check_materials
from camgeo.recipe.own_kind import NotYet, begin, common_values, entry_at, finish, round_part
from camgeo.recipe.radii import check_radii
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.guide import Guide
    from camgeo.capabilities.cylindrical.tracks import Track
    from camgeo.recipe.document import Document
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source

NOT_YET = NotYet(
    "a cylindrical cam",
    {
        "cam.sizing": "give the radius of the blank",
        "manufacture": "a program has its cutter and feeds beside its axes, {gcode: {axes: [X, A], cutter: 20}}",
    },
    ("svg",),
    "stl, 3mf, ply or step",
)
EXAMPLE = "axes: [X, A], cutter: 20, feed: 300, plunge: 60, spindle: 2500, safe_height: 5"
REFUSE = "undercut: refuse, as a cut ends in a sharp edge"
RIDGE = 0.02  # mm by which what two cuts along a groove clear is wider than the groove
NOTHING = 1e-9  # mm: a length below it is none
NOTHING_MORE = 1e-7  # of the size of a cone, that a figure may be rounded by
SAME_TAPER = 1e-6  # rad, so is its taper


def reader_of(source: Source) -> tuple[Reader, Values]:
    """Reader that has read the text of a cylindrical cam, but for faults between its keys; and its values."""
    swings = entry_at(source.root, "cam", "follower", "arm") is not None
    reader, values = begin(source, "cylindrical", RECIPE, swings=swings)
    reader.errors = [NOT_YET.told(error) for error in reader.errors]
    return reader, values


def read_cylindrical(source: Source, path: Path) -> DrumRecipe:
    """Read the recipe of a cylindrical cam; raises RecipeErrors with all its faults."""
    return finish(*reader_of(source), path, _check, _built)


def _check(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values["part"]
    turns = cam.get("turns", 1)
    whole = "the whole turn, 360 degrees" if turns == 1 else f"{turns} turns, {360 * turns} degrees"
    several = "a track of several turns has cam.turns"
    check_filled(cam["motion"], "cam.motion", turns * TURN, whole, reader, why=several)
    _check_shoe(cam, reader)
    _check_turns(cam, reader)
    _check_guide(cam, reader)
    _check_track(cam, reader)
    drive = cam.get("drive", {})
    check_materials(drive, reader, loaded="load" in drive)
    check_round(part, reader)
    check_files(values, reader, FILES)
    if reader.errors:
        return
    check_radii(values, cam["radius"] - _track(cam).depth, cam["radius"], reader)
    _check_programs(values, reader)
    _check_limits(values, reader)


def _check_shoe(cam: Values, reader: Reader) -> None:
    """Note a shoe without its sizes, where nothing leads it on two sides, and on what is no straight carriage."""
    given, path = cam["follower"], "cam.follower"
    if (given.get("kind") == "shoe") != ("width" in given):
        key, remedy = (
            ("radius", "give width and length") if given.get("kind") == "shoe" else ("width", "give kind: shoe")
        )
        reader.fault_at(f"{path}.{key}", f"does not go with a {given.get('kind', 'roller')}", None, remedy)
        return
    if "width" not in given:
        return
    if "groove" not in cam["track"]:
        (track,) = cam["track"]
        word = "an end face" if track == "end" else f"a {track}"
        reader.fault_at(f"{path}.kind", f"a shoe is led by a groove alone, not by {word}", None, "give a roller")
    for key in ("offset", "taper", "at", "arm"):
        if given.get(key):
            remedy = "leave it out: a shoe is on a carriage, and its pin is a radius of the drum"
            reader.fault_at(f"{path}.{key}", "does not go with a shoe", None, remedy)
    if not given["length"] > given["width"]:
        remedy = f"give more than {reader.shown(given['width'])}"
        problem = "a shoe is longer than it is wide"
        reader.fault_at(f"{path}.length", problem, reader.shown(given["length"]), remedy)


def _check_turns(cam: Values, reader: Reader) -> None:
    """Note what is made of one turn alone."""
    if cam.get("turns", 1) == 1:
        return
    if "groove" not in cam["track"]:
        word = "a rib" if "rib" in cam["track"] else "an end face"
        problem = f"the turns of {word} would cross, and cut one another's faces away"
        reader.fault_at("cam.track", problem, None, "give a groove, or leave cam.turns out")
    if cam.get("undercut") == "shorten":
        remedy = "leave it out, and give a smaller roller or depth, or wider reversals where it is undercut"
        reader.fault_at(
            "cam.undercut", "an undercut that shortens a track of several turns is not made yet", None, remedy
        )


def _size(given: Values) -> float:
    """Radius of the roller, or half the width of the shoe, mm."""
    return float(given["radius"] if "radius" in given else 0.5 * given["width"])


def _check_guide(cam: Values, reader: Reader) -> None:
    """Note an arm that does not reach the drum, and keys of a guide and of a cone that do not go together."""
    roller, path = cam["follower"], "cam.follower"
    arm = roller.get("arm")
    if "at" in roller and "taper" not in roller:
        remedy = "leave it out: a cylinder has its radius everywhere; or give taper"
        reader.fault_at(f"{path}.at", "cannot stand without taper", None, remedy)
    if arm is None:
        return
    if "offset" in roller:
        remedy = "leave it out: arm.offset places the pivot"
        reader.fault_at(f"{path}.offset", "does not go with an arm", None, remedy)
    height = cam["pitch_height"] - arm["pivot"]
    if not abs(height) < arm["length"]:
        low, high = (cam["pitch_height"] + sign * arm["length"] for sign in (-1.0, 1.0))
        remedy = f"give a pivot between {reader.shown(low)} and {reader.shown(high)}"
        problem = "the arm does not reach pitch_height at lift 0"
        reader.fault_at(f"{path}.arm.pivot", problem, reader.shown(arm["pivot"]), remedy)


def _roller(cam: Values, floor: float) -> Roller:
    """The roller of a track down to a floor, mm."""
    given, radius = cam["follower"], cam["radius"]
    inner, outer = given.get("from", floor + FLOOR_GAP), given.get("to", radius)
    at, taper, size = given.get("at", 0.5 * (inner + outer)), given.get("taper", 0.0), _size(given)
    if taper == APEX:
        return Roller(size, inner, outer, at=at, apex=True).resized(size)
    return Roller(size, inner, outer, taper, at if taper else 0.0, shoe=given.get("length"))


def _check_track(cam: Values, reader: Reader) -> None:
    """Note a roller that does not lie between the floor of its track and the blank."""
    radius, roller, path = cam["radius"], cam["follower"], "cam.follower"
    (kind, track), begins = next(iter(cam["track"].items())), roller.get("from")
    if kind == "end" and begins is None:
        remedy = "give where the roller begins along its axis: within that the drum is turned round"
        reader.fault(reader.marks[path], f"{path}.from", "missing, needed with an end face", None, remedy)
        return
    depth = radius - begins + FLOOR_GAP if kind == "end" else track["depth"]
    floor, ends = radius - depth, roller.get("to", radius)
    made = _roller(cam, floor)
    least = made.size(floor)  # of a cylinder its radius
    if not least > 0.0:
        problem = f"the cone ends in its apex before the floor, {reader.shown(floor)} from the axis"
        reader.fault_at(f"{path}.taper", problem, None, "give a smaller taper, axis, or a larger radius")
        return
    if made.taper and not floor > least:
        smaller = f"give at more than {reader.shown(made.radius)}" if made.apex else "give a smaller taper"
        problem = f"at the floor, {reader.shown(floor)} from the axis, the radius of the cone is no less than that"
        reader.fault_at(f"{path}.taper", problem, None, f"{smaller}, or a smaller roller")
        return
    if not floor > least:
        at = f"{path}.from" if kind == "end" else f"cam.track.{kind}.depth"
        most = radius - _size(roller)
        remedy = "give a smaller roller, or a larger blank"
        if most > FLOOR_GAP:
            end = f"more than {reader.shown(_size(roller) + FLOOR_GAP)}"
            remedy = f"give {end if kind == 'end' else f'less than {reader.shown(most)}'}, or a smaller roller"
        reader.fault_at(at, "the floor is no farther from the axis than the radius of the roller", None, remedy)
        return
    clearance = track["clearance"] if kind == "groove" and "clearance" in track else 0.0
    if not floor > least + clearance:
        remedy = f"give less than {reader.shown(floor - least)}"
        problem = "the upper flank is that of a roller whose radius is no less than that of the floor"
        reader.fault_at("cam.track.groove.clearance", problem, reader.shown(clearance), remedy)
        return
    if begins is not None and not begins > floor:
        remedy = f"give more than {reader.shown(floor)}, or a greater depth"
        reader.fault_at(f"{path}.from", "the roller's end stands on the floor", reader.shown(begins), remedy)
    inner = floor + FLOOR_GAP if begins is None else begins
    if not ends > inner or not inner < radius:
        at = f"{path}.to" if f"{path}.to" in reader.marks else f"{path}.from" if begins is not None else path
        remedy = f"let it bear between {reader.shown(floor)} and {reader.shown(radius)}"
        reader.fault_at(at, "the roller bears nowhere", None, remedy)
    thick = 2.0 * made.size(radius)
    if kind == "rib" and not track["distance"] > thick:
        remedy = f"give more than {reader.shown(thick)}, and the rib's thickness"
        reader.fault_at("cam.track.rib.distance", "the rollers leave no rib", reader.shown(track["distance"]), remedy)


def _check_programs(values: Values, reader: Reader) -> None:
    """Note what a program lacks, and a cutter that does not leave the flanks, or what lies between them."""
    cam = values["cam"]
    (kind, track), floor = next(iter(cam["track"].items())), cam["radius"] - _track(cam).depth
    whole = _roller(cam, floor)
    roller = whole.size(floor)
    clearance = track.get("clearance", 0.0) if kind == "groove" else 0.0
    for file in programs_in(values, reader, EXAMPLE):
        path = f"{file['path']}.{file['kind']}"
        if file.get("taper", 0.0) > whole.taper + SAME_TAPER:
            problem, own = "a cutter tapers at most as its roller", math.degrees(file["taper"])
            most = downward(math.degrees(whole.taper), 6)
            remedy = f"give at most {most} degrees" if whole.taper else "leave it out: the roller is a cylinder"
            reader.fault_at(f"{path}.taper", problem, f"{own:.9g} degrees", remedy)
            continue
        widest, told = 2.0 * roller, reader.shown(file["cutter"])
        narrowest = roller + 0.5 * clearance + RIDGE if kind == "groove" else 0.0
        allowance = file.get("allowance", 0.0)
        if kind == "groove":
            widest -= 2.0 * allowance
        # that of a cone is no round figure
        if file["cutter"] > widest + (NOTHING if not whole.taper else NOTHING_MORE * widest):
            if widest <= narrowest:
                remedy = f"give an allowance below {reader.shown(0.5 * (2.0 * roller - narrowest))}"
                reader.fault_at(f"{path}.allowance", "leaves no room for a cutter", reader.shown(allowance), remedy)
                continue
            what = "the roller" if widest == 2.0 * roller else "the roller less the allowance on both flanks"
            most = f"{downward(widest / reader.mm, 7)} {reader.units}" if whole.taper else reader.shown(widest)
            what = f"{what} at the floor" if whole.taper else what
            remedy = f"give at most {most}"
            if whole.taper and "taper" not in file:
                remedy += f", and taper: {math.degrees(whole.taper):.4f} for the cone of the roller"
            reader.fault_at(f"{path}.cutter", f"a cutter wider than {what} cuts the flanks away", told, remedy)
        elif file["cutter"] < narrowest - NOTHING:
            remedy = f"give at least {reader.shown(narrowest)}"
            reader.fault_at(f"{path}.cutter", "does not clear the groove along both flanks", told, remedy)


def _check_limits(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values["part"]
    drive, track = cam.get("drive", {}), cam["track"]
    regular = cam.get("undercut") != "shorten"
    several, shoe = (cam.get("turns", 1) > 1, "cam.turns above 1"), "width" in cam["follower"]
    driven, loaded = ("rpm" in drive, "cam.drive.rpm"), ("load" in drive, "cam.drive.load")
    there = {
        "rib-thickness": ("rib" in track, "a rib"),
        "play": ("groove" in track, "a groove"),
        "crossings": several,
        "crossing-angle": several,
        "crossing-gap": several,
        "shoe-play": (cam.get("turns", 1) > 1 and shoe, "cam.turns above 1 and a shoe"),
        "shoe-twist": (shoe, "a shoe"),
        "velocity": driven,
        "acceleration": driven,
        "contact-force": loaded,
        "side-thrust": loaded,
        "axial-thrust": ("load" in drive and "taper" in cam["follower"], "cam.drive.load and a taper"),
        "off-radius": ("arm" in cam["follower"], "an arm"),
        "torque": loaded,
        "contact-pressure": ("material" in drive and regular, f"cam.drive.load and material, and {REFUSE}"),
        "contact-pressure-middle": ("material" in drive, "cam.drive.load and material"),
        "mating-radius": (regular, REFUSE),
        "undercut-radius": (not regular, "undercut: shorten"),
        "mass": ("density" in part, "part.density"),
    }
    check_bounds(values.get("limits", {}), there, reader)


def _track(cam: Values) -> Track:
    """The track of values in which there is no fault."""
    ((kind, track),) = cam["track"].items()
    if kind == "groove":
        return Groove(track["depth"], track.get("clearance", 0.0))
    if kind == "rib":
        return Rib(track["depth"], track["distance"])
    return End(track, cam["radius"] - cam["follower"]["from"] + FLOOR_GAP)


def _built(values: Values, document: Document, reader: Reader) -> DrumRecipe:
    """Make the recipe of values in which there is no fault."""
    cam, part = values["cam"], values["part"]
    track, level, arm = _track(cam), cam["pitch_height"], cam["follower"].get("arm")
    if arm is None:
        guide: Guide = Carriage(level, cam["follower"].get("offset", 0.0))
    else:
        side: Literal[-1, 1] = -1 if arm.get("side") == "leading" else 1
        start = math.asin((level - arm["pivot"]) / arm["length"])
        guide = Arm(arm["length"], arm["offset"], arm["pivot"], side, start)
    return DrumRecipe(
        rotation=values.get("rotation", "cw"),
        export=build_export(values.get("export", {}), FILES, "stl"),
        radius=cam["radius"],
        track=track,
        roller=_roller(cam, cam["radius"] - track.depth),
        guide=guide,
        motion=cam["motion"],
        part=round_part(part),
        undercut=cam.get("undercut", "refuse"),
        turns=cam.get("turns", 1),
        drive=Drive(**cam.get("drive", {})),
        profile=values.get("made", {}).get("profile"),
        **common_values(values, document, reader),
    )
