"""What a recipe says, checked and converted: lengths in mm, angles in radians.

Plain values throughout, so that recipes compare, hash and travel between processes. Formulas stay text; their values
are in the recipe's units, and `scale` (mm per unit) turns those into mm.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar, Literal, TypeAlias, get_args

from camgeo.recipe.errors import RecipeError, RecipeErrors

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import kin.law
    from camgeo.recipe.model_dynamics import Dynamics
    from camgeo.recipe.model_manufacture import Compensation, Manufacture
    from camgeo.recipe.model_mechanism import MechanismAsked
    from camgeo.recipe.model_part import Part
    from camgeo.recipe.model_sweep import Limit, Sweep
    from kin.motion_sources.programme import Step

Undercut: TypeAlias = Literal["refuse", "trim"]
Harmonics: TypeAlias = tuple[tuple[int, float], ...]  # (harmonic, coefficient), rising


@dataclass(frozen=True)
class FormulaShape:
    """A support function p(t), t in radians, as text; `scale` times its value is in mm."""

    text: str
    scale: float


@dataclass(frozen=True)
class FourierShape:
    """A support function mean + sum of cos[j] cos(j t) + sin[j] sin(j t), in mm."""

    mean: float
    cos: Harmonics
    sin: Harmonics


@dataclass(frozen=True)
class ReuleauxShape:
    """A regular Reuleaux polygon with an odd number of sides and rounded corners, in mm."""

    sides: int
    breadth: float
    rounding: float


@dataclass(frozen=True)
class HypocycloidShape:
    """The parallel curve of an odd hypocycloid, p = breadth/2 + size cos(cusps t), in mm."""

    cusps: int
    size: float
    breadth: float


Shape: TypeAlias = FormulaShape | FourierShape | ReuleauxShape | HypocycloidShape


@dataclass(frozen=True)
class SccaLaw:
    """A member of the SCCA family: shares of sine and constant acceleration, and of constant velocity."""

    sine: float = 0.0
    constant: float = 0.0
    velocity: float = 0.0


MATCH = "match"  # the law that takes its neighbours' velocity and acceleration


@dataclass(frozen=True)
class MotionSegment:
    """One segment of a motion programme.

    `over` in rad; `stroke` in mm for a plate, in rad for a follower that swings: of a rise, a return and a rise_fall
    their height, of `to` the displacement at the end, 0 for a dwell. `law` is a name, the coefficients c0, c1, ... of
    a polynomial in u, or shares. `formula` is a displacement in u, its values times `scale`. `at_end` holds v and a at
    the end of a matched segment, per rad.
    """

    kind: Literal["rise", "return", "to", "rise_fall", "displacement", "dwell"]
    over: float
    stroke: float = 0.0
    law: str | tuple[float, ...] | SccaLaw | None = None
    split: float | None = None
    at_end: tuple[float, float] | None = None
    formula: str = ""
    scale: float = 1.0

    def step(self, field: str = "motion") -> Step:
        """Give the segment with its law looked up, as `kin.motion_sources.programme` takes it.

        Raises kin's IntentError where a split or an end does not go with the law, with its field.
        """
        from kin.formula import Formula
        from kin.law import IntentError
        from kin.motion_sources.laws import split
        from kin.motion_sources.programme import Dwell, Given, Matched, Move, RiseAndFall, State

        if self.kind == "dwell":
            return Dwell(self.over)
        if self.kind == "rise_fall":
            return RiseAndFall(self.over, self.stroke)
        if self.kind == "displacement":
            return Given(self.over, Formula(self.formula, ("u",)), self.scale)
        by = {"rise": self.stroke, "return": -self.stroke}.get(self.kind)
        to = self.stroke if self.kind == "to" else None
        if self.law == MATCH:
            if self.split is not None:
                raise IntentError("a matched segment takes no split", f"{field}.split")
            state = None if self.at_end is None else State(*self.at_end)
            return Move(self.over, Matched(at_end=state), by, to)
        if self.at_end is not None:
            raise IntentError("only a matched segment takes a state at its end", f"{field}.at_end")
        law = self._law(field)
        return Move(self.over, law if self.split is None else split(law, self.split, field), by, to)

    def _law(self, field: str) -> kin.law.Law:
        from kin.law import polynomial_law
        from kin.motion_sources.laws import named, scca

        if isinstance(self.law, str):
            return named(self.law)
        if isinstance(self.law, SccaLaw):
            return scca(self.law.sine, self.law.constant, self.law.velocity, f"{field}.law.scca")
        return polynomial_law(self.law or (), f"{field}.law")


@dataclass(frozen=True)
class SupportCam:
    """A cam given by its support function; `pivot` is the shaft in the axes of that function, mm."""

    shape: Shape
    pivot: tuple[float, float]
    undercut: Undercut


@dataclass(frozen=True)
class ConstantBreadthCam:
    """A cam between two parallel faces, from the motion over one half turn (Shu and Wu)."""

    base_radius: float
    motion: tuple[MotionSegment, ...]
    undercut: Undercut


@dataclass(frozen=True)
class DeltaRoute:
    """D(t) = sum over odd j of cos[j] cos(j lambda t) + sin[j] sin(j lambda t), in mm^2 (Wunderlich 6.5)."""

    cos: Harmonics
    sin: Harmonics


@dataclass(frozen=True)
class LawRoute:
    """The follower's swing over delta = pi/lambda of shaft angle; of a flat pair the swing is psi/2."""

    motion: tuple[MotionSegment, ...]


