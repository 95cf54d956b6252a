"""A motion that is a list of segments: what the page draws of it, and segments changed in the text of a recipe."""

from __future__ import annotations

from math import floor, isclose, log10
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import camgeo
from camgeo.motions.motion import Segments
from camgeo.schema.change import insert_item, move_item, remove_item, replace_entry, set_value
from camgeo.schema.edit import number_text
from camgeo.schema.scalars import Complaint, read_number
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, Source, entries

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.motions.stated import StatedMotion
    from camgeo.schema.change import Value
    from camgeo.schema.yaml_source import Node

SHAPE = 24  # steps in which the page draws a segment
PLACES = 9  # decimals of inputs and lifts: more are rounding
SOURCES = {
    "table": "The motion is a table: its rows are changed in the file, or as text.",
    "points": "The motion is a spline through points: they are changed as text.",
    "formula": "The motion is a formula, which is changed in its box.",
    "lobe": "The motion is a lobe, whose lift and angles are changed in their boxes.",
    "contour": "The motion is taken from a drawing of a cam, which is changed where it was drawn.",
}
"""Why there is nothing to drag, by the key of a motion's source."""
OPPOSITE = {"rise": "return", "return": "rise"}


class _Segment(NamedTuple):
    """A segment as the recipe has it: kind, extent, and how much higher its end lies, in the units of the plot."""

    kind: str
    over: float
    change: float
    shape: list[float]
    free: bool
    node: Mapping


class _Motion(NamedTuple):
    """A motion of segments over `total` of its input; `behind` says what follows, as of a `StatedMotion`.

    `step` is the least extent of a segment that is drawn, and the least move of a joint along the input.
    """

    path: str
    total: float
    step: float
    unit: str
    repeat: int
    behind: str
    start: float
    segments: list[_Segment]

    @property
    def closed(self) -> bool:
        """Whether it goes on as it began, so that it ends where it began."""
        return self.behind == "same"


def drawn(source: Source, stated: StatedMotion | str) -> dict[str, Any]:
    """The motion as the page draws it: its segments with their shapes, or why there is nothing to drag.

    Inputs and lifts are in the units of the plot; the shape of a segment goes from 0 to 1 with its lift.
    """
    motion = _motion(source, stated)
    if isinstance(motion, str):
        return {"why": motion}
    segments = [{**segment._asdict(), "node": None, "flow": segment.node.flow} for segment in motion.segments]
    return {**motion._asdict(), "why": "", "segments": segments, "closed": motion.closed}


def _motion(source: Source, stated: StatedMotion | str) -> _Motion | str:
    """The segments of a recipe's motion, or why it has none to drag."""
    if isinstance(stated, str):
        return stated
    cam = entries(source.root).get("cam") if isinstance(source.root, Mapping) else None
    node = entries(cam).get("motion") if isinstance(cam, Mapping) else None
    if node is None:
        return "The recipe of this cam gives no motion over the shaft angle: change what it gives in its boxes."
    path = "cam.motion"
    if isinstance(node, Mapping) and isinstance(entries(node).get("segments"), Sequence):
        path, node = "cam.motion.segments", entries(node)["segments"]
    if isinstance(node, Mapping):
        return next((why for key, why in SOURCES.items() if key in entries(node)), "The motion is changed as text.")
    given = stated.source
    if not isinstance(given, Segments) or not isinstance(node, Sequence):
        return "The motion is changed as text."
    total = stated.total / stated.repeat
    if not isclose(sum(segment.over for segment in given.segments), total):
        return "The travel of this motion is found by sizing: give its lengths as numbers to draw it."
    ends = np.cumsum([0.0, *(segment.over for segment in given.segments)])
    places = np.linspace(0.0, 1.0, SHAPE + 1)
    segments = []
    for segment, item, first, last in zip(given.segments, node.items, ends[:-1], ends[1:], strict=True):
        if not isinstance(item, Mapping):
            return "The motion is changed as text."
        inputs = first + (last - first) * np.where(places == 1.0, 1.0 - 1e-9, places)
        lifts = stated.lift(inputs) * stated.per_lift
        change = 0.0 if segment.kind in {"dwell", "rise_fall"} else float(lifts[-1] - lifts[0])
        height = float(np.abs(lifts - lifts[0]).max()) if segment.kind == "rise_fall" else change
        shape = (lifts - lifts[0]) / height if abs(height) > 1e-12 else np.zeros_like(lifts)
        words = [one.text for key, one in entries(item).items() if key in {"over", "dwell"} and isinstance(one, Scalar)]
        free = not set(words).isdisjoint({"least", "rest"})
        over = round(float(last - first) * stated.per_input, PLACES)
        segments.append(_Segment(segment.kind, over, _brief(change), [round(float(s), 4) for s in shape], free, item))
    start = _brief(float(stated.lift(np.zeros(1))[0]) * stated.per_lift)
    extent = round(total * stated.per_input, PLACES)
    angle = isclose(stated.per_input, float(np.degrees(1.0)))
    step = 1.0 if angle else 10.0 ** floor(log10(extent / 50.0))
    unit = "degrees" if angle else "units of the travel"
    return _Motion(path, extent, step, unit, stated.repeat, stated.behind, start, segments)


