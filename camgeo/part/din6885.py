"""Parallel keys by the bore: DIN 6885-1 (1968, forms A to J), the same widths and depths as ISO/R 773 (1969).

The hub's depth t2 leaves play at the key's back and is measured from the bore's circle to the keyway's floor: a hub's
drawing shows d + t2. Figures as tabled in Siemens/Flender MD 31.1 (2016), page 7/3, and, for bores below 38 mm, in
GB/T 1095-1979, whose other rows up to 230 mm are the same. JIS B 1301 has these rows too. Both depths may be greater,
by an amount that goes with the size of the key: 0.1 mm up to 6 x 6, 0.2 mm from 8 x 7 on, 0.3 mm from 36 x 20 on (the
same standards; up to a bore of 44 mm as tabled in Ganter's catalogue, "DIN 6885 keyway, key details").
"""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """Bores over `over` up to `to`; key `width` and `height`; depths `shaft` (t1) and `hub` (t2); all in mm."""

    over: float
    to: float
    width: float
    height: float
    shaft: float
    hub: float

    @property
    def deeper(self) -> float:
        """Upper deviation of both depths, mm; the lower one is 0."""
        return next(deviation for width, deviation in DEEPER if self.width <= width)


DEEPER = ((6.0, 0.1), (32.0, 0.2), (100.0, 0.3))  # greatest width of a key, and the upper deviation of its depths, mm
TABLE = (
    Row(6, 8, 2, 2, 1.2, 1.0),
    Row(8, 10, 3, 3, 1.8, 1.4),
    Row(10, 12, 4, 4, 2.5, 1.8),
    Row(12, 17, 5, 5, 3.0, 2.3),
    Row(17, 22, 6, 6, 3.5, 2.8),
    Row(22, 30, 8, 7, 4.0, 3.3),
    Row(30, 38, 10, 8, 5.0, 3.3),
    Row(38, 44, 12, 8, 5.0, 3.3),
    Row(44, 50, 14, 9, 5.5, 3.8),
    Row(50, 58, 16, 10, 6.0, 4.3),
    Row(58, 65, 18, 11, 7.0, 4.4),
    Row(65, 75, 20, 12, 7.5, 4.9),
    Row(75, 85, 22, 14, 9.0, 5.4),
    Row(85, 95, 25, 14, 9.0, 5.4),
    Row(95, 110, 28, 16, 10.0, 6.4),
    Row(110, 130, 32, 18, 11.0, 7.4),
    Row(130, 150, 36, 20, 12.0, 8.4),
    Row(150, 170, 40, 22, 13.0, 9.4),
    Row(170, 200, 45, 25, 15.0, 10.4),
    Row(200, 230, 50, 28, 17.0, 11.4),
)
LEAST, MOST = TABLE[0].over, TABLE[-1].to


def key_for(bore: float) -> Row | None:
    """Row of the table for a bore in mm; None outside the table. A bore of 6 mm itself takes the first row."""
    if bore == LEAST:
        return TABLE[0]
    return next((row for row in TABLE if row.over < bore <= row.to), None)
