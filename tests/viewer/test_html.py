"""Self-contained pages: no external content, escaped scripts, and how the command writes them."""

import base64
import hashlib
import json
import re
from html.parser import HTMLParser

import pytest

from command_line import EXAMPLES, SCENE
from polhode._cli import main
from polhode._viewer import document
from polhode._viewer import html as _html
from viewers import SCRIPT, needs_bundle

NASTY = "</script><script>alert(1)</script><!-- & \" ' \u2028 <svg onload=x> Ω"


class Page(HTMLParser):
    """The elements of a page with their attributes, and the texts of its scripts."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.texts = [], {}
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_data(self, text):
        if self.elements and self.elements[-1][0] in ("script", "title"):
            tag, attributes = self.elements[-1]
            key = attributes.get("type", tag)
            self.texts[key] = self.texts.get(key, "") + text

    def all(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.mark.usefixtures("bundle")
@pytest.mark.parametrize("text", [f'title = "a"\n# {NASTY}\n', NASTY, "", "é" * 10])
def test_the_document_is_embedded_as_data(text):
    shown = {"format": 1, "scene": text, "name": NASTY}
    page = Page(_html.page(shown))
    assert json.loads(page.texts["application/json"]) == shown
    assert [script.get("type") for script in page.all("script")] == ["application/json", "module"]
    assert page.texts["module"].strip() == SCRIPT.strip().replace("</script", r"\x3C/script")
    assert not page.all("svg")


@pytest.mark.usefixtures("bundle")
def test_a_title_is_escaped():
    shown = {"format": 1, "scene": f"title = {json.dumps(NASTY)}"}
    page = Page(_html.page(shown))
    assert page.texts["title"].strip() == NASTY
    assert len(page.all("script")) == 2
    # A file name may be invalid UTF-8.
    assert "<title>caf?</title>" in _html.page({"format": 1, "scene": "", "name": "caf\udce9.toml"})


@pytest.mark.usefixtures("bundle")
def test_a_page_loads_nothing():
    text = _html.page(document.document(EXAMPLES / "t-handle.toml"))
    page = Page(text)
    assert text.startswith("<!doctype html>\n<html lang=")
    assert text.index('charset="utf-8"') < 1024
    policy = next(one["content"] for one in page.all("meta") if "http-equiv" in one)
    allowed = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    assert allowed["default-src"] == "'none'"
    assert "unsafe-eval'" not in allowed["script-src"].replace("'wasm-unsafe-eval'", "")
    assert not re.search(r"https?:|\*|'self'", policy)
    addresses = [one.get(name) for _, one in page.elements for name in ("src", "href") if one.get(name)]
    assert addresses == ["data:,"]
    # The policy precedes what it applies to.
    assert text.index("Content-Security-Policy") < text.index("<style")


@pytest.mark.usefixtures("bundle")
def test_the_policy_allows_no_script_but_the_viewer():
    """By its hash: a script in the title or the data of a page cannot run."""
    text = _html.page({"format": 1, "scene": NASTY, "name": NASTY})
    scripts = re.search(r"script-src ([^;]*)", text)[1].split()
    script = re.search(r'<script type="module">(.*?)</script>', text, re.DOTALL)[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert scripts == [f"'sha256-{digest}'", "'wasm-unsafe-eval'"]


def test_a_bundle_that_cannot_be_embedded_is_refused(bundle):
    bundle.write_text('"<!-- <script>"')
    with pytest.raises(ValueError, match="<!--"):
        _html.page({"format": 1})


def test_a_missing_bundle_is_reported_with_the_remedy(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(_html, "_BUNDLE", tmp_path / "viewer.js")
    with pytest.raises(FileNotFoundError, match="make viewer"):
        _html.page({"format": 1})
    # Before the run.
    assert main.main(["run", str(EXAMPLES / "toutatis.toml"), "--html", str(tmp_path / "a.html")]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "Node >= 20" in captured.err
    assert not list(tmp_path.iterdir())


@needs_bundle
def test_pages_are_small():
    """The core and the drawing library take 2.0 MB; compressed, as servers send it, a page has 1.0 MB."""
    text = _html.page(document.document(EXAMPLES / "toutatis.toml"))
    assert len(text.encode()) < 2_050_000
    assert len(Page(text).all("script")) == 2


# --- polhode run --html


@pytest.mark.usefixtures("bundle")
def test_run_writes_a_page(scene, capsys):
    target = scene.with_name("page.html")
    assert main.main(["run", str(scene), "--html", str(target)]) == 0
    assert capsys.readouterr().out.endswith(f"Written\n  {target}\n")
    shown = json.loads(Page(target.read_text(encoding="utf-8")).texts["application/json"])
    assert shown == {"format": 1, "scene": SCENE, "name": "small.toml"}


@pytest.mark.usefixtures("bundle")
def test_the_page_of_a_stepped_run_has_its_states(scene, capsys):
    scene.write_text(SCENE + 'method = "rk4"\nstep = "10 ms"\n')
    assert main.main(["run", str(scene), "--json", "--html", str(scene.with_name("a.html"))]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["files"] == [str(scene.with_name("a.html"))]
    shown = json.loads(Page(scene.with_name("a.html").read_text()).texts["application/json"])
    assert json.loads(shown["recorded"]["about"])["steps"] == summary["run"]["steps"]


@pytest.mark.usefixtures("bundle")
@pytest.mark.parametrize("many", [False, True])
def test_data_figures_and_page_are_written_together(many, scene, capsys):
    pytest.importorskip("matplotlib")
    pytest.importorskip("h5netcdf")
    if many:
        scene.write_text(SCENE.replace("[run]", '[ensemble]\nnumber = 3\nattitude = "uniform"\n[run]'))
    target, output = scene.with_name("a.html"), scene.with_name("a.nc")
    assert main.main(["run", str(scene), "-o", str(output), "--html", str(target)]) == 0
    figures = ("ensemble", "directions") if many else ("motion", "polhode")
    names = ["a.nc", *(f"a-{figure}.png" for figure in figures), "a.html"]
    listed = capsys.readouterr().out.partition("Written\n")[2].split()
    assert listed == [str(scene.with_name(name)) for name in names]
    assert sorted(path.name for path in scene.parent.iterdir()) == sorted([*names, "small.toml"])


@pytest.mark.usefixtures("bundle")
def test_a_page_of_an_ensemble_alone(scene):
    text = SCENE.replace("[run]", '[ensemble]\nnumber = 3\nattitude = "uniform"\n[run]')
    scene.write_text(text)
    assert main.main(["run", str(scene), "--html", str(scene.with_name("a.html"))]) == 0
    shown = json.loads(Page(scene.with_name("a.html").read_text()).texts["application/json"])
    assert shown == {"format": 1, "scene": text, "name": "small.toml"}


@pytest.mark.usefixtures("bundle")
@pytest.mark.parametrize("name", ["nowhere/a.html", "folder.html"])
def test_a_page_that_cannot_be_written_is_refused_before_the_work(name, scene, capsys):
    scene.with_name("folder.html").mkdir()
    before = sorted(scene.parent.iterdir())
    arguments = ["run", str(scene), "-o", str(scene.with_name("a.nc")), "--html", str(scene.parent / name)]
    assert main.main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("polhode: error: cannot write ")
    assert sorted(scene.parent.iterdir()) == before


@pytest.mark.parametrize("name", ["a.txt", "a", ".html", ""])
def test_a_page_is_an_html_file(name, scene, capsys):
    with pytest.raises(SystemExit) as stop:
        main.main(["run", str(scene), "--html", name])
    assert stop.value.code == 2
    assert f"a page is saved as FILE.html or FILE.htm, not '{name}'" in capsys.readouterr().err
