"""Fixtures of the published cases: one workshop, in which each recipe is exported once."""

import pytest
from ledger import Workshop


@pytest.fixture(scope="session")
def workshop(tmp_path_factory):
    return Workshop(tmp_path_factory.mktemp("validation"))
