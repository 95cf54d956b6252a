"""The one line of a report: a file that only begins like the recipe's name keeps its own."""

import pytest

from camgeo.report.document import summary


@pytest.mark.parametrize(
    ("path", "told"), [("c.step", "step"), ("c-arcs.dxf", "arcs.dxf"), ("cyl.step", "cyl.step"), ("c", "c")]
)
def test_only_the_recipe_s_own_name_is_left_out(path, told):
    report = {"recipe": "c", "ok": True, "files": [{"path": path}], "checks": []}
    assert summary(report) == f"c: ok  {told}"
