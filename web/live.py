"""What the page's worker asks of camgeo: each call takes plain data and gives plain data, which JSON carries."""

from __future__ import annotations

import json
import math
import re
import shutil
import tempfile
import traceback
from bisect import bisect_left
from collections import Counter
from contextlib import suppress
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
import yaml
from paper import TooManySheetsError, pdf
from segments import changed, drawn

import camgeo
from camgeo.api.report import explanation
from camgeo.api.root import root_by_key, root_of
from camgeo.capabilities.follow.followed import judged_by_recipe  # needs: follow
from camgeo.capabilities.follow.library import READING  # needs: follow
from camgeo.checks.declared import declaration
from camgeo.common.rounding import upward  # needs: follow
from camgeo.files.errors import MissingExtraError
from camgeo.output.pipeline import REPORT
from camgeo.recipe.export import FileRequest
from camgeo.recipe.keys import UNITS
from camgeo.recipe.recipe import root_key
from camgeo.recipe.starter import starter
from camgeo.registry.formats import FORMATS
from camgeo.registry.root import CAM, reading
from camgeo.report.page import tables
from camgeo.schema.change import set_value
from camgeo.schema.edit import number_text
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.fields import Kind, field_at
from camgeo.schema.quantity import read_quantity, split_unit, units_for
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, Source, comments, entries, join, keys, scalars
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from camgeo.api.report import Report
    from camgeo.api.shown import Shown
    from camgeo.recipe.export import Length
    from camgeo.recipe.recipe import Order
    from camgeo.schema.fields import Field, FieldTable, OwnForm
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node
    from kin.numeric.arrays import Array

FOLDER = tempfile.mkdtemp()  # for the recipe, its tables, a file to judge; in the browser's own file system
OUT = f"{FOLDER}/out"
PAGE = FileRequest("html")
ON_PAPER = 0.004  # mm: most distance of a printed contour from the exact one
ALIKE = 1e-6  # of its size: what a recipe in another unit may differ by
PLACES = 720  # of a motion at which it is compared
LENGTHS = ("roller", "shoe", "width", "offset", "pivot", "arm", "x", "y", "reading", "gap")  # of a follower
WRITTEN = {Kind.TEXT, Kind.NAME, Kind.FORMULA, Kind.RATIO}  # fields that hold a text
NUMBERS = {Kind.LENGTH, Kind.ANGLE, Kind.NUMBER, Kind.INTEGER, Kind.STROKE}  # whose boxes stay where they hold none
_LAST: list[Any] = []  # the recipe that was shown last, and its cam
_WORDS: dict[OwnForm[Any], list[str]] = {}  # of forms of their own, whose schemas are large


def say(stage: str) -> None:
    """Say at which stage a long call is; the worker puts what tells the page in its place."""


def answer(call: str, text: str) -> str:
    """Answer a call by its name; faults of a recipe and of a call are part of the answer."""
    try:
        output = CALLS[call](**json.loads(text))
    except RecipeErrors as errors:
        output = {"faults": [_fault(error) for error in errors.errors]}
    except camgeo.CamgeoError as error:
        output = {"faults": [_sentence(line) for line in str(error).splitlines()]}
    except ConnectionError as error:  # of a module that is fetched when it is imported
        output = {"faults": [_sentence(f"a part of this page could not be loaded: {error}; try again, or reload it")]}
    except MemoryError:
        output = {"faults": [_sentence("there is not enough memory for this: close other tabs, or make it smaller")]}
    except Exception:  # noqa: BLE001 - the page tells it, and goes on
        output = {"faults": [_sentence("camgeo has failed")], "trace": traceback.format_exc()}
    return json.dumps(output, separators=(",", ":"))


def _sentence(text: str) -> dict[str, Any]:
    told = in_words_of_the_page(text)
    return {"line": 0, "column": 0, "path": "", "text": told, "told": told}


