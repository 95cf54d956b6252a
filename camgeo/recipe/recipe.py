"""The recipe as a whole: its keys, and what it says, checked and converted: lengths in mm, angles in radians.

Plain values throughout, so that recipes compare, hash and travel between processes. Formulas stay text; their values
are in the recipe's units, and `scale` (mm per unit) turns those into mm. Each topic has a file of its own beside this
one: its keys, how they are read and published, what they are checked for and what they become.
"""

from __future__ import annotations

import collections.abc
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, overload

from camgeo.cams.families import FAMILIES
from camgeo.common.arguments import is_a, number_of, path_of
from camgeo.common.errors import SurroundingsError
from camgeo.recipe.assembly import MECHANISM, MechanismAsked
from camgeo.recipe.cam import CAM, CAMS, build_cam, check_cam
from camgeo.recipe.dynamics import DYNAMICS, Dynamics, build_train, check_train
from camgeo.recipe.export import EXPORT, build_export, check_files
from camgeo.recipe.figures import LIMITS, Limit, build_limits, check_limits
from camgeo.recipe.linkage import (
    DWELL,
    DYADS,
    LINKAGE,
    LINKAGES,
    SLIDING,
    DwellAsked,
    build_linkage,
    check_linkage,
)
from camgeo.recipe.machining import MANUFACTURE, Manufacture, check_allowance
from camgeo.recipe.part import PART, build_part, check_part
from camgeo.recipe.ring import check_ring
from camgeo.recipe.sweep import SWEEP, build_sweep, check_sweep
from camgeo.schema.edit import with_values
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.fields import MOST, Field, Kind, Table, mapping, present
from camgeo.schema.reader import kind_of
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, as_written, described, entries

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from camgeo.cams.family import Cam
    from camgeo.recipe.export import Export, FileRequest, Length
    from camgeo.recipe.linkage import Linkage
    from camgeo.recipe.part import Part
    from camgeo.recipe.sweep import Sweep
    from camgeo.schema.change import Value
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Mark

