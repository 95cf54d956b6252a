"""The files that a recipe asks for."""

from __future__ import annotations

import collections.abc
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from camgeo.recipe.extension import KEYS
from camgeo.recipe.machining import COMPENSATION, Compensation, alterations, build_compensation
from camgeo.registry.formats import FORMATS
from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST_FILES, Field, FieldTable, Kind, OwnForm, either, length, mapping
from camgeo.schema.yaml_source import Mapping, Scalar, describe, is_empty, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.extension import Alteration, Variant
    from camgeo.registry.formats import Form as FileForm
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


Length: TypeAlias = Literal["mm", "inch"]


@dataclass(frozen=True)
class FileRequest:
    """One file to write.

    kind          word of its format, such as dxf
    as_           word of its form, such as arcs; None for a format without forms
    tolerance     in place of the export's, mm; None for that
    compensation  for a part that differs from the nominal one; None for the nominal part
    variant       name of the capability whose option makes the file something else than the cam; empty for the cam
    units         unit that the recipe gives for the file; None for the usual unit (`unit_for`)
    options       further options of its format by name, lengths in mm and angles in rad
    """

    kind: str
    as_: str | None = None
    tolerance: float | None = None
    compensation: Compensation | None = None
    variant: str = ""
    units: Length | None = None
    options: tuple[tuple[str, Any], ...] = ()

    @property
    def own(self) -> dict[str, Any]:
        """Further options of its format, by name."""
        return dict(self.options)

    @property
    def format(self) -> Format:
        """Record of the format."""
        return FORMATS[self.kind]

    @property
    def form(self) -> FileForm:
        """Record of the form that the key `as` chooses, such as arcs or a spline, or of the format's only form."""
        return self.format.form(self.as_)

    @property
    def holds_other_bodies(self) -> bool:
        """Whether the file holds other bodies beside the cam."""
        return bool(self.variant) and not self.format.by_disc

    @property
    def word(self) -> str:
        """Format and form in words: `dxf as arcs`."""
        return self.kind if self.as_ is None else f"{self.kind} as {self.as_}"

    def unit_for(self, units: Length) -> Length:
        """Unit of the file in a recipe in `units`: the unit given for it, else mm for a solid, else the recipe's."""
        return self.units or ("mm" if self.format.solid else units)

    def filename(self, name: str, requests: collections.abc.Sequence[FileRequest]) -> str:
        """Name of the file among all `requests` of the recipe `name`; later requests do not change it.

        The first file of a format is `<name>.<kind>`, a further one `<name>-<as>.<kind>`. After a file of the same form
        it is `<name>-<as>-<option>.<kind>` by the options that its format names, such as `R12` of DXF, with the keys of
        a compensation, such as `-kerf`, and with `-inch` or `-mm` where the unit is given. A part altered by a
        capability always has the key. Of all bodies of a mechanism the first file is named: `<name>-cam.stl`,
        `<name>-parts.3mf` or `<name>-assembly.glb`. A file without any of these, after a compensated file or one with a
        unit under the plain name, is `<name>-nominal.<kind>`.
        """
        earlier = requests[: requests.index(self)] if self in requests else requests
        same_kind = [request for request in earlier if request.kind == self.kind]
        parts = [name, _variant(self.variant).tag(self.format)] if self.variant else [name]
        parts += [self.format.tail] if self.format.tail else []
        alike = [request for request in same_kind if request.as_ == self.as_]
        if same_kind and self.as_:
            parts.append(self.as_)
            parts += [str(self.own[option]) for option in self.format.named if alike and option in self.own]
        if self.compensation and (alike or self.compensation.altered):
            parts.append(self.compensation.tags)
        if alike and self.units and not self.variant:
            parts.append(self.units)
        # without anything of its own the file would have the plain name, which an earlier file that differs may bear
        rivals = (
            other for other in alike if len(parts) == 1 and not (other.compensation and other.compensation.altered)
        )
        if any(request.compensation or request.units for request in rivals):
            parts.append("nominal")
        return f"{'-'.join(parts)}.{self.own.get('suffix', self.format.ending)}"

    def filenames(self, name: str, requests: collections.abc.Sequence[FileRequest], discs: int = 1) -> tuple[str, ...]:
        """Names of the files of a cam with `discs` discs: one file for all, or one for each disc.

        `name` is the recipe's name, `requests` are all its requests, among which names must differ.
        """
        whole = self.filename(name, requests)
        if discs == 1 or not self.format.by_disc:
            return (whole,)
        return tuple(disc_filename(whole, k) for k in range(discs))


