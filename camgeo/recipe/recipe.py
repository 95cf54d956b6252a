"""A recipe, checked and converted: lengths in mm, angles in radians.

Values are plain, so that recipes can be compared, hashed and pickled. Formulas stay text; their values are in the
recipe's units, which a factor beside them, mm per unit, turns into mm. Each topic has its keys, checks and values in a
file of its own beside this one.
"""

from __future__ import annotations

import collections.abc
import re
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, TypeVar, overload

from camgeo.common.arguments import demand_type
from camgeo.common.errors import CallError
from camgeo.part.part import build_part
from camgeo.recipe.cam import CAMS, build_cam
from camgeo.recipe.document import Document
from camgeo.recipe.export import build_export
from camgeo.recipe.extension import KEYS
from camgeo.recipe.keys import UNITS, read_values, recipe_table
from camgeo.recipe.limits import Limit, build_limits
from camgeo.recipe.linkage import DwellLimits, build_linkage
from camgeo.recipe.machining import Manufacture, build_manufacture
from camgeo.recipe.words import words_of
from camgeo.registry import registry
from camgeo.registry import root as roots
from camgeo.registry.formats import FORMATS
from camgeo.registry.root import CAM, Reading
from camgeo.schema.errors import RecipeError, RecipeErrors, nearest_word, suggestion
from camgeo.schema.file_bytes import read_bytes
from camgeo.schema.reader import Others, Reader, kind_of
from camgeo.schema.readers import READERS
from camgeo.schema.scalars import NAME_RULE, Complaint, read_name
from camgeo.schema.yaml_source import MAX_BYTES, Mapping, Scalar, entries, keys, read_source
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike
    from typing import Self

    from camgeo.cams.family import Cam
    from camgeo.part.part import Part
    from camgeo.recipe.export import Export, FileRequest, Length
    from camgeo.recipe.linkage import Linkage
    from camgeo.schema.change import Value
    from camgeo.schema.reader import Values
    from camgeo.schema.yaml_source import Source

T = TypeVar("T")
ANGLES = 3600  # of a turn at which files are judged
OF_A_KIND = re.compile(rf"({CAM}\.(?!kind$)|part\.|limits\.).*|export\.files\[\d+\]")
"""Paths of what depends on the kind of cam: its keys, those of the part and of limits, and what a file needs."""


@dataclass(frozen=True)
class Verify:
    """Judgement of files: number of shaft angles in a turn, and the greatest errors permitted.

    `motion_error` is the error of the follower's or frame's position, mm, or rad where it swings; `output_error` the
    error of the linkage's output, rad, or mm where it slides. None stands for the error that the tolerance implies.
    Openings that the part does not name are faults of a file unless `openings` is "ignore".
    """

    angles: int
    motion_error: float | None = None
    output_error: float | None = None
    openings: Literal["judge", "ignore"] = "judge"


class Angle(NamedTuple):
    """An angle chosen in place of a word of the recipe, such as `least`: the path of the field, and degrees."""

    path: str
    degrees: float


@dataclass(frozen=True)
class ChosenAngles:
    """Angles of a motion chosen for `over: least` and `dwell: rest`.

    `kind` is the key, such as rise, of the segment with the least angle. `bound` are names of the checks that fail at
    the next shorter angle, or why it gives no cam; `again` are longer angles, degrees, that were tried and fail too.
    """

    kind: str
    least: Angle
    rest: Angle
    bound: tuple[str, ...]
    again: tuple[float, ...]


