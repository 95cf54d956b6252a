"""Loops and dyads: positions, extreme positions, mobility, transmission angle."""
