"""Which entities of a drawing are a cam on its shaft, where frames, centre lines or other cams are drawn beside it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.about import LEVEL, circle_about, goes_round, is_frame
from kin.contour.across import Bridge, bulge_across, closed_across
from kin.contour.intersections import first_meeting
from kin.contour.nearest import signed_distance
from kin.contour.pieces import LINE
from kin.numeric.angles import TURN
from kin.numeric.records import replace
from kin.read.drawing.chaining import close_pairs
from kin.read.drawing.drawing import (
    CutEntities,
    chain,
    closeness,
    drawing_of,
    gathered,
    rounded,
    without_faults,
)
from kin.read.drawing.shapes import shape
from kin.read.errors import ReadError, short
from kin.read.nesting import counter_clockwise

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.contour.across import Across
    from kin.contour.contour import Contour
    from kin.contour.pieces import Pieces
    from kin.numeric.arrays import Indices, Mask
    from kin.read.drawing.chaining import Closeness
    from kin.read.drawing.drawing import Chained, Drawing
    from kin.read.formats import DrawingOptions

# Faults of a whole drawing that another reading of it may be without.
MENDED = frozenset({"open", "gap", "branch", "several", "crossing", "island"})
MOST_LAYERS = 200
MOST_NAMED = 5  # layers in a message
SECTORS = 360  # of a turn, in which it is seen how far round pieces go
MOST_ROUND = 1.0 / 3.0
ACROSS = np.linspace(0.0, 1.0, 17)  # shares of a piece at which it is seen to lie in the cam or beside it


class Strokes(NamedTuple):
    """All pieces of a drawing, mm, the entity `run` (n,) of each, which are `sound` (n,), and how near ends are."""

    pieces: Pieces
    run: Indices
    sound: Mask
    near: Closeness


class Layer(NamedTuple):
    """A layer: its closed chains, and which pieces (n,) of the drawing on it belong to none."""

    name: str
    chains: list[Chained]
    loose: Mask


def drawing_about_shaft(
    curves: CutEntities,
    marks: CutEntities | None,
    unit: float | None,
    path: Path,
    options: DrawingOptions,
    *,
    version: str,
) -> Drawing:
    """Drawing of the entities to cut, `curves`, and to engrave, `marks`, in units of `unit` mm.

    Where they are not one contour with others in it, what belongs to `options.shaft` is read, if it is given, and
    `options.across` closes what is open in one place. Raises ReadError as `drawing_of` does.
    """
    scale, unstated = (1.0, options.unstated) if unit is None else (unit, 1.0)  # mm, or drawing units if it has none
    x, y = options.shaft or (0.0, 0.0)
    shaft = x / unstated, y / unstated
    try:
        return drawing_of(curves, marks, unit, path, options, version=version)
    except ReadError as error:
        fault = error
    fault.unstated = unit is None
    if fault.closing is not None:
        fault.closing *= unstated
    if options.shaft is None:
        raise fault
    try:
        pieces, run = gathered(curves.shapes)
        pieces = pieces.enlarged(scale) if scale != 1.0 else pieces
        near = rounded(curves, scale, closeness(pieces, options.gap and options.gap / unstated))
        sound, _ = without_faults(pieces, run, curves, near.same, path)
        which, passed = about_shaft(curves, Strokes(pieces, run, sound, near), shaft, fault, unstated)
    except ReadError:
        if options.across is None or fault.between is None:
            raise
        bridged, bridge = bridged_over(curves, fault.between, options.across, shaft, scale)
        return replace(drawing_of(bridged, marks, unit, path, options, version=version), bridge=bridge)
    return replace(drawing_of(curves.chosen(which), marks, unit, path, options, version=version), passed=passed)


def bridged_over(
    curves: CutEntities,
    between: tuple[tuple[float, float], tuple[float, float]],
    way: Across,
    shaft: tuple[float, float],
    scale: float,
) -> tuple[CutEntities, Bridge]:
    """The entities with one more that closes what is open between two places, and the stretch that it is, mm.

    The places and the shaft's are in mm, or in drawing units where these have none; `scale` is mm in a drawing's unit.
    """
    ends = Bridge(*between).moved(-shaft[0], -shaft[1])
    first, last = ends.angles
    start, end = between if last - first < np.pi else between[::-1]  # the shorter way round the shaft
    bulge = bulge_across(np.array(start), np.array(end), way, shaft)
    row = [*(value / scale for value in (*start, *end)), bulge]
    closing = shape(chords=row, heights=curves.shapes[0].heights[:1])
    more = [*curves.shapes, closing], [*curves.names, "across"], [*curves.layers, curves.layers[0]]
    return CutEntities(*more, curves.aside, []), Bridge(start, end)


def about_shaft(
    curves: CutEntities, strokes: Strokes, shaft: tuple[float, float], fault: ReadError, unstated: float = 1.0
) -> tuple[Mask, tuple[str, ...]]:
    """Entities (n,) of a cam on its shaft, at (x, y), mm, and words for the others.

    Of a drawing that states no unit pieces and shaft are in its own unit, which is taken to be `unstated` mm long.

    Each layer is joined by itself, without what ends nowhere. The cam is what goes round the shaft and is neither a
    circle about it nor a frame of lines along x and y; what lies in it and meets none of it stays with it. Raises
    `fault`, the error of the whole drawing, where there is no such contour, where an open chain might have the cam as
    its bore, and where contours of several layers meet.
    """
    if fault.reason not in MENDED or len(set(curves.layers)) > MOST_LAYERS:
        raise fault
    layers = [joined(name, curves, strokes, fault.path) for name in dict.fromkeys(curves.layers)]
    # the cam: contours round the shaft, of the layers that have some that are no circles
    x, y = shaft
    placed = [(layer, [(ring, ring.contour.moved(-x, -y)) for ring in layer.chains]) for layer in layers]
    around = {layer.name: [ring for ring, contour in rings if goes_round(contour)] for layer, rings in placed}
    if not any(around.values()):  # but for a slot that reaches the shaft
        around = {
            layer.name: [ring for ring, contour in rings if closed_across(contour, "arc") is not None]
            for layer, rings in placed
        }
    cams = {
        name: [ring for ring in rings if circle_about(ring.contour, x, y) is None and not is_frame(ring.contour)]
        for name, rings in around.items()
    }
    cams = {name: rings for name, rings in cams.items() if rings} or {
        name: rings for name, rings in around.items() if any(not is_frame(ring.contour) for ring in rings)
    }
    if not cams:
        raise elsewhere(layers, shaft, fault, unstated)
    core = [ring for name in cams for ring in around[name] if not is_frame(ring.contour)]
    if first_meeting([ring.contour for ring in core]) is not None:
        raise fault
    outer = max(core, key=lambda ring: abs(ring.contour.area))
    for layer in layers:
        if not passable(strokes, layer.loose, outer.contour, shaft, beside=layer.name in cams):
            raise fault
    # what lies within the cam and does not meet it
    others = [ring for layer in layers for ring in layer.chains if not any(ring is other for other in core)]
    others = [ring for ring in others if inside(ring.contour, outer.contour)]
    about = [ring.contour for ring in core]
    others = [ring for ring in others if first_meeting([*about, ring.contour]) is None]
    kept = core if first_meeting([*about, *(ring.contour for ring in others)]) else [*core, *others]
    which = np.zeros(len(curves.shapes), dtype=np.bool_)
    which[np.concatenate([ring.entities for ring in kept])] = True
    return which, in_words(curves, which)


def elsewhere(
    layers: Sequence[Layer], shaft: tuple[float, float], fault: ReadError, unstated: float = 1.0
) -> ReadError:
    """Return the error where no contour goes round the shaft: places of cams where there are some, else `fault`.

    Contours and shaft are in units of `unstated` mm, the places in the error in mm.
    """
    rings = [ring.contour for layer in layers for ring in layer.chains if not is_frame(ring.contour)]
    rounds = {k: middle_of(ring) for k, ring in enumerate(rings)}
    round_rings = {k: at for k, at in rounds.items() if circle_about(rings[k], *at) is not None}
    cams = [ring for k, ring in enumerate(rings) if k not in round_rings]
    cams = [ring for ring in cams if not any(ring is not other and _holds(other, ring) for other in cams)]
    if not cams:
        return fault
    places = []
    for cam in cams[:MOST_NAMED]:
        bores = [k for k in round_rings if _holds(cam, rings[k])]
        largest = max(bores, key=lambda k: abs(rings[k].area), default=None)
        x, y = middle_of(cam) if largest is None else round_rings[largest]
        places.append(f"{unstated * x:.6g},{unstated * y:.6g}")
    where = ", ".join(f"{unstated * value:.9g}" for value in shaft)
    count = f"it has {len(cams)} cams, " if len(cams) > 1 else "it has a cam "
    told = f"no closed contour goes round {where}, where the shaft is; {count}at {' and '.join(places)}"
    error = ReadError("several", told, fault.path)
    error.cams, error.unstated = tuple(places), fault.unstated
    return error


def middle_of(contour: Contour) -> tuple[float, float]:
    """Middle (x, y) of a contour's box, mm."""
    x_min, y_min, x_max, y_max = contour.box
    return 0.5 * (x_min + x_max), 0.5 * (y_min + y_max)


