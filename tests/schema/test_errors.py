"""What a faulty recipe is answered: whole messages, with file, line, column, field, fault, value and remedy.

Holds: camgeo.schema.fields, camgeo.schema.read_scalar, camgeo.schema.reader, camgeo.schema.readers,
camgeo.schema.yaml_source, camgeo.recipe.keys.
"""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
import yaml

from camgeo.cli.main import main
from camgeo.recipe.cam import CAMS
from camgeo.recipe.keys import recipe_table
from camgeo.recipe.loading import load, load_text, read
from camgeo.registry import formats, registry
from camgeo.registry.root import kinds
from camgeo.schema.errors import RecipeError, RecipeErrors
from camgeo.schema.fields import either
from camgeo.schema.yaml_source import MAX_ALIASES, MAX_BYTES, MAX_DEPTH, MAX_NODES
from kin.law.formula.formula import Formula, FormulaError
from kin.law.sources.laws import NAMES

SUPPORT = "cam: {kind: support, p: 9}\n"
KEYS = either(recipe_table().keys, "and")
PART = (
    "thickness, bore, keyway, flat, hub, set_screw, bolts, dowel, slot, chamfer, mark, lightening, "
    "outer, wall and density"
)
BORE = "give a diameter above 0, or a form such as {square: 10}, {hexagon: 10} or {diameter: 20, fit: H7} in mm"
NAME = "letters, digits, '.', '_' and '-', beginning with a letter, a digit or '_', at most 64 characters"
TAKEN = "give mm, cm, in or inch, or a number alone, which is in"
LENGTH = "give a length above 0 in mm"
FORMATS = f"give {either(formats.FORMATS)}"
OF_TABLES = either(
    [
        *(key for key in ("correct", "local") if "made" in registry.labels()),
        *formats.FORMATS["csv"].options.keys,
    ],
    "and",
)
HELD = either([name for name, record in formats.FORMATS.items() if "tolerance" in record.options.keys])


def told(body: str | bytes, path: str = "c.yaml") -> list[str]:
    with pytest.raises(RecipeErrors) as caught:
        read(body if isinstance(body, bytes) else body.encode(), path)
    return str(caught.value).splitlines()


def test_all_faults_at_once_by_line() -> None:
    body = """\
name: a
units: inch
cam:
  kind: double-roller
  ratio: 4/2
  length: 60
  roller_radius: -8
  delta: {cos: {2: 625}}
part: {bore: 10um, follower: 3}
export: {files: [dxf, {dxf: {as: spline, version: R12}}, stl, stp]}
verify: {angles: 010}
tolerance: 4
dynamics: {mass: 1, stiffness: 1e5, rpm: 100}  # needs: dynamics
"""
    assert told(body, "cams/a.yaml") == [
        (
            "cams/a.yaml:4:3: cam.arm: missing; give a length above 0 in inch: "
            "arm length, the distance l of the closing equation"
        ),
        "cams/a.yaml:5:10: cam.ratio: not in lowest terms, given 4/2; write 2",
        (
            "cams/a.yaml:6:3: cam.length: unknown key; the keys here are kind, ratio, arm, roller_radius, delta, law, "
            "arc, rosette, undercut and preload"
        ),
        "cams/a.yaml:7:18: cam.roller_radius: not above 0, given -8; give a length above 0 in inch",
        "cams/a.yaml:8:17: cam.delta.cos.2: an even number, given 2; give an odd whole number from 1 to 199",
        f"cams/a.yaml:9:14: part.bore: 'um' is no unit of a length, given '10um'; {TAKEN} inch",
        "cams/a.yaml:9:20: part.follower: unknown key; it belongs under cam of kind disc",
        (
            "cams/a.yaml:10:34: export.files[1].dxf.as: R12 has no splines, given 'spline'; "
            "give arcs or polyline, or a later version"
        ),
        "cams/a.yaml:10:58: export.files[2]: stl needs a thickness; give part.thickness, or leave stl out",
        f"cams/a.yaml:10:63: export.files[3]: unknown file format, given 'stp'; {FORMATS}",
        "cams/a.yaml:11:18: verify.angles: a leading zero, which some read as octal, given 010; leave the zero out",
        (f"cams/a.yaml:12:1: tolerance: unknown key; it belongs under export, or under the file {HELD}"),
        "cams/a.yaml:13:11: dynamics: needs preload or backlash; give exactly one of them",  # needs: dynamics
    ]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        # a required key, the kind, one of several, one that another needs, a diameter for a radius
        (
            "cam: {kind: double-roller, ratio: 2, arms: 30, roller_radius: 3, arc: {radius: 40, side: convex}}",
            "1:38: cam.arms: unknown key; did you mean arm?",
        ),
        ("cam: {knd: support, p: 9}", "1:7: cam.knd: unknown key; did you mean kind?"),
        (
            "cam: {kind: disc, base_radius: 30, follower: {knd: flat}, motion: [{dwell: 360}]}",
            "1:47: cam.follower.knd: unknown key; did you mean kind?",
        ),
        ("cam: {kind: support, forier: {mean: 9}}", "1:22: cam.forier: unknown key; did you mean fourier?"),
        (
            (
                "cam: {kind: disc, base_radius: 30, follower: {kind: flat}, "
                "motion: [{rise: 9, ovr: 180, law: cycloidal}, {return: 9, over: 180, law: cycloidal}]}"
            ),
            "1:79: cam.motion[0].ovr: unknown key; did you mean over?",
        ),
        (
            "cam: {kind: disc, base_radius: 30, follower: {kind: roller, diameter: 16}, motion: [{dwell: 360}]}",
            "1:61: cam.follower.diameter: unknown key; give radius: 8",
        ),
    ],
)
def test_one_misspelled_key_is_one_fault(body: str, message: str) -> None:
    assert told(body) == [f"c.yaml:{message}"]


