"""The one line of a report: a file that only begins like the recipe's name keeps its own."""

import pytest

from camgeo.cli.main import main
from camgeo.report.document import summary, table, verdict


@pytest.mark.parametrize(
    ("path", "told"), [("c.step", "step"), ("c-arcs.dxf", "arcs.dxf"), ("cyl.step", "cyl.step"), ("c", "c")]
)
def test_only_the_recipe_s_own_name_is_left_out(path, told):
    report = {"recipe": "c", "ok": True, "files": [{"path": path}], "checks": []}
    assert summary(report) == f"c: ok  {told}"


def test_a_dwell_of_no_file_is_called_intended():
    def dwell(*lengths, files=({"path": "c.dxf"},)):
        rows = [{"from": name, "length_deg": length} for name, length in lengths]
        return summary({"recipe": "c", "ok": True, "files": files, "checks": [], "linkage": {"dwells": rows}})

    assert dwell(("intended", 37.05)) == "c: ok  dxf; intended dwell 37.05 deg"
    assert dwell(("intended", 37.05), ("c.dxf", 36.5), ("c.dxf", 36.2)) == "c: ok  dxf; dwell 36.20 deg"
    assert dwell(("intended", 37.05), files=()) == "c: ok  dwell 37.05 deg"


def checked(value, *, ok=True, sense="at_most", limit=1e-3):
    name = "motion"
    return {"name": name, "ok": ok, "value": value, "limit": limit, "unit": "mm", "sense": sense, "at_deg": None}


def reported(checks=(), stages=(), skipped=(), motion=None):
    file = {"path": "c.dxf", "kind": "dxf", "as": "arcs", "pieces": 6, "bytes": 9, "tolerance": 1e-3}
    if motion is not None:
        file["motion"] = {"max": motion, "rms": motion, "unit": "mm", "at_deg": 0.0}
    return {
        "recipe": "c",
        "ok": all(check["ok"] for check in checks),
        "files": [file],
        "checks": list(checks),
        "stages": [{"name": name, "seconds": 1e-3 * ms} for name, ms in stages],
        "skipped": [{"what": what, "why": why} for what, why in skipped],
    }


@pytest.mark.parametrize(
    ("check", "told"),
    [
        (checked(2.13e-14), "below rounding"),
        (checked(2.13e-14, limit=None), "below rounding"),
        (checked(0.0), "0"),
        (checked(-0.0), "0"),
        (checked(2.13e-9), "2.13e-09"),
        (checked(5e-12, limit=1e-11), "5e-12"),  # near its limit every digit counts
        (checked(2e-12, ok=False, limit=1e-12), "2e-12"),
        (checked(2.13e-14, sense="at_least", limit=0.0), "2.13e-14"),
    ],
)
def test_errors_that_rounding_made_have_no_digits(check, told):
    row = table(reported([check])).splitlines()[1]
    assert row.split("ok" if check["ok"] else "FAILED")[1].strip().startswith(f"{told}  ")


def test_of_files_too():
    report = reported(motion=2.13e-14)
    assert summary(report) == "c: ok  dxf 6 arcs, motion below rounding"
    assert "2.13e-14" not in table(report)
    assert summary(reported(motion=2.13e-4)) == "c: ok  dxf 6 arcs, motion 0.000213 mm"


def test_what_was_skipped_is_one_line():
    text = table(reported(skipped=[("svg", "the recipe's export.files does not list it"), ("dynamics", "not given")]))
    assert [line for line in text.splitlines() if "skipped" in line] == ["skipped (the JSON says why): svg, dynamics"]


def test_times_are_told_by_group():
    stages = [("motion", 1), ("undercut", 2), ("fit arcs", 3), ("judge dxf", 4), ("judge stl", 5), ("judge dxf", 6)]
    assert table(reported(stages=stages)).splitlines()[-1] == "21.0 ms: design 3.0, fit 3.0, judge 15.0"


def test_the_verdict_is_the_last_line(tmp_path, capsys):
    good, bad = tmp_path / "good.yaml", tmp_path / "bad.yaml"
    for path, mean in ((good, 25), (bad, 15)):
        text = f"cam: {{kind: support, p: {mean} + 2*cos(3*t)}}\nexport: {{tolerance: 0.01, files: [dxf]}}\n"
        path.write_text(text, encoding="utf-8")
    assert main(["check", str(good), "-v"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("good: ok  dxf ")
    assert main(["check", str(good), str(bad), "-v", "--jobs", "1"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1].startswith("bad: FAILED")
    assert lines[-2].startswith("  ")
    assert verdict(reported()) == summary(reported())


@pytest.mark.parametrize(
    ("extremes", "told"),
    [("true", "motion 0.0123 deg"), ("sampled", "motion 0.0123 deg (sampled, estimated within 0.00025)")],
)
def test_a_sampled_motion_error_is_called_one(extremes, told):
    motion = {"max": 0.01234, "unit": "deg", "extremes": extremes, "remainder": 0.00025}
    report = {"recipe": "c", "ok": True, "files": [{"path": "c.dxf", "motion": motion}], "checks": []}
    assert summary(report) == f"c: ok  dxf, {told}"
