"""Two commits' speed in one run: `python benchmarks/ab.py OLD NEW [--recipe REGEX] [--random N] [--cold] [--stages]`.

OLD and NEW are commits of this repository, or folders that hold the packages, such as `.`; the same one twice tells
what the machine tells apart. Each has a process of its own, and both export a DXF of the same recipes in turn, first
the one, then the other, with one number changed each time, so that no process has seen the recipe before. Times are of
the processor, with one BLAS thread, from a recipe object to a judged file; `--cold` takes whole processes instead.

A line for each recipe has the least milliseconds of both, the ratio of these, NEW to OLD, and the median of the ratios
of rounds with their middle half. The last line has the geometric mean of the medians. `--stages` adds a line for each
stage of a run; `--random` recipes by chance, a new one each round, with medians in place of the least. `--small` takes
little of everything, to see that it works: its figures say nothing.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from itertools import count as count_from
from itertools import islice
from pathlib import Path
from statistics import geometric_mean, median, quantiles
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml
from peer import COLLECT_AFTER
from random_recipes import made
from same_bytes import Side, side, start
from speed import compiled, spent

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

DEFAULT = "^(shu-wu|disc-roller|disc-arm|valve-lobe|lobe-card|six-bar|yoke-swing|groove-stem|conjugate-arm)$"
CHANGED = ("linkage.ground", "cam.base_radius", "cam.arm", "cam.shaft.0", "part.bore", "export.tolerance")
NUDGE = 1e-6  # of a number, each round
LEAST = 2e-3  # seconds: a stage that takes less in both is not told
WORKER = f"""
import gc, json, sys, tempfile, time
from pathlib import Path
from types import SimpleNamespace
from camgeo import CamgeoError
from camgeo.api.loading import load
from camgeo.common import clock
from camgeo.output.pipeline import export
gc.set_threshold({COLLECT_AFTER})
clock.time = SimpleNamespace(perf_counter=time.process_time)
for line in sys.stdin:
    path, changes = json.loads(line)
    try:
        recipe = load(path)
        recipe = recipe.replace(changes) if changes else recipe
        gc.collect()
        with tempfile.TemporaryDirectory() as folder:
            start = time.process_time()
            report = export(recipe, Path(folder), only=("dxf",)).report
            spent = time.process_time() - start
        stages = {{}}
        for stage in report["stages"]:
            stages[stage["name"]] = stages.get(stage["name"], 0.0) + stage["seconds"]
        said = [spent, stages]
    except (CamgeoError, OSError) as error:  # a nudged number may leave no cam: said, and left out in both
        said = [None, type(error).__name__]
    print(json.dumps(said), flush=True)
"""


class Task(NamedTuple):
    """One export: a recipe's file, and the values that are changed in it."""

    path: Path
    changes: dict[str, float]


class Told(NamedTuple):
    """What one export took: seconds, and those of each stage; or no seconds and the error's name."""

    seconds: float | None
    stages: dict[str, float] | str


class Warm:
    """A process that has the packages of one side, and exports what it is told."""

    def __init__(self, one: Side, environment: dict[str, str]) -> None:
        command = [sys.executable, "-c", WORKER]
        self.process = subprocess.Popen(
            command, env=environment, cwd=one.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def __call__(self, task: Task) -> Told:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(json.dumps([str(task.path), task.changes]), file=self.process.stdin, flush=True)
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"a process that exports {task.path.name} came to its end, with status {self.process.wait()}")
        return Told(*json.loads(line))

    def close(self) -> None:
        self.process.communicate()


class Cold:
    """Exports in a new process each."""

    def __init__(self, one: Side, environment: dict[str, str]) -> None:
        self.folder, self.environment = one.folder, environment

    def __call__(self, task: Task) -> Told:
        recipe = yaml.safe_load(task.path.read_text(encoding="utf-8"))
        for key, value in task.changes.items():
            *above, last = steps(key)
            within = recipe
            for name in above:
                within = within[name]
            within[last] = value
        path = task.path.with_name("cold.yaml")  # beside its tables
        path.write_text(yaml.safe_dump(recipe, sort_keys=False), encoding="utf-8")
        words = ["export", str(path), "--only", "dxf", "--out", str(self.folder / "out")]
        try:
            return Told(spent([sys.executable, "-m", "camgeo", *words], self.environment), {})
        except subprocess.CalledProcessError as error:
            return Told(None, f"status {error.returncode}")

    def close(self) -> None:
        """Nothing is held."""


def steps(key: str) -> list[str | int]:
    return [int(name) if name.isdigit() else name for name in key.split(".")]


def number_in(recipe: Any, key: str) -> float | None:
    """The number at a path, if there is one."""
    for name in steps(key):
        try:
            recipe = recipe[name]
        except (KeyError, IndexError, TypeError):
            return None
    return float(recipe) if isinstance(recipe, (int, float)) and not isinstance(recipe, bool) else None


def shipped(path: Path, rounds: int) -> Iterator[Task]:
    """The same recipe, with the first number that it has of `CHANGED` a little larger each round."""
    recipe = yaml.safe_load(path.read_text(encoding="utf-8"))
    found = ((key, number_in(recipe, key)) for key in CHANGED)
    key, number = next((pair for pair in found if pair[1]), (None, None))
    if key is None or number is None:
        return
    for k in range(rounds):
        yield Task(path, {key: number * (1.0 + NUDGE * k)})


