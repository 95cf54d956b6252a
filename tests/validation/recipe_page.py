"""The tables of docs/recipe.md, from the schema: `python tests/validation/recipe_page.py` writes them anew."""

from __future__ import annotations

from pathlib import Path

from camgeo.cams.disc import FOLLOWERS
from camgeo.recipe.cam import CAMS
from camgeo.recipe.export import FILES
from camgeo.recipe.figures import FIGURES, NEEDS, bounds
from camgeo.recipe.linkage import DYADS, LINKAGES
from camgeo.recipe.recipe import RECIPE
from camgeo.recipe.sweep import RANGE
from camgeo.schema.fields import Kind

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
}


def row(field, optional_together):
    unit = UNITS.get(field.unit or field.kind, "")
    if field.required:
        default = "required"
    elif field.name in optional_together:
        default = "one of these"
    else:
        default = field.default or ""
    return f"| `{field.name}` | {field.wanted()} | {unit} | {default} | {field.about} |".replace("  ", " ")


def table(found):
    together = [name for name, _ in found.alternatives]
    lines = [HEAD, *(row(field, together) for field in found.fields)]
    later = [f"`{name}`" for name, _ in found.later]
    later += [f"`{field.name}: {word}`" for field in found.fields for word, _ in field.later_choices]
    if later:
        lines += ["", f"Known and refused in this version: {', '.join(later)}."]
    return "\n".join(lines)


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


def figures():
    lines = ["| figure | unit | best | needs | sweep | meaning |", "| --- | --- | --- | --- | --- | --- |"]
    for name, figure in FIGURES.items():
        needs, swept = NEEDS.get(figure.needs, ""), "yes" if figure.swept else ""
        row = f"| `{name}` | {UNITS.get(figure.kind, '')} | {figure.best} | {needs} | {swept} | {figure.about} |"
        lines.append(row.replace("  ", " ").replace("  ", " "))
    return "\n".join(lines)


def tables():
    """Every table of the schema, written out, by the name that marks its place in the page."""
    found = {"recipe": RECIPE, **dict(below(RECIPE, "")), "sweep.vary": RANGE}
    found["limits"] = bounds(next(iter(FIGURES.values())))
    for noun, kinds in (("cam", CAMS), ("follower", FOLLOWERS), ("linkage", LINKAGES), ("dyad", DYADS)):
        for kind, one in kinds.items():
            found[f"{noun} {kind}"] = one
            found.update(below(one, f"{noun} {kind}"))
    found.update({f"file {kind}": file for kind, file in FILES.items()})
    # flat pair and double roller share their routes, csv has no keys
    first = {one: name for name, one in reversed(found.items()) if one.fields}
    written = {name: table(one) for name, one in found.items() if first.get(one) == name}
    return {**written, "figures": figures()}


def main():
    text = PAGE.read_text(encoding="utf-8")
    for name, written in tables().items():
        mark = f"<!-- {name} -->\n"
        if mark not in text:
            print(f"no place for {mark.strip()}")
            continue
        before, rest = text.split(mark)
        text = f"{before}{mark}{written}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
