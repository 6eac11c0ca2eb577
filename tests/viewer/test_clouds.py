"""What the page says about the cloud of an ensemble, and how it reads the table of the scene."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from viewer_scenes import FILES, ROOT, RUN, TUMBLING


def tables():
    """Return the texts of all examples, and of all scenes of the guide on scenes."""
    guide = (ROOT / "docs/scenes.md").read_text()
    blocks = re.findall(r"^```toml *\n(.*?)^```", guide, re.MULTILINE | re.DOTALL)
    return [path.read_text() for path in FILES.values()] + [text for text in blocks if "[ensemble]" in text]


ODD = (
    """
[ensemble]  # a comment
number = 1_000
'a b'."c.d" = [1, # one
  "two # three", ]
torque.magnetic = { dipole = { normal = [1e-3, +2.5, -0.5] } }
text = """
    + '"""many\nlines"""'
    + """
keep = ["last"]
[ensemble.torque.damping]
relative = 0.1
[run]
number = 2
"""
)


@pytest.mark.parametrize("text", [*tables(), ODD])
def test_tables_are_those_of_toml(text, core):
    expected = tomllib.loads(text).get("ensemble")
    assert core.ask("table", text=text, name="ensemble") == json.loads(json.dumps(expected))


def cloud(core, table, number=1000, held=False, omega=(0.1, 1, 0.2)):
    scene = f"{TUMBLING}{RUN}[ensemble]\n{table}\n"
    return core.ask("cloud", scene=scene, ensemble=number, held=held, omega=list(omega))


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('attitude = "uniform"', "with attitude uniform over all attitudes (seed 0)"),
        ('seed = 7\nspin = { normal = "1 deg/s" }', "with spin normal with a deviation of 1 deg/s (seed 7)"),
        ("velocity = { uniform = [1, 2, 0] }", "with velocity uniform within ±(1, 2, 0)"),
        ("torque.damping = { relative = 0.3 }", "torque.damping times a log-normal factor of width 0.3"),
        ('spin = { direction = "uniform" }', "with spin in a uniform direction"),
        ("grid.body.moments = [[3, 2, 1], [3, 2.5, 1]]", "on the grid of body.moments (2) values"),
        (
            'grid.initial.time = { from = 0, to = 1, number = 5 }\ngrid."body.moments[0]" = [1, 2]',
            "on the grid of initial.time (5) × body.moments[0] (2) values",
        ),
        ('table = "bodies.csv"', "one for each row of bodies.csv"),
        (
            'covariance = { of = ["spin", "attitude"], matrix = [] }',
            "with spin and attitude drawn together from a normal distribution with a covariance matrix",
        ),
    ],
)
def test_sentence_says_how_the_bodies_differ(table, said, core):
    assert said in cloud(core, table)


def test_sentence_says_what_is_drawn(core):
    uniform = 'attitude = "uniform"'
    assert cloud(core, uniform, number=20).startswith("20 bodies, ")
    assert cloud(core, uniform, number=100_000).startswith("The first 1,000 of 100,000 bodies, ")
    assert "the direction of its axis f₂" in cloud(core, uniform)
    assert "from the fixed point to its centre of mass" in cloud(core, uniform, held=True)
    assert "The colour is the same for all" in cloud(core, uniform)


def test_facts_say_what_the_cloud_is(opened):
    text = Path(FILES["toutatis-uncertain"]).read_text().replace("100_000", "20")
    page = opened({"format": 1, "scene": text, "name": "few.toml"})
    page.page.locator("#panel-motion").evaluate("panel => panel.open = true")
    said = page.page.locator("#cloud").inner_text()
    assert said.startswith("20 bodies, with attitude normal with a deviation of 1 deg, spin normal")
