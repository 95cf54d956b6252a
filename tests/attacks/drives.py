"""Tables for drives by chance: exported within their tolerance, or judged with a row that is off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from attacks.cams import drawn
from attacks.outcome import Attack
from kin.read.drive_tables import MOTION_FUNCTION

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

    from attacks.outcome import Done

HEADS = (
    "# joined by straight lines\nmaster_deg,slave_mm\n",
    "# joined by polynomials of degree 5\n# within 0.001 mm of the motion\nmaster_deg,slave_mm,velocity,acceleration\n",
    "# joined by polynomials of degree 5\nmaster_deg,slave_deg,velocity,acceleration\n",
    "master_deg,slave_mm\n",
    "# joined by straight lines\n# within nan mm of the motion\nmaster_deg,slave_in\n",
    "# joined by a cubic spline\n# Start Slope 0.1, End Slope nan\nmaster_deg,slave_mm\n",
    "# slave in mm; MCCP with Start Slope 0, End Slope 1e300\nMaster,Slave,SegmentType\n",
    "# slave in deg\n" + ",".join(MOTION_FUNCTION.columns) + "\n",
    "# numbers of single precision\n# joined by straight lines\nmaster_deg,slave_mm\n",
)
CONTROLLERS = (
    *("codesys", "codesys-table", "twincat", "twincat-table", "rockwell", "rockwell-linear", "siemens", "sew", "plain"),
)


def driven(rng: Random, number: int) -> Attack:
    """A cam by chance as a table for a drive."""
    options = f"as: controller, for: {rng.choice(CONTROLLERS)}"
    options += rng.choice(["", "", ", step: 1", ", step: 0.01", ", step: 7", ", units: inch", ", tolerance: 1e-7"])
    options += rng.choice(["", "", ", joints: true", ", velocity_error: 0.5", ", acceleration_error: 2"])
    text = drawn(rng).text(f"{{csv: {{{options}}}}}")

    def judge(done: Done, folder: Path) -> list[str]:
        made = (folder / "out" / "cam" / "cam.csv").is_file()
        return [] if made == (done.status == 0) else [f"verdict: {done.status} with a table: {made}"]

    return Attack(
        f"drive {number}", ("export", "cam.yaml"), {"cam.yaml": text.encode()}, (0, 1, 2), judge, seconds=15.0
    )


def tabled_for_a_drive(rng: Random, number: int) -> Attack:
    """A table for a drive that is none, or none of this motion: never right, and never a traceback."""
    rows = []
    head = rng.choice(HEADS)
    wide = head.rstrip().rpartition("\n")[2].count(",")
    for angle in range(0, 361, rng.choice([10, 30, 90, 360])):
        cells = [rng.choice([0, 1e-3, 5, 1e300, -4]) for _ in range(wide)]
        rows.append(",".join(map(str, [angle, *cells])) + "\n")
    if rng.random() < 0.4:
        rows[rng.randrange(len(rows))] = rng.choice(["", "x,y\n", "10\n", "nan,nan\n", "1,2,3,4,5,6\n", "180,inf\n"])
    if rng.random() < 0.3:  # of a curve point table
        mark = rng.choice([";", "\t", ",", ";;"])
        head = f"{len(rows) + rng.choice([0, 0, 0, 1, -1])}\n"
        rows = [mark.join(row.split(",")[:2]).rstrip() + "\n" for row in rows]
    files = {"cam.yaml": drawn(rng).text("dxf").encode(), "drive.csv": (head + "".join(rows)).encode()}
    return Attack(f"drive's table {number}", ("verify", "cam.yaml", "drive.csv"), files, statuses=(1, 2))
