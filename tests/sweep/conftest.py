"""What the tests of sweeps share."""

import pytest


@pytest.fixture
def no_pictures(monkeypatch):
    """Pictures are composed, but not drawn: for tests that look at other files."""
    made = {"png": b"\x89PNG", "svg": b"<svg/>"}
    monkeypatch.setattr("camgeo.sweep.search.pictures._encoded", lambda _: made)
