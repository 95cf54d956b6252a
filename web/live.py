"""What the page's worker asks of camgeo: each call takes plain data and gives plain data, which JSON carries."""

from __future__ import annotations

import json
import re
import shutil
import tempfile
import traceback
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
import yaml

import camgeo
from camgeo.api.report import explanation
from camgeo.capabilities.follow.command import summary  # needs: follow
from camgeo.capabilities.follow.library import judged_by_recipe  # needs: follow
from camgeo.checks.declared import declaration
from camgeo.files.errors import MissingExtraError
from camgeo.output.dispatch import foresee
from camgeo.output.job import Job
from camgeo.output.pipeline import REPORT
from camgeo.recipe.export import FileRequest
from camgeo.recipe.keys import UNITS, read_values, recipe_table
from camgeo.recipe.recipe import of_source, root_key
from camgeo.recipe.words import words_of
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS
from camgeo.registry.root import CAM, root
from camgeo.report.page import page as pages
from camgeo.report.page import tables
from camgeo.report.page.content import mechanism
from camgeo.schema.change import set_value
from camgeo.schema.edit import number_text
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.fields import Kind, field_at
from camgeo.schema.quantity import read_quantity, split_unit, units_for
from camgeo.schema.reader import Reader
from camgeo.schema.readers import READERS
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, Source, entries, join, keys, scalars
from camgeo.synthesis.design import sketched
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from camgeo.api.design import Design
    from camgeo.api.report import Report
    from camgeo.recipe.export import Length
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.fields import Field, FieldTable, OwnForm
    from kin.numeric.arrays import Array

FOLDER = tempfile.mkdtemp()  # for the recipe, its tables, a file to judge; in the browser's own file system
OUT = f"{FOLDER}/out"
PAGE = FileRequest("html")
ALIKE = 1e-6  # of its size: what a recipe in another unit may differ by
LENGTHS = ("roller", "shoe", "width", "offset", "pivot", "arm", "x", "y", "reading")  # of a follower
WRITTEN = {Kind.TEXT, Kind.NAME, Kind.FORMULA, Kind.RATIO}  # fields that hold a text
_WORDS: dict[OwnForm[Any], list[str]] = {}  # of forms of their own, whose schemas are large


def answer(call: str, text: str) -> str:
    """Answer a call by its name; faults of a recipe and of a call are part of the answer."""
    try:
        output = CALLS[call](**json.loads(text))
    except RecipeErrors as errors:
        output = {"faults": [_fault(error) for error in errors.errors]}
    except camgeo.CamgeoError as error:
        output = {"faults": [_sentence(line) for line in str(error).splitlines()]}
    except MemoryError:
        output = {"faults": [_sentence("there is not enough memory for this: close other tabs, or make it smaller")]}
    except Exception:  # noqa: BLE001 - the page tells it, and goes on
        output = {"faults": [_sentence("camgeo has failed")], "trace": traceback.format_exc()}
    return json.dumps(output, separators=(",", ":"))


def _sentence(text: str) -> dict[str, Any]:
    return {"line": 0, "column": 0, "path": "", "text": text.replace(f"{FOLDER}/", "")}


def _fault(error: RecipeError) -> dict[str, Any]:
    value = f", given {error.value}" if error.value is not None else ""
    remedy = f"; {error.remedy}" if error.remedy else ""
    place = f"{error.path}: " if error.path else ""
    text = f"{place}{error.problem}{value}{remedy}".replace(f"{FOLDER}/", "")
    return {"line": error.line, "column": error.column, "path": error.path, "text": text}


# --- design -----------------------------------------------------------------------------------------------------------


def picture(name: str, text: str) -> dict[str, Any]:
    """What the page draws of a recipe before its cam is checked; empty for a linkage, which takes the checks."""
    recipe = _recipe(name, text)
    if recipe.linkage is not None:
        return {}
    drawn, _, relative = mechanism(recipe, sketched(recipe))
    return pages.picture(recipe, drawn, relative)


