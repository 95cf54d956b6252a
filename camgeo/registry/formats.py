"""Facts of the formats of files, and the list of the formats.

A format is a module of `camgeo/formats`, whose `FORMAT` holds all that recipes and reports ask of it. What layers above
ask stands there too, such as `MAKING`. `MODULES` names the modules; each is imported when a recipe or a file is of its
format. Functions import what they need when they are called, since the module is read with the recipe.
"""

from __future__ import annotations

from collections import ChainMap
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from camgeo.common.on_demand import OnDemand
from camgeo.registry import registry
from camgeo.registry.slot import NO_CHECK
from camgeo.schema.fields import FieldTable
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from camgeo.schema.reader import Reader, Values

R = TypeVar("R")


@dataclass(frozen=True, kw_only=True)
class Form:
    """One form of a format, by its word after the key `as`.

    surfaces  greatest number of surfaces that it holds of a cam of one disc; a cam of more is refused
    discs     greatest number of discs on one shaft that it holds
    pieces    noun for the pieces of its contour in reports
    listed    options that a report states
    ground    whether it is a table by which a lobe is ground, whose contour is judged
    curve     whether it is a list of points, the spline through which is judged as a contour
    drive     whether it is a table between whose rows a drive interpolates, whose motion is judged
    takes     options of its files that other forms do not have
    check     notes what the recipe lacks for the form: (values of the file, values of the recipe, reader)
    after     name of the core's form behind which the form of a capability stands; empty: behind all
    """

    name: str = ""
    surfaces: int = 1
    discs: int = 1
    pieces: str = "pieces"
    listed: tuple[str, ...] = ()
    ground: bool = False
    curve: bool = False
    drive: bool = False
    takes: tuple[str, ...] = ()
    check: Callable[[Values, Values, Reader], None] = NO_CHECK
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
    mesh      whether it is a mesh, and so can hold every body
    summary   whether it reports on all other files of a run, and so is made last
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
    mesh: bool = False
    summary: bool = False

    @property
    def ending(self) -> str:
        """Ending of its files' names, without the dot."""
        return self.suffix or self.name

    @property
    def program(self) -> bool:
        """Whether files of the format are programs of a machine, whose contour is what the cutter leaves."""
        return self.contour and not self.part

    @property
    def chosen(self) -> Values:
        """Defaults of the options that choose a file's form and name, of those that have one."""
        chosen = (item for item in self.options.fields if item.name in {"as", *self.named})
        return {item.name: item.default for item in chosen if item.default in item.choices}

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


def of_formats(attribute: str, default: R) -> Mapping[str, R]:
    """What a layer above asks of each format, by its word: an attribute of its module, by default `default`.

    Another class than that of the default raises TypeError when it is asked for.
    """

    def record(name: str) -> R:
        value = getattr(import_module(_ALL[name]), attribute, default)
        if not isinstance(value, type(default)):
            raise TypeError(f"{_ALL[name]}: {attribute} is no {type(default).__name__}")
        return value

    return OnDemand(_ALL, record)
