"""Tables of docs/recipe.md, of its pages docs/recipe-*.md and of those of capabilities, from the schema.

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
from camgeo.recipe.extension import KEYS
from camgeo.recipe.figures import FIGURES
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.limits import bounds
from camgeo.recipe.linkage import DYADS, LINKAGES
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS, MODULES
from camgeo.registry.root import reading
from camgeo.schema.fields import FieldTable, Kind, either

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "recipe.md"
OWN = ("motion", "support", "yoke", "disc", "pair", "linkage", "part", "export", "verify")
CORE = (PAGE, *(PAGE.with_name(f"recipe-{name}.md") for name in OWN))
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


def meaning(field):
    about = field.about
    for name in registry.formats():
        about = about.replace(f", {name}", "")
    return about


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
    return f"| `{field.name}` | {wanted} | {unit} | {default} | {meaning(field)} |".replace("  ", " ")


def table(found):
    together = [name for name, _ in found.alternatives]
    return "\n".join([HEAD, *(row(field, together) for field in found.fields)])


def first_names(found):
    """By the name of each table the first name under which the same one stands, where it is written out."""
    return {name: next(other for other, same in found.items() if same == one) for name, one in found.items()}


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


def titles(text):
    """Title of a page, and of each of its sections, without the comments of its blocks of code."""
    plain = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.findall(r"^# (.*)$", plain, re.MULTILINE)[0], re.findall(r"^##+ (.*)$", plain, re.MULTILINE)


def anchor(title):
    return "#" + re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def contents():
    """Each page of the core as a link, with its sections."""
    lines = []
    for page in CORE[1:]:
        title, sections = titles(page.read_text(encoding="utf-8"))
        links = " · ".join(f"[{section}]({page.name}{anchor(section)})" for section in sections)
        lines.append(f"- [{title}]({page.name})" + (f": {links}" if links else ""))
    return "\n".join(lines)


def place(page, name):
    """Where a table stands: its page, with the section in which its mark is; of one without a mark its keys."""
    before, mark, _ = page.read_text(encoding="utf-8").partition(f"<!-- {name} -->\n")
    sections = titles(before)[1]
    if not mark:
        sections = [title for title in sections if title == "Keys"]
    return page.name + (anchor(sections[-1]) if sections else "")


NOUNS = {"follower": "cam.follower", "dyad": "linkage.dyads", "file": "export.files", "limits": "limits.<figure>"}


def key_lines(found, page_of_table, capability=""):
    """A line for each key of some tables: its paths, where it is explained, of which kinds, what it means."""
    first, lines = first_names(found), {}
    for name, one in found.items():
        noun, _, rest = name.removesuffix(" as a mapping").partition(" ")
        kind, _, inner = rest.partition(".")
        bounds_of_kind = noun == "limits" and kind  # whose keys are its figures, each bounded as any other
        if bounds_of_kind and inner:
            continue
        path = ".".join(filter(None, (noun if bounds_of_kind else NOUNS.get(noun, noun), inner)))
        where = place(page_of_table(first[name]), first[name])
        entries = [(field.name, meaning(field)) for field in one.fields]
        if kind and not inner and noun not in {"file", "limits"}:
            entries.insert(0, ("kind", f"the kind of {noun}"))
        for key, about in entries:
            # what stands at several paths for one kind has one line, and so has what several kinds have at one path
            paths, places = lines.setdefault((path if kind else first[name], key, about), ({}, {}))
            paths[f"`{path}.{key}`"] = None
            places.setdefault(where, {})[kind or capability or path.partition(".")[0]] = None
    mark = f" <!-- needs: {capability} -->" if capability else ""
    for (_, _, about), (paths, places) in lines.items():
        links = ", ".join(f"[{', '.join(kinds)}]({where})" for where, kinds in places.items())
        yield f"| {', '.join(paths)} | {links} | {about} |{mark}"


def keys(found):
    """Every key below the top level, in the order of the pages, those of capabilities last."""
    found = {name: one for name, one in found.items() if name != "recipe"}
    found["limits"] = FieldTable((*found["limits"].fields, *own_keys(FIGURES.among(()))))
    texts = [page.read_text(encoding="utf-8") for page in CORE]
    places = {mark: (i, text.index(f"<!-- {mark} -->\n")) for i, text in enumerate(texts) for mark in marks(text)}
    first = first_names(found)
    order = sorted(found, key=lambda name: places.get(first[name], (0, 0)))
    lines = ["| key | explained | meaning |", "| --- | --- | --- |"]
    lines += key_lines({name: found[name] for name in order}, lambda name: CORE[places.get(name, (0, 0))[0]])
    for capability in registry.labels():
        page = page_of(capability)
        page = page if page.is_file() else page.with_stem(f"{capability}s")  # camshafts.md
        lines += key_lines(all_of_capability(capability), lambda _, page=page: page, capability)
    return "\n".join(lines)


def own_keys(entries):
    """Keys that some figures have in `limits` beside their bounds."""
    return {key.name: key for figure in entries.values() for key in figure.keys}.values()


def all_of_capability(name):
    """Tables of all keys of a capability, also of those that its page explains in its own words."""
    found, keys = keys_of_capability(name), KEYS[name]
    if keys.alteration is not None:
        found["file"] = FieldTable((*(found["file"].fields if "file" in found else ()), *keys.alteration.options))
    for root in registry.labels()[name].roots:
        found[root] = reading(root).table().field(root).table
        found.update(below(found[root], root))
        of_motions = tuple(motions({root: found[root]}))  # whose grammar stands on its own page
        found = {path: one for path, one in found.items() if not (of_motions and path.startswith(of_motions))}
    for path, one in more_of(name).get("LISTED", {}).items():
        found[path] = one
        found.update(below(one, path))
    own = tuple(own_keys(keys.figures))
    return {**found, "limits": FieldTable(own)} if own else found


def more_of(name):
    """What `page.py` beside the tests of a capability has."""
    path = ROOT / "tests" / "capabilities" / name / "page.py"
    return run_path(str(path)) if path.is_file() else {}


def marks(text):
    return re.findall(r"^<!-- (?!end|needs: )(.*) -->$", text, re.MULTILINE)


def figures(entries):
    lines = ["| figure | unit | best | needs | sweep | meaning |", "| --- | --- | --- | --- | --- | --- |"]
    for name, figure in entries.items():
        needs, swept = figure.needs.words, "yes" if figure.swept else ""
        row = f"| `{name}` | {UNITS.get(figure.kind, '')} | {figure.best} | {needs} | {swept} | {figure.about} |"
        lines.append(row.replace("  ", " ").replace("  ", " "))
    return "\n".join(lines)


def written_out(found):
    """Each table with keys, once."""
    return {
        name: table(found[name]) for name, first in first_names(found).items() if first == name and found[name].fields
    }


def schema():
    """Every table of the core's schema, by the name that marks its place."""
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
    return found, of_cams