def test_a_key_that_is_near_one_that_stands_hides_no_missing_one() -> None:
    body = "cam: {kind: double-roller, ratio: 2, ratios: 2, roller_radius: 3, arc: {radius: 40, side: convex}}"
    assert [message.split("; ")[0] for message in told(body)] == [
        "c.yaml:1:6: cam.arm: missing",
        "c.yaml:1:38: cam.ratios: unknown key",
    ]


def test_an_error_carries_its_parts() -> None:
    with pytest.raises(RecipeErrors) as caught:
        read(b"cam: {kind: support, p: 9, undercut: ignore}", Path("c.yaml"))
    (error,) = caught.value.errors
    assert error == RecipeError(
        file="c.yaml",
        line=1,
        column=38,
        path="cam.undercut",
        problem="not one of the choices",
        value="'ignore'",
        remedy="give refuse or trim",
    )
    assert pickle.loads(pickle.dumps(caught.value)).errors == caught.value.errors


# --- the file and its YAML --------------------------------------------------------------------------------------------


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    def whole(path: str | Path) -> str:
        with pytest.raises(RecipeErrors) as caught:
            load(path)
        (error,) = caught.value.errors
        assert (error.line, error.column) == (0, 0)
        return str(error)

    missing = tmp_path / "missing.yaml"
    assert whole(missing) == f"{missing}: the file does not exist"
    assert whole(tmp_path) == f"{tmp_path}: a folder"
    assert whole("a\0b") == "a\\x00b: not the name of a file"
    large = tmp_path / "large.yaml"
    large.write_bytes(b"#" * (MAX_BYTES + 1))
    assert whole(large) == f"{large}: the file is larger than 1000000 bytes; a recipe needs a few hundred"


AROUND = "check indentation, quotes, brackets and colons in this line and the line above"


def test_lines_of_comments_that_end_as_on_windows_are_passed_over_once(tmp_path: Path) -> None:
    """Each of these lines once doubled the time in which a directive was looked for."""
    path = tmp_path / "windows.yaml"
    path.write_bytes(b"# a line of comment\r\n\r\n" * 1000 + SUPPORT.encode())
    assert load(path).name == "windows"
    path.write_bytes(b"# a line of comment\r\n" * 1000 + b"%YAML 1.1\r\n---\r\n" + SUPPORT.encode())
    with pytest.raises(RecipeErrors, match="1001:1: a YAML directive"):
        load(path)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("", "1:1: the recipe is empty; `camgeo new` writes one to start from"),
        ("# only this\n", "1:1: the recipe is empty; `camgeo new` writes one to start from"),
        ("- 1\n- 2", "1:1: a recipe is a mapping, given a list of 2; begin with the key `cam:`"),
        ("25", "1:1: a recipe is a mapping, given 25; begin with the key `cam:`"),
        (SUPPORT + "---\n" + SUPPORT, "2:1: a second YAML document; one recipe a file; leave out the line ---"),
        ("# x\n%YAML 1.1\n---\n" + SUPPORT, "2:1: a YAML directive; a recipe has none; leave the line out"),
        (
            "cam:\n\tkind: support\n",
            (
                "2:1: YAML cannot be read: while scanning for the next token, found character '\\t' that cannot "
                "start any token; indent with spaces, not tabs"
            ),
        ),
        (
            "cam:\n  kind: [support\n",
            "3:1: YAML cannot be read: while parsing a flow sequence, expected ',' or ']', but got '<stream end>'; "
            + AROUND,
        ),
        (
            "about: SW: 5\n" + SUPPORT,
            (
                "1:10: YAML cannot be read: mapping values are not allowed here; "
                "a text that contains a colon and a space needs quotes; keys of one mapping start in one column"
            ),
        ),
        ("cam: *c\n", "1:6: an alias without its anchor, given '*c'; quote a text that begins with * or &"),
        ("cam: &c [*c]\n", "1:10: an alias without its anchor, given '*c'; quote a text that begins with * or &"),
        (b"cam: 1\nabout: \xe9\n", "2:8: not UTF-8, given byte 0xe9; save the file as UTF-8"),
        (b"\xff\xfec\x00", "1:1: not UTF-8, given byte 0xff; save the file as UTF-8"),
        (b"cam: 1\nabout: a\x00", "2:9: a character that cannot stand in a recipe, given U+0000; delete it"),
        ("about: a\u2028b", "1:9: a character that cannot stand in a recipe, given U+2028; delete it"),
        ('about: "\\U00110000"\n', "1:6: an escape that stands for no character; write it out"),
    ],
)
def test_yaml_that_cannot_be_read(body: str | bytes, message: str) -> None:
    assert told(body) == [f"c.yaml:{message}"]


