"""Questions after a kind: code asks a linkage, a cam or a contact for what it needs by name, not which one it is.

A family of kinds has its row in `families`, with the files that may ask and how often. What counts as a question is
said by `questions`: what stands in an annotation is none, a cast to a kind is one, and so are a probe and a name that
is taken apart. Each is tried on planted sources. The tables from class to maker have an entry for every class.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, make_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, get_args

import pytest

from camgeo.cams.families import FAMILIES as CAMS
from kin.law.contacts import Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.linkage import dyad, four_bar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from types import ModuleType

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Family:
    """Kinds that are asked for nowhere: their classes, their names in recipes, and what variables with one are called.

    `exempt` are the files that may ask, each with its number of questions; `home` is the room that may ask anything.
    """

    classes: frozenset[str]
    kinds: frozenset[str]
    nouns: frozenset[str]
    exempt: dict[str, int]
    home: str | tuple[str, ...] = "nowhere"


def classes_in(room: str, base: str) -> frozenset[str]:
    """Names of the classes of a room that are derived from a base class, however far up."""
    found, trees = {base}, [ast.parse(path.read_text(encoding="utf-8")) for path in (ROOT / room).glob("*.py")]
    classes = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    while True:
        more = {one.name for one in classes if found & {ast.unparse(each) for each in one.bases}} - found
        if not more:
            return frozenset(found - {base})
        found |= more


NAMES = ("linkages", "cams", "followers", "intents")
GUIDES = (Translating, Oscillating)
TOUCHES = (Roller, KnifeEdge, Shoe, Flat)


@cache
def families() -> dict[str, Family]:
    return {
        "linkages": Family(
            classes=frozenset(
                [
                    *("FourBar", "InvertedSliderCrank", "SliderCrank", "RRR", "RRP", "RPR"),
                ]
            ),
            kinds=frozenset(["four-bar", "inverted-slider-crank", "slider-crank", "rrr", "rrp", "rpr"]),
            nouns=frozenset(["linkage", "dyad", "loop"]),
            exempt={
                # what a recipe may say, and what is made of it
                "camgeo/recipe/linkage.py": 7,
                "camgeo/recipe/starter.py": 1,
                # one table each from class to maker, and its look-ups
                "camgeo/assembly/linked.py": 3,
                "camgeo/report/page/linked.py": 2,
                "camgeo/capabilities/sweep/search/linkages.py": 2,
            },
        ),
        "cams": Family(
            classes=classes_in("camgeo/cams", "Cam"),
            kinds=frozenset(CAMS),
            nouns=frozenset(["cam"]),
            exempt={"camgeo/recipe/starter.py": 1},
            home="camgeo/cams/",
        ),
        "followers": Family(
            classes=classes_in("kin/follower", "Follower") | {kind.__name__ for kind in (*GUIDES, *TOUCHES)} | {"Arm"},
            kinds=frozenset(
                [
                    *("yoke", "square frame", "double roller", "flat pair", "roller yoke"),
                    *(f"{guide.word} {touch.word}" for guide in GUIDES for touch in TOUCHES),
                ]
            ),
            nouns=frozenset(["follower", "guide", "touch", "contact"]),
            exempt={
                # of round touches which is drawn, and whose radius a set may give
                "camgeo/assembly/build.py": 1,
                "camgeo/assembly/guided.py": 2,
                "camgeo/report/page/guided.py": 2,
            },
            home=("kin/follower/", "kin/law/contacts.py", "camgeo/cams/"),
        ),
        "intents": Family(
            classes=frozenset(["Lift", "Transmission", "Displacement"]),
            kinds=frozenset(),
            nouns=frozenset(["intent"]),
            exempt={},
            home=("kin/", "camgeo/curve/"),
        ),
    }


LINED = ast.expr | ast.stmt | ast.pattern  # what has a line
# what a question is made of: the cases of `_asks`
TAKING_APART = frozenset(
    ["partition", "rpartition", "split", "rsplit", "startswith", "endswith", "removeprefix", "removesuffix", "find"]
)
ASKING = (
    ast.Call | ast.Attribute | ast.MatchClass | ast.MatchValue | ast.Compare | ast.Dict | ast.Tuple | ast.List | ast.Set
)


def questions(source: str, family: Family) -> list[int]:
    """Lines that ask for a kind: by isinstance, match, type(), cast, probe, comparison, table, or a name's words."""
    return asked(list(code(ast.parse(source))), family)


