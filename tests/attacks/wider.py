"""Disc cams with all that a recipe may hold besides, tables, sizing, searches, and files that cost."""

from __future__ import annotations

import io
import re
import struct
import zipfile
from typing import TYPE_CHECKING

import numpy as np

from attacks.cams import drawn
from attacks.outcome import Attack
from attacks.tables import with_motion

if TYPE_CHECKING:
    from random import Random


LONG = 60.0  # s: a set of bodies is moved against one another, a search makes many designs


def sized(rng: Random, number: int) -> Attack:
    """A cam whose size is found."""
    cam = drawn(rng)
    limits = []
    if rng.random() < 0.8:
        angle = f"at_most: {rng.uniform(10, 50):.2f}" + (
            f", on_return: {rng.uniform(10, 60):.2f}" if rng.random() < 0.5 else ""
        )
        limits.append(f"pressure-angle: {{{angle}}}")
    if rng.random() < 0.6 or not limits:
        limits.append(f"radius-of-curvature: {{at_least: {rng.uniform(1, 60):.2f}}}")
    text = cam.text("dxf").replace(f"base_radius: {cam.base!r}", f"sizing: {{{', '.join(limits)}}}")
    if rng.random() < 0.7:
        text = re.sub(r"(offset|pivot): [-\d.e]+, |, (offset): [-\d.e]+", "", text)
    return Attack(
        f"sized {number}", (rng.choice(["export", "check"]), "cam.yaml"), {"cam.yaml": text.encode()}, (0, 1, 2)
    )


def dropped(rng: Random, number: int) -> Attack:
    """A cam whose quickest stroke is found, by limits of any kind; some leave nothing, or contradict one another."""
    cam = drawn(rng)
    law, stroke = rng.choice(["cycloidal", "modified-sine", "harmonic", "cubic", "parabolic"]), rng.uniform(0.5, 30)
    words = [rng.choice(["least"] * 12 + ["rest", "40"]), rng.choice(["rest"] * 12 + ["least", "60"])]
    rise = f"{{rise: {stroke:.3f}, over: {rng.uniform(20, 340):.2f}, law: {law}}}"
    back = f"{{return: {stroke:.3f}, over: {words[0]}, law: {law}}}"
    motion = [rise, back, f"{{dwell: {words[1]}}}"]
    rng.shuffle(motion)
    bounds = [
        f"pressure-angle: {{at_most: {rng.uniform(5, 80):.2f}}}",
        f"peak-acceleration: {{at_most: {10 ** rng.uniform(0, 4):.4g}}}",
        f"pitch-radius: {{at_least: {rng.uniform(0, 40):.2f}}}",
        f"size: {{at_most: {rng.uniform(10, 100):.2f}}}",
        f"duration: {{at_most: {rng.uniform(100, 700):.1f}, at_lift: {rng.uniform(0, 3):.2f}}}",
        "pieces: {at_most: 40}",
        "contact-force-least: {at_least: 5}",
    ]
    text = with_motion(cam.text(rng.choice(["dxf", "stl"])), f"[{', '.join(motion)}]")
    text += f"limits: {{{', '.join(rng.sample(bounds, rng.randrange(1, 3)))}}}\n"
    if "contact-force" in text:
        text += f"dynamics: {{mass: 0.3, preload: 80, rpm: {rng.uniform(10, 900):.1f}}}\n"
    call = rng.choice(["export", "check", "report"])
    return Attack(f"dropped {number}", (call, "cam.yaml"), {"cam.yaml": text.encode()}, (0, 1, 2), seconds=15.0)