ON_THE_PAGE = (
    ("`camgeo new` writes one to start from", "begin with another cam, above"),
    (r"\bS\(([^()]*)\)", r"the lift at \1"),
    (r"\bS[']{3}", "the jerk"),
    (r"\bS''", "the acceleration"),
    (r"\bS'", "the velocity"),
    (r"\bS\b", "the lift"),
    (r"give it by --units, such as --units (\w+)", r"choose the unit of the file, such as \1"),
    ("another is given by --units", "another can be chosen as the unit of the file"),
    (r"--gap (\S+) joins what lies so near", r"let ends of its lines meet within \1 mm"),
    (r"give gap (\S+) to join (?:them|its ends)", r"let ends of its lines meet within \1 mm"),
    ("give across arc or chord to close (?:it|the contour) there", "choose how the contour goes on where it is open"),
    ("leave across out", "let an open contour be refused"),
    ("a follower has a roller, of radius 0 .*", "say how large the touch is: its box is empty"),
    ("the drawing states no unit: give units", "the drawing states no unit: choose the unit of the file"),
    ("leave units out", "choose none given as the unit of the file"),
    ("give at, such as the middle", "give the place of the shaft in the file, such as the middle"),
    ("; give at$", "; give the place of the shaft in the file"),
    ("of a ring's opening give track internal, of a groove track groove", "let it run in the ring, or in the groove"),
    ("of a groove give track groove", "of a groove, let it run in a groove"),
    ("leave track out", "let it run outside"),
    ("leave width out", "leave the width empty"),
    ("leave it out", "leave it empty"),
    ("or leave yoke out", "or take the second contact away"),
    (r"give reading (\S+) or more", r"let a dwell rest within \1 mm or more"),
    ("give arm as pivot distance and length, 80,65", "give pivot and length"),
    ("give arm as the pivot's distance alone", "leave the length empty"),
)
"""Words of commands and of formulas, as patterns, and what the page says for them."""


def in_words_of_the_page(text: str) -> str:
    """A sentence for somebody who sees boxes: no option of a command, no symbol of a formula, no folder of Python's."""
    text = text.replace(f"{FOLDER}/", "")
    for pattern, words in ON_THE_PAGE:
        text = re.sub(pattern, words, text)
    return text


def _fault(error: RecipeError) -> dict[str, Any]:
    value = f", given {error.value}" if error.value is not None else ""
    remedy = f"; {error.remedy}" if error.remedy else ""
    place = f"{error.path}: " if error.path else ""
    told = in_words_of_the_page(f"{error.problem}{value}{remedy}")
    return {"line": error.line, "column": error.column, "path": error.path, "text": f"{place}{told}", "told": told}


# --- design -----------------------------------------------------------------------------------------------------------


def picture(name: str, text: str) -> dict[str, Any]:
    """What the page draws of a recipe before its cam is checked; empty for a linkage, which takes the checks."""
    return _shown(_recipe(name, text)).picture()


def design(name: str, text: str, *, figures: bool = False) -> dict[str, Any]:
    """Everything that the page draws of a recipe, its fields, and its faults, each with line and column.

    With `figures` those of the design too, which are compared with a kept one's.
    """
    output: dict[str, Any] = {"fields": [], "faults": []}
    try:
        source = Source.of(text, f"{FOLDER}/{name}.yaml")
        output["fields"] = fields(source)
        output["bare"] = bare(source)
        recipe = _recipe(name, source)
        shown = _shown(recipe)
        scene = shown.scene()
        output["motion"] = drawn(source, shown.motion())
        output["figures"] = _figures(shown) if figures else []
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
        "ok": not failed,
        "name": recipe.name,
        "verdict": _verdict(report),
        "checks": tables.checks({**report, "checks": held}),
        "failed": [_explained(check, report, recipe) for check in failed],
    }


def beside(name: str, text: str) -> dict[str, Any]:
    """What the page shows of a design that is kept beside others: its scene and its figures."""
    shown = _shown(_recipe(name, text))
    return {"scene": shown.scene(), "figures": _figures(shown)}


def _figures(cam: Shown) -> list[dict[str, Any]]:
    """Figures of a design by name, each with its value, None where it is not finite, as text, and with its unit."""
    rows = []
    for name, figure in cam.figures.items():
        there = figure.value is not None
        value = figure.value if figure.value is not None and math.isfinite(figure.value) else None
        text = f"{value:.5g}" if value is not None else "∞" if there else "–"
        rows.append({"name": name, "value": value, "text": text, "unit": figure.unit if there else ""})
    return rows


