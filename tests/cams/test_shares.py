"""The share of a swing with which a law is possible, and how contacts share an interference."""

from __future__ import annotations

from typing import Any

import pytest

from camgeo.cams.double_roller import DoubleRollerCam
from camgeo.cams.family import Preload
from camgeo.cams.pairs import DeltaRoute, _greatest_share
from kin.law.normalised import IntentError


@pytest.mark.parametrize("most", [0.999, 0.73, 0.5, 0.31, 0.06])
def test_the_greatest_share_is_found_from_below(most: float) -> None:
    tried: list[float] = []

    def law(share: float) -> None:
        tried.append(share)
        assert len(tried) < 30
        if share > most:
            raise IntentError("too much", "cam")

    found = _greatest_share(law)
    assert most - 1e-3 <= found <= most
    assert found in tried


def test_where_no_share_does_there_is_none() -> None:
    tried: list[float] = []

    def law(share: float) -> None:
        tried.append(share)
        assert len(tried) < 30
        raise IntentError("never", "cam")

    assert _greatest_share(law) == 0.0
    assert min(tried) == 0.05


@pytest.mark.parametrize(("most", "told"), [(0.4, "; with each value of D multiplied by 0.399 such a"), (0.0, "")])
def test_an_impossible_law_tells_the_share_that_is_possible(
    most: float, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def law(_: Any, share: float = 1.0) -> None:
        if share > most:
            raise IntentError("too much", "delta")

    monkeypatch.setattr(DoubleRollerCam, "_law", law)
    cam = DoubleRollerCam(3, 1, 50.0, 8.0, DeltaRoute(((1, 625.0),), ()), "refuse")
    with pytest.raises(IntentError) as refused:
        cam.transmission()
    assert refused.value.message.removesuffix(" motion is possible") == f"too much{told}"
    assert refused.value.field == "delta"


def test_contacts_share_an_interference() -> None:
    assert Preload(0.02).overlaps == pytest.approx((0.01, 0.01))
    assert Preload(0.02, shares=(0.0, 1.0)).overlaps == pytest.approx((0.0, 0.02))
    assert Preload(0.02, shares=(0.25, 0.75)).overlaps == pytest.approx((0.005, 0.015))
