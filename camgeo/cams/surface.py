"""A surface of a disc: the curve that the motion describes, the contour beside it, and figures of their contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.curve.curve import Curve
    from camgeo.curve.extremes import Extreme, ShaftFigure
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array


def no_pressure_angle(t: Array) -> Array:
    """Pressure angle of a flat face at right angles to its way, rad (n,): 0."""
    return 0.0 * t


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a disc that a follower touches.

    `base` is the curve that the motion describes, the pitch curve of a roller or the surface itself; `curve` is the
    surface, by `radius` (mm, 0 for flat faces) within the base, or around it where the metal lies outside (`side` -1).
    `pressure` is the angle between the contact's normal and the follower's path, rad, over parameters of the curve
    (n,), above 0 where the cam drives a rise; `place` is the point of contact on a flat face, mm along it. `series` are
    figures over the shaft angle whose extremes are proved: slope, the tangent of the pressure angle; contact, the place
    on a flat face, mm; spin, turns of the roller per turn of the shaft. `name` tells the surface from the cam's others,
    empty where there is one; `disc` counts the discs on the shaft from 0, `layer` is that of drawings, `depth` reaches
    down from the top face, mm, None for a surface through the whole thickness.
    """

    base: Curve
    curve: Curve
    radius: float = 0.0
    side: Side = 1
    pressure: Callable[[Array], Array] = no_pressure_angle
    place: Callable[[Array], Array] | None = None
    series: Mapping[str, ShaftFigure] = field(default_factory=dict)
    name: str = ""
    disc: int = 0
    layer: str = "CUT"
    depth: float | None = None
    _extremes: dict[str, tuple[Extreme, Extreme]] = field(default_factory=dict, init=False, repr=False, compare=False)

    @property
    def prefix(self) -> str:
        """Prefix of the names of its columns in tables: its name, where the cam has several surfaces."""
        return f"{self.name.replace(' ', '_')}_" if self.name else ""

    def extremes(self, name: str) -> tuple[Extreme, Extreme] | None:
        """Least and greatest value of one of `series`, computed once; None without such a series."""
        from camgeo.curve.extremes import both
        from camgeo.curve.rates import stretches

        if name not in self._extremes:
            figure = self.series.get(name)
            if figure is None:
                return None
            self._extremes[name] = both(figure, stretches(self.base.shape))
        return self._extremes[name]