def design(name: str, text: str) -> dict[str, Any]:
    """Everything that the page draws of a recipe, its fields, and its faults, each with line and column."""
    output: dict[str, Any] = {"fields": [], "faults": []}
    try:
        source = Source.of(text, f"{FOLDER}/{name}.yaml")
        output["fields"] = fields(source)
        recipe = _recipe(name, source)
        exact = camgeo.design(recipe)
        scene = dict(exact.scene())
    except RecipeErrors as errors:
        return {**output, "faults": [_fault(error) for error in errors.errors]}
    except camgeo.CamgeoError as error:
        return {**output, "faults": [_sentence(line) for line in str(error).splitlines()]}
    report: dict[str, Any] = {"checks": scene["checks"], "remarks": scene["remarks"], "units": recipe.units}
    if scene["linked"]:
        report["linkage"] = True
    failed = [check for check in report["checks"] if not check["ok"]]
    held = [check for check in report["checks"] if check["ok"]]
    return {
        **output,
        "units": recipe.units,
        "scene": scene,
        "ok": exact.ok,
        "name": recipe.name,
        "verdict": "every check of the design holds" if exact.ok else tables.failing_count(report["checks"]),
        "checks": tables.checks({**report, "checks": held}),
        "failed": [_explained(check, report, recipe) for check in failed],
    }


def _recipe(name: str, text: str | Source) -> Recipe:
    """The recipe of one cam, whose tables are in the folder; raises RecipeErrors, for several cams too."""
    path = Path(FOLDER) / f"{name}.yaml"
    source = text if isinstance(text, Source) else Source.of(text, str(path))
    if (key := root_key(source)) != CAM and isinstance(source.root, Mapping):
        problem = f"this page makes no {key}, which the command `camgeo export {name}.yaml` does on a machine"
        remedy = f"keep the recipe beside the files that it names and give that command; here give {root(key).instead}"
        raise RecipeErrors([RecipeError(str(path), *keys(source.root)[key].mark, key, problem, None, remedy)])
    return of_source(source, path)


def _explained(check: dict[str, Any], report: dict[str, Any], recipe: Recipe) -> dict[str, Any]:
    """A check that fails in words, with the line of the recipe's field that it hangs on."""
    head, *rows = explanation(check, report, recipe).splitlines()
    parts = {name: text.strip() for name, _, text in (row.strip().partition(" ") for row in rows)}
    place = re.fullmatch(r".*?:(\d+):(\d+) (.*)", parts.get("recipe", ""))
    line, column, path = (int(place[1]), int(place[2]), place[3]) if place else (0, 0, "")
    text = "; ".join(filter(None, (parts.get("found"), parts.get("remedy"))))
    declared = declaration(check["name"])
    over = "relative" if "linkage" in report and declared is not None and declared.in_frame else "shaft"
    button = "" if check["at_deg"] is None else tables.place_button(check["at_deg"], over)
    return {"line": line, "column": column, "path": path, "head": head, "text": text, "place": button}


# --- form -------------------------------------------------------------------------------------------------------------


def fields(source: Source) -> list[dict[str, Any]]:
    """The fields of a recipe that a form edits, in the order of the text: each says where its value stands there.

    `start` and `end` are indices in units of UTF-16, as browsers count. A number has its unit and the ends of a slider.
    """
    if not isinstance(source.root, Mapping):
        return []
    reader = _read(source, source.root)
    nodes = list(scalars(source.root))
    shared = Counter(id(node) for _, node in nodes)
    entries = [
        entry
        for path, node in nodes
        if shared[id(node)] == 1 and node.tag is None
        for entry in _entry(reader, path, node)
    ]
    lists = list(_files(reader))
    whole = {entry["path"] for entry in lists}  # their words are ticked, and are no fields besides
    single = [entry for entry in entries if entry["path"].partition("[")[0] not in whole]
    return sorted([*single, *lists], key=lambda entry: entry["start"])


def _read(source: Source, root: Mapping) -> Reader:
    """A reader that has read a recipe, with all of its faults."""
    capabilities = registry.by_words(words_of(root))
    reader = Reader(source, READERS, recipe_table(capabilities))
    read_values(reader, capabilities)
    return reader