def _verdict(report: dict[str, Any]) -> str:
    """What the pill says: whether checks hold, and how many remarks there are besides."""
    count = len(report["remarks"])
    remarks = f", {count} remark{'s' if count > 1 else ''}" if count else ""
    holds = all(check["ok"] for check in report["checks"])
    return f"{'every check of the design holds' if holds else tables.failing_count(report['checks'])}{remarks}"


def _recipe(name: str, text: str | Source) -> Order:
    """The recipe of a cam, whose tables are in the folder; raises RecipeErrors, and for what is not shown here."""
    path = Path(FOLDER) / f"{name}.yaml"
    source = text if isinstance(text, Source) else Source.of(text, str(path))
    kind = reading(key := root_key(source))
    if root_by_key(key).shown is not None or not isinstance(source.root, Mapping):
        recipe: Order = kind.read(source, path)
        return recipe
    problem = f"this page makes no {kind.noun}, which the command `camgeo export {name}.yaml` does on a machine"
    remedy = f"keep the recipe beside the files that it names and give that command; here give {kind.instead}"
    # its name is a key of the top level, or the kind of the cam
    top, cam = keys(source.root), entries(source.root).get(CAM)
    mark, place = (top[key].mark, key) if key in top else (entries(cam)["kind"].mark, f"{CAM}.kind")
    raise RecipeErrors([RecipeError(str(path), *mark, place, problem, None, remedy)])


def _shown(recipe: Order) -> Shown:
    """The cam of a recipe as the page shows it: its picture, its checks and its files are of one design."""
    if _LAST and _LAST[0] == recipe:
        return _LAST[1]
    shown = root_of(recipe).shown
    assert shown is not None  # of a recipe that `_recipe` has let pass
    _LAST[:] = recipe, shown(recipe)
    return _LAST[1]


def _explained(check: dict[str, Any], report: dict[str, Any], recipe: Order) -> dict[str, Any]:
    """A check that fails in words, with the line of the recipe's field that it hangs on."""
    head, *rows = explanation(check, report, recipe).splitlines()
    parts = {name: text.strip() for name, _, text in (row.strip().partition(" ") for row in rows)}
    place = re.fullmatch(r".*?:(\d+):(\d+) (.*)", parts.get("recipe", ""))
    line, column, path = (int(place[1]), int(place[2]), place[3]) if place else (0, 0, "")
    text = "; ".join(filter(None, (parts.get("found"), parts.get("remedy"))))
    declared = declaration(check["name"])
    over = "relative" if "linkage" in report and declared is not None and declared.in_frame else "shaft"
    button = "" if check.get("at_deg", check.get("at")) is None else tables.place(check, over)
    return {"line": line, "column": column, "path": path, "head": head, "text": text, "place": button}


# --- form -------------------------------------------------------------------------------------------------------------


def fields(source: Source) -> list[dict[str, Any]]:
    """The fields of a recipe that a form edits, in the order of the text: each says where its value stands there.

    `start` and `end` are indices in units of UTF-16, as browsers count. A number has its unit and the ends of a slider.
    """
    if not isinstance(source.root, Mapping):
        return []
    reader = _read(source)
    nodes = list(scalars(source.root))
    shared = Counter(id(node) for _, node in nodes)
    known = [
        entry
        for path, node in nodes
        if shared[id(node)] == 1 and node.tag is None
        for entry in _entry(reader, path, node)
    ]
    known += _laws(reader)
    lists = list(_files(reader))
    whole = {entry["path"] for entry in lists}  # their words are ticked, and are no fields besides
    single = [entry for entry in known if entry["path"].partition("[")[0] not in whole]
    return sorted([*single, *lists], key=lambda entry: entry["start"])


def bare(source: Source) -> str:
    """The text of a recipe without its comments, and without the lines that hold nothing else."""
    marks = [first for first, _ in comments(source)]
    kept = list[str]()
    for start, end in pairwise([*source.starts, len(source.text)]):
        line, place = source.text[start:end], bisect_left(marks, start)
        if place == len(marks) or marks[place] >= end:
            kept.append(line)
        elif said := source.text[start : marks[place]].rstrip():
            kept.append(said + line[len(line.rstrip("\r\n")) :])
    return "".join(kept)


