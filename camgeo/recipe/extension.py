"""What the reading of a recipe asks of capabilities."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.registry.slot import EMPTY, NO_CHECK, Slot, always
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.recipe.design_figure import DesignFigure
    from camgeo.registry.formats import Format
    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True, kw_only=True)
class Variant:
    """Option by which a file shows something in place of the cam alone.

    option   the key, whose default is the cam alone; it stands before the options of the format
    offered  whether files of a format have the key
    tag      text behind the recipe's name in the name of the first file of a format
    check    notes the faults of a file with the option: (values of the file, values of the recipe, reader)
    """

    option: Field
    offered: Callable[[Format], bool]
    tag: Callable[[Format], str]
    check: Callable[[Values, Values, Reader], None]

    @property
    def options(self) -> tuple[Field, ...]:
        """Keys of a file."""
        return (self.option,)

    def chosen(self, file: Values) -> bool:
        """Whether the values of a file have the option at another value than its default."""
        return bool(file.get(self.option.name, self.option.default) != self.option.default)


@dataclass(frozen=True, kw_only=True)
class Alteration:
    """Option by which a file alters the part that it shows, beside kerf, clearance and shrinkage.

    option   the key, a number whose default leaves the part as it is; it stands before the options of the format
    offered  whether files of a format have the key
    check    notes the faults of a file with another number: (values of the file, values of the recipe, reader)
    beside   a choice that goes with it, which a file gives beside the number alone; None without one
    """

    option: Field
    offered: Callable[[Format], bool]
    check: Callable[[Values, Values, Reader], None]
    beside: Field | None = None

    @property
    def options(self) -> tuple[Field, ...]:
        """Keys of a file: the option, and the choice that goes with it."""
        return (self.option,) if self.beside is None else (self.option, self.beside)

    def word(self, file: Values) -> tuple[str, str] | None:
        """Key and word of the choice of a file; None for its default, and without a choice."""
        word = None if self.beside is None else file.get(self.beside.name)
        return None if self.beside is None or word in {None, self.beside.default} else (self.beside.name, str(word))

    def chosen(self, file: Values) -> float | None:
        """Number that the values of a file give for the option; None for the default, which alters nothing."""
        value = file.get(self.option.name)
        return None if value is None or value == float(self.option.default) else float(value)


@dataclass(frozen=True, kw_only=True)
class Keys:
    """Answers of a capability with words of its own in recipes. Lengths are in mm, angles in rad.

    fields      keys of the top level, each with the core's key behind which it stands as `after`
    check       notes all faults between its keys and others: `reader.fault_at(path, problem, value, remedy)`
    build       object that `recipe.of(Class)` gives, from values without faults; None where the recipe has none
    speed       turns a minute of the shaft, from that object; None where the recipe gives no speed
    profile     path of the field that gives the profile tolerance of the made contour, and the width of the zone, mm,
                from that object; None without one. Of several capabilities the one of the highest rank counts
    figures     by name, as recipes limit them and sweeps rank by them
    variant     option by which a file shows something else than the cam; None for none
    alteration  option by which a file alters the part that it shows; None for none
    """

    fields: Callable[[], Sequence[Field]] = always(())
    check: Callable[[Values, Reader], None] = NO_CHECK
    build: Callable[[Values], object | None] = always(None)
    speed: Callable[[Any], float | None] = always(None)
    profile: Callable[[Any], tuple[str, float] | None] = always(None)
    figures: Mapping[str, DesignFigure] = EMPTY
    variant: Variant | None = None
    alteration: Alteration | None = None


KEYS = Slot("recipe", Keys())
