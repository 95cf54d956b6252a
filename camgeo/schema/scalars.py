"""Scalars of a recipe, from the text as written. Nothing is guessed: what could mean two things is refused."""

from __future__ import annotations

import math
import re

MOST_LAMBDA = 200
MOST_TEXT = 1000  # characters
_UNSIGNED = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER = rf"[+-]?{_UNSIGNED}"
_FRACTION = r"([+-]?[0-9]{1,9})/([0-9]{1,9})"
_RATIO = r"([0-9]{1,9})(?:/([0-9]{1,9}))?"
_ZEROS_BEFORE = r"(?<![0-9.eE])(?<![eE][+-])0+[0-9]"
_ARITHMETIC = r" *[-+*/()][-+*/() ]*"  # arithmetic once its numbers and pi are blanks
_LEADING_ZERO = r"[+-]?0+[0-9]"
_MOST_DIGITS = 60
_LEAST = 1e-30  # so that no later square or quotient leaves the range of floats

# Other ways to write a number, and the remedy for each.
_NOT_NUMBERS = (
    (r"(?i:[+-]?\.?(?:inf|infinity|nan))", "it must be finite"),
    (r"[+-]?[0-9]+(?::[0-9.]+)+", "sexagesimal numbers are not read; write it as one decimal number"),
    (r"(?i:[+-]?0[xob][0-9a-f_]+)", "write it in decimal"),
    (r"[+-]?[0-9]+_[0-9_]*(?:\.[0-9_]*)?", "write it without underscores"),
    (r"[+-]?[0-9]*,[0-9]+", "a decimal takes a point, not a comma"),
    (r"[+-]?[0-9]+ [0-9]+/[0-9]+", "a mixed number takes a plus, such as 1+1/2"),
    (r".*[0-9.)] ?(?:mm|cm|in|inch|deg)\b.+", "a unit stands once, behind the whole number"),
    (r"(?s:[0-9]{4}-[0-9]{1,2}-[0-9]{1,2}.*)", "this is a date"),
    (r"(?i:true|false|yes|no|on|off|y|n)", "this is a truth value"),
)

NAME_RULE = "letters, digits, '.', '_' and '-', beginning with a letter, a digit or '_', at most 64 characters"
_NAME = r"[A-Za-z0-9_][A-Za-z0-9._-]{0,63}"
_DEVICE = r"(?i:con|prn|aux|nul|com[0-9]|lpt[0-9])(?:\..*)?"
RESERVED_SUFFIX = ".rejected"  # of the folder that a failing run leaves


class Complaint(ValueError):  # noqa: N818 - it never leaves the package
    """Problem of a text, and its remedy; with an empty remedy the remedy of the field is shown."""

    def __init__(self, problem: str, remedy: str = "") -> None:
        super().__init__(problem)
        self.problem = problem
        self.remedy = remedy


class SmallComplaint(Complaint):
    """A number too near 0 to compute with; `instead` is the remedy where 0 is not allowed."""

    def __init__(self, least: float) -> None:
        super().__init__("too small", "write 0, or the intended number")
        self.instead = f"give at least {least:g}"


def read_number(text: str) -> float:
    """Value of a decimal number, a fraction such as 180/7 or arithmetic such as 15/25.4.

    Raises Complaint for a text that is none of these or too long, a division by zero, and a value too large or too near
    0 to compute with.
    """
    if len(text) > _MOST_DIGITS:
        raise Complaint(f"a number of more than {_MOST_DIGITS} characters", "sixteen digits are all that counts")
    if match := re.fullmatch(_FRACTION, text):
        if int(match[2]) == 0:
            raise Complaint("divides by zero")
        return int(match[1]) / int(match[2])
    if re.fullmatch(_NUMBER, text):
        if re.match(_LEADING_ZERO, text):
            raise Complaint("a leading zero, which some read as octal", "leave the zero out")
        value = float(text)
    else:
        hint = next((hint for pattern, hint in _NOT_NUMBERS if re.fullmatch(pattern, text)), None)
        remainder = re.sub(r"\bpi\b", " ", re.sub(_UNSIGNED, " ", text))
        if hint is not None or not (re.fullmatch(_ARITHMETIC, remainder) or text == "pi"):
            raise Complaint("not a number", hint or "")
        value = _evaluate(text)
    return within_range(value)