def _read(source: Source) -> Reader:
    """A reader that has read a recipe; that of a disc cam for a kind of recipe without fields on the page."""
    return (reading(root_key(source)).reader or reading(CAM).reader)(source)


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


def _laws(reader: Reader) -> Iterator[dict[str, Any]]:
    """The laws of segments that give none: the default, and what stands before a law where one is put in."""
    for path, node in _mappings(reader.source.root):
        given = entries(node)
        if "law" in given or {"rise", "return", "to"}.isdisjoint(given):
            continue
        field = field_at(reader.root, f"{path}.law", reader.kinds)
        if field is None or not field.default:
            continue
        key, value = node.entries[-1]
        place = _utf16(reader.source.text, reader.source.index(value.end))
        before = ", law: " if node.flow else f"\n{' ' * (key.mark[1] - 1)}law: "
        about = {"path": f"{path}.law", "about": field.about, "text": field.default, "start": place, "end": place}
        yield {**about, "kind": "choice", "choices": _words(field), "before": before}


def _mappings(node: Node, path: str = "") -> Iterator[tuple[str, Mapping]]:
    """Every mapping of a tree with its path."""
    if isinstance(node, Sequence):
        for i, item in enumerate(node.items):
            yield from _mappings(item, join(path, i))
    elif isinstance(node, Mapping):
        yield path, node
        for key, value in entries(node).items():
            yield from _mappings(value, join(path, key))


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
    """A field of a number: its value, None where it is none, unit and bounds; its place is without the unit."""
    number, unit = split_unit(node.text)
    value: float | None
    try:
        value = read_number(number)
    except Complaint:  # a word that stands in its place, such as rest, or a fault, whose box stays
        if field.kind not in NUMBERS:
            return
        number, unit, value = node.text, None, None
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
        "units": _sizes(own),
        "whole": field.kind is Kind.INTEGER,
        "odd": field.odd,
        "least": field.at_least if field.above is None else field.above,
        "most": field.at_most,
        "open": field.above is not None,
    }


@cache
def _sizes(own: str) -> dict[str, float]:
    """The units that a number may carry, each in the unit of its field."""
    return {own: 1.0} | {unit: read_quantity(f"1 {unit}", own) for unit in units_for(own)}


def _utf16(text: str, index: int) -> int:
    return len(text[:index].encode("utf-16-le")) // 2


def more(name: str, text: str) -> dict[str, Any]:
    """The fields that a recipe could have besides its own."""
    source = Source.of(text, name)
    if not isinstance(source.root, Mapping):
        return {"more": []}
    reader = _read(source)
    return {"more": list(_absent(reader, source.root, reading(root_key(source)).table()))}


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


def with_segments(name: str, text: str, change: str, index: int, at: float) -> dict[str, Any]:
    """The text of a recipe with its segments changed as `segments.CHANGES` tells, and the segment chosen then."""
    source = Source.of(text, f"{FOLDER}/{name}.yaml")
    new, chosen = changed(source, _shown(_recipe(name, source)).motion(), change, index, at)
    return {"text": new, "chosen": chosen}


def with_table(name: str, text: str, table: str) -> dict[str, Any]:
    """The text of a recipe whose motion is a table; of a cam without a motion that of a disc cam with a roller."""
    source = Source.of(text, name)
    cam = entries(source.root).get("cam") if isinstance(source.root, Mapping) else None
    if not isinstance(cam, Mapping) or "motion" not in entries(cam):
        source = Source.of(starter("disc-roller"), name)
    return {"text": set_value(source, "cam.motion", {"table": table})}


def converted(name: str, text: str, units: Length) -> dict[str, Any]:
    """The text of a recipe in another unit of length: the cam stays the same one.

    Values that carry their own unit stay, formulas are divided or multiplied as a whole.
    """
    before = _recipe(name, text)
    source = before.source()
    assert isinstance(source.root, Mapping)
    reader = _read(source)
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


def _alike(first: Order, second: Order) -> bool:
    """Whether two recipes make the same cam, to a millionth of its size: by its motion and its figures."""
    values, others = _measured(first), _measured(second)
    return len(values) == len(others) and bool(np.allclose(values, others, rtol=ALIKE, atol=ALIKE))


