"""Do two commits write the same bytes? `python benchmarks/same_bytes.py OLD NEW [--recipes N] [--only shipped|random]`.

OLD and NEW are commits of this repository, or folders that hold the packages, such as `.`. The shipped recipes of OLD,
with their tables and camshafts, and N random ones are exported by both, with this interpreter, in calls of several
recipes each. Compared are every file byte by byte, every report but its seconds and its version, every line on the
terminal, and exit statuses; of a recipe that is refused, its status and the text of the error. A line for each
difference; exit status 1 if there is any.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from random_recipes import FAMILIES, TOPICS, Made, made

ROOT = Path(__file__).resolve().parents[1]
TOGETHER = 6  # recipes of one call, whose imports are paid once
ATTEMPTS = 6  # draws for one slot, until one is exported
SECONDS = 300  # for one recipe; what takes longer is named, and compared as far as it came
NAMED_BY = ("name", "path", "file", "what", "kind")  # what tells the entries of a report's list apart
REPORT = "report.json"
LEFT_OUT = {"seconds", "camgeo", "sha256", "bytes"}  # of a report: files are compared themselves


@dataclass
class Side:
    """One commit: its packages, the folder that its calls run in, and what they said."""

    told: str
    tree: Path
    folder: Path
    said: dict[str, list[str]] = field(default_factory=dict)
    status: dict[str, int | None] = field(default_factory=dict)

    def files(self, name: str) -> dict[str, Path]:
        """Give all files of a recipe, those of a rejected one under the folder's name `.rejected`."""
        folders = [self.folder / "out" / name, self.folder / "out" / f"{name}.rejected"]
        found = [path for folder in folders for path in sorted(folder.rglob("*")) if path.is_file()]
        return {str(path.relative_to(self.folder / "out")): path for path in found}

    def reported(self, name: str) -> Path | None:
        return next((path for path in self.files(name).values() if path.name == REPORT), None)

    def fate(self, name: str) -> str:
        """Tell what became of a recipe: exported, failed (with files that are rejected, or none), or refused."""
        report = self.reported(name)
        if report is None:
            return "refused"
        return "failed" if report.parent.name.endswith(".rejected") else "exported"


def main() -> int:
    about, _, more = (__doc__ or "").partition("\n\n")
    parser = argparse.ArgumentParser(
        description=f"{about.split('`')[0]}\n\n{more}", formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", help="a commit, or a folder that holds the packages")
    parser.add_argument("new", help="the same; `.` is the working tree")
    parser.add_argument("--recipes", type=int, default=100, metavar="N", help="random recipes that give files")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="calls at once")
    parser.add_argument("--seed", type=int, default=0, metavar="S", help="of the random recipes")
    parser.add_argument("--only", choices=["shipped", "random"], help="one kind of recipes")
    parser.add_argument("--recipe", action="append", type=Path, metavar="FILE", help="this recipe alone; repeatable")
    parser.add_argument("--ignore-text", action="append", default=[], metavar="REGEX", help="lines said to leave out")
    parser.add_argument("--ignore", action="append", default=[], metavar="REGEX", help="differences to leave out")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep recipes and files in this new folder")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="same-bytes-") as temporary:
        base = args.keep.resolve() if args.keep else Path(temporary)
        base.mkdir(parents=True, exist_ok=not args.keep)
        sides = [side(args.old, base / "old"), side(args.new, base / "new")]
        for each in sides:
            start(each)
        count = compare(sides, args)
    return 1 if count else 0


def side(told: str, folder: Path) -> Side:
    """Give a commit's files in a temporary folder, or the folder itself."""
    (folder / "recipes").mkdir(parents=True)
    if (Path(told) / "camgeo" / "__init__.py").is_file():
        return Side(told, Path(told).resolve(), folder)
    tree = folder / "tree"
    command = ["git", "-C", str(ROOT), "archive", "--format=tar", told]
    done = subprocess.run(command, capture_output=True, check=False)
    if done.returncode:
        sys.exit(f"{told} is neither a folder that holds camgeo nor a commit: {done.stderr.decode().strip()}")
    with tarfile.open(fileobj=io.BytesIO(done.stdout)) as archive:
        archive.extractall(tree, filter="data")
    return Side(told, tree, folder)


