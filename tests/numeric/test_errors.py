"""Every error that is raised on purpose reaches another process as it is."""

from __future__ import annotations

import importlib
import pickle
import pkgutil
from typing import TYPE_CHECKING

import pytest

import camgeo
import kin
from kin.law.normalised import IntentError
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Iterator


def kinds(of: type[CamgeoError]) -> Iterator[type[CamgeoError]]:
    yield of
    for each in of.__subclasses__():
        yield from kinds(each)


def test_a_motion_that_no_cam_can_have() -> None:
    back = pickle.loads(pickle.dumps(IntentError("too steep", "motion", 12.5)))
    assert type(back) is IntentError
    assert (str(back), back.message, back.field, back.at_deg) == ("too steep", "too steep", "motion", 12.5)


def test_every_kind_of_error() -> None:
    for package in (kin, camgeo):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if "pytest_plugin" not in found.name and "__main__" not in found.name:
                try:
                    importlib.import_module(found.name)
                except ImportError:  # an extra that is not installed
                    continue
    for kind in set(kinds(CamgeoError)):
        error = kind.__new__(kind, "what is wrong", 3.5)
        error.args, error.__dict__["at"] = ("what is wrong", 3.5), 3.5
        back = pickle.loads(pickle.dumps(error))
        assert type(back) is kind
        assert (back.args, back.__dict__["at"]) == (("what is wrong", 3.5), 3.5), kind


@pytest.mark.parametrize("cause", [None, CamgeoError("first")])
def test_an_error_s_text_is_kept(cause: CamgeoError | None) -> None:
    error = CamgeoError("at last")
    error.__cause__ = cause
    assert str(pickle.loads(pickle.dumps(error))) == "at last"