@dataclass(frozen=True)
class Order(Document):
    """A recipe of any kind; `mm` is the length of its unit, mm, `root` the key that makes its kind, such as cam."""

    root: ClassVar[str]

    name: str
    about: str
    units: Length
    mm: float
    export: Export
    verify: Verify

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}, {str(self.path)!r})"

    @property
    def input_entries(self) -> dict[str, str]:
        """Entries of a report that say how the input runs, such as the `rotation` of a shaft."""
        return {}

    @property
    def input_words(self) -> str:
        """How the input runs, in words."""
        return ""

    @property
    def parts(self) -> tuple[Path, ...]:
        """Files of the recipes that this recipe is made of, each once; none for a cam."""
        return ()

    @property
    def trims(self) -> bool:
        """Whether undercut is cut off, so that motion is lost and not judged."""
        return False

    def field_of(self, request: FileRequest | None) -> str:
        """Path of a request in the recipe, such as export.files[0]; export.files for None or a request not in it."""
        files = self.export.files
        return f"export.files[{files.index(request)}]" if request in files else "export.files"

    def tolerance(self, request: FileRequest) -> float:
        """Tolerance of a requested file, mm: its own, or else that of the export."""
        return request.tolerance or self.export.tolerance

    def tolerance_field(self, request: FileRequest) -> str:
        """Path of what sets the tolerance of a requested file."""
        return "export.tolerance" if request.tolerance is None else self.field_of(request)

    def using(self, *options: str) -> Self:
        """The recipe itself; raises CallError for any option, as options need a recipe of one cam."""
        if options:
            raise CallError(f"{options[0]} looks at files of one cam: leave it out for a {self.root}")
        return self

    def filenames(self, request: FileRequest) -> tuple[str, ...]:
        """Names of the files that a request makes, one for a recipe without a cam."""
        return (request.filename(self.name, self.export.files),)

    def request_of(self, filename: str) -> FileRequest | None:
        """First file request of the recipe that writes a file of this name; None without one."""
        return next((request for request in self.export.files if filename in self.filenames(request)), None)


@dataclass(frozen=True)
class ShaftOrder(Order):
    """A recipe of what a shaft turns; `rotation` is the sense in which it turns, seen as drawn."""

    rotation: Literal["cw", "ccw"]

    @property
    def input_entries(self) -> dict[str, str]:
        """Sense of rotation of the shaft, for a report."""
        return {"rotation": self.rotation}

    @property
    def input_words(self) -> str:
        """Sense of rotation of the shaft, in words."""
        return f"the shaft turns {'clockwise' if self.rotation == 'cw' else 'counter-clockwise'}"


@dataclass(frozen=True)
class SolidOrder(ShaftOrder):
    """A recipe of a solid cam, computed as one that turns clockwise."""

    @property
    def mirrored(self) -> bool:
        """Whether the cam in files is the mirror image, y -> -y, of the computed one."""
        return self.rotation == "ccw"

    @property
    def sense(self) -> float:
        """Factor of y and of polar angles from the computed cam to the one in files: -1 if mirrored, else 1."""
        return -1.0 if self.mirrored else 1.0