def start(one: Side) -> None:
    """Make sure that the calls of a side run the side's own packages."""
    code = "import camgeo, kin; print(camgeo.__file__); print(kin.__file__)"
    done = run(one, [sys.executable, "-c", code], SECONDS)
    if done is None or done[1] or not all(Path(line).is_relative_to(one.tree) for line in done[0].splitlines()[:2]):
        sys.exit(f"{one.told} does not run: {done and done[0]}")


def run(one: Side, command: list[str], seconds: float) -> tuple[str, int] | None:
    """Run a command in the side's folder with its packages first; None if it takes too long."""
    environment = os.environ | {"PYTHONPATH": str(one.tree), "PYTHONIOENCODING": "utf-8", "COLUMNS": "100"}
    try:
        done = subprocess.run(
            command, cwd=one.folder, env=environment, capture_output=True, text=True, timeout=seconds, check=False
        )
    except subprocess.TimeoutExpired:
        return None
    return done.stdout + done.stderr.replace(str(one.tree), "TREE"), done.returncode


def export(one: Side, names: list[str]) -> None:
    """Export recipes in one call; one that comes to no report is then called alone, for its own status and text."""
    command = [sys.executable, "-m", "camgeo", "export", "--jobs", "1", "--out", "out"]
    done = run(one, [*command, *(f"recipes/{name}.yaml" for name in names)], SECONDS * len(names))
    current = names[0]
    for line in done[0].splitlines() if done else []:
        current = next((word for word in re.findall(r"[\w-]+", line) if word in names), current)
        one.said.setdefault(current, []).append(line)
    for name in names:
        if len(names) == 1:
            one.status[name] = done[1] if done else None
            one.said[name] = done[0].splitlines() if done else [f"stopped after {SECONDS} s"]
        elif one.reported(name) is None:
            export(one, [name])


def exported(sides: list[Side], recipes: dict[str, str], jobs: int) -> None:
    names = list(recipes)
    for one in sides:
        for name, text in recipes.items():
            (one.folder / "recipes" / f"{name}.yaml").write_text(text, encoding="utf-8")
    groups = [names[k : k + TOGETHER] for k in range(0, len(names), TOGETHER)]
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda call: export(*call), [(one, group) for group in groups for one in sides]))


def compare(sides: list[Side], args: argparse.Namespace) -> int:
    """Export everything by both sides, print the differences, and give their number."""
    texts = [re.compile(pattern) for pattern in args.ignore_text]
    leave = [re.compile(pattern) for pattern in args.ignore]
    old, new = sides
    number = count = 0

    def held(recipes: dict[str, str]) -> None:
        nonlocal number, count
        exported(sides, recipes, args.jobs)
        for name in recipes:
            number += len(old.files(name))
            for line in differences(name, old, new, texts):
                if not any(pattern.search(line) for pattern in leave):
                    count += 1
                    print(line, flush=True)

    fates: Counter[tuple[str, str]] = Counter()
    if args.recipe or args.only != "random":
        paths = args.recipe or sorted((old.tree / "recipes").rglob("*.yaml"))
        for rows in {rows for path in paths for rows in path.parent.glob("*.csv")}:
            for each in sides:
                shutil.copy(rows, each.folder / "recipes")
        held({path.stem: path.read_text(encoding="utf-8") for path in paths})
        fates.update(("shipped", old.fate(path.stem)) for path in paths)
    if not args.recipe and args.only != "shipped":
        wanted = list(range(args.recipes))
        for attempt in range(ATTEMPTS):
            drawn = [made(args.seed, slot, attempt) for slot in wanted]
            if drawn:
                held({each.name: each.text for each in drawn})
            for each in drawn:
                fates.update((group, old.fate(each.name)) for group in (each.family, each.topic))
            wanted = [slot for slot, each in zip(wanted, drawn, strict=True) if not settled(old, each)]
        if wanted:
            print(f"{len(wanted)} random recipes gave no file in {ATTEMPTS} attempts")
    table(fates)
    print(f"{number} files and reports of {old.told} and {new.told}: {count or 'no'} differences")
    return count


