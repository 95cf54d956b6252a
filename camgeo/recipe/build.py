"""From the values that were read to the recipe's dataclasses, with the defaults."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

from camgeo.recipe.build_part import build_part
from camgeo.recipe.model import (
    ArcRoute,
    Cam,
    ConstantBreadthCam,
    DeltaRoute,
    DoubleRollerCam,
    DwellAsked,
    Dyad,
    Export,
    FileRequest,
    FlatPairCam,
    FormulaShape,
    FourBarLinkage,
    FourierShape,
    HypocycloidShape,
    InvertedSliderCrankLinkage,
    LawRoute,
    Linkage,
    MotionSegment,
    Recipe,
    ReuleauxShape,
    RosetteRoute,
    Route,
    RPRDyad,
    RRPDyad,
    RRRDyad,
    Shape,
    SliderCrankLinkage,
    SupportCam,
    Verify,
)
from camgeo.recipe.model_dynamics import Dynamics
from camgeo.recipe.model_manufacture import Compensation, Manufacture
from camgeo.recipe.model_mechanism import MechanismAsked
from camgeo.recipe.model_sweep import Axis, Limit, Sweep

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from camgeo.recipe.model import FileKind
    from camgeo.recipe.reader import Values
    from camgeo.recipe.source import Mark

TOLERANCE = 0.001  # mm
ANGLES = 3600
KEEP = 10  # designs of a sweep
SAMPLES = 360  # angles at which a sweep looks at a design
CHOSEN: dict[FileKind, Values] = {  # what a file is where its options do not say
    "dxf": {"as": "arcs", "version": "R2010"},
    "svg": {"as": "arcs"},
    "step": {"as": "arcs"},
    "csv": {"as": "motion"},
}


def build(values: Values, path: Path, marks: Mapping[str, Mark], text: str) -> Recipe:
    """Make the recipe of values in which there is no fault."""
    export: Values = values.get("export", {})
    return Recipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=values["mm"],
        rotation=values.get("rotation", "cw"),
        cam=_cam(values["cam"], values["mm"]),
        part=build_part(values.get("part", {})),
        export=Export(export.get("tolerance", TOLERANCE), requests(export.get("files", [{"kind": "dxf"}]))),
        verify=Verify(**{"angles": ANGLES, **values.get("verify", {})}),
        path=path,
        linkage=_linkage(values["linkage"]) if "linkage" in values else None,
        dwell=DwellAsked(**values["dwell"]) if "dwell" in values else None,
        sweep=_sweep(values["sweep"]) if "sweep" in values else None,
        dynamics=Dynamics(**values["dynamics"]) if "dynamics" in values else None,
        manufacture=Manufacture(**values["manufacture"]) if "manufacture" in values else None,
        mechanism=MechanismAsked(**values["mechanism"]) if "mechanism" in values else None,
        limits=_limits(values.get("limits", [])),
        marks=marks,
        text=text,
    )


def requests(files: list[Values]) -> tuple[FileRequest, ...]:
    """Make the list of files."""
    return tuple(_request(file["kind"], file) for file in files)


def _request(kind: FileKind, file: Values) -> FileRequest:
    chosen = {**CHOSEN.get(kind, {}), **file}
    return FileRequest(
        kind,
        chosen.get("as"),
        chosen.get("version"),
        chosen.get("tolerance"),
        _compensation(file),
        chosen.get("parts", "cam"),
    )


def _compensation(file: Values) -> Compensation | None:
    given = {name: file[name] for name in ("kerf", "clearance", "shrinkage") if name in file}
    if "shrinkage" in given:
        given["shrinkage"] /= 100.0
    return Compensation(**given) if given else None


def _cam(cam: Values, mm: float) -> Cam:
    undercut = cam.get("undercut", "refuse")
    match cam["kind"]:
        case "support":
            return SupportCam(_shape(cam, mm), cam.get("pivot", (0.0, 0.0)), undercut)
        case "constant-breadth":
            return ConstantBreadthCam(cam["base_radius"], _motion(cam["motion"], mm), undercut)
        case "double-roller":
            lam, mu = cam["ratio"]
            return DoubleRollerCam(lam, mu, cam["arm"], cam["roller_radius"], _route(cam, mm), undercut)
        case _:
            lam, mu = cam["ratio"]
            return FlatPairCam(lam, mu, cam["arm"], _route(cam, mm), undercut)


def _shape(cam: Values, mm: float) -> Shape:
    if "fourier" in cam:
        return FourierShape(**{"cos": (), "sin": (), **cam["fourier"]})
    if "reuleaux" in cam:
        return ReuleauxShape(**cam["reuleaux"])
    if "hypocycloid" in cam:
        return HypocycloidShape(**cam["hypocycloid"])
    return FormulaShape(cam["p"], mm)


def _route(cam: Values, mm: float) -> Route:
    if "delta" in cam:
        return DeltaRoute(**{"cos": (), "sin": (), **cam["delta"]})
    if "law" in cam:
        return LawRoute(_motion(cam["law"], math.pi / 180))
    if "arc" in cam:
        return ArcRoute(**{"side": "convex", **cam["arc"]})
    return RosetteRoute(cam["rosette"]["leaf"], mm)


def _motion(segments: list[Values], scale: float) -> tuple[MotionSegment, ...]:
    return tuple(_segment(segment, scale) for segment in segments)


def _segment(segment: Values, scale: float) -> MotionSegment:
    if "dwell" in segment:
        return MotionSegment("dwell", segment["dwell"])
    if "displacement" in segment:
        return MotionSegment("displacement", segment["over"], formula=segment["displacement"], scale=scale)
    kinds: tuple[Literal["rise", "return", "to", "rise_fall"], ...] = ("rise", "return", "to", "rise_fall")
    kind = next(kind for kind in kinds if kind in segment)
    end = segment.get("at_end")
    state = None if end is None else (end.get("v", 0.0), end.get("a", 0.0))
    return MotionSegment(kind, segment["over"], segment[kind], segment.get("law"), segment.get("split"), state)


def _linkage(linkage: Values) -> Linkage:
    given = {"assembly": "open", **{key: value for key, value in linkage.items() if key != "kind"}}
    given["dyads"] = tuple(map(_dyad, given.get("dyads", [])))
    match linkage["kind"]:
        case "four-bar":
            return FourBarLinkage(**given)
        case "inverted-slider-crank":
            return InvertedSliderCrankLinkage(**given)
        case _:
            return SliderCrankLinkage(**given)


def _dyad(dyad: Values) -> Dyad:
    given = {"on": "output", **{key: value for key, value in dyad.items() if key != "kind"}}
    match dyad["kind"]:
        case "rrr":
            return RRRDyad(**{"assembly": "open", **given})
        case "rrp":
            return RRPDyad(**{"assembly": "open", **given})
        case _:
            return RPRDyad(**{"offset": 0.0, **given})


def _sweep(sweep: Values) -> Sweep:
    return Sweep(
        vary=tuple(map(_axis, sweep["vary"])),
        method=sweep.get("method", "grid"),
        count=sweep.get("count"),
        seed=sweep.get("seed", 0),
        limits=_limits(sweep.get("limits", [])),
        rank=sweep["rank"],
        keep=sweep.get("keep", KEEP),
        angles=sweep.get("angles", SAMPLES),
        refine=sweep.get("refine", False),
    )


def _axis(axis: Values) -> Axis:
    if "values" in axis:
        return Axis(axis["path"], values=axis["values"])
    return Axis(axis["path"], axis["from"], axis["to"], axis.get("steps"))


def _limits(limits: list[Values]) -> tuple[Limit, ...]:
    return tuple(Limit(limit["figure"], limit.get("at_least"), limit.get("at_most")) for limit in limits)
