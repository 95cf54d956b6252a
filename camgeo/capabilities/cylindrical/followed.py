"""The motion that a drum of unknown origin gives a roller, as text, table, recipe and page."""

from __future__ import annotations

import json
import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.motions.recognised import MOST_LEFT, STROKES_BEGIN, Recognised, roundest
from kin.follower.measured import MeasuredMotion
from kin.follower.recognised import recognised
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.schema.change import Value
    from kin.cylindrical.running import Run
    from kin.cylindrical.unknown import Drum
    from kin.follower.measured import MeasuredDwell
    from kin.follower.recognised import Programme
    from kin.numeric.arrays import Array

Flank = Literal["lower", "upper", "middle"]

SPREAD = 3  # steps to both sides, over which a velocity is taken
FINE = 1e-6  # mm: lengths below this are the numbers' rounding


@dataclass(frozen=True, eq=False)
class DrumMotion:
    """Positions (n,), mm or rad, at equal steps of a turn; what is left of laws may have `spans` independent values."""

    position: Array
    sd: float
    spans: int
    span: float = TURN
    closed: bool = True
    zero_ends: bool = False

    @property
    def turn(self) -> Array:
        """Positions (n,) over the turn."""
        return self.position

    @property
    def shaft(self) -> Array:
        """Shaft angles (n,), rad."""
        return equal_steps(len(self.position))

    @property
    def last(self) -> float:
        """Position at the end of the turn."""
        return float(self.position[0])

    def alike(self, most: int, /) -> tuple[int, ...]:
        """All numbers of waves up to `most`."""
        return tuple(range(1, most + 1))


