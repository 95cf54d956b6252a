"""Remarks on a follower train: what an engineer would look at twice, and that fails nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.dynamics.running_forces import running_of
from camgeo.measures.remarks import Remark

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def lost_contact(recipe: Recipe, design: Design) -> list[Remark]:
    """Remark on a preloaded contact that inertia and load lift off at the train's speed, which leaves play there."""
    if design.exact.preload is None:
        return []
    running = running_of(recipe, design)
    if running is None or running.jam_deg is not None:
        return []
    lost = [(loss.rpm, loss) for loss in running.lost_rpm() if loss.rpm is not None]
    if not lost or min(lost)[0] > running.train.rpm:
        return []
    rpm, loss = min(lost)
    begins = f"from {rpm:.6g} rpm" if rpm > 0.0 else "by its load alone"
    remark = f"the preload does not hold {loss.contact} at {running.train.rpm:.6g} rpm: it is lost {begins}"
    return [Remark("lost-contact", rpm, running.train.rpm, "rpm", remark, loss.at_deg)]
