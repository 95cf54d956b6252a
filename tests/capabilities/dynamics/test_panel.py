"""Reports of recipes in inches: pounds beside N in text, page and table; the numbers in SI stay where they were.

Holds: camgeo.capabilities.dynamics.table.
"""

from __future__ import annotations

import csv
import json
from typing import TYPE_CHECKING, Any

import pytest

from camgeo.capabilities.dynamics import panel
from camgeo.capabilities.sweep.task import SweepTask  # needs: sweep
from camgeo.measures.units import in_pounds, pounds
from camgeo.output.pipeline import check, export
from camgeo.recipe.loading import read
from camgeo.report.document import summary, table
from camgeo.report.failure import headline
from camgeo.report.page import tables

if TYPE_CHECKING:
    from pathlib import Path

INCHES = """\
units: inch
cam:
  kind: disc
  base_radius: 1.5
  follower: {kind: roller, radius: 0.4}
  motion: [{rise: 0.8, over: 120, law: cycloidal}, {dwell: 60}, {return: 0.8, over: 180, law: polynomial-345}]
part: {thickness: 0.5, bore: 0.75}
dynamics:
  {mass: 2.5 lb, rpm: 600, preload: 20 lbf, rate: 40 lbf/in, load: 5 lbf, material: steel, guide: {overhang: 1.2,
  length: 1.5, friction: 0.1}}
limits: {contact-force-greatest: {at_most: 20 lbf}, shaft-torque: {at_most: 300 lbf*in}}
export: {tolerance: 0.001, files: [{csv: {as: forces}}]}
verify: {angles: 360}
"""
PER_LBF, PER_LBF_IN, PER_PSI = 4.4482216152605, 0.1129848290276167, 0.006894757293168361  # NIST SP 811: N, N m, N/mm^2


def metric(text: str) -> str:
    """The same recipe with every length in mm."""
    for inches, mm in (("radius: 1.5", 38.1), ("radius: 0.4", 10.16), ("thickness: 0.5", 12.7), ("bore: 0.75", 19.05)):
        text = text.replace(inches, f"{inches.partition(':')[0]}: {mm!r}")
    text = text.replace("rise: 0.8", "rise: 20.32").replace("return: 0.8", "return: 20.32").replace("units: inch\n", "")
    return (
        text.replace("overhang: 1.2", "overhang: 30.48")
        .replace("length: 1.5", "length: 38.1")
        .replace("0.001", "0.0254")
    )


def report(text: str) -> dict[str, Any]:
    return check(read(text.encode(), "pounds.yaml")).report


def named(document: dict[str, Any], name: str) -> dict[str, Any]:
    (found,) = (one for one in document["checks"] if one["name"] == name)
    return found


def test_checks_have_pounds_beside_si() -> None:
    inches, mm = report(INCHES), report(metric(INCHES))
    for name, per, unit in (
        ("float", PER_LBF, "lbf"),
        ("limit:contact-force-greatest", PER_LBF, "lbf"),
        ("limit:shaft-torque", PER_LBF_IN, "lbf in"),
    ):
        one, other = named(inches, name), named(mm, name)
        assert (one["value"], one["unit"]) == (pytest.approx(other["value"], rel=1e-9), other["unit"])
        assert "pounds" not in other
        assert one["pounds"]["unit"] == unit
        assert one["pounds"]["value"] == pytest.approx(one["value"] / per, rel=1e-12)
        assert one["pounds"]["limit"] == pytest.approx(one["limit"] / per, rel=1e-12)
    assert named(inches, "limit:contact-force-greatest")["pounds"]["limit"] == pytest.approx(20.0, rel=1e-12)
    assert all("pounds" not in one for one in inches["checks"] if not one["unit"].startswith("N"))


def test_text_and_page() -> None:
    inches, mm = report(INCHES), report(metric(INCHES))
    failed = named(inches, "limit:contact-force-greatest")
    both = f"{failed['value']:.6g} N ({failed['value'] / PER_LBF:.6g} lbf)"
    assert both in summary(inches)
    assert both in headline(failed)
    assert f"N ({failed['value'] / PER_LBF:.6g} lbf)" in table(inches)
    force, pressure = inches["forces"]["contacts"][0]["max"], inches["forces"]["pressure"][0]["max"]
    page = panel.forces(inches) + tables.checks(inches)
    for value, told in (
        (force / PER_LBF, f"lbf ({force:.6g} N)"),
        (pressure / PER_PSI, f"psi ({pressure:.6g} N/mm²)"),
        (failed["limit"] / PER_LBF, "lbf in ("),
    ):
        assert f"{value:.6g}" in page
        assert told in page
    for text in (summary(mm), table(mm), panel.forces(mm), tables.checks(mm)):
        assert "lbf" not in text