@pytest.mark.thin(2)
@pytest.mark.parametrize("reader", ["CSafeLoader", "SafeLoader"])
def test_bounds_hold_from_both_sides(reader: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if reader == "SafeLoader":
        monkeypatch.delattr(yaml, "CSafeLoader", raising=False)

    def nested(depth: int) -> list[str]:
        return told("cam: " + "[" * depth + "]" * depth)

    assert nested(MAX_DEPTH - 1) == [
        ("c.yaml:1:6: cam: not a mapping, given a list of 1; give a mapping with the kind of cam and its fields")
    ]
    assert nested(MAX_DEPTH) == [
        f"c.yaml:1:{5 + MAX_DEPTH}: nested more than {MAX_DEPTH} deep; a recipe needs five levels"
    ]

    def listed(count: int) -> list[str]:  # the list, the key, the mapping and `count` items
        return told("cam: [" + "1," * count + "]")

    assert listed(MAX_NODES - 3)[0].startswith("c.yaml:1:6: cam: not a mapping, given a list of 9997;")
    assert listed(MAX_NODES - 2) == [
        f"c.yaml:1:{7 + 2 * (MAX_NODES - 3)}: more than 10000 entries, aliases expanded; a recipe needs a few dozen"
    ]

    def aliased(count: int) -> list[str]:
        return told("cam: [&a 1" + ", *a" * count + "]")

    assert aliased(MAX_ALIASES)[0].startswith("c.yaml:1:6: cam: not a mapping, given a list of 101;")
    assert aliased(MAX_ALIASES + 1) == [f"c.yaml:1:{13 + 4 * MAX_ALIASES}: more than 100 aliases; write the values out"]


def test_laughs_are_counted_not_expanded() -> None:
    lines = ["l0: &l0 [1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"l{i}: &l{i} [{', '.join([f'*l{i - 1}'] * 9)}]" for i in range(1, 9)]
    assert told("\n".join(lines)) == [
        "c.yaml:5:10: more than 10000 entries, aliases expanded; a recipe needs a few dozen"
    ]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            "name: !!python/name:os.system x\n" + SUPPORT,
            (
                "1:7: name: a YAML tag, given 'tag:yaml.org,2002:python/name:os.system'; "
                "leave it out; the field says how it is read"
            ),
        ),
        (
            "cam:\n  kind: support\n  p: 9\n  p: 8\n",
            "4:3: cam.p: a duplicate key; it is given in line 3 already",
        ),
        (SUPPORT + "? [a]\n: 1\n", "2:3: a key must be a text, given a list of 1"),
        (SUPPORT + "<<: {part: 1}\n", "2:1: '<<': merge keys are not read; write the keys out"),
    ],
)
def test_yaml_that_a_recipe_does_not_use(body: str, message: str) -> None:
    assert told(body) == [f"c.yaml:{message}"]


# --- keys -------------------------------------------------------------------------------------------------------------

FLAT_PAIR = "cam: {kind: flat-pair, ratio: 2, arm: 30, roller_radius: 3, arc: {radius: 50}}\n"


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("body", "message"),
    [
        (SUPPORT + "naem: x\n", "2:1: naem: unknown key; did you mean name?"),
        (SUPPORT + "bore: 5\n", "2:1: bore: unknown key; it belongs under part"),
        (
            "cam: {kind: disc, base_radius: 20, motion: [{dwell: 360}], follower: {kind: roller, radius: 4, pivot: 5}}",
            "1:96: cam.follower.pivot: unknown key; it belongs under arm",
        ),
        (SUPPORT + "xyz: 5\n", f"2:1: xyz: unknown key; the keys here are {KEYS}"),
        (SUPPORT + "cam.shaft: 5\n", f"2:1: 'cam.shaft': unknown key; the keys here are {KEYS}"),
        (SUPPORT + "part: {units: mm}\n", "2:8: part.units: unknown key; it belongs at the top level"),
        # near motion, but a word of its own elsewhere
        (
            "cam: {kind: disc, base_radius: 40, follower: {kind: knife-edge}, rotation: ccw, motion: [{dwell: 360}]}\n",
            "1:66: cam.rotation: unknown key; it belongs at the top level",
        ),
        (SUPPORT + "part: {x: 1}\n", f"2:8: part.x: unknown key; the keys here are {PART}"),
        (
            SUPPORT + "export: {files: [{html: {x: 1}}]}\n",
            "2:26: export.files[0].html.x: unknown key; the keys here are overlays",
        ),
        (
            FLAT_PAIR,
            "1:43: cam.roller_radius: unknown key; it belongs under cam of kind constant-diameter or double-roller",
        ),
        # needs: dynamics
        (
            SUPPORT + "dynamics: {mass: 1, stiffness: 100, rpm: 60, damping: 300, backlash: 0.1}\n",
            "2:55: dynamics.damping: 15 times critical; give less than 200",
        ),
        # needs: dynamics
        (
            SUPPORT + "dynamics: {mass: 1, stiffness: 100, rpm: 60, backlash: 0.1, rate: 2}\n",
            (
                "2:67: dynamics.rate: a spring rate beside backlash; give preload in place of backlash, "
                "or leave the rate out"
            ),
        ),
        # needs: dynamics
        (
            SUPPORT + "dynamics: {mass: 1, stiffness: 100, rpm: 60, preload: 1, backlash: 0.1}\n",
            "2:68: dynamics.backlash: cannot be combined with preload; give exactly one of preload, backlash or spring",
        ),
        (
            SUPPORT + "part: {follower: 1}\n",
            "2:8: part.follower: unknown key; it belongs under cam of kind disc",
        ),
        ("{}", "1:1: cam: missing; give a mapping with the kind of cam and its fields: the cam, of exactly one kind"),
        ("cam:\n", "1:5: cam: nothing given; give a mapping with the kind of cam and its fields"),
        ("cam: 5", "1:6: cam: not a mapping, given 5; give a mapping with the kind of cam and its fields"),
        (
            "cam: {p: 9}",
            f"1:6: cam.kind: missing; give {either((*CAMS, *kinds()))}: the kind of cam",
        ),
        ("cam: {kind: suport, p: 9}", "1:13: cam.kind: not one of the choices, given 'suport'; did you mean support?"),
        ("cam: {kind: disk, p: 9}", "1:13: cam.kind: not one of the choices, given 'disk'; did you mean disc?"),
        (
            "cam: {kind: support}",
            "1:6: cam: needs p, fourier, reuleaux or hypocycloid; give exactly one of them",
        ),
        (
            "cam: {kind: support, p: 9, fourier: {mean: 1}}",
            "1:37: cam.fourier: cannot be combined with p; give exactly one of p, fourier, reuleaux or hypocycloid",
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, arc: {radius: 50}, delta: {cos: {1: 5}}}",
            "1:48: cam.arc: cannot be combined with delta; give exactly one of delta, law, arc or rosette",
        ),
        (SUPPORT + "part:\n", f"2:6: part: nothing given; give a mapping with {PART}, or leave the key out"),
        (SUPPORT + "part: {bore: ~}\n", f"2:14: part.bore: nothing given; {BORE}, or leave the key out"),
        (
            SUPPORT + "part: [1]\n",
            f"2:7: part: not a mapping, given a list of 1; give a mapping with {PART}",
        ),
    ],
)
def test_keys(body: str, message: str) -> None:
    assert told(body) == [f"c.yaml:{message}"]


