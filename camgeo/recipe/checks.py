"""Faults between fields that show without any geometry.

Each check looks at the values that were read; where one of them is missing or faulty the check has nothing to say, as
that fault is noted already.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.recipe.build import requests
from camgeo.recipe.check_part import check_part
from camgeo.recipe.check_sweep import check_sweep
from camgeo.recipe.model import SOLIDS
from camgeo.recipe.read_limits import check_limits
from camgeo.recipe.spec import either
from camgeo.recipe.table_cam import SWINGING
from camgeo.recipe.table_manufacture import LEAST_TOLD, NEEDED, SHORTEST
from camgeo.rounded import downward

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values

MOST_DAMPING = 10.0  # times critical, as in kin.dynamics
_ANGLE = 1e-9  # rad, within which the segments of a motion must fill their angle (as in kin.law)
_OTHER_HALF = "two parallel faces hold the cam, so the other half turn's motion follows: S(t + 180) = S(180) - S(t)"
_OTHER_PARTS = "both sides of the follower touch the cam at once, so the motion after that follows"


def check(values: Values, reader: Reader) -> None:
    """Note the faults between fields."""
    cam: Values = values.get("cam", {})
    _corners(cam.get("reuleaux", {}), reader)
    _harmonics(cam, reader)
    if "motion" in cam:
        _filled(cam["motion"], "cam.motion", math.pi, "one half turn, 180 degrees", reader, why=_OTHER_HALF)
    if "law" in cam and "ratio" in cam:
        lam, _ = cam["ratio"]
        _filled(cam["law"], "cam.law", math.pi / lam, f"180/{lam} degrees", reader, why=_OTHER_PARTS)
    _linkage(values, reader)
    check_part(values.get("part", {}), reader)
    _files(values, reader)
    _train(values.get("dynamics", {}), reader)
    _allowance(values.get("manufacture", {}), reader)
    check_limits(values.get("limits", []), reader)
    if "sweep" in values:
        check_sweep(values["sweep"], reader)


def _corners(reuleaux: Values, reader: Reader) -> None:
    if {"breadth", "rounding"} <= reuleaux.keys() and reuleaux["rounding"] >= reuleaux["breadth"] / 2:
        remedy = f"give less than {reuleaux['breadth'] / 2 / reader.mm:g} {reader.units}"
        value = f"{reuleaux['rounding'] / reader.mm:g}"
        reader.fault_at("cam.reuleaux.rounding", "not below half the breadth", value, remedy)


def _harmonics(cam: Values, reader: Reader) -> None:
    delta = cam.get("delta")
    faulty = any(error.path.startswith("cam.delta") for error in reader.errors)
    if delta is not None and not faulty and not (delta.get("cos") or delta.get("sin")):
        reader.fault_at("cam.delta", "no harmonics, so no motion", None, "give some, such as {cos: {1: 625}}")


def _filled(segments: list[Values], path: str, angle: float, wanted: str, reader: Reader, *, why: str) -> None:
    for i, segment in enumerate(segments):
        for key in ("split", "at_end"):
            if key in segment and "law" not in segment:
                reader.fault_at(f"{path}[{i}].{key}", "cannot stand without a law", None, "leave it out")
    covered = math.fsum(segment["dwell"] if "dwell" in segment else segment["over"] for segment in segments)
    if abs(covered - angle) > _ANGLE:
        value = f"{math.degrees(covered):.10g} degrees"
        more = why if covered > angle else "an angle may be a fraction such as 180/7"
        remedy = f"let them cover {wanted}; {more}"
        reader.fault_at(path, "the segments do not fill their angle", value, remedy)


def _linkage(values: Values, reader: Reader) -> None:
    if "linkage" not in reader.marks:
        for path in ("dwell", "verify.output_error"):
            if path in reader.marks:
                reader.fault_at(path, "needs a linkage", None, "give a linkage, or leave it out")
        return
    if reader.cam_kind in SWINGING:
        remedy = "a frame around a cam of kind support or constant-breadth drives it"
        reader.fault_at("linkage", f"cannot stand beside a cam of kind {reader.cam_kind}", None, remedy)
    for part, harmonics in values.get("cam", {}).get("fourier", {}).items():
        for j, value in harmonics if part in {"cos", "sin"} else ():
            if j % 2 == 0 and value:
                remedy = "a frame needs constant breadth: odd harmonics alone"
                reader.fault_at(f"cam.fourier.{part}", "an even harmonic under a linkage", str(j), remedy)
    dyads: list[Values] = values.get("linkage", {}).get("dyads", [])
    if dyads and dyads[0].get("on") == "previous":
        remedy = "give output or coupler"
        reader.fault_at("linkage.dyads[0].on", "there is no dyad before the first", "'previous'", remedy)


def _allowance(milling: Values, reader: Reader) -> None:
    """Note an allowance that is too much for a last pass of this cutter."""
    if {"allowance", "cutter"} <= milling.keys() and milling["allowance"] >= 0.25 * milling["cutter"]:
        remedy = f"give less than {0.25 * milling['cutter'] / reader.mm:.6g} {reader.units}"
        value = f"{milling['allowance'] / reader.mm:.6g} {reader.units}"
        reader.fault_at("manufacture.allowance", "not below a quarter of the cutter", value, remedy)


def _milling(path: str, reader: Reader) -> None:
    """Note what a program for a machine lacks."""
    if "manufacture" not in reader.marks:
        remedy = f"give manufacture with cutter, {', '.join(NEEDED[:-1])} and {NEEDED[-1]}, or leave gcode out"
        reader.fault_at(path, "gcode needs manufacture", None, remedy)
    elif missing := [name for name in NEEDED if f"manufacture.{name}" not in reader.marks]:
        remedy = f"give {either(tuple(missing), 'and')}, or leave gcode out"
        reader.fault_at("manufacture", f"gcode needs {missing[0]}", None, remedy)
    if "part.thickness" not in reader.marks:
        reader.fault_at(path, "gcode needs a thickness", None, "give part.thickness, or leave gcode out")


def _slight(values: Values, reader: Reader) -> None:
    """Note figures so slight that a program would need its digits for them alone."""
    for table, least_told in (("manufacture", LEAST_TOLD), ("part", {"thickness": SHORTEST})):
        for name, least in least_told.items():
            unit, mm = ("turns a minute", 1.0) if name == "spindle" else (reader.units, reader.mm)
            value = values.get(table, {}).get(name)
            if value is not None and value < least * mm:
                remedy = f"give at least {least:.6g} {unit}"
                reader.fault_at(f"{table}.{name}", "too little for a program", f"{value / mm:.6g} {unit}", remedy)


def _train(train: Values, reader: Reader) -> None:
    if "play" in train and "rate" in train:
        reader.fault_at(
            "dynamics.rate", "a spring's rate beside play", None, "give preload instead of play, or leave it out"
        )
    if "play" in train and "linkage" in reader.marks:
        remedy = "give preload: what the joints have of play is not the cam's"
        reader.fault_at("dynamics.play", "play at the cam under a linkage", None, remedy)
    if {"mass", "stiffness"} <= train.keys() and "damping" in train:
        ratio = train["damping"] / math.sqrt((train["stiffness"] + train.get("rate", 0.0)) * train["mass"]) / 2
        if ratio > MOST_DAMPING:
            most = train["damping"] * MOST_DAMPING / ratio
            remedy = f"give less than {downward(most)}"
            reader.fault_at("dynamics.damping", f"{ratio:.4g} times critical", None, remedy)


def _files(values: Values, reader: Reader) -> None:
    files: list[Values] = values.get("export", {}).get("files", [])
    listed = requests(files)
    names = [request.filename("NAME", listed) for request in listed]
    if any(request.kind == "gcode" for request in listed):
        _slight(values, reader)
    for i, (file, request) in enumerate(zip(files, listed, strict=True)):
        path = file["path"]
        if request.kind in SOLIDS and "part.thickness" not in reader.marks:
            remedy = f"give part.thickness, or leave {request.kind} out"
            reader.fault_at(path, f"{request.kind} needs a thickness", None, remedy)
        if request.parts == "all" and request.compensation is not None:
            remedy = "give mechanism.clearance, which sets how the bodies fit, or leave `parts: all` out"
            reader.fault_at(path, "compensation of a whole mechanism", None, remedy)
        if request.parts == "all" and "part.bore" not in reader.marks:
            remedy = "give part.bore, such as {hexagon: 10}, or leave `parts: all` out"
            reader.fault_at(path, "a mechanism needs a bore for its shaft", None, remedy)
        if request.kind == "gcode":
            _milling(path, reader)
        if request.kind == "step" and request.as_ != "arcs" and "part.chamfer" in reader.marks:
            remedy = "give arcs, whose chamfers are exact cones, or leave part.chamfer out"
            reader.fault_at(f"{path}.step.as", "the chamfer of a spline is no spline", f"'{request.as_}'", remedy)
        if request.as_ in {"spline", "exact"} and request.version == "R12":
            remedy = "give arcs or polyline, or a later version"
            reader.fault_at(f"{path}.dxf.as", "R12 has no splines", f"'{request.as_}'", remedy)
        if request in listed[:i]:
            reader.fault_at(path, "the same file twice", None, "leave one out")
        elif names[i] in names[:i]:
            name = names[i].removeprefix("NAME")
            remedy = "give each another `as` or `version`, or a recipe of its own"
            reader.fault_at(path, "a second file of one name", f"<name>{name}", remedy)
