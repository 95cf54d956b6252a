"""Fixtures of pytest's own that tests of the plugin need."""

pytest_plugins = ["pytester"]