def settled(old: Side, each: Made) -> bool:
    return each.topic == "fault" or len(old.files(each.name)) > 1


def differences(name: str, old: Side, new: Side, ignored: list[re.Pattern[str]]) -> list[str]:
    """Tell every difference of one recipe, a line each."""
    found = []
    if old.status.get(name) != new.status.get(name):
        found.append(f"{name}: exit status {old.status.get(name)}, now {new.status.get(name)}")
    said = [
        [line for line in side.said.get(name, []) if not any(p.search(line) for p in ignored)] for side in (old, new)
    ]
    for k in range(max(map(len, said))):
        lines = [repr(lines[k]) if k < len(lines) else "nothing" for lines in said]
        if lines[0] != lines[1]:
            found.append(f"{name}: line {k + 1} said was {lines[0]}, now {lines[1]}")
            break  # the lines below are moved
    ours, theirs = old.files(name), new.files(name)
    for path in sorted(ours.keys() | theirs.keys()):
        if path not in theirs or path not in ours:
            found.append(f"{path}: only in {old.told if path in ours else new.told}")
        elif Path(path).name == REPORT:
            reports = [flat(json.loads(side[path].read_text(encoding="utf-8"))) for side in (ours, theirs)]
            found += [f"{path}: {line}" for line in unlike(*reports)]
        else:
            a, b = ours[path].read_bytes(), theirs[path].read_bytes()
            if a != b:
                at = next((k for k, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
                found.append(f"{path}: first differs at byte {at}; it had {len(a)} bytes, now {len(b)}")
    return found


def flat(value: object, at: str = "") -> dict[str, object]:
    """Give a report as paths and plain values; a list's entries by their names, so that one more moves no other."""
    if isinstance(value, dict):
        pairs = [(f"{at}.{key}", below) for key, below in value.items() if key not in LEFT_OUT]
    elif isinstance(value, list):
        taken: Counter[str] = Counter()
        pairs = []
        for entry in value:
            names = [str(entry[key]) for key in NAMED_BY if key in entry] if isinstance(entry, dict) else []
            label = " ".join(names)
            taken[label] += 1
            pairs.append((f"{at}[{label}{f' {taken[label]}' if taken[label] > 1 or not names else ''}]", entry))
    else:
        return {at.lstrip("."): value}
    found: dict[str, object] = {at.lstrip("."): type(value).__name__} if not pairs else {}
    for path, below in pairs:
        found |= flat(below, path)
    return found


def unlike(old: dict[str, object], new: dict[str, object]) -> list[str]:
    """Tell where two reports differ: `PATH was X, now Y`, `PATH is gone`, `PATH is new`."""
    lines = [f"{path} is gone, was {value!r}" for path, value in old.items() if path not in new]
    lines += [f"{path} is new: {value!r}" for path, value in new.items() if path not in old]
    both = [path for path in old if path in new and repr(old[path]) != repr(new[path])]
    return lines + [f"{path} was {old[path]!r}, now {new[path]!r}" for path in both]


def table(fates: Counter[tuple[str, str]]) -> None:
    """Show what was covered: for each family and topic how many recipes were exported, failed a check, were refused."""
    columns = ["exported", "failed", "refused"]
    print(f"{'recipes':24}" + "".join(f"{column:>10}" for column in columns))
    groups = {group for group, _ in fates}
    for group in [group for group in ("shipped", *FAMILIES, *TOPICS) if group in groups]:
        print(f"{group:24}" + "".join(f"{fates[group, column]:10}" for column in columns))


if __name__ == "__main__":
    sys.exit(main())
