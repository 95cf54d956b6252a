"""Preload by interference: the metal grows towards every contact of a follower that is held from both sides.

Both contacts together overlap the metal by the interference along their normals, so on one contour it grows by half of
that all round, and of two discs the second by all of it. The motion stays nominal: the contacts' elasticity takes up
the overlap.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from camgeo.cams.family import AlteredCam, ExactCam, GrownError, Preload
from camgeo.schema.fields import MOST, Field, Kind, length, mapping
from kin.law.contacts import eased_contact
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.cams.family import Cam, Circle, Margin, Proof
    from camgeo.cams.surface import Surface
    from camgeo.schema.reader import Values
    from kin.follower.base import Follower as Gauge
    from kin.law.joints import DerivativeJump
    from kin.law.support_function import Lift


@dataclass(frozen=True, eq=False)
class PreloadedCam(AlteredCam):
    """The exact cam `nominal` with metal that overlaps its contacts by the preload `held_by`; the motion stays.

    `grown_metal` has a grown cam for each surface, in their order.
    """

    grown_metal: tuple[ExactCam, ...]
    held_by: Preload

    @property
    def preload(self) -> Preload:
        """The preload of the contacts."""
        return self.held_by

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surfaces of the grown metal, with pressure angles, places of contact and series of the nominal motion."""
        metal = (exact.surfaces[rank] for rank, exact in enumerate(self.grown_metal))
        pairs = zip(metal, self.nominal.surfaces, strict=True)
        return tuple(
            replace(grown, pressure=bare.pressure, place=bare.place, series=bare.series) for grown, bare in pairs
        )

    @cached_property
    def gauges(self) -> dict[str, Gauge]:
        """Followers that judge files: the contacts stand back by the growth of the metal."""
        return self._followers(list(map(eased_contact, self.follower.contacts, self.preload.overlaps)))

    @property
    def running(self) -> dict[str, Gauge]:
        """Real follower on each surface, by the surface's name; it overlaps the metal."""
        return self.nominal.gauges

    @property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the nominal motion."""
        return self.nominal.joints

    @property
    def margins(self) -> list[Margin]:
        """Distances of the nominal motion from the limits beyond which it does not exist."""
        return self.nominal.margins

    @property
    def proofs(self) -> Mapping[str, Callable[[], Proof]]:
        """Functions that prove the nominal motion, by the names of the checks."""
        return self.nominal.proofs

    @property
    def never_undercut(self) -> bool:
        """Whether no motion can undercut any of the grown metal."""
        return all(exact.never_undercut for exact in self.grown_metal)

    @property
    def plate(self) -> Lift | None:
        """Support function of the nominal plate; None for other cams."""
        return self.nominal.plate

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """A size in words and the cam of that size, which keeps both pressure angles, rad; None if unknown."""
        return self.nominal.less_pressure(rising, falling, mm)

    def rounder_pitch(self, surface: str, mm: float) -> str:
        """Words for the size at which the roller is half the pitch curve's least convex radius, for the nominal cam."""
        return self.nominal.rounder_pitch(surface, mm)

    def circles(self, surface: str) -> tuple[Circle, ...]:
        """Reference circles of the nominal cam."""
        return self.nominal.circles(surface)

    def grow(self, out: float, scale: float) -> ExactCam:
        """The nominal cam grown by `out` mm and scaled, with its interference times `scale`.

        Raises GrownError where the growth leaves nothing of a radius, and IntentError where the preload does.
        """
        preload = replace(self.preload, interference=scale * self.preload.interference)
        return with_preload(self.nominal.grow(out, scale), preload)


def with_preload(nominal: ExactCam, preload: Preload | None) -> ExactCam:
    """An exact cam with its metal grown by each contact's share of an interference; the cam itself for None.

    Raises IntentError for a follower that is not held from both sides, and where nothing of a roller is left.
    """
    if preload is None:
        return nominal
    from kin.law.normalised import IntentError

    if not nominal.follower.closure:
        raise IntentError(
            f"a single {nominal.follower.name} follows this cam, as its breadth varies; a preload is held from both "
            "sides: leave it out, or give a cam of constant breadth",
            "preload",
        )
    contacts = zip(nominal.follower.contacts, preload.overlaps, strict=True)
    overlaps = {contact.surface: overlap for contact, overlap in contacts}
    try:
        metal = tuple(nominal.grow(overlaps[surface.name], 1.0) for surface in nominal.surfaces)
    except GrownError as error:
        name, radius = error.args
        share = "it" if 1.0 in preload.shares else "half of it"
        raise IntentError(
            f"{share} is no less than {name}, {radius:.6g} mm; give less", "preload.interference"
        ) from error
    return PreloadedCam(nominal, metal, preload)


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
    """Preload from values of a cam without fault; None where the recipe gives no preload.

    `shares` are the first and the second contact's parts of the interference. A single stiffness holds for both.
    """
    values = cam.get("preload")
    if values is None:
        return None
    first, *second = values.get("stiffness") or (None,)
    return Preload(values["interference"], None if first is None else (first, *(second or [first])), shares)
