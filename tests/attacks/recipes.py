"""Recipes by chance, sound and wrong, given to the commands that take one."""

from __future__ import annotations

import copy
import importlib
import re
import sys
from functools import cache
from typing import TYPE_CHECKING, Any

import yaml
from support.places import ROOT, SHIPPED
from support.spoilt import by_schema, holder, leaves
from support.starters import OF_CAMS

from attacks.cams import drawn, wrong_verdict
from attacks.outcome import Attack, nothing_more
from camgeo.recipe.starter import starter
from camgeo.registry import root as roots

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done, Judge

LONG = 60.0  # s: sets and searches make and move ten bodies, or a hundred designs
SLOW_TOPICS = {"set": LONG, "linkage-set": LONG}
FORMS = [
    "dxf",
    "svg",
    "stl",
    "ply",
    "3mf",
    "csv",
    "glb",
    "html",
    "{dxf: {as: arcs, version: R12}}",
    "{dxf: {as: spline}}",
]
FORMS += [
    "{csv: {as: inspection, step: 5}}",
    "{csv: {as: contacts}}",
    "{csv: {as: polar}}",
    "{csv: {as: points}}",
    "{svg: {as: polyline}}",
    "{dxf: {as: polyline, kerf: 0.1}}",
]
SHEETS: list[Any] = [
    "sheet",
    {"sheet": {"paper": "A4", "projection": "third", "step": 15, "scale": "1:2", "title": "x"}},
    {"sheet": {"profile": 0.01, "finish": {"contour": "Ra 0.8", "bore": "Rz 6.3"}}},
]
PLACED = re.compile(r"^cam\.yaml(:\d+:\d+)?: |^camgeo: ")


def sound(rng: Random, number: int) -> Attack:
    """A disc cam by chance, exported; its drawing is felt by brute force."""
    cam = drawn(rng)
    files = [
        "{dxf: {as: " + rng.choice(["arcs", "polyline", "spline"]) + "}}",
        *rng.sample(FORMS[1:7], rng.randrange(3)),
        *rng.choice([[], [], ["{sheet: {profile: 0.02}}"], ["{sheet: {finish: {contour: Ra 0.8}}}"]]),
    ]

    def judge(done: Done, folder: Path) -> list[str]:
        path = folder / "out" / "cam" / "cam.dxf"
        return wrong_verdict(cam, done, path) if done.status == 0 else []

    words = ("export", "cam.yaml", "--json")
    return Attack(f"disc {number}", words, {"cam.yaml": cam.text(", ".join(files)).encode()}, (0, 1, 2), judge)


def of_any_kind(rng: Random, number: int) -> Attack:
    """A recipe of `benchmarks/random_recipes.py`: cams of every kind, parts, linkages, sets, programs."""
    benchmarks = str(ROOT / "benchmarks")
    if benchmarks not in sys.path:
        sys.path.append(benchmarks)
    made = importlib.import_module("random_recipes").made(rng.randrange(10**6), rng.randrange(140))
    command = rng.choice([("check", "cam.yaml", "-v"), ("export", "cam.yaml", "--json"), ("report", "cam.yaml")])
    seconds = SLOW_TOPICS.get(made.topic, 0.0)
    attack = Attack(f"{made.family} {made.topic} {number}", command, {"cam.yaml": made.text.encode()})
    return Attack(attack.name, command, attack.files, seconds=max(seconds, attack.seconds))


# --- wrong recipes ----------------------------------------------------------------------------------------------------


@cache
def bases() -> tuple[str, ...]:
    """Recipes to spoil: the starters and the shipped ones that need no other file and no search."""
    texts = [starter(kind) for kind in OF_CAMS if kind != "sweep"]
    texts += [path.read_text(encoding="utf-8") for path in SHIPPED]
    return tuple(text for text in texts if "table:" not in text and "\nsweep:" not in text and "parts: all" not in text)


def lighter(data: dict[str, Any], rng: Random) -> dict[str, Any]:
    """The recipe with a file or two of its own, so that a run is short."""
    files = rng.sample(["dxf", "stl", "svg", "csv", *SHEETS], rng.randrange(1, 3))
    data.setdefault("export", {})["files"] = copy.deepcopy(files)  # what comes after spoils them
    data["verify"] = {**data.get("verify", {}), "angles": 360}
    return data


VALUES: list[Any] = ["nought", [], {}, True, None, -1, 0, 1e300, 1e-300, float("nan"), float("inf"), "1_0", 10**400, ""]
VALUES += ["1/0", {"a": 1}, "x" * 5000, "\u00e4\u0000\u202e", [[]], "12 mm", "3 in", "-5 deg", "1e5", "0x10", [1, 2, 3]]
VALUES += [
    "t",
    "sin(",
    "__import__('os')",
    "1" * 4000,
    -0.0,
    0.5,
    7,
    360,
    "yes",
    "~",
    "&a",
    "2001-01-01",
    "9" * 30 + "**9",
]