FEATURES = [
    "bolts: {count: 3, circle: 24, hole: 3}",
    "hub: {diameter: 14, height: 8}",
    "chamfer: 0.4",
    "mark: {}",
    "mark: {width: 60}",
    "mark: {as: engrave, length: 3}",
    "keyway: din6885",
    "keyway: {standard: din6885, fit: P9}",
    "keyway: {standard: jis-b1301, fit: JS9, at: 200}",
    "lightening: {ring: 5, wall: 3}",
    "wall: 60",
    "dowel: {circle: 22, hole: 3}",
    "flat: {across: 7}",
    "set_screw: {diameter: 3}",
]
LOADS = ["40*sin(t)", "1e12*cos(t)", "5e12", "-1e60", "1e300*t*1e300", "1/(t - 1)", "1e11/(1.0001 + sin(t))"]
SPRINGS = (
    "spring: {seat_length: 40, free_length: 48, rate: 30 N/mm}",
    "spring: {seat_length: 40, loads: [[32, 480], [44, 120]], solid_length: 39.9}",
    "spring: {seat_length: 40, loads: [[32, 480], [32, 120]]}",
    "spring: {seat_length: 60, free_length: 48, rate: 1e-9}",
)
GUIDED = "guide: {overhang: 40, length: 50, friction: 0.1}"
MILLING = "manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 3, safe_height: 5}\n"
MOTIONS = [
    "{formula: 3*(1 - cos(t))}",
    "{formula: 3*(1 - cos(4000*t))}",
    "{formula: 2*sin(t)**4}",
    "[{rise: 5, over: 120, law: {uniform: {blend: [10, 20]}}}, {return: 5, over: 90}, {dwell: 150}]",
    "[{rise: 5, over: 120, law: {points: [[0, 0], [0.4, 0.2], [1, 1]]}}, {return: 5, over: 240, law: cycloidal}]",
    "[{rise: 5, over: 120, law: {uniform: {blend: 90}}}, {return: 5, over: 240, law: cycloidal}]",
    "[{rise: 5, over: 180, law: {table: [[0, 0], [0.3, 0.2], [0.7, 0.8], [1, 1]], reading: 0.01}}, {dwell: 180}]",
    "{points: [[0, 0], [90, 6], [120, 6], [250, 0]]}",
    "{lobe: {lift: 8, half: 68, powers: [2, 8, 14, 20, 26]}}",
    "{lobe: {lift: 8, duration: [{at_lift: 1.27, degrees: 226}, {at_lift: 0.15, degrees: 274}]}}",
    "{repeat: 3, segments: [{rise: 3, over: 50, law: cycloidal}, {return: 3, over: 50, law: cycloidal}, {dwell: 20}]}",
    "[{rise: 5, over: 120, law: {polynomial: [0, 0, 3, -2]}}, {return: 5, over: 120, law: cubic}, {dwell: 120}]",
]


def furnished(rng: Random, number: int) -> Attack:
    """A disc cam with features, a train, limits, a set or a program."""
    cam, seconds, files, more = drawn(rng), 5.0, ["dxf", "stl"], ""
    text = cam.text("FILES")
    if rng.random() < 0.5:
        text = with_motion(text, rng.choice(MOTIONS))
    way = rng.choice(["part", "part", "set", "train", "rigid", "limits", "program", "ring", "trim"])
    if way == "part":
        text = text.replace("bore: 8}", "bore: 8, " + ", ".join(rng.sample(FEATURES, rng.randrange(1, 4))) + "}")
        files = rng.sample(["dxf", "svg", "stl", "ply", "3mf", "glb"], 2)
    elif way == "set":
        files, seconds = ["{" + rng.choice(["stl", "ply", "3mf", "glb"]) + ": {parts: all}}"], LONG
        text = text.replace(f"tolerance: {cam.tolerance!r}", "tolerance: 0.01")
    elif way == "train":
        transient = ", transient: true" if rng.random() < 0.3 else ""
        more = f"dynamics: {{mass: {rng.uniform(0.01, 2):.3g}, stiffness: {10 ** rng.uniform(3, 12):.3g}, damping: "
        more += f"{rng.choice([0, 20, 1000])}, preload: {10 ** rng.uniform(-1, 4):.3g}, "
        more += f"rpm: {10 ** rng.uniform(0, 4):.3g}{transient}}}\n"
        seconds = 10.0 if transient else seconds
    elif way == "rigid":
        more = f"dynamics: {{mass: {10 ** rng.uniform(-3, 9):.3g}, rpm: {10 ** rng.uniform(0, 5):.3g}, "
        more += rng.choice(["preload: 300", "preload: 1e12", "least_force: 5", *SPRINGS])
        more += f", load: {rng.choice(LOADS)}" * rng.randrange(2) + rng.choice(["", f", {GUIDED}"])
        more += rng.choice(["", ", material: steel", f", material: steel, width: {rng.uniform(0.5, 12):.3g}"]) + "}\n"
        text = text.replace("bore: 8}", "bore: 8, " + rng.choice(["chamfer: 0.4}", "density: 7850}"]))
        files = ["{csv: {as: forces}}", "html"]
    elif way == "limits":
        figures = [
            "pressure-angle",
            "radius-of-curvature",
            "peak-velocity",
            "peak-jerk",
            "size",
            "wall",
            "motion-error",
            "pieces",
        ]
        figures += [
            "roller-speed",
            "face-width",
            "peak-acceleration",
            "contact-travel",
            "pitch-radius",
            "contour-error",
        ]
        rows = [
            f"{name}: {{{rng.choice(['at_most', 'at_least'])}: {10 ** rng.uniform(-3, 3):.4g}}}"
            for name in rng.sample(figures, 3)
        ]
        more = f"limits: {{{', '.join(rows)}}}\n"
    elif way == "program":
        more, files = MILLING, ["gcode", "{csv: {as: inspection}}"]
    elif way == "ring":
        text = text.replace("follower:", "track: internal, follower:").replace("bore: 8", f"outer: {4 * cam.base + 60}")
    elif way == "trim":
        text = text.replace("kind: disc", "kind: disc, undercut: trim")
        text = text.replace(f"base_radius: {cam.base!r}", f"base_radius: {rng.uniform(2, 15):.3f}")
    else:
        files = [
            rng.choice(
                ["{dxf: {as: spline}}", "{svg: {as: spline}}", "{csv: {as: contacts}}", "{csv: {as: polar}}", "html"]
            )
        ]
    text = text.replace("FILES", ", ".join(files)) + more
    words = (rng.choice(["export", "check", "export"]), "cam.yaml", *rng.sample(["-v"], rng.randrange(2)))
    return Attack(f"disc {way} {number}", words, {"cam.yaml": text.encode()}, (0, 1, 2), seconds=seconds)


