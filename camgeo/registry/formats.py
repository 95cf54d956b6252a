"""Records of the formats of files, and the list of the formats.

A format is a module of `camgeo/formats`, whose `FORMAT` holds all facts of it. `MODULES` names the modules; each is
imported when a recipe or a file is of its format. The types below stand above this module: imports upwards are for
types alone. Functions import what they need when they are called, since a record is read with the recipe.
"""

from __future__ import annotations

from collections import ChainMap
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from camgeo.common.on_demand import OnDemand
from camgeo.registry import registry
from camgeo.registry.capability import NO_CHECK, always
from camgeo.schema.fields import FieldTable
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.cams.family import ExactCam
    from camgeo.common.clock import Clock
    from camgeo.files.mesh import Item
    from camgeo.files.precision import Precision
    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Order, Recipe
    from camgeo.registry.capability import ShaftCam
    from camgeo.report.document import Findings
    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent


def designed_intent(recipe: Recipe, design: Design, /) -> PartIntent:
    """Intent of the part as it is designed, by which kin judges files; raises ValueError for several discs."""
    from camgeo.synthesis.intent import intended

    return intended(recipe, design)


def has_holes(recipe: Recipe, /) -> bool:
    """Whether the part has holes besides its bore."""
    return recipe.part.holed


class RunResults(NamedTuple):
    """Results of a run, for files that report on all others.

    `job` is None where a check of the exact contour fails, so that no cam is made.
    """

    recipe: Recipe
    design: Design
    findings: Findings
    job: Job | None
    clock: Clock


@dataclass(frozen=True, kw_only=True)
class Variant:
    """Option of a capability by which a file shows something in place of the cam alone.

    option    the key, whose default is the cam alone; it stands before the options of the format
    offered   whether files of a format have the key
    tag       text behind the recipe's name in the name of the first file of a format
    check     notes the faults of a file with the option: (request, values of the recipe, reader, place of the file in
              the recipe, such as `export.files[0]`)
    foresee   refuses what is certain to be refused, before anything is fitted
    make      writes and judges the files: (job, request, path of the first file)
    """

    option: Field
    offered: Callable[[Format], bool]
    tag: Callable[[Format], str]
    check: Callable[[FileRequest, Values, Reader, str], None]
    foresee: Callable[[Job, FileRequest], None]
    make: Callable[[Job, FileRequest, Path], MadeFiles]

    def chosen(self, file: Values) -> bool:
        """Whether the values of a file have the option at another value than its default."""
        return bool(file.get(self.option.name, self.option.default) != self.option.default)


class Altered(NamedTuple):
    """A number other than its default that a file gives for the option `key` of a capability's `Alteration`."""

    capability: str
    key: str
    value: float


@dataclass(frozen=True, kw_only=True)
class Alteration:
    """Option of a capability that alters the part of a file, beside kerf, clearance and shrinkage.

    option    the key, a number whose default leaves the part as it is; it stands before the options of the format
    offered   whether files of a format have the key
    check     notes the faults of a file with another number: (request, values of the recipe, reader, place of the
              file in the recipe, such as `export.files[0]`)
    alter     gives the altered cam: (recipe, design, cam to be altered, the number, scale at which it is drawn);
              raises CallError in the words of the recipe for what cannot be altered, RecipeErrors for a file that it
              needs and that does not serve, OSError where such a file cannot be read
    """

    option: Field
    offered: Callable[[Format], bool]
    check: Callable[[FileRequest, Values, Reader, str], None]
    alter: Callable[[Recipe, Design, ExactCam, float, float], ExactCam]

    def chosen(self, file: Values) -> float | None:
        """Number that the values of a file give for the option; None for the default, which alters nothing."""
        value = file.get(self.option.name)
        return None if value is None or value == float(self.option.default) else float(value)


@dataclass(frozen=True, kw_only=True)
class Form:
    """One form of a format, by its word after the key `as`.

    surfaces  greatest number of surfaces that it holds of a cam of one disc; a cam of more is refused
    discs     greatest number of discs on one shaft that it holds
    pieces    noun for the pieces of its contour in reports
    listed    options that a report states
    ground    whether it is a table by which a lobe is ground, whose contour is judged
    curve     whether it is a list of points, the spline through which is judged as a contour
    takes     options of its files that other forms do not have
    check     notes what the recipe lacks for the form: (values of the file, values of the recipe, reader)
    make      writes and judges the file, where the format has no one way for all its forms
    after     name of the core's form behind which the form of a capability stands; empty: behind all
    """

    name: str = ""
    surfaces: int = 1
    discs: int = 1
    pieces: str = "pieces"
    listed: tuple[str, ...] = ()
    ground: bool = False
    curve: bool = False
    takes: tuple[str, ...] = ()
    check: Callable[[Values, Values, Reader], None] = NO_CHECK
    make: Callable[[Job, FileRequest, Path], MadeFiles] | None = None
    after: str = ""


WHOLE: Mapping[str, Form] = MappingProxyType({"": Form(surfaces=2, discs=2)})
"""Forms of a format that has one alone, which holds every cam."""


