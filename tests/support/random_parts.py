"""Parts by chance, of all features and followers, on sheets of either size: a recipe of two numbers alone."""

from __future__ import annotations

from random import Random

MOTION = (
    "[{rise: %s, over: 100, law: cycloidal}, {dwell: 60}, {return: %s, over: 120, law: modified-sine}, {dwell: 80}]"
)
FORMULA = "{formula: %s*(1 - cos(t))}"
INCH = 25.4


class Drawn:
    """A recipe that is being drawn by chance; lengths are mm, written in its unit."""

    def __init__(self, seed: int, attempt: int) -> None:
        self.rng = Random(f"part {seed} {attempt}")
        self.inch = self.rng.random() < 0.4
        self.size = self.rng.choice([0.5, 1.0, 1.0, 2.2])

    def mm(self, low: float, high: float) -> str:
        """Length between two in mm, in the recipe's unit, whole tenths or thousandths."""
        value = self.size * self.rng.uniform(low, high)
        return f"{value / INCH:.4f}" if self.inch else f"{value:.{self.rng.choice([0, 1, 2])}f}"

    def angle(self) -> str:
        return self.rng.choice(["0", f"{self.rng.uniform(-180, 180):.1f}", f"{self.rng.randrange(-360, 361)}"])

    def often(self, share: float = 0.5) -> bool:
        return self.rng.random() < share

    def cam(self, family: str) -> str:
        """A cam of a family with a least radius of about 34 mm, times the size."""
        motion = self.rng.choice([MOTION % ((lift := self.mm(4, 9)), lift), FORMULA % self.mm(2, 4)])
        base = self.mm(36, 40)
        follower = {
            "stem": f"{{kind: roller, radius: {self.mm(6, 9)}}}",
            "offset": f"{{kind: roller, radius: {self.mm(6, 9)}, offset: {self.mm(-8, 8)}}}",
            "shoe": f"{{kind: shoe, radius: {self.mm(6, 9)}}}",
            "knife": "{kind: knife-edge}",
            "flat": "{kind: flat}",
        }.get(family)
        if family == "arm":
            motion = "[{rise: 9, over: 100, law: cycloidal}, {dwell: 60}, {return: 9, over: 120}, {dwell: 80}]"
            arm = f"arm: {{length: {self.mm(60, 64)}, pivot: {self.mm(76, 80)}}}"
            follower = f"{{kind: roller, radius: {self.mm(6, 8)}, {arm}}}"
        if family == "flat":
            motion = FORMULA % self.mm(2, 4)
        if family == "yoke":
            terms = " + ".join([self.mm(34, 38), f"{self.mm(0.4, 1)}*cos(3*t)"])
            return f"{{kind: support, p: {terms}}}"
        return f"{{kind: disc, base_radius: {base}, follower: {follower}, motion: {motion}}}"

    def bore(self, form: str) -> list[str]:
        """A bore of a form, with what shapes it."""
        diameter, at = self.mm(9, 16), f"at: {self.angle()}"
        plain, sizes = f"bore: {diameter}", f"width: {self.mm(2, 4)}, depth: {self.mm(1, 2)}"
        standard = f"standard: din6885, fit: {self.rng.choice(['P9', 'JS9'])}"
        return {
            "none": [],
            "plain": [plain],
            "fit": [f"bore: {{diameter: {diameter}, fit: H7}}"],
            "keyway": [plain, f"keyway: {{{sizes}, {at}}}"],
            "standard": [plain, f"keyway: {{{standard}, {at}}}"],
            "flat": [plain, f"flat: {{across: {self.mm(7.4, 8.4)}, {at}}}"],
            "square": [f"bore: {{square: {self.mm(8, 11)}, {at}}}"],
            "hexagon": [f"bore: {{hexagon: {self.mm(8, 12)}, {at}}}"],
        }[form]

    def holes(self) -> list[str]:
        """Bolts, a dowel, a slot, lightening holes, each of them or not."""
        bolts = f"count: {self.rng.randrange(1, 7)}, circle: {self.mm(40, 44)}, hole: {self.mm(2, 3.5)}"
        slot = f"length: {self.mm(6, 9)}, width: {self.mm(2, 3)}, circle: {self.mm(36, 50)}"
        ring, largest = (
            f"ring: {self.rng.randrange(2, 9)}, start: {self.angle()}",
            f"largest: {self.rng.randrange(1, 7)}",
        )
        many = f"{self.rng.choice([ring, largest])}, wall: {self.mm(1.5, 2.5)}, least: {self.mm(1, 1.5)}"
        found = [f"bolts: {{{bolts}, start: {self.angle()}}}"] * self.often()
        found += [f"dowel: {{circle: {self.mm(50, 54)}, hole: {self.mm(1.5, 2.5)}, at: {self.angle()}}}"] * self.often(
            0.3
        )
        found += [f"slot: {{{slot}, at: {self.angle()}}}"] * self.often(0.3)
        return found + [f"lightening: {{{many}}}"] * self.often(0.4)

    def part(self) -> list[str]:
        """Features with room within about 34 mm, times the size."""
        solid = self.often(0.85)
        part = [f"thickness: {self.mm(6, 14)}"] * solid
        form = self.rng.choice(
            ["none", "plain", "plain", "fit", *["keyway", "standard"] * 2, "flat", "square", "hexagon"]
        )
        part += self.bore(form)
        if solid and self.often():
            side = self.rng.choice(["top", "bottom", "both"])
            part.append(f"hub: {{diameter: {self.mm(25, 29)}, height: {self.mm(6, 12)}, side: {side}}}")
            if form != "none" and self.often():
                part.append(f"set_screw: {{diameter: {self.mm(2, 3)}, at: {self.rng.choice(['90', self.angle()])}}}")
        part += self.holes()
        part += [f"chamfer: {self.mm(0.4, 1)}"] * (solid and self.often(0.4))
        engraved = f"mark: {{as: engrave, width: {self.mm(0.8, 1)}, length: {self.mm(3, 5)}}}"
        part += [self.rng.choice([engraved, "mark: {as: cut}"])] * self.often(0.4)
        return part + ["density: 7850"] * (solid and self.often())

    def sheet(self) -> list[str]:
        """Options of the drawing; on A4 as often as on A3."""
        options = [f"paper: {self.rng.choice(['A3', 'A4'])}", f"projection: {self.rng.choice(['first', 'third'])}"]
        options += [f"profile: {self.mm(0.02, 0.08)}"] if self.often(0.7) and not self.inch else []
        options += [f"step: {self.rng.choice([1, 5, 10, 30])}"] if self.often(0.3) else []
        options += ["number: C-104, title: 'Łódź (Ø/g)', owner: Å"] if self.often(0.3) else []
        return options

    def finish(self, *, bored: bool) -> str:
        """Roughness of contour and bore, or a text."""
        rough = [f"contour: {self.rng.choice(['Ra 0.8', 'Rz 6.3'])}", "bore: Ra 1.6"][: 1 + bored]
        return self.rng.choice(["finish: ground", f"finish: {{{', '.join(rough)}}}"])


