"""From the values that were read to the recipe's dataclasses, with the defaults."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from camgeo.recipe.model import (
    ArcRoute,
    Cam,
    ConstantBreadthCam,
    DeltaRoute,
    DoubleRollerCam,
    Export,
    FileRequest,
    FlatPairCam,
    FormulaShape,
    FourierShape,
    HypocycloidShape,
    LawRoute,
    MotionSegment,
    Part,
    Recipe,
    ReuleauxShape,
    RosetteRoute,
    Route,
    Shape,
    SupportCam,
    Verify,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from camgeo.recipe.reader import Values
    from camgeo.recipe.source import Mark

TOLERANCE = 0.001  # mm
ANGLES = 3600


def build(values: Values, path: Path, marks: Mapping[str, Mark]) -> Recipe:
    """Make the recipe of values in which there is no fault."""
    export: Values = values.get("export", {})
    return Recipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=values["mm"],
        rotation=values.get("rotation", "cw"),
        cam=_cam(values["cam"], values["mm"]),
        part=Part(**values.get("part", {})),
        export=Export(export.get("tolerance", TOLERANCE), requests(export.get("files", [{"kind": "dxf"}]))),
        verify=Verify(**{"angles": ANGLES, **values.get("verify", {})}),
        path=path,
        marks=marks,
    )


def requests(files: list[Values]) -> tuple[FileRequest, ...]:
    """Make the list of files."""
    return tuple(
        FileRequest("dxf", file.get("as", "arcs"), file.get("version", "R2010"), file.get("tolerance"))
        if file["kind"] == "dxf"
        else FileRequest(file["kind"], tolerance=file.get("tolerance"))
        for file in files
    )


def _cam(cam: Values, mm: float) -> Cam:
    undercut = cam.get("undercut", "refuse")
    match cam["kind"]:
        case "support":
            return SupportCam(_shape(cam, mm), cam.get("pivot", (0.0, 0.0)), undercut)
        case "constant-breadth":
            return ConstantBreadthCam(cam["base_radius"], _motion(cam["motion"]), undercut)
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
        return LawRoute(_motion(cam["law"]))
    if "arc" in cam:
        return ArcRoute(**{"side": "convex", **cam["arc"]})
    return RosetteRoute(cam["rosette"]["leaf"], mm)


def _motion(segments: list[Values]) -> tuple[MotionSegment, ...]:
    return tuple(map(_segment, segments))


def _segment(segment: Values) -> MotionSegment:
    if "dwell" in segment:
        return MotionSegment("dwell", segment["dwell"])
    kind: Literal["rise", "return"] = "rise" if "rise" in segment else "return"
    return MotionSegment(kind, segment["over"], segment[kind], segment["law"])
