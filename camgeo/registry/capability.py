"""The contract between the core and a capability: all that the core asks of one, each by its name in the record.

A capability is a folder of `camgeo/capabilities`: its `__init__` holds a `Label`, its module `record` one `Capability`,
named `CAPABILITY`. What is left out of the record is nothing. The types below stand above this module, for which alone
imports for types run upwards. Functions import what they need when they are called: a record is read with the recipe.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

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
    from camgeo.measures.remarks import Remark
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.figures import Figure
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

EMPTY: Mapping[str, Any] = MappingProxyType({})


class Results(NamedTuple):
    """What a capability makes of a run: sections of the report by their keys, checks, and figures of runs of its own.

    `runs` has for each figure that is `of` a run its values by the file that drives it, None for the intended motion.
    `skipped` is what was left out, with the reason.
    """

    sections: Mapping[str, Any] = EMPTY
    checks: Sequence[Check] = ()
    runs: Mapping[str, Mapping[str | None, Measured]] = EMPTY
    skipped: Sequence[tuple[str, str]] = ()


class Moved(Protocol):
    """What a follower on a stem moves besides itself, such as a valve; lifts in mm."""

    @property
    def name(self) -> str:
        """What it is."""

    def rows(self, tappet: Array) -> Array:
        """Its lift and two derivatives (3, n) by those of the follower (3, n)."""

    def follower_lift(self, lift: float) -> float:
        """Lift of the follower at which it is at a lift."""


class MadeMotion(NamedTuple):
    """The motion of a follower on a made part, beside the intended one: shaft angles (n,), rad; mm or rad.

    `errors` are what position, velocity and acceleration, by the shaft angle, are off (3, n), without the offset that
    is set on assembly; nan where acceleration jumps. `sds` are their standard deviations (3, n).
    """

    shaft: Array
    errors: Array
    sds: Array


class MadeFigure(NamedTuple):
    """A figure of a made motion: as intended and as made, its expanded uncertainty (k = 2), and where, degrees."""

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
        """Greatest derivative of the motion by the shaft angle, or by time at a speed in rad/s, (m,)."""

    @property
    def slope(self) -> Array:
        """Tangent of the pressure angle, above 0 on the rise, (m, n)."""

    @property
    def lean(self) -> Array | None:
        """Tangent of the pressure angle at rest, (m,); None without a stem."""


class Estimate(NamedTuple):
    """How a figure is estimated: `of` gives it (m,), `error` is the greatest seen, in degrees or as a share of it.

    An estimate without error, None, is exact.
    """

    of: Callable[[SampledCams], Array]
    error: float | None = None
    in_degrees: bool = False


class CallOption(NamedTuple):
    """An option of `camgeo verify`, a keyword of the library: its help, what stands for its value, its choices."""

    about: str
    metavar: str = ""
    choices: tuple[str, ...] = ()


class FileCall(NamedTuple):
    """What `verify` is given for a capability's own files: paths, mm in a unit of files that state none, options."""

    paths: Sequence[Path]
    units: float | None = None
    options: Mapping[str, object] = EMPTY