def disc_filename(filename: str, disc: int) -> str:
    """Name of the file of one disc, counted from 0: `<name>-1.dxf` is the first for the cam's `<name>.dxf`."""
    stem, dot, suffix = filename.rpartition(".")
    return f"{stem}-{disc + 1}{dot}{suffix}"


@dataclass(frozen=True)
class Export:
    """The requested files, and their `tolerance`, the greatest distance between a contour and the exact one, mm."""

    tolerance: float
    files: tuple[FileRequest, ...]

    @property
    def overlays(self) -> tuple[str, ...]:
        """Names of the overlays that pages show on the mechanism, each once."""
        names = (name for request in self.files for name in request.own.get("overlays", ()))
        return tuple(dict.fromkeys(names))


class Options(collections.abc.Mapping[str, FieldTable]):
    """Table of options by format: options of capabilities first, then the format's own."""

    def __init__(
        self, formats: collections.abc.Mapping[str, Format], more: collections.abc.Sequence[Variant | Alteration]
    ) -> None:
        self._formats = formats
        self._more = more

    def __getitem__(self, name: str) -> FieldTable:
        """Table of the options of the format `name`; raises KeyError for an unknown format."""
        record = self._formats[name]
        own = [field for extension in self._more if extension.offered(record) for field in extension.options]
        return FieldTable((*own, *record.options.fields))

    def __contains__(self, name: object) -> bool:
        """Whether a format is known; no table is made."""
        return name in self._formats

    def __iter__(self) -> collections.abc.Iterator[str]:
        """Names of the formats; no table is made."""
        return iter(self._formats)

    def __len__(self) -> int:
        """Number of formats."""
        return len(self._formats)


def read_files(options: Options, reader: Reader, field: Field, node: Node, path: str) -> list[Values]:
    """Read the list of files: values of each with its format `kind` and its `path` in the recipe.

    A faulty file is noted and left out.
    """
    files = []
    for i, item in enumerate(reader.items(field, node, path, MOST_FILES)):
        below = join(path, i)
        kind, options_node = _format(item)
        if kind is None:
            remedy = "give a format, or a mapping with one format such as {dxf: {as: spline}}"
            reader.fault(item.mark, below, "not a file", describe(item), remedy)
            continue
        if kind.text not in options and reader.others.have(kind.text):
            reader.fault(kind.mark, below, *reader.others.refusal(kind.text))
        elif kind.text not in options:
            reader.fault(kind.mark, below, "unknown file format", quote(kind.text), f"give {either(tuple(options))}")
        elif options_node is None:
            files.append({"kind": kind.text, "path": below})
        else:
            table = Field("", Kind.TABLE, "", table=options[kind.text])
            values = reader.field(table, options_node, join(below, kind.text))
            if values is not None:
                files.append({"kind": kind.text, "path": below, **values})
    return files


def _format(node: Node) -> tuple[Scalar | None, Node | None]:
    """Format and options of an entry of the list of files: `dxf`, without options, or `{dxf: {...}}`.

    The format is None for an entry that is neither.
    """
    if isinstance(node, Scalar):
        return (None if is_empty(node) else node), None
    if isinstance(node, Mapping) and len(node.entries) == 1:
        key, options = node.entries[0]
        return (key if isinstance(key, Scalar) else None), options
    return None, None


def _files_schema(options: Options, _: Field) -> Schema:
    from camgeo.schema.json_schema import table_schema

    fields = [Field(kind, Kind.TABLE, "", required=True, table=table) for kind, table in options.items()]
    items = {"anyOf": [{"enum": list(options)}, *(table_schema(FieldTable((item,))) for item in fields)]}
    return {"type": "array", "items": items, "minItems": 1, "maxItems": MOST_FILES}


