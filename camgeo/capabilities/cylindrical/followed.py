"""The motion that a drum of unknown origin gives a roller, as text and table."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from camgeo.common.terminal import escaped
from camgeo.motions.recognised import MOST_LEFT, STROKES_BEGIN, Recognised
from kin.follower.recognised import WholeTurn, dwells_of, recognised
from kin.follower.unknown import stretches
from kin.numeric.angles import TURN
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.common.units import Units
    from camgeo.schema.change import Value
    from kin.cylindrical.running import Run
    from kin.cylindrical.unknown import Drum
    from kin.follower.measured import MeasuredDwell
    from kin.follower.recognised import Programme
    from kin.law.contacts import Unit
    from kin.numeric.arrays import Array

Flank = Literal["lower", "upper", "middle"]

SPREAD = 3  # steps to both sides, over which a velocity is taken
LONGER = 1.15  # times the longest gap, or the width, is a shoe whose length is not given
ROUND = 0.25  # of the reading, by which round numbers may move the motion


class Segments(NamedTuple):
    """The motion as a recipe's segments: `rows`, or None and `why` there are none, in words.

    `lines` are text on each stroke, `zero` is the position at lift 0, mm or rad; lifts of a table count from the least
    position.
    """

    rows: list[Value] | None
    lines: list[str]
    zero: float
    why: str = ""


@dataclass(frozen=True, eq=False)
class FollowedDrum:
    """The motion of a roller on a drum: what was read, and what the roller does; mm or rad.

    `flank` is that on which a roller in a groove is held; `reading`, mm, is within how much a dwell rests and a recipe
    keeps to the motion; `turn`, degrees, is that of the file; `unjudged` says why no page is made, and is empty where
    one is. `shoe` is the length of a shoe, mm, 0 where the call does not say it, and None for a roller.
    """

    path: Path
    drum: Drum
    run: Run
    flank: Flank
    rotation: str
    reading: float
    turn: float = 0.0
    units: Units | None = None
    unjudged: str = ""
    shoe: float | None = None

    @property
    def unit(self) -> Literal["mm", "rad"]:
        """Unit of the motion: mm on a carriage, rad on an arm."""
        return "mm" if self.run.follower.arm is None else "rad"

    @property
    def told(self) -> Unit:
        """Unit of positions as they are shown."""
        return self.run.follower.unit

    @property
    def scale(self) -> float:
        """Factor by which positions, mm or rad, become numbers of the reported unit."""
        return self.run.follower.in_unit(1.0)

    @property
    def lever(self) -> float:
        """Length, mm, by which a position becomes a path: of an arm, or 1."""
        return 1.0 if self.run.follower.arm is None else self.run.follower.arm.length

    @cached_property
    def position(self) -> Array:
        """Position (n,) of the roller, mm over the lower face, or rad over level; of a rib of both rollers' middle."""
        run = self.run
        if not run.closed:
            return run.lower if run.kind == "top" else run.upper
        if run.kind == "rib" or self.flank == "middle":
            return np.asarray(0.5 * (run.lower + run.upper))
        return run.lower if self.flank == "lower" else run.upper

    @property
    def turns(self) -> int:
        """Turns of the drum after which the motion repeats."""
        return self.run.turns

    @property
    def theta(self) -> Array:
        """Shaft angles (n,), rad, over all turns."""
        return equal_steps(len(self.position)) * self.turns

    @property
    def bridged(self) -> list[tuple[float, float]]:
        """Stretches of shaft angles, (begin, end), rad, in which no flank holds the pin: positions are on a cubic."""
        lower, upper = self.run.touches
        free = stretches(equal_steps(len(lower)), ~(lower | upper))
        return [(begin * self.turns, end * self.turns) for begin, end in free]

    @property
    def shoe_length(self) -> float:
        """Length of the recipe's shoe, mm: that of the call, or one that is longer than any gap and than it is wide."""
        return self.shoe or math.ceil(LONGER * max(self.run.gap, 2.0 * self.run.follower.radius))

    @property
    def lift(self) -> float:
        """Greatest position less the least, mm or rad."""
        return float(np.ptp(self.position))

    @property
    def velocity(self) -> Array:
        """Velocity (n,), mm or rad by radian of the shaft, as the difference over three steps to both sides."""
        steps = np.roll(self.position, -SPREAD) - np.roll(self.position, SPREAD)
        return np.asarray(steps * (len(self.position) / (2.0 * SPREAD * TURN * self.turns)))

    @property
    def pressure_angle(self) -> Array:
        """Greatest pressure angle (n,), rad, about, at the roller's inner end."""
        return self.run.lean

    @property
    def play(self) -> Array | None:
        """Play (n,) of a roller in a groove, or of two rollers on a rib over their distance; None of an end cam."""
        if not self.run.closed:
            return None
        sense = 1.0 if self.run.kind == "groove" else -1.0
        return np.asarray(sense * (self.run.upper - self.run.lower))

    @property
    def within(self) -> float:
        """The reading as a position, mm or rad."""
        return self.reading / self.lever

    @property
    def rounding(self) -> float:
        """By how much round numbers may move a position, mm or rad: as facets say, or by a share of the reading."""
        return max(self.run.error, ROUND * self.within)

    @cached_property
    def rests(self) -> list[MeasuredDwell]:
        """Dwells in the order of the motion; over several turns they are as many times as long at least."""
        found = dwells_of(self.position, self.within, self.told)
        return [rest._replace(begin=rest.begin * self.turns, end=rest.end * self.turns) for rest in found]

    @cached_property
    def programme(self) -> Programme | None:
        """The nearest programme of dwells and strokes; None of a roller that does not move, and of several turns."""
        if self.turns > 1 or not np.ptp(self.position) > 2.0 * self.within:
            return None
        return recognised(self._motion, self.within, self.told)

    @property
    def _motion(self) -> WholeTurn:
        return WholeTurn(self.position, self.run.error / 3.0)

    @cached_property
    def segments(self) -> Segments:
        """The motion as segments of a recipe, as round as the file's facets let them be."""
        least = float(self.position.min())
        if self.turns > 1:
            return Segments(None, [], least, "laws are sought over one turn alone")
        if self.programme is None:
            return Segments(None, [], least, "there are no strokes between dwells or turning points")
        programme, error, most = self.programme, self.rounding, MOST_LEFT * self.within
        # as round as it lets them be, if the motion stays within it; else as the residuals say
        angles, levels = programme.uncertainty
        open_ = np.maximum(angles, error * programme.hidden.boundaries), np.maximum(levels, error)
        near = min(programme.greatest + error, most)
        rough = Recognised(self._motion, replace(programme, uncertainty=open_), near, self.scale, self.told)
        known = Recognised(self._motion, programme, most, self.scale, self.told)
        rows, why = rough.segments()
        if rows is None:
            rows, why = known.segments()
        if why == STROKES_BEGIN and self.rests:
            middle = math.degrees(0.5 * (self.rests[0].begin + self.rests[0].end))
            turned = self.turn + (middle if self.rotation == "ccw" else -middle)
            why += f": give --turn={math.remainder(turned, 360.0):.6g} to begin in a dwell"
        if rows is None:
            return Segments(None, [], least, why)
        lines = known.lines()
        lines.append(f"these laws are within {self.scale * self.programme.greatest:.2g} {self.told} of the motion")
        return Segments(rows, lines, known.zero)

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
        if self.shoe is not None:
            over = f" over {self.turns} turns" if self.turns > 1 else ""
            return f"shoe {2.0 * follower.radius:.6g} mm wide, {bears}, {track}{over}"
        return f"roller of radius {follower.radius:.6g} mm{cone}{lead}, {bears}, {track}"

    def document(self) -> dict[str, Any]:
        """The figures as plain data; lengths in mm, angles in degrees."""
        run, scale, position = self.run, self.scale, self.position
        low, high, steep = int(position.argmin()), int(position.argmax()), int(np.abs(run.lean).argmax())
        rows, lines, zero, why = self.segments
        play = self.play
        return {
            "file": self.path.name,
            "follower": self.words,
            "unit": self.told,
            "drum": run.kind,
            "radius": self.drum.radius,
            "floor": run.floor,
            "from": run.follower.inner,
            "to": run.follower.outer,
            "flank": self.flank if run.kind == "groove" else None,
            "distance": run.distance,
            "turns": self.turns,
            "gap": run.gap,
            "bridged": [{"start_deg": math.degrees(a), "end_deg": math.degrees(b)} for a, b in self.bridged],
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
            "facets": self.run.sag,
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
            "programme": rows,
            "programme_from": scale * zero,
            "strokes": lines,
            "no_programme": why,
            "remarks": list(self.remarks),
        }

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences of the report: what the solid leaves open, and how sure the motion is."""
        told = [*self.drum.remarks]
        if self.run.error > self.within:
            needed = f"{self.lever * self.run.error:.2g}"
            told.append(f"facets stand off by more than the reading: give a finer file, or reading {needed}")
        if self.shoe == 0.0:
            told.append(f"a recipe has a shoe {self.shoe_length:.6g} mm long: give --length with that of yours")
        if self.drum.keyed:
            told.append("the bore is no circle: name its form in part, the recipe has a round one")
        if self.run.kind == "groove" and self.flank != "lower":
            told.append("a recipe has the clearance on the upper flank, so that its motion is that of the lower one")
        return tuple(told)

    def summary(self) -> str:
        """Text for a terminal."""
        told, unit = self.document(), self.told
        least, most, play = told["least"], told["greatest"], told["play"]
        rows = [f"{escaped(told['file'])}: {told['follower']}"]
        rows.append(
            f"  drum of radius {self.drum.radius:.6g} mm, {self.drum.length:.6g} long, floor at {self.run.floor:.6g} mm"
        )
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
            end = (dwell["start_deg"] + dwell["length_deg"]) % (360.0 * self.turns)
            rows.append(
                f"  dwell at {dwell['position']:.6g} {unit} from {dwell['start_deg']:.1f} to {end:.1f} degrees, "
                f"flat within {dwell['flatness']:.2g} {unit}"
            )
        if told["gap"]:
            rows.append(f"  a wall is gone over about {told['gap']:.4g} mm at most, where tracks cross")
        if told["bridged"]:
            longest = max(part["end_deg"] - part["start_deg"] for part in told["bridged"])
            rows.append(
                f"  no wall holds the shoe in {len(told['bridged'])} stretches of up to {longest:.2g} degrees: "
                f"there its way is a cubic"
            )
        angle = told["pressure_angle"]
        rows.append(f"  pressure angle up to {angle['value']:.2f} degrees at {angle['at_deg']:.1f}, at the inner end")
        rows.append(
            f"  facets stand about {told['facets']:.2g} mm off a surface: positions are good to about "
            f"{told['error']:.2g} {unit}"
        )
        rows += [f"  {line}" for line in told["strokes"]]
        if told["no_programme"]:
            rows.append(f"  no laws: {told['no_programme']}")
        return "\n".join([*rows, *(f"  {remark}" for remark in told["remarks"])])

    # --- files --------------------------------------------------------------------------------------------------------

    def table(self) -> str:
        """Motion over the turn as CSV text; lengths in mm, angles in degrees, the velocity by the radian.

        The velocity is that over three steps to both sides.
        """
        scale, unit = self.scale, self.told
        columns = {
            "shaft_deg": np.degrees(self.theta),
            f"position_{unit}": scale * self.position,
            f"velocity_{unit}_per_rad": scale * self.velocity,
            "pressure_angle_deg": np.degrees(self.run.lean),
        }
        for name, row in (("lower", self.run.lower), ("upper", self.run.upper)):
            if np.isfinite(row).all():
                columns[f"{name}_{unit}"] = scale * row
        if self.play is not None:
            columns[f"play_{unit}"] = scale * self.play
        rows = np.column_stack(list(columns.values())) + 0.0
        return "\n".join(
            [",".join(columns), *(",".join(f"{value:.12g}" for value in row) for row in rows.tolist()), ""]
        )

    def lifts(self) -> str | None:
        """Lifts over the turn as CSV text, from the least position on; None where the recipe has a programme."""
        if self.segments.rows is not None:
            return None
        lift = self.scale * (self.position - float(self.position.min()))
        rows = zip(np.degrees(self.theta).tolist(), (np.round(lift, 9) + 0.0).tolist(), strict=True)
        end = [f"{360 * self.turns},{lift[0] + 0.0:.9f}\n"]
        return "".join(["angle,lift\n", *(f"{angle:.12g},{value:.9f}\n" for angle, value in rows), *end])
