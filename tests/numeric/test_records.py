"""Records against the standard library's frozen dataclasses, which they stand for."""

from __future__ import annotations

import dataclasses
import pickle
from typing import TYPE_CHECKING, Any, ClassVar

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


def test_the_init_of_an_heir_calls_that_of_its_base_first_of_all():
    class Own(Late):
        """Arguments of its own."""

        def __init__(self) -> None:
            super().__init__(1.0, y=2.0)

    for _ in range(2):

        @dataclass(frozen=True)
        class Base:
            """Never made before."""

            x: float

        class Doubled(Base):
            """As much again."""

            def __init__(self, x: float) -> None:
                super().__init__(2.0 * x)

        assert Doubled(1.5).x == Doubled(1.5).x == 3.0
    assert Own().ends == [3.0]


def test_threads_that_use_a_class_first_find_it_whole():
    import sys
    from concurrent.futures import ThreadPoolExecutor

    def used() -> list[object]:
        @dataclass(frozen=True)
        class Shared(Point):
            """A base has fewer fields: what a class lacks for a moment is read from there."""

            weight: float = field(default=1.0)
            name: str = "cam"

        def use(number: int) -> object:
            changed = replace(Shared(1.0, weight=2.0), name=str(number))
            return changed.weight, changed.name, len(dataclasses.fields(Shared)), Shared.__match_args__

        with ThreadPoolExecutor(8) as pool:
            return list(pool.map(use, range(8)))

    expected = [(2.0, str(number), 5, ("x", "y", "weight", "name")) for number in range(8)]
    interval = sys.getswitchinterval()
    try:
        sys.setswitchinterval(1e-6)
        for _ in range(40):
            assert used() == expected
    finally:
        sys.setswitchinterval(interval)


def test_the_standard_library_takes_a_default_that_only_it_would_refuse():
    from types import MappingProxyType

    @dataclass(frozen=True)
    class Viewed:
        """A read-only view of a dictionary cannot be altered through a record."""

        shown: object = MappingProxyType({"x": 1.0})

    assert dataclasses.fields(Viewed)[0].default == {"x": 1.0}
    assert dataclasses.is_dataclass(Viewed())
    assert replace(Viewed(), shown=None).shown is None


def test_defaults_that_the_standard_library_refuses_for_a_reason_are_refused():
    @dataclass(frozen=True)
    class Alterable:
        """Each record would have the same list."""

        seen: list[float] = []  # noqa: RUF012 - what is refused

    @dataclass(frozen=True)
    class Behind:
        """Python gives defaults to the last arguments."""

        x: float = 1.0
        y: float  # type: ignore[misc]

    cases: list[tuple[Any, type[Exception], str]] = [(Alterable, ValueError, "seen"), (Behind, TypeError, "y")]
    for kind, error, name in cases:
        with pytest.raises(error, match=rf"{kind.__name__}\.{name}"):
            kind()


def test_a_standard_dataclass_is_a_base_and_an_heir():
    @dataclasses.dataclass(frozen=True)
    class Base:
        """Made by the standard library."""

        unit: ClassVar[str] = "mm"
        x: float

    @dataclass(frozen=True)
    class Middle(Base):
        """A record."""

        y: float = 2.0

    @dataclasses.dataclass(frozen=True)
    class Last(Middle):
        """Made by the standard library, which asks whether its base is frozen."""

        z: float = 3.0

    assert repr(Middle(1.0)).endswith("Middle(x=1.0, y=2.0)")
    assert replace(Last(1.0, z=4.0), y=5.0) == Last(1.0, 5.0, 4.0)
    assert [entry.name for entry in dataclasses.fields(Last)] == ["x", "y", "z"]


@pytest.mark.slow  # loads both packages
def test_the_standard_library_sees_every_record_of_both_packages():
    import pkgutil
    from importlib import import_module

    import camgeo
    import kin
    from kin.numeric import records

    for package in (camgeo, kin):
        for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
            if not module.name.endswith("__main__"):
                import_module(module.name)
    kinds: list[Any] = [kind for kind in records._SHAPES if kind.__module__.startswith(("camgeo.", "kin."))]
    assert len(kinds) > 400
    for kind in kinds:
        names = [
            name
            for base in reversed(kind.__mro__)
            for name, text in vars(base).get("__annotations__", {}).items()
            if dataclasses.is_dataclass(base) and not str(text).startswith("ClassVar") and text != "KW_ONLY"
        ]
        described = dataclasses.fields(kind)
        assert [entry.name for entry in described] == list(dict.fromkeys(names)), kind
        by_place = tuple(entry.name for entry in described if entry.init and not entry.kw_only)
        assert kind.__match_args__ == by_place, kind


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