def _holds(outer: Contour, contour: Contour) -> bool:
    return abs(outer.area) > abs(contour.area) and inside(contour, outer)


def joined(name: str, curves: CutEntities, strokes: Strokes, path: Path) -> Layer:
    """Closed chains of the layer `name`, and which pieces on it belong to none."""
    pieces, run, sound, near = strokes
    on = np.array([layer == name for layer in curves.layers])[run] & sound
    rows = np.flatnonzero(on)
    rows = rows[not_dangling(pieces.take(rows), run[rows], near)] if rows.size else rows
    try:
        rings = chain(pieces.take(rows), run[rows], near, path, some=True) if rows.size else []
    except ReadError:
        rings = []
    used = np.concatenate([np.empty(0, dtype=np.intp), *(ring.entities for ring in rings)])
    return Layer(name, rings, on & ~np.isin(run, used))


def not_dangling(pieces: Pieces, run: Indices, near: Closeness) -> Mask:
    """Which pieces (n,) are left when runs that end nowhere are taken away, again and again."""
    first = np.flatnonzero(np.diff(run, prepend=-1))
    last = np.append(first[1:], len(run)) - 1
    count = len(first)
    ends = np.concatenate([pieces.start[first], pieces.end[last]])
    reach = max(near.gap, near.near)
    if near.rounding is not None:
        reach = max(reach, 2.0 * float(near.rounding[run[first]].max(initial=0.0)))
    i, j = close_pairs(ends, reach)
    left = np.ones(count, dtype=np.bool_)
    while True:
        there = left[i % count] & left[j % count]
        met = np.bincount(np.concatenate([i[there], j[there]]), minlength=2 * count) > 0
        going = left & ~(met[:count] & met[count:])
        if not going.any():
            return np.repeat(left, last - first + 1)
        left &= ~going