ANGLES, MOST_ANGLES = 3600, 1_000_000  # of a turn at which files are judged
_MM = {"mm": 1.0, "inch": 25.4}


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

    `mm` is the length of its unit, `path` where it was read, `text` what stands there. `marks` are the places of the
    fields given, `renamed` the paths as written of those given by a former key, `notices` what is to be said of those.
    `unplaced` names in errors a text that stands in no file, whose lines nobody has seen; empty where lines count.
    """

    name: str
    about: str
    units: Length
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
    marks: collections.abc.Mapping[str, tuple[int, int]] = field(default_factory=dict, repr=False, compare=False)
    text: str = field(default="", repr=False, compare=False)
    renamed: collections.abc.Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)
    notices: tuple[RecipeError, ...] = field(default=(), repr=False, compare=False)
    unplaced: str = field(default="", repr=False, compare=False)

    @property
    def tables(self) -> tuple[str, ...]:
        """Fields that name a file which is read with the recipe, from the folder that it stands in."""
        return tuple(path for path in self.marks if path.startswith("cam.") and path.endswith(".table"))

    @overload
    def replace(self, path: str, value: Value, /) -> Recipe: ...

    @overload
    def replace(self, path: collections.abc.Mapping[str, Value], /) -> Recipe: ...

    def replace(self, path: str | collections.abc.Mapping[str, Value], value: Value = None, /) -> Recipe:
        """Give the recipe with another value at a path such as `cam.base_radius`, or with several, by a mapping.

        Values are in the recipe's units, as its text has them; where a path has none yet, the field is added. All else
        in the text stays, comments and former keys included. Raises RecipeErrors for a path that leads nowhere, and
        where the new recipe has faults; TypeError for a path that is no text.
        """
        from camgeo.recipe.loading import load_text
        from camgeo.schema.change import changed
        from camgeo.schema.yaml_source import read_source

        is_a("path", path, (str, collections.abc.Mapping), "a str or a mapping from such")
        if not isinstance(path, str) and value is not None:
            raise TypeError("value must be left out where path is a mapping")
        text = self.text
        given: dict[str, str] = {}
        for at, new in ({path: value} if isinstance(path, str) else path).items():
            is_a("path", at, str, "a str")
            there = self.written(self.present(at))
            if there in given:
                remedy = "give it one value"
                raise self.error(there, f"the same field as {given[there]}", None, remedy)
            given[there] = at
            source = read_source(text.encode("utf-8", "surrogatepass"), str(self.path))
            text = changed(source, there, new)
        return load_text(text, self.path, f"{self.path} (replaced)")

    def sized(self) -> Recipe:
        """Give the recipe with the sizes that its cam found in the place of `sizing`; itself where there are none."""
        from camgeo.recipe.loading import load_text
        from camgeo.schema.change import changed, exchanged
        from camgeo.schema.yaml_source import read_source

        text = self.text
        for path, size in self.cam.sizes.items():
            source = read_source(text.encode("utf-8", "surrogatepass"), str(self.path))
            value = size / self.mm
            if path == "base_radius":
                text = exchanged(source, "cam.sizing", path, value)
            else:
                text = changed(source, f"cam.{path}", value)
        return load_text(text, self.path, f"{self.path} (sized)") if self.cam.sizes else self

    def told_in(self, units: Length) -> Recipe:
        """Give the recipe as one that tells its lengths in another unit; what it asks for stays."""
        return replace(self, units=units, mm=_MM[units])

    def told_for(self, request: FileRequest) -> Recipe:
        """Give the recipe as one in the unit of a file."""
        return self.told_in(request.told_in(self.units))

    def field_of(self, request: FileRequest | None) -> str:
        """Give the path of a request; that of the list for one that does not stand there."""
        files = self.export.files
        return f"export.files[{files.index(request)}]" if request in files else "export.files"

    def request_of(self, filename: str) -> FileRequest | None:
        """Give the request whose file has this name, the first of all bodies' files, or None."""
        files = self.export.files
        return next((request for request in files if request.filename(self.name, files) == filename), None)

    def unstated(self, path: Path) -> float | None:
        """Give the unit, mm, of a file that cannot state one, where the recipe asks for a file of this name."""
        request = self.request_of(path.name) if path.suffix == ".stl" else None
        return None if request is None else self.told_for(request).mm

    def save(self, path: str | PathLike[str]) -> None:
        """Write the recipe's text to a file, in place of what is there.

        Raises SurroundingsError where the file system refuses, CallError for a path that no file can have.
        """
        file = path_of("path", path)
        try:
            file.write_text(self.text, encoding="utf-8", newline="")
        except OSError as error:
            raise SurroundingsError(f"cannot be written: {error.strerror or error}", file) from error

    def locate(self, path: str) -> tuple[int, int]:
        """Find line and column, from 1, of a field such as `cam.motion[1].law`; of its parent where it is not given."""
        path = self.written(path)  # which refuses what is no text
        while path and path not in self.marks:
            path = path[: max(path.rfind("."), path.rfind("["), 0)]
        return self.marks.get(path, (1, 1))

    def error(self, path: str, problem: str, value: str | None = None, remedy: str = "") -> RecipeErrors:
        """Make the error that a later stage raises about a field, with the field's place in the file."""
        line, column = self.locate(path)
        error = RecipeError(str(self.path), line, column, self.written(path), problem, value, remedy)
        return RecipeErrors([error.without_place(self.unplaced) if self.unplaced else error])

    def written(self, path: str) -> str:
        """Give a path as the recipe has it, with a former key where one stands."""
        is_a("path", path, str, "a str")
        return as_written(path, self.renamed)

    def present(self, path: str) -> str:
        """Give the path of a field of cam or linkage with present keys in the place of former ones."""
        is_a("path", path, str, "a str")
        linkage = "" if self.linkage is None else self.linkage.kind
        return present(RECIPE, path, {"cam": self.cam.kind, "linkage": linkage})

    def text_with(self, values: collections.abc.Mapping[str, float]) -> str:
        """Give the recipe's text with other numbers by their paths, by former keys or present ones.

        Raises CallError and RecipeErrors as `camgeo.schema.edit.with_values` does.
        """
        is_a("values", values, collections.abc.Mapping, "a mapping from paths to numbers")
        for path in values:
            is_a("values: a path", path, str, "a str")
        numbers = {path: number_of(f"values[{path!r}]", value) for path, value in values.items()}
        return with_values(self.text, {self.written(self.present(path)): value for path, value in numbers.items()})


