"""Where a STEP file puts its solid, and in which units: the placement of its representation, assemblies, contexts.

A kernel turns and shifts a solid by the AXIS2_PLACEMENT_3D among the items of the representation that holds it, and by
the transformation of each assembly that it stands in, from the innermost out (ISO 10303-43, 5.4; held against Open
CASCADE by the tests). What is not understood here is refused with its number, never passed over.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.read.step.curves import Frame, StepFile
from kin.read.step.part21 import Reference, Typed

if TYPE_CHECKING:
    from kin.read.step.part21 import Exchange, Value

# Mm in a metre under each prefix of an SI unit.
PREFIXES = {
    "MICRO": 1e-3, "MILLI": 1.0, "CENTI": 10.0, "DECI": 100.0, "DECA": 1e4, "HECTO": 1e5, "KILO": 1e6, "NANO": 1e-6,
}  # fmt: skip
REPRESENTATIONS = (
    "ADVANCED_BREP_SHAPE_REPRESENTATION",
    "SHAPE_REPRESENTATION",
    "MANIFOLD_SURFACE_SHAPE_REPRESENTATION",
)
# Ends are joined within the accuracy that the file states, but no closer and no farther than this, mm.
ACCURACY = (1e-6, 1e-3)
AXES = "AXIS2_PLACEMENT_3D"
RELATED, PLAIN = "REPRESENTATION_RELATIONSHIP", "SHAPE_REPRESENTATION_RELATIONSHIP"
TRANSFORMED = "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"
IN_PLACE = "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION"
OCCURRENCE = "NEXT_ASSEMBLY_USAGE_OCCURRENCE"
# What could put a solid somewhere else, and is not read.
UNREAD = ("MAPPED_ITEM", "SOLID_REPLICA", "GEOMETRIC_REPLICA", "ASSEMBLY_COMPONENT_USAGE_SUBSTITUTE")
SAME = 1e-12  # of directions, and of places in mm
DEEPEST = 16  # of assemblies within assemblies


def space_of(file: Exchange, solid: int, *, alone: bool = True) -> StepFile:
    """Units, accuracy and place of the representation that holds the solid of a number.

    `alone` says that the file may place no other solid. Raises ReadError for units, placements and assemblies that are
    not read.
    """
    for kind in UNREAD:
        for number in file.of(kind):
            raise file.error(number, "is not read; export the part alone, with nothing put together")
    # the representation that lists the solid, its units, and the coarsest accuracy that it states
    holders = [
        (number, kind)
        for kind in REPRESENTATIONS
        for number in file.of(kind)
        if any(item == solid for item in file.several(file.values(number, kind, 3)[1], number))
    ]
    if len(holders) != 1:
        raise file.error(solid, f"{len(holders)} representations hold it, one belongs there", "syntax")
    holder, kind = holders[0]
    context = file.reference(file.values(holder, kind, 3)[2], holder)
    length, angle = _units(file, context)
    accuracy = 0.0
    if "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT" in file.instances[context]:
        for item in file.several(file.values(context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", 1)[0], context):
            measure = file.reference(item, context)
            size = file.values(measure, "UNCERTAINTY_MEASURE_WITH_UNIT", 2)[0]
            if isinstance(size, Typed) and size.name == "LENGTH_MEASURE":
                accuracy = max(accuracy, file.number(size, measure) * length)
    drawn = StepFile(file, length, angle, min(max(accuracy, ACCURACY[0]), ACCURACY[1]))
    place = _Places(drawn).of(holder, alone=alone)
    return drawn if _still(place) else drawn._replace(place=place)


class _Places:
    """The placements of a file's representations, in the unit of the representation that holds the solid."""

    def __init__(self, space: StepFile) -> None:
        self.space, self.file = space, space.file
        file = self.file
        self.plain: list[tuple[int, int, int]] = []
        self.moved: dict[int, tuple[int, int]] = {}
        for number, records in file.instances.items():
            kind = RELATED if records.get(RELATED) else PLAIN if records.get(PLAIN) else None
            if kind is None:
                if TRANSFORMED in records:
                    raise file.error(number, "relates no two representations", "syntax")
                continue
            first, second = (file.reference(value, number) for value in file.values(number, kind, 4)[2:4])
            if TRANSFORMED in records:
                self.moved[number] = (first, second)
            else:
                self.plain.append((number, first, second))

    def of(self, holder: int, *, alone: bool) -> Frame | None:
        """Where the solid of a representation stands in the outermost assembly, `alone` there or with other solids.

        None where nothing places it.
        """
        file = self.file
        same = self._alike(holder)
        for related in same - {holder}:
            if not _still(self._own(related)) and not _agree(self._own(related), self._own(holder)):
                raise file.error(related, f"has another placement than #{holder}, to which it is related")
        placement = self._own(holder)
        if self.moved and not _still(placement):
            raise file.error(holder, "is placed by itself and by an assembly; export the part alone")
        seats = file.of(IN_PLACE)
        if not len(seats) == len(self.moved) == len(file.of(OCCURRENCE)):
            named = next(iter([*self.moved, *seats, *file.of(OCCURRENCE)]))
            raise file.error(named, "belongs to an assembly that is not whole; export the part alone")
        # from the innermost assembly out, each relation puts the part into its parent once
        used: set[int] = set()
        while len(used) < len(self.moved):
            seat = [number for number, (child, _) in self.moved.items() if child in same and number not in used]
            if not seat and not alone:
                break  # the others place other solids
            if len(seat) != 1 or len(used) == DEEPEST:
                number = seat[0] if seat else next(related for related in self.moved if related not in used)
                raise file.error(number, "puts more than the one part in place; export the part alone")
            number = seat[0]
            used.add(number)
            child, parent = self.moved[number]
            self._demand_same_unit(parent)
            self._demand_occurrence(number, child, parent)
            placement = _after(self._transformation(number, child, parent), placement)
            same = self._alike(parent)
        return placement

    def _alike(self, name: int) -> set[int]:
        """Return the numbers of a representation and of all that are related to it without a transformation."""
        alike, fresh = {name}, [name]
        while fresh:
            representation = fresh.pop()
            near = {b if a == representation else a for _, a, b in self.plain if representation in (a, b)} - alike
            alike |= near
            fresh += near
        return alike

    def _items(self, number: int) -> tuple[Value, ...]:
        file = self.file
        kind = file.kind(number, REPRESENTATIONS, number)
        return file.several(file.values(number, kind, 3)[1], number)

    def _own(self, number: int) -> Frame | None:
        """Return the one placement among a representation's items, None without any."""
        axes = [
            item
            for item in self._items(number)
            if isinstance(item, Reference) and AXES in self.file.instances.get(item, {})
        ]
        frames = [self._frame(item, number) for item in axes]
        if any(not _agree(frame, frames[0]) for frame in frames[1:]):
            raise self.file.error(number, f"has {len(frames)} placements that differ; one belongs there")
        return frames[0] if frames else None

    def _frame(self, value: Value, by: int) -> Frame:
        number = self.file.reference(value, by)
        axes = self.file.values(number, AXES, 2)
        if len(axes) > 2 and axes[2] is not None and (len(axes) < 4 or axes[3] is None):
            raise self.file.error(number, "leaves out its x axis, which kernels take differently")
        return self.space.frame(value, by)

    def _transformation(self, number: int, child: int, parent: int) -> Frame:
        """Where the assembly `parent` puts the axes of `child`, by the relation of a number."""
        file = self.file
        item = file.reference(file.values(number, TRANSFORMED, 1)[0], number)
        file.kind(item, ("ITEM_DEFINED_TRANSFORMATION",), number)
        first, last = file.values(item, "ITEM_DEFINED_TRANSFORMATION", 4)[2:4]
        matches = first in self._items(child) and last in self._items(parent)
        if not matches or not _still(self._frame(first, item)):
            raise file.error(item, "does not take the child's own axes to a placement of its parent; export it alone")
        return self._frame(last, item)

    def _demand_same_unit(self, number: int) -> None:
        file = self.file
        context = file.reference(file.values(number, file.kind(number, REPRESENTATIONS, number), 3)[2], number)
        if _units(file, context)[0] != self.space.mm:
            raise file.error(number, "is in another unit than its part; export the part alone")

    def _demand_occurrence(self, number: int, child: int, parent: int) -> None:
        """Raise ReadError for a relation whose two sides are not the assembly and part of the occurrence it places."""
        file = self.file
        seat = next((s for s in file.of(IN_PLACE) if file.values(s, IN_PLACE, 2)[0] == number), None)
        if seat is None:
            raise file.error(number, "puts nothing in place", "syntax")
        shape = file.reference(file.values(seat, IN_PLACE, 2)[1], seat)
        use = file.reference(file.values(shape, "PRODUCT_DEFINITION_SHAPE", 3)[2], shape)
        whole, part = file.values(use, OCCURRENCE, 5)[3:5]
        if whole not in self._products(parent) or part not in self._products(child):
            raise file.error(use, "its assembly and part are not those of its placement; export the part alone")

    def _products(self, number: int) -> set[Value]:
        """Return the product definitions that a representation shows."""
        file, kind = self.file, "SHAPE_DEFINITION_REPRESENTATION"
        alike = self._alike(number)
        shown = [file.values(definition, kind, 2) for definition in file.of(kind)]
        shapes = [file.reference(shape, number) for shape, drawn in shown if drawn in alike]
        return {file.values(shape, "PRODUCT_DEFINITION_SHAPE", 3)[2] for shape in shapes}


