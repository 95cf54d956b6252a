"""HTML of designs and reports in a notebook: a drawing, the verdict, tables. No script."""

from __future__ import annotations

import base64
from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from camgeo.api.check import Check
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design as Exact

WIDTH = 360  # px of a drawing
FAULT = "#b00020"


def drawing(recipe: Recipe, exact: Exact) -> str:
    """SVG of the exact cam with its follower at shaft angle 0."""
    from camgeo.report.page import svg
    from camgeo.report.page.content import content

    return svg.still(content(recipe, exact, ()).scene, 0, recipe.name)


def notebook_html(picture: str, title: str, checks: Sequence[Check], *more: str) -> str:
    """HTML of the verdict, a drawing and the table of checks, then `more` HTML.

    `picture` is SVG text; it becomes an image, so that its style stays within it.
    """
    data = base64.b64encode(picture.encode("utf-8")).decode("ascii")
    failed = sum(not check.ok for check in checks)
    verdict = f"{failed} of {len(checks)} checks FAILED" if failed else f"all {len(checks)} checks hold"
    head = f'<strong style="color:{FAULT if failed else "inherit"}">{escape(title)}: {verdict}</strong>'
    image = f'<img width="{WIDTH}" alt="{escape(title)}" src="data:image/svg+xml;base64,{data}">'
    rows = [_row(check) for check in checks]
    return f"<div>{head}<br>{image}{table(('check', '', 'value', 'limit', 'at', 'file'), rows)}{''.join(more)}</div>"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """HTML of a table with these heads of columns and rows of cells; texts are escaped."""
    cells = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def line(text: str) -> str:
    """HTML of a line of text, escaped."""
    return f"<p>{escape(text)}</p>"


def _row(check: Check) -> tuple[str, ...]:
    return (
        check.title,
        "ok" if check.ok else "FAILED",
        check.figure,
        check.bound,
        "" if check.at is None else f"{check.at:.2f}{'°' if check.at_unit == 'deg' else f' {check.at_unit}'}",
        check.file or "",
    )
