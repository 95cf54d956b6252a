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
    """Pressure angle, rad (n,), of a flat face at right angles to its path, at parameters t (n,): 0."""
    return 0.0 * t


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a disc that a follower touches.

    base      curve that the motion describes: the pitch curve of a roller, or under a flat face the surface itself
    curve     the surface, parallel to `base` at `radius`, mm, 0 for flat faces
    side      1 for metal inside the surface, which then lies inside `base`; -1 for metal outside, as in a ring
    pressure  angle between the contact's normal and the follower's path, rad (n,), at parameters of the curve (n,);
              above 0 where the cam drives a rise under a round touch, or where a face is tilted or offset ahead; of
              two rollers on one arm its size alone
    place     place of contact along a flat face, mm (n,), at parameters (n,); None for a round touch or two on one arm
    series    figures over the shaft angle whose extremes are proved: slope, the tangent of the pressure angle;
              contact, the place on a flat face, mm; spin, turns of the roller per turn of the shaft
    name      empty where the cam has one surface
    disc      number of the disc on the shaft, from 0
    layer     name of the layer in drawings
    depth     depth from the top face, mm; None for a surface through the whole thickness
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
        """Prefix of the names of its columns in tables: its name and `_`; empty where the cam has one surface."""
        return f"{self.name.replace(' ', '_')}_" if self.name else ""

    def extremes(self, name: str) -> tuple[Extreme, Extreme] | None:
        """Least and greatest value of the series of this name, computed once; None where `series` has none."""
        from camgeo.curve.extremes import both
        from camgeo.curve.rates import stretches

        if name not in self._extremes:
            figure = self.series.get(name)
            if figure is None:
                return None
            self._extremes[name] = both(figure, stretches(self.base.shape))
        return self._extremes[name]