def searched(rng: Random, number: int) -> Attack:
    """A small search, or a study."""
    cam = drawn(rng)
    if rng.random() < 0.3:
        words = ("study", "cam.yaml", "--form", rng.choice(["polyline", "stl"]), "--patience", "0.05")
        return Attack(f"study {number}", words, {"cam.yaml": cam.text("dxf").encode()}, (0, 1, 2, 3), seconds=LONG)
    axis = rng.choice(
        ["cam.base_radius", "cam.base_radius", "cam.motion[0].over", "cam.follower.radius", "part.bore", "cam.x"]
    )
    span = rng.choice(
        ["{from: 20, to: 60, steps: 5}", "{from: 60, to: 20, steps: 3}", "{from: 0, to: 0, steps: 2}", "[30, 40]", "[]"]
    )
    rank = rng.choice(["size", "pressure-angle", "peak-jerk", "radius-of-curvature", "nothing"])
    text = cam.text("dxf", f"sweep: {{vary: {{{axis}: {span}}}, rank: {rank}, keep: 2}}\n")
    return Attack(f"sweep {number}", ("sweep", "cam.yaml", "--jobs", "1"), {"cam.yaml": text.encode()}, seconds=LONG)


# needs: budget
BUDGETED = (
    "profile",
    "angle",
    "bore",
    "shaft",
    "pivot",
    "guide",
    "face",
    "follower.radius",
    "follower.offset",
    "breadth",
)


# needs: budget
def budgeted(rng: Random, number: int) -> Attack:
    """A budget of some dimensions by chance, some of them free, with fits, a zero, or words that the cam has not."""
    cam = drawn(rng)
    sizes = ["0.01"] * 12 + ["0", "2", "1e-9", "-1", "nan"]
    words = rng.sample(BUDGETED[:4], 2) + rng.choice([[], [], [], [rng.choice(BUDGETED)], ["motion", "x"]])
    tolerances = ", ".join(f"{word}: {rng.choice(sizes)}" for word in dict.fromkeys(words))
    if rng.random() < 0.3:
        tolerances = tolerances.replace("0.01", "free", 1)
    ways = ["zero: 40", "zero: none", "sum: rss", "sum: rss", "play: 0.1", "guide: 80", "exponent: 2"]
    ways += ["cost: {profile: 2, angle: 1}", "cost: {profile: 2, angle: 1}, exponent: 3"]
    more = rng.sample(ways, rng.choice([0, 0, 1, 1, 2]))
    options = "".join(f", {option}" for option in [*more, f"runs: {rng.choice([0, 50, 500])}"])
    permitted = rng.choice(["0.05", "0.5", "1e-9", "100"])
    text = cam.text("dxf", f"budget: {{permitted: {permitted}, tolerances: {{{tolerances}}}{options}}}\n")
    if rng.random() < 0.2:
        text = text.replace("bore: 8}", "bore: {diameter: 8, fit: H7}}").replace("budget: {", "budget: {fit: g6, ")
    elif rng.random() < 0.2:
        hub, own = rng.choice(["JS9", "P9", "H9"]), rng.choice(["din6885", "{standard: din6885, fit: P9}"])
        text = text.replace("bore: 8}", f"bore: {{diameter: 8, fit: H7}}, keyway: {own}}}")
        text = text.replace("budget: {", f"budget: {{fit: h6, key: {{hub: {hub}, shaft: P9}}, ")
    call = ("budget", "cam.yaml", *rng.choice([(), (), ("--json",), ("cam.yaml",), ("a-1.dxf", "a-2.dxf")]))
    return Attack(f"budget {number}", call, {"cam.yaml": text.encode()}, (0, 1, 2))


