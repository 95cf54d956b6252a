"""The one line of a report: a file that only begins like the recipe's name keeps its own."""

import pytest

from camgeo.report.document import summary


@pytest.mark.parametrize(
    ("path", "told"), [("c.step", "step"), ("c-arcs.dxf", "arcs.dxf"), ("cyl.step", "cyl.step"), ("c", "c")]
)
def test_only_the_recipe_s_own_name_is_left_out(path, told):
    report = {"recipe": "c", "ok": True, "files": [{"path": path}], "checks": []}
    assert summary(report) == f"c: ok  {told}"


@pytest.mark.parametrize(
    ("extremes", "told"),
    [("true", "motion 0.0123 deg"), ("sampled", "motion 0.0123 deg (sampled, estimated within 0.00025)")],
)
def test_a_sampled_motion_error_is_called_one(extremes, told):
    motion = {"max": 0.01234, "unit": "deg", "extremes": extremes, "remainder": 0.00025}
    report = {"recipe": "c", "ok": True, "files": [{"path": "c.dxf", "motion": motion}], "checks": []}
    assert summary(report) == f"c: ok  dxf, {told}"
