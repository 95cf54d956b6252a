"""The part of a recipe from the values that were read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.din6885 import key_for
from camgeo.recipe.model_part import Bolts, Dowel, Flat, Hub, Keyway, Lightening, Mark, Part, SetScrew

if TYPE_CHECKING:
    from camgeo.recipe.reader import Values

SIDES = {"square": 4, "hexagon": 6}


def build_part(values: Values) -> Part:
    """Make the part of values in which there is no fault."""
    bore = values.get("bore")
    form: Values = bore if isinstance(bore, dict) else {}
    name = next((name for name in SIDES if name in form), "")
    width = form[name] if name else bore
    mark = values.get("mark")
    return Part(
        thickness=values.get("thickness"),
        bore=width,
        sides=SIDES.get(name, 0),
        bore_at=form.get("at", 0.0),
        keyway=_keyway(values.get("keyway"), width),
        flat=Flat(**values["flat"]) if "flat" in values else None,
        hub=Hub(**values["hub"]) if "hub" in values else None,
        set_screw=SetScrew(**values["set_screw"]) if "set_screw" in values else None,
        bolts=Bolts(**values["bolts"]) if "bolts" in values else None,
        dowel=Dowel(**values["dowel"]) if "dowel" in values else None,
        lightening=Lightening(**values["lightening"]) if "lightening" in values else None,
        chamfer=values.get("chamfer"),
        mark=None if mark is None else Mark(**{"kind" if key == "as" else key: item for key, item in mark.items()}),
        wall=values.get("wall"),
    )


def _keyway(keyway: Values | None, bore: float | None) -> Keyway | None:
    if keyway is None or "width" in keyway:
        return None if keyway is None else Keyway(**keyway)
    row = None if bore is None else key_for(bore)
    return None if row is None else Keyway(row.width, row.hub, keyway.get("at", 0.0), standard=True)
