"""Plant faults in the source and tell which of them the quick tests catch: the power of the tests.

A fault is a sign, an operator, a comparison, a factor, a bound or two arguments that change places. Faults are drawn
over all packages by their lines. Each is planted in a copy of the tree. The quick tests of its package that reach its
line run there, then those of api and attacks, then a part of all others, until one fails. A fault that no test reaches
survives without a run. A fault in what runs while a module is imported is given to all tests of the package.

    python benchmarks/mutants.py --seed 1 --count 200
    python benchmarks/mutants.py --seed 1 --only kin.law --count 20

The first run of a tree traces all quick tests, which takes some minutes more than a plain run of them.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[1]
OPERATORS: dict[type[ast.operator], tuple[type[ast.operator], ...]] = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Div,),
    ast.Mod: (ast.Mult,),
    ast.Pow: (ast.Mult,),
}
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
}
MOST_OTHERS = 200  # tests of other packages that a fault is given to
LIMIT = 300.0  # seconds for the tests of one fault; a fault that hangs is caught


@dataclass(frozen=True)
class Fault:
    """One change of one expression: file relative to the root, line, kind, and the text of the changed file."""

    file: str
    line: int
    kind: str
    before: str
    after: str
    text: str


def sources(only: str | None) -> list[Path]:
    """Files of the product below package `only`."""
    found = [path for top in ("camgeo", "kin") for path in sorted((ROOT / top).rglob("*.py"))]
    prefix = (only or "").replace(".", "/")
    return [path for path in found if str(path.relative_to(ROOT)).startswith(prefix)]


def expressions(tree: ast.Module) -> Iterator[ast.expr]:
    """Expressions in which a fault may be planted: no annotations, no messages, nothing for type checkers alone."""
    passed: set[int] = set()
    for node in ast.walk(tree):
        left_out: list[ast.AST | None] = []
        if isinstance(node, ast.Raise | ast.JoinedStr) or (
            isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
        ):
            left_out = [node]
        elif isinstance(node, ast.FunctionDef):
            left_out = [
                node.returns,
                *(argument.annotation for argument in ast.walk(node.args) if isinstance(argument, ast.arg)),
            ]
        elif isinstance(node, ast.AnnAssign):
            left_out = [node.annotation]
        elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
            left_out = [node.slice]
        passed.update(id(inner) for top in left_out if top is not None for inner in ast.walk(top))
        if isinstance(node, ast.expr) and id(node) not in passed:
            yield node


def changes(node: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """Kinds of faults that an expression may have, each with what stands there instead."""
    if isinstance(node, ast.BinOp) and not isinstance(node.left, ast.Constant | ast.JoinedStr | ast.List):
        for operator in OPERATORS.get(type(node.op), ()):
            yield "operator", ast.BinOp(node.left, operator(), node.right)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and not isinstance(node.operand, ast.Constant):
        yield "sign", node.operand
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield "comparison", node.operand
    elif isinstance(node, ast.Compare) and len(node.ops) == 1:
        for comparison in COMPARISONS.get(type(node.ops[0]), ()):
            yield "comparison", ast.Compare(node.left, [comparison()], node.comparators)
    elif isinstance(node, ast.BoolOp):
        yield "comparison", ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values)
    elif isinstance(node, ast.Constant) and type(node.value) is float and node.value:
        yield "factor", ast.Constant(node.value * 1.25)
    elif isinstance(node, ast.Constant) and type(node.value) is int and node.value > 1:
        yield "bound", ast.Constant(node.value + 1)
    elif isinstance(node, ast.Call) and len(node.args) > 1 and not any(isinstance(at, ast.Starred) for at in node.args):
        first, second, *rest = node.args
        if ast.dump(first) != ast.dump(second) and not isinstance(first, ast.Constant):
            yield "argument", ast.Call(node.func, [second, first, *rest], node.keywords)


def faults_of(path: Path) -> list[Fault]:
    """All faults of a file, in its order."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines(keepends=True)
    found = []
    for node in expressions(ast.parse(text)):
        if node.lineno != node.end_lineno or node.end_col_offset is None:
            continue
        row = lines[node.lineno - 1].encode()
        before = row[node.col_offset : node.end_col_offset].decode()
        for kind, other in changes(node):
            after = f"({ast.unparse(other)})"
            line = (row[: node.col_offset] + after.encode() + row[node.end_col_offset :]).decode()
            whole = "".join([*lines[: node.lineno - 1], line, *lines[node.lineno :]])
            found.append(Fault(str(path.relative_to(ROOT)), node.lineno, kind, before, after, whole))
    return found