def test_the_page_of_an_elastic_train() -> None:
    elastic = INCHES.replace("load: 5 lbf, material: steel", "stiffness: 4000 lbf/in, damping: 60").partition("limits")[
        0
    ]
    found = report(elastic + "export: {files: [csv]}\n")
    peak = found["dynamics"]["runs"][0]["steady"]["peak_force"]
    table = panel.dynamics(found)
    assert "peak force, lbf" in table
    assert f">{peak / PER_LBF:.6g}<" in table


@pytest.mark.slow
def test_the_table_has_columns_behind(tmp_path: Path) -> None:
    rows: dict[str, list[dict[str, str]]] = {}
    for name, text in (("inch", INCHES), ("mm", metric(INCHES))):
        export(read(text.encode(), f"{name}.yaml"), tmp_path / name)
        with next((tmp_path / name).rglob("*.csv")).open(newline="") as file:
            rows[name] = list(csv.DictReader(file))
    plain = list(rows["mm"][0])
    more = ["contact_lbf", "torque_lbf_in", "guide_a_lbf", "guide_b_lbf", "pressure_psi"]
    assert list(rows["inch"][0]) == [*plain, *more]
    for row in rows["inch"][::30]:
        assert float(row["contact_lbf"]) == pytest.approx(float(row["contact_N"]) / PER_LBF, rel=1e-10)
        assert float(row["torque_lbf_in"]) == pytest.approx(float(row["torque_Nm"]) / PER_LBF_IN, rel=1e-10, abs=1e-10)
        assert float(row["pressure_psi"]) == pytest.approx(float(row["pressure_N_mm2"]) / PER_PSI, rel=1e-10)


def test_units_that_have_none() -> None:
    assert pounds("mm", "N") is None
    assert pounds("inch", "mm") is None
    assert in_pounds("inch", None, "N") == (None, "lbf")
    value, unit = in_pounds("inch", 4.4482216152605, "N")
    assert value == pytest.approx(1.0)
    assert unit == "lbf"
    assert in_pounds("inch", 2.0, "mm") == (2.0, "mm")


# needs: sweep
def test_sweeps_name_the_unit_of_forces() -> None:
    text = metric(INCHES) + "sweep: {vary: {cam.base_radius: [38, 40]}, rank: contact-force-greatest}\n"
    task = SweepTask.from_recipe(read(text.encode(), "sweep.yaml"))
    names = ("contact-force-greatest", "shaft-torque", "contact-pressure")
    assert [task.units(names)[name].name for name in names] == ["N", "N m", "N/mm^2"]
    json.dumps({name: unit.name for name, unit in task.units(("mass", "inertia")).items()})


def test_plots_are_in_pounds() -> None:
    from camgeo.capabilities.dynamics.plots import plots as forces
    from camgeo.synthesis.design import designed

    recipe = read(INCHES.encode(), "pounds.yaml")
    metres = read(metric(INCHES).encode(), "pounds.yaml")
    shown, plain = ({plot.title: plot for plot in forces(one, designed(one))} for one in (recipe, metres))
    assert list(shown) == ["Load", "Contact force", "Torque of the shaft", "Contact pressure"]
    per = {"N": ("lbf", PER_LBF), "N m": ("lbf in", PER_LBF_IN), "N/mm²": ("psi", PER_PSI)}
    for title, plot in shown.items():
        other = plain[title]
        unit, many = per[other.unit]
        assert plot.unit == unit
        assert plot.series[0].values * many == pytest.approx(other.series[0].values, rel=1e-9, abs=1e-9)
        assert plot.holds == (0.0,)
    assert shown["Load"].series[0].values == pytest.approx(5.0)
    ((line, name),) = shown["Contact force"].limits
    assert line == pytest.approx(20.0)
    assert name == "limit 20"
    assert [value for value, _ in shown["Torque of the shaft"].limits] == pytest.approx([300.0, -300.0])