def within_range(value: float) -> float:
    """The number itself; raises Complaint where it is not finite, or nearer to 0 than 1e-30 without being 0."""
    if not math.isfinite(value):
        raise Complaint("too large")
    if 0 < abs(value) < _LEAST:
        raise SmallComplaint(_LEAST)
    return value


def _evaluate(text: str) -> float:
    """Value of sums, products, quotients and powers of numbers and pi.

    Raises Complaint for a text that is no such number, divides by zero or is too large.
    """
    from kin.law.formula.formula import FormulaError
    from kin.law.formula.parser import parse

    if "//" in text or re.search(r"\*\s+\*|\*{3}", text):
        raise Complaint("not a number", "numbers are joined by + - * / ** and parentheses alone")
    if re.search(_ZEROS_BEFORE, text):
        raise Complaint("a leading zero, which some read as octal", "leave the zero out")
    try:
        return float(parse(text, ()).steps[-1].value)
    except FormulaError as error:
        phrases = {"division by zero": "divides by zero", "overflow": "too large"}
        problem = phrases.get(error.message, f"not a number: {error.message.replace('the formula', 'it')}")
        raise Complaint(problem) from None


def whole(value: float) -> int:
    """The number as an integer; raises Complaint for a number that is not whole."""
    if value != math.floor(value):
        raise Complaint("not a whole number")
    return int(value)


def read_ratio(text: str) -> tuple[int, int]:
    """Pair (lambda, mu) of a ratio above 1 in lowest terms, mu odd (Wunderlich 2.2).

    Raises Complaint for a text that is no such ratio, and for lambda above `MOST_LAMBDA`.
    """
    match = re.fullmatch(_RATIO, text)
    if not match:
        raise Complaint("not a fraction of whole numbers")
    lam, mu = int(match[1]), int(match[2] or 1)
    if mu == 0:
        raise Complaint("divides by zero")
    if lam <= mu:
        raise Complaint("not above 1", "the arms' angle alpha = pi mu/lambda must stay below 180 degrees")
    if (common := math.gcd(lam, mu)) > 1:
        lowest = f"{lam // common}" if mu == common else f"{lam // common}/{mu // common}"
        raise Complaint("not in lowest terms", f"write {lowest}")
    if mu % 2 == 0:
        raise Complaint("an even denominator", "mu must be odd, or the pitch curve would cross itself")
    if lam > MOST_LAMBDA:
        raise Complaint(f"a numerator above {MOST_LAMBDA}", "only small ones make useful cams")
    return lam, mu


def read_name(text: str) -> str:
    """The name itself; raises Complaint where it is not safe as the name of a folder on any system.

    Names that end as folders of failed runs do are refused too.
    """
    if not re.fullmatch(_NAME, text) or text.endswith("."):
        raise Complaint("not safe as the name of a folder", f"use {NAME_RULE}")
    if re.fullmatch(_DEVICE, text):
        raise Complaint("reserved for a device by Windows", f"use {NAME_RULE}")
    if text.lower().endswith(RESERVED_SUFFIX):
        problem = f"reserved for the folders of failed runs, which end in {RESERVED_SUFFIX}"
        raise Complaint(problem, "choose another ending")
    return text


def read_paragraph(text: str) -> str:
    """Note as one paragraph, line breaks as spaces; raises Complaint for a long one and for control characters."""
    words = " ".join(text.split())
    if len(words) > MOST_TEXT:
        raise Complaint(f"longer than {MOST_TEXT} characters", "shorten it")
    if not words.isprintable():
        raise Complaint("holds control characters", "write plain text")
    return words