@dataclass(frozen=True, eq=False)
class FollowedDrum:
    """The motion of a roller on a drum: what was read, and what the roller does; mm or rad.

    `flank` is that on which a roller in a groove is held; `reading`, mm, is within how much a dwell rests and a recipe
    keeps to the motion; `unjudged` says why no page is made, and is empty where one is.
    """

    path: Path
    drum: Drum
    run: Run
    flank: Flank
    rotation: str
    reading: float
    units: str | None = None
    unjudged: str = ""

    @property
    def swings(self) -> bool:
        """Whether the roller is on an arm."""
        return self.run.follower.arm is not None

    @property
    def unit(self) -> str:
        """Unit of positions as they are shown."""
        return self.run.follower.unit

    @property
    def scale(self) -> float:
        """One mm or rad in that unit."""
        return self.run.follower.told(1.0)

    @property
    def lever(self) -> float:
        """Length, mm, by which a position becomes a path: of an arm, or 1."""
        return 1.0 if self.run.follower.arm is None else self.run.follower.arm.length

    @cached_property
    def position(self) -> Array:
        """Position (n,) of the roller, mm over the lower face, or rad over level; of a rib of both rollers' middle."""
        run = self.run
        if run.kind in {"top", "bottom"}:
            return run.lower if run.kind == "top" else run.upper
        if run.kind == "rib" or self.flank == "middle":
            return np.asarray(0.5 * (run.lower + run.upper))
        return run.lower if self.flank == "lower" else run.upper

    @property
    def theta(self) -> Array:
        """Shaft angles (n,), rad."""
        return equal_steps(len(self.position))

    @property
    def play(self) -> Array | None:
        """Play (n,) of a roller in a groove, or of two rollers on a rib over their distance; None of an end cam."""
        if self.run.kind in {"top", "bottom"}:
            return None
        sense = 1.0 if self.run.kind == "groove" else -1.0
        return np.asarray(sense * (self.run.upper - self.run.lower))

    @property
    def within(self) -> float:
        """The reading as a position, mm or rad."""
        return self.reading / self.lever

    @cached_property
    def rests(self) -> list[MeasuredDwell]:
        """Dwells in the order of the turn."""
        nothing = np.zeros(len(self.position))
        rows, ends = np.stack([self.position, nothing, nothing]), (float(self.position.min()), 0.0)
        unit: Literal["mm", "rad"] = "rad" if self.swings else "mm"
        motion = MeasuredMotion(unit, self.theta, rows, nothing, nothing, ends, (float(self.position.max()), 0.0))
        return motion.dwells(self.within)

    @cached_property
    def programme(self) -> Programme | None:
        """The nearest programme of dwells and strokes; None of a roller that does not move."""
        motion = self._motion
        return recognised(motion, self.within, self.unit) if np.ptp(self.position) > 2.0 * self.within else None

    @property
    def _motion(self) -> DrumMotion:
        return DrumMotion(self.position, self.run.error / 3.0, len(self.position) // 2)

    @cached_property
    def told(self) -> tuple[list[Value] | None, list[str], float, str]:
        """Segments of a recipe, lines on them, the position at their lift 0; or no segments, and the reason.

        Lifts of a table count from the least position.
        """
        least = float(self.position.min())
        if self.programme is None:
            return None, [], least, "there are no strokes between dwells or turning points"
        programme, error, most = self.programme, self.run.error, MOST_LEFT * self.within
        # as round as facets leave it open, where that moves nothing by more than they do; else as the residuals say
        angles, levels = programme.uncertainty
        open_ = np.maximum(angles, error * programme.hidden.boundaries), np.maximum(levels, error)
        near = min(programme.greatest + error, most)
        rough = Recognised(self._motion, replace(programme, uncertainty=open_), near, self.scale, self.unit)
        known = Recognised(self._motion, programme, most, self.scale, self.unit)
        segments, why = rough.segments()
        if segments is None:
            segments, why = known.segments()
        if why == STROKES_BEGIN:
            first = next((rest for rest in self.rests), None)
            if first is not None:
                why += f": give --turn={-math.degrees(0.5 * (first.begin + first.end)):.6g} to begin in a dwell"
        if segments is None:
            return None, [], least, why
        lines = known.lines()
        lines.append(f"the programme is within {self.scale * self.programme.greatest:.2g} {self.unit} of the motion")
        return segments, lines, known.zero, ""

    def _at(self, place: int) -> float:
        return math.degrees(float(self.theta[place]))

    # --- for a terminal and for machines ------------------------------------------------------------------------------

    @property
    def words(self) -> str:
        """The roller and its track in words."""
        follower, kind = self.run.follower, self.run.kind
        lead = "" if not follower.offset else f", {follower.offset:.6g} mm beside the axis"
        if follower.arm is not None:
            lead = f" on an arm of {follower.arm.length:.6g} mm"
        cone = f", a cone of {math.degrees(follower.taper):.6g} degrees" if follower.taper else ""
        track = {
            "groove": "in a groove",
            "rib": "and another about a rib",
            "top": "on an end face towards the top",
            "bottom": "on an end face towards the bottom",
        }[kind]
        bears = f"bearing from {follower.inner:.6g} to {follower.outer:.6g} mm"
        return f"roller of radius {follower.radius:.6g} mm{cone}{lead}, {bears}, {track}"

    def document(self) -> dict[str, Any]:
        """The figures as plain data; lengths in mm, angles in degrees."""
        run, scale, position = self.run, self.scale, self.position
        low, high, steep = int(position.argmin()), int(position.argmax()), int(np.abs(run.lean).argmax())
        segments, lines, zero, why = self.told
        play = self.play
        return {
            "file": self.path.name,
            "follower": self.words,
            "unit": self.unit,
            "drum": run.kind,
            "radius": self.drum.radius,
            "floor": run.floor,
            "from": run.follower.inner,
            "to": run.follower.outer,
            "flank": self.flank if run.kind == "groove" else None,
            "distance": run.distance,
            "lift": scale * float(position[high] - position[low]),
            "least": {"position": scale * float(position[low]), "at_deg": self._at(low)},
            "greatest": {"position": scale * float(position[high]), "at_deg": self._at(high)},
            "play": None
            if play is None
            else {
                "least": scale * float(play.min()),
                "least_at_deg": self._at(int(play.argmin())),
                "greatest": scale * float(play.max()),
                "greatest_at_deg": self._at(int(play.argmax())),
            },
            "facets": self.drum.sag,
            "error": scale * run.error,
            "pressure_angle": {"value": math.degrees(abs(float(run.lean[steep]))), "at_deg": self._at(steep)},
            "dwells": [
                {
                    "start_deg": math.degrees(rest.begin),
                    "length_deg": math.degrees(rest.end - rest.begin),
                    "position": scale * rest.level,
                    "flatness": scale * rest.flatness,
                }
                for rest in self.rests
            ],
            "programme": segments,
            "programme_from": scale * zero,
            "strokes": lines,
            "no_programme": why,
            "remarks": list(self.remarks),
        }

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be known besides, in words."""
        told = [*self.drum.remarks]
        if self.run.error > self.within:
            told.append(f"facets say less than the reading: give a finer file, or reading {self.lever * self.run.error:.2g}")
        if self.drum.keyed:
            told.append("the bore is no circle: name its form in part, the recipe has a round one")
        if self.run.kind == "groove" and self.flank != "lower":
            told.append("a recipe has the clearance on the upper flank, so that its motion is that of the lower one")
        return tuple(told)

    def summary(self) -> str:
        """Text for a terminal."""
        told, unit = self.document(), self.unit
        least, most, play = told["least"], told["greatest"], told["play"]
        rows = [f"{escaped(told['file'])}: {told['follower']}"]
        rows.append(f"  drum of radius {self.drum.radius:.6g} mm, {self.drum.length:.6g} long, its floor at {self.run.floor:.6g}")
        rows.append(
            f"  lift {told['lift']:.6g} {unit}: from {least['position']:.6g} at {least['at_deg']:.6g} degrees "
            f"to {most['position']:.6g} at {most['at_deg']:.6g}"
        )
        if self.run.kind == "groove":
            rows[-1] += f", on the {self.flank} flank" if self.flank != "middle" else ", midway between both flanks"
        if told["distance"] is not None:
            rows.append(f"  both rollers' axes are {told['distance']:.6g} mm apart")
        if play is not None:
            rows.append(
                f"  play from {play['least']:.4g} {unit} at {play['least_at_deg']:.6g} degrees "
                f"to {play['greatest']:.4g} at {play['greatest_at_deg']:.6g}"
            )
        for dwell in told["dwells"]:
            end = (dwell["start_deg"] + dwell["length_deg"]) % 360.0
            rows.append(
                f"  dwell at {dwell['position']:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
                f"flat within {dwell['flatness']:.2g} {unit}"
            )
        angle = told["pressure_angle"]
        rows.append(f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}, at the inner end")
        rows.append(
            f"  facets stand about {told['facets']:.2g} mm off a surface: positions are good to about "
            f"{told['error']:.2g} {unit}"
        )
        rows += [f"  {line}" for line in told["strokes"]]
        if told["no_programme"]:
            rows.append(f"  no programme: {told['no_programme']}")
        return "\n".join([*rows, *(f"  {remark}" for remark in told["remarks"])])

    # --- files --------------------------------------------------------------------------------------------------------

    def table(self) -> str:
        """Motion over the turn as CSV text; lengths in mm, angles in degrees, the velocity by the radian.

        The velocity is that over three steps to both sides.
        """
        n, scale, unit = len(self.position), self.scale, self.unit
        steps = np.roll(self.position, -SPREAD) - np.roll(self.position, SPREAD)
        columns = {
            "shaft_deg": np.degrees(self.theta),
            f"position_{unit}": scale * self.position,
            f"velocity_{unit}_per_rad": scale * steps * (n / (2.0 * SPREAD * TURN)),
            "pressure_angle_deg": np.degrees(self.run.lean),
        }
        for name, row in (("lower", self.run.lower), ("upper", self.run.upper)):
            if np.isfinite(row).all():
                columns[f"{name}_{unit}"] = scale * row
        if self.play is not None:
            columns[f"play_{unit}"] = scale * self.play
        rows = np.column_stack(list(columns.values())) + 0.0
        return "\n".join([",".join(columns), *(",".join(f"{value:.12g}" for value in row) for row in rows.tolist()), ""])

    def lifts(self) -> str | None:
        """Lifts over the turn as CSV text, from the least position on; None where the recipe has a programme."""
        if self.told[0] is not None:
            return None
        lift = self.scale * (self.position - float(self.position.min()))
        rows = zip(np.degrees(self.theta).tolist(), (np.round(lift, 9) + 0.0).tolist(), strict=True)
        end = [f"360,{lift[0] + 0.0:.9f}\n"]
        return "".join(["angle,lift\n", *(f"{angle:.12g},{value:.9f}\n" for angle, value in rows), *end])

    def recipe(self, table: str) -> str:
        """Text of a recipe of a drum with this motion: its programme, or lifts that are in the file `table`."""
        segments, _, zero, _ = self.told
        about = f"The motion of {escaped(self.path.name)} under a {self.words}, within {self.reading:.6g} mm"
        if segments is None:
            motion = f"{{table: {json.dumps(table, ensure_ascii=False)}, reading: {self.scale * self.within:.6g}}}"
        else:
            motion = "[" + ", ".join("{" + ", ".join(f"{k}: {_text(v)}" for k, v in row.items()) + "}" for row in _rows(segments)) + "]"
        keys, part = self._keys(zero)
        lines = [
            f"about: {json.dumps(about, ensure_ascii=False)}",
            f"rotation: {self.rotation}",
            "cam:",
            "  kind: cylindrical",
            *(f"  {key}: {value}" for key, value in keys.items()),
            f"  motion: {motion}",
            f"part: {{{', '.join(f'{key}: {value:.9g}' for key, value in part.items())}}}",
            "export:",
            f"  tolerance: {2.0 * self.reading:.6g}",
            "  files: [stl, {csv: {as: motion}}, html]",
            "",
        ]
        return "\n".join(lines)

    def _keys(self, zero: float) -> tuple[dict[str, str], dict[str, float]]:
        """Keys of the cam without its motion, and of the part; `zero` is the position at lift 0."""
        drum, run, follower = self.drum, self.run, self.run.follower
        unsure = max(drum.sag, FINE)
        radius, floor = roundest(drum.radius, unsure), roundest(run.floor, unsure)
        base, top = 0.0, drum.length
        if run.kind in {"top", "bottom"}:
            base, top = drum.core(run.floor + 2.0 * unsure)
        own = [f"radius: {follower.radius:.9g}", f"from: {roundest(follower.inner, unsure):.9g}"]
        if drum.radius - follower.outer > unsure:
            own.append(f"to: {follower.outer:.9g}")
        if follower.offset:
            own.append(f"offset: {follower.offset:.9g}")
        if follower.taper:
            own.append(f"taper: {math.degrees(follower.taper):.12g}")
        height = zero
        if (arm := follower.arm) is not None:
            side = "trailing" if arm.side > 0 else "leading"
            lengths = f"length: {arm.length:.9g}, offset: {arm.offset:.9g}, pivot: {arm.pivot - base:.9g}"
            own.append(f"arm: {{{lengths}, side: {side}}}")
            height = arm.pivot + arm.length * math.sin(zero)
        depth = radius - floor
        track = {"top": "{end: top}", "bottom": "{end: bottom}"}.get(run.kind, "")
        if run.kind == "groove" and self.play is not None:
            clear = float(np.median(self.lever * self.play * np.cos(run.lean)))
            clear = roundest(clear, self.lever * run.error) if clear > self.lever * run.error else 0.0
            track = f"{{groove: {{depth: {depth:.9g}, clearance: {clear:.9g}}}}}"
        if run.kind == "rib":
            track = f"{{rib: {{distance: {roundest(run.distance or 0.0, run.error):.9g}, depth: {depth:.9g}}}}}"
        keys = {
            "radius": f"{radius:.9g}",
            "track": track,
            "follower": f"{{{', '.join(own)}}}",
            "pitch_height": f"{roundest(height - base, self.lever * run.error):.9g}",
        }
        part = {"length": roundest(top - base, unsure)}
        if drum.bore is not None:
            part["bore"] = roundest(2.0 * drum.bore, unsure)
        return keys, part

    def page(self) -> str:
        """The page of the recipe, with the verdict on the file.

        Raises CallError where `unjudged` says why, RecipeErrors where the recipe is refused.
        """
        import tempfile
        from pathlib import Path

        from camgeo.api.run import verify
        from camgeo.recipe.loading import load_order_text

        if self.unjudged:
            raise CallError(self.unjudged)
        with tempfile.TemporaryDirectory(prefix="camgeo-") as folder:
            if (lifts := self.lifts()) is not None:
                (Path(folder) / "lift.csv").write_text(lifts, encoding="utf-8")
            text, name = self.recipe("lift.csv"), escaped(self.path.stem)
            recipe = replace(load_order_text(text, str(Path(folder) / "follow.yaml"), escaped(str(self.path))), name=name)
            return verify(recipe, self.path, units=self.units, page=True).page or ""


def _rows(segments: list[Value]) -> list[dict[str, Value]]:
    return [row for row in segments if isinstance(row, dict)]


def _text(value: Value) -> str:
    return f"{value:.9g}" if isinstance(value, float) else str(value)
