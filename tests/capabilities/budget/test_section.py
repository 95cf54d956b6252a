"""The section `budget` of a report, its limits, and the page.

Holds: camgeo.capabilities.budget.recipe, camgeo.capabilities.budget.measures, camgeo.capabilities.budget.page.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from support.budgets import CAM

import camgeo

if TYPE_CHECKING:
    from pathlib import Path


def test_report_limit_and_page(tmp_path: Path) -> None:
    text = CAM + "budget: {permitted: 0.05, tolerances: {profile: 0.01, follower.offset: 0.01}}\n"
    text = (
        text.replace("[dxf]", "[dxf, html]") + "limits: {budget-worst: {at_most: 0.01}, budget-rss: {at_most: 0.02}}\n"
    )
    result = camgeo.export(camgeo.load(text), tmp_path)
    failed = [check.name for check in result.checks if not check.ok]
    assert failed == ["limit:budget-worst"]
    assert result["budget"]["worst"]["value"] > 0.01
    page = next(result.path.glob("*.html")).read_text(encoding="utf-8")
    assert "Budget of errors</h2>" in page
    assert page.count("<polygon") >= 2
    assert '"title":"Budget"' in page