def code(tree: ast.AST) -> Iterator[ast.AST]:
    """Every node but those of annotations."""
    todo = [tree]
    while todo:
        node = todo.pop()
        yield node
        for name, value in ast.iter_fields(node):
            if name not in {"annotation", "returns"}:
                todo += [one for one in (value if isinstance(value, list) else [value]) if isinstance(one, ast.AST)]


def asked(nodes: list[ast.AST], family: Family) -> list[int]:
    return sorted(node.lineno for node in nodes if _asks(node, family) and isinstance(node, LINED))


def _asks(node: ast.AST, family: Family) -> bool:
    match node:
        case ast.Call(func=ast.Name(id="isinstance" | "issubclass"), args=[_, kinds]):
            return any(_is_class(part, family) for part in ast.walk(kinds))
        case ast.Call(func=ast.Name(id="type"), args=[of]) | ast.Attribute(value=of, attr="__class__"):
            return _is_one(of, family)
        case ast.Call(func=ast.Name(id="hasattr" | "getattr"), args=[of, *_]):
            return _is_one(of, family)
        case ast.Call(func=ast.Name(id="cast"), args=[kind, _]):
            return any(_is_class(part, family) for part in ast.walk(_unquoted(kind)))
        case ast.Call(func=ast.Attribute(value=ast.Attribute(value=of, attr="name"), attr=method)):
            return method in TAKING_APART and _is_one(of, family)
        case ast.MatchClass(cls=kind) | ast.MatchValue(value=kind):
            return _is_kind(kind, family)
        case ast.Compare():
            return any(_is_kind(side, family) or _is_kind_of_one(side, family) for side in _sides(node))
        case ast.Dict(keys=members) | ast.Tuple(elts=members) | ast.List(elts=members) | ast.Set(elts=members):
            return any(member is not None and _is_kind(member, family) for member in members)
    return False


def _unquoted(node: ast.expr) -> ast.AST:
    return ast.parse(node.value) if isinstance(node, ast.Constant) and isinstance(node.value, str) else node


def _sides(node: ast.Compare) -> list[ast.expr]:
    return [node.left, *node.comparators]


def _is_kind_of_one(node: ast.AST, family: Family) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == "kind" and _is_one(node.value, family)


def _is_kind(node: ast.AST, family: Family) -> bool:
    return _is_class(node, family) or (isinstance(node, ast.Constant) and node.value in family.kinds)


def _is_class(node: ast.AST, family: Family) -> bool:
    return _name(node) in family.classes


def _is_one(node: ast.AST, family: Family) -> bool:
    """Whether an expression is called as one of the family: `linkage`, `self.linkage`, `dyads[k]`, `the_dyad()`."""
    while isinstance(node, ast.Subscript | ast.Call):
        node = node.value if isinstance(node, ast.Subscript) else node.func
    words = _name(node).strip("_").split("_")
    return words[-1].removesuffix("s") in family.nouns


def _name(node: ast.AST) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def sources() -> Iterator[tuple[str, str]]:
    for package in ("kin", "camgeo"):
        for path in sorted((ROOT / package).rglob("*.py")):
            yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


@dataclass(frozen=True)
class House:
    """What all files say, each read once: lines that ask, by family and file; `Any`; who takes intents, one surface."""

    asking: dict[str, dict[str, list[int]]]
    anys: int
    taking: dict[str, list[str]]
    single: dict[str, list[int]]


@pytest.fixture(scope="module")
def house() -> House:
    asking: dict[str, dict[str, list[int]]] = {name: {} for name in NAMES}
    every, taken, ones = 0, {}, {}
    for path, text in sources():
        tree = ast.parse(text)
        spoken = list(code(tree))
        if lines := single(spoken):
            ones[path] = lines
        nodes = [node for node in spoken if isinstance(node, ASKING)]
        for name, family in families().items():
            lines = [] if path.startswith(family.home) else asked(nodes, family)
            if lines:
                asking[name][path] = lines
        said = [node for node in ast.walk(tree) if isinstance(node, SAYING)]
        every += anys(said)
        if path.startswith("camgeo/") and (names := taking(said, {"intent"})):
            taken[path] = names
    return House(asking, every, taken, ones)


