"""Still pictures, as a program that is no browser draws them: literal colours, a ground of their own, fine lines."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from support.cases import few
from support.pages import SHOWN, of
from support.places import ROOT
from support.rendered import rendered, share

from camgeo.report.page.looks import LOOKS, colours, rules
from camgeo.report.page.svg import OTHER, still

if TYPE_CHECKING:
    from pathlib import Path

GALLERY = sorted((ROOT / "docs" / "gallery").glob("*.svg"))


def through(colour: str, role: str = "metal upper") -> str:
    """A colour as it is seen through the fill of a role."""
    look = LOOKS[role]
    below, above = ([int(text[at : at + 2], 16) for at in (1, 3, 5)] for text in (colour, colours()[look.fill]))
    mixed = (round((1.0 - look.opacity) * x + look.opacity * y) for x, y in zip(below, above, strict=True))
    return "#" + "".join(f"{part:02x}" for part in mixed)


def assert_is_seen(text: str) -> None:
    image = rendered(text)
    metal, edge = colours()["metal"], colours()["metal-edge"]
    if colours()["upper"] in text:  # of a pair of discs the lower one is seen through the upper one
        metal, edge = through(metal), through(edge)
    assert (image[..., 3] == 255).all()  # a ground of its own, legible on a dark page too
    assert share(image, colours()["ground"]) > 0.2
    assert share(image, metal) > 0.01
    assert 0.0005 < share(image, edge) < 0.04  # a line, neither a hair nor a beam
    least = 0.0001 if 'stroke-linecap="round"' in text else 0.0005  # a line of contact may be seen end on
    assert least < share(image, colours()["contact"]) < 0.02
    assert share(image, "#000000") == 0.0  # what a program paints that does not understand a colour


@pytest.mark.thin(12)
@pytest.mark.parametrize("path", few(GALLERY, 8), ids=lambda path: path.stem)
def test_the_gallery_is_seen_without_a_browser(path: Path) -> None:
    assert_is_seen(path.read_text(encoding="utf-8"))


def test_the_gallery_needs_no_style_sheet() -> None:
    assert len(GALLERY) >= 50
    for path in GALLERY:
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"var\(|<style|\sstyle=|calc\(|vector-effect|paint-order", text), path.name


@pytest.mark.slow
@pytest.mark.parametrize("name", few(SHOWN, 7))
def test_a_picture_is_seen_without_a_browser(name: str) -> None:
    text = still(of(name).content.scene, 100, name)
    assert_is_seen(text)
    if name == "shu-wu":
        faded = text.replace(f'fill="{colours()["metal"]}"', 'fill="var(--metal)"')  # as it once was
        with pytest.raises(AssertionError):
            assert_is_seen(faded)


def test_every_role_has_a_look_and_every_look_its_colours() -> None:
    code = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "camgeo" / "report" / "page").glob("*.py"))
    assert {role for role in re.findall(r'Shape\(\s*"([a-z ]+)"', code) if OTHER not in role} <= set(LOOKS)
    roles = {s.role for body in of(SHOWN[0]).content.scene.bodies for s in body.shapes}
    assert {role for role in roles if OTHER not in role} <= set(LOOKS)
    names = {name for look in LOOKS.values() for name in look[:2] if name}
    assert names <= set(colours())
    assert set(re.findall(r"var\(--([a-z-]+)\)", rules())) == names