def _measured(recipe: Order) -> Array:
    """Figures of a cam that are lengths or angles, mm and degrees, and its motion's displacements, mm or rad."""
    cam = _shown(recipe)
    sizes = {"mm": 1.0, "in": UNITS["inch"], "deg": 1.0}
    figures = [f.value * sizes[f.unit] for f in cam.figures.values() if f.value is not None and f.unit in sizes]
    motion = cam.motion()
    lifts = [] if isinstance(motion, str) else motion.lift(np.linspace(0.0, motion.total, PLACES))
    return np.array([*figures, *lifts])


# --- files ------------------------------------------------------------------------------------------------------------


def make(name: str, text: str) -> dict[str, Any]:
    """Make and judge all files of a recipe: the page, the report, each file, and all of them as a zip."""
    recipe = _recipe(name, text)
    if PAGE.kind not in {request.kind for request in recipe.export.files}:
        recipe = replace(recipe, export=replace(recipe.export, files=(*recipe.export.files, PAGE)))
    shutil.rmtree(OUT, ignore_errors=True)
    report = camgeo.export(recipe, OUT, progress=lambda stage: say(stage))  # noqa: PLW0108 - it is replaced
    folder = report.path
    if folder is None:
        raise AssertionError(report)
    files = sorted(folder.iterdir(), key=lambda path: (path.name == REPORT, path.name))
    page = next(path for path in files if path.suffix == ".html")
    output = _judged(report, page.read_text("utf-8"))
    kept = files if report.ok else [path for path in files if path.suffix in {".html", ".json"}]
    return {**output, "files": [{"name": path.name, "path": str(path)} for path in kept]}


def zipped(name: str, text: str, files: list[str]) -> dict[str, Any]:
    """Files that lie in the folder, and the recipe, as a zip."""
    say("the files")
    bundle = Path(OUT) / f"{name}.zip"
    bundle.parent.mkdir(parents=True, exist_ok=True)
    with ZipFile(bundle, "w", ZIP_DEFLATED) as archive:
        for file in files:
            archive.writestr(ZipInfo(f"{name}/{file}"), (Path(FOLDER) / file).read_bytes(), ZIP_DEFLATED)
        archive.writestr(ZipInfo(f"{name}/{name}.yaml"), text, ZIP_DEFLATED)
    return {"files": [{"name": bundle.name, "path": str(bundle)}]}


def paper(name: str, text: str) -> dict[str, Any]:
    """The contours of each disc of a recipe's cam, with its openings, as a PDF at true size."""
    say("the contour")
    drawings = _shown(_recipe(name, text)).drawings(ON_PAPER)
    say("the sheets")
    path = Path(OUT) / f"{name}.pdf"
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        path.write_bytes(pdf(drawings))
    except TooManySheetsError as error:
        raise camgeo.CallError(f"{error}; take the DXF to somebody who plots on rolls") from None
    return {"files": [{"name": path.name, "path": str(path)}]}


def solid(name: str, text: str) -> dict[str, Any]:
    """The corners of the triangles of a recipe's solid, mm: nine numbers of single precision for each triangle."""
    say("the triangles")
    meshes = _shown(_recipe(name, text)).meshes(FileRequest("stl"))
    corners = [np.take(mesh.points, mesh.triangles, axis=0) for mesh in meshes]
    path = Path(OUT) / "triangles"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(np.concatenate(corners).astype("<f4").tobytes())
    return {"files": [{"name": path.name, "path": str(path)}]}


def absent(name: str, text: str) -> dict[str, Any]:
    """Formats that cannot be made here of a recipe's part, each with the package that is missing."""
    cam = _shown(_recipe(name, text))
    reasons: dict[str, str] = {}
    for kind in FORMATS:
        with suppress(camgeo.CamgeoError):  # what else stands in its way is said when it is asked for
            try:
                cam.foresee(FileRequest(kind))
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