def _brief(value: float) -> float:
    """A lift without the rounding of its motion, which is made within 1e-9 of its size."""
    return float(f"{value:.8g}") if abs(value) > 1e-9 else 0.0


# --- changes ----------------------------------------------------------------------------------------------------------


def changed(source: Source, stated: StatedMotion | str, change: str, index: int, at: float) -> tuple[str, int]:
    """The text of a recipe with its segments changed, and the index of the segment that is chosen then.

    `change` is a word of `CHANGES`; `at` is the input of a new joint, as in the plot, or how often the motion repeats.
    Raises CallError where that cannot be, and RecipeErrors for texts that cannot be changed without harm.
    """
    motion = _motion(source, stated)
    if isinstance(motion, str):
        raise camgeo.CallError(motion)
    if not 0 <= index < len(motion.segments):
        raise camgeo.CallError("choose a segment first")
    return CHANGES[change](_Text(source, motion), index, at)


class _Text:
    """Text of a recipe under change, with the segments as they were at first."""

    def __init__(self, source: Source, motion: _Motion) -> None:
        self.source, self.motion = source, motion

    @property
    def text(self) -> str:
        """The text as it is now."""
        return self.source.text

    def take(self, text: str) -> None:
        self.source = Source.of(text, self.source.file)

    def put(self, index: int, key: str, value: Value) -> None:
        """Give a key of a segment another value, or its number another one with few decimals."""
        if isinstance(value, float):
            value = _few(value)
        self.take(set_value(self.source, f"{self.motion.path}[{index}].{key}", value))

    def insert(self, index: int, value: dict[str, Value]) -> None:
        few = {key: _few(one) if isinstance(one, float) else one for key, one in value.items()}
        self.take(insert_item(self.source, self.motion.path, index, few))

    def remove(self, index: int) -> None:
        self.take(remove_item(self.source, self.motion.path, index))


def _few(value: float) -> float:
    return float(number_text(round(value, PLACES)))


def _angle_key(segment: _Segment) -> str:
    return "dwell" if segment.kind == "dwell" else "over"


def _stroke(segment: _Segment) -> float:
    """How much a segment rises or falls, above 0."""
    return abs(segment.change)


def _law(segment: _Segment) -> dict[str, Value]:
    """What a segment says of its law, for another one like it."""
    return {key: _plain(node) for key, node in entries(segment.node).items() if key in {"law", "split"}}


def _plain(node: Node) -> Value:
    """The value of a tree as it may be written anew: numbers as numbers, all else as texts."""
    if isinstance(node, Sequence):
        return [_plain(item) for item in node.items]
    if isinstance(node, Mapping):
        return {key: _plain(one) for key, one in entries(node).items()}
    try:
        return read_number(node.text)
    except Complaint:
        return node.text


def _demand_room(motion: _Motion, segment: _Segment) -> None:
    """Refuse a segment that is too short to be two."""
    if segment.free:
        raise camgeo.CallError("the angle of this segment is left open: give it a number first")
    if segment.over < 2.0 * motion.step:
        raise camgeo.CallError(f"this segment is shorter than {2.0 * motion.step:g} {motion.unit}: lengthen it first")


def _level(motion: _Motion, index: int) -> float:
    """Displacement at the end of a segment, from the beginning of the motion."""
    return sum(segment.change for segment in motion.segments[: index + 1])


def _split(text: _Text, index: int, share: float) -> tuple[str, int]:
    """A joint within a segment, on its curve; each part has the law of the whole."""
    segment, motion = text.motion.segments[index], text.motion
    _demand_room(motion, segment)
    step = motion.step
    first = min(max(round(segment.over * share / step) * step, step), segment.over - step)
    rest = segment.over - first
    if segment.kind == "displacement":
        raise camgeo.CallError("a displacement by a formula is not split: write the parts as text")
    if segment.kind == "dwell":
        text.put(index, "dwell", first)
        text.insert(index + 1, {"dwell": rest})
        return text.text, index
    if segment.kind == "rise_fall":
        height = _stated(segment)
        text.take(replace_entry(text.source, f"{motion.path}[{index}].rise_fall", "rise", height))
        text.put(index, "over", first)
        text.insert(index + 1, {"return": height, "over": rest})
        return text.text, index
    places = np.linspace(0.0, 1.0, SHAPE + 1)
    lift = _on_grid(abs(float(np.interp(first / segment.over, places, segment.shape))), segment)
    text.put(index, "over", first)
    if segment.kind == "to":
        level = _level(motion, index)
        text.put(index, "to", level - segment.change + np.sign(segment.change) * lift)
        text.insert(index + 1, {"to": level, "over": rest, **_law(segment)})
        return text.text, index
    text.put(index, segment.kind, lift)
    text.insert(index + 1, {segment.kind: _stroke(segment) - lift, "over": rest, **_law(segment)})
    return text.text, index