RECIPE = Table(
    (
        Field("name", Kind.NAME, "name of the output folder and of the files in it", default="the file's stem"),
        Field("about", Kind.TEXT, "a note that travels into the files", default="none"),
        Field("units", Kind.CHOICE, "unit of lengths that carry none", default="mm", choices=("mm", "inch")),
        Field(
            "rotation",
            Kind.CHOICE,
            "sense in which the shaft turns, seen as drawn",
            default="cw",
            choices=("cw", "ccw"),
        ),
        Field("cam", Kind.OWN, "the cam, of exactly one kind", required=True, form=CAM),
        Field(
            "linkage",
            Kind.OWN,
            "the linkage whose coupler is the square frame around the cam",
            default="none",
            form=LINKAGE,
        ),
        PART,
        EXPORT,
        mapping(
            "verify",
            "how each file is judged",
            Field(
                "angles",
                Kind.INTEGER,
                "number of shaft angles at which each file is judged",
                default="3600",
                at_least=8,
                at_most=MOST_ANGLES,
            ),
            Field(
                "motion_error",
                Kind.ERROR,
                "greatest motion error permitted: a length, or degrees where the follower swings",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
            Field(
                "output_error",
                Kind.OUTPUT,
                "greatest error permitted of the linkage's output, in degrees, or a length where it slides",
                default="what the tolerance implies",
                above=0,
                at_most=MOST,
            ),
        ),
        LIMITS,
        mapping("mechanism", "sizes of the printable bodies round the cam, for files with `parts: all`", *MECHANISM),
        mapping("dwell", "dwells of the linkage's output", *DWELL),
        mapping("sweep", "a search among designs", *SWEEP),
        Field(
            "dynamics",
            Kind.TABLE,
            "the follower train, whose forces, float and impacts at a speed are found",
            default="none",
            table=DYNAMICS,
        ),
        Field("manufacture", Kind.TABLE, "how the part is milled", default="none", table=MANUFACTURE),
    ),
    later=(("camshaft", "camshafts"),),
)


def read_values(reader: Reader) -> Values:
    """Read the whole recipe and note the faults between its fields.

    What decides how other fields read is looked for first, wherever it stands: the unit, the kinds of cam and linkage,
    and so whether the follower swings and whether the output of the linkage slides.
    """
    root = reader.source.root
    reader.survey(root, "")
    if not isinstance(root, Mapping):
        reader.fault(root.mark, "", "a recipe is a mapping", described(root), "begin with the key `cam:`")
        return {}
    top = entries(root)
    units = top.get("units")
    if isinstance(units, Scalar) and units.text in _MM:
        reader.units, reader.mm = units.text, _MM[units.text]
    linkage = top.get("linkage")
    reader.kinds = {"cam": kind_of(top.get("cam"), CAMS), "linkage": kind_of(linkage, LINKAGES)}
    last = reader.kinds["linkage"]
    dyads = entries(linkage).get("dyads") if isinstance(linkage, Mapping) else None
    if isinstance(dyads, Sequence) and dyads.items:
        last = kind_of(dyads.items[-1], DYADS)
    if (family := FAMILIES.get(reader.kinds["cam"])) is not None:
        held = family.of(top["cam"])
        own = ((Kind.STROKE, held.unit), (Kind.ERROR, held.unit), (Kind.BACKLASH, held.backlash_unit))
        reader.angular |= {kind for kind, unit in own if unit == "deg"}
        reader.offers = held.offers
    if last not in SLIDING:
        reader.angular |= {Kind.OUTPUT}
    if (Kind.OUTPUT if reader.kinds["linkage"] else Kind.ERROR) in reader.angular:
        reader.angular |= {Kind.MOTION}
    values = {"mm": reader.mm, **reader.table(RECIPE, root, "")}
    _check(values, reader)
    return values


def _check(values: Values, reader: Reader) -> None:
    """Note the faults between fields that show without any geometry.

    Each check looks at the values that were read; where one of them is missing or faulty the check has nothing to say,
    as that fault is noted already.
    """
    check_cam(values.get("cam", {}), reader)
    check_linkage(values, reader)
    check_part(values.get("part", {}), reader)
    check_ring(values, reader)
    check_files(values, reader)
    check_train(values.get("dynamics", {}), reader)
    check_allowance(values.get("manufacture", {}), reader)
    check_limits(values.get("limits", []), reader)
    if "sweep" in values:
        check_sweep(values["sweep"], reader)


def build(values: Values, path: Path, marks: collections.abc.Mapping[str, Mark], text: str) -> Recipe:
    """Make the recipe of values in which there is no fault."""
    linkage = build_linkage(values["linkage"]) if "linkage" in values else None
    cam = build_cam(values["cam"], values["mm"])
    return Recipe(
        name=values["name"],
        about=values.get("about", ""),
        units=values.get("units", "mm"),
        mm=values["mm"],
        rotation=values.get("rotation", "cw"),
        cam=cam if linkage is None else linkage.shaped(cam),
        part=build_part(values.get("part", {})),
        export=build_export(values.get("export", {})),
        verify=Verify(**{"angles": ANGLES, **values.get("verify", {})}),
        path=path,
        linkage=linkage,
        dwell=DwellAsked(**values["dwell"]) if "dwell" in values else None,
        sweep=build_sweep(values["sweep"]) if "sweep" in values else None,
        dynamics=build_train(values["dynamics"]) if "dynamics" in values else None,
        manufacture=Manufacture(**values["manufacture"]) if "manufacture" in values else None,
        mechanism=MechanismAsked(**values["mechanism"]) if "mechanism" in values else None,
        limits=build_limits(values.get("limits", [])),
        marks=marks,
        text=text,
    )
