"""Lessons: every step drives the picture, quoted numbers hold, and malformed lessons are reported."""

import math
import re

import numpy as np
import pytest

import polhode as ph
from polhode._report.summary import summary
from polhode._support.files import UnreadableError
from polhode._viewer import document as _document
from polhode._viewer import html
from polhode._viewer.server import Source
from viewer_page import VIEWER
from viewer_scenes import ROOT

LESSONS = sorted((ROOT / "examples/lessons").glob("*.md"))
MODEL = f"async () => {{ const model = await {VIEWER}.ready; return %s; }}"


@pytest.fixture
def lesson(new_page, tmp_path):
    """Opens a lesson by its path."""

    def lesson(path, **options):
        page = new_page(**{"viewport": {"width": 1000, "height": 500}, **options})
        target = tmp_path / "lesson.html"
        target.write_text(html.page(_document.of_file(path)))
        page.open(target)
        return page

    return lesson


def read(page, expression):
    """Return the value of an expression of the page's `model`, when no scene is being solved."""
    page.until("!model.solving.value")
    return page.page.evaluate(MODEL % expression)


def step_of(page):
    return int(page.page.locator(".lesson").get_attribute("data-step"))


def phrase(page, text):
    page.page.locator("a.drive", has_text=text).first.click()


# --- the lessons


def test_a_book_is_thrown_three_ways(lesson):
    """Each step of one lesson, and what the picture shows in it."""
    page = lesson(ROOT / "examples/lessons/book-thrown-three-ways.md", reduced_motion="no-preference")
    main = 2 * math.pi * math.cos(math.radians(1))

    def about(axis):
        """Whether the book was thrown about an axis, one degree off."""
        return read(page, "model.about.value.start.omega_body")[axis] == pytest.approx(main, rel=1e-12)

    def about_longest():
        omega = read(page, "model.about.value.start.omega_body")
        return omega[0] == pytest.approx(2 * math.pi * math.cos(math.radians(8)), rel=1e-12)

    assert step_of(page) == 1
    assert about(0)
    assert read(page, "[model.playing.value, model.speed.value]") == [True, 0.5]
    phrase(page, "its shortest side")
    assert about(2)
    assert read(page, "model.speed.value") == 0.5
    phrase(page, "its longest side")
    assert about(0)

    page.page.locator("#lesson-next").click()
    assert about(1)
    assert read(page, "[model.playing.value, model.time.value]") == [False, 0]
    # The answer is hidden until a choice is made.
    assert page.page.get_by_text("It turns over every").count() == 0
    page.page.locator(".guess").nth(0).click()
    assert page.page.get_by_text("Not so.").is_visible()
    assert page.page.get_by_text("It turns over every").is_visible()
    assert read(page, "model.playing.value") is True

    page.page.locator("#lesson-next").click()
    phrase(page, "0.01°")
    assert read(page, "model.about.value.free.flip_time") == pytest.approx(5.24, abs=0.005)

    page.page.locator("#lesson-next").click()
    shown = read(page, "model.shown.value")
    assert {name for name, seen in shown.items() if seen} == {
        *("body", "bodyFrame", "momentum", "energy", "labels"),
    }
    page.page.locator(".energy canvas").first.wait_for(state="attached")
    phrase(page, "the longest")
    assert about_longest()

    page.page.locator("#lesson-next").click()
    assert read(page, "model.camera.value") == "oblique"
    page.page.locator(".guess").nth(0).click()
    assert page.page.get_by_text("That is right.").is_visible()
    moments = read(page, "model.about.value.body.moments")
    assert moments[0] == pytest.approx(moments[1], rel=1e-12)
    assert read(page, "model.speed.value") == 0.5
    phrase(page, "three different moments")
    assert len({round(moment, 6) for moment in read(page, "model.about.value.body.moments")}) == 3

    # Back to the question, which keeps its answer.
    for _ in range(3):
        page.page.locator("#lesson-back").click()
    assert step_of(page) == 2
    assert page.page.get_by_text("Not so.").is_visible()


@pytest.mark.parametrize(
    "path",
    [pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * (k > 0)) for k, path in enumerate(LESSONS)],
)
def test_every_step_and_phrase_works(path, lesson):
    page = lesson(path)
    count = path.read_text().count("\n## ")
    phrases = 0
    for step in range(1, count + 1):
        assert step_of(page) == step
        assert page.page.locator("li.line[data-holds=false]").count() == 0
        for guess in page.page.locator(".guess").all()[-1:]:
            guess.click()
        for link in page.page.locator("a.drive").all():
            before = read(page, "[model.scene.value, model.lines.value]")
            link.press("Enter")
            phrases += 1
            assert read(page, "model.problem.value") is None, link.get_attribute("data-do")
            if "let " in (target := link.get_attribute("data-do")) and step != count:
                assert read(page, "[model.scene.value, model.lines.value]")[0] == before[0], target
        assert read(page, "model.problem.value") is None
        assert page.page.locator("[data-problem]").count() == 0
        if step < count:
            page.page.locator("#lesson-next").click()
    assert phrases == path.read_text().count("](<#do:")


