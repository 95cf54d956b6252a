"""A surface of a disc: what the motion describes, the metal within it, and the figures of their contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.curve.curve import Curve
    from camgeo.curve.extremes import Extreme, ShaftFigure
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array


def upright(t: Array) -> Array:
    """Pressure angle of a flat face at right angles to its way, rad (n,): none."""
    return 0.0 * t


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a disc that a follower touches.

    `base` is what the motion describes, the pitch curve of a roller or the surface itself; `curve` is the surface, by
    `radius` (mm, 0 for flat faces) within the base, or around it where the metal lies outside (`side` -1). `pressure`
    is the angle between the contact's normal and the follower's way, rad, over parameters of the curve (n,), above 0
    where the cam drives a rise; `place` is where a flat face is touched, mm along it. `series` are figures over the
    shaft angle whose extremes are proved: slope, the tangent of the pressure angle; contact, the place on a flat face,
    mm; spin, turns of the roller per turn of the shaft. `name` is that by which contacts and reports tell it from the
    cam's other surfaces, empty where there is one; `disc` counts the discs on the shaft, `layer` is that of drawings.
    `depth` is how far it reaches down from the top face, mm, None of one that goes through.
    """

    base: Curve
    curve: Curve
    radius: float = 0.0
    side: Side = 1
    pressure: Callable[[Array], Array] = upright
    place: Callable[[Array], Array] | None = None
    series: Mapping[str, ShaftFigure] = field(default_factory=dict)
    name: str = ""
    disc: int = 0
    layer: str = "CUT"
    depth: float | None = None
    _extremes: dict[str, tuple[Extreme, Extreme]] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def prefix(self) -> str:
        """What names of its columns in tables begin with: its name, where the cam has several."""
        return f"{self.name.replace(' ', '_')}_" if self.name else ""

    def extremes(self, name: str) -> tuple[Extreme, Extreme] | None:
        """Least and greatest value of one of `series`, found once; None of one that there is not."""
        from camgeo.curve.extremes import both
        from camgeo.curve.rates import stretches

        if name not in self._extremes:
            figure = self.series.get(name)
            if figure is None:
                return None
            self._extremes[name] = both(figure, stretches(self.base.shape))
        return self._extremes[name]