def on_a_shaft(rng: Random, number: int) -> Attack:
    """A camshaft of one cam by chance, several times, with an engine or without, and its diagrams, tables and page."""
    engine = rng.random() < 0.6
    order = list(range(1, rng.choice([1, 2, 3, 4, 6]) + 1))
    rng.shuffle(order)
    rows, z = [], 2.0
    for _ in range(rng.randrange(1, 6)):
        long, gap = rng.choice([4, 4, 8, 8, 0.1, 12.5]), rng.choice([0, 1, 1, 2.5, 2.5, 2.5, 1e-9, -1])
        named = f"cylinder: {rng.choice([*order, *order, *order, 9])}, valve: {rng.choice(['intake', 'exhaust'])}"
        place = named if engine and rng.random() < 0.8 else f"at: {rng.choice([0, 33.3, -120, 359.9999, 360])}"
        turned = rng.choice(["", "", ", direction: 90"])
        rows.append(f"    - {{recipe: cam.yaml, {place}, z: {z:.9g}, length: {long}{turned}}}\n")
        z += long + gap
    centres = [f"intake: {rng.randrange(60, 140)}, exhaust: {rng.randrange(60, 140)}"]
    centres += [f"separation: {rng.choice([110, 400])}, advance: {rng.randrange(-9, 9)}", "intake: 110, advance: 4"]
    about = f"{rng.choice(centres)}, lift: {rng.choice([1, 1, 0.1, 0.5, 0, 50])}"
    given = f"  engine: {{order: {order}, {about}}}\n" if engine else ""
    forms = ["timing", "bars", "shaft", *(["cam-wheel", "crank-wheel"] if engine or rng.random() < 0.1 else [])]
    forms += ["arcs"] if rng.random() < 0.05 else []
    files = [f"{{svg: {{as: {form}}}}}" for form in rng.sample(forms, rng.randrange(1, 4))]
    files += rng.sample(["html", "{csv: {as: events}}", "{csv: {as: motion}}", "glb", "stl"], rng.randrange(3))
    bore = rng.choice(["", "", ", bore: 4"])
    text = (
        f"units: {rng.choice(['mm', 'mm', 'mm', 'inch'])}\nrotation: {rng.choice(['cw', 'ccw'])}\ncamshaft:\n"
        f"  shaft: {{diameter: {rng.choice([6, 12, 80])}, to: {z + 3:.9g}{bore}}}\n  lobes:\n{''.join(rows)}{given}"
        f"export: {{tolerance: 0.01, files: [{', '.join(dict.fromkeys(files))}]}}\nverify: {{angles: 90}}\n"
    )
    made = {"cam.yaml": drawn(rng).text("dxf").encode(), "shaft.yaml": text.encode()}
    return Attack(f"camshaft {number}", (rng.choice(["export", "check"]), "shaft.yaml"), made, (0, 1, 2), seconds=LONG)


# --- files that cost --------------------------------------------------------------------------------------------------


MODEL = '<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="80mm" viewBox="-40 -40 80 80">'


def zipped(model: str) -> bytes:
    link = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" '
    link += 'Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", link)
        archive.writestr("3D/3dmodel.model", model)
    return stream.getvalue()