# --- numbers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("ten", f"not a number, given 'ten'; {LENGTH}"),
        ("1:30", "not a number, given '1:30'; sexagesimal numbers are not read; write it as one decimal number"),
        ("010", "a leading zero, which some read as octal, given 010; leave the zero out"),
        (".inf", "not a number, given '.inf'; it must be finite"),
        ("-.INF", "not a number, given '-.INF'; it must be finite"),
        (".nan", "not a number, given '.nan'; it must be finite"),
        ("0x1F", "not a number, given '0x1F'; write it in decimal"),
        ("1_000", "not a number, given '1_000'; write it without underscores"),
        ("1,5", "not a number, given '1,5'; a decimal takes a point, not a comma"),
        (
            "10 m",
            "'m' is no unit of a length, given '10 m'; give mm, cm, in or inch, or a number alone, which is in mm",
        ),
        ("on", "not a number, given 'on'; this is a truth value"),
        ("2020-01-01", "not a number, given '2020-01-01'; this is a date"),
        ("1/0", f"divides by zero, given 1/0; {LENGTH}"),
        ("1e999", f"too large, given 1e999; {LENGTH}"),
        ("-1e-31", "too small, given -1e-31; give at least 1e-30"),  # 0 would not do
        ("1e-999", f"not above 0, given 1e-999; {LENGTH}"),
        ("0", f"not above 0, given 0; {LENGTH}"),
        ("-2", f"not above 0, given -2; {LENGTH}"),
        ("2000001", f"above 2000000, given 2000001; {LENGTH}"),
        ("[1]", f"not a length, given a list of 1; {LENGTH}"),
        ("{}", f"not a length, given a mapping of 0; {LENGTH}"),
        (
            "1" * 61,
            f"a number of more than 60 characters, given '{'1' * 57}...'; sixteen digits are all that counts",
        ),
    ],
)
def test_what_is_no_length(written: str, message: str) -> None:
    assert told(f"{SUPPORT}part:\n  thickness: {written}\n") == [f"c.yaml:3:14: part.thickness: {message}"]


@pytest.mark.parametrize(
    "cam", ["kind: disc, follower: {kind: flat}", "kind: constant-diameter, roller_radius: 5", "kind: support, p: 9"]
)
def test_a_key_of_another_kind_of_cam_is_no_slip_of_the_pen(cam: str) -> None:
    found = told(f"cam: {{{cam}, swing: []}}")
    about_swing = [line.partition("cam.swing: ")[2] for line in found if "cam.swing" in line]
    assert about_swing == ["unknown key; it belongs under cam of kind constant-breadth"]


def test_a_length_near_0_where_0_would_do() -> None:
    linkage = "linkage:\n  {ground: 60, rocker: 1e-31, kind: inverted-slider-crank}\n"
    assert told(SUPPORT + linkage) == [
        "c.yaml:3:24: linkage.rocker: too small, given 1e-31; write 0, or the intended number"
    ]
    assert read((SUPPORT + linkage.replace("1e-31", "0")).encode(), "c.yaml").linkage


@pytest.mark.parametrize(
    ("angles", "message"),
    [
        ("7", "below 8, given 7"),
        ("1000001", "above 1000000, given 1000001"),
        ("10.5", "not a whole number, given 10.5"),
    ],
)
def test_shaft_angles(angles: str, message: str) -> None:
    assert told(f"{SUPPORT}verify: {{angles: {angles}}}") == [
        f"c.yaml:2:18: verify.angles: {message}; give a whole number from 8 to 1000000"
    ]