def _files(reader: Reader) -> Iterator[dict[str, Any]]:
    """The list of files, where it is one of plain words in brackets."""
    export = entries(reader.source.root).get("export")
    node = entries(export).get("files") if isinstance(export, Mapping) else None
    field = field_at(reader.root, "export.files", reader.kinds)
    if field is None or field.form is None or not isinstance(node, Sequence):
        return
    source = reader.source
    start, end = source.index(node.mark), source.index(node.end)
    raw = source.text[start:end]
    if re.fullmatch(r"\[[\w ,]*\]", raw) is None:
        return
    place = {"start": _utf16(source.text, start), "end": _utf16(source.text, end)}
    choices = _words(field)
    words = [item.text for item in node.items if isinstance(item, Scalar)]
    about = {"path": "export.files", "about": field.about, "text": raw, "kind": "list"}
    yield {**about, **place, "choices": choices, "words": words}


def _words(field: Field) -> list[str]:
    """The words that a form of its own permits, beside whatever else it does, for the field itself or its entries."""
    if field.form is None:
        return []
    if field.form in _WORDS:
        return _WORDS[field.form]
    schema = field.form.schema(field)
    schema = schema.get("items", schema)
    options = schema.get("anyOf") or schema.get("oneOf") or [schema]
    _WORDS[field.form] = [word for option in options for word in option.get("enum", ()) if isinstance(word, str)]
    return _WORDS[field.form]


def _entry(reader: Reader, path: str, node: Scalar) -> Iterator[dict[str, Any]]:
    """The field at a path, where a form knows its kind."""
    field = reader.numbers.get(path) or field_at(reader.root, path, reader.kinds)
    if field is None:
        return
    source = reader.source
    start, end = source.index(node.mark), source.index(node.end)
    raw = source.text[start:end]
    if "\n" in raw:
        return
    place = {"start": _utf16(source.text, start), "end": _utf16(source.text, end)}
    shown = {"path": path, "about": field.about, "text": node.text, **place}
    choices = list(field.choices) or _words(field)
    if node.text in choices:
        yield {**shown, "kind": "choice", "choices": choices}
    elif field.kind is Kind.TRUTH:
        yield {**shown, "kind": "choice", "choices": ["true", "false"]}
    elif field.kind in WRITTEN:
        yield {**shown, "kind": "text"}
    else:
        yield from _number(reader, field, node, shown)


