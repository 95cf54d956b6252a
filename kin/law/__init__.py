"""Motions: laws, segments, programmes and formulas; the transmission of a pair; whether a motion is feasible."""