def _still(place: Frame | None) -> bool:
    """Whether a place leaves every point where it is."""
    return place is None or bool((np.abs(np.array(place) - np.array([np.zeros(3), *np.eye(3)])) <= SAME).all())


def _agree(first: Frame | None, other: Frame | None) -> bool:
    if first is None or other is None:
        return _still(first) and _still(other)
    return bool((np.abs(np.array(first) - np.array(other)) <= SAME).all())


def _after(outer: Frame, inner: Frame | None) -> Frame | None:
    """Return the place that does `inner` and then `outer`."""
    if _still(outer) or inner is None:
        return inner if inner is not None else outer
    turn = np.array(outer[1:])
    return Frame(outer.origin + inner.origin @ turn, *(np.array(inner[1:]) @ turn))


def _units(file: Exchange, context: int) -> tuple[float, float | None]:
    """Length of a context's unit, mm, and its unit of plane angle, rad, if it states one."""
    units = file.several(file.values(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT", 1)[0], context)
    sizes: dict[str, float] = {}
    for item in units:
        unit = file.reference(item, context)
        records = file.instances.get(unit, {})
        for kind in ("LENGTH_UNIT", "PLANE_ANGLE_UNIT"):
            if kind in records and sizes.setdefault(kind, _unit(file, unit)) != _unit(file, unit):
                raise file.error(context, f"has more than one {kind}")
    length = sizes.get("LENGTH_UNIT")
    if length is None or not 1e-9 < length < 1e9:
        raise file.error(context, "states no unit of length")
    return length, sizes.get("PLANE_ANGLE_UNIT")


def _unit(file: Exchange, number: int, depth: int = 0) -> float:
    """Mm or rad in a unit: an SI unit, or one that is given by another."""
    records = file.instances[number]
    if "SI_UNIT" in records:
        prefix, name, *_ = file.values(number, "SI_UNIT", 2)
        if name == "RADIAN" and prefix is None:
            return 1.0
        if name == "METRE" and (prefix is None or prefix in PREFIXES):
            return 1000.0 if prefix is None else PREFIXES[str(prefix)]
        raise file.error(number, f"is not a unit that is read: {prefix} {name}")
    if "CONVERSION_BASED_UNIT" not in records or depth > 3:
        raise file.error(number, "is not a unit that is read")
    measure = file.reference(file.values(number, "CONVERSION_BASED_UNIT", 2)[1], number)
    kinds = ("LENGTH_MEASURE_WITH_UNIT", "PLANE_ANGLE_MEASURE_WITH_UNIT", "MEASURE_WITH_UNIT")
    size, unit, *_ = file.values(measure, file.kind(measure, kinds, number), 2)
    base = file.reference(unit, measure)
    if base not in file.instances:
        raise file.error(measure, f"refers to #{base}, which is not there", "syntax")
    return file.number(size, measure) * _unit(file, base, depth + 1)