def drawn(rng: Random, count: int, only: str | None) -> list[Fault]:
    """So many faults: files by their lines, then a kind, then one of that kind."""
    paths = sources(only)
    sizes = [path.read_text(encoding="utf-8").count("\n") for path in paths]
    found: dict[tuple[str, int, str], Fault] = {}
    while len(found) < count:
        faults = faults_of(rng.choices(paths, sizes)[0])
        if faults:
            kind = rng.choice(sorted({fault.kind for fault in faults}))
            fault = rng.choice([fault for fault in faults if fault.kind == kind])
            found[fault.file, fault.line, fault.after] = fault
    return list(found.values())


def package_of(file: str) -> str:
    """Package of a file as its tests are foldered: `kin/law`, `camgeo/capabilities/made`."""
    parts = Path(file).parts
    return "/".join(parts[: 3 if parts[1] == "capabilities" else 2])


def tests_of(file: str) -> list[str]:
    """Folders of tests of a file's package, or the file of tests of a module, that exist."""
    top, name, *rest = Path(file).parts
    folders = [f"tests/{name}", f"tests/capabilities/{name}"] if top == "kin" else [f"tests/{name}"]
    if name == "capabilities":
        folders = [f"tests/capabilities/{rest[0]}"]
    elif not rest:  # a module beside the packages
        folders = [f"tests/test_{name}"]
    return [folder for folder in folders if (ROOT / folder).exists()]


def environment(tree: Path) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(tree), "OPENBLAS_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}


def traced(tree: Path) -> None:
    """Run all quick tests once and keep which of them reach which line."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--cov=camgeo", "--cov=kin"]
    subprocess.run([*command, "--cov-context=test", "--cov-report="], cwd=tree, env=environment(tree), check=False)


def reached(data: Path, file: Path, line: int) -> tuple[list[str], bool]:
    """Tests that run a line, and whether it runs on import."""
    from coverage import CoverageData

    held = CoverageData(str(data))
    held.read()
    contexts = {name.partition("|")[0] for name in held.contexts_by_lineno(str(file)).get(line, ())}
    return sorted(contexts - {""}), "" in contexts


def passes(tree: Path, tests: list[str]) -> bool:
    """Whether all of these tests pass; what hangs does not."""
    if not tests:
        return True
    listed = tree / "chosen.txt"
    listed.write_text("\n".join(tests), encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "@chosen.txt"]
    with subprocess.Popen(
        command,
        cwd=tree,
        env=environment(tree),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as run:
        try:
            return run.wait(LIMIT) in (0, 5)
        except subprocess.TimeoutExpired:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(run.pid, signal.SIGKILL)
            return False


def outcome(tree: Path, data: Path, fault: Fault) -> str:
    """Who catches a fault: `package`, `api, attacks`, `others`, or nobody (`survives`)."""
    folders = tests_of(fault.file)
    path = tree / fault.file
    before = path.read_text(encoding="utf-8")
    tests, on_import = reached(data, path, fault.line)
    path.write_text(fault.text, encoding="utf-8")
    try:
        own = [test for test in tests if test.startswith(tuple(folders))]
        if not passes(tree, [*own[:500], *(folders if on_import or len(own) > 500 else [])]):
            return "package"
        through = [test for test in tests if test.startswith(("tests/api/", "tests/attacks/"))]
        if not passes(tree, ["tests/api", "tests/attacks"] if on_import else through):
            return "api, attacks"
        others = sorted({*tests} - {*own} - {*through})
        return "survives" if passes(tree, others[:: len(others) // MOST_OTHERS + 1]) else "others"
    finally:
        path.write_text(before, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--only", help="a package, as kin.law")
    parser.add_argument(
        "--tree", type=Path, help="a copy of the tree to plant in, kept with its trace for further runs"
    )
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        tree = (arguments.tree or Path(made) / "tree").resolve()
        if not tree.exists():
            shutil.copytree(
                ROOT, tree, ignore=shutil.ignore_patterns(".git", ".venv", ".ci-*", "__pycache__", "node_modules")
            )
        data = tree / ".coverage"
        if not data.exists():
            traced(tree)
        table: Counter[tuple[str, str]] = Counter()
        for fault in drawn(Random(arguments.seed), arguments.count, arguments.only):
            who = outcome(tree, data, fault)
            table[package_of(fault.file), who] += 1
            table["all", who] += 1
            table[fault.kind, who] += 1
            print(f"{who:14}{fault.file}:{fault.line} {fault.kind}: {fault.before}  ->  {fault.after}", flush=True)
    columns = ("package", "api, attacks", "others", "survives")
    print(f"\n| of | {' | '.join(columns)} |\n| --- | --- | --- | --- | --- |")
    for name in sorted({name for name, _ in table}):
        print(f"| {name} | {' | '.join(str(table[name, who]) for who in columns)} |")


if __name__ == "__main__":
    main()
