"""Reading the recipe of an indexing cam: its faults between keys, and its value."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.form_rules import NOTHING, less, more, rules_of
from camgeo.capabilities.indexing.index_recipe import Drive, IndexRecipe
from camgeo.capabilities.indexing.keys import EXAMPLE, FILES, NO_PROGRAM, RECIPE, SOLID_OF_IT
from camgeo.formats.turned import programs_in
from camgeo.motions.motion import check_filled
from camgeo.part.keyway import check_round
from camgeo.recipe.export import build_export, check_files
from camgeo.recipe.figure_bounds import check_bounds
from camgeo.recipe.materials import check_materials
from camgeo.recipe.own_kind import NotYet, begin, common_values, finish, round_part
from camgeo.recipe.radii import check_radii
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.turrets import Turret
    from camgeo.recipe.document import Document
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Source

NOT_YET = NotYet(
    "an indexing cam",
    {
        "cam.sizing": "give the radius of the blank, turret.radius and turret.roller",
        "manufacture": f"a program of a barrel has its cutter and feeds beside its axes, {{gcode: {{{EXAMPLE}}}}}",
        "made": "measured points of an indexing cam are not judged",
    },
    ("svg", "step"),
    "stl, 3mf or ply",
)
RIDGE = 0.02  # mm by which what two cuts along the groove clear is wider than that


def reader_of(source: Source) -> tuple[Reader, Values]:
    """Reader that has read the text of an indexing cam, but for faults between its keys; and its values."""
    reader, values = begin(source, "indexing", RECIPE, swings=True)
    reader.errors = [NOT_YET.told(error) for error in reader.errors]
    return reader, values


def read_indexing(source: Source, path: Path) -> IndexRecipe:
    """Read the recipe of an indexing cam; raises RecipeErrors with all its faults."""
    return finish(*reader_of(source), path, _check, _built)


def _check(values: Values, reader: Reader) -> None:
    cam, part = values["cam"], values["part"]
    why = "a turn of the cam advances the turret once"
    check_filled(cam["motion"], "cam.motion", TURN, "the whole turn, 360 degrees", reader, why=why)
    rules, drive = rules_of(values, reader), cam.get("drive", {})
    rules.check_keys()
    _check_preload(cam["turret"], reader)
    check_materials(drive, reader, loaded=_loaded(drive), need="load, or rpm and inertia")
    if "inertia" in drive and "rpm" not in drive:
        remedy = "give rpm beside it, or leave it out"
        reader.fault_at("cam.drive.inertia", "cannot stand without rpm", None, remedy)
    check_round(part, reader)
    check_files(values, reader, FILES)
    if not reader.errors:
        rules.check_form()
    if not reader.errors:
        rules.check_roller()
        _check_developments(values, rules.built(), reader)
        _check_programs(values, rules.built(), reader)
        _check_limits(values, reader)


def _check_preload(turret: Values, reader: Reader) -> None:
    """Note a preload beside a clearance, and one that is no less than the roller."""
    path = "cam.turret.preload"
    if "preload" not in turret:
        return
    if "clearance" in turret:
        reader.fault_at(path, "does not go with clearance", None, "leave one of them out")
    if not turret["preload"] < turret["roller"]:
        remedy = f"give a few hundredths of a mm, less than {reader.shown(turret['roller'])}"
        reader.fault_at(path, "no less than the radius of the roller", reader.shown(turret["preload"]), remedy)


def _loaded(drive: Values) -> bool:
    """Whether the drive says what torque the turret takes."""
    return "load" in drive or ("inertia" in drive and "rpm" in drive)


def _check_developments(values: Values, turret: Turret, reader: Reader) -> None:
    """Note developments of a turret's cam that has none, and radii of a development that lie on no flank."""
    if turret.unrolls:
        check_radii(values, turret.form.floor, turret.form.blank, reader)
        return
    for file in values.get("export", {}).get("files", []):
        if file["kind"] == "dxf":
            remedy = "give stl, 3mf or ply: a torus is not unrolled without stretching"
            reader.fault_at(file["path"], "a globoid has no development", None, remedy)


def _check_programs(values: Values, turret: Turret, reader: Reader) -> None:
    """Note programs of a turret's cam that has none, what one lacks, and a cutter that spoils flanks, or a groove."""
    if not turret.unrolls:
        for file in values.get("export", {}).get("files", []):
            if FILES[file["kind"]].program:
                reader.fault_at(file["path"], NO_PROGRAM, None, SOLID_OF_IT)
        return
    given = values["cam"]["turret"]
    play = given.get("clearance", 0.0) - given.get("preload", 0.0)
    smaller = given["roller"] + min(play, 0.0)
    narrowest = given["roller"] + 0.5 * play + RIDGE
    for file in programs_in(values, reader, EXAMPLE):
        path, told = f"{file['path']}.{file['kind']}", reader.shown(file["cutter"])
        if "Y" not in file["axes"]:
            problem = "a barrel's rollers stand beside its axis, and so does the cutter"
            reader.fault_at(f"{path}.axes", problem, ", ".join(file["axes"]), "give [X, Y, A]")
        allowance = file.get("allowance", 0.0)
        widest = 2.0 * (smaller - allowance)
        if file["cutter"] > widest + NOTHING and widest <= narrowest:
            remedy = f"give an allowance below {less(smaller - 0.5 * narrowest, reader)}"
            reader.fault_at(f"{path}.allowance", "leaves no room for a cutter", reader.shown(allowance), remedy)
        elif file["cutter"] > widest + NOTHING:
            what = "the smaller roller less the allowance on both flanks" if allowance else "the smaller roller"
            problem = f"a cutter wider than {what} cuts the flanks away"
            reader.fault_at(f"{path}.cutter", problem, told, f"give at most {reader.shown(widest)}")
        elif file["cutter"] < narrowest - NOTHING:
            remedy = f"give at least {more(narrowest, reader)}"
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
    cam, rules = values["cam"], rules_of(values, reader)
    given, turret = cam["turret"], rules.built()
    return IndexRecipe(
        rotation=values.get("rotation", "cw"),
        export=build_export(values.get("export", {}), FILES, "stl"),
        turret=turret,
        roller=rules.roller(turret),
        stops=given["stops"],
        start=given.get("start", -math.pi / given["stops"]),
        clearance=given.get("clearance", 0.0) - given.get("preload", 0.0),
        motion=cam["motion"],
        part=round_part(values["part"]),
        drive=Drive(**cam.get("drive", {})),
        **common_values(values, document, reader),
    )
