"""What the tests of sweeps share."""

import pytest


@pytest.fixture
def no_pictures(monkeypatch):
    """Pictures are composed, but not drawn: for tests that look at other files."""
    made = {"png": b"\x89PNG", "svg": b"<svg/>"}
    monkeypatch.setattr("camgeo.capabilities.sweep.pictures._encoded", lambda _: made)


@pytest.fixture
def pooled(monkeypatch):
    """More processes are started after the first piece of work, however short."""
    monkeypatch.setattr("camgeo.capabilities.sweep.engines._TRIAL", 0.0)
    monkeypatch.setattr("camgeo.capabilities.sweep.engines._WORTHWHILE", 0.0)