def test_the_families_have_their_names() -> None:
    assert tuple(families()) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_nobody_asks_which_kind_it_is(name: str, house: House) -> None:
    family, asking = families()[name], house.asking[name]
    assert {path: lines for path, lines in asking.items() if path not in family.exempt} == {}
    assert {path: len(asking.get(path, [])) for path in family.exempt} == family.exempt


@pytest.mark.parametrize(
    "planted",
    [
        "isinstance(chosen, FourBar)",
        "isinstance(chosen, kin.linkage.dyad.RRR | RRP)",
        "isinstance(chosen, (str, RPR))",
        "issubclass(chosen, SliderCrank)",
        "match chosen:\n    case FourBar(ground=r1): pass",
        "match chosen:\n    case {'kind': 'rrp'}: pass",
        "match chosen.kind:\n    case 'four-bar' | 'other': pass",
        "type(self.linkage)",
        "type(chosen) is FourBar",
        "type(dyads[-1]).__name__",
        "self.dyads[k].__class__",
        "hasattr(mechanism.linkage, 'coupler')",
        "getattr(first_dyad, 'ground', None)",
        "getattr(recipe.linkage, name)",
        "chosen.kind == 'slider-crank'",
        "'rrr' != chosen",
        "chosen in ('inverted-slider-crank', 'slider-crank')",
        "linkage.kind == other",
        "{FourBar: 1}[chosen]",
        "{'four-bar': 2}.get(chosen)",
        "SLIDING = ['slider-crank', 'rrp']",
        "cast('FourBar', chosen).ground",
        "cast('kin.linkage.dyad.RRR | None', chosen)",
        "cast(RRP, chosen)",
        "linkage.name.endswith('crank')",
        "self.linkage.name.partition(' ')[2]",
    ],
)
def test_each_way_of_asking_is_found(planted: str) -> None:
    assert len(questions(planted, families()["linkages"])) >= 1
    assert questions(f"def f(chosen):\n    return None\n{planted}", families()["linkages"])[0] >= 3


@pytest.mark.parametrize(
    "innocent",
    [
        "FourBar(80, 70, 105)",
        "isinstance(linkage, Mapping)",
        "made = linkage.output_link(at), linkage.unit == 'deg'",
        "def f(linkage: FourBar | None) -> RRR: ...",
        "report['kind'] = recipe.linkage.kind",
        "type(error).__name__, getattr(options, 'linkage', None)",
        "Linkage = FourBar | SliderCrank",
        "kind: ClassVar[str] = 'four-bar'",
        "dyad.on == 'coupler' and linkage is not None",
        "def f(linkage: Table[FourBar, ('rrr', 'rrp')]) -> tuple[FourBar, RRR]: ...",
        "made: dict[FourBar, RRR] = {}",
        "cast('Array', linkage), path.name.split('.')",
    ],
)
def test_what_is_no_question_is_none(innocent: str) -> None:
    assert questions(innocent, families()["linkages"]) == []


# --- Any --------------------------------------------------------------------------------------------------------------

MOST_ANY = 110  # in signatures that others see


SAYING = ast.FunctionDef | ast.AsyncFunctionDef | ast.AnnAssign  # what has an annotation of its own


def anys(nodes: Iterable[ast.AST]) -> int:
    """How often `Any` stands in the annotations of public functions, methods and fields."""
    found = 0
    for node in nodes:
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) if not name.startswith("_"):
                every = [
                    *node.args.posonlyargs,
                    *node.args.args,
                    *node.args.kwonlyargs,
                    node.args.vararg,
                    node.args.kwarg,
                ]
                found += sum(_count_any(one.annotation) for one in every if one is not None)
                found += _count_any(node.returns)
            case ast.AnnAssign(target=ast.Name(id=name)) if not name.startswith("_"):
                found += _count_any(node.annotation)
    return found


def _count_any(annotation: ast.expr | None) -> int:
    return 0 if annotation is None else sum(_name(part) == "Any" for part in ast.walk(annotation))


def test_public_signatures_have_no_more_any_than_they_had(house: House) -> None:
    assert house.anys <= MOST_ANY