def drawn(folder: Path, count: int) -> Iterator[Task]:
    """As many recipes by chance, each a new one, of which a DXF is asked for."""
    slots = (made(1, slot) for slot in count_from(0))
    for each in islice((each for each in slots if each.topic != "fault"), count):
        recipe = yaml.safe_load(each.text)
        files = recipe.setdefault("export", {}).setdefault("files", [])
        if not any("dxf" in ((file,) if isinstance(file, str) else file) for file in files):
            files.append("dxf")
        path = folder / f"{each.name}.yaml"
        path.write_text(yaml.safe_dump(recipe, sort_keys=False), encoding="utf-8")
        yield Task(path, {})


def pairs(tasks: Iterator[Task], old: Callable[[Task], Told], new: Callable[[Task], Told]) -> list[tuple[Told, Told]]:
    """What both took for each task; who is first changes each time. What either refuses is named, and left out."""
    found = []
    for k, task in enumerate(tasks):
        if k % 2:
            second = new(task)
            first = old(task)
        else:
            first = old(task)
            second = new(task)
        if (first.seconds is None) != (second.seconds is None):
            print(f"{task.path.stem}: OLD {first.stages}, NEW {second.stages}: refused by one of them")
        elif first.seconds is not None:
            found.append((first, second))
    return found


def line(name: str, old: list[float], new: list[float], one: Callable[[list[float]], float] = min) -> float:
    """Print a line of the table, `one` of all rounds for each side, and give the median ratio."""
    ratios = sorted(b / a for a, b in zip(old, new, strict=True))
    low, middle, high = quantiles(ratios, n=4, method="inclusive") if len(ratios) > 1 else ratios * 3
    least = f"{1e3 * one(old):.1f} | {1e3 * one(new):.1f} | {one(new) / one(old):.2f}"
    print(f"| {name} | {len(ratios)} | {least} | {middle:.2f} ({low:.2f} to {high:.2f}) |", flush=True)
    return middle


def by_stage(told: list[tuple[Told, Told]]) -> None:
    """Print a line for each stage that both have."""
    rows = [(a.stages, b.stages) for a, b in told if isinstance(a.stages, dict) and isinstance(b.stages, dict)]
    for name in rows[0][0] if rows else ():
        both = [(a[name], b[name]) for a, b in rows if a.get(name) and b.get(name)]
        if both and median(max(pair) for pair in both) > LEAST:
            line(f"— {name}", [a for a, _ in both], [b for _, b in both])


def copied(one: Side) -> Side:
    """The side with a copy of its packages and recipes beside the other's: some discs are slower than others."""
    tree = one.folder / "tree"
    if one.tree != tree:
        for name in ("camgeo", "kin", "recipes"):
            shutil.copytree(one.tree / name, tree / name, ignore=shutil.ignore_patterns("__pycache__"))
        one.tree = tree
    return one


def measured(sides: list[Side], args: argparse.Namespace, folder: Path) -> None:
    """Print the table."""
    base = compiled(folder / "bytecode")
    way = Cold if args.cold else Warm
    old, new = (way(one, base | {"PYTHONPATH": str(one.tree), "PYTHONHASHSEED": "0"}) for one in sides)
    paths = [path for path in sorted((sides[0].tree / "recipes").glob("*.yaml")) if re.search(args.recipe, path.stem)]
    if not paths and not args.random:
        sys.exit(f"no shipped recipe has a name like {args.recipe}")
    copies = folder / "recipes"
    copies.mkdir()
    for table in (sides[0].tree / "recipes").glob("*.csv"):
        (copies / table.name).write_bytes(table.read_bytes())
    print("| recipe | rounds | OLD, ms | NEW, ms | least by least | median (middle half) |")
    print("| --- | --- | --- | --- | --- | --- |")
    medians = []
    for path in paths[:2] if args.small else paths:
        copy = copies / path.name
        copy.write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
        told = pairs(shipped(copy, args.rounds + 1), old, new)[1:]  # the first imports
        if told:
            medians.append(line(path.stem, *seconds(told)))
        if args.stages:
            by_stage(told)
    if args.random:
        told = pairs(drawn(copies, args.random + 1), old, new)[1:]
        if told:
            medians.append(line("by chance, each new", *seconds(told), one=median))
    if medians:
        print(f"\ngeometric mean of the medians: {geometric_mean(medians):.3f}")
    old.close()
    new.close()


def seconds(told: list[tuple[Told, Told]]) -> tuple[list[float], list[float]]:
    return [a.seconds or 0.0 for a, _ in told], [b.seconds or 0.0 for _, b in told]


def main() -> None:
    about, _, more = (__doc__ or "").partition("\n\n")
    parser = argparse.ArgumentParser(
        description=f"{about.split(':')[0]}.\n\n{more}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", help="a commit, or a folder that holds the packages")
    parser.add_argument("new", help="the same; `.` is the working tree")
    parser.add_argument("--recipe", default=DEFAULT, metavar="REGEX", help="shipped recipes whose names match")
    parser.add_argument("--random", type=int, default=0, metavar="N", help="and so many by chance")
    parser.add_argument("--rounds", type=int, default=12, metavar="N", help="exports of each recipe that count")
    parser.add_argument("--cold", action="store_true", help="whole processes")
    parser.add_argument("--stages", action="store_true", help="a line for each stage too")
    parser.add_argument("--small", action="store_true", help="two recipes, two rounds, to see that it works")
    args = parser.parse_args()
    if args.small:
        args.rounds, args.random = 2, args.random and 2
    with tempfile.TemporaryDirectory(prefix="ab-") as name:
        folder = Path(name)
        sides = [copied(side(args.old, folder / "old")), copied(side(args.new, folder / "new"))]
        for each in sides:
            start(each)
        measured(sides, args, folder)


if __name__ == "__main__":
    main()