def passable(strokes: Strokes, loose: Mask, outer: Contour, shaft: tuple[float, float], *, beside: bool) -> bool:
    """Whether pieces (n,) of a layer that are `loose` may be left out: whether the cam `outer` is no bore of theirs.

    What lies within the cam may, and single lines across it, as centre lines are. All others together stand `beside`
    its box if they are on its layer; on another they go round less than a third of a turn, lines along x and y, as of a
    frame, apart.
    """
    pieces, run, rows = strokes.pieces, strokes.run, np.flatnonzero(loose)
    if not rows.size:
        return True
    points = np.stack([pieces.points(rows, np.full(rows.size, share)) for share in ACROSS])
    metal = counter_clockwise(outer).as_arcs()[0]
    within = (signed_distance(metal, points.reshape(-1, 2)) < 0.0).reshape(points.shape[:2])
    line = pieces.kind[rows] == LINE
    alone = line & (np.bincount(run[loose], minlength=int(run.max()) + 1)[run[rows]] == 1)
    others = ~(within.all(axis=0) | (alone & within.any(axis=0)))
    if beside:
        box, rest = outer.box, points[:, others].reshape(-1, 2)
        low, high = (rest.min(axis=0), rest.max(axis=0)) if len(rest) else (np.inf, -np.inf)
        return bool((high < np.array([box.x_min, box.y_min])).any() or (low > np.array([box.x_max, box.y_max])).any())
    along = np.abs(pieces.end[rows] - pieces.start[rows])
    others &= ~(line & (along.min(axis=1) <= LEVEL * along.max(axis=1)))
    angle = np.unwrap(np.arctan2(points[..., 1] - shaft[1], points[..., 0] - shaft[0])[:, others], axis=0)
    seen = np.zeros(SECTORS, dtype=np.bool_)
    for low_, high_ in zip(angle.min(axis=0), angle.max(axis=0), strict=True):
        first, last = np.floor(np.array([low_, high_]) * SECTORS / TURN).astype(int)
        seen[np.arange(first, last + 1) % SECTORS] = True
    return bool(seen.mean() < MOST_ROUND)


def inside(contour: Contour, outer: Contour) -> bool:
    """Whether a contour that does not meet another lies within it."""
    return bool(signed_distance(counter_clockwise(outer).as_arcs()[0], contour.start[:1])[0] < 0.0)


def in_words(curves: CutEntities, which: Mask) -> tuple[str, ...]:
    """Entities that are not marked in `which` (n,), by layer and type."""
    others = [k for k in range(len(which)) if not which[k]]
    counted = Counter((curves.layers[k], curves.names[k].partition(" ")[0]) for k in others)
    words = [f"{number} {kind} on {short(layer) or 'no layer'}" for (layer, kind), number in counted.items()]
    more = [f"{len(words) - MOST_NAMED} more kinds"] if len(words) > MOST_NAMED else []
    return (*words[:MOST_NAMED], *more)