@pytest.mark.parametrize("angles", ["8", "1e6"])
def test_shaft_angles_at_their_bounds(angles: str) -> None:
    assert read(f"{SUPPORT}verify: {{angles: {angles}}}".encode(), "c.yaml").verify.angles == float(angles)


# --- names ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    [
        "..",
        "../x",
        "/x",
        "a/b",
        "a\\b",
        ".x",
        "-x",
        "x.",
        "a b",
        "ünter",
        "",
        "x" * 65,
        "a:b",
        "a\nb",
        "C:",
        "a\u0000b",
    ],
)
def test_names_that_could_leave_the_folder(name: str) -> None:
    escaped = name.encode("unicode_escape").decode()
    body = f'name: "{escaped}"\n{SUPPORT}'
    given = repr(name if len(name) <= 60 else name[:57] + "...")
    assert told(body) == [f"c.yaml:1:7: name: not safe as the name of a folder, given {given}; use {NAME}"]


@pytest.mark.parametrize("name", ["NUL", "con", "nul.txt", "COM1", "lpt9.a.b"])
def test_names_of_devices(name: str) -> None:
    assert told(f"name: {name}\n{SUPPORT}") == [
        f"c.yaml:1:7: name: reserved for a device by Windows, given '{name}'; use {NAME}"
    ]


def test_a_name_cannot_be_that_of_a_failed_runs_folder() -> None:
    assert told(f"name: x.Rejected\n{SUPPORT}") == [
        (
            "c.yaml:1:7: name: reserved for the folders of failed runs, which end in .rejected, given 'x.Rejected'; "
            "choose another ending"
        )
    ]


@pytest.mark.parametrize("stem", ["my cam", "nul", "ünter"])
def test_a_stem_that_is_no_name(stem: str) -> None:
    problem = "reserved for a device by Windows" if stem == "nul" else "not safe as the name of a folder"
    assert told(SUPPORT, f"cams/{stem}.yaml") == [
        f"cams/{stem}.yaml:1:1: name: the file's stem is {problem}, given '{stem}'; give `name:` with {NAME}"
    ]
    assert read(f"name: x\n{SUPPORT}".encode(), f"{stem}.yaml").name == "x"


# --- formulas ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "text", "column"),
    [
        ("25 + sinn(t)", "25 + sinn(t)", 11),
        ("'25 + sinn(t)'", "25 + sinn(t)", 12),
        ('"25 + sinn(t)"', "25 + sinn(t)", 12),
        ('"25 + \\x73inn(t)"', "25 + sinn(t)", 6),
        (">\n    25 +\n    sinn(t)", "25 + sinn(t) ", 6),
        ("25 + cos(3t)", "25 + cos(3t)", 16),
        ("2^t", "2^t", 7),
        ("__import__('os')", "__import__('os')", 17),
        ("25 +", "25 +", 10),
        ("10**1000", "10**1000", 8),
    ],
)
def test_formulas_are_pointed_into(written: str, text: str, column: int) -> None:
    with pytest.raises(FormulaError) as caught:
        Formula(text)
    assert told(f"cam:\n  kind: support\n  p: {written}\n") == [
        f"c.yaml:3:{column}: cam.p: {caught.value.message}, given {text!r}; give a formula in t"
    ]


def test_a_formula_with_a_comma_inside_braces() -> None:
    body = "cam: {kind: flat-pair, ratio: 2, arm: 6, rosette: {leaf: atan2(x, 1)}}"
    assert told(body) == [
        (
            "c.yaml:1:63: cam.rosette.leaf: this parenthesis is never closed, given 'atan2(x'; "
            "a formula with a comma in it needs quotes inside braces"
        ),
        "c.yaml:1:67: cam.rosette.'1)': unknown key; the keys here are leaf",
    ]


# --- cams -------------------------------------------------------------------------------------------------------------

FRACTION = "give a fraction lambda/mu above 1 in lowest terms with mu odd, such as 4/3, or a whole number"


@pytest.mark.parametrize(
    ("ratio", "message"),
    [
        ("4/2", "not in lowest terms, given 4/2; write 2"),
        ("9/3", "not in lowest terms, given 9/3; write 3"),
        ("10/6", "not in lowest terms, given 10/6; write 5/3"),
        ("3/2", "an even denominator, given 3/2; mu must be odd, or the pitch curve would cross itself"),
        ("1", "not above 1, given 1; the arms' angle alpha = pi mu/lambda must stay below 180 degrees"),
        ("2/3", "not above 1, given 2/3; the arms' angle alpha = pi mu/lambda must stay below 180 degrees"),
        ("999/7", "a numerator above 200, given 999/7; only small ones make useful cams"),
        ("4/0", f"divides by zero, given 4/0; {FRACTION}"),
        ("4:3", f"not a fraction of whole numbers, given '4:3'; {FRACTION}"),
        ("1.3333", f"not a fraction of whole numbers, given 1.3333; {FRACTION}"),
        ("-4/3", f"not a fraction of whole numbers, given -4/3; {FRACTION}"),
        ("[4, 3]", f"not a ratio, given a list of 2; {FRACTION}"),
    ],
)
def test_ratios(ratio: str, message: str) -> None:
    body = f"cam: {{kind: flat-pair, ratio: {ratio}, arm: 30, arc: {{radius: 50}}}}"
    assert told(body) == [f"c.yaml:1:31: cam.ratio: {message}"]