def verify(name: str, text: str, file: str, units: str, gap: str = "") -> dict[str, Any]:
    """Judge somebody's file by the recipe: its page, and the report. `gap` is a length as for a follower's."""
    say("the recipe")
    recipe = _recipe(name, text)
    say("the file and the motion on it")
    within = _length("gap", gap) / recipe.mm if gap else None
    report = camgeo.verify(recipe, Path(FOLDER) / file, units=units or None, gap=within, page=True)
    path = Path(OUT) / "report.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(report.to_json(), "utf-8")
    return {**_judged(report, report.page or ""), "files": [{"name": f"{file}.report.json", "path": str(path)}]}


# needs: follow
def follow(file: str, follower: dict[str, Any]) -> dict[str, Any]:
    """The motion that somebody's file gives a follower: in words, its table, its recipe and the page of that.

    Lengths are texts, mm or with their unit; an empty one is none. A roller's is its diameter where `diameter` is true.
    Without a reading it is what the file allows.
    """
    mm = {name: _length(name, text) for name in LENGTHS if (text := follower.pop(name))}
    if follower.pop("diameter") and "roller" in mm:
        mm["roller"] *= 0.5
    say("the file and the motion on it")
    followed = camgeo.follow(
        Path(FOLDER) / file,
        roller=mm.get("roller"),
        shoe=mm.get("shoe"),
        width=mm.get("width"),
        offset=mm.get("offset", 0.0),
        arm=tuple(mm[name] for name in ("pivot", "arm") if name in mm) or None,
        at=(mm.get("x", 0.0), mm.get("y", 0.0)),
        reading=mm.get("reading", READING),
        units=follower.pop("units") or None,
        gap=mm.get("gap"),
        across=follower.pop("across") or None,
        **follower,
    )
    if "reading" not in mm:  # a motion no nearer than the facets of a polygon are
        followed = replace(followed, reading=float(upward(max(READING, followed.facets or 0.0), 2)))
    stem = re.sub(r"[^A-Za-z0-9_-]", "-", Path(file).stem)
    folder = Path(OUT)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{stem}-motion.csv").write_text(followed.table(), "utf-8")
    output: dict[str, Any] = {"verdict": followed.summary(), "page": "", "ok": True}
    output["files"] = [{"name": f"{stem}-motion.csv", "path": str(folder / f"{stem}-motion.csv")}]
    table = f"{stem}-lifts.csv"
    say("a recipe of this motion, and the file by it")
    try:
        recipe = followed.recipe(table)
    except camgeo.CallError as error:
        return {**output, "verdict": f"{output['verdict']}\nNo recipe is made of it: {error}"}
    (Path(FOLDER) / table).write_text(followed.lifts(), "utf-8")
    output |= {"name": stem, "recipe": recipe, "tables": {table: followed.lifts()}}
    if followed.unjudged:  # the curves of its motion then stand on the page of that recipe's own cam
        shown = _recipe(stem, recipe)
        made = camgeo.export(replace(shown, export=replace(shown.export, files=(PAGE,))), OUT).path
        told = f"The page is of the cam by the recipe of this motion. Not judged is the file: {_why(followed.unjudged)}"
        page = "" if made is None else next(made.glob("*.html")).read_text("utf-8")
        return {**output, "page": page, "verdict": f"{output['verdict']}\n{told}"}
    report = judged_by_recipe(followed)
    verdict = f"{output['verdict']}\nThe file by the recipe of this motion: {report}"
    return {**output, "page": report.page or "", "ok": report.ok, "verdict": verdict}


def _why(unjudged: str) -> str:
    """Why a file is not judged, without what a caller could leave out."""
    return unjudged.rpartition(": ")[0]


def _length(name: str, text: str) -> float:
    """A length as it stands in a box, mm."""
    try:
        return read_quantity(text, "mm")
    except Complaint as error:
        raise camgeo.CallError(f"{name}: {text} is no length ({error}); give a number such as 12.5 or 1/2 in") from None


CALLS: dict[str, Callable[..., dict[str, Any]]] = {
    "picture": picture,
    "design": design,
    "beside": beside,
    "more": more,
    "added": added,
    "with_segments": with_segments,
    "with_table": with_table,
    "converted": converted,
    "make": make,
    "zipped": zipped,
    "paper": paper,
    "solid": solid,
    "absent": absent,
    "verify": verify,
    "follow": follow,  # needs: follow
}
