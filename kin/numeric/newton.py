"""Newton's method inside brackets: a zero is found as closely as is asked for, or an error says how far it came."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array


# Steps of Newton's method before brackets are halved alone: where it converges, it does in fewer.
FREE = 16
# Enough for a part in 10^18 of a bracket, which is more than its ends can tell unless they are close to zero.
HALVINGS = 60
ROUNDING = 1e-15  # of a place, or of 1 where that is more: a step that is none


def zeros(
    function: Callable[[Array], tuple[Array, Array]], low: Array, high: Array, start: Array, close: float | Array
) -> Array:
    """Zeros (n,) of n functions that rise through zero between low and high (n,), from `start` (n,) between these.

    `function(x)` gives values and slopes at x, (n,) each. A step out of what remains of a bracket ends at the bracket's
    end or, every other time, in its middle; after the first `FREE` steps brackets are halved alone. A zero has settled,
    and stays, after a Newton step of at most `close` (one or (n,)), as the next would be about its square; after any
    other step only if that was rounding. For a function without a zero in its bracket the end nearer to zero is given.

    Raises UnsettledError where a function is not a number, or where a bracket halved `HALVINGS` times is still wide.
    """
    x, open_ = start, np.ones(start.shape, dtype=np.bool_)
    for step in range(FREE + HALVINGS):
        value, slope = function(x)
        # the sign narrows the bracket; Newton's step is taken inside it, clipped to its end every other time
        low, high = np.where(value <= 0.0, x, low), np.where(value >= 0.0, x, high)
        usable = (slope > 0.0) & (slope < np.inf) & (step < FREE)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            newton = x - value / slope
        following = np.clip(newton, low, high) if step % 2 == 0 else newton
        inside = usable & (following >= low) & (following <= high)
        following = np.where(inside, following, 0.5 * (low + high))
        moved = np.abs(following - x)
        x = np.where(open_, following, x)
        rounding = np.minimum(close, ROUNDING * np.maximum(np.abs(x), 1.0))
        small = np.where(inside & (newton == following), close, rounding)
        open_ &= ~(moved <= small) | np.isnan(value)
        if not open_.any():
            return x
    count, first = int(np.count_nonzero(open_)), int(np.argmax(open_))
    reason = f"{count} zeros were not found in {FREE + HALVINGS} steps; the last was of {moved[first]:.3g}"
    raise UnsettledError(reason, float(x[first]))
