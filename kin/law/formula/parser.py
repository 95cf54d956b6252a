"""The grammar of formulas: from text to an `Expression`, with messages that suggest what to write.

    sum     = product (("+" | "-") product)*
    product = factor (("*" | "/") factor)*
    factor  = ("+" | "-") factor | power
    power   = atom ["**" factor]
    atom    = number | pi | e | variable | function "(" sum ("," sum)* ")" | "(" sum ")"

as in Python: `-t**2` is `-(t**2)`, `2**3**2` is `2**9`. Length, depth and the number of terms are bounded.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache

from kin.law.formula.expression import FUNCTIONS, OF_TWO, Builder, Expression, FormulaError
from kin.numeric.records import dataclass

MOST_CHARACTERS = 1000
MOST_DEPTH = 50
MOST_TERMS = 500

CONSTANTS = {"pi": math.pi, "e": math.e}

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)|(?P<name>[A-Za-z_][A-Za-z_0-9]*)"
    r"|(?P<sign>\*\*|//|<=|>=|==|!=|[-+*/(),])|(?P<end>$)|(?P<other>.))",
    re.DOTALL,
)
# Signs that people write, and what to write instead.
_OTHER_SIGNS = {
    "^": "a power is written **",
    "²": "a square is written **2",
    "³": "a cube is written **3",
    "·": "a product is written *",
    "×": "a product is written *",
    "∗": "a product is written *",
    "÷": "a quotient is written /",
    "−": "minus is written -",
    "–": "minus is written -",
    "π": "pi is written pi",
    "√": "a square root is written sqrt(...)",
    "°": "angles are in radians: write *pi/180",
    "[": "brackets are written ( )",
    "]": "brackets are written ( )",
    "{": "brackets are written ( )",
    "}": "brackets are written ( )",
    "|": "an absolute value is written abs(...)",
    "%": "there is no remainder",
    "//": "a quotient is written /",
    "=": "a formula is the right-hand side alone",
    "==": "there are no comparisons; abs, sign, min and max make cases",
    "!=": "there are no comparisons; abs, sign, min and max make cases",
    "<": "there are no comparisons; abs, sign, min and max make cases",
    "<=": "there are no comparisons; abs, sign, min and max make cases",
    ">": "there are no comparisons; abs, sign, min and max make cases",
    ">=": "there are no comparisons; abs, sign, min and max make cases",
    ";": "arguments are separated by a comma",
    "'": "there are no strings",
    '"': "there are no strings",
    ".": "a name has no parts",
}
_OTHER_NAMES = {
    "ln": "log",
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arctan2": "atan2",
    "arcsinh": "log(x + sqrt(x**2 + 1))",
    "log10": "log(x)/log(10)",
    "log2": "log(x)/log(2)",
    "cot": "1/tan(x)",
    "sec": "1/cos(x)",
    "csc": "1/sin(x)",
    "power": "**",
    "pow": "**",
    "sgn": "sign",
    "fabs": "abs",
    "sqr": "**2",
    "radians": "*pi/180",
    "tau": "2*pi",
}


@dataclass(frozen=True)
class _Token:
    kind: str  # number, name, sign, end
    text: str
    column: int


@lru_cache(maxsize=256)
def parse(text: str, variables: tuple[str, ...]) -> Expression:
    """Expression of a text; raises FormulaError for a text that is too long, or no formula in `variables`."""
    if len(text) > MOST_CHARACTERS:
        message = f"the formula has {len(text)} characters; {MOST_CHARACTERS} are allowed"
        raise FormulaError(message, MOST_CHARACTERS)
    return _Parser(text, variables).formula()


class _Parser:
    """Recursive descent over the tokens; each method returns the builder's index of the term that it has read."""

    def __init__(self, text: str, variables: tuple[str, ...]) -> None:
        self._tokens = _tokens(text)
        self._next = 0
        self._depth = 0
        self._terms = 0
        self._builder = Builder(variables)

    def formula(self) -> Expression:
        if self._token.kind == "end":
            raise FormulaError("the formula is empty", 0)
        result = self._sum()
        if self._token.text == ")":
            raise FormulaError("this closing parenthesis was never opened", self._token.column)
        if self._token.text == ",":
            message = "a comma separates the arguments of a function; decimals take a point"
            raise FormulaError(message, self._token.column)
        return self._builder.expression(result)

    @property
    def _token(self) -> _Token:
        return self._tokens[self._next]

    def _take(self) -> _Token:
        token = self._token
        self._next += 1
        return token

    def _count(self, column: int) -> None:
        self._terms += 1
        if self._terms > MOST_TERMS:
            raise FormulaError(f"the formula has more than {MOST_TERMS} terms and operations", column)

    def _apply(self, op: str, args: tuple[int, ...], column: int) -> int:
        self._count(column)
        return self._builder.apply(op, args, column)

    def _sum(self) -> int:
        result = self._product()
        while self._token.text in {"+", "-"}:
            sign = self._take()
            result = self._apply("add" if sign.text == "+" else "sub", (result, self._product()), sign.column)
        return result

    def _product(self) -> int:
        result = self._factor()
        while self._token.text in {"*", "/"}:
            sign = self._take()
            result = self._apply("mul" if sign.text == "*" else "div", (result, self._factor()), sign.column)
        return result

    def _factor(self) -> int:
        self._depth += 1
        if self._depth > MOST_DEPTH:
            raise FormulaError(f"the formula is nested more than {MOST_DEPTH} deep", self._token.column)
        if self._token.text in {"+", "-"}:
            sign = self._take()
            result = self._factor()
            if sign.text == "-":
                result = self._apply("neg", (result,), sign.column)
        else:
            result = self._power()
        self._depth -= 1
        return result

    def _power(self) -> int:
        base = self._atom()
        if self._token.text != "**":
            return base
        sign = self._take()
        return self._apply("power", (base, self._factor()), sign.column)

    def _atom(self) -> int:
        token = self._take()
        self._count(token.column)
        if token.kind == "number":
            result = self._number(token)
        elif token.kind == "name":
            result = self._name(token)
        elif token.text == "(":
            result = self._sum()
            self._close(token)
        elif token.kind == "end":
            raise FormulaError("the formula ends where a number, a name or a parenthesis should follow", token.column)
        else:
            raise FormulaError(f"a number, a name or a parenthesis should stand before '{token.text}'", token.column)
        self._refuse_implicit(token)
        return result

    def _refuse_implicit(self, first: _Token) -> None:
        """Raise FormulaError where two terms stand side by side: a product is written out."""
        following = self._token
        if following.kind in {"number", "name"} or following.text == "(":
            left = ")" if self._tokens[self._next - 1].text == ")" else first.text
            right = following.text
            factors = "(...)" if left == ")" else left, right + "(...)" * (right in FUNCTIONS) + "...)" * (right == "(")
            message = f"no operator between '{left}' and '{right}'; write {factors[0]}*{factors[1]}"
            raise FormulaError(message, following.column)

    def _close(self, opening: _Token) -> None:
        token = self._take()
        if token.text != ")":
            fault = "is never closed" if token.kind == "end" else f"is not closed before '{token.text}'"
            raise FormulaError(f"this parenthesis {fault}", opening.column)

    def _number(self, token: _Token) -> int:
        value = float(token.text)
        if math.isinf(value):
            raise FormulaError(f"{token.text} is too large a number", token.column)
        exact = token.text.isdigit() and value < 2**53
        return self._builder.constant(value, 0.0 if exact else math.ulp(value), token.column)

    def _name(self, token: _Token) -> int:
        name, called = token.text, self._token.text == "("
        if name in self._builder.variables:
            return self._builder.variable(self._builder.variables.index(name), token.column)
        if name in CONSTANTS:
            return self._builder.constant(CONSTANTS[name], math.ulp(CONSTANTS[name]), token.column)
        if name not in FUNCTIONS:
            raise FormulaError(self._unknown(name), token.column)
        if not called:
            raise FormulaError(f"{name} takes its argument in parentheses: {name}(...)", token.column)
        return self._call(token)

    def _call(self, function: _Token) -> int:
        opening, name = self._take(), function.text
        arguments = [] if self._token.text == ")" else [self._sum()]
        while arguments and self._token.text == ",":
            self._take()
            arguments.append(self._sum())
        self._close(opening)
        if name in {"min", "max"}:
            if len(arguments) < 2:
                raise FormulaError(f"{name} takes two arguments or more, not {len(arguments)}", function.column)
        elif len(arguments) != (2 if name in OF_TWO else 1):
            right = "two arguments" if name in OF_TWO else "one argument"
            raise FormulaError(f"{name} takes {right}, not {len(arguments)}", function.column)
        result = self._apply(name, tuple(arguments[:2]), function.column)
        for more in arguments[2:]:
            result = self._apply(name, (result, more), function.column)
        return result

    def _unknown(self, name: str) -> str:
        from difflib import get_close_matches  # for the message alone

        variables = self._builder.variables
        allowed = [*variables, *CONSTANTS, *FUNCTIONS]
        lower = name.lower()
        near = [known for known in FUNCTIONS if len(known) > 2 and lower.startswith(known)]  # cosine, arctangent
        near = near[-1:] or get_close_matches(lower, allowed, n=1)
        if lower in _OTHER_NAMES:
            hint = f"; write {_OTHER_NAMES[lower]}"
        elif near:
            hint = f"; did you mean {near[0]}?"
        else:
            hint = ""
        return (
            f"unknown name '{name}'{hint} (variable: {', '.join(variables)}; constants: {', '.join(CONSTANTS)}; "
            f"functions: {', '.join(FUNCTIONS)})"
        )


def _tokens(text: str) -> list[_Token]:
    tokens, at = [], 0
    while True:
        match = _TOKEN.match(text, at)
        if match is None:  # every character matches, and so does the end
            raise AssertionError(text)
        kind, at = str(match.lastgroup), match.end()
        token = match[kind]
        column = match.start(kind)
        if kind == "other" or token in _OTHER_SIGNS:
            hint = _OTHER_SIGNS.get(token, "it has no meaning here")
            raise FormulaError(f"{token!r} is not understood; {hint}", column)
        tokens.append(_Token(kind, token, column))
        if kind == "end":
            return tokens
