"""The contract between the core and a capability: the record of a capability, whose fields the core calls by name.

A capability is a folder of `camgeo/capabilities`: its `__init__` holds a `Label`, its module `record` a `Capability`
named `CAPABILITY`. A field that the record leaves out adds nothing. The types below stand above this module: imports
upwards are for types alone. Functions import what they need when they are called, since a record is read with the
recipe.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.cams.family import ExactCam
    from camgeo.cams.surface import Surface
    from camgeo.checks.declared import Declared
    from camgeo.common.clock import Clock
    from camgeo.curve.curve import Curve
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.measures.remarks import RuleRemark
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.figures import DesignFigure
    from camgeo.recipe.recipe import Order, Recipe
    from camgeo.recipe.starter import Starter
    from camgeo.registry.formats import Alteration, Form, Variant
    from camgeo.registry.root import Root
    from camgeo.report.page.curves import Plot
    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.check import Check
    from kin.numeric.arrays import Array

T = TypeVar("T")
EMPTY: Mapping[str, Any] = MappingProxyType({})


class Results(NamedTuple):
    """Results of a capability in a run: sections of the report by their keys, checks, and figures of its own runs.

    `runs` has, for each figure that is `of` a run, its values by the name of the file that drives it, None for the
    intended motion. `skipped` has pairs (name, reason) of what was left out.
    """

    sections: Mapping[str, Any] = EMPTY
    checks: Sequence[Check] = ()
    runs: Mapping[str, Mapping[str | None, Measured]] = EMPTY
    skipped: Sequence[tuple[str, str]] = ()


class MovedBody(Protocol):
    """Body that a follower on a stem moves besides itself, such as a valve; lifts in mm."""

    @property
    def name(self) -> str:
        """Noun for messages: `valve`."""

    def rows(self, tappet: Array) -> Array:
        """Lift of the body, mm, and two derivatives by the shaft angle (3, n), from those of the follower (3, n)."""

    def follower_lift(self, lift: float) -> float:
        """Lift of the follower, mm, at a lift of the body, mm."""


class MadeMotion(NamedTuple):
    """The motion of a follower on a made part, beside the intended one, at shaft angles (n,), rad; mm or rad.

    `errors` are made less intended position, velocity and acceleration by the shaft angle (3, n), without the offset
    that is set on assembly; nan where acceleration jumps. `sds` are their standard deviations (3, n). `deviation` gives
    the standard deviation of a sum of position errors with the weights (n,). `gap` is by how much the play of two
    opposite contacts exceeds the intended one, with its standard deviation (2, n); None for a single contact.
    """

    shaft: Array
    errors: Array
    sds: Array
    deviation: Callable[[Array], float]
    gap: Array | None = None


class MadeFigure(NamedTuple):
    """A figure of a made motion as intended and as made, in `unit`.

    `uncertainty` is the expanded uncertainty (k = 2) of the made figure, `at_deg` the shaft angle of its place.
    """

    name: str
    unit: str
    intended: float
    made: float
    uncertainty: float
    at_deg: float


class MadeFigures(NamedTuple):
    """Figures of a made motion by a capability, and sentences on those that it cannot give."""

    figures: Sequence[MadeFigure] = ()
    remarks: Sequence[str] = ()


class SampledCams(Protocol):
    """Cams of m designs, each sampled at n places, of which a sweep estimates figures (m,) in mm and degrees."""

    @property
    def recipe(self) -> Recipe:
        """The recipe whose cam varies."""

    def most(self, rows: Array) -> Array:
        """Greatest value of rows (m, n) over the turn, (m,)."""

    def peak(self, order: int, speed: float = 1.0) -> Array:
        """Greatest value of a derivative of the motion by the shaft angle, or by time at a speed in rad/s, (m,).

        The motion is in mm or degrees; `order` is that of the derivative.
        """

    @property
    def slope(self) -> Array:
        """Tangent of the pressure angle, above 0 on the rise, (m, n)."""

    @property
    def lean(self) -> Array | None:
        """Tangent of the pressure angle at rest, (m,); None without a stem."""


class Estimate(NamedTuple):
    """Estimate of a figure of m cams: `of` gives it (m,).

    `error` is the greatest error seen, in degrees with `in_degrees`, else as a share of the figure; None where the
    estimate is exact.
    """

    of: Callable[[SampledCams], Array]
    error: float | None = None
    in_degrees: bool = False


class CallOption(NamedTuple):
    """Option of `camgeo verify`, a keyword of the library: its help, the word for its value in help, its choices.

    An option without choices takes any text.
    """

    about: str
    metavar: str = ""
    choices: tuple[str, ...] = ()


class FileCall(NamedTuple):
    """Arguments of `verify` for a capability's own files.

    `units` is the length, mm, of the unit of files that state none, None for the recipe's; `options` by name.
    """

    paths: Sequence[Path]
    units: float | None = None
    options: Mapping[str, object] = EMPTY


class ShaftCam(NamedTuple):
    """One of several cams on a shaft; lengths are mm, angles rad.

    name       its name, which no other cam of the shaft has
    recipe     its own recipe, with the unit and the sense of rotation of the shaft
    design     its exact cam
    at         angle by which its metal is turned, counter-clockwise in a drawing for rotation `cw`
    zero       shaft angle at which its motion begins
    low, high  its ends along the shaft
    events     lift of its follower at which events are stated; None: no events
    """

    name: str
    recipe: Recipe
    design: Design
    at: float
    zero: float
    low: float
    high: float
    events: float | None


class FileJudge(NamedTuple):
    """Judge of a capability's own files for `verify`, such as points measured on a part.

    claims       whether a file is of that kind, by its heading or the options of the call; raises OSError where the
                 file cannot be read
    options      options of a call on such files, by name; the command line gives their values as text
    judge        checks and sections; raises CallError for files that cannot be judged, SurroundingsError where the disk
                 refuses
    judge_shaft  as `judge`, for files of several cams on one shaft: (recipe of the shaft, its cams, call, clock)
    shown        text for the terminal: (report, whether all lines are wanted)
    """

    claims: Callable[[Path, Mapping[str, object]], bool]
    options: Mapping[str, CallOption]
    judge: Callable[[Recipe, Design, FileCall, Clock], Results]
    judge_shaft: Callable[[Order, Sequence[ShaftCam], FileCall, Clock], Results]
    shown: Callable[[dict[str, Any], bool], str]


# --- what a record holds where it leaves a function out ---------------------------------------------------------------


def always(value: T) -> Callable[..., T]:
    """Function of any positional arguments that returns this value."""
    return lambda *_: value


NO_CHECK: Callable[..., None] = always(None)
"""Check that notes no fault and refuses nothing."""


def no_figure_at(_recipe: Recipe, _design: Design, name: str, _lift: float, /) -> Measured:
    """Measure a figure at a lift for a capability without such figures: raises KeyError."""
    raise KeyError(name)


# --- the record -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Capability:
    """All that a capability adds. Lengths are in mm, angles in rad, figures and checks in mm and degrees.

    Of the recipe:

    fields    keys of the top level, each with the core's key behind which it stands as `after`
    below     keys of another table, by the table's path such as `part`; their values are taken out before the value of
              that table is built
    check     notes all faults between its keys and others: `reader.fault_at(path, problem, value, remedy)`
    build     object that `recipe.of(Class)` gives, from values without faults; None where the recipe has none
    speed     turns a minute of the shaft; None where the recipe gives no speed
    profile   path of the field that gives the profile tolerance of the made contour, and the width of the zone, mm;
              None without one
    starters  recipes for `camgeo new`, by name
    roots     other kinds of recipes, by the label's keys

    Of figures and checks:

    figures   by name, as recipes limit them and sweeps rank by them
    measure   figures `of` the design by name: (recipe, design, names, turns a minute of the limit of each figure)
    measure_at figure at a lift: (recipe, design, name, lift in mm); raises KeyError for a name without such a figure
    moved     body that the follower moves besides itself, with events of its own; None for none
    on_metal  figures of the motion that a made part gives: (recipe, design, motion); raises RecipeErrors where they
              cannot be had
    estimates estimates of figures of many cams at once for a sweep, by name
    checks    declarations of all its checks; every check that it makes is declared here
    exact     checks that need no file: (recipe, exact cam, pairs of a surface and its contour)
    remedy    sentence on a change that would bring a figure of its own to a bound that it misses: (recipe, name of the
              figure, its value, the bound); empty where none is known
    demand    raises SurroundingsError where a library that it needs is missing, before anything is designed
    look      checks of files beside the judge's: (recipe, design, all files, checks of them so far, clock)
    examine   checks, sections of the report and figures of runs, when all files were judged

    Of the page, the terminal and files:

    remarks   by the core's group of remarks behind which they stand, such as `sizing`: (recipe, design) -> remarks
    lines     a table for the terminal beside those of checks and files, from the report
    panel     HTML on the page, from the report
    plots     on the page, over a turn
    tables    forms of CSV by their words
    variant   option by which a file shows something else than the cam; None for none
    alteration option by which a file alters the part that it shows; None for none
    left_out  pairs (name, reason) of what a run leaves out: (recipe, requests of files, design)
    judges    judge of files of its own, of the suffixes that the label names; None for none
    """

    fields: Callable[[], Sequence[Field]] = always(())
    below: Mapping[str, Sequence[Field]] = EMPTY
    check: Callable[[Values, Reader], None] = NO_CHECK
    build: Callable[[Values], object | None] = always(None)
    speed: Callable[[Recipe], float | None] = always(None)
    profile: Callable[[Recipe], tuple[str, float] | None] = always(None)
    starters: Callable[[], Mapping[str, Starter]] = always(EMPTY)
    roots: Mapping[str, Root[Any]] = EMPTY
    figures: Mapping[str, DesignFigure] = EMPTY
    measure: Callable[[Recipe, Design, Sequence[str], Mapping[str, float]], Mapping[str, Measured]] = always(EMPTY)
    measure_at: Callable[[Recipe, Design, str, float], Measured] = no_figure_at
    moved: Callable[[Recipe, Design], MovedBody | None] = always(None)
    on_metal: Callable[[Recipe, Design, MadeMotion], MadeFigures] = always(MadeFigures())
    estimates: Callable[[], Mapping[str, Estimate]] = always(EMPTY)
    checks: Callable[[], Sequence[Declared]] = always(())
    exact: Callable[[Recipe, ExactCam, Sequence[tuple[Surface, Curve]]], Sequence[Check]] = always(())
    remedy: Callable[[Recipe, str, float, float], str] = always("")
    demand: Callable[[Recipe], None] = NO_CHECK
    look: Callable[[Recipe, Design, Sequence[FileResult], Sequence[Check], Clock], Results] = always(Results())
    examine: Callable[[Recipe, Design, Sequence[FileResult], Clock], Results] = always(Results())
    remarks: Mapping[str, Callable[[Recipe, Design], Sequence[RuleRemark]]] = EMPTY
    lines: Callable[[dict[str, Any]], str] = always("")
    panel: Callable[[dict[str, Any]], str] = always("")
    plots: Callable[[Recipe, Design], Sequence[Plot]] = always(())
    tables: Callable[[], Mapping[str, Form]] = always(EMPTY)
    variant: Variant | None = None
    alteration: Alteration | None = None
    left_out: Callable[[Recipe, Sequence[FileRequest], Design], Sequence[tuple[str, str]]] = always(())
    judges: FileJudge | None = None