@dataclass(frozen=True)
class Recipe(ShaftOrder):
    """A recipe of a disc cam, checked as far as no geometry is needed.

    `wheel` is the radius of the grinding wheel, mm, None where none is given. `capabilities` has the names of the
    capabilities that the recipe uses, each with the value made of its keys, None without keys. `settled` has the angles
    chosen for a motion that the recipe leaves open, None where it gives all angles.
    """

    root = CAM
    cam: Cam
    part: Part
    linkage: Linkage | None = None
    dwell: DwellLimits | None = None
    manufacture: Manufacture | None = None
    wheel: float | None = None
    limits: tuple[Limit, ...] = ()
    capabilities: tuple[tuple[str, object], ...] = ()
    settled: ChosenAngles | None = None

    @property
    def uses(self) -> tuple[str, ...]:
        """Names of the capabilities that the recipe uses."""
        return tuple(name for name, _ in self.capabilities)

    @property
    def rpm(self) -> float | None:
        """Speed of the shaft, turns a minute; None where the recipe gives none."""
        speeds = (KEYS[name].speed(value) for name, value in self.capabilities if value is not None)
        return next((rpm for rpm in speeds if rpm is not None), None)

    @property
    def profile(self) -> float | None:
        """Width, mm, of the tolerance zone of the made contour; None where the recipe gives none."""
        return None if self.zone is None else self.zone[1]

    @property
    def zone(self) -> tuple[str, float] | None:
        """Path of the field of the made contour's tolerance zone, and the zone's width, mm; None without a zone.

        Of several it is the one that counts: that of the capability of the highest rank.
        """
        return next(iter(self.zones), None)

    @property
    def zones(self) -> tuple[tuple[str, float], ...]:
        """Every statement of the made contour's tolerance zone, as `zone` has it; the one that counts comes first."""
        zones = [KEYS[name].profile(value) for name, value in reversed(self.capabilities) if value is not None]
        return tuple(zone for zone in zones if zone is not None)

    def of(self, kind: type[T]) -> T | None:
        """The value of the class `kind` that a capability made of its keys; None where the recipe has none."""
        return next((value for _, value in self.capabilities if isinstance(value, kind)), None)

    def without(self, *names: str) -> Recipe:
        """The recipe without the capabilities of these names; its text and marks stay."""
        return replace(self, capabilities=tuple(item for item in self.capabilities if item[0] not in names))

    def using(self, *options: str) -> Recipe:
        """The recipe with further capabilities in use, by their names, without values."""
        return replace(self, capabilities=(*self.capabilities, *((option, None) for option in options)))

    def with_value(self, value: object) -> Recipe:
        """The recipe with a capability's value replaced by one of the same class; ValueError where it has none."""
        if self.of(type(value)) is None:
            raise ValueError(f"{self.name}: no {type(value).__name__}")
        capabilities = (
            (name, value if isinstance(current, type(value)) else current) for name, current in self.capabilities
        )
        return replace(self, capabilities=tuple(capabilities))

    __repr__ = Order.__repr__

    @overload
    def replace(self, path: str, value: Value, /) -> Recipe: ...

    @overload
    def replace(self, path: collections.abc.Mapping[str, Value], /) -> Recipe: ...

    def replace(self, path: str | collections.abc.Mapping[str, Value], value: Value = None, /) -> Recipe:
        """The recipe with another value at a path such as `cam.base_radius`, or with several, by a mapping.

        Values are in the recipe's units, as in its text; a field that is not given yet is added. All else in the text
        stays, comments included. Raises RecipeErrors for a path that leads nowhere, a value that no recipe may hold, a
        place that an alias shares, and where the new recipe has faults; TypeError for a path that is no str, and for a
        value beside a mapping.
        """
        demand_type("path", path, (str, collections.abc.Mapping), "a str or a mapping from such")
        if not isinstance(path, str) and value is not None:
            raise TypeError("value must be left out where path is a mapping")
        text = self.changed({path: value} if isinstance(path, str) else path)
        return load_text(text, self.path, f"{self.path} (replaced)")

    def sized(self) -> Recipe:
        """The recipe with the values chosen for `sizing`, `least` and `rest` written out; itself without these keys.

        Raises RecipeErrors where an alias shares one of their places.
        """
        from camgeo.schema.change import replace_entry, set_value

        angles = {} if self.settled is None else dict((self.settled.least, self.settled.rest))
        document = Document(path=self.path, text=self.changed(angles))
        for path, size in self.cam.sizes.items():
            source, value = document.source(), size / self.mm
            if path == "base_radius":
                text = replace_entry(source, "cam.sizing", path, value)
            else:
                text = set_value(source, f"cam.{path}", value)
            document = Document(path=self.path, text=text)
        return load_text(document.text, self.path, f"{self.path} (sized)") if self.cam.sizes or angles else self

    def in_units(self, units: Length) -> Recipe:
        """The recipe with another unit of lengths in reports and files; all values stay, in mm."""
        return replace(self, units=units, mm=UNITS[units])

    def in_units_of(self, request: FileRequest) -> Recipe:
        """The recipe with the unit of a requested file."""
        return self.in_units(request.unit_for(self.units))

    @property
    def trims(self) -> bool:
        """Whether undercut is cut off."""
        return self.cam.undercut == "trim"

    def filenames(self, request: FileRequest) -> tuple[str, ...]:
        """Names of the files of a request that hold the cam: one, or one for each disc."""
        return request.filenames(self.name, self.export.files, self.cam.arrangement.discs)

    def unstated_unit(self, path: Path) -> float | None:
        """Length, mm, of the unit in which the numbers of a file without a stated unit are read; None for other files.

        It is the unit of the request of this name, else the recipe's. Files without a stated unit are lists of points
        of a curve, tables of curve points for a drive, and requested files of a format that states none. Raises
        ValueError for a suffix of no format, OSError where a table cannot be read.
        """
        from kin.read.curve_points import is_curve_points
        from kin.read.formats import format_of
        from kin.read.point_list import is_point_list

        request = self.request_of(path.name)
        in_file = self if request is None else self.in_units_of(request)
        if format_of(path).contents == "table" and (is_point_list(path) or is_curve_points(path)):
            return in_file.mm
        return None if request is None or request.format.units else in_file.mm