def test_any_is_found_where_others_see_it() -> None:
    seen = "def f(a: Any, *b: list[Any], c: int = 1) -> dict[str, Any]: ...\nclass C:\n    x: Any\n"
    assert anys(ast.walk(ast.parse(seen))) == 4
    hidden = "def _f(a: Any) -> Any: ...\n_x: Any = 1\ndef g(a: int) -> Anything: ..."
    assert anys(ast.walk(ast.parse(hidden))) == 0


# --- what a cam answers -----------------------------------------------------------------------------------------------

MOST_MEMBERS = 14


def members(source: str, name: str) -> set[str]:
    """Public names of a class: its fields, methods and properties, those for the type checker too."""
    (found,) = (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef) and node.name == name)
    names = {node.name for node in ast.walk(found) if isinstance(node, ast.FunctionDef)}
    names |= {ast.unparse(node.target) for node in found.body if isinstance(node, ast.AnnAssign)}
    return {one for one in names if not one.startswith("_")}


def taking(nodes: Iterable[ast.AST], words: set[str]) -> list[str]:
    """Public functions and methods with a parameter of one of these names."""
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    taken = [(node.name, {one.arg for one in (*node.args.args, *node.args.kwonlyargs)}) for node in functions]
    return [name for name, names in taken if not name.startswith("_") and names & words]


def test_a_cam_answers_few_things_and_an_exact_one_keeps_its_law(house: House) -> None:
    text = (ROOT / "camgeo" / "cams" / "family.py").read_text(encoding="utf-8")
    assert len(members(text, "Cam")) <= MOST_MEMBERS
    assert house.taking == {}


def test_members_and_parameters_are_found() -> None:
    inner = "    def f(self, intent): ...\n    def _g(self): ...\n    if 1:\n        def h(self): ...\n"
    source = f"class C:\n    x: int\n{inner}"
    assert members(source, "C") == {"x", "f", "h"}
    assert taking(ast.walk(ast.parse(source)), {"intent"}) == ["f"]


# --- cams of one surface ----------------------------------------------------------------------------------------------

MANY = {"surfaces", "contours", "fits", "discs", "outlines", "gauges", "running"}  # what a cam may have several of
SINGLE = {"only_surface", "gauge"}  # what stands for one of them, wherever it is asked
FIRST = {"contour", "surface", "motion", "play", "measured_error", "perimeter", "area"}  # of a file: the first's
GONE = {"contour", "surface", "body"}  # of a design
WHERE_ONE_IS_ALL = {
    "camgeo/api/report.py": 1,
    "camgeo/api/design.py": 2,  # `import camgeo` gives the contour of a cam that has one, and refuses others
    "camgeo/assembly/build.py": 1,  # printed sets, dynamics and rests are of one disc and its first surface
    "camgeo/measures/dynamics.py": 5,
    "camgeo/report/page/curves.py": 1,
    "camgeo/report/page/content.py": 1,  # where the zero of the motion is marked
    "camgeo/machining/compensation.py": 1,  # a chamfer runs along one
    "camgeo/machining/grinding.py": 2,  # tables of one surface: CAPACITIES
    "camgeo/machining/milling.py": 1,  # polar tables and solids are taught one: CAPACITIES
    "camgeo/output/gcode.py": 1,
    "camgeo/output/job.py": 2,
    "camgeo/output/table.py": 1,
    "camgeo/measures/remarks.py": 1,  # limits that a tolerance implies
    "camgeo/capabilities/study/margins.py": 1,
    "camgeo/capabilities/sweep/search/cams.py": 1,  # support functions
    "camgeo/camshaft/lobes.py": 1,  # a lobe is a cam of one surface; others are refused
    "camgeo/camshaft/drawing.py": 1,
    "camgeo/camshaft/pipeline.py": 1,
}
"""How often a file takes one surface for all; it goes down as forms of files are taught more."""


def single(nodes: list[ast.AST]) -> list[int]:
    """Lines that take one of what a cam may have several of: by index, by unpacking one, by a name for the only one."""
    return sorted(node.lineno for node in nodes if _takes_one(node) and isinstance(node, LINED))


