"""The tables of docs/recipe.md, from the schema: `python tests/validation/recipe_page.py` writes them anew."""

from __future__ import annotations

from pathlib import Path

from camgeo.recipe.spec import CAMS, FILES, RECIPE, Kind

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "recipe.md"
HEAD = "| key | takes | unit | default | meaning |\n| --- | --- | --- | --- | --- |"
UNITS = {
    Kind.LENGTH: "length",
    Kind.POINT: "length",
    Kind.FORMULA: "length",
    Kind.AREA: "length²",
    Kind.ANGLE: "deg",
    Kind.ERROR: "length; deg",
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
    if found.later:
        lines += ["", f"Known and refused in this version: {', '.join(f'`{name}`' for name in found.later)}."]
    return "\n".join(lines)


def below(found, path):
    """Path and table of each mapping within a table, the deeper after the shallower."""
    for field in found.fields:
        if field.table is not None:
            name = f"{path}.{field.name}" if path else field.name
            yield name, field.table
            yield from below(field.table, name)


def tables():
    """Every table of the schema by the name that marks its place in the page."""
    found = {"recipe": RECIPE, **dict(below(RECIPE, ""))}
    for kind, cam in CAMS.items():
        found[f"cam {kind}"] = cam
        found.update(below(cam, f"cam {kind}"))
    found.update({f"file {kind}": file for kind, file in FILES.items()})
    # flat pair and double roller share their routes, csv has no keys
    first = {one: name for name, one in reversed(found.items()) if one.fields}
    return {name: one for name, one in found.items() if first.get(one) == name}


def main():
    text = PAGE.read_text(encoding="utf-8")
    for name, found in tables().items():
        mark = f"<!-- {name} -->\n"
        if mark not in text:
            print(f"no place for {mark.strip()}")
            continue
        before, rest = text.split(mark)
        text = f"{before}{mark}{table(found)}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}"
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