def read(data: bytes, path: str | PathLike[str], unplaced: str = "") -> Recipe:
    """Read a recipe from bytes; raises RecipeErrors with all its faults.

    `path` names the recipe in errors and gives its default name, and files that the recipe names are in its folder.
    `unplaced` names in errors bytes that stand in no file and so have no lines to refer to.
    """
    with without_places(unplaced):
        return replace(of_source(read_source(data, str(path)), path), unplaced=unplaced)


@contextmanager
def without_places(name: str) -> Iterator[None]:
    """Context in which RecipeErrors show `name` in place of a file's line, for a text that stands in no file.

    With an empty name the errors stay as they are.
    """
    try:
        yield
    except RecipeErrors as errors:
        raise RecipeErrors(error.without_place(name) if name else error for error in errors.errors) from None


def root_key(source: Source) -> str:
    """Key of the kind of a recipe: a key of its top level, or its `cam.kind`; `cam` for a disc cam.

    A word that stands for a kind, or is near to one, is that kind, whose own reading refuses the word: of a slip in
    the kind all other keys are not at fault.
    """
    top = entries(source.root) if isinstance(source.root, Mapping) else {}
    cam = top.get(CAM)
    kind = entries(cam).get("kind") if isinstance(cam, Mapping) else None
    word = kind.text if isinstance(kind, Scalar) else ""
    own = word if word in roots.kinds() else roots.slips().get(word, CAM)
    if own == CAM and word not in CAMS:
        near = nearest_word(word, (*CAMS, *roots.kinds(), *roots.slips()))
        own = near if near in roots.kinds() else roots.slips().get(near, CAM)
    return next((key for key in roots.top_keys() if key in top), own)


def intended_root(source: Source) -> str:
    """Key of the kind of a recipe, also where it is a key of the top level, misspelt in a text without a cam.

    `cam` where no top key resembles the key of another kind.
    """
    top = entries(source.root) if isinstance(source.root, Mapping) else {}
    key = root_key(source)
    if key != CAM or CAM in top:
        return key
    words = (*roots.top_keys(), *recipe_table().keys)
    slips = (suggestion(word, words) for word in top)
    return next((key for slip in slips for key in roots.top_keys() if key in slip), CAM)


def of_source(source: Source, path: str | PathLike[str]) -> Recipe:
    """Recipe of a cam from a parsed text; raises RecipeErrors with all its faults, and for another kind of recipe.

    `path` names the recipe in errors and gives its default name.
    """
    if (key := root_key(source)) != CAM:
        raise RecipeErrors([_of_another_kind(source, path, key)])
    reader, values = _read(source, registry.by_words(words_of(source.root)))
    if reader.errors:  # read again with all capabilities: an unknown key may be one of theirs, or close to one
        reader, values = _read(source, KEYS.answering())
    name_by_stem(values, reader, path)
    if reader.errors:
        raise RecipeErrors(reader.errors)
    document = Document(path=Path(path), text=source.text, marks=reader.marks, kinds=reader.kinds)
    recipe = _build(values, document, registry.by_words(words_of(source.root)))
    return recipe if recipe.cam.open is None else roots.settle(recipe)


