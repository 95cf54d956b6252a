"""Files of sound cams, altered and given to `verify`: what must fail, what must pass, and what brute force says."""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
from support.heavy import ezdxf

from attacks.cams import Cam, drawn, wrong_verdict
from attacks.outcome import Attack, nothing_more
from camgeo.registry import registry
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from collections.abc import Callable

    from attacks.outcome import Done

CAMS = 12  # cams whose files are altered, of so many attacks
SHARED = 400
KINDS = ("dxf", "dxf", "dxf", "svg", "stl", "ply", "3mf", "step", "ngc")
MILLING = "manufacture: {cutter: 4, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 6, safe_height: 5}\n"
FAILS, PASSES, ANY = (1,), (0,), (0, 1, 2)


@dataclass(frozen=True)
class Spoilt:
    """A file's bytes after an alteration, by name, and the exit statuses that are right; `mm` in its unit."""

    name: str
    raw: bytes
    statuses: tuple[int, ...] = ANY
    mm: float = 1.0


@lru_cache(maxsize=2 * CAMS)
def exported(share: int, number: int) -> tuple[Cam, dict[str, bytes]]:
    """A sound cam and its files by suffix, `yaml` among them; the same for the same numbers."""
    import camgeo

    for attempt in range(40):
        rng = Random(f"cam {share} {number} {attempt}")
        cam = drawn(rng)
        files = [f"{{dxf: {{as: {rng.choice(['arcs', 'polyline'])}}}}}", "svg", "stl", "ply", "3mf"]
        files += ["step"] if number == 0 else ["gcode"] if number % 2 and "gcode" in FORMATS else []
        text = cam.text(", ".join(files), MILLING)
        with TemporaryDirectory() as folder:
            path = Path(folder) / "cam.yaml"
            path.write_text(text, encoding="utf-8")
            try:
                report = camgeo.export(camgeo.load(path), Path(folder) / "out")
            except camgeo.CamgeoError:
                continue
            if not report.ok:
                continue
            made = {file.suffix[1:]: file.read_bytes() for file in (Path(folder) / "out" / "cam").iterdir()}
        return cam, {**made, "yaml": text.encode()}
    raise AssertionError("no cam by chance could be made")


