"""The site of the docs, as it is made: links, anchors, pictures, its menu, its bytes, its search in a browser."""

import re

import pytest
from support import pyodide
from support.browser import Browser, executable
from support.places import ROOT
from support.site import Page, Search, faults, make_site
from support.tab import Plain, served

MADE = make_site()
PAGES = sorted(path.name for path in (ROOT / "docs").glob("*.md"))


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    if MADE.why_not():
        pytest.skip(MADE.why_not())
    folder = tmp_path_factory.mktemp("site") / "site"
    assert "without the page that designs in a browser" in MADE.build(folder)
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    if executable() is None:
        pytest.skip("no browser here: install chromium, or name one in CAMGEO_BROWSER")
    with Browser(tmp_path_factory.mktemp("profile")) as one:
        yield one


@pytest.fixture(scope="module")
def address(site):
    with served(site, Plain) as there:
        yield there


# --- what is in it ----------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_every_link_anchor_and_file_is_there_and_of_the_site(site):
    assert len(list(site.rglob("*.html"))) > 150
    assert faults(site) == []


@pytest.mark.slow
def test_every_picture_of_the_docs_is_on_its_page(site):
    """Raw HTML too; each is a file of the site, as the links above are."""
    shown = 0
    for name in PAGES:
        text = re.sub(r"^ *```.*?^ *```", "", (ROOT / "docs" / name).read_text("utf-8"), flags=re.DOTALL | re.MULTILINE)
        given = re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", text) + re.findall(r'<img [^>]*src="([^"]+)"', text)
        page = Page((site / name.replace(".md", ".html")).read_text("utf-8"))
        assert sorted(page.pictures) == sorted(given), name
        assert all((site / picture).read_bytes() == (ROOT / "docs" / picture).read_bytes() for picture in given)
        shown += len(given)
    assert shown > 100


@pytest.mark.slow
def test_every_recipe_and_example_is_published_as_it_is(site):
    files = [path for top in MADE.SHOWN for path in (ROOT / top).rglob("*") if path.suffix in {".yaml", ".py", ".csv"}]
    assert len(files) > 100
    for path in files:
        place = path.relative_to(ROOT)
        assert (site / place).read_bytes() == path.read_bytes()
        assert path.name in (site / f"{place}.html").read_text("utf-8")


@pytest.mark.slow
def test_no_comment_and_no_markdown_is_left(site):
    for name in PAGES:
        html = (site / name.replace(".md", ".html")).read_text("utf-8")
        article = re.sub(r"<pre.*?</pre>|<code.*?</code>", "", html[html.index("<article") :], flags=re.DOTALL)
        assert "needs:" not in article
        assert re.findall(r"\]\([^)]*\.md|<p>\s*\||<p>- |^- |\*\*[a-z]|<p>\d+\. ", article, re.MULTILINE) == [], name


@pytest.mark.slow
def test_the_menu_has_every_page_in_the_order_of_the_first(site):
    text = (ROOT / "docs" / "index.md").read_text("utf-8")
    menu = [row.page for section in MADE.sections(text) for row in section.pages]
    assert sorted(menu) == sorted({*PAGES, "../CONTRIBUTING.md", "../CHANGELOG.md"} - {"index.md"})
    page = (site / "api.html").read_text("utf-8")
    order = re.findall(r'<a href="\./([^"#]*)" class="md-nav__link', page)
    wanted = [name.removeprefix("../").lower().replace(".md", ".html") for name in menu]
    assert [name for name in order if name in wanted] == wanted


@pytest.mark.slow
def test_the_public_names_have_their_docstrings(site):
    import camgeo

    page = (site / "api.html").read_text("utf-8")
    for name in camgeo.__all__:
        assert name.startswith("_") or f"camgeo.{name}" in page, name
    assert "exact cam" in page


@pytest.mark.slow
def test_every_command_is_described(site):
    from camgeo.registry import registry

    page = (site / "commands.html").read_text("utf-8")
    added = [command for label in registry.labels().values() for command in label.commands]
    for name in ("export", "check", "verify", "new", "report", "laws", "schema", *added):
        assert f"usage: camgeo {name} [-h]" in page
    assert "130 interrupted" in page


@pytest.mark.slow
def test_made_again_it_has_the_same_bytes(site, tmp_path):
    MADE.build(tmp_path / "again")
    assert MADE.zipped(site) == MADE.zipped(tmp_path / "again")


@pytest.mark.slow
@pytest.mark.skipif(bool(pyodide.why_not()), reason=pyodide.why_not() or "-")
def test_the_page_that_designs_is_inside_where_pyodide_is(tmp_path):
    if MADE.why_not():
        pytest.skip(MADE.why_not())
    folder = tmp_path / "site"
    assert "without" not in MADE.build(folder, pyodide.folder())
    assert faults(folder) == []
    for name in ("index.html", "tab.html"):
        assert "design/index.html" in Page((folder / name).read_text("utf-8")).links
    assert (folder / "design" / "worker.js").is_file()


# --- in a browser -----------------------------------------------------------------------------------------------------

QUERIES = {
    "foreign dxf": {"follow", "handoff"},
    "lift table": {"recipe-motion", "camshafts"},
    "reverse engineer": {"follow", "made"},
    "barrel cam": {"cylindrical"},
    "cam card": {"engine", "camshafts", "recipe-motion"},
    "measured part": {"made"},
    "print a toy": {"toy"},
    "undercut": {"theory", "recipe-disc"},
    "spring": {"dynamics"},
    "controller table": {"controllers"},
    "PLC": {"controllers"},
    "servo": {"axis"},
    "electronic cam": {"axis"},
    "G-code": {"milling"},
    "STEP": {"handoff"},
    "grinding": {"camshafts"},
    "valve lift": {"valve"},
    "keyway": {"recipe-part"},
    "indexing": {"indexing"},
    "globoid": {"which-cam"},
    "constant breadth": {"constant-breadth"},
    "yoke": {"recipe-yoke"},
    "tolerance": {"budget"},
    "pytest": {"pytest"},
    "laser": {"handoff", "manufacture"},
    "desmodromic": {"pairs"},
    "exit status": {"judge", "commands"},
    "commands": {"commands"},
    "install": {"first-cam"},
    "old drawing": {"follow"},
    "3d printing": {"mechanism", "first-cam"},
    "pressure angle": {"recipe-verify"},
    "advertised duration": {"engine", "recipe-motion"},
    "several figures": {"toy"},
    "probe error": {"made"},
    "better law": {"follow"},
}


@pytest.mark.slow
def test_the_search_finds_what_strangers_ask_for(address, browser):
    search = Search(browser, address)
    missed = {}
    for query, pages in QUERIES.items():
        first = [link.partition("#")[0].strip("/").removesuffix(".html") for link in search.results(query)[:3]]
        if not pages.intersection(first):
            missed[query] = first
    assert missed == {}
    assert search.results("zzyzx") == []


# px; the window itself grows about what is too wide on a telephone, the client's width does not
OVER = "Math.max(0, document.documentElement.scrollWidth - document.documentElement.clientWidth)"


@pytest.mark.slow
def test_every_page_fits_its_window_and_asks_no_other_host(address, site, browser):
    browser.requests.clear()
    browser.problems.clear()
    wide = {}
    for path in sorted(site.glob("*.html")):
        browser.call("Page.navigate", url=f"{address}{path.name}")
        browser.wait(f"document.readyState === 'complete' && location.pathname.endsWith('/{path.name}')")
        for width in (390, 1280):
            browser.size(width, 900, mobile=width < 400)
            if over := browser.ask(OVER):
                wide[path.name, width] = over
    browser.ask("document.querySelector('article').insertAdjacentHTML('beforeend', '<hr style=\"width: 1500px\">'), 0")
    assert browser.ask(OVER) > 0  # what is too wide is seen
    assert wide == {}
    assert len(browser.requests) > 100
    assert [one for one in browser.requests if not one.startswith((address, "data:", "about:"))] == []
    assert browser.problems == []


# --- what the tests above would find ----------------------------------------------------------------------------------


def test_planted_faults_are_found(tmp_path):
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "a.svg").write_text("<svg/>")
    (tmp_path / "other.html").write_text('<h2 id="there">x</h2><a name="old"></a>')
    good = '<img src="pictures/a.svg"><a href="other.html#there">x</a><a href="other.html#old">x</a><a href="https://b.org">x</a>'
    (tmp_path / "index.html").write_text(f'{good}<a href="#own">x</a><p id="own">')
    assert faults(tmp_path) == []
    planted = {
        '<a href="none.html">x</a>': "none.html is not there",
        '<td><a href="../recipes/x.yaml">x</a>': "../recipes/x.yaml is not there",
        '<a href="/other.html">x</a>': "/other.html is not there",
        '<a href="other.html#gone">x</a>': "other.html#gone has no such anchor",
        '<a href="#gone">x</a>': "#gone has no such anchor",
        '<img src="pictures/b.svg">': "pictures/b.svg is not there",
        '<script src="https://cdn.org/x.js"></script>': "index.html loads https://cdn.org/x.js",
        '<link rel="stylesheet" href="//fonts.org/x.css">': "index.html loads //fonts.org/x.css",
    }
    for text, told in planted.items():
        (tmp_path / "index.html").write_text(good + text)
        (fault,) = faults(tmp_path)
        assert told in fault
    (tmp_path / "index.html").write_text(good)
    (tmp_path / "site.css").write_text("a {background: url('https://fonts.org/x.woff2')}")
    assert faults(tmp_path) == ["site.css loads https://fonts.org/x.woff2"]


def test_pages_are_rewritten_but_not_their_code(tmp_path):
    source = MADE.Source(tmp_path)
    text = "`[a](b.md) <!-- c -->` and [x](../recipes/shu-wu.yaml#l) <!-- needs: y -->\n<!-- z -->\n"
    text += "```sh\n<!-- kept -->\n```\n"
    plain = MADE.COMMENT.sub(lambda m: m["code"] or "", text)
    assert plain == "`[a](b.md) <!-- c -->` and [x](../recipes/shu-wu.yaml#l)\n```sh\n<!-- kept -->\n```\n"
    linked = MADE.LINK.sub(lambda m: source._linked(m, "docs", "page.md"), plain)
    assert linked == plain.replace("../recipes/shu-wu.yaml#l", "recipes/shu-wu.yaml.md#l")
    assert (tmp_path / "recipes" / "shu-wu.yaml").read_bytes() == (ROOT / "recipes" / "shu-wu.yaml").read_bytes()
    raw = '<a href="../recipes/shu-wu.yaml">x</a><img src="gallery/a.svg">'
    assert MADE.LINK.sub(lambda m: source._linked(m, "docs", "page.md"), raw) == raw.replace(
        "../recipes/shu-wu.yaml", "recipes/shu-wu.yaml.html"
    )
    with pytest.raises(FileNotFoundError, match=r"gone\.yaml"):
        source.place_of("recipes/gone.yaml")
    assert MADE.plain_lists("a\n- b\n  c\n- d\nx\n| a | b |\n| --- | --- |\n1. e\n\n   | f |\n") == (
        "a\n\n- b\n  c\n- d\nx\n\n| a | b |\n| --- | --- |\n1. e\n\n    | f |\n"
    )


def test_without_the_generator_one_line_says_what_brings_it(tmp_path, monkeypatch):
    monkeypatch.setattr(MADE, "find_spec", lambda _: None)
    monkeypatch.setattr("sys.argv", ["make_site.py", str(tmp_path / "site")])
    with pytest.raises(SystemExit, match=r"pip install -e '\.\[site\]' brings zensical"):
        MADE.main()
    assert not (tmp_path / "site").exists()


def test_a_folder_of_others_is_left_alone(tmp_path):
    (tmp_path / "mine.txt").write_text("x")
    with pytest.raises(SystemExit, match="name another"):
        MADE.build(tmp_path)
    assert (tmp_path / "mine.txt").is_file()
