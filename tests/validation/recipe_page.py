"""Contents and tables of docs/recipe.md, and of the pages of capabilities, from the schema.

`python tests/validation/recipe_page.py` writes them anew.
"""

from __future__ import annotations

import re
from pathlib import Path
from runpy import run_path

from camgeo.cams.disc import FOLLOWERS
from camgeo.formats.csv import FORMS
from camgeo.formats.csv import MODULES as TABLES
from camgeo.recipe.cam import CAMS
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.limits import bounds
from camgeo.recipe.linkage import DYADS, LINKAGES
from camgeo.registry import registry
from camgeo.registry.capability import Capability
from camgeo.registry.formats import FORMATS, MODULES
from camgeo.schema.fields import FieldTable, Kind, either

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "recipe.md"
HEAD = "| key | takes | unit | default | meaning |\n| --- | --- | --- | --- | --- |"
UNITS = {
    Kind.LENGTH: "length",
    Kind.POINT: "length",
    Kind.PAIR: "length",
    Kind.FORMULA: "length",
    Kind.AREA: "length²",
    Kind.ANGLE: "deg",
    Kind.ERROR: "length; deg",
    Kind.OUTPUT: "deg; length",
    Kind.STROKE: "length; deg",
    Kind.MOTION: "deg; length",
    Kind.BACKLASH: "length; deg",
    Kind.FORCE: "N",
    Kind.MOMENT: "N m",
    Kind.RATE: "N/m",
    Kind.MASS: "kg",
    Kind.THRUST: "N; N m",
    Kind.GIVING: "N/m; N m/rad",
    Kind.INERTIA: "kg; kg m²",
}


def row(field, optional_together):
    unit = UNITS.get(field.unit or field.kind, "")
    if field.required:
        default = "required"
    elif field.name in optional_together:
        default = "one of these"
    else:
        default = field.default or ""
    # figures and formats that capabilities add have pages of their own
    wanted = "a figure" if field.choices and set(field.choices) <= set(FIGURES) else field.wanted()
    if set(field.choices) == set(FORMS):  # tables that capabilities add have pages of their own
        wanted = either(tuple(name for name in FORMS if name in TABLES))
    about = field.about
    for name in registry.formats():
        about = about.replace(f", {name}", "")
    return f"| `{field.name}` | {wanted} | {unit} | {default} | {about} |".replace("  ", " ")


def table(found):
    together = [name for name, _ in found.alternatives]
    return "\n".join([HEAD, *(row(field, together) for field in found.fields)])


def below(found, path):
    """Path and table of each mapping within a table, the deeper after the shallower."""
    for field in found.fields:
        if field.table is not None:
            name = f"{path}.{field.name}" if path else field.name
            yield name, field.table
            yield from below(field.table, name)
        if field.form is not None and field.form.instead is not None:
            yield f"{path}.{field.name} as a mapping", field.form.instead
            yield from below(field.form.instead, f"{path}.{field.name}")


def is_motion(field):
    return field.table is not None and field.form is not None and field.form.instead is not None


def motions(found):
    """Each motion that a kind of cam takes, by its name in the schema's tables."""
    return {f"{name}.{field.name}": field for name, one in found.items() for field in one.fields if is_motion(field)}


def spans(of_cams):
    """What each motion is of: the unit of its strokes, and the greatest angle of a segment."""
    lines = ["| cam | motion | stroke | segment up to |", "| --- | --- | --- | --- |"]
    for name, motion in of_cams.items():
        kind, _, key = name.removeprefix("cam ").partition(".")
        rise, over = motion.inner.field("rise"), motion.inner.field("over")
        lines.append(f"| `{kind}` | `{key}` | {UNITS[rise.unit or rise.kind]} | {over.at_most:g} deg |")
    return "\n".join(lines)


def contents(text):
    """The sections of a page as links."""
    titles = [title for title in re.findall(r"^## (.*)$", text, re.MULTILINE) if title != "Contents"]
    places = [re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in titles]
    return "\n".join(f"- [{title}](#{place})" for title, place in zip(titles, places, strict=True))


def figures(entries):
    lines = ["| figure | unit | best | needs | sweep | meaning |", "| --- | --- | --- | --- | --- | --- |"]
    for name, figure in entries.items():
        needs, swept = figure.needs.words, "yes" if figure.swept else ""
        row = f"| `{name}` | {UNITS.get(figure.kind, '')} | {figure.best} | {needs} | {swept} | {figure.about} |"
        lines.append(row.replace("  ", " ").replace("  ", " "))
    return "\n".join(lines)


def tables():
    """Every table of the core's schema, written out, by the name that marks its place in the page."""
    recipe = recipe_table(())
    found = {"recipe": recipe, **dict(below(recipe, ""))}
    found["limits"] = bounds(next(iter(FIGURES.values())))
    for noun, kinds in (("cam", CAMS), ("follower", FOLLOWERS), ("linkage", LINKAGES), ("dyad", DYADS)):
        for kind, one in kinds.items():
            found[f"{noun} {kind}"] = one
            found.update(below(one, f"{noun} {kind}"))
    found.update({f"file {kind}": FORMATS[kind].options for kind in MODULES})
    of_cams = motions(found)
    found = {name: one for name, one in found.items() if not name.startswith(tuple(of_cams))}
    motion = of_cams["cam disc.motion"]  # the others have the same keys or fewer, which a test holds
    found["motion"] = motion.inner
    found.update(below(motion.inner, "motion"))
    found["motion as a mapping"] = motion.form.instead
    found.update(below(motion.form.instead, "motion"))
    # flat pair and double roller share their routes, csv has no keys
    first = {one: name for name, one in reversed(found.items()) if one.fields}
    written = {name: table(one) for name, one in found.items() if first.get(one) == name}
    text = PAGE.read_text(encoding="utf-8")
    return {**written, "motions": spans(of_cams), "figures": figures(FIGURES.among(())), "contents": contents(text)}


def of_capability(name):
    """The same of the keys and figures that a capability adds, and what `page.py` beside its tests has more."""
    record = registry.capability(name) if registry.labels()[name].record else Capability()
    own = FieldTable(tuple(record.fields()))
    found = dict(below(own, ""))
    if any(field.table is None for field in own.fields):
        found["keys"] = own
    found.update({path: FieldTable(tuple(fields)) for path, fields in record.below.items()})
    found.update({f"file {kind}": FORMATS[kind].options for kind in registry.labels()[name].formats})
    if record.variant is not None:
        found["file"] = FieldTable((record.variant.option,))
    more = ROOT / "tests" / "capabilities" / name / "page.py"
    if more.is_file():
        found.update(run_path(str(more))["TABLES"])
    first = {one: name for name, one in reversed(found.items())}
    written = {name: table(one) for name, one in found.items() if first[one] == name}
    return {**written, **({"figures": figures(record.figures)} if record.figures else {})}


def page_of(name):
    return PAGE.with_name(f"{name}.md")


def pages():
    """Every page with the tables that stand on it."""
    of_others = {page_of(name): of_capability(name) for name in registry.labels()}
    return {PAGE: tables(), **{page: written for page, written in of_others.items() if written}}


def main():
    for page, written in pages().items():
        text = page.read_text(encoding="utf-8")
        for name, lines in written.items():
            mark = f"<!-- {name} -->\n"
            if mark not in text:
                print(f"{page.name} has no place for {mark.strip()}")
                continue
            before, rest = text.split(mark)
            text = f"{before}{mark}{lines}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
        page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