def _on_grid(share: float, segment: _Segment) -> float:
    """A share of a segment's stroke, within a hundredth of it and above 0, and less than all of it."""
    stroke = _stroke(segment)
    by = float(f"{stroke / 100.0:.1g}") or stroke / 100.0
    return min(max(round(stroke * share / by), 1), int(stroke / by) - 1) * by


def _stated(segment: _Segment) -> float:
    value = _plain(entries(segment.node)[segment.kind])
    if not isinstance(value, float):
        raise camgeo.CallError("give the height of this segment as a number without a unit first")
    return value


def _add(text: _Text, _: int, at: float) -> tuple[str, int]:
    """A joint at an angle of the shaft."""
    motion = text.motion
    angle = at % motion.total if motion.closed else at
    if not motion.closed and at > motion.total:
        raise camgeo.CallError(f"the motion is given up to {motion.total:g} {motion.unit}; what follows comes of it")
    for index, segment in enumerate(motion.segments):
        if angle < segment.over or index == len(motion.segments) - 1:
            return _split(text, index, min(angle / segment.over, 1.0))
        angle -= segment.over
    raise AssertionError(at)


def _halve(text: _Text, index: int, _: float) -> tuple[str, int]:
    return _split(text, index, 0.5)


def _partner(motion: _Motion, index: int) -> int | None:
    """Index of the segment that falls what this one rises, or rises what it falls; None without one."""
    count, kind = len(motion.segments), motion.segments[index].kind
    steps = range(1, count) if kind == "rise" else range(-1, -count, -1)
    around = [(index + step) % count for step in steps if motion.closed or 0 <= index + step < count]
    return next((i for i in around if motion.segments[i].kind == OPPOSITE.get(kind)), None)


def _copy(text: _Text, index: int, _: float) -> tuple[str, int]:
    """A segment twice, each over half of its angle; its partner moves as much as both."""
    segment, motion = text.motion.segments[index], text.motion
    _demand_room(motion, segment)
    if segment.kind in {"dwell", "to"}:
        return _split(text, index, 0.5)
    partner = _partner(motion, index)
    if segment.kind in OPPOSITE:
        if partner is None and motion.closed:
            raise camgeo.CallError(f"there is no {OPPOSITE[segment.kind]} that could move as much: add one first")
        if partner is not None:
            text.put(partner, OPPOSITE[segment.kind], _stroke(motion.segments[partner]) + _stroke(segment))
    half = round(0.5 * segment.over, PLACES)
    text.put(index, "over", half)
    twin = {key: _plain(node) for key, node in entries(segment.node).items()}
    text.insert(index + 1, {**twin, "over": segment.over - half})
    return text.text, index + 1


def _delete(text: _Text, index: int, _: float) -> tuple[str, int]:
    """All but a segment; its partner moves less by as much, or goes too.

    The angle goes to a dwell beside it, or becomes one; that of a dwell goes to the segment behind it.
    """
    motion = text.motion
    gone, segment = {index}, motion.segments[index]
    if segment.kind in OPPOSITE:
        partner = _partner(motion, index)
        if partner is not None:
            left = _stroke(motion.segments[partner]) - _stroke(segment)
            if left > 1e-9:
                text.put(partner, OPPOSITE[segment.kind], left)
            elif left > -1e-9:
                gone.add(partner)
            else:
                raise camgeo.CallError(f"its {OPPOSITE[segment.kind]} moves less than it: make this one smaller first")
        elif motion.closed:
            raise camgeo.CallError("nothing moves back what this segment moves: change it as text")
    elif segment.kind in {"to", "displacement"} and motion.closed and segment.change:
        raise camgeo.CallError("the cycle would not close: change this segment as text")
    if all(one.kind == "dwell" for i, one in enumerate(motion.segments) if i not in gone):
        raise camgeo.CallError("something must move: nothing but dwells would be left")
    left_over = [*motion.segments]
    for one in sorted(gone, reverse=True):
        segment = left_over[one]
        beside = [i for i in (one - 1, one + 1) if 0 <= i < len(left_over) and left_over[i].kind == "dwell"]
        if segment.kind == "dwell":
            beside = [i for i in (one + 1, one - 1) if 0 <= i < len(left_over)]
        if segment.free or any(left_over[i].free for i in beside[:1]):
            raise camgeo.CallError("an angle is left open: give it a number first")
        text.remove(one)
        if beside:
            taker = left_over[beside[0]]
            left_over[beside[0]] = taker._replace(over=taker.over + segment.over)
            del left_over[one]
            place = beside[0] - (beside[0] > one)
            text.put(place, _angle_key(taker), left_over[place].over)
        else:
            left_over[one] = segment._replace(kind="dwell", change=0.0)
            text.insert(one, {"dwell": segment.over})
    return text.text, min(index, len(left_over) - 1)