def _takes_one(node: ast.AST) -> bool:
    match node:
        case ast.Subscript(value=of, slice=ast.Constant(value=int()) | ast.UnaryOp(operand=ast.Constant())):
            return _is_of_many(of)
        case ast.Assign(targets=[target], value=value):
            pairs = [(target, value)]
            if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                pairs = list(zip(target.elts, value.elts, strict=False))
            return any(isinstance(to, ast.Tuple) and len(to.elts) == 1 and _is_of_many(of) for to, of in pairs)
        case ast.Attribute(value=of, attr=name):
            owner = _name(of)
            return (
                name in SINGLE
                or (name in GONE and owner in {"design", "exact"})
                or (name in FIRST and owner in {"file", "verdict"})
            )
    return False


def _is_of_many(node: ast.AST) -> bool:
    named = node.func if isinstance(node, ast.Call) else node
    return isinstance(named, ast.Attribute) and named.attr in MANY


def test_a_surface_is_taken_for_all_only_where_that_is_said(house: House) -> None:
    home = ("kin/", "camgeo/cams/", "camgeo/synthesis/design.py")
    found = {path: len(lines) for path, lines in house.single.items() if not path.startswith(home)}
    assert found == WHERE_ONE_IS_ALL


@pytest.mark.parametrize(
    "planted",
    [
        "design.only_surface.contour",
        "self.exact.gauge.rests",
        "curve = design.surfaces[0].contour",
        "exact.surfaces[-1]",
        "(fit,) = job.fits",
        "(surface,), trim = exact.surfaces, True",
        "(outline,) = job.outlines('arcs', 0.001)",
        "design.contour",
        "job.design.surface.side",
        "exact.surface",
        "design.body",
        "file.measured_error",
    ],
)
def test_one_taken_for_all_is_found(planted: str) -> None:
    assert single(list(code(ast.parse(f"def f(design):\n    {planted}")))) == [2]


@pytest.mark.parametrize(
    "innocent",
    [
        "for surface, contour in design.contours: pass",
        "one, two = exact.surfaces",
        "made.surface.side, made.contour",
        "surfaces = tuple(design.surfaces)",
        "(check,) = checks",
        "lows, fits = lows[:-1], fits[0]",
        "file.surfaces, verdict.closures",
        "design.motion.stroke(t), file.body == 'cam'",
    ],
)
def test_what_takes_all_is_none(innocent: str) -> None:
    assert single(list(code(ast.parse(innocent)))) == []


# --- tables from class to maker ---------------------------------------------------------------------------------------


def kinds(module: ModuleType) -> set[type]:
    """Classes of a module of kin that are loops: they tell how far they are from binding."""
    return {
        found
        for found in vars(module).values()
        if isinstance(found, type) and found.__module__ == module.__name__ and "margin" in vars(found)
    }


def missing() -> dict[str, set[str]]:
    """Names of the kinds that the tables lack."""
    from camgeo.assembly.linked import MAKERS
    from camgeo.capabilities.sweep.search.linkages import ENGINES
    from camgeo.report.page import linked

    loops = kinds(four_bar) | kinds(dyad)
    wanted = {"page": (linked.MAKERS, loops), "bodies": (MAKERS, loops), "sweep": (ENGINES, kinds(four_bar))}
    return {name: {kind.__name__ for kind in all_ ^ set(table)} for name, (table, all_) in wanted.items()}


def test_the_tables_have_an_entry_for_every_class() -> None:
    assert missing() == {"page": set(), "bodies": set(), "sweep": set()}
    assert kinds(four_bar) == set(get_args(four_bar.Linkage))
    assert kinds(dyad) == set(get_args(dyad.Dyad))
    assert {kind.__name__ for kind in kinds(four_bar) | kinds(dyad)} <= families()["linkages"].classes


@pytest.mark.parametrize(("module", "rooms"), [(four_bar, {"page", "bodies", "sweep"}), (dyad, {"page", "bodies"})])
def test_a_class_without_an_entry_is_found(
    module: ModuleType, rooms: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    new = make_dataclass("Scotch", ["throw"], namespace={"margin": None})
    new.__module__ = module.__name__  # since Python 3.12 a namespace does not say it
    monkeypatch.setattr(module, "Scotch", new, raising=False)
    assert {room for room, names in missing().items() if names == {"Scotch"}} == rooms
