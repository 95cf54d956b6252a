"""Tables of docs that hold measured figures: their rows, how a page shows them, and whether it still does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

HEAD = "| quantity | source | published | ours | differs by |\n| --- | --- | --- | --- | --- |"
PAPER_HEAD = (
    "| item | what it says | recipe | place | published | ours | differs by |\n"
    "| --- | --- | --- | --- | --- | --- | --- |"
)


@dataclass(frozen=True)
class Row:
    """One line of a table.

    `published` is the text to show, `value` the number it stands for (None where the source gives no number);
    `within` how far ours may lie from it, or from the page's where there is no value; `form` shows ours.
    """

    quantity: str
    source: str
    published: str
    value: float | None
    ours: float
    within: float
    form: str = ".7g"

    @property
    def key(self):
        return self.quantity, self.source, self.published

    @property
    def holds(self):
        return self.value is None or abs(self.ours - self.value) <= self.within

    @property
    def shown(self):
        return f"{self.ours:{self.form}}"

    @property
    def differs(self):
        if self.value is None:
            return "-"
        # rounding differs between machines, so below a billionth only the order is given
        off = abs(self.ours - self.value)
        floor = 1e-9 * max(1.0, abs(self.value))
        return f"{off:.1e}" if off > floor else f"< {floor:.0e}"

    def line(self):
        return f"| {' | '.join((*self.key, self.shown, self.differs))} |"


@dataclass(frozen=True)
class PaperRow(Row):
    """One figure, table, equation or claim of a paper; `source` is the item, `quantity` what it says.

    `recipe` and `place` in the docs are shown as they are written. Without a number of ours `why` says what stands for
    it, or why there is none. `needs` is the capability without which the row is not there.
    """

    recipe: str = "-"
    place: str = "-"
    why: tuple[str, str] = ("", "")
    needs: str = ""

    @property
    def key(self):
        return self.source, self.quantity, self.recipe, self.place, self.published

    @property
    def shown(self):
        # a residual of 0 is rounding, which no two machines share
        small = self.value == 0.0 and abs(self.ours) <= 1e-9
        return self.why[0] or ("0" if small else super().shown)

    @property
    def differs(self):
        return self.why[1] or super().differs

    @property
    def holds(self):
        return bool(self.why[0]) or super().holds

    def line(self):
        return super().line() + (f" <!-- needs: {self.needs} -->" if self.needs else "")


@dataclass(frozen=True)
class Section:
    """What rows of a paper's table share: the recipe they are measured on, and their place in the docs."""

    recipe: str
    place: str

    def number(self, source, says, measured, within, *, published, form=".7g"):
        """Return a row with a number; `published` is the text to show and the number that it stands for."""
        text, value = published
        return PaperRow(says, source, text, value, float(measured), within, form, self.recipe, self.place)

    def zero(self, source, says, measured, within):
        """Return a row of what an equation leaves, 0."""
        return self.number(source, says, measured, within, published=("0", 0.0), form=".1e")

    def said(self, source, says, ours, why, *, published="text", needs=""):
        """Return a row without a number: what stands for it, and why."""
        return PaperRow(says, source, published, None, 0.0, 0.0, ".7g", self.recipe, self.place, (ours, why), needs)


def cells(page: Path, mark: str) -> list[list[str]]:
    """Rows of a table of a page, as lists of cells, without the marks of what they need."""
    block = page.read_text(encoding="utf-8").split(f"<!-- {mark} -->\n")[1].split("<!-- end -->")[0]
    lines = [line.partition(" <!-- needs: ")[0] for line in block.splitlines()[2:]]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]


def write(page: Path, mark: str, lines: list[str]) -> None:
    """Put a table in the place of the one that a page has."""
    before, rest = page.read_text(encoding="utf-8").split(f"<!-- {mark} -->\n")
    table = "\n".join(lines)
    page.write_text(
        f"{before}<!-- {mark} -->\n{table}\n<!-- end -->{rest.split('<!-- end -->', 1)[1]}", encoding="utf-8"
    )


def off(shown: list[list[str]], rows: list[Row]) -> list[str]:
    """What a page's table says otherwise than the rows: words, figures beyond half of their last digit."""
    found = [] if len(shown) == len(rows) else [f"{len(shown)} rows, not {len(rows)}"]
    for line, row in zip(shown, rows, strict=False):
        said, ours, differs = tuple(line[:-2]), line[-2], line[-1]
        if said != row.key:
            found.append(f"{said} is {row.key}")
        elif isinstance(row, PaperRow) and row.why[0]:
            found += [] if (ours, differs) == (row.shown, row.differs) else [f"{said}: {ours}, {differs}"]
        elif not _near(ours, differs, row):
            found.append(f"{said}: {ours} is {row.ours!r}, differs by {row.differs}")
    return found


def _near(ours: str, differs: str, row: Row) -> bool:
    digit = abs(float(row.shown) - row.ours) + 1e-9 * max(1.0, abs(row.ours))
    if abs(float(ours) - row.ours) > row.within + digit:
        return False
    return row.value is None or float(differs.lstrip("< ")) <= max(row.within, 2e-9 * max(1.0, abs(row.value)))