class ShaftCam(NamedTuple):
    """One of several cams on a shaft; heights are mm, angles rad.

    name       its name, of which the shaft has no other
    recipe     its own, in the units of the shaft and turning as that does
    design     its exact cam
    at         angle by which its metal is turned, counter-clockwise as drawn for `cw`
    zero       shaft angle at which its motion begins
    low, high  its ends along the shaft
    events     lift of its follower, mm, at which events are told; None where none are
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
    """How `verify` has a capability judge files of its own, such as points measured on a part.

    claims       whether a file is of that kind, by its heading or the options of the call; raises OSError
    options      of a call on such files, by their names; the command line gives their values as text
    judge        checks and sections; raises CallError for what cannot be judged, SurroundingsError as the disk does
    judge_shaft  likewise, of files of several cams on one shaft: (recipe of the shaft, its cams, call, clock)
    shown        lines for the terminal, from the report and whether all is asked for
    """

    claims: Callable[[Path, Mapping[str, object]], bool]
    options: Mapping[str, CallOption]
    judge: Callable[[Recipe, Design, FileCall, Clock], Results]
    judge_shaft: Callable[[Order, Sequence[ShaftCam], FileCall, Clock], Results]
    shown: Callable[[dict[str, Any], bool], str]


# --- what a record holds where it leaves a function out ---------------------------------------------------------------


def no_fields() -> Sequence[Field]:
    """Give no keys."""
    return ()


def no_fault(_values: Values, _reader: Reader, /) -> None:
    """Note nothing."""


def no_value(_values: Values, /) -> object | None:
    """Make nothing."""
    return None


def no_speed(_recipe: Recipe, /) -> float | None:
    """Give no speed."""
    return None


def no_profile(_recipe: Recipe, /) -> tuple[str, float] | None:
    """Give no tolerance."""
    return None


def no_starters() -> Mapping[str, Starter]:
    """Give no starters."""
    return EMPTY


def no_declarations() -> Sequence[Declared]:
    """Declare no checks."""
    return ()


def no_exact_checks(
    _recipe: Recipe, _exact: ExactCam, _contours: Sequence[tuple[Surface, Curve]], /
) -> Sequence[Check]:
    """Make no checks."""
    return ()


def no_results(_recipe: Recipe, _design: Design, _files: Sequence[FileResult], _clock: Clock, /) -> Results:
    """Examine nothing."""
    return Results()


def no_demand(_recipe: Recipe, /) -> None:
    """Need nothing."""


def no_opinion(
    _recipe: Recipe, _design: Design, _files: Sequence[FileResult], _checks: Sequence[Check], _clock: Clock, /
) -> Results:
    """Look at no file."""
    return Results()


def no_figures(
    _recipe: Recipe, _design: Design, _names: Sequence[str], _speeds: Mapping[str, float], /
) -> Mapping[str, Measured]:
    """Measure nothing."""
    return EMPTY


def no_figure_at(_recipe: Recipe, _design: Design, name: str, _lift: float, /) -> Measured:
    """Know no figure at a lift."""
    raise KeyError(name)


def nothing_moved(_recipe: Recipe, _design: Design, /) -> Moved | None:
    """Move nothing."""
    return None


def no_made_figures(_recipe: Recipe, _design: Design, _motion: MadeMotion, /) -> MadeFigures:
    """Say nothing of a made motion."""
    return MadeFigures()


def no_remedy(_recipe: Recipe, _figure: str, _value: float, _bound: float, /) -> str:
    """Know no remedy."""
    return ""


def no_lines(_report: dict[str, Any], /) -> str:
    """Tell nothing."""
    return ""


def no_panel(_report: dict[str, Any], /) -> str:
    """Show nothing."""
    return ""


def no_plots(_recipe: Recipe, _design: Design, /) -> Sequence[Plot]:
    """Plot nothing."""
    return ()


def no_tables() -> Mapping[str, Form]:
    """Give no tables."""
    return EMPTY


def nothing_left_out(
    _recipe: Recipe, _requests: Sequence[FileRequest], _design: Design, /
) -> Sequence[tuple[str, str]]:
    """Leave nothing out."""
    return ()


def no_estimates() -> Mapping[str, Estimate]:
    """Estimate nothing."""
    return EMPTY


# --- the record -------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class Capability:
    """Everything that a capability adds. Lengths are mm, angles radians, figures and checks in mm and degrees.

    Of the recipe:

    fields    keys of the top level, each with the core's key behind which it stands as `after`
    below     keys of another table, by the table's path such as `part`; they are taken out before that table is made
    check     notes all faults between its keys and others: `reader.fault_at(path, problem, value, remedy)`
    build     makes of the values in which there is no fault what `recipe.of(Class)` gives; None for nothing
    speed     turns a minute of the shaft, where a recipe gives it
    profile   field that says in what zone the contour is to lie once it is made, and its width, mm
    starters  recipes for `camgeo new`, by name
    roots     other kinds of recipes, by the label's keys

    Of figures and checks:

    figures   by name, as recipes limit them and sweeps rank by them
    measure   figures `of` the design: (recipe, design, names, speeds of limits, turns a minute, by figure)
    measure_at figures that have a lift: (recipe, design, name, lift in mm)
    moved     what the follower moves besides itself, of which events may be told; None for nothing
    on_metal  figures of the motion that a made part gives: (recipe, design, motion); raises RecipeErrors
    estimates figures of many cams at once for a sweep, by name
    checks    declarations of all its checks; every check that it makes is one of them
    exact     checks that need no file: (recipe, exact cam, each surface with its contour)
    remedy    what would bring a figure of its own to a bound that it misses; empty: nothing that is known
    demand    raises SurroundingsError where a library is missing that it needs, before anything is designed
    look      checks of files beside the judge's: (recipe, design, all files, checks of them so far, clock)
    examine   checks, sections of the report and figures of runs, when all files were judged

    Of what is shown and written:

    remarks   by the core's group of remarks behind which they stand, see `remarks_of`: (recipe, design) -> remarks
    lines     a table for the terminal beside those of checks and files, from the report
    panel     HTML on the page, from the report
    plots     on the page, over a turn
    tables    forms of CSV by their words
    variant   what an option of files makes of them
    alteration what an option of files makes different of the part that they show
    left_out  what of it a run leaves out that uses it, with the reason: (recipe, requests of files, design)
    judges    files that `verify` is given and the record claims, of the suffixes that the label names; None: none
    """

    fields: Callable[[], Sequence[Field]] = no_fields
    below: Mapping[str, Sequence[Field]] = EMPTY
    check: Callable[[Values, Reader], None] = no_fault
    build: Callable[[Values], object | None] = no_value
    speed: Callable[[Recipe], float | None] = no_speed
    profile: Callable[[Recipe], tuple[str, float] | None] = no_profile
    starters: Callable[[], Mapping[str, Starter]] = no_starters
    roots: Mapping[str, Root[Any]] = EMPTY
    figures: Mapping[str, Figure] = EMPTY
    measure: Callable[[Recipe, Design, Sequence[str], Mapping[str, float]], Mapping[str, Measured]] = no_figures
    measure_at: Callable[[Recipe, Design, str, float], Measured] = no_figure_at
    moved: Callable[[Recipe, Design], Moved | None] = nothing_moved
    on_metal: Callable[[Recipe, Design, MadeMotion], MadeFigures] = no_made_figures
    estimates: Callable[[], Mapping[str, Estimate]] = no_estimates
    checks: Callable[[], Sequence[Declared]] = no_declarations
    exact: Callable[[Recipe, ExactCam, Sequence[tuple[Surface, Curve]]], Sequence[Check]] = no_exact_checks
    remedy: Callable[[Recipe, str, float, float], str] = no_remedy
    demand: Callable[[Recipe], None] = no_demand
    look: Callable[[Recipe, Design, Sequence[FileResult], Sequence[Check], Clock], Results] = no_opinion
    examine: Callable[[Recipe, Design, Sequence[FileResult], Clock], Results] = no_results
    remarks: Mapping[str, Callable[[Recipe, Design], Sequence[Remark]]] = EMPTY
    lines: Callable[[dict[str, Any]], str] = no_lines
    panel: Callable[[dict[str, Any]], str] = no_panel
    plots: Callable[[Recipe, Design], Sequence[Plot]] = no_plots
    tables: Callable[[], Mapping[str, Form]] = no_tables
    variant: Variant | None = None
    alteration: Alteration | None = None
    left_out: Callable[[Recipe, Sequence[FileRequest], Design], Sequence[tuple[str, str]]] = nothing_left_out
    judges: FileJudge | None = None
