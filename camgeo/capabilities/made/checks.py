"""Checks on measured points."""

from __future__ import annotations

from camgeo.checks.declared import Declared

PROFILE = Declared("made-profile", ("mm",), field="made.profile")
MOTION = Declared("made-motion", ("mm", "deg"), field="verify.motion_error")
OUTPUT = Declared("made-output", ("mm", "deg"), field="verify.output_error")
CHECKS = (PROFILE, MOTION, OUTPUT)