def _of_another_kind(source: Source, path: str | PathLike[str], key: str) -> RecipeError:
    """Fault of a text that is a recipe of another kind than a disc cam."""
    top, other = keys(source.root) if isinstance(source.root, Mapping) else {}, roots.reading(key)
    field, mark = (key, top[key].mark) if key in top else (f"{CAM}.kind", top[CAM].mark)
    remedy = (
        f"export, check and verify take it; its page is html in export.files; give any other command {other.instead}"
    )
    return RecipeError(str(path), *mark, field, f"a {other.noun} is no disc cam", None, remedy)


def reader_of_kind(source: Source, key: str) -> Reader:
    """Reader of a recipe of another kind than a disc cam; it refuses words of other recipes in one sentence."""
    kind = roots.reading(key)

    def have(word: str) -> bool:
        return word in FORMATS or word in roots.top_keys() or word in recipe_table(KEYS.answering()).keys

    return Reader(source, READERS, kind.table(), Others(kind.noun, kind.instead, have))


def name_by_stem(values: Values, reader: Reader, path: str | PathLike[str]) -> None:
    """Set the name of a recipe that gives none to the stem of its file, or note that no name can be made of it."""
    if "name" in reader.marks:
        return
    stem = Path(path).stem
    try:
        values["name"] = read_name(stem)
    except Complaint as complaint:
        remedy = f"give `name:` with {NAME_RULE}"
        reader.fault(reader.source.root.mark, "name", f"the file's stem is {complaint.problem}", repr(stem), remedy)


def _read(source: Source, capabilities: tuple[str, ...]) -> tuple[Reader, Values]:
    reader = Reader(source, READERS, recipe_table(capabilities))
    values = read_values(reader, capabilities)
    cam = entries(source.root).get(CAM) if isinstance(source.root, Mapping) else None
    if isinstance(cam, Mapping) and "kind" in entries(cam) and not kind_of(cam, CAMS):
        # which keys a kind takes is not known of one that there is not
        reader.errors = [error for error in reader.errors if not OF_A_KIND.fullmatch(error.path)]
    return reader, values


def reader_of(source: Source) -> Reader:
    """Reader that has read the text of a cam, with all of its faults."""
    return _read(source, registry.by_words(words_of(source.root)))[0]


def file_bytes(path: str | PathLike[str]) -> bytes:
    """Bytes of a recipe's file, at most the first `MAX_BYTES` + 1, by which a larger file is known.

    Raises RecipeErrors for an empty name, for a file that does not exist or cannot be read, and for one of a cam.
    """
    if not str(path):
        raise RecipeErrors([RecipeError("''", 0, 0, "", "an empty name of a file", None, "give the path of a recipe")])
    try:
        data = read_bytes(path, MAX_BYTES, "recipe")
    except Complaint as complaint:
        raise RecipeErrors([RecipeError(str(path), 0, 0, "", complaint.problem, None, complaint.remedy)]) from None
    if (suffix := Path(path).suffix.lower()) not in {".yaml", ".yml", ".txt"}:
        from kin.read.formats import suffixes

        if suffix in suffixes():
            problem, remedy = "a file of a cam, and no recipe", "give the recipe first, and such files behind it"
            raise RecipeErrors([RecipeError(str(path), 0, 0, "", problem, None, remedy)])
    return data


def load_text(text: str, path: str | PathLike[str], unplaced: str = "") -> Recipe:
    """Read a recipe from a text. Raises RecipeErrors with all its faults.

    `path` names the recipe in errors and gives its default name, and files that the recipe names are in its folder.
    `unplaced` names in errors a text that stands in no file and so has no lines to refer to.
    """
    return read(text.encode("utf-8", "surrogatepass"), path, unplaced)


def _build(values: Values, document: Document, capabilities: tuple[str, ...]) -> Recipe:
    """Recipe of values without faults, which uses these capabilities."""
    milling, wheel = build_manufacture(values.get("manufacture", {}))
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
        linkage=linkage,
        dwell=DwellLimits(**values["dwell"]) if "dwell" in values else None,
        manufacture=milling,
        wheel=wheel,
        limits=build_limits(values.get("limits", [])),
        capabilities=tuple((name, KEYS[name].build(values)) for name in capabilities),
        **vars(document),
    )


READING = Reading(table=recipe_table, read=of_source, reader=reader_of)
