"""The section `budget` of a report, its limits, and the page.

Holds: camgeo.capabilities.budget.record.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

CAM = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 10}
  motion: [{rise: 24, over: 100, law: cycloidal}, {dwell: 40}, {return: 24, over: 140, law: cycloidal}, {dwell: 80}]
part: {thickness: 10, bore: {diameter: 20, fit: H7}, keyway: din6885}
export: {tolerance: 0.01, files: [dxf]}
verify: {angles: 360}
"""


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
