"""Records against the standard library's frozen dataclasses, which they stand for."""

from __future__ import annotations

import dataclasses
import pickle
from typing import TYPE_CHECKING, ClassVar

import pytest

from kin.numeric.records import KW_ONLY, dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(frozen=True)
class Point:
    """Two fields, one of them with a default, and one that is found later."""

    unit: ClassVar[str] = "mm"
    x: float
    y: float = 0.0
    seen: list[float] = field(default_factory=list, init=False, repr=False, compare=False)

    @property
    def doubled(self) -> float:
        return 2 * self.x


@dataclass(frozen=True)
class Weighted(Point):
    """A field more."""

    weight: float = field(default=1.0, kw_only=True)


@dataclass(frozen=True, eq=False)
class Single:
    """Equal to itself alone, with a text of its own."""

    x: float

    def __repr__(self) -> str:
        return "single"


def test_values_are_compared_shown_and_hashed_by_their_fields() -> None:
    point = Point(1.0, 2.0)
    point.seen.append(3.0)
    assert point == Point(1.0, 2.0)
    assert point != Point(1.0, 2.5)
    assert point != Weighted(1.0, 2.0)
    assert len({point, Point(1.0, 2.0), Point(2.0, 1.0)}) == 2
    assert repr(point) == "Point(x=1.0, y=2.0)"
    assert repr(Weighted(1.0, weight=4.0)) == "Weighted(x=1.0, y=0.0, weight=4.0)"
    assert dataclasses.asdict(replace(point, y=5.0)) == {"x": 1.0, "y": 5.0, "seen": []}
    assert pickle.loads(pickle.dumps(point)) == point


def test_the_standard_library_agrees() -> None:
    standard = dataclasses.make_dataclass("Point", [("x", float), ("y", float, 0.0)], frozen=True)
    ours, theirs = Point(1.0, 2.0), standard(1.0, 2.0)
    assert repr(ours) == repr(theirs)
    assert hash(ours) == hash(theirs)


def test_without_equality_a_record_equals_itself_alone() -> None:
    assert Single(1.0) != Single(1.0)
    assert len({Single(1.0), Single(1.0)}) == 2
    assert repr(Single(1.0)) == "single"


@pytest.mark.parametrize("name", ["x", "seen", "other", "weight"])
@pytest.mark.parametrize("make", [Point, Weighted])
def test_no_field_is_set_twice_and_none_is_added(make: Callable[[float], Point], name: str) -> None:
    record = make(1.0)
    with pytest.raises(dataclasses.FrozenInstanceError, match=f"'{name}'"):
        setattr(record, name, 2.0)
    with pytest.raises(dataclasses.FrozenInstanceError, match=f"'{name}'"):
        delattr(record, name)
    assert record == make(1.0)


@dataclass(frozen=True)
class Late:
    """Fields by place and by key, some of them with defaults, and what is done at the end."""

    x: float
    _: KW_ONLY
    y: float
    z: float = 3.0
    ends: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.ends.append(self.z)


class Heir(Late):
    """Not decorated itself."""


@pytest.mark.parametrize("make", [Late, Heir])
def test_arguments_are_taken_by_place_by_key_and_by_default(make: Callable[..., Late]) -> None:
    assert (make(1.0, y=2.0).z, make(1.0, y=2.0).ends) == (3.0, [3.0])
    assert make(y=2.0, x=1.0, ends=[4.0]).ends == [4.0, 3.0]
    assert make(1.0, y=2.0) == make(1.0, y=2.0, z=3.0)
    for wrong, text in (((1.0,), "'y'"), ((1.0, 2.0), "positional")):
        with pytest.raises(TypeError, match=rf"Late.__init__\(\).*{text}"):
            make(*wrong)
    with pytest.raises(TypeError, match="'w'"):
        make(1.0, y=2.0, w=3.0)


def test_the_standard_library_sees_a_class_before_and_after_its_first_record() -> None:
    for first in (True, False):

        @dataclass(frozen=True, kw_only=True)
        class Fresh(Point):
            """Never seen before."""

            z: float = field(default=5.0, repr=False)

        assert Fresh.z == 5.0
        if first:
            assert Fresh(1.0).z == 5.0
        assert [entry.name for entry in dataclasses.fields(Fresh)] == ["x", "y", "seen", "z"]
        assert Fresh.__match_args__ == ("x", "y")
        assert replace(Fresh(1.0), z=2.0) == Fresh(1.0, z=2.0) != Fresh(1.0)
        assert repr(Fresh(1.0, z=2.0)).endswith("Fresh(x=1.0, y=0.0)")


def test_a_class_of_a_module_that_is_unloaded_is_still_a_dataclass(monkeypatch):
    import sys
    from types import ModuleType

    module = ModuleType("passing")
    monkeypatch.setitem(sys.modules, "passing", module)
    text = (
        "from __future__ import annotations\nfrom typing import ClassVar\nfrom kin.numeric.records import dataclass\n"
        "@dataclass(frozen=True)\nclass Passing:\n    kind: ClassVar[str] = 'passing'\n    width: float\n"
    )
    exec(text, vars(module))
    record = module.Passing(2.0)
    monkeypatch.delitem(sys.modules, "passing")
    assert replace(record, width=3.0).width == 3.0
    assert [entry.name for entry in dataclasses.fields(record)] == ["width"]
    assert "passing" not in sys.modules
