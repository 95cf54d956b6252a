"""Fixtures of the published cases: one workshop, in which each recipe is exported once."""

import pytest
from ledger import Workshop
from support.once import common


@pytest.fixture(scope="session")
def workshop(tmp_path_factory):
    return Workshop(common(tmp_path_factory) / "validation")
