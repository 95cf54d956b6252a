"""One lift as simulators, controllers, spreadsheets, CAD programs and reports write it: all are the same rows."""

import math

import numpy as np
import pytest

from kin.read.tables import Counted, Sheet, read_table

DEGREES = range(0, 360, 15)
LIFT = [4.5 - 4.5 * math.cos(math.radians(deg)) for deg in DEGREES]
ROWS = list(zip(DEGREES, LIFT, strict=True))


def lines(form, head="", rows=ROWS):
    return head + "".join(form.format(deg, lift, i=i) + "\n" for i, (deg, lift) in enumerate(rows))


FOREIGN = {
    "simulator": (
        lines(
            "  {0:8.1f}   {1:.5E}", "! VALVE LIFT PROFILE\n! CRANK [deg]   LIFT [mm]\n", [(2 * a, s) for a, s in ROWS]
        ).replace("E", "D"),
        Sheet("length", angle="crank"),
    ),
    "simulator with derivatives": (
        lines("{0}\t{1:.6f}\t0.1\t-0.2", "Theta\tLift\tVelocity\tAcceleration\ndeg\tmm\tmm/deg\tmm/deg^2\n"),
        Sheet("length"),
    ),
    "cam measuring machine": (
        "ACME CAMS\nGrind 4711 INTAKE 112 LSA\n24\n" + "".join(f"{lift / 25.4:.6f}\n" for lift in LIFT),
        Sheet("length", Counted(1, 15.0), unit="inch"),
    ),
    "controller's points": (
        lines("{0:.4f};{1:.5f};0.0;Polynom5;Motion", "MasterPos;SlavePos;SlaveVelo;FunctionType;PointType\n"),
        Sheet("length", ("MasterPos", "SlavePos")),
    ),
    "controller's list": ("24\n" + lines("{0:.3f};{1:.5f}").replace(".", ","), Sheet("length")),
    "spreadsheet": (
        "Nockenprofil Einlass;;;\nWinkel;Hub;Bemerkung;\n[°];[mm];;\n"
        + lines("{0};{1:.5f};;").replace(".", ",").replace("\n90;", "\n# Nase\n90;").replace(";;\n105", ";Ende;\n105")
        + ";;;\n",
        Sheet("length"),
    ),
    "data frame": (lines("{i},{0:.1f},{1!r}", ",angle_deg,lift_mm\n"), Sheet("length")),
    "motion study": (
        lines(
            "{i},{0:.5f},{1:.5f}",
            '"Study 1","Linear Displacement2"\n"Frame","Time (sec)","Linear Displacement2 (mm)"\n',
            [(a / 720, s) for a, s in ROWS],
        ),
        Sheet("length", (2, 3), "seconds", period=0.5),
    ),
    "matrix": (lines("   {0:.7e}   {1:.7e}"), Sheet("length")),
    "parameters with units": (lines("{0:.2f} deg,{1:.5f} mm", "Position,Displacement\n"), Sheet("length")),
    "table of a report": (
        lines("| {0} | {1:.5f} |", "| Cam angle (deg) | Lift (mm) |\n|-----:|------:|\n"),
        Sheet("length"),
    ),
    "two lobes": (
        "# two lobes\nin_deg;in_mm;ex_deg;ex_mm\n" + lines("{0};1.5;{0};{1:.5f}  # exhaust") + "360;0;;\n375;0;;\n",
        Sheet("length", ("ex_deg", "ex_mm")),
    ),
}


@pytest.mark.parametrize("name", FOREIGN)
def test_a_table_is_read_as_it_comes(name):
    text, sheet = FOREIGN[name]
    rows = read_table(text, sheet)
    slack = 0.01 if name == "motion study" else 1e-9  # its times are rounded
    assert np.degrees(rows.theta) == pytest.approx(DEGREES, abs=slack)
    assert rows.s == pytest.approx(LIFT, abs=2e-5)
    assert (np.abs(rows.s - LIFT) <= rows.rounding + 1e-15).all()
