"""The longest windows within a band by two pointers, one function after another: a reference."""

from __future__ import annotations

import math

import numpy as np


def scanned(samples, band):
    """First nodes and whole cells of the longest windows, (abscissae, m) each."""
    found = np.full((2, len(samples.abscissae), len(samples.value)), -1)
    _scan(samples, band, np.empty((2, 2 * samples.value.shape[1]), dtype=np.intp), found[0], found[1])
    return found


def _scan(samples, band, queue, start, cells):
    """Run two pointers round each function, the window's extremes at the heads of two monotone queues."""
    value, low, high, abscissae = samples
    count, m, n = abscissae.shape
    best = np.empty(count)
    for row in range(m):
        best[:] = -1.0
        # queues of cells: least values rising, greatest falling
        head_low, tail_low, head_high, tail_high = 0, 0, 0, 0
        last = 0  # nodes i .. last are in the window
        for i in range(n):
            last = max(last, i)
            while head_low < tail_low and queue[0, head_low] < i:
                head_low += 1
            while head_high < tail_high and queue[1, head_high] < i:
                head_high += 1
            least = most = value[row, i]
            if head_low < tail_low:
                cell = queue[0, head_low]
                least = low[row, cell if cell < n else cell - n]
                cell = queue[1, head_high]
                most = high[row, cell if cell < n else cell - n]
            while last < i + n:
                cell = last if last < n else last - n
                bottom, top = min(least, low[row, cell]), max(most, high[row, cell])
                if not top - bottom <= band:
                    break
                least, most = bottom, top
                while head_low < tail_low:
                    cell_before = queue[0, tail_low - 1]
                    if low[row, cell_before if cell_before < n else cell_before - n] < low[row, cell]:
                        break
                    tail_low -= 1
                queue[0, tail_low] = last
                tail_low += 1
                while head_high < tail_high:
                    cell_before = queue[1, tail_high - 1]
                    if high[row, cell_before if cell_before < n else cell_before - n] > high[row, cell]:
                        break
                    tail_high -= 1
                queue[1, tail_high] = last
                tail_high += 1
                last += 1
            if last == i + n:
                start[:, row] = 0
                cells[:, row] = n
                break
            before, j = i - 1 if i else n - 1, last if last < n else last - n
            if max(most, high[row, before]) - min(least, low[row, before]) <= band:
                continue  # a window from the node before holds this one
            after = j + 1 if j + 1 < n else 0
            floor, ceiling = most - band, least + band
            f_i, f_j, f_before, f_after = value[row, i], value[row, j], value[row, before], value[row, after]
            for k in range(count):
                x_i, x_j = abscissae[k, row, i], abscissae[k, row, j]
                x_before, x_after = abscissae[k, row, before], abscissae[k, row, after]
                if before > i:
                    x_before -= 2.0 * math.pi
                if last >= n:
                    x_j += 2.0 * math.pi
                if last + 1 >= n:
                    x_after += 2.0 * math.pi
                if (x_after - x_before) + 1e-9 < best[k]:
                    continue
                left, right = 1.0, 1.0
                left_side, right_side = 0, 0
                if f_before > ceiling:
                    left, left_side = (ceiling - f_i) / (f_before - f_i), 1
                elif f_before < floor:
                    left, left_side = (f_i - floor) / (f_i - f_before), -1
                if f_after > ceiling:
                    right, right_side = (ceiling - f_j) / (f_after - f_j), 1
                elif f_after < floor:
                    right, right_side = (f_j - floor) / (f_j - f_after), -1
                left = left * (x_i - x_before)
                right = right * (x_after - x_j)
                more = max(left, right) if left_side * right_side < 0 else left + right
                reach = (x_j - x_i) + more
                if reach > best[k]:
                    best[k] = reach
                    start[k, row], cells[k, row] = i, last - i
