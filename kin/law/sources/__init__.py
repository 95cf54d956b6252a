"""Motions from every source: segments with any law, a formula, a table, points, a lobe polynomial.

Each gives a `Motion` over an angle: displacement and exact derivatives, proved bounds, breaks, dwells, joints.
"""
