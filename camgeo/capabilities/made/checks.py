"""Checks on measured points."""

from __future__ import annotations

from camgeo.capabilities.made.keys import ZONE_PATH
from camgeo.checks.declaration import Declared
from camgeo.checks.extension import Checks

PROFILE = Declared("made-profile", ("mm",), field=ZONE_PATH)
MOTION = Declared("made-motion", ("mm", "deg"), field="verify.motion_error")
OUTPUT = Declared("made-output", ("mm", "deg"), field="verify.output_error")
ANSWERS = Checks(checks=(PROFILE, MOTION, OUTPUT))