def components(deep: int, wide: int) -> bytes:
    """Objects of many components of the one before."""
    corners = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
    faces = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
    )
    body = f'<object id="1"><mesh><vertices>{corners}</vertices><triangles>{faces}</triangles></mesh></object>'
    for k in range(2, deep + 2):
        row = f'<component objectid="{k - 1}"/>' * wide
        body += f'<object id="{k}"><components>{row}</components></object>'
    return zipped(f'{MODEL}{body}</resources><build><item objectid="{deep + 1}"/></build></model>')


def bomb(rng: Random, number: int) -> Attack:
    """A file that is small, or plain, and costs."""
    way = rng.choice(
        [
            "3mf",
            "3mf loose",
            "svg path",
            "svg groups",
            "dxf points",
            "dxf blocks",
            "step",
            "stl",
            "ngc",
            "table",
            "yaml",
        ]
    )
    files = {"cam.yaml": drawn(rng).text("dxf", MILLING).encode()}
    some = rng.choice([3_000, 30_000, 120_000])
    around = np.column_stack(
        [30.0 * np.cos(np.arange(some) * 2 * np.pi / some), 30.0 * np.sin(np.arange(some) * 2 * np.pi / some)]
    )
    if way == "3mf":
        name, raw = "cam.3mf", components(rng.choice([3, 12, 400]), 10)
    elif way == "3mf loose":
        head = f'{MODEL}<object id="1"><mesh>'
        rows = '<vertex x="1" y="2" z="3"/>' * some
        name, raw = (
            "cam.3mf",
            zipped(f"{head}<vertices>{rows}</vertices><triangles/></mesh></object></resources><build/></model>"),
        )
    elif way == "svg path":
        points = " ".join(f"{x:.6f},{y:.6f}" for x, y in around)
        name, raw = (
            "cam.svg",
            f'{SVG}<path d="M {points} Z"/></svg>'.encode(),
        )
    elif way == "svg groups":
        deep = rng.choice([100, 3_000, 30_000])
        name, raw = (
            "cam.svg",
            f'<svg xmlns="http://www.w3.org/2000/svg">{"<g>" * deep}<circle r="5"/>{"</g>" * deep}</svg>'.encode(),
        )
    elif way in {"dxf points", "dxf blocks"}:
        points = "".join(f"10\n{x:.6f}\n20\n{y:.6f}\n" for x, y in around)
        body = f"0\nLWPOLYLINE\n100\nAcDbEntity\n8\nCUT\n100\nAcDbPolyline\n90\n{some}\n70\n1\n{points}"
        if way == "dxf blocks":
            body = "0\nCIRCLE\n8\nCUT\n10\n0\n20\n0\n40\n30\n" * (some // 10)
        name, raw = "cam.dxf", f"0\nSECTION\n2\nENTITIES\n{body}0\nENDSEC\n0\nEOF\n".encode()
    elif way == "step":
        points = "".join(f"#{k + 10}=CARTESIAN_POINT('',({x:.6f},{y:.6f},0.));\n" for k, (x, y) in enumerate(around))
        name, raw = "cam.step", f"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n{points}ENDSEC;\nEND-ISO-10303-21;\n".encode()
    elif way == "stl":
        records = np.zeros(some, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
        records["corners"] = np.random.default_rng(number).normal(size=(some, 3, 3))
        name, raw = "cam.stl", bytes(80) + struct.pack("<I", some) + records.tobytes()
    elif way == "ngc":
        name, raw = (
            "cam.ngc",
            ("G21 G90\n" + "".join(f"G1 X{x:.5f} Y{y:.5f} F100\n" for x, y in around) + "M30\n").encode(),
        )
    elif way == "table":
        rows = "".join(f"{k * 360 / some:.6f};{rng.random():.3f}\n" for k in range(some))
        files = {"cam.yaml": with_motion(drawn(rng).text("dxf"), "{table: cam.csv}").encode()}
        name, raw = "cam.csv", rows.encode()
    else:
        deep = rng.choice([100, 5_000])
        name, raw = "cam.yaml", b"cam: " + b"{a: " * deep + b"1" + b"}" * deep
    words = ("check", "cam.yaml") if name in {"cam.csv", "cam.yaml"} else ("verify", "cam.yaml", name)
    return Attack(f"bomb {way} {some} {number}", words, {**files, name: raw}, (1, 2))
