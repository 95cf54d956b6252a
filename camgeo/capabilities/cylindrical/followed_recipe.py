"""The recipe of a drum whose motion was followed, as round as the file's facets let it be, and its page."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.followed import FollowedDrum
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.motions.recognised import roundest
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.schema.change import Value

FINE = 1e-6  # mm: lengths below this are the numbers' rounding


class Drawn(FollowedDrum):
    """A followed drum that is written as a recipe, and judged by it on a page."""

    def recipe(self, table: str) -> str:
        """Text of a recipe of a drum with this motion: its programme, or lifts that are in the file `table`."""
        return _recipe_of(self, table)

    def told_recipe(self, table: str) -> tuple[str, list[str]]:
        """Text of `recipe`; the summary tells what it has."""
        return self.recipe(table), []

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
            recipe = replace(
                load_order_text(text, str(Path(folder) / "follow.yaml"), escaped(str(self.path))), name=name
            )
            return verify(recipe, self.path, units=self.units, page=True).page or ""


def _recipe_of(followed: FollowedDrum, table: str) -> str:
    """Text of a recipe of a drum with this motion: its programme, or lifts that are in the file `table`."""
    rows, _, zero, _ = followed.segments
    about = f"The motion of {escaped(followed.path.name)} under a {followed.words}, within {followed.reading:.6g} mm"
    if rows is None:
        reading = followed.scale * followed.within
        motion = f"{{table: {json.dumps(table, ensure_ascii=False)}, reading: {reading:.6g}}}"
    else:
        motion = f"[{', '.join(_flow(row) for row in rows)}]"
    keys = {**_cam(followed, zero), "motion": motion}
    part = ", ".join(f"{key}: {value:.9g}" for key, value in _part(followed).items())
    lines = [
        f"about: {json.dumps(about, ensure_ascii=False)}",
        f"rotation: {followed.rotation}",
        "cam:",
        "  kind: cylindrical",
        *(f"  {key}: {value}" for key, value in keys.items()),
        f"part: {{{part}}}",
        "export:",
        f"  tolerance: {2.0 * followed.reading:.6g}",
        "  files: [stl, {csv: {as: motion}}, html]",
        "",
    ]
    return "\n".join(lines)


def _flow(value: Value) -> str:
    """A segment in one line."""
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_flow(entry)}' for key, entry in value.items())}}}"
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _unsure(followed: FollowedDrum) -> float:
    """By how much a length of the drum may be off, mm: its facets lie so near it."""
    return max(followed.run.sag, FINE)


def _ends(followed: FollowedDrum) -> tuple[float, float]:
    """Heights between which the drum lies; of an end cam what lies within its flank."""
    if not followed.run.closed:
        return followed.drum.core(followed.run.floor + 2.0 * _unsure(followed))
    return 0.0, followed.drum.length


def _part(followed: FollowedDrum) -> dict[str, float]:
    unsure, (base, top) = _unsure(followed), _ends(followed)
    part = {"length": roundest(top - base, unsure)}
    if followed.drum.bore is not None:
        part["bore"] = roundest(2.0 * followed.drum.bore, unsure)
    return part


def _cam(followed: FollowedDrum, zero: float) -> dict[str, str]:
    """Keys of the cam without its motion; `zero` is the position at lift 0."""
    drum, run, follower, unsure = followed.drum, followed.run, followed.run.follower, _unsure(followed)
    near, (base, _) = followed.lever * followed.rounding, _ends(followed)
    radius, depth = roundest(drum.radius, unsure), roundest(drum.radius, unsure) - roundest(run.floor, unsure)
    roller = [f"radius: {follower.radius:.9g}"]
    if followed.shoe is not None:
        roller = ["kind: shoe", f"width: {2.0 * follower.radius:.9g}", f"length: {followed.shoe_length:.9g}"]
    roller.append(f"from: {roundest(follower.inner, unsure):.9g}")
    if drum.radius - follower.outer > unsure:
        roller.append(f"to: {follower.outer:.9g}")
    if follower.offset:
        roller.append(f"offset: {follower.offset:.9g}")
    if follower.taper:
        roller.append(f"taper: {math.degrees(follower.taper):.12g}")
        roller.append(f"at: {follower.at or 0.0:.9g}")
    height = zero
    if (arm := follower.arm) is not None:
        side = "trailing" if arm.side > 0 else "leading"
        lengths = f"length: {arm.length:.9g}, offset: {arm.offset:.9g}, pivot: {arm.pivot - base:.9g}"
        roller.append(f"arm: {{{lengths}, side: {side}}}")
        height = arm.pivot + arm.length * math.sin(zero)
    track = f"{{end: {run.kind}}}"
    if run.kind == "groove" and followed.play is not None:
        clear = float(np.median(followed.lever * followed.play * np.cos(run.lean)))
        clear = roundest(clear, near) if clear > followed.lever * run.error else 0.0
        track = f"{{groove: {{depth: {depth:.9g}, clearance: {clear:.9g}}}}}"
    elif run.kind == "rib":
        track = f"{{rib: {{distance: {roundest(run.distance or 0.0, near):.9g}, depth: {depth:.9g}}}}}"
    return {
        "radius": f"{radius:.9g}",
        **({"turns": str(followed.turns)} if followed.turns > 1 else {}),
        "track": track,
        "follower": f"{{{', '.join(roller)}}}",
        "pitch_height": f"{roundest(height - base, near):.9g}",
    }