def altered(rng: Random, number: int) -> Attack:
    """One file of a sound cam, altered, and verified by its recipe."""
    cam, files = exported(number // SHARED, rng.randrange(CAMS))
    kind = rng.choice([kind for kind in KINDS if kind in files])
    change = rng.choice(CHANGES[kind])
    spoilt = change(rng, files[kind], cam)
    name = f"cam.{kind}"

    def judge(done: Done, folder: Path) -> list[str]:
        return wrong_verdict(cam, done, folder / name, spoilt.mm)

    words = ["verify", "cam.yaml", name, "--json"]
    if rng.random() < 0.1 and kind != "ngc" and "second_opinion" in registry.labels():
        words.append("--second-opinion")
    given = {"cam.yaml": files["yaml"], name: spoilt.raw}
    title = f"{kind} {spoilt.name} {number}"
    return Attack(title, tuple(words), given, spoilt.statuses, judge if kind == "dxf" else nothing_more)


# --- any file ---------------------------------------------------------------------------------------------------------


def garbled(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    """Some bytes replaced."""
    changed = bytearray(raw)
    for _i in range(rng.choice([1, 3, 30])):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return Spoilt("garbled", bytes(changed))


def truncated(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    return Spoilt("truncated", raw[: int(len(raw) * rng.uniform(0.0, 0.93))], FAILS)


def noise(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    kinds = [
        b"",
        b"\x00" * 1000,
        rng.randbytes(rng.randrange(1, 5000)),
        raw[::-1],
        b"solid\n",
        b"<svg/>",
        b"PK\x03\x04",
    ]
    return Spoilt("noise", rng.choice(kinds), FAILS)


def digits(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    """A number of the text replaced by one that is none, or far too large."""
    places = list(re.finditer(rb"-?\d+\.\d+", raw))
    if not places:
        return Spoilt("digits", raw)
    spot = rng.choice(places)
    other = rng.choice(
        [b"nan", b"inf", b"1e999", b"-1e300", b"0", b"1_0", b"--1", b"1e-320", b"", b"9" * 400, b"0x1p3"]
    )
    return Spoilt("digits", raw[: spot.start()] + other + raw[spot.end() :])


# --- DXF --------------------------------------------------------------------------------------------------------------


def _opened(raw: bytes) -> tuple[Any, Any]:
    document = ezdxf.read(io.StringIO(raw.decode("utf-8")))
    (outline,) = document.modelspace().query("LWPOLYLINE[layer=='CUT']")
    return document, outline


def _saved(document: Any) -> bytes:
    stream = io.StringIO()
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no clock, no number by chance
    try:
        document.write(stream)
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before
    return stream.getvalue().encode("utf-8", "surrogateescape")


def points_changed(rng: Random, raw: bytes, cam: Cam) -> Spoilt:
    """Vertices or bulges moved, taken away or all of them transformed; brute force says what must not pass."""
    document, outline = _opened(raw)
    rows = np.array(outline.get_points("xyb"))
    at, tol = rng.randrange(len(rows)), cam.tolerance
    way = rng.choice(["vertex", "vertices", "bulge", "removed", "scaled", "turned", "mirrored", "shifted", "bulges"])
    by = tol * 10 ** rng.uniform(-1.0, 2.5)
    angle = rng.uniform(0.0, 2 * math.pi)
    statuses: tuple[int, ...] = ANY
    if way == "vertex":
        rows[at, :2] += by * np.array([math.cos(angle), math.sin(angle)])
    elif way == "vertices":
        count = rng.randrange(2, 20)
        rows[np.arange(at, at + count) % len(rows), :2] *= 1.0 + by / cam.base
    elif way == "bulge":
        rows[at, 2] = rows[at, 2] * rng.uniform(0.2, 3.0) + rng.choice([0.0, by / 10.0])
    elif way == "bulges":
        rows[:, 2] *= 1.0 + by
    elif way == "removed":
        rows = np.delete(rows, at, axis=0)
    elif way == "scaled":
        share = rng.choice([1, -1]) * by / cam.base
        rows[:, :2] *= 1.0 + share
        statuses = FAILS if by > 3.0 * tol else ANY
    elif way == "turned":
        turn = by / cam.base
        rows[:, :2] = rows[:, :2] @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    elif way == "mirrored":
        rows[:, 1] *= -1.0
        rows[:, 2] *= -1.0
    else:
        rows[:, :2] += by * np.array([math.cos(angle), math.sin(angle)])
        statuses = FAILS if by > 3.0 * tol else ANY
    outline.set_points(rows.tolist(), format="xyb")
    return Spoilt(f"dxf {way}", _saved(document), statuses)


def made_wrong(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    """Faults that no follower need feel."""
    document, outline = _opened(raw)
    space = document.modelspace()
    way, mm = rng.choice(["units", "bore", "no bore", "hole", "beside", "twice", "open", "line"]), 1.0
    if way == "units":
        document.header["$INSUNITS"], mm = rng.choice([(1, 25.4), (2, 304.8), (5, 10.0), (6, 1000.0)])
    elif way in {"bore", "no bore"}:
        (bore,) = space.query("CIRCLE[layer=='BORE']")
        if way == "bore":
            bore.dxf.center = (0.2, 0.0)
        else:
            space.delete_entity(bore)
    elif way == "hole":
        space.add_circle((0.0, 9.0), 2.0, dxfattribs={"layer": "BORE"})
    elif way == "beside":
        space.add_circle((500.0, 0.0), 5.0, dxfattribs={"layer": "CUT"})
    elif way == "twice":
        space.add_lwpolyline(list(outline.get_points("xyb")), format="xyb", close=True, dxfattribs={"layer": "CUT"})
    elif way == "line":
        space.add_line((100.0, 0.0), (120.0, 0.0), dxfattribs={"layer": "CUT"})
    else:
        outline.closed = False
    return Spoilt(f"dxf {way}", _saved(document), FAILS, mm)


def saved_again(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    """The same contour as another program may write it."""
    document, outline = _opened(raw)
    rows = list(outline.get_points("xyb"))
    way = rng.choice(["start", "backwards", "lines and arcs", "inches", "block", "frame", "no header"])
    mm = 1.0
    if way == "start":
        at = rng.randrange(len(rows))
        outline.set_points(rows[at:] + rows[:at], format="xyb")
    elif way == "backwards":
        points, bulges = [row[:2] for row in rows[::-1]], [-row[2] for row in rows[::-1]]
        bulges = bulges[1:] + bulges[:1]
        outline.set_points([(*p, b) for p, b in zip(points, bulges, strict=True)], format="xyb")
    elif way == "lines and arcs":
        outline.explode()
    elif way == "inches":
        for entity in document.modelspace():
            entity.scale_uniform(1.0 / 25.4) if hasattr(entity, "scale_uniform") else None
        document.header["$INSUNITS"], mm = 1, 25.4
    elif way == "frame":
        document.layout("Layout1").add_circle((0.0, 0.0), 5.0, dxfattribs={"layer": "CUT"})
    elif way == "no header":
        saved = _saved(document)
        head = saved.index(b"HEADER")
        cut = saved[: saved.rindex(b"  0", 0, head)] + saved[saved.index(b"ENDSEC", head) + len(b"ENDSEC\n") :]
        return Spoilt("dxf no header", cut, FAILS)
    else:
        block = document.blocks.new("PART")
        for entity in list(document.modelspace().query("*[layer=='CUT' | layer=='BORE']")):
            document.modelspace().unlink_entity(entity)
            block.add_entity(entity)
        document.modelspace().add_blockref("PART", (0.0, 0.0))
    return Spoilt(f"dxf {way}", _saved(document), PASSES, mm)


# --- SVG --------------------------------------------------------------------------------------------------------------


def svg_changed(rng: Random, raw: bytes, cam: Cam) -> Spoilt:
    text = raw.decode("utf-8")
    way = rng.choice(["units", "scaled", "comment"])
    if way == "units":
        other = re.sub(r'width="([\d.]+)mm" height="([\d.]+)mm"', r'width="\1in" height="\2in"', text)
        return Spoilt("svg units", other.encode(), FAILS if other != text else ANY)
    if way == "comment":
        return Spoilt("svg comment", text.replace("</svg>", "<!-- saved again --></svg>").encode(), PASSES)
    share = 1.0 + rng.uniform(4.0, 200.0) * cam.tolerance / cam.base
    inner = text.replace("<svg", "<svg", 1)
    opened = inner.index(">", inner.index("<svg")) + 1
    other = f'{inner[:opened]}<g transform="scale({share})">{inner[opened:].replace("</svg>", "</g></svg>")}'
    return Spoilt("svg scaled", other.encode(), FAILS)


# --- meshes -----------------------------------------------------------------------------------------------------------


def _triangles(raw: bytes) -> np.ndarray:
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return np.frombuffer(raw[84:], kind).copy()


def _stl(rows: np.ndarray) -> bytes:
    return bytes(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def stl_changed(rng: Random, raw: bytes, cam: Cam) -> Spoilt:
    rows = _triangles(raw)
    corners = rows["corners"]
    way = rng.choice(
        ["column", "corner", "removed", "flipped", "inside out", "scaled", "inches", "shuffled", "turned", "noise"]
    )
    at = rng.randrange(len(rows))
    by = rng.uniform(4.0, 300.0) * cam.tolerance
    statuses = FAILS
    if way in {"column", "corner"}:
        far = np.hypot(corners[..., 0], corners[..., 1])
        edge = corners[np.unravel_index(rng.choice(np.flatnonzero(far > 0.5 * cam.base)), far.shape)].copy()
        same = (corners[..., :2] == edge[:2]).all(axis=2)
        if way == "corner":
            same &= corners[..., 2] == edge[2]
        corners[same, :2] *= np.float32(1.0 + rng.choice([1, -1]) * by / np.hypot(*edge[:2]))
    elif way == "removed":
        rows = np.delete(rows, at)
    elif way == "flipped":
        corners[at] = corners[at][::-1].copy()
    elif way == "inside out":
        corners[:] = corners[:, ::-1].copy()
    elif way == "scaled":
        corners *= np.float32(1.0 + rng.choice([1, -1]) * by / cam.base)
    elif way == "inches":
        corners /= np.float32(25.4)
    elif way == "turned":
        corners[..., :] = corners[..., [2, 0, 1]].copy()
    elif way == "noise":
        places, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        places[:, 2] += np.float32(1e-9) * np.array([rng.uniform(-1, 1) for _ in places], dtype=np.float32)
        corners[:] = places[numbers].reshape(corners.shape)
        statuses = PASSES
    else:
        rows = rows[rng.sample(range(len(rows)), len(rows))]
        statuses = PASSES
    return Spoilt(f"stl {way}", _stl(rows), statuses)


def _packed(raw: bytes, change: Callable[[str], str]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(raw)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for info in old.infolist():
            text = old.read(info)
            if info.filename.endswith(".model"):
                text = change(text.decode("utf-8")).encode("utf-8", "surrogateescape")
            new.writestr(info.filename, text)
    return stream.getvalue()


def three_mf_changed(rng: Random, raw: bytes, cam: Cam) -> Spoilt:
    way = rng.choice(["units", "removed", "number", "encoding", "scaled", "packed again", "moved"])
    statuses: tuple[int, ...] = FAILS

    def change(text: str) -> str:
        if way == "units":
            return text.replace('unit="millimeter"', 'unit="inch"')
        if way == "removed":
            rows = re.findall(r"<triangle [^>]*/>", text)
            return text.replace(rng.choice(rows), "", 1)
        if way == "encoding":
            other = rng.choice(["rot13", "utf-7", "cp99999", "hex", "base64", "utf-32", "latin-1"])
            return text.replace('encoding="UTF-8"', f'encoding="{other}"').replace(
                'encoding="utf-8"', f'encoding="{other}"'
            )
        if way == "moved":
            place = f"1 0 0 0 1 0 0 0 1 {rng.uniform(-500, 500)} 3 20"
            return text.replace("<item ", f'<item transform="{place}" ') if "transform=" not in text else text
        if way == "scaled":
            share = 1.0 + rng.uniform(4.0, 300.0) * cam.tolerance / cam.base
            return text.replace("<item ", f'<item transform="{share} 0 0 0 {share} 0 0 0 1 0 0 0" ')
        if way == "number":
            spots = list(re.finditer(r'"-?\d+(\.\d+)?"', text))
            spot = rng.choice(spots)
            other = rng.choice(["nan", "1e400", "-1", "99999999999", "", "0x1", "1_0", "\u0661", "1e9"])
            return f'{text[: spot.start()]}"{other}"{text[spot.end() :]}'
        return text

    if way in {"packed again", "moved"}:
        statuses = PASSES
    elif way in {"encoding", "number"}:
        statuses = ANY
    return Spoilt(f"3mf {way}", _packed(raw, change), statuses)


# --- STEP and programs ------------------------------------------------------------------------------------------------


def step_changed(rng: Random, raw: bytes, _: Cam) -> Spoilt:
    text = raw.decode("latin-1")
    way = rng.choice(["metres", "line", "reference", "entity"])
    statuses: tuple[int, ...] = ANY
    if way == "metres":
        text, statuses = text.replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT($,.METRE.)"), FAILS
    elif way == "reference":
        spot = rng.choice(list(re.finditer(r"#\d+", text)))
        text = f"{text[: spot.start()]}#{rng.randrange(3000)}{text[spot.end() :]}"
    else:
        rows = text.split(";\n")
        at = rng.randrange(len(rows))
        rows[at] = "" if way == "line" else rows[rng.randrange(len(rows))]
        text = ";\n".join(rows)
    return Spoilt(f"step {way}", text.encode("latin-1"), statuses)


def program_changed(rng: Random, raw: bytes, cam: Cam) -> Spoilt:
    text = raw.decode("utf-8")
    way = rng.choice(["scaled", "inches", "half", "comment", "words", "line"])
    if way == "scaled":
        share = 1.0 + rng.uniform(5.0, 200.0) * cam.tolerance / cam.base
        text = re.sub(r"([XYIJ])(-?[\d.]+)", lambda m: f"{m[1]}{float(m[2]) * share:.6f}", text)
        return Spoilt("program scaled", text.encode(), FAILS)
    if way == "inches":
        return Spoilt("program inches", text.replace("G21", "G20").encode(), FAILS)
    rows = text.split("\n")
    if way == "half":
        return Spoilt("program half", "\n".join(rows[: len(rows) // 2]).encode(), FAILS)
    at = rng.randrange(len(rows))
    if way == "comment":
        rows.insert(at, "(checked by the night shift)")
        return Spoilt("program comment", "\n".join(rows).encode())
    if way == "line":
        rows.pop(at)
        return Spoilt("program line", "\n".join(rows).encode())
    other = [
        "G92 X3",
        "G41 D1",
        "#1=#2",
        "O100 sub",
        "G2 X1 Y1",
        "N" * 500,
        "G1 X1e400",
        "M98 P1",
        "%",
        "G999999999999",
    ]
    rows.insert(at, rng.choice(other))
    return Spoilt("program words", "\n".join(rows).encode())


CHANGES: dict[str, list[Callable[[Random, bytes, Cam], Spoilt]]] = {
    "dxf": [points_changed, points_changed, points_changed, made_wrong, saved_again, garbled, truncated, noise, digits],
    "svg": [svg_changed, svg_changed, garbled, truncated, noise, digits],
    "ply": [garbled, truncated, noise],
    "stl": [stl_changed, stl_changed, stl_changed, garbled, truncated, noise],
    "3mf": [three_mf_changed, three_mf_changed, garbled, truncated, noise],
    "step": [step_changed, step_changed, garbled, truncated, noise, digits],
    "ngc": [program_changed, program_changed, program_changed, garbled, truncated, noise, digits],
}
