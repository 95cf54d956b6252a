"""Recipes by chance for `same_bytes.py`: every kind of cam, form of file, feature and mechanism, most of them sound.

A recipe comes of three numbers (seed, slot, attempt) alone. The slot decides its family (what kind of cam, given how)
and its topic (what else it has), so that the first hundred slots have every family and every topic several times.
"""

from __future__ import annotations

import importlib.util
import math
from dataclasses import dataclass, field
from random import Random
from typing import Any

import yaml

Fields = dict[str, Any]  # as YAML writes them
INCH = 25.4
LAWS = ["parabolic", "harmonic", "cycloidal", "modified-trapezoid", "modified-sine", "modified-constant-velocity"]
LAWS += ["polynomial-345", "polynomial-4567"]
CUBIC = {"polynomial": [0, 0, 3, -2]}
QUINTIC = {"polynomial": [0, 0, 0, 10, -15, 6]}
FACES = ["face-formula", "face-fourier", "face-bent"]
YOKES = ["yoke-formula", "yoke-fourier", "reuleaux", "hypocycloid", "constant-breadth"]
PAIRS = [f"{kind}-{route}" for kind in ("double-roller", "flat-pair") for route in ("delta", "law", "arc", "rosette")]
FAMILIES = [*FACES, *YOKES, *PAIRS]
LINKED = ["four-bar", "inverted-slider-crank", "slider-crank", "rrr", "rrp", "rpr", "linkage-set"]
TOPICS = ["part", "milling", "set", "dynamics", "compensation", "inspection", "page", "trim", "limits"]
TOPICS += [*LINKED, "solids", "fault"]
TOPICS.append("plate")  # needs: linear
STEP = importlib.util.find_spec("OCP") is not None


@dataclass(frozen=True)
class Made:
    """A recipe's text, and what it was meant to be."""

    name: str
    family: str
    topic: str
    text: str


def made(seed: int, slot: int, attempt: int = 0) -> Made:
    """Give the recipe of a slot; a later attempt has the same family and topic, and other numbers."""
    rounds, place = divmod(slot, len(TOPICS))
    topic = TOPICS[place]
    linked = topic in LINKED
    alike = [each for each in TOPICS if (each in LINKED) == linked]
    families = YOKES[:-1] if linked else FAMILIES
    family = families[(rounds * len(alike) + alike.index(topic)) % len(families)]
    draw = Draw(Random(f"{seed} {slot} {attempt}"), 1.0)
    name = f"r{slot:03}-{attempt}-{family}-{topic}"
    units = draw.rng.choice(["mm", "mm", "inch"])
    draw.unit = INCH if units == "inch" else 1.0
    # needs: linear
    if topic == "plate":
        text = yaml.safe_dump({"units": units, **draw.plate()}, sort_keys=False, width=1000)
        return Made(f"r{slot:03}-{attempt}-{topic}", family, topic, text)
    recipe: Fields = {"units": units, "rotation": draw.rng.choice(["cw", "ccw"])}
    recipe["cam"], room = draw.cam(family, linked=linked)
    if topic == "trim":
        draw.deepen(recipe["cam"], family)
    recipe |= draw.rest(topic, family, room)
    text = yaml.safe_dump(recipe, sort_keys=False, width=1000)
    return Made(name, family, topic, draw.spoilt(text) if topic == "fault" else text)


