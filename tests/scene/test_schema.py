"""The JSON Schema of scenes: examples validate, every law is in it, and it agrees with the core."""

import json
import re
import tomllib

import pytest

import polhode as ph
from command_line import EXAMPLES, ROOT, polhode
from polhode._mechanics.registry import FORCES, TORQUES
from polhode._scene.schema import _SIZES as SIZES
from polhode._scene.schema import scene_schema

jsonschema = pytest.importorskip("jsonschema")
SCHEMA = scene_schema()
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)
SCENES = [path.read_text() for path in sorted(EXAMPLES.glob("*.toml"))]
SCENES += re.findall(r"```toml\n(.*?)```", (ROOT / "docs/scenes.md").read_text(), flags=re.DOTALL)
BASE = """
[body]
moments = [1, 2, 3]
mass = 1
[initial]
spin = { vector = [0.1, 1, 0.1] }
[run]
duration = 1
"""


def errors_of(text):
    return [error.message for error in VALIDATOR.iter_errors(tomllib.loads(text))]


def test_the_schema_is_valid_and_printed_by_the_command():
    jsonschema.Draft7Validator.check_schema(SCHEMA)
    done = polhode("schema")
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout) == SCHEMA


@pytest.mark.parametrize("text", SCENES, ids=lambda text: text.strip().splitlines()[0][:25])
def test_scenes_validate(text):
    assert errors_of(text) == []


def test_every_law_of_the_registry_is_in_it():
    tables = SCHEMA["properties"]
    assert set(tables["torque"]["properties"]) == {*TORQUES, "torque_body", "torque_space"}
    assert set(tables["force"]["properties"]) == set(FORCES)
    for name, laws in (("torque", TORQUES), ("force", FORCES)):
        for law in laws.values():
            fields = {x.field for x in law.arguments} - {""}
            found = tables[name]["properties"][law.name].get("properties", {})
            assert fields <= set(found), law.name


def listed(text, tmp_path, what="field"):
    """The fields or solids that the core expects where it meets `nonsense`."""
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(ph.SceneError) as caught:
        ph.Scene.read(tmp_path / "a.toml")
    line = next(x for x in str(caught.value).splitlines() if f"unknown {what} `nonsense`" in x)
    return set(re.findall(r"`(\w+)`", line)) - {"nonsense"}


@pytest.mark.parametrize("table", ["", "initial", "run", "method", "torque", "force", "gravity"])
def test_fields_of_tables_are_those_of_the_core(table, tmp_path):
    text = BASE if not table or f"[{table}]" in BASE else f"{BASE}[{table}]\n"
    wrong = text.replace(f"[{table}]", f"[{table}]\nnonsense = 1") if table else f"nonsense = 1\n{text}"
    schema = SCHEMA["properties"][table] if table else SCHEMA
    assert listed(wrong, tmp_path) == set(schema["properties"])
    assert errors_of(wrong) != []


def test_solids_are_those_of_the_core(tmp_path):
    solids = listed(BASE.replace("moments = [1, 2, 3]", 'solid = "nonsense"'), tmp_path, "solid")
    assert solids == set(SIZES)
    for name in solids:
        assert callable(getattr(ph.Body, name))


LAWS = [(table, law) for table, laws in (("torque", TORQUES), ("force", FORCES)) for law in laws]


@pytest.mark.parametrize(("table", "law"), LAWS)
def test_arguments_of_laws_are_those_of_the_core(table, law, tmp_path):
    schema = SCHEMA["properties"][table]["properties"][law]
    wrong = f"{BASE}[{table}]\n{law} = {{ nonsense = 1 }}\n"
    assert errors_of(wrong) != []
    if "properties" in schema:
        assert listed(wrong, tmp_path) == set(schema["properties"])


@pytest.mark.parametrize(
    "change",
    [
        ("moments = [1, 2, 3]", "moments = [1, 2]"),
        ("moments = [1, 2, 3]", 'solid = "cube"'),
        ("duration = 1", "duration = 1\nmethod = 'magic'"),
        ("[run]", "[torque]\ndamping = true\n[run]"),
        ("[run]", "[torque]\nmagnetic = { dipole = [0, 0, 1] }\n[run]"),
        ("[run]", "[torque]\nfriction = 1\n[run]"),
        ("spin = { vector = [0.1, 1, 0.1] }", "attitude = { quaternion = [1, 0, 0, 0] }"),
    ],
)
def test_mistakes_are_found_by_the_schema_and_by_the_core(change, tmp_path):
    text = BASE.replace(*change)
    assert text != BASE
    assert errors_of(text) != []
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(ph.SceneError):
        ph.Scene.read(tmp_path / "a.toml")


def test_a_period_may_stand_for_a_rate():
    law = "[torque]\ngravity_gradient = {{ {} }}\n"
    assert errors_of(BASE + law.format('period = "95 min"')) == []
    assert errors_of(BASE + law.format("rate = 0.001, eccentricity = 0.1")) == []