def _repeat(text: _Text, index: int, times: float) -> tuple[str, int]:
    """The segments so many times a turn, each over as much less."""
    motion, count = text.motion, round(times)
    if not motion.closed:
        half = "this cam's motion fills half a turn, and the other half follows from it"
        raise camgeo.CallError(half if motion.behind == "opposite" else "a travel from end to end does not repeat")
    if not 1 <= count <= 100:
        raise camgeo.CallError("give a whole number from 1 to 100")
    if any(segment.free for segment in motion.segments):
        raise camgeo.CallError("an angle is left open: give it a number first")
    left = round(motion.total * motion.repeat / count, PLACES)  # what the last one takes, so that they fill the turn
    for i, segment in enumerate(motion.segments):
        over = left if i == len(motion.segments) - 1 else round(segment.over * motion.repeat / count, PLACES)
        left -= over
        text.put(i, _angle_key(segment), over)
    if motion.path.endswith(".segments"):
        text.take(set_value(text.source, "cam.motion.repeat", count))
    elif count > 1:
        text.take(_within_repeat(text.source, count))
    return text.text, index


def _within_repeat(source: Source, count: int) -> str:
    """The text with the list of the motion below `segments`, beside `repeat`; every comment stays."""
    assert isinstance(source.root, Mapping)
    cam = entries(source.root)["cam"]
    assert isinstance(cam, Mapping)
    key, items = next(pair for pair in cam.entries if isinstance(pair[0], Scalar) and pair[0].text == "motion")
    first, end = source.index(items.mark), source.index(items.end)
    if isinstance(items, Sequence) and items.flow:
        return f"{source.text[:first]}{{repeat: {count}, segments: {source.text[first:end]}}}{source.text[end:]}"
    line, column = items.mark
    if column <= key.mark[1]:
        raise camgeo.CallError("indent the list of segments in the text first")
    start = source.starts[line - 1]
    indent = " " * (column - 1)
    return f"{source.text[:start]}{indent}repeat: {count}\n{indent}segments:\n{source.text[start:]}"


def _reverse(text: _Text, index: int, _: float) -> tuple[str, int]:
    """The motion backwards: the last segment first, rises for returns; where its opposite follows rises stay rises."""
    motion = text.motion
    flips = motion.behind != "opposite"
    for number, segment in enumerate(motion.segments, 1):
        given = entries(segment.node)
        law = given.get("law")
        own = isinstance(law, Mapping) and "uniform" in entries(law)
        mirrored = np.allclose(np.array(segment.shape) + segment.shape[::-1], 1.0, atol=2e-3)
        turned = not (flips or segment.kind in {"dwell", "rise_fall"} or mirrored)
        if "at_end" in given or segment.kind == "displacement" or own or turned:
            raise camgeo.CallError(f"segment {number} has a law that does not run backwards: change it as text")
    new, last = text.text, len(motion.segments) - 1
    for segment in reversed(motion.segments):
        if segment.kind in OPPOSITE and flips:
            key = next(one for one, _ in segment.node.entries if isinstance(one, Scalar) and one.text == segment.kind)
            first, end = text.source.index(key.mark), text.source.index(key.end)
            new = new[:first] + OPPOSITE[segment.kind] + new[end:]
    text.take(new)
    for i, segment in enumerate(motion.segments):
        if segment.kind == "to":
            level = _level(motion, i - 1) - _level(motion, last)
            text.put(i, "to", level if flips else -level)
    for i in range(last):
        text.take(move_item(text.source, motion.path, last, i))
    return text.text, last - index


CHANGES: dict[str, Callable[[_Text, int, float], tuple[str, int]]] = {
    "add": _add,
    "split": _halve,
    "copy": _copy,
    "delete": _delete,
    "repeat": _repeat,
    "reverse": _reverse,
}
