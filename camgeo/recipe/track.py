"""Tracks: a ring, whose opening is followed from within, or a groove; what their recipes need and exclude."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.features import FEATURES
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values

OF_A_DISC = ("bore", *(feature.name for feature in FEATURES if not feature.of_ring))
"""Keys of a part that a ring cannot have."""
SAME = 1e-12  # share by which rounding may make a cutter wider than the groove


def check_track(values: Values, reader: Reader) -> None:
    """Note what a ring or a groove lacks or excludes, and `part.outer` of another cam."""
    cam = values.get("cam")
    if is_ring(values):
        _check_ring(reader)
    elif is_groove(cam or {}):
        _check_groove(values, reader)
    # a cam or a track that is given but could not be read has its fault already
    elif "part.outer" in reader.marks and cam is not None and ("track" in cam or "cam.track" not in reader.marks):
        remedy = "give a disc cam with `track: internal` or a groove, or leave it out"
        reader.fault_at("part.outer", "belongs to a ring or a groove", None, remedy)


def is_ring(values: Values) -> bool:
    """Whether the values of a recipe are of a ring."""
    return bool(values.get("cam", {}).get("track") == "internal")


def is_groove(cam: Values) -> bool:
    """Whether the values of a cam are of a groove."""
    return isinstance(cam.get("track"), dict)


def _check_ring(reader: Reader) -> None:
    """Note a ring without an outline, and parts that belong to a disc."""
    if "part.outer" not in reader.marks:
        remedy = "give part.outer, or leave track out"
        reader.fault_at("cam.track", "a ring needs part.outer, the diameter of its outline", "internal", remedy)
    for name in OF_A_DISC:
        if f"part.{name}" in reader.marks:
            reader.fault_at(f"part.{name}", "belongs to a disc on a shaft, not to a ring", None, "leave it out")


def _check_groove(values: Values, reader: Reader) -> None:
    """Note what does not go with a groove in its cam, its part, its cutter and its files."""
    cam, part, depth = values["cam"], values.get("part", {}), "cam.track.groove.depth"
    groove = cam["track"].get("groove", {})
    follower = cam.get("follower", {}).get("kind", "roller")
    if follower != "roller":
        remedy = "give a roller, or leave track out"
        reader.fault_at("cam.follower.kind", "does not run in a groove", follower, remedy)
    if cam.get("undercut") == "trim":
        reader.fault_at("cam.undercut", "a groove is not trimmed", "trim", "leave it out")
    for feature in FEATURES:
        refusal = feature.grooved
        if refusal is None or feature.name not in part:
            continue
        if refusal.unless is None or not refusal.unless(part[feature.name]):
            reader.fault_at(f"part.{feature.name}", refusal.problem, None, refusal.remedy)
    if groove.get("clearance", 0.0) < 0.0:
        remedy = "give 0 or more; one roller on both flanks would scrub"
        reader.fault_at("cam.track.groove.clearance", "a roller in a groove needs clearance", None, remedy)
    if "depth" in groove and not groove["depth"] < part.get("thickness", groove["depth"] + 1.0):
        reader.fault_at(depth, "not below the thickness", None, "give a depth below part.thickness")
    _check_cutter(values, groove.get("clearance", 0.0), reader)
    for file in values.get("export", {}).get("files", []):
        kind, path = file["kind"], file["path"]
        for name in ("kerf", "clearance", "shrinkage"):
            if name in file:
                remedy = "leave it out; cam.track.groove.clearance is the play of the roller"
                reader.fault_at(f"{path}.{kind}.{name}", "a groove is made to its nominal size", None, remedy)
        record = FORMATS[kind]
        if (record.solid or record.program) and depth not in reader.marks:
            reader.fault_at(path, f"{kind} needs the depth of the groove", None, f"give {depth}, or leave {kind} out")
        elif record.solid and "part.outer" not in reader.marks:
            remedy = f"give part.outer, the diameter of the blank, or leave {kind} out"
            reader.fault_at(path, f"{kind} of a groove needs its blank", None, remedy)


def _check_cutter(values: Values, clearance: float, reader: Reader) -> None:
    """Note a cutter wider than the groove, the roller's diameter and its clearance, mm."""
    radius, cutter = values["cam"].get("follower", {}).get("radius"), values.get("manufacture", {}).get("cutter")
    if radius is None or cutter is None:
        return
    width = 2.0 * radius + clearance
    if cutter > width * (1.0 + SAME):
        diameter = f"{cutter / reader.mm:.9g} {reader.units}"
        remedy = f"give {width / reader.mm:.9g} {reader.units} or less"
        reader.fault_at("manufacture.cutter", "wider than the groove", diameter, remedy)