ODD = "give an odd whole number from 3 to 99"
MOTION = "cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 180, law: LAW}]}"


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("body", "messages"),
    [
        (
            "cam: {kind: support, reuleaux: {sides: 4, breadth: 50, rounding: 25}}",
            [
                f"1:40: cam.reuleaux.sides: an even number, given 4; {ODD}",
                "1:66: cam.reuleaux.rounding: not below half the breadth, given 25; give less than 25 mm",
            ],
        ),
        (
            "cam: {kind: support, reuleaux: {sides: 1, breadth: 50, rounding: -1}}",
            [
                f"1:40: cam.reuleaux.sides: below 3, given 1; {ODD}",
                "1:66: cam.reuleaux.rounding: below 0, given -1; give a length of at least 0 in mm",
            ],
        ),
        (
            "cam: {kind: support, reuleaux: {sides: 3, breadth: 2, rounding: 1.5}}\nunits: inch",
            ["1:65: cam.reuleaux.rounding: not below half the breadth, given 1.5; give less than 1 inch"],
        ),
        (
            "cam: {kind: support, hypocycloid: {cusps: 2, size: 0}}",
            [
                f"1:35: cam.hypocycloid.breadth: missing; {LENGTH}: constant breadth",
                f"1:43: cam.hypocycloid.cusps: below 3, given 2; {ODD}",
                f"1:52: cam.hypocycloid.size: not above 0, given 0; {LENGTH}",
            ],
        ),
        (
            "cam: {kind: support, fourier: {mean: 9, cos: {3: x, 0: 1, 1.5: 2, 5: 1, 5.0: 1}, sin: 4}}",
            [
                "1:50: cam.fourier.cos.3: not a number, given 'x'; give a length in mm",
                "1:53: cam.fourier.cos.0: below 1, given 0; give a whole number from 1 to 199",
                "1:59: cam.fourier.cos.'1.5': not a whole number, given 1.5; give a whole number from 1 to 199",
                "1:73: cam.fourier.cos.'5.0': a duplicate harmonic; give each harmonic once",
                (
                    "1:87: cam.fourier.sin: not a mapping, given 4; give a mapping from harmonics to coefficients, "
                    "such as {3: 0.5} in mm"
                ),
            ],
        ),
        (
            "cam: {kind: support, p: 9, shaft: [1]}",
            ["1:35: cam.shaft: not a point, given a list of 1; give a list of two lengths [x, y] in mm"],
        ),
        (
            "cam: {kind: support, p: 9, shaft: [1, a]}",
            ["1:39: cam.shaft[1]: not a number, given 'a'; give a length in mm"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 2, 2: 1}}}",
            ["1:63: cam.delta.cos.2: an even number, given 2; give an odd whole number from 1 to 199"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {harmonics: 33, law: [{dwell: 90}]}}",
            ["1:62: cam.delta.harmonics: above 31, given 33; give an odd whole number from 1 to 31"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {harmonics: 3}}",
            ["1:62: cam.delta.harmonics: cannot stand without a law; leave it out, or give delta.law"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 9}, law: [{dwell: 90}]}}",
            ["1:56: cam.delta.cos: cannot stand beside law; leave one of them out"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {law: [{dwell: 45}]}}",
            [
                (
                    "1:56: cam.delta.law: the segments do not fill their angle, given 45 degrees; "
                    "let them cover 180/2 degrees; an angle may be a fraction such as 180/7"
                )
            ],
        ),
        (
            "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {}, sin: {}}}",
            ["1:50: cam.delta: no harmonics, so no motion; give some, such as {cos: {1: 625}}"],
        ),
        (
            "cam: {kind: flat-pair, ratio: 7/3, arm: 30, law: [{dwell: 25.7}]}",
            [
                (
                    "1:50: cam.law: the segments do not fill their angle, given 25.7 degrees; "
                    "let them cover 180/7 degrees; an angle may be a fraction such as 180/7"
                )
            ],
        ),
        (
            (
                "cam: {kind: constant-breadth, base_radius: 40, "
                "motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 50}]}"
            ),
            [
                (
                    "1:56: cam.motion: the segments do not fill their angle, given 170 degrees; "
                    "let them cover one half turn, 180 degrees; an angle may be a fraction such as 180/7"
                )
            ],
        ),
        (
            "cam: {kind: double-roller, ratio: 2, arm: 30, roller_radius: 3, arc: {radius: 40, side: inside}}",
            ["1:89: cam.arc.side: not one of the choices, given 'inside'; give convex or concave"],
        ),
        (
            MOTION.replace("LAW", "modified-sin"),
            ["1:84: cam.motion[0].law: unknown motion law, given 'modified-sin'; did you mean modified-sine?"],
        ),
        (  # another name of the harmonic law
            MOTION.replace("LAW", "simple-harmonic"),
            ["1:84: cam.motion[0].law: unknown motion law, given 'simple-harmonic'; did you mean harmonic?"],
        ),
        (
            MOTION.replace("LAW", "xyz"),
            [
                (
                    "1:84: cam.motion[0].law: unknown motion law, given 'xyz'; give "
                    f"{', '.join(NAMES)}, match, {{polynomial: [...]}}, {{scca: {{...}}}}, {{uniform: {{blend: 10}}}}, "
                    "{points: [...]} or {table: s.csv}"
                )
            ],
        ),
        (
            MOTION.replace("LAW", "{polynomial: [0, 2]}"),
            [
                (
                    "1:84: cam.motion[0].law: a polynomial law must lead from 0 to 1; this one leads from s(0) = 0 to "
                    "s(1) = 2; let c0 be 0 and the sum of all coefficients 1"
                )
            ],
        ),
        (
            MOTION.replace("LAW", "{scca: {sine: 0.75, constant: 0.5}}"),
            [
                (
                    "1:84: cam.motion[0].law.scca: `sine` and `constant` together are at most 1, not 1.25; let `sine` "
                    "and `constant` together be at most 1, and `velocity` below 1"
                )
            ],
        ),
        (
            "cam: {kind: constant-breadth, base_radius: 4, motion: [{dwell: 90, split: 0.4}, {dwell: 90, at_end: {}}]}",
            [
                "1:75: cam.motion[0].split: needs a law; leave it out",
                "1:101: cam.motion[1].at_end: needs a law; leave it out",
            ],
        ),
        (
            MOTION.replace("LAW", "{polynomial: [0, 2, -1, 1e-310]}"),
            ["1:108: cam.motion[0].law.polynomial[3]: too small, given 1e-310; write 0, or the intended number"],
        ),
        (
            MOTION.replace("LAW", "{polynom: [0, 1]}"),
            ["1:85: cam.motion[0].law.polynom: unknown key; did you mean polynomial?"],
        ),
    ],
)
def test_cams(body: str, messages: list[str]) -> None:
    assert told(body) == [f"c.yaml:{message}" for message in messages]