@dataclass(frozen=True)
class ArcRoute:
    """A circular first arc of the pitch curve, radius in mm, symmetric about its bisector."""

    radius: float
    side: Literal["convex", "concave"]


@dataclass(frozen=True)
class RosetteRoute:
    """One leaf of the path of the third arm's tip: |OQ| as text in x, 0 to 1; `scale` times its value is in mm."""

    text: str
    scale: float


Route: TypeAlias = DeltaRoute | LawRoute | ArcRoute | RosetteRoute


@dataclass(frozen=True)
class DoubleRollerCam:
    """A single disk that works two rollers on one arm (Wunderlich); pi/alpha = lam/mu in lowest terms, mu odd."""

    lam: int
    mu: int
    arm: float
    roller_radius: float
    route: Route
    undercut: Undercut


@dataclass(frozen=True)
class FlatPairCam:
    """A single disk that works a rigid pair of flat faces, its pivot at 2 arm from the shaft (Wunderlich, 5)."""

    lam: int
    mu: int
    arm: float
    route: Route
    undercut: Undercut


Cam: TypeAlias = SupportCam | ConstantBreadthCam | DoubleRollerCam | FlatPairCam
CAM_KINDS: dict[type[Cam], str] = {
    SupportCam: "support",
    ConstantBreadthCam: "constant-breadth",
    DoubleRollerCam: "double-roller",
    FlatPairCam: "flat-pair",
}


def cam_kind(cam: Cam) -> str:
    """Name the kind of a cam as recipes do."""
    return CAM_KINDS[type(cam)]


Assembly: TypeAlias = Literal["open", "crossed"]
Carrier: TypeAlias = Literal["output", "coupler", "previous"]
Pair: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class RRRDyad:
    """Two links, mm: the first from `point` on the link `on`, the second from there to the fixed pivot `ground`."""

    on: Carrier
    point: Pair
    ground: Pair
    links: Pair
    assembly: Assembly

    slides: ClassVar[bool] = False


@dataclass(frozen=True)
class RRPDyad:
    """A link from `point` on the link `on` to a slide on the line through `through` in `direction` (rad); mm."""

    on: Carrier
    point: Pair
    link: float
    through: Pair
    direction: float
    assembly: Assembly

    slides: ClassVar[bool] = True


@dataclass(frozen=True)
class RPRDyad:
    """A block at `point` of the link `on`, in a slot that passes the fixed pivot `ground` at `offset`; mm."""

    on: Carrier
    point: Pair
    ground: Pair
    offset: float

    slides: ClassVar[bool] = False


Dyad: TypeAlias = RRRDyad | RRPDyad | RPRDyad


@dataclass(frozen=True)
class FourBarLinkage:
    """The frame as the coupler of a four-bar (AS 2023, Figure 7), mm; its output is an angle."""

    ground: float
    coupler: float
    rocker: float
    assembly: Assembly
    dyads: tuple[Dyad, ...] = ()

    kind: ClassVar[str] = "four-bar"
    slides: ClassVar[bool] = False


@dataclass(frozen=True)
class InvertedSliderCrankLinkage:
    """The frame sliding on a rocker (AS 2023, Figure 4b), mm; a rocker of 0 makes an oscillating yoke."""

    ground: float
    rocker: float
    assembly: Assembly
    dyads: tuple[Dyad, ...] = ()

    kind: ClassVar[str] = "inverted-slider-crank"
    slides: ClassVar[bool] = False


@dataclass(frozen=True)
class SliderCrankLinkage:
    """The frame as the coupler of a slide on the line y = offset, mm; its output is a length."""

    coupler: float
    offset: float
    assembly: Assembly
    dyads: tuple[Dyad, ...] = ()

    kind: ClassVar[str] = "slider-crank"
    slides: ClassVar[bool] = True


Linkage: TypeAlias = FourBarLinkage | InvertedSliderCrankLinkage | SliderCrankLinkage


def output_slides(linkage: Linkage) -> bool:
    """Tell whether the output of a linkage, that of its last dyad if it has any, is a length and not an angle."""
    return (linkage.dyads[-1] if linkage.dyads else linkage).slides


