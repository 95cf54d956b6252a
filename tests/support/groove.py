"""A groove for tests: two flanks under the roller of a disc cam, the outer one wider by a clearance.

The metal lies within the inner flank, as of a disc, and outside the outer one, as of a ring; the roller runs on both.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.cams.disc_cams import DiscCam
from camgeo.cams.family import Surface
from camgeo.cams.guided import ExactGuided, Spin
from camgeo.curve.curve import Curve
from camgeo.curve.moving_frame import CentreShape
from camgeo.curve.parallel import Parallel
from camgeo.recipe.loading import read
from kin.law.contacts import Roller
from kin.numeric.records import dataclass, fields, replace

if TYPE_CHECKING:
    from camgeo.cams.family import ExactCam, Follower
    from camgeo.recipe.recipe import Recipe

FLANKS = ("inner", "outer")
MOTION = "[{rise: 8, over: 120, law: cycloidal}, {dwell: 40}, {return: 8, over: 140, law: cycloidal}, {dwell: 60}]"
CAM = f"cam: {{kind: disc, base_radius: 40, follower: {{kind: roller, radius: 8, offset: 5}}, motion: {MOTION}}}"


@dataclass(frozen=True, eq=False)
class ExactGroove(ExactGuided):
    """The roller's path, and a flank on either side of it."""

    cam: GrooveCam

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The inner flank under the roller, the outer one under a roller wider by the clearance."""
        pitch = CentreShape(self.law, self.cam.led)
        return tuple(
            Surface(
                Curve.whole(pitch),
                Curve.whole(Parallel(pitch, side * radius)),
                radius,
                side,
                pitch.pressure_angle,
                series={"slope": pitch.slope, "spin": Spin(pitch, radius, float(side))},
                name=name,
                layer=f"GROOVE_{name.upper()}",
            )
            for name, side, radius in zip(FLANKS, (1, -1), self.cam.radii, strict=True)
        )

    @cached_property
    def follower(self) -> Follower:
        """One roller, which touches both."""
        alone = super().follower
        (contact,) = alone.contacts
        rollers = zip(FLANKS, self.cam.radii, strict=True)
        return replace(
            alone,
            closure="form-closure",
            contacts=tuple(replace(contact, touch=Roller(radius), surface=name) for name, radius in rollers),
        )


@dataclass(frozen=True)
class GrooveCam(DiscCam):
    """A disc cam whose roller runs in a groove."""

    clearance: float = 0.03

    @property
    def radii(self) -> tuple[float, float]:
        """Of the rollers that fill the groove to either flank, mm."""
        return self.touch.radius, self.touch.radius + self.clearance

    def exact(self, *, framed: bool = False) -> ExactCam:
        """By the same displacement."""
        exact = super().exact(framed=framed)
        assert isinstance(exact, ExactGuided)
        return ExactGroove(self, exact.law)


def grooved(text: str, clearance: float = 0.03, path: str = "groove.yaml") -> Recipe:
    """The recipe of a disc cam with its roller in a groove."""
    recipe = read(text.encode(), Path(path))
    assert isinstance(recipe.cam, DiscCam)
    given = {one.name: getattr(recipe.cam, one.name) for one in fields(recipe.cam)}
    return replace(recipe, cam=GrooveCam(**given, clearance=clearance))