# needs: camshaft
def test_a_camshaft_is_no_cam() -> None:
    """Where one cam is wanted, such as by `study`; what reads camshafts is named."""
    (message,) = told("camshaft: {lobes: [{recipe: intake.yaml, at: 234, z: 0}]}\n")
    assert message == (
        "c.yaml:1:1: camshaft: a camshaft is no disc cam; export, check and verify take it; its page is html in "
        "export.files; give any other command the recipe of a lobe"
    )


# needs: camshaft
def test_a_camshaft_without_lobes_ends_with_status_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "shaft.yaml"
    path.write_text("camshaft: {lobes: []}\n")
    assert main(["check", str(path)]) == 2
    assert "shaft.yaml:1:19: camshaft.lobes: an empty list" in capsys.readouterr().err


def test_segments() -> None:
    body = """\
cam:
  kind: constant-breadth
  base_radius: 40
  motion:
    - {dwell: 60, over: 3}
    - {rise: 5, return: 3, over: 4, law: harmonic}
    - {over: 5}
    - {rise: 4, law: harmonic}
    - {return: 4, over: 200}
    - {displacement: 20*u}
    - {table: motion.csv}
    - 7
"""
    keys = "rise, return, to, rise_fall, displacement, dwell, over, law, split and at_end"
    kinds = "rise, return, to, rise_fall, displacement or dwell"
    assert told(body) == [
        "c.yaml:5:25: cam.motion[0].over: cannot be combined with dwell; leave it out",
        "c.yaml:6:25: cam.motion[1].return: cannot be combined with rise; give exactly one of " + kinds,
        f"c.yaml:7:7: cam.motion[2]: needs {kinds}; give exactly one of them",
        (
            "c.yaml:8:7: cam.motion[3].over: missing, needed with rise; give an angle above 0 up to 180 in "
            "degrees: shaft angle of the segment"
        ),
        "c.yaml:9:25: cam.motion[4].over: above 180, given 200; give an angle above 0 up to 180 in degrees",
        (
            "c.yaml:10:7: cam.motion[5].over: missing, needed with displacement; give an angle above 0 up to 180 in "
            "degrees: shaft angle of the segment"
        ),
        f"c.yaml:11:7: cam.motion[6]: needs {kinds}; give exactly one of them",
        "c.yaml:11:8: cam.motion[6].table: unknown key; it belongs under law",
        f"c.yaml:12:7: cam.motion[7]: not a mapping, given 7; give a mapping with {keys}",
    ]


def test_an_angle_that_is_off_by_more_than_rounding_is_not_closed_in_silence() -> None:
    def motion(over: str) -> bytes:
        return f"cam: {{kind: flat-pair, ratio: 7/3, arm: 30, law: [{{dwell: {over}}}]}}".encode()

    assert read(motion("180/7"), "c.yaml")
    assert read(motion("25.71428571428571"), "c.yaml")
    assert told(motion("25.714285"))[0].startswith("c.yaml:1:50: cam.law: the segments do not fill their angle")


# --- files ------------------------------------------------------------------------------------------------------------