@dataclass(frozen=True)
class DwellAsked:
    """Dwells of the output: within `band` (rad, or mm where it slides); `at_least` (rad) is a check, over one angle."""

    band: float
    at_least: float | None = None
    over: Literal["shaft", "relative"] = "shaft"


FileKind: TypeAlias = Literal["dxf", "svg", "stl", "3mf", "step", "glb", "csv", "html", "gcode"]
KINDS: tuple[FileKind, ...] = get_args(FileKind)
NO_CONTOUR = frozenset({"csv", "html", "glb"})
"""Kinds of file that hold no contour to be judged."""
NO_PART = NO_CONTOUR | {"gcode"}
"""Kinds of file that do not show the part itself."""
SOLIDS = frozenset({"stl", "3mf", "step", "glb"})
"""Kinds of file that hold a solid, which needs a thickness."""
ALL_PARTS: dict[FileKind, str] = {"stl": "cam", "3mf": "parts", "glb": "assembly"}
"""Ends of the name of the first file of all bodies."""
SUFFIXES: dict[FileKind, str] = {"gcode": "ngc"}  # of kinds that are not their own


@dataclass(frozen=True)
class FileRequest:
    """One file to write.

    `as_` is of DXF, SVG, STEP and CSV, `version` of DXF; `tolerance` (mm) stands in for the export's own; a part that
    is made different from the nominal one has its `compensation`. `parts` is of solids: the cam, or all bodies of the
    mechanism.
    """

    kind: FileKind
    as_: Literal["arcs", "polyline", "spline", "exact", "motion", "inspection"] | None = None
    version: Literal["R12", "R2000", "R2010", "R2013"] | None = None
    tolerance: float | None = None
    compensation: Compensation | None = None
    parts: Literal["cam", "all"] = "cam"

    def filename(self, name: str, requests: Sequence[FileRequest]) -> str:
        """Name the file among all `requests` of recipe `name`.

        `<name>.<kind>`; where a kind is asked for more than once `<name>-<as>.<kind>`, and where that still leaves two
        alike `<name>-<as>-<version>.<kind>`, and `-kerf` and the like behind for a part that is not nominal. Of
        all bodies of a mechanism it is the first: `<name>-cam.stl`, `<name>-parts.3mf` or `<name>-assembly.glb`.
        """
        kin = [request for request in requests if request.kind == self.kind]
        parts = [name] if self.parts == "cam" else [name, ALL_PARTS[self.kind]]
        alike = [request for request in kin if request.as_ == self.as_]
        if len(kin) > 1 and self.as_:
            parts.append(self.as_)
            if len(alike) > 1 and self.version:
                parts.append(self.version)
        if len(alike) > 1 and self.compensation:
            parts.append(self.compensation.tags)
        return f"{'-'.join(parts)}.{SUFFIXES.get(self.kind, self.kind)}"


@dataclass(frozen=True)
class Export:
    """The files, and the greatest distance (mm) between a file's contour and the exact one."""

    tolerance: float
    files: tuple[FileRequest, ...]


@dataclass(frozen=True)
class Verify:
    """How each file is judged: shaft angles, and the greatest errors or None for the implied ones.

    `motion_error` (mm, or rad where the follower swings) is that of follower or frame against the cam, `output_error`
    (rad, or mm where it slides) that of the linkage's output.
    """

    angles: int
    motion_error: float | None = None
    output_error: float | None = None


@dataclass(frozen=True)
class Recipe:
    """A recipe, checked as far as no geometry is needed.

    `mm` is the length of its unit, `path` where it was read, `text` what stands there.
    """

    name: str
    about: str
    units: Literal["mm", "inch"]
    mm: float
    rotation: Literal["cw", "ccw"]
    cam: Cam
    part: Part
    export: Export
    verify: Verify
    path: Path
    linkage: Linkage | None = None
    dwell: DwellAsked | None = None
    sweep: Sweep | None = None
    dynamics: Dynamics | None = None
    manufacture: Manufacture | None = None
    mechanism: MechanismAsked | None = None
    limits: tuple[Limit, ...] = ()
    marks: Mapping[str, tuple[int, int]] = field(default_factory=dict, repr=False, compare=False)
    text: str = field(default="", repr=False, compare=False)

    def locate(self, path: str) -> tuple[int, int]:
        """Find line and column, from 1, of a field such as `cam.motion[1].law`; of its parent where it is not given."""
        while path and path not in self.marks:
            path = path[: max(path.rfind("."), path.rfind("["), 0)]
        return self.marks.get(path, (1, 1))

    def error(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> RecipeErrors:
        """Make the error that a later stage raises about a field, with the field's place in the file."""
        line, column = self.locate(path)
        return RecipeErrors([RecipeError(str(self.path), line, column, path, problem, value, remedy)])
