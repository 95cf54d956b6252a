"""Figures of a follower train at its speed: peaks in time, the guide of the stem, forces, float."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.recipe.design_figure import DesignFigure, Need
from camgeo.recipe.figures import ON_RETURN, PEAKS, PRELOAD_GREATEST
from camgeo.schema.fields import MOST, Field, Kind

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

AT_SPEED = tuple(f"{name}-at-speed" for name in PEAKS)
JAM_MARGIN = "jam-margin"
FORCE_LEAST, FORCE_GREATEST, TORQUE = "contact-force-least", "contact-force-greatest", "shaft-torque"
PRESSURE, GUIDE_FORCE, MEAN_FORCE = "contact-pressure", "guide-force", "mean-roller-force"
SEAT_LOAD, OPEN_LOAD, COIL_BIND = "spring-seat-load", "spring-open-load", "coil-bind"
OF_COIL = Need("dynamics.spring", lambda _, paths: "dynamics.spring" in paths)
OF_SOLID = Need("dynamics.spring.solid_length", lambda _, paths: "dynamics.spring.solid_length" in paths)
LEAST_FORCE, PEAK_FORCE, BACKLASH_LEFT = "least-force", "peak-force", "least-backlash"

_RPM = Field("rpm", Kind.NUMBER, "speed of the shaft, turns a minute", default="dynamics.rpm", above=0, at_most=MOST)

OF_SPRING = Need(
    "dynamics.preload or dynamics.spring, and its stiffness", lambda _, paths: _is_sprung(paths) and _STIFF in paths
)
OF_BACKLASH = Need("dynamics.backlash", lambda _, paths: {"dynamics.backlash", _STIFF} <= paths)
OF_GUIDE = Need(
    "dynamics.guide of a round follower", lambda offers, paths: "dynamics.guide" in paths and "stem" in offers
)
OF_SPEED = Need(
    "a follower without a linkage, and dynamics.rpm",
    lambda _, paths: "linkage" not in paths and "dynamics.rpm" in paths,
)
OF_FORCES = Need("dynamics without stiffness", lambda _, paths: _is_rigid(paths))
OF_MATERIAL = Need(
    "dynamics.material, part.thickness, a groove's depth or dynamics.width, and a rigid train or a spring",
    lambda _, paths: (
        not paths.isdisjoint({"dynamics.width", "part.thickness", "cam.track.groove.depth"})
        and "dynamics.material" in paths
        and (_is_rigid(paths) or _is_sprung(paths))
    ),
    part=True,
)
OF_REACTION = Need("dynamics.guide, and no stiffness", lambda _, paths: "dynamics.guide" in paths and _is_rigid(paths))
OF_BEARING = Need(
    "a roller that a cam turns, and dynamics without stiffness",
    lambda offers, paths: "rolling" in offers and _is_rigid(paths),
)
_STIFF = "dynamics.stiffness"


def _is_sprung(paths: AbstractSet[str]) -> bool:
    return not paths.isdisjoint({"dynamics.preload", "dynamics.spring"})


def _is_rigid(paths: AbstractSet[str]) -> bool:
    return "dynamics" in paths and _STIFF not in paths


_force = partial(DesignFigure, dear=True, after=PRELOAD_GREATEST)
_of_run = partial(DesignFigure, of="run", swept=False)

FIGURES: dict[str, DesignFigure] = {
    **{
        name: DesignFigure(
            about, Kind.MOTION, "least", OF_SPEED, per=per, dear=True, eased_by="motion", keys=(_RPM,), after=PEAKS[2]
        )
        for name, about, per in zip(
            AT_SPEED,
            (
                "peak-velocity a second, at the shaft's speed",
                "peak-acceleration a second squared, at that speed",
                "peak-jerk a second cubed, at that speed",
            ),
            ("/s", "/s^2", "/s^3"),
            strict=True,
        )
    },
    JAM_MARGIN: DesignFigure(
        "by how much the pressure angle stays below that at which the stem jams in its guide",
        Kind.ANGLE,
        "most",
        OF_GUIDE,
        dear=True,
        after=ON_RETURN,
    ),
    FORCE_LEAST: _force("least normal force of any contact at the speed, N", Kind.FORCE, "most", OF_FORCES),
    FORCE_GREATEST: _force("greatest normal force of any contact at the speed, N", Kind.FORCE, "least", OF_FORCES),
    TORQUE: _force("greatest torque of the shaft at the speed, either way, N m", Kind.MOMENT, "least", OF_FORCES),
    PRESSURE: _force(
        "greatest pressure of the contacts (Hertz), N/mm²", Kind.PRESSURE, "least", OF_MATERIAL, per="N/mm^2"
    ),
    GUIDE_FORCE: _force("greatest reaction of the stem's guide, N", Kind.FORCE, "least", OF_REACTION),
    MEAN_FORCE: _force("mean force of a roller over its own turns, exponent 10/3, N", Kind.FORCE, "least", OF_BEARING),
    SEAT_LOAD: DesignFigure("force of the spring where the follower is lowest, N", Kind.FORCE, "most", OF_COIL),
    OPEN_LOAD: DesignFigure("force of the spring where it is highest, N", Kind.FORCE, "least", OF_COIL),
    COIL_BIND: DesignFigure("what is left to the spring's coils where it is highest", Kind.LENGTH, "most", OF_SOLID),
    LEAST_FORCE: _of_run("least contact force, N; N m where it turns", Kind.THRUST, "most", OF_SPRING),
    PEAK_FORCE: _of_run("greatest contact force, N; N m where it turns", Kind.THRUST, "least", OF_SPRING),
    BACKLASH_LEFT: _of_run("least backlash that the dynamics leave between the faces", Kind.ERROR, "most", OF_BACKLASH),
}