def test_lessons_are_on_the_first_page(opened):
    page = opened({"format": 1})
    names = page.page.locator("button[data-lesson]").evaluate_all("all => all.map(x => x.dataset.lesson)")
    assert set(names) == {path.stem for path in LESSONS}
    page.page.locator("[data-lesson=half-angles]").click()
    page.page.locator(".lesson[data-lesson=half-angles]").wait_for()
    assert read(page, "model.page.value") == "algebra"
    page.page.locator("#lesson-close").click()
    page.page.locator("#figure").wait_for()


def test_phone_needs_no_sideways_scrolling(lesson):
    page = lesson(LESSONS[0], viewport={"width": 360, "height": 740}, is_mobile=True, has_touch=True)
    wide = page.page.evaluate(
        f"""() => [...{VIEWER}.shadowRoot.querySelectorAll(".lesson, .lesson *")]
            .filter((element) => element.getBoundingClientRect().right > 361).map((one) => one.className)"""
    )
    assert wide == []


def test_values_change_steadily(lesson):
    page = lesson(ROOT / "examples/lessons/half-angles.md", reduced_motion="no-preference")
    for _ in range(4):
        page.page.locator("#lesson-next").click()
    page.page.evaluate(
        f"""async () => {{
            window.angles = [];
            (await {VIEWER}.ready).lines.subscribe((text) => window.angles.push(parseFloat(text.slice(4))));
        }}"""
    )
    phrase(page, "by 90°")
    page.until("model.lines.value.startsWith('θ = 90 deg')")
    angles = page.page.evaluate("window.angles")
    assert angles[0] == 0
    assert angles[-1] == 90
    assert angles == sorted(angles)
    assert len(angles) > 2


# --- their numbers


def scene_of(text, changes, tmp_path):
    """Return the motion of a scene text with other lines."""
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "scene.toml"
    path.write_text(text)
    scene = ph.Scene.read(path)
    trajectory = scene.run()
    return trajectory, summary(scene, trajectory)["motion"]


