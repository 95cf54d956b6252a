"""Pytest's own fixtures that tests of the plugin need, and how property tests choose their examples.

A run repeats the last one's examples, so that a change is judged by what it changes; `HYPOTHESIS_PROFILE=explore` looks
for new ones, and what it finds becomes an example of its own.
"""

from __future__ import annotations

import os
import signal

from hypothesis import settings

pytest_plugins = ["pytester"]

# A run in the background of a shell is born deaf to interrupts, and so would be the processes that tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("repeat", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeat"))