FAMILIES = ("stem", "offset", "arm", "flat", "yoke", "knife", "shoe", "ring")


def random_part(seed: int, attempt: int = 0) -> str:
    """Give the recipe of a part by chance with its shop drawing; not every one leaves its walls."""
    draw = Drawn(seed, attempt)
    family = FAMILIES[seed % len(FAMILIES)]
    cam, part = draw.cam("stem" if family == "ring" else family), draw.part()
    if family == "ring":
        cam = f"{cam[:-1]}, track: internal}}"
        room = draw.mm(140, 146)
        part = [f"thickness: {draw.mm(6, 14)}", f"outer: {room}"] if draw.often(0.8) else [f"outer: {room}"]
        part += [f"bolts: {{count: 6, circle: {draw.mm(126, 128)}, hole: {draw.mm(3, 4)}, start: {draw.angle()}}}"]
    options = [*draw.sheet(), draw.finish(bored=any(each.startswith("bore") for each in part))]
    lines = [
        f"units: {'inch' if draw.inch else 'mm'}",
        f"rotation: {draw.rng.choice(['cw', 'ccw'])}",
        f"cam: {cam}",
        f"part: {{{', '.join(part)}}}" if part else "",
        f"export: {{tolerance: {'0.0004' if draw.inch else '0.01'}, files: [{{sheet: {{{', '.join(options)}}}}}]}}",
        "verify: {angles: 36}",
    ]
    return "\n".join(lines) + "\n"