def export_of(
    formats: collections.abc.Mapping[str, Format],
    example: str = "{dxf: {as: spline}}",
    default: str = "[dxf]",
    *,
    more: collections.abc.Sequence[Variant | Alteration] = (),
) -> Field:
    """Key `export` of recipes whose files are in these formats, with an `example` and a `default` list for texts.

    `more` adds options of capabilities to the options of formats.
    """
    options = Options(formats, more)
    form = OwnForm(
        "a list of files",
        "a list of files such as [dxf, stl]" if "dxf" in formats else f"a list of files such as {default}",
        partial(read_files, options),
        partial(_files_schema, options),
        tables=options,
        group="the file",
    )
    return mapping(
        "export",
        "the files",
        length("tolerance", "greatest distance between a file's contour and the exact one", default="0.001 mm"),
        Field(
            "files",
            Kind.OWN,
            f"{', '.join(formats)}, or mappings such as {example}",
            default=default,
            form=form,
        ),
    )


EXPORT = export_of(FORMATS)


def _variant(capability: str) -> Variant:
    """Option by which a capability makes files; raises KeyError for a capability without one."""
    variant = KEYS[capability].variant
    if variant is None:
        raise KeyError(capability)
    return variant


def _variants() -> dict[str, Variant]:
    """Variants by their capability, of the loaded capabilities; a recipe that uses another would have loaded it."""
    return {name: option for name in KEYS.loaded() if (option := KEYS[name].variant) is not None}


def check_files(values: Values, reader: Reader, formats: collections.abc.Mapping[str, Format] = FORMATS) -> None:
    """Note requested files that lack a field of the recipe, that their format refuses, or that share a name.

    `formats` are those that the recipe's kind takes.
    """
    files: list[Values] = values.get("export", {}).get("files", [])
    listed = requests(files, formats)
    names = [request.filename("NAME", listed) for request in listed]
    for i, (file, request) in enumerate(zip(files, listed, strict=True)):
        path, record = file["path"], formats[request.kind]
        if record.solid and "part.thickness" not in reader.marks:
            remedy = f"give part.thickness, or leave {request.kind} out"
            reader.fault_at(path, f"{request.kind} needs a thickness", None, remedy)
        if request.variant:
            _variant(request.variant).check(file, values, reader)
        for altered in request.compensation.altered if request.compensation else ():
            alterations()[altered.capability].check(file, values, reader)
        for alteration in alterations().values():
            beside = alteration.beside
            if beside is not None and beside.name in file and alteration.chosen(file) is None:
                remedy = f"give {alteration.option.name}, or leave it out"
                place = f"{path}.{file['kind']}.{beside.name}"
                reader.fault_at(place, f"goes with {alteration.option.name}, and there is none", None, remedy)
        record.check(file, values, reader)
        record.form(request.as_).check(file, values, reader)
        if request in listed[:i]:
            reader.fault_at(path, "the same file twice", None, "leave one out")
        elif names[i] in names[:i]:
            name = names[i].removeprefix("NAME")
            remedy = "give each another `as` or `version`, or a recipe of its own"
            reader.fault_at(path, "a second file of one name", f"<name>{name}", remedy)


TOLERANCE = 0.001  # mm
SHARED = frozenset({"as", "tolerance", "units", *(item.name for item in COMPENSATION)})
"""Options of files that are fields of a request."""


def requests(files: list[Values], formats: collections.abc.Mapping[str, Format] = FORMATS) -> tuple[FileRequest, ...]:
    """Build the requests of files in these formats from values of a recipe without faults."""
    return tuple(_request(file["kind"], formats[file["kind"]], file) for file in files)


def _request(kind: str, record: Format, file: Values) -> FileRequest:
    values = {**record.chosen, **file}
    return FileRequest(
        kind,
        values.get("as"),
        values.get("tolerance"),
        build_compensation(file),
        next((name for name, record_of_variant in _variants().items() if record_of_variant.chosen(file)), ""),
        values.get("units"),
        tuple((name, values[name]) for name in record.options.keys if name in values and name not in SHARED),
    )


def build_export(
    values: Values, formats: collections.abc.Mapping[str, Format] = FORMATS, default: str = "dxf"
) -> Export:
    """Build the export from the values of `export`, in a recipe without faults; one file where none is given.

    That is of the format `default`. The tolerance is `TOLERANCE` unless given; `formats` are those of the kind.
    """
    files = requests(values.get("files", [{"kind": default}]), formats)
    return Export(values.get("tolerance", TOLERANCE), files)