@dataclass
class Draw:
    """Numbers by chance; lengths are thought of in mm and written in the recipe's unit."""

    rng: Random
    unit: float
    size: float = field(init=False)

    def __post_init__(self) -> None:
        self.size = self.rng.uniform(0.6, 1.6)

    def mm(self, low: float, high: float | None = None, power: int = 1) -> float:
        """Give a length (or its square) between two, which grow with the cam."""
        value = self.rng.uniform(low, low if high is None else high) * self.size**power
        return self.fixed(value, power)

    def fixed(self, value: float, power: int = 1) -> float:
        """Give a length of mm that does not grow with the cam, in the recipe's unit."""
        return float(f"{value / self.unit**power:.5g}")

    def angle(self) -> float:
        return self.rng.choice([0, 0, 90, 180, self.rng.randrange(-180, 360)])

    def some(self, share: float = 0.4) -> bool:
        return self.rng.random() < share

    # cams: each comes with the room round its shaft, in mm

    def cam(self, family: str, *, linked: bool) -> tuple[Fields, float]:
        kind, _, route = family.rpartition("-")
        if kind in {"double-roller", "flat-pair"}:
            return self.pair(kind, route), 12 * self.size
        if family == "constant-breadth":
            return self.breadth(), 34 * self.size
        cam: Fields = {"kind": "support"} | self.support(family)
        if linked:
            cam["shaft"] = [self.mm(16, 18.5), self.mm(7.5, 8.5)]
            return cam, 5.5 * self.size
        if self.some(0.6):
            cam["shaft"] = [self.mm(-6, 6), self.mm(-6, 6)]
        return cam, 13 * self.size

    def support(self, family: str) -> Fields:
        rng, odd = self.rng, family.startswith("yoke")
        mean, k = self.mm(25), rng.choice([3, 5] if odd else [2, 3, 4])
        first = self.mm(0.3, 0.75 * 25 / (k * k - 1))
        if family.endswith("formula"):
            second = rng.choice(["", f" + {self.mm(0.05, 0.1)}*sin({k + 2}*t)", f" - {first}/9*sin({k}*t)*cos(2*t)"])
            return {
                "p": f"{mean} + {first}*{rng.choice(['sin', 'cos'])}({k}*t + {rng.choice([0, 0.3, 'pi/7'])}){second}"
            }
        if family.endswith("fourier"):
            more = {7 if odd else 5: self.mm(-0.08, 0.08)}
            return {"fourier": {"mean": mean, "cos": {k: first}} | ({"sin": more} if self.some(0.7) else {})}
        if family == "face-bent":
            bent = [
                f"max(0, sin(t))**{rng.choice([3, 4])}",
                "abs(sin(t))**3",
                f"exp({self.rng.choice([0.3, 0.6])}*cos(t))",
            ]
            return {"p": f"{mean} + {self.mm(0.5, 2)}*{rng.choice(bent)}"}
        if family == "reuleaux":
            sides = rng.choice([3, 3, 5, 7, 9])
            return {"reuleaux": {"sides": sides, "breadth": self.mm(50), "rounding": self.mm(4, 9)}}
        cusps = rng.choice([3, 3, 5, 7])
        size = self.mm(0.3, 0.8 * 25 / (cusps * cusps - 1))
        return {"hypocycloid": {"cusps": cusps, "size": size, "breadth": self.mm(50)}}

    def breadth(self) -> Fields:
        law = [*LAWS, CUBIC, QUINTIC]
        rise, over = self.mm(4, 16), self.rng.choice([90, 110, 120, 135, 150])
        segments: list[Fields] = [{"rise": rise, "over": over, "law": self.rng.choice(law)}]
        if self.some(0.3):
            half = over // 3
            segments = [{"rise": rise, "over": over - half, "law": self.rng.choice(law[1:])}]
            segments += [
                {"dwell": half // 2},
                {"return": round(rise / 4, 4), "over": half - half // 2, "law": "cycloidal"},
            ]
        segments.append({"dwell": 180 - over})
        if self.some(0.3):
            segments.insert(0, segments.pop())
        return {"kind": "constant-breadth", "base_radius": self.mm(40, 50), "motion": segments}

    def pair(self, kind: str, route: str) -> Fields:
        rng, rollers = self.rng, kind == "double-roller"
        ratio = rng.choice(["2", "3", "4/3", "5/3"] if rollers and route != "law" else ["2", "2", "3"])
        strokes = int(ratio.split("/")[0])
        arm = self.mm(60)
        cam: Fields = {"kind": kind, "ratio": int(ratio) if ratio.isdigit() else ratio, "arm": arm}
        if rollers:
            cam["roller_radius"] = self.mm(6, 9)
        if route == "delta":
            most = 0.2 if rollers and strokes < 5 else 0.06
            most = most if rollers else (0.28 if strokes == 2 else 0.06)
            share = rng.uniform(0.02, most) * (0.5 if strokes == 3 and rollers else 1)
            cam["delta"] = {rng.choice(["cos", "sin"]): {1: float(f"{share * arm**2:.5g}")}}
            if self.some(0.3):
                cam["delta"] |= {"sin": {3: float(f"{share * arm**2 / 200:.4g}")}}
        elif route == "law":
            span = 180 // strokes
            rise, out = round(rng.uniform(2, 6 if rollers else 1.5) * span / 90, 3), rng.choice([2, 3]) * span // 6
            law = rng.choice(LAWS[1:] if rollers else ["cycloidal", "modified-sine", "polynomial-345"])
            back = span - out - span // 12
            cam["law"] = [{"rise": rise, "over": out, "law": law}, {"dwell": span // 12}]
            cam["law"] += [{"return": rise, "over": back, "law": rng.choice(["cycloidal", law])}]
        elif route == "arc":
            cam |= {"ratio": 3, "arc": {"radius": float(f"{arm * rng.uniform(1.2, 1.4):.5g}")}}
            if not rollers:
                cam |= {"ratio": 2, "arc": {"radius": float(f"{arm * rng.uniform(1.0, 1.6):.5g}")}}
        else:
            leaf = self.mm(3, 8) if rollers else self.mm(0.3, 2)
            cam |= {"ratio": "5/3" if rollers else 2, "rosette": {"leaf": f"{leaf}*sin(pi*x)"}}
        return cam

    def deepen(self, cam: object, family: str) -> None:
        """Make the motion too steep for the cam, which is then trimmed."""
        assert isinstance(cam, dict)
        cam["undercut"] = "trim"
        if "p" in cam:
            cam["p"] = f"{self.mm(25)} + {self.mm(3.3, 3.8)}*{'cos' if 'face' in family else 'sin'}(3*t)"
        elif "fourier" in cam:
            cam["fourier"] = {"mean": self.mm(25), "cos": {3: self.mm(3.3, 3.8)}}
        elif "hypocycloid" in cam:
            cam["hypocycloid"] |= {"cusps": 3, "size": self.mm(3.3, 3.8)}
        elif "motion" in cam:
            cam["base_radius"] = self.mm(24)
            cam["motion"] = [{"rise": self.mm(24), "over": 120, "law": self.rng.choice(LAWS)}, {"dwell": 60}]
        elif "roller_radius" in cam and self.some(0.7):
            cam["roller_radius"] = self.mm(14, 20)

    # what else a recipe has

    def rest(self, topic: str, family: str, room: float) -> Fields:
        swings = family in PAIRS
        part = self.part(room, plain=topic in {"set", "linkage-set"})
        given: Fields = {"part": part}
        tolerance = self.fixed(self.rng.choice([0.001, 0.002, 0.005, 0.01]))
        files = self.files()
        if topic in LINKED:
            given |= self.linkage("four-bar" if topic == "linkage-set" else topic)
        if topic in {"set", "linkage-set"}:
            tolerance, files = self.fixed(0.01), [{kind: {"parts": "all"}} for kind in ("3mf", "stl", "glb")]
            given["mechanism"] = {"clearance": self.fixed(self.rng.choice([0.2, 0.25, 0.3]))}
            if self.some():
                given["mechanism"] |= {"gap": self.fixed(0.5), "pin": self.mm(3, 5)}
        elif topic == "milling":
            given["manufacture"] = self.milling()
            files = ["gcode", {"csv": {"as": "inspection"}}, "dxf"]
        elif topic == "dynamics":
            given["dynamics"] = self.dynamics(swings=swings)
            files = ["dxf", "csv", "html"]
        elif topic == "compensation":
            files = [{kind: self.other()} for kind in ("dxf", "svg", "stl", "3mf", *(["step"] if STEP else []))]
        elif topic == "inspection":
            files = [{"csv": {"as": "inspection"}}, "csv", {"dxf": {"as": self.rng.choice(["arcs", "spline"])}}]
        elif topic == "page":
            files = ["html", "svg", {"dxf": {"as": "spline"}}]
        elif topic == "solids":
            files = ["stl", "3mf", "glb", *(["step"] if STEP else [])]
            if STEP and "chamfer" not in part:
                files.append({"step": {"as": "spline"}})
        given["export"] = {"tolerance": tolerance, "files": files}
        if topic == "limits":
            given["verify"] = {"angles": 1440, "motion_error": self.fixed(10 ** self.rng.uniform(-4, -1))}
        else:
            given["verify"] = {"angles": self.rng.choice([360, 720, 1000])}
        return given

    def files(self) -> list[object]:
        versions = ["R2000", "R2010", "R2013"]
        form = self.rng.choice(["arcs", "arcs", "polyline", "spline"])
        dxf = {"as": form, "version": self.rng.choice(versions if form == "spline" else ["R12", *versions])}
        svg = {"as": self.rng.choice(["arcs", "polyline", "spline"])}
        found: list[object] = [{"dxf": dxf}, {"svg": svg}, "stl", "3mf", "csv", "glb"]
        if form != "polyline" and self.some(0.3):
            found.append({"dxf": {"as": "polyline", "tolerance": self.fixed(0.02), "version": "R2010"}})
        return self.rng.sample(found, self.rng.randrange(2, 5))

    def other(self) -> Fields:
        """Give what makes a file's part different from the nominal one."""
        kerf = {"kerf": self.fixed(self.rng.choice([0.1, 0.2, 0.3]))}
        return self.rng.choice([kerf, {"clearance": self.fixed(0.1)}, {"shrinkage": 0.5}, kerf | {"shrinkage": 2}])

    def part(self, room: float, *, plain: bool) -> Fields:
        part: Fields = {"thickness": self.fixed(self.rng.choice([5, 6, 8, 10]))}
        bore = max(4.0, float(f"{room * self.rng.uniform(0.6, 0.9):.3g}"))
        form = self.rng.choice(["round", "round", "round", "square", "hexagon", *([] if plain else ["none"])])
        if form == "none":
            return part
        if form == "round":
            part["bore"] = self.fixed(bore)
            if not plain and bore > 6 and self.some():
                part["keyway"] = self.rng.choice(["din6885", {"standard": "din6885", "at": self.angle()}, "own"])
                if part["keyway"] == "own":
                    part["keyway"] = {"width": self.fixed(bore / 4), "depth": self.fixed(bore / 8), "at": self.angle()}
            elif self.some():
                part["flat"] = {"across": self.fixed(bore * 0.9), "at": self.angle()}
        else:
            part["bore"] = {form: self.fixed(bore * 0.8), "at": self.angle()}
        if plain:
            return part
        hub = room > 8 and self.some()
        if hub:
            part["hub"] = {
                "diameter": self.fixed(bore + 8),
                "height": self.fixed(8),
                "side": self.rng.choice(["top", "both"]),
            }
            if self.some():
                part["set_screw"] = {"diameter": self.fixed(3), "at": self.angle()}
        if room > 12 and self.some():
            holes = {
                "count": self.rng.choice([3, 4, 6]),
                "circle": self.fixed(bore + (14 if hub else 8)),
                "hole": self.fixed(2),
            }
            part["bolts"] = holes | {"start": self.angle()}
        elif room > 12 and self.some():
            part["dowel"] = {"circle": self.fixed(bore + (14 if hub else 8)), "hole": self.fixed(2), "at": self.angle()}
        if self.some():
            count = self.rng.choice([{"ring": 5}, {"largest": 3}, {"ring": 3, "start": 20}])
            part["lightening"] = count | {"wall": self.fixed(self.rng.choice([3, 4])), "least": self.fixed(2)}
        if self.some():
            part["chamfer"] = self.fixed(self.rng.choice([0.3, 0.5]))
        if self.some():
            part["mark"] = {
                "as": self.rng.choice(["engrave", "cut"]),
                "width": self.fixed(0.8),
                "length": self.fixed(2),
            }
        if room > 16 and "bolts" not in part and "dowel" not in part and self.some():
            across = {"length": self.fixed(5), "width": self.fixed(self.rng.choice([2, 3]))}
            part["slot"] = across | {"circle": self.fixed(bore + (16 if hub else 10)), "at": self.angle()}
        if self.some(0.3):
            part["wall"] = self.fixed(0.8)
        return part

    def milling(self) -> Fields:
        given = {"cutter": self.mm(3, 6), "feed": self.fixed(400), "plunge": self.fixed(100), "spindle": 12000}
        given |= {"depth_of_cut": self.fixed(2), "safe_height": self.fixed(12)}
        more: list[Fields] = [{"lead_in": self.fixed(2)}, {"direction": "conventional"}, {"holes": True}]
        more += [{"allowance": self.fixed(0.3)}, {"start": self.angle()}, {"layer": True}]
        for extra in more:
            if self.some():
                given |= extra
        return given

    def dynamics(self, *, swings: bool) -> Fields:
        scale = 4e-3 if swings else 1.0  # inertia and turning stiffness at some 60 mm
        given: Fields = {"mass": round(self.rng.uniform(0.2, 0.6) * scale, 6)}
        given |= {"damping": self.rng.choice([0, 20 * scale]), "stiffness": self.rng.choice([2e5, 5e5]) * scale}
        if self.some(0.3):
            given["backlash"] = self.fixed(0.05)
        else:
            given |= {"preload": 200 * math.sqrt(scale), "rate": self.rng.choice([0, 1000 * scale])}
        return given | {"rpm": self.rng.choice([60, 200, 400])}

    def linkage(self, topic: str) -> Fields:
        base = "four-bar" if topic in {"rrr", "rrp", "rpr"} else topic
        near = [self.mm(x * 0.98, x * 1.02) for x in (80, 70, 105, 130, 70)]
        table: dict[str, Fields] = {
            "four-bar": {"ground": near[0], "coupler": near[1], "rocker": near[2]},
            "inverted-slider-crank": {"ground": near[3], "rocker": self.rng.choice([near[4], 0])},
            "slider-crank": {"coupler": self.mm(75, 90), "offset": self.mm(0, 6)},
        }
        linkage: Fields = {"kind": base} | table[base] | ({"assembly": "crossed"} if self.some(0.15) else {})
        triple = {"kind": "rrr", "point": [self.mm(80), 0], "ground": [self.mm(140), self.mm(80)]}
        slotted = {"kind": "rpr", "point": [self.mm(90), 0], "ground": [self.mm(80), self.mm(200)]}
        slide = {
            "kind": "rrp",
            "point": [self.mm(60), 0],
            "link": self.mm(120),
            "through": [0, self.mm(150)],
            "direction": 0,
        }
        dyads: dict[str, list[Fields]] = {
            "rrr": [triple | {"on": "output", "links": [self.mm(100), self.mm(30)]}],
            "rpr": [slotted],
            "rrp": [slotted, slide | {"on": "previous", "link": self.mm(90)}],
        }
        if topic in dyads:
            linkage["dyads"] = dyads[topic]
        given: Fields = {"linkage": linkage}
        if self.some(0.6) and topic not in {"slider-crank", "rrp"}:
            given["dwell"] = {"band": self.rng.choice([0.1, 0.5])}
            if self.some():
                given["dwell"] |= {"at_least": 20, "over": self.rng.choice(["shaft", "relative"])}
        return given

    # needs: linear
    def plate(self, *, groove: bool | None = None) -> Fields:
        """Give a linear cam: on a stem or an arm, with ends, in a groove, or endless; a few of them undercut."""
        rng = self.rng
        arm, endless = self.some(0.35), self.some(0.2)
        groove = not endless and self.some(0.3) if groove is None else groove
        radius, base = self.mm(3, 10), self.mm(15, 40)
        stroke = rng.uniform(8, 28) if arm else self.mm(4, 22)
        over = [self.mm(35, 80) for _ in range(2)]
        law = rng.choice(["cycloidal", "modified-sine", "polynomial-345", "polynomial-4567", "modified-trapezoid"])
        rests = [{"dwell": self.mm(4, 15)} for _ in range(2)]
        motion: list[Fields] = [{"rise": stroke, "over": over[0], "law": law}, rests[0]]
        if endless or self.some(0.7):
            motion += [{"return": stroke, "over": over[1], "law": rng.choice(["cycloidal", "modified-sine"])}, rests[1]]
        cam: Fields = {"kind": "linear", "base": base, "follower": {"kind": "roller", "radius": radius}}
        cam["travel"] = rng.choice(["left", "right"])
        if arm:
            length = self.mm(60, 110)
            pivot = float(f"{base + radius + length * math.sin(math.radians(0.5 * stroke)):.6g}")
            side = rng.choice(["trailing", "leading"])
            cam["follower"]["arm"] = {"length": length, "pivot": pivot, "side": side}
        elif self.some(0.6):
            cam["follower"]["lean"] = rng.choice([rng.randrange(-30, 31), 5, 10])
        if not endless:
            cam["ends"] = {"overrun": [self.mm(2, 9), self.mm(2, 9)], "as": rng.choice(["tangent", "dwell"])}
        cam["motion"] = {"repeat": rng.randrange(1, 4), "segments": motion} if endless else motion
        cam |= {"endless": True} if endless else {}
        part: Fields = {"thickness": self.mm(8, 16)}
        if groove:
            cam["track"] = {"groove": {"clearance": self.fixed(rng.choice([0.02, 0.05])), "depth": self.mm(4, 7)}}
            reach = length * math.sin(math.radians(stroke)) if arm else stroke
            part["height"] = float(f"{base + 2 * radius + reach + self.mm(8, 15):.6g}")
        elif self.some(0.5):
            cam["undercut"] = "trim"
        if self.some() and not arm:
            part["holes"] = [{"at": [self.mm(18), float(f"{0.4 * base:.6g}")], "diameter": self.mm(4, 6)}]
        files: list[object] = rng.sample(["dxf", "svg", "stl", "3mf", "csv", {"csv": {"as": "inspection"}}, "html"], 3)
        tolerance = self.fixed(rng.choice([0.001, 0.002, 0.01]))
        return {"cam": cam, "part": part, "export": {"tolerance": tolerance, "files": files}}

    def spoilt(self, text: str) -> str:
        """Plant one fault, so that what is said of it, where, is compared too."""
        faults = [
            ("kind: ", "kind: x"),
            ("thickness: ", "thickness: -"),
            ("tolerance: ", "tolerance: nought"),
            ("rotation: c", "rotation: [c"),
            ("angles: ", "angels: "),
            ("cam:\n", "cam:\n  shaft: 3\n"),
            ("units: ", "unit: "),
            ("files:\n", "files:\n  - dxf2\n"),
        ]
        old, new = self.rng.choice([fault for fault in faults if fault[0] in text])
        return text.replace(old, new, 1)