@dataclass(frozen=True, kw_only=True)
class Format:
    """All facts of a format.

    Of the recipe:

    name      its word in recipes, reports and on the command line
    suffix    ending of its files' names without the dot, where that is not the name
    tail      word behind the recipe's name in its files' names
    options   keys of one file
    named     options whose values stand in the names of its files, so that files of one form differ
    forms     its forms by their words after the key `as`; by the empty word for a format without that key
    check     notes the faults between its options and others: (values of the file, values of the recipe, reader)

    Of its files:

    contour   whether a file holds a contour, which is judged
    part      whether it shows the part itself: a program shows the path of a cutter
    solid     whether it is a solid, which needs a thickness
    by_disc   whether each disc on a shaft has a file of its own; else one file has all
    units     whether a file states its unit
    turning   whether it is made only of a mechanism that turns right round
    path      whether it shows the path of the cutter where `manufacture.layer` asks for that

    What makes them:

    make      fits, writes, reads back and judges one file at a path
    summarise writes files that report on all others of a run, when they are judged: (run, request, path)
    foresee   refuses what is certain to be refused, before anything is fitted; raises MissingExtraError where a package
              is missing that makes its files, which are then left out
    intent    intent by which kin judges its files
    bored     whether a file of a recipe has the bore of the part
    drilled   whether a file of a recipe has holes besides the bore
    unmade    pairs (name, reason) of features of the part that its files leave out
    numbers   gives the precision of the numbers of a mesh; None for a format without meshes
    write     writes named meshes in their places: (path, meshes, title, mm of the unit, about)
    shaft     writes a file of several cams on one shaft, which nothing judges: (recipe of the shaft, its cams, request,
              path); None where there is no such file
    """

    name: str
    suffix: str = ""
    tail: str = ""
    options: FieldTable = FieldTable(())
    named: tuple[str, ...] = ()
    forms: Mapping[str, Form] = field(default_factory=lambda: WHOLE)
    check: Callable[[Values, Values, Reader], None] = NO_CHECK
    contour: bool = True
    part: bool = True
    solid: bool = False
    by_disc: bool = False
    units: bool = True
    turning: bool = False
    path: bool = False
    make: Callable[[Job, FileRequest, Path], MadeFiles] | None = None
    summarise: Callable[[RunResults, FileRequest, Path], MadeFiles] | None = None
    foresee: Callable[[Job, FileRequest], None] = NO_CHECK
    intent: Callable[[Recipe, Design], PartIntent] = designed_intent
    bored: Callable[[Recipe], bool] = always(True)
    drilled: Callable[[Recipe], bool] = has_holes
    unmade: Callable[[Recipe, Design], Sequence[tuple[str, str]]] = always(())
    numbers: Callable[[], Precision] | None = None
    write: Callable[[Path, Sequence[Item], str, float, str], None] | None = None
    shaft: Callable[[Order, Sequence[ShaftCam], FileRequest, Path], None] | None = None

    @property
    def ending(self) -> str:
        """Ending of its files' names, without the dot."""
        return self.suffix or self.name

    @property
    def summary(self) -> bool:
        """Whether files of the format report on all other files of a run, and so are made last."""
        return self.summarise is not None

    @property
    def program(self) -> bool:
        """Whether files of the format are programs of a machine, whose contour is what the cutter leaves."""
        return self.contour and not self.part

    @property
    def chosen(self) -> Values:
        """Defaults of the options that choose a file's form and name."""
        return {item.name: item.default for item in self.options.fields if item.name in {"as", *self.named}}

    def form(self, word: str | None) -> Form:
        """Form by its word, for None the default form; for an unknown word a new form that holds one surface."""
        name = word or self.chosen.get("as", "")
        return self.forms.get(name) or Form(name=name)


MODULES = {
    "dxf": "camgeo.formats.dxf",
    "svg": "camgeo.formats.svg",
    "stl": "camgeo.formats.stl",
    "ply": "camgeo.formats.ply",
    "3mf": "camgeo.formats.three_mf",
    "step": "camgeo.formats.step",
    "glb": "camgeo.formats.glb",
    "csv": "camgeo.formats.csv",
    "html": "camgeo.formats.html",
}
"""Module of each of the core's formats by its word, in the order in which formats are listed."""
_ALL = ChainMap(registry.formats(), MODULES)  # in their order: the core's first


def _record(name: str) -> Format:
    record: Format = import_module(_ALL[name]).FORMAT
    return record


FORMATS: Mapping[str, Format] = OnDemand(_ALL, _record)
"""Record of each format by its word."""


def numbers_of(record: Format, mm: float) -> Precision:
    """Precision of the numbers of a mesh in a unit of `mm` mm; raises ValueError for a format without meshes."""
    if record.numbers is None:
        raise ValueError(f"{record.name} holds no mesh")
    return record.numbers().in_units(mm)


def variant(capability: str) -> Variant:
    """Record of the option by which a capability makes files; raises KeyError for a capability without one."""
    record = registry.capability(capability).variant
    if record is None:
        raise KeyError(capability)
    return record


def alteration(capability: str) -> Alteration:
    """Record of the option by which a capability alters the part; raises KeyError for a capability without one."""
    record = registry.capability(capability).alteration
    if record is None:
        raise KeyError(capability)
    return record
