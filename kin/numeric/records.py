"""Frozen dataclasses that cost next to nothing until they are used.

The standard library compiles six functions from text for each class when its module is loaded: half a millisecond a
class, and a short run loads over two hundred. Below 80 classes, or 40 ms, this module would not be worth its lines.
Here the fields are read from the annotations when the first record is made, and functions of one text for all classes
go by their names. `dataclasses.fields` and what rests on it (`replace`, `asdict`, matching by place) come from the
standard library when they are first used. To a type checker there is no difference.
"""

from __future__ import annotations

import dataclasses
import sys
from dataclasses import KW_ONLY, MISSING, Field, FrozenInstanceError, field, fields, replace
from functools import cache, cached_property
from operator import attrgetter
from reprlib import recursive_repr
from threading import RLock
from types import CodeType, FunctionType, ModuleType
from typing import TYPE_CHECKING, ClassVar, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable
    from dataclasses import dataclass

__all__ = ["KW_ONLY", "dataclass", "field", "fields", "full_text", "replace"]

T = TypeVar("T")
_SHAPES: dict[type, _Shape] = {}
_STANDARD = ("__dataclass_fields__", "__dataclass_params__", "__match_args__")
_MAKING = RLock()


class _Shape:
    """The fields of a class, read from its annotations."""

    def __init__(self, kind: type, *, kw_only: bool) -> None:
        self.kind = kind
        self.kw_only = kw_only
        self.described = {name: value for name, value in vars(kind).items() if isinstance(value, Field)}
        for name, entry in self.described.items():
            if entry.default is MISSING:
                delattr(kind, name)
            else:
                setattr(kind, name, entry.default)

    @cached_property
    def fields(self) -> dict[str, Field[object]]:
        """Fields by name, those of bases first."""
        every: dict[str, Field[object]] = {}
        for base in reversed(self.kind.__mro__[1:]):
            if base in _SHAPES:
                every |= _SHAPES[base].fields
        kw_only = self.kw_only
        for name, annotation in vars(self.kind).get("__annotations__", {}).items():
            if annotation in ("KW_ONLY", KW_ONLY):
                kw_only = True
            elif not str(annotation).startswith(("ClassVar", "typing.ClassVar")):
                entry = self.described.get(name) or field(default=vars(self.kind).get(name, MISSING))
                if entry.kw_only is MISSING:
                    entry.kw_only = kw_only
                every[name] = entry
        return every

    @cached_property
    def values(self) -> Callable[[object], tuple[object, ...]]:
        """Function that gives the values of a record's compared fields, as a tuple."""
        names = [name for name, entry in self.fields.items() if entry.compare]
        return attrgetter(*names) if len(names) > 1 else lambda record: tuple([getattr(record, name) for name in names])

    def compile(self) -> None:
        """Make `__init__`; MISSING is the default of a field with a factory, which then makes the value."""
        # parameters and statements with numbers in place of names, so that one text serves many classes
        placed, named, body = ["self"], ["*"], ["pass"]
        by_place: list[object] = []
        by_key: dict[str, object] = {}
        for number, (name, entry) in enumerate(self.fields.items()):
            value, factory = f"_{number}", entry.default_factory is not MISSING
            if entry.init:
                (named if entry.kw_only else placed).append(value)
                if (factory or entry.default is not MISSING) and entry.kw_only:
                    by_key[name] = entry.default
                elif factory or entry.default is not MISSING:
                    by_place.append(entry.default)
            if factory:
                value = f"fields[{value!r}].default_factory()" + f" if {value} is MISSING else {value}" * entry.init
            if entry.init or factory:
                body.append(f"put(self, '_{number}', {value})")
        if hasattr(self.kind, "__post_init__"):
            body.append("self.__post_init__()")
        # the compiled code gets the names, defaults and qualified name of this class
        parameters = ", ".join(placed + (named if len(named) > 1 else []))
        code = _compiled(f"def __init__({parameters}):\n " + "\n ".join(body))
        names = {f"_{number}": name for number, name in enumerate(self.fields)}
        code = code.replace(
            co_varnames=tuple(names.get(name, name) for name in code.co_varnames),
            co_consts=tuple(names.get(value, value) for value in code.co_consts),
        )
        scope = {"put": object.__setattr__, "MISSING": MISSING, "fields": self.fields}
        function = FunctionType(code, scope, "__init__", tuple(by_place))
        function.__kwdefaults__ = by_key
        function.__qualname__ = f"{self.kind.__qualname__}.__init__"
        type.__setattr__(self.kind, "__init__", function)

    def standardise(self) -> None:
        """Let the standard library see the class; it looks into the class's module, which may be unloaded by then."""
        module = self.kind.__module__
        unloaded = module not in sys.modules
        if unloaded:
            sys.modules[module] = ModuleType(module)
            vars(sys.modules[module]).update(ClassVar=ClassVar, KW_ONLY=KW_ONLY)
        try:
            for name in _STANDARD:
                delattr(self.kind, name)
            for name, entry in self.described.items():
                setattr(self.kind, name, entry)
            dataclasses.dataclass(init=False, repr=False, eq=False, kw_only=self.kw_only)(self.kind)
        finally:
            if unloaded:
                del sys.modules[module]


@cache
def _compiled(text: str) -> CodeType:
    """Code of the function in a text; records whose texts are the same share it."""
    names: dict[str, FunctionType] = {}
    exec(text, names)  # noqa: S102 - the text has numbers in place of all names of fields
    return names["__init__"].__code__


class _Later:
    """An attribute of a class that is made when it is first read."""

    def __init__(self, kind: type, name: str, make: Callable[[], None]) -> None:
        self.kind = kind
        self.name = name
        self.make = make

    def __get__(self, record: object, _kind: type) -> object:
        with _MAKING:
            if vars(self.kind)[self.name] is self:
                self.make()
        value: object = getattr(self.kind if record is None else record, self.name)
        return value


def _shape(record: object) -> _Shape:
    return _SHAPES.get(type(record)) or next(_SHAPES[kind] for kind in type(record).__mro__ if kind in _SHAPES)


def _refuse(_self: object, name: str, _value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _keep(_self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


@recursive_repr()
def full_text(self: object) -> str:
    """Text of a record with all fields that are shown, also of a record whose own `repr` is shorter."""
    shown = [name for name, entry in _shape(self).fields.items() if entry.repr]
    return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"


def _equal(self: object, other: object) -> bool:
    values = _shape(self).values
    return values(self) == values(other) if type(self) is type(other) else NotImplemented


def _hash(self: object) -> int:
    return hash(_shape(self).values(self))


if not TYPE_CHECKING:

    def dataclass(*, frozen: bool = False, eq: bool = True, kw_only: bool = False) -> Callable[[type[T]], type[T]]:
        """Make a class a dataclass as `dataclasses.dataclass` does, without slots or order."""

        def made(kind: type[T]) -> type[T]:
            shape = _SHAPES[kind] = _Shape(kind, kw_only=kw_only)
            methods: dict[str, object] = {"__repr__": full_text}
            if frozen:
                methods |= {"__setattr__": _refuse, "__delattr__": _keep}
            if eq:
                methods |= {"__eq__": _equal, "__hash__": _hash if frozen else None}
            methods |= {name: _Later(kind, name, shape.standardise) for name in _STANDARD}
            methods["__init__"] = _Later(kind, "__init__", shape.compile)
            for name, method in methods.items():
                if name not in vars(kind):
                    setattr(kind, name, method)
            return kind

        return made
