"""HTML in a notebook: the verdict in words, and no text that leaves its cell."""

from camgeo.api.check import Check
from camgeo.api.notebook import line, notebook_html, table


def check(name, *, ok):
    return Check(name, ok, 1.5, 2.0, "mm", at=30.0, sense="at_least", file="a.dxf")


def test_the_verdict_counts_what_failed():
    html = notebook_html("<svg/>", "cam <1>", [check("wall", ok=False), check("motion", ok=True)])
    assert "cam &lt;1&gt;: 1 of 2 checks FAILED" in html
    assert "<td>wall</td><td>FAILED</td><td>1.5 mm</td><td>&gt;= 2</td><td>30.00°</td><td>a.dxf</td>" in html
    assert "all 1 checks hold" in notebook_html("", "cam", [check("motion", ok=True)])


def test_texts_are_escaped():
    assert line("a < b") == "<p>a &lt; b</p>"
    assert table(["<"], [["&"]]).count("&lt;") == 1
