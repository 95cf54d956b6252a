"""Controllers of drives: how each joins the rows of a cam table, in which numbers, and the layout of its file.

The pages of vendors that show a layout are listed in docs/controllers.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.table import DIGITS, write_table
from kin.law.joined_rows import RATES
from kin.read.drive_tables import CAM_ARRAY, COLUMNS, JOINS, MASTER, MOTION_FUNCTION, SINGLE

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from kin.law.joined_rows import Join
    from kin.numeric.arrays import Array

PLACES = 9  # decimals of a curve point: of a millimetre the last is 1e-6 micrometres
SINGLE_DIGITS = 9  # that bring back a number of 32 bits
MOST_ROWS = 360_001  # of a turn, 0.001 degrees apart
EXACT_POWER = 22  # the greatest power of ten that is a double
MOTION_POINT = 8  # MOTIONPOINTTYPE_MOTION of MC_MotionPointType, 16#0008


_POWERS = np.array([float(f"1e{power}") for power in range(EXACT_POWER + 1)])


class Rows(NamedTuple):
    """Rows of a table, rounded as its controller keeps them: degrees (n,), slave and its derivatives (k, n).

    `slave` is in the file's `unit`, mm, in or deg, its derivatives by degree of the master. `ends` are the slopes of a
    cubic spline at both ends.
    """

    degrees: Array
    slave: Array
    unit: str
    ends: tuple[float, float] = (0.0, 0.0)


def fixed(value: float) -> str:
    """Text of a number rounded to nine decimals, without zeros at its end and without an exponent; -0 is 0.

    SEW-EURODRIVE's manual of the MOVI-C mentions no exponents.
    """
    text = f"{value:.{PLACES}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def decimal(values: Array) -> Array:
    """Numbers (...) rounded to twelve digits, each the double that is nearest to a number of so many digits.

    Whole numbers of twelve digits and powers of ten up to 22 are doubles, so that one division or product gives it.
    Of two that are as near to within rounding either may be taken.
    """
    size = np.abs(values)
    power = DIGITS - 1 - np.floor(np.log10(np.where(size > 0.0, size, 1.0))).astype(int)
    plain = (size > 0.0) & (np.abs(power) <= EXACT_POWER - 1)
    ten = _POWERS[np.where(plain, np.abs(power), 0)]
    whole = np.rint(np.where(power < 0, values / ten, values * ten))
    # the logarithm is rounded: next to a power of ten there may be a digit too few
    plain &= (np.abs(whole) >= 10.0 ** (DIGITS - 1)) & (np.abs(whole) <= 10.0**DIGITS)
    rounded: Array = np.where(power < 0, whole * ten, whole / ten)
    others = ~plain & (size > 0.0)
    rounded[~plain] = 0.0
    rounded[others] = [float(f"{value:.{DIGITS}g}") for value in values[others].tolist()]
    return rounded


def _fixed(values: Array) -> Array:
    return np.array([float(fixed(value)) for value in values.ravel().tolist()]).reshape(values.shape)


def _single(values: Array) -> Array:
    return values.astype(np.float32).astype(np.float64)


def _write_plain(path: Path, rows: Rows, head: Sequence[str]) -> None:
    names = (MASTER, f"slave_{rows.unit}", *COLUMNS[: len(rows.slave) - 1])
    write_table(path, names, np.column_stack([rows.degrees, *rows.slave]), head=head)


def _write_single(path: Path, rows: Rows, head: Sequence[str]) -> None:
    names = (MASTER, f"slave_{rows.unit}")
    table = np.column_stack([rows.degrees, rows.slave[0]])
    write_table(path, names, table, head=(*head, SINGLE), digits=SINGLE_DIGITS)


def _write_motion_function(path: Path, rows: Rows, head: Sequence[str]) -> None:
    """Write points of `MC_MotionFunctionPoint`, each with the function up to the next one."""
    one = np.ones_like(rows.degrees)
    point = [np.arange(1.0, len(one) + 1.0), one * MOTION_FUNCTION.code_of("quintic"), one * MOTION_POINT, one]
    table = np.column_stack([*point, rows.degrees, *rows.slave])
    write_table(path, MOTION_FUNCTION.columns, table, head=(*head, f"slave in {rows.unit}"))


def _cam_array(join: Join) -> Callable[[Path, Rows, Sequence[str]], None]:
    def write(path: Path, rows: Rows, head: Sequence[str]) -> None:
        first, last = (f"{slope:.{SINGLE_DIGITS}g}" for slope in rows.ends)
        slopes = f"; MCCP with Start Slope {first}, End Slope {last}" if join == "cubic" else ""
        table = np.column_stack(
            [rows.degrees, rows.slave[0], np.full_like(rows.degrees, float(CAM_ARRAY.code_of(join)))]
        )
        own = (*head, SINGLE, f"slave in {rows.unit}{slopes}")
        write_table(path, CAM_ARRAY.columns, table, head=own, digits=SINGLE_DIGITS)

    return write


def write_curve_points(path: Path, rows: Rows, _head: Sequence[str]) -> None:
    """Write a curve point table of SEW-EURODRIVE's MOVI-C, in the layout of `kin.read.curve_points`.

    The file has the number of rows, then master and slave of each, without heading and remarks. Raises OSError where it
    cannot be written.
    """
    pairs = zip(rows.degrees.tolist(), rows.slave[0].tolist(), strict=True)
    lines = [str(len(rows.degrees)), *(f"{fixed(master)};{fixed(slave)}" for master, slave in pairs)]
    path.write_bytes("".join(f"{line}\n" for line in lines).encode("ascii"))


class Controller(NamedTuple):
    """A controller: how it interpolates between the rows of its table, and the layout of the table.

    `join` is the interpolation. Two texts are for the head of the table: `layout` describes the layout, `word` says by
    whose word the controller interpolates so. `most` is the greatest number of rows that it takes. `rounded` rounds
    numbers as the controller keeps them; `write` writes the table: (path, rows, lines of the head). `order` is that of
    the highest derivative in the table.
    """

    join: Join
    layout: str
    word: str
    most: int = MOST_ROWS
    rounded: Callable[[Array], Array] = decimal
    write: Callable[[Path, Rows, Sequence[str]], None] = _write_plain
    third: bool = False

    @property
    def order(self) -> int:
        """Order of the highest derivative in the table."""
        return 3 if self.third else RATES[self.join]

    @property
    def stated(self) -> bool:
        """Whether the table has a head, which states its error."""
        return self.write is not write_curve_points

    @property
    def joined(self) -> str:
        """Words of the head on how rows are joined, and by whose word."""
        return f"{JOINS[self.join]} ({self.word})"


_TWINCAT = "Beckhoff TwinCAT NC Camming, MC_CAM_REF of MC_TABLETYPE_"
_ROCKWELL = "Rockwell Logix 5000, array of CAM for MCCP and MAPC"
CONTROLLERS = {
    "codesys": Controller(
        "quintic",
        "CODESYS SoftMotion, MC_CAM_REF of type XYVA: an array of SMC_CAMXYVA with dX, dY, dV, dA",
        "by position, velocity and acceleration, as the library SM3_Basic says of SMC_CAM_TYPE.XYVA",
    ),
    "codesys-table": Controller(
        "line",
        "CODESYS SoftMotion, MC_CAM_REF of type XY: SMC_CAMTable_LREAL_n_2 with pairs of master and slave",
        "as SM3_Basic says of MC_CAM_REF with byInterpolationQuality 1",
    ),
    "twincat": Controller(
        "quintic",
        f"{_TWINCAT}MOTIONFUNCTION: an array of MC_MotionFunctionPoint, each with MOTIONFUNCTYPE_POLYNOM5_MM",
        "by position, velocity and acceleration, as MC_MotionFunctionType says of POLYNOM5_MM",
        write=_write_motion_function,
        third=True,
    ),
    "twincat-table": Controller(
        "line",
        f"{_TWINCAT}NONEQUIDISTANT, or EQUIDISTANT for equal steps: ARRAY [0..n, 0..1] OF LREAL, master and slave",
        "as MC_InterpolationType says of MC_INTERPOLATIONTYPE_LINEAR",
    ),
    "rockwell": Controller(
        "cubic",
        f"{_ROCKWELL}: Master, Slave and SegmentType 1",
        "with the slopes at both ends, as MOTION-RM002 says of MCCP; its second derivative is taken to be continuous",
        most=65_535,
        rounded=_single,
        write=_cam_array("cubic"),
    ),
    "rockwell-linear": Controller(
        "line",
        f"{_ROCKWELL}: Master, Slave and SegmentType 0",
        "as MOTION-RM002 says of linear segments",
        most=65_535,
        rounded=_single,
        write=_cam_array("line"),
    ),
    "siemens": Controller(
        "line",
        "Siemens SIMATIC CPU 317T, MC_CamSectorAdd: pairs X, Y of REAL in a data block, one after another",
        "as is assumed of MC_CamInterpolate",
        rounded=_single,
        write=_write_single,
    ),
    "sew": Controller(
        "line",
        "SEW-EURODRIVE MOVI-C, curve point table: the number of points, then master and slave with a semicolon between",
        "as its manual says of the interpolation method Linear",
        most=1024,
        rounded=_fixed,
        write=write_curve_points,
    ),
    "plain": Controller(
        "quintic",
        "x, s, v, a of any controller",
        "by position, velocity and acceleration, as is assumed here",
    ),
}
"""Controllers by their words after the key `for`, in the order of the schema."""