CHOOSE = "give a format, or a mapping with one format such as {dxf: {as: spline}}"
TWINS = "give each another `as` or `version`, or a recipe of its own"


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("files", "messages"),
    [
        ("dxf", ["17: export.files: not a list, given 'dxf'; give a list of files such as [dxf, stl]"]),
        ("[]", ["17: export.files: an empty list; give a list of files such as [dxf, stl]"]),
        ("[~]", [f"18: export.files[0]: not a file, given nothing; {CHOOSE}"]),
        ("[[dxf]]", [f"18: export.files[0]: not a file, given a list of 1; {CHOOSE}"]),
        ("[{dxf: {}, csv: {}}]", [f"18: export.files[0]: not a file, given a mapping of 2; {CHOOSE}"]),
        ("[stp]", [f"18: export.files[0]: unknown file format, given 'stp'; {FORMATS}"]),
        ("[DXF]", [f"18: export.files[0]: unknown file format, given 'DXF'; {FORMATS}"]),
        (
            "[{csv: }]",
            [(f"23: export.files[0].csv: nothing given; give a mapping with {OF_TABLES}, or leave the key out")],
        ),
        (
            "[{dxf: {as: curves, version: R14, tolerance: 0}}]",
            [
                "29: export.files[0].dxf.as: not one of the choices, given 'curves'; give arcs, polyline or spline",
                "46: export.files[0].dxf.version: not one of the choices, given 'R14'; give R12, R2000, R2010 or R2013",
                f"62: export.files[0].dxf.tolerance: not above 0, given 0; {LENGTH}",
            ],
        ),
        (
            "[{csv: {as: motions}}]",
            [
                "29: export.files[0].csv.as: not one of the choices, given 'motions'; did you mean motion?",
            ],
        ),
        (
            "[{svg: {as: exact, version: R12}}]",
            [
                "29: export.files[0].svg.as: not one of the choices, given 'exact'; give arcs, polyline or spline",
                "36: export.files[0].svg.version: unknown key; it belongs under the file dxf",
            ],
        ),
        ("[svg, {svg: {as: arcs}}]", ["23: export.files[1]: the same file twice; leave one out"]),
        (
            "[dxf, stl]",
            ["23: export.files[1]: stl needs a thickness; give part.thickness, or leave stl out"],
        ),
        ("[dxf, csv, dxf]", ["28: export.files[2]: the same file twice; leave one out"]),
        (
            "[dxf, {dxf: {as: arcs, version: R2010}}]",
            ["23: export.files[1]: the same file twice; leave one out"],
        ),
        (
            "[dxf, {dxf: {tolerance: 1}}, {dxf: {tolerance: 2}}]",
            [f"46: export.files[2]: a second file of one name, given <name>-arcs-R2010.dxf; {TWINS}"],
        ),
        (
            "[{dxf: {as: spline, version: R12}}]",
            [
                (
                    "29: export.files[0].dxf.as: R12 has no splines, given 'spline'; "
                    "give arcs or polyline, or a later version"
                )
            ],
        ),
    ],
)
def test_files(files: str, messages: list[str]) -> None:
    assert told(f"{SUPPORT}export: {{files: {files}}}") == [f"c.yaml:2:{message}" for message in messages]


def test_a_faulty_thickness_is_not_called_missing() -> None:
    assert told(f"{SUPPORT}part: {{thickness: 0}}\nexport: {{files: [stl]}}") == [
        f"c.yaml:2:19: part.thickness: not above 0, given 0; {LENGTH}"
    ]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("units: cm", "1:8: units: not one of the choices, given 'cm'; give mm or inch"),
        ("rotation: clockwise", "1:11: rotation: not one of the choices, given 'clockwise'; give cw or ccw"),
        ("about: [a]", "1:8: about: not a text, given a list of 1; give a text"),
        ('about: "a\\x07b"', "1:8: about: holds control characters, given 'a\\x07b'; write plain text"),
        (f"about: {'x' * 1001}", f"1:8: about: longer than 1000 characters, given '{'x' * 57}...'; shorten it"),
        ("export: {tolerance: 0}", f"1:21: export.tolerance: not above 0, given 0; {LENGTH}"),
        (
            "verify: {motion_error: 0}",
            "1:24: verify.motion_error: not above 0, given 0; give a motion error above 0 in mm",
        ),
    ],
)
def test_other_fields(line: str, message: str) -> None:
    assert told(f"{line}\n{SUPPORT}") == [f"c.yaml:{message}"]


def test_a_decimal_comma_within_braces_is_named() -> None:
    """YAML ends the value there, and reads the rest as a key."""
    (message,) = told("cam:\n  kind: support\n  fourier: {mean: 25,5}\n")
    assert message.endswith("cam.fourier.5: a number cut at its comma; a decimal takes a point, not a comma")


def test_many_faults_alike_are_one_line_and_a_count() -> None:
    rows = "".join(f"  - {{rise: {word}, over: 9, law: cycloidal}}\n" for word in ["x"] * 51 + ["y"] * 3 + ["x"])
    with pytest.raises(RecipeErrors) as caught:
        load_text(f"cam:\n  kind: disc\n  base_radius: 9\n  follower: {{kind: flat}}\n  motion:\n{rows}", "cam.yaml")
    assert len(caught.value.errors) == 55
    lines = str(caught.value).splitlines()
    assert lines[0].endswith("mm; and 51 more such faults, the last in line 60")
    assert lines[0].startswith("cam.yaml:6:12: cam.motion[0].rise: not a number, given 'x'; ")
    assert [line.partition(", given")[0] for line in lines[1:]] == [
        f"cam.yaml:{57 + k}:12: cam.motion[{51 + k}].rise: not a number" for k in range(3)
    ]