def blocks(name):
    """Return the text of a lesson, and its scenes."""
    text = (ROOT / f"examples/lessons/{name}.md").read_text()
    return " ".join(text.split()), re.findall(r"^```toml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def test_flip_times_of_the_book(tmp_path):
    text, (scene,) = blocks("book-thrown-three-ways")
    old = "cos(1 deg) e2∧e3 + sin(1 deg) e3∧e1"
    times = []
    for angle in ("1", "0.1", "0.01"):
        spin = f"cos({angle} deg) e3∧e1 + sin({angle} deg) e1∧e2"
        _, motion = scene_of(scene, {old: spin}, tmp_path)
        times.append(motion["flip_time"])
        row = rf"\| \[{re.escape(angle)}°\]\([^|]*\) \| {times[-1]:.2f} s \|"
        assert re.search(row, text)
    assert "every 2.72 seconds" in text
    # Near the axis the deviation grows and decays as exp(±λ t): a factor of ten takes ln 10/λ twice. This is
    # true up to terms of the square of the angle, here 3e-4.
    trajectory, _ = scene_of(scene, {}, tmp_path)
    a, b, c = np.sort(trajectory.inertia.principal_moments)
    growth = 2 * math.pi * math.sqrt((b - a) * (c - b) / (a * c))
    assert np.diff(times) == pytest.approx([2 * math.log(10) / growth] * 2, rel=1e-3)
    assert f"buys {2 * math.log(10) / growth:.2f} seconds" in text


def test_numbers_of_the_symmetric_top(tmp_path):
    text, (disc, earth, exaggerated) = blocks("earths-wobble")
    plate = {'"4 cm"': '"5 mm"', '"0.8 rev/s"': '"0.5 rev/s"'}
    assert f"{scene_of(disc, plate, tmp_path)[1]['wobbles_per_turn']:.3f} times" in text
    equal = scene_of(disc, {'"4 cm"': '"17.320508 cm"'}, tmp_path)[0].inertia.principal_moments
    assert np.ptp(equal) < 1e-8 * equal.max()
    assert scene_of(disc, {'"4 cm"': '"30 cm"'}, tmp_path)[1]["wobbles_per_turn"] < 1
    i1, _, i3 = np.sort(scene_of(disc, {}, tmp_path)[0].inertia.principal_moments)
    assert f"i₃ = {i3 / i1:.2f} i₁, that is {3 * (i3 / i1 - 1):.2f} circles" in text

    a, _, c = scene_of(earth, {}, tmp_path)[0].inertia.principal_moments
    assert f"(i₃ − i₁)/i₃ = {(c - a) / c:.6f}" in text
    assert f"= {a / (c - a):.1f} turns" in text
    # The Earth's mean radius is 6371 km.
    assert round(math.radians(0.3 / 3600) * 6371e3) == 9
    motion, found = scene_of(exaggerated, {}, tmp_path)
    x, _, z = motion.inertia.principal_moments
    assert x / z == pytest.approx(0.9, rel=1e-8)
    assert f"the flattening {(1 - x / z) / ((c - a) / c):.0f} times" in text
    assert f"the angle {10 * 3600 / 0.3:,.0f} times" in text
    assert round(found["period"] / 86164.0905) == 9
    assert "about nine turns" in text


def test_numbers_of_the_gyroscope(tmp_path):
    text, (scene,) = blocks("why-a-gyroscope-stays-up")

    def spun(rate):
        return scene_of(scene, {'"30 rev/s"': f'"{rate} rev/s"'}, tmp_path)[1]

    for rate in (100, 30, 20):
        period = spun(rate)["precession_period"]
        assert re.search(rf"\| \[{rate} turns/s\]\([^|]*\) \| {period:.1f} s \|", text)
    assert f"goes around in {spun(30)['precession_period']:.1f} seconds" in text
    for rate, before in ((15, "from 30.0° to"), (30, "down to"), (5, "sinks to")):
        assert f"{before} {math.degrees(spun(rate)['tilt_max']):.1f}°" in text


# --- malformed lessons

FRONT = "---\ntitle: A lesson\nscene: t-handle\n---\n"
STEP = FRONT + "## A step\n\nText.\n"

MALFORMED = {
    "Text.": "x.md:1: error: a lesson begins with its title and scene",
    "---\nscene: t-handle\n---\n## A\n": "x.md:1: error: the lesson has no title; add a line `title: …`",
    "---\ntitle: A\ncolour: red\n---\n": "x.md:3: error: unknown field `colour: red`; write `title",
    "---\ntitle: A\nscene: t-handel\n---\n": "x.md:3: error: unknown scene `t-handel`; write the name",
    FRONT: "the lesson has no steps; begin each step with a heading `## …`",
    FRONT + "Text.\n": "x.md:5: error: text before the first step",
    "---\ntitle: A\n---\n## A\nText.\n": "x.md:5: error: this step has nothing to show; give `scene: …`",
    STEP + "\n```python\nx\n```\n": "x.md:9: error: a code block is a scene (```toml) or",
    STEP + "\n```ga\na = e1\n```\n": "x.md:9: error: a code block must precede the settings and the text",
    FRONT + "## A\n\n```ga\na = e1\nb = = 2\n```\n": "x.md:9: error: ",
    FRONT + '## A\n\n```toml\n[body\n```\n': "x.md:7: error: ",
    STEP + "\n<!-- do: camra = along L -->\n": "x.md:9: error: unknown setting `camra`; write one of",
    STEP + "\n<!-- do: camera = above -->\n": "x.md:9: error: camera: unknown name `above`; write one of",
    STEP + "\n<!-- do: time = soon -->\n": "x.md:9: error: time: `soon` is not a number; write",
    STEP + "\n<!-- do: show = torques -->\n": "x.md:9: error: show: unknown name `torques`; write one of",
    STEP + "\n<!-- do: play = 2 -->\n": "x.md:9: error: play takes no value, got `2`",
    STEP + "\n<!-- do: -->\n": "x.md:9: error: no settings; write for example",
    STEP + "\n<!-- do: let a = e1 -->\n": "x.md:9: error: `let a` changes a line of formulas, but",
    STEP + "\n<!-- do: initial.spin = [1, -->\n": "x.md:9: error: ",
    STEP + "\n<!-- do: start.spin = 1 -->\n": "x.md:9: error: table: unknown name `start`; write one of body",
    STEP + "\nA\n[b](<#do:zoom = 2>).\n": "x.md:10: error: unknown setting `zoom`",
    STEP + "\n[b](other.md)\n": "x.md:9: error: unknown link `other.md`; write `#do:` and settings",
    STEP + "\n<b>HTML</b>\n": "x.md:9: error: a lesson cannot show this (html)",
    STEP + "\n![a](b.png)\n": "x.md:9: error: a lesson cannot show this (image)",
    STEP + "\n- [ ] one\n- [ ] two\n": "x.md:9: error: a question needs at least two choices",
    STEP + "\n- [x] one\n- [ ] two\n\nSo.\n\n- [x] one\n- [ ] two\n": "x.md:14: error: a second question",
    FRONT + "## A\n\n```ga\na = e1\n```\n\n[b](<#do:let c = e2>)\n": "no line of this step defines `c`",
}  # fmt: skip


def test_malformed_lessons_are_reported_with_file_line_and_remedy(opened):
    page = opened({"format": 1})
    for text, message in MALFORMED.items():
        found = page.page.evaluate(
            f"""async text => {{
                const model = await {VIEWER}.ready;
                model.problem.value = null;
                model.lesson.value = {{ text, name: "x.md" }};
                return model.problem.value;
            }}""",
            text,
        )
        assert found is not None, text
        assert message in found, text
        assert found.startswith("x.md:")
    page.page.get_by_role("alert").wait_for()


def test_scene_of_a_lesson_is_reported_at_its_line(opened):
    page = opened({"format": 1})
    text = (
        FRONT.replace("scene: t-handle\n", "")
        + "\n```toml\n[body]\nmoments = [1, 2, 9]\n[initial]\n[run]\nduration = 1\n```\n## A\n\nText.\n"
    )
    page.page.evaluate(
        f"async text => {{ (await {VIEWER}.ready).lesson.value = {{ text, name: 'x.md' }}; }}", text
    )
    assert "x.md:8:1: error: missing field `spin`" in read(page, "model.problem.value")


# --- files beside a lesson


def test_files_beside_a_lesson_go_with_it(lesson, tmp_path):
    folder = tmp_path / "own"
    folder.mkdir()
    for name in ("t-handle.toml", "t-handle.stl"):
        (folder / name).write_bytes((ROOT / "examples" / name).read_bytes())
    path = folder / "own.md"
    path.write_text('---\ntitle: "Mine: own"\nscene: t-handle.toml\n---\n## A step\n\nText.\n')
    shown = _document.of_file(path)
    assert set(shown["files"]) == {"t-handle.toml", "t-handle.stl"}
    assert _document.title_of(shown) == "Mine: own"
    page = lesson(path)
    assert read(page, "model.problem.value") is None
    assert read(page, "model.about.value.title") == "T-handle in free flight"


def test_lessons_are_served_and_read_again(tmp_path):
    path = tmp_path / "own.md"
    with pytest.raises(UnreadableError, match=r"own\.md"):
        Source(path).document()
    source = Source(path)
    for title in ("One", "Two"):
        path.write_text(FRONT.replace("A lesson", title) + "## A step\n\nText.\n")
        assert f"title: {title}\n" in source.shown()["lesson"]["text"]


def test_lessons_are_shown_in_notebooks():
    pytest.importorskip("anywidget")
    viewer = ph.view(LESSONS[0])
    assert viewer.document["lesson"]["name"] == LESSONS[0].name
    assert viewer.scene is None


def test_a_lesson_that_is_not_utf8(tmp_path):
    path = tmp_path / "latin.md"
    path.write_bytes(b"---\ntitle: caf\xe9\n---\n")
    with pytest.raises(ValueError, match=r"latin\.md: not UTF-8 text: byte 14 is 0xe9; save it as UTF-8"):
        _document.of_file(path)


def test_lessons_are_dropped_on_the_page(opened, tmp_path):
    page = opened({"format": 1})
    page.page.locator("#file").set_input_files(LESSONS[0])
    page.page.locator(f".lesson[data-lesson={LESSONS[0].stem}]").wait_for()


# --- the focus, and what is in view

PHONE = {"viewport": {"width": 390, "height": 740}, "is_mobile": True, "has_touch": True}
# The focused element if it is in view and not under the picture.
READ = f"""() => {{
    const root = {VIEWER}.shadowRoot;
    const at = root.activeElement;
    if (!at) return null;
    const {{ left, top, bottom }} = at.getBoundingClientRect();
    const over = root.elementFromPoint(left + 5, (top + bottom) / 2);
    return top >= 0 && bottom <= innerHeight && at.contains(over) ? at.textContent : null;
}}"""


def awaits_reader(page, text):
    """Wait until the focused element, in view, begins with a text."""
    page.until(f"(({READ})() ?? '').startsWith(begin)", begin=text)


def test_what_is_read_next_has_the_focus_and_is_in_view(opened):
    page = opened({"format": 1}, **PHONE)
    for name, asks in (("book-thrown-three-ways", True), ("cross-products-to-bivectors", False)):
        text = (ROOT / f"examples/lessons/{name}.md").read_text()
        titles = re.findall(r"^## (.*)$", text, re.MULTILINE)
        page.page.locator(f".lessons [data-lesson={name}]").press("Enter")
        awaits_reader(page, titles[0])
        page.page.locator("#lesson-next").press("Enter")
        awaits_reader(page, titles[1])
        if asks:
            page.page.locator(".guess").nth(0).press("Enter")
            awaits_reader(page, "Not so.")
            page.page.locator("#lesson-close").press("Enter")
            awaits_reader(page, re.search(r"^title: (.*)$", text, re.MULTILINE)[1])


def test_a_page_of_a_lesson_leaves_the_focus_when_it_is_loaded(lesson):
    page = lesson(LESSONS[0])
    page.drawn()
    assert page.page.evaluate(f"{VIEWER}.shadowRoot.activeElement") is None


# --- the lesson and the rest of the page


def test_another_scene_closes_the_lesson(lesson):
    page = lesson(LESSONS[0])
    page.page.locator("#scenes").click()
    page.page.locator("[data-scene='toutatis.toml']").click()
    page.page.locator(".lesson").wait_for(state="detached")
    assert read(page, "model.about.value.title") == "4179 Toutatis"
    page.page.locator("#file").set_input_files(LESSONS[0])
    page.page.locator(".lesson").wait_for()
    page.page.locator("#file").set_input_files(ROOT / "examples/gyroscope.toml")
    page.page.locator(".lesson").wait_for(state="detached")
    page.until("model.about.value.top !== null")


def test_captions_of_scenes_do_not_answer_the_questions_of_a_lesson(lesson):
    """That of this lesson's scene says how the ellipsoid moves, which a step asks."""
    page = lesson(ROOT / "examples/lessons/why-l-stays-and-omega-wanders.md")
    assert read(page, "model.about.value.caption").startswith("The inertia ellipsoid rolls")
    assert page.page.locator(".caption").count() == 0


def test_charts_do_not_answer_the_questions_of_a_lesson(lesson):
    page = lesson(ROOT / "examples/lessons/book-thrown-three-ways.md")
    page.page.locator(".strip").wait_for()
    page.page.locator("#lesson-next").click()
    page.page.locator(".strip").wait_for(state="detached")
    page.page.locator(".guess").first.click()
    page.page.locator(".strip").wait_for()


@pytest.mark.parametrize("name", ["why-l-stays-and-omega-wanders", "half-angles"])
def test_phrases_turn_to_the_page_of_their_step(name, lesson):
    page = lesson(ROOT / f"examples/lessons/{name}.md")
    while page.page.locator("a.drive").count() == 0:
        page.page.locator("#lesson-next").click()
    own = read(page, "model.page.value")
    page.page.locator(f"#tab-{'algebra' if own == 'motion' else 'motion'}").click()
    link = page.page.locator("a.drive").first
    text = link.text_content()
    link.press("Enter")
    page.until("model.page.value === own", own=own)
    awaits_reader(page, text)


def test_a_phrase_pressed_before_the_next_frame_gets_the_focus(lesson):
    """The page is rendered before its effects run; those of the turn to the motion come too late."""
    page = lesson(ROOT / "examples/lessons/half-angles.md")
    read(page, "model.page.value")
    text = page.page.evaluate(
        f"""async () => {{
            const root = {VIEWER}.shadowRoot;
            root.querySelector("#tab-motion").click();
            for (let k = 0; k < 1000 && !root.querySelector(".motion"); k++) await Promise.resolve();
            const link = root.querySelector("a.drive");
            link.click();
            return link.textContent;
        }}"""
    )
    page.until("model.page.value === 'algebra'")
    awaits_reader(page, text)


def test_a_lesson_without_a_motion_says_so(lesson):
    page = lesson(ROOT / "examples/lessons/half-angles.md")
    page.page.locator("#tab-motion").click()
    page.page.get_by_text("This step of the lesson has no motion.").wait_for()
    assert page.page.locator("h1").text_content() == "Half angles: rotors by two mirrors"
    assert page.page.locator("#panel-text").count() == 0


def test_the_scene_of_a_lesson_is_folded(lesson):
    page = lesson(LESSONS[0])
    page.page.locator("#panel-text").wait_for(state="attached")
    assert page.page.locator("#panel-text[open]").count() == 0