def misspelled(rng: Random, data: dict[str, Any]) -> str | None:
    """Swap, drop or double a letter of a key; gives the new key."""
    keys = [
        path for path in leaves(data) if isinstance(path[-1], str) and len(path[-1]) >= 5 and path[-1].isidentifier()
    ]
    path = rng.choice(keys)
    key, at = path[-1], rng.randrange(1, len(path[-1]) - 1)
    if key == "about" or "vary" in path:
        return None
    new = rng.choice([key[:at] + key[at + 1 :], key[:at] + key[at] + key[at:], key + "x"])
    where = holder(data, path)
    rows = [(new if k == key else k, v) for k, v in where.items()]
    where.clear()
    where.update(rows)
    return new


def placed(done: Done, _: Path) -> list[str]:
    """Say which lines of an error do not say where it is."""
    if done.status != 2:
        return []
    lines = [line for line in done.err.splitlines() if not PLACED.match(line)]
    return [f"words: no place in {line[:200]!r}" for line in lines[:1]]


def wrong(rng: Random, number: int) -> Attack:
    """A sound recipe, spoilt in one to three ways."""
    data = lighter(copy.deepcopy(yaml.safe_load(rng.choice(bases()))), rng)
    way = rng.choice(["typo", "value", "value", "value", "missing", "extreme", "extreme", "text", "deep"])
    statuses: tuple[int, ...] = (0, 1, 2)
    judge: Judge = placed
    if way == "typo":
        new = misspelled(rng, data)
        statuses = (2,) if new else statuses
        judge = _names(new) if new else placed
    for _ in range(rng.choice([1, 1, 2, 3])):
        path = rng.choice(list(leaves(data)))
        where = holder(data, path)
        if way == "value":
            where[path[-1]] = copy.deepcopy(rng.choice(VALUES))
        elif way == "missing":
            del where[path[-1]]
        elif way == "extreme":
            numbers = [p for p in leaves(data) if type(holder(data, p)[p[-1]]) in {int, float}]
            path = rng.choice(numbers)
            where = holder(data, path)
            where[path[-1]] = where[path[-1]] * rng.choice([-1, 0, 1e-9, 1e-3, 0.1, 10, 1e3, 1e9, 1e150])
    text = yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=10**6)
    raw = text.encode("utf-8", "surrogatepass")
    if way == "text":
        raw, judge = spoilt_text(rng, raw), placed
    elif way == "deep":
        raw = rng.choice([deep_list, aliases, many_keys])() + raw
    words = rng.choice([("check", "cam.yaml"), ("check", "cam.yaml", "--json"), ("export", "cam.yaml")])
    return Attack(f"{way} {number}", words, {"cam.yaml": raw}, statuses, nothing_more if "--json" in words else judge)


def of_the_schema(rng: Random, number: int) -> Attack:
    """Keys by chance from the schema, of all sections together, sound and wrong."""
    raw = by_schema(rng, rng.choice(["cam", "cam", "cam", "cam", *roots.folders()])).encode()
    return Attack(f"schema {number}", ("check", "cam.yaml"), {"cam.yaml": raw}, (0, 1, 2), placed, LONG)


def _names(key: str) -> Judge:
    def judge(done: Done, folder: Path) -> list[str]:
        found = placed(done, folder)
        return found if key in done.err else [*found, f"words: {key!r} is not named in {done.err[:200]!r}"]

    return judge


def spoilt_text(rng: Random, raw: bytes) -> bytes:
    """Damage the text itself: bytes, lines, indents."""
    lines = raw.split(b"\n")
    at = rng.randrange(len(lines))
    way = rng.randrange(7)
    if way == 0:
        place = rng.randrange(len(raw))
        return raw[:place] + rng.randbytes(rng.randrange(1, 6)) + raw[place:]
    if way == 1:
        lines.insert(at, lines[at])
    elif way == 2:
        lines[at] = b" " * rng.randrange(1, 4) + lines[at]
    elif way == 3:
        lines[at] = b"\t" + lines[at]
    elif way == 4:
        return raw[: rng.randrange(len(raw))]
    elif way == 5:
        return rng.choice([b"\xff\xfe", b"\xef\xbb\xbf", b"\x00", b"---\n---\n", b"%YAML 9.9\n---\n"]) + raw
    else:
        return raw.replace(b"\n", rng.choice([b"\r", b"\r\n", b"\xe2\x80\xa8"]))
    return b"\n".join(lines)


def deep_list() -> bytes:
    return b"about: " + b"[" * 3000 + b"]" * 3000 + b"\n"


def aliases() -> bytes:
    rows = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    rows += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 12)]
    return "\n".join(rows).encode() + b"\n"


def many_keys() -> bytes:
    return b"".join(b"k%d: 1\n" % k for k in range(20_000))