def tables():
    """The same, written out."""
    found, of_cams = schema()
    written = written_out(found)  # flat pair and double roller share their routes
    written |= {"motions": spans(of_cams), "figures": figures(FIGURES.among(()))}
    return {**written, "pages": contents(), "keys": keys(found)}


def keys_of_capability(name):
    """Tables of the keys that a capability adds, and of what `page.py` beside its tests has more."""
    keys = KEYS[name]
    own = FieldTable(tuple(keys.fields()))
    found = dict(below(own, ""))
    if any(field.table is None for field in own.fields):
        found["keys"] = own
    found.update({f"file {kind}": FORMATS[kind].options for kind in registry.labels()[name].formats})
    if keys.variant is not None:
        found["file"] = FieldTable((keys.variant.option,))
    return found | more_of(name).get("TABLES", {})


def of_capability(name):
    """The same, written out, and the figures that it adds."""
    added = KEYS[name].figures
    return {**written_out(keys_of_capability(name)), **({"figures": figures(added)} if added else {})}


def page_of(name):
    return PAGE.with_name(f"{name}.md")


def pages():
    """Every page with the tables that stand on it; a table without a place is one of docs/recipe.md."""
    written = tables()
    found = {page: marks(page.read_text(encoding="utf-8")) for page in CORE}
    of_core = {page: {name: written[name] for name in names if name in written} for page, names in found.items()}
    of_core[PAGE] |= {
        name: lines for name, lines in written.items() if not any(name in page for page in of_core.values())
    }
    of_others = {page_of(name): of_capability(name) for name in registry.labels()}
    return {**of_core, **{page: written for page, written in of_others.items() if written}}


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
