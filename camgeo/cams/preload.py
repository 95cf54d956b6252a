"""Preload by interference: metal grown towards every contact of a follower that is held from both sides.

Both contacts together overlap the metal by the interference along their normals, so on one contour it grows by half of
that all round, and of two discs the second by all of it. The motion is the one asked for:
the overlap is taken up by what gives way at either contact.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from camgeo.cams.family import ExactCam, GrownError, Preload
from camgeo.schema.fields import MOST, Field, Kind, length, mapping
from kin.law.contacts import eased
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.cams.family import Cam, Circle, Margin, Proof
    from camgeo.cams.follower import Follower
    from camgeo.cams.surface import Surface
    from camgeo.curve.moving_frame import Displacement
    from camgeo.motions.position import Position
    from camgeo.schema.reader import Values
    from kin.follower.base import Follower as Gauge
    from kin.law.joints import Joint
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission


@dataclass(frozen=True, eq=False)
class Preloaded(ExactCam):
    """An exact cam whose metal overlaps the contacts that `nominal` has; the motion is that one's.

    `grown_metal` is the cam that each of its surfaces is taken from.
    """

    nominal: ExactCam
    grown_metal: tuple[ExactCam, ...]
    held_by: Preload

    @property
    def preload(self) -> Preload:
        """The one that it is made by."""
        return self.held_by

    @property
    def cam(self) -> Cam:
        """The cam as far as its own lengths are drawn."""
        return self.nominal.cam

    @property
    def law(self) -> Lift | Displacement | Transmission:
        """The nominal one."""
        return self.nominal.law

    @property
    def follower(self) -> Follower:
        """The follower as it is."""
        return self.nominal.follower

    @property
    def motion(self) -> Position:
        """The nominal one."""
        return self.nominal.motion

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Those of the grown metal; what the follower does on them is nominal."""
        metal = (exact.surfaces[rank] for rank, exact in enumerate(self.grown_metal))
        pairs = zip(metal, self.nominal.surfaces, strict=True)
        return tuple(
            replace(grown, pressure=bare.pressure, place=bare.place, series=bare.series) for grown, bare in pairs
        )

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """Followers with room for the metal by which it has grown."""
        return self._followers(list(map(eased, self.follower.contacts, self.preload.overlaps)))

    @property
    def running(self) -> dict[str, Gauge]:
        """The follower itself, which overlaps the metal."""
        return self.nominal.gauges

    @property
    def judged_law(self) -> Piecewise | Transmission:
        """The nominal one."""
        return self.nominal.judged_law

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The nominal ones."""
        return self.nominal.joints

    @property
    def margins(self) -> list[Margin]:
        """Those of the nominal motion."""
        return self.nominal.margins

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """Those of the nominal motion."""
        return self.nominal.proofs

    @property
    def free(self) -> bool:
        """As the grown metal is."""
        return all(exact.free for exact in self.grown_metal)

    @property
    def plate(self) -> Lift | None:
        """The nominal one."""
        return self.nominal.plate

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """Of the nominal cam."""
        return self.nominal.less_pressure(rising, falling, mm)

    def rounder_pitch(self, surface: str, mm: float) -> str:
        """Of the nominal cam."""
        return self.nominal.rounder_pitch(surface, mm)

    @property
    def gap(self) -> float:
        """The nominal one."""
        return self.nominal.gap

    def circles(self, surface: str) -> tuple[Circle, ...]:
        """The nominal ones."""
        return self.nominal.circles(surface)

    def grown(self, out: float, scale: float) -> ExactCam:
        """Drawn larger, with as much interference; it is scaled with the drawing."""
        preload = replace(self.preload, interference=scale * self.preload.interference)
        return preloaded(self.nominal.grown(out, scale), preload)


def preloaded(nominal: ExactCam, preload: Preload | None) -> ExactCam:
    """An exact cam with its metal grown by what each contact has of an interference, itself without one.

    Raises IntentError for a follower that is not held from both sides, and one of which nothing would be left.
    """
    if preload is None:
        return nominal
    from kin.law.programme import IntentError

    if not nominal.follower.closure:
        raise IntentError(
            f"a single {nominal.follower.name} follows this cam, as its breadth varies; a preload is held from both "
            "sides: leave it out, or give a cam of constant breadth",
            "preload",
        )
    contacts = zip(nominal.follower.contacts, preload.overlaps, strict=True)
    overlaps = {contact.surface: overlap for contact, overlap in contacts}
    try:
        metal = tuple(nominal.grown(overlaps[surface.name], 1.0) for surface in nominal.surfaces)
    except GrownError as error:
        name, radius = error.args
        share = "it" if 1.0 in preload.shares else "half of it"
        raise IntentError(
            f"{share} is no less than {name}, {radius:.6g} mm; give less", "preload.interference"
        ) from error
    return Preloaded(nominal, metal, preload)


# --- in a recipe ------------------------------------------------------------------------------------------------------

PRELOAD = mapping(
    "preload",
    "a preload by interference, for a follower that two contacts hold",
    length("interference", "what both contacts together overlap the metal by, along their normals", required=True),
    Field(
        "stiffness",
        Kind.NUMBERS,
        "stiffness of the first contact and the second along their normals, N/m, for the force alone",
        default="no force",
        unit=Kind.RATE,
        at_least=1.0,
        at_most=MOST**2,
        most=2,
    ),
)


def build_preload(cam: Values, shares: tuple[float, float] = (0.5, 0.5)) -> Preload | None:
    """Make the preload of a cam's values in which there is no fault, None where they have none; `shares` of it."""
    given = cam.get("preload")
    if given is None:
        return None
    first, *second = given.get("stiffness") or (None,)
    return Preload(given["interference"], None if first is None else (first, *(second or [first])), shares)