def _number(reader: Reader, field: Field, node: Scalar, shown: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """A field of a number: its value, unit and bounds; the place is that of the number without the unit."""
    number, unit = split_unit(node.text)
    try:
        value = read_number(number)
    except Complaint:
        return
    if not node.plain:
        shown = {**shown, "start": shown["start"] + 1}
    own = reader.unit(field.unit or field.kind)
    yield {
        **shown,
        "kind": "number",
        "text": number,
        "end": shown["start"] + len(number),
        "value": value,
        "unit": unit or own,
        "units": list(units_for(own)),
        "whole": field.kind is Kind.INTEGER,
        "odd": field.odd,
        "least": field.at_least if field.above is None else field.above,
        "most": field.at_most,
        "open": field.above is not None,
    }


def _utf16(text: str, index: int) -> int:
    return len(text[:index].encode("utf-16-le")) // 2


def more(name: str, text: str) -> dict[str, Any]:
    """The fields that a recipe could have besides its own."""
    source = Source.of(text, name)
    if not isinstance(source.root, Mapping):
        return {"more": []}
    table = recipe_table()
    reader = Reader(source, READERS, table)
    read_values(reader, registry.names_with_record())
    return {"more": list(_absent(reader, source.root, table))}


def _absent(reader: Reader, node: Mapping, table: FieldTable, path: str = "") -> Iterator[dict[str, Any]]:
    """The fields that the mappings of a recipe could have besides, with what each is and what it is by default."""
    present = entries(node)
    chosen = [set(names) for name, names in table.alternatives if name in present]
    rivals = {name for name, names in table.alternatives for name in (name, *names)}
    for field in table.fields:
        below = join(path, field.name)
        held = present.get(field.name)
        if held is None and (field.name not in rivals or any(field.name in names for names in chosen)):
            yield {"path": below, "about": field.about, "default": field.default, "wanted": reader.wanted(field)}
        elif isinstance(held, Mapping):
            tables = field.form.tables if field.form else None
            kind = entries(held).get("kind")
            inner = tables.get(kind.text) if tables and isinstance(kind, Scalar) else field.table
            if inner is not None:
                yield from _absent(reader, held, inner, below)


def added(name: str, text: str, path: str, value: str) -> dict[str, Any]:
    """The text of a recipe with one more field, whose value is written as YAML."""
    try:
        plain = yaml.safe_load(value)
    except yaml.YAMLError:
        return {"faults": [_sentence(f"{path}: {value} is no value of YAML: check quotes and brackets")]}
    return {"text": set_value(Source.of(text, name), path, plain)}


def converted(name: str, text: str, units: Length) -> dict[str, Any]:
    """The text of a recipe in another unit of length: the cam stays the same one.

    Values that carry their own unit stay, formulas are divided or multiplied as a whole.
    """
    before = _recipe(name, text)
    source = before.source()
    assert isinstance(source.root, Mapping)
    reader = _read(source, source.root)
    factor = before.mm / UNITS[units]
    powers = {before.units: 1, f"square {before.units}": 2}
    new = text
    for path, node in sorted(scalars(source.root), key=lambda pair: pair[1].mark, reverse=True):
        field = reader.numbers.get(path) or field_at(reader.root, path, reader.kinds)
        if field is None or (field.kind is not Kind.FORMULA and path not in reader.numbers):
            continue
        kind = Kind.LENGTH if field.kind is Kind.FORMULA and field.unit is None else field.unit or field.kind
        power = powers.get(reader.unit(kind), 0)
        if not power or split_unit(node.text)[1]:
            continue
        start, end = source.index(node.mark), source.index(node.end)
        if field.kind is Kind.FORMULA:
            scale = f"{max(factor, 1.0 / factor) ** power:.9g}"
            number = f"({node.text}){'*' if factor > 1.0 else '/'}{scale}"
        else:
            number = _brief(read_number(node.text) * factor**power)
        new = new[:start] + new[start:end].replace(node.text, number) + new[end:]
    new = set_value(Source.of(new, name), "units", units)
    try:
        same = _alike(before, _recipe(name, new))
    except camgeo.CamgeoError:
        same = False
    if same:
        return {"text": new}
    return {"faults": [_sentence("not all of these numbers can be converted: give lengths their unit, such as 12 mm")]}


def _brief(value: float) -> str:
    """A number with as few digits as keep it within 2e-8 of its size, so that 36 mm are 36 mm again."""
    shorter = (float(f"{value:.{digits}g}") for digits in range(1, 10))
    return number_text(next(number for number in (*shorter, value) if abs(number - value) <= 2e-8 * abs(value)))


def _alike(first: Recipe, second: Recipe) -> bool:
    """Whether two recipes make the same cam, to a millionth of its size."""
    cam, other = camgeo.design(first), camgeo.design(second)
    pairs = list(zip(_points(cam), _points(other), strict=True))
    turn = np.linspace(0.0, 2.0 * np.pi, 720)
    pairs.append((cam.motion(turn), other.motion(turn)))
    return all(bool(np.allclose(a, b, rtol=ALIKE, atol=ALIKE * float(np.abs(a).max() + 1.0))) for a, b in pairs)


def _points(cam: Design) -> list[Array]:
    """Points of each contour of a cam, mm."""
    runs = [(curve, np.linspace(run.low, run.high, 90)) for _, curve in cam.exact.contours for run in curve.runs]
    return [curve.sample(along).point for curve, along in runs]


# --- files ------------------------------------------------------------------------------------------------------------


def make(name: str, text: str) -> dict[str, Any]:
    """Make and judge all files of a recipe: the page, the report, each file, and all of them as a zip."""
    recipe = _recipe(name, text)
    if PAGE.kind not in {request.kind for request in recipe.export.files}:
        recipe = replace(recipe, export=replace(recipe.export, files=(*recipe.export.files, PAGE)))
    shutil.rmtree(OUT, ignore_errors=True)
    report = camgeo.export(recipe, OUT)
    folder = report.path
    if folder is None:
        raise AssertionError(report)
    files = sorted(folder.iterdir(), key=lambda path: (path.name == REPORT, path.name))
    page = next(path for path in files if path.suffix == ".html")
    output = _judged(report, page.read_text("utf-8"))
    kept = files if report.ok else [path for path in files if path.suffix in {".html", ".json"}]
    bundle = Path(OUT) / f"{recipe.name}.zip"
    with ZipFile(bundle, "w", ZIP_DEFLATED) as archive:
        for path in kept:
            archive.writestr(ZipInfo(f"{recipe.name}/{path.name}"), path.read_bytes(), ZIP_DEFLATED)
        archive.writestr(ZipInfo(f"{recipe.name}/{name}.yaml"), text, ZIP_DEFLATED)
    return {**output, "files": [{"name": path.name, "path": str(path)} for path in (*kept, bundle)]}


def absent(name: str, text: str) -> dict[str, Any]:
    """Formats that cannot be made here of a recipe's part, each with the package that is missing."""
    design = camgeo.design(_recipe(name, text))
    reasons: dict[str, str] = {}
    if not design.exact.contours:
        return {"absent": reasons}
    job = Job.of(design.recipe, design.exact)
    for kind in FORMATS:
        with suppress(camgeo.CamgeoError):  # what else stands in its way is said when it is asked for
            try:
                foresee(job, FileRequest(kind))
            except MissingExtraError as error:
                reasons[kind] = str(error)
    return {"absent": reasons}


def _judged(report: Report, page: str) -> dict[str, Any]:
    """What the page shows of a report."""
    failed = [check for check in report["checks"] if not check["ok"]]
    return {
        "ok": report.ok,
        "verdict": str(report),
        "page": page,
        "missing": [{"what": name, "why": why} for name, why in report.missing.items()],
        "failed": len(failed),
    }


# --- files of others --------------------------------------------------------------------------------------------------


def verify(name: str, text: str, file: str, units: str) -> dict[str, Any]:
    """Judge somebody's file by the recipe: its page, and the report."""
    recipe = _recipe(name, text)
    report = camgeo.verify(recipe, Path(FOLDER) / file, units=units or None, page=True)
    path = Path(OUT) / "report.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(report.to_json(), "utf-8")
    return {**_judged(report, report.page or ""), "files": [{"name": f"{file}.report.json", "path": str(path)}]}


# needs: follow
def follow(file: str, follower: dict[str, Any]) -> dict[str, Any]:
    """The motion that somebody's file gives a follower: in words, its table, its recipe and the page of that.

    Lengths are texts, mm or with their unit; an empty one is none.
    """
    mm = {name: _length(name, text) for name in LENGTHS if (text := follower.pop(name))}
    followed = camgeo.follow(
        Path(FOLDER) / file,
        roller=mm.get("roller"),
        shoe=mm.get("shoe"),
        width=mm.get("width"),
        offset=mm.get("offset", 0.0),
        arm=tuple(mm[name] for name in ("pivot", "arm") if name in mm) or None,
        at=(mm.get("x", 0.0), mm.get("y", 0.0)),
        reading=mm.get("reading", 0.01),
        units=follower.pop("units") or None,
        **follower,
    )
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", Path(file).stem)
    folder = Path(OUT)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{stem}-motion.csv").write_text(followed.table(), "utf-8")
    output: dict[str, Any] = {"verdict": summary(followed), "page": "", "ok": True}
    output["files"] = [{"name": f"{stem}-motion.csv", "path": str(folder / f"{stem}-motion.csv")}]
    table = f"{stem}-lifts.csv"
    try:
        recipe = followed.recipe(table)
    except camgeo.CallError as error:
        return {**output, "verdict": f"{output['verdict']}\nNo recipe is made of it: {error}"}
    (Path(FOLDER) / table).write_text(followed.lifts(), "utf-8")
    output |= {"name": stem, "recipe": recipe, "tables": {table: followed.lifts()}}
    if followed.at == (0.0, 0.0):
        report = judged_by_recipe(followed)
        verdict = f"{output['verdict']}\nThe file by the recipe of this motion: {report}"
        output |= {"page": report.page or "", "ok": report.ok, "verdict": verdict}
    return output


# needs: follow
def _length(name: str, text: str) -> float:
    """A length as it stands in a box, mm."""
    try:
        return read_quantity(text, "mm")
    except Complaint as error:
        raise camgeo.CallError(f"{name}: {text} is no length ({error}); give a number such as 12.5 or 1/2 in") from None


CALLS: dict[str, Callable[..., dict[str, Any]]] = {
    "picture": picture,
    "design": design,
    "more": more,
    "added": added,
    "converted": converted,
    "make": make,
    "absent": absent,
    "verify": verify,
    "follow": follow,  # needs: follow
}
