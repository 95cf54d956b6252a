"""Frozen dataclasses that cost next to nothing until they are used.

The standard library compiles six functions from text for each class when its module is loaded: half a millisecond a
class, and a short run loads over two hundred. Below 80 classes, or 40 ms, this module would not be worth its lines.
Here the fields are read from the annotations when the first record is made, and functions of one text for all classes
go by their names. What `dataclasses.fields` and all that rests on it (`replace`, `asdict`, matching by place) read is
from a class of the library with the same fields, made at their first use: the record's class gains attributes and never
lacks one, so that threads may share it. To a type checker there is no difference.
"""

from __future__ import annotations

import dataclasses
from copy import copy
from dataclasses import KW_ONLY, MISSING, Field, FrozenInstanceError, field, fields, replace
from functools import cache, cached_property
from operator import attrgetter
from reprlib import recursive_repr
from threading import RLock
from types import CodeType, FunctionType, MappingProxyType
from typing import TYPE_CHECKING, NoReturn, TypeVar

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

    def __init__(self, kind: type, *, frozen: bool, eq: bool, kw_only: bool) -> None:
        self.kind = kind
        self.frozen = frozen
        self.eq = eq
        self.kw_only = kw_only
        self.described = {name: value for name, value in vars(kind).items() if isinstance(value, Field)}
        for name, entry in self.described.items():
            if entry.default is MISSING:
                delattr(kind, name)
            else:
                setattr(kind, name, entry.default)

    @cached_property
    def fields(self) -> dict[str, Field[object]]:
        """Fields by name, those of bases first; a default that can be altered is refused, as records would share it."""
        every: dict[str, Field[object]] = {}
        for base in reversed(self.kind.__mro__[1:]):
            if base in _SHAPES:
                every |= _SHAPES[base].fields
            elif _STANDARD[0] in vars(base):
                every |= {entry.name: entry for entry in fields(base)}
        kw_only = self.kw_only
        for name, annotation in vars(self.kind).get("__annotations__", {}).items():
            if annotation in ("KW_ONLY", "dataclasses.KW_ONLY", KW_ONLY):
                kw_only = True
            elif not str(annotation).startswith(("ClassVar", "typing.ClassVar")):
                entry = self.described.get(name) or field(default=vars(self.kind).get(name, MISSING))
                if type(entry.default).__hash__ is None and not isinstance(entry.default, MappingProxyType):
                    raise ValueError(f"{self.kind.__qualname__}.{name}: a default that can be altered needs a factory")
                if entry.kw_only is MISSING:
                    entry.kw_only = kw_only
                entry.type = annotation
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
                elif by_place and not entry.kw_only:
                    raise TypeError(f"{self.kind.__qualname__}.{name} has no default and follows a field that has one")
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
        """Give the class what the standard library's functions read, from one of the library with the same fields."""
        bare = {name: copy(entry) for name, entry in self.fields.items()}
        for entry in bare.values():
            entry.default = MISSING  # the library would refuse a read-only view of a dictionary
        described = [(name, entry.type, entry) for name, entry in bare.items()]
        text = {"__doc__": self.kind.__name__}  # without it the library would take time to write one
        standard = dataclasses.make_dataclass(
            self.kind.__name__, described, namespace=text, init=False, repr=False, eq=False
        )
        for name, entry in bare.items():
            entry.default = self.fields[name].default
        for name in ("init", "repr", "eq", "frozen"):
            setattr(vars(standard)["__dataclass_params__"], name, getattr(self, name, True))
        for name in _STANDARD:
            if isinstance(vars(self.kind)[name], _Later):
                type.__setattr__(self.kind, name, vars(standard)[name])


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

    def __get__(self, record: object, kind: type) -> object:
        with _MAKING:
            if vars(self.kind)[self.name] is self:
                self.make()
        value: object = vars(self.kind)[self.name]  # and not the heir's of the same name, where its base's is meant
        return value.__get__(record, kind) if isinstance(value, FunctionType) else value


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
            shape = _SHAPES[kind] = _Shape(kind, frozen=frozen, eq=eq, kw_only=kw_only)
            methods: dict[str, object] = {"__repr__": full_text, "__replace__": replace}
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
