"""The reference shows every public name once, with an example that runs."""

import doctest
import importlib
import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import polhode as ph

PAGES = Path(__file__).parents[2] / "docs" / "reference"
MODULES = ("torque", "force", "event", "io")
# The optional libraries that examples of methods need, which take seconds to import.
NEEDED = {
    "Formula.grad": "jax",
    "Multivector.diff": "sympy",
    "Multivector.simplify": "sympy",
    "Multivector.subs": "sympy",
    "Rotor.from_scipy": "scipy",
    "Rotor.to_scipy": "scipy",
}
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def shown(directive):
    """The words after a directive of the pages."""
    found = [
        re.findall(rf"^```{{{directive}}}\s+(.+)$", page.read_text(), re.M) for page in PAGES.glob("*.md")
    ]
    return [word for lines in found for line in lines for word in line.split()]


def public():
    """All public functions and classes by their names."""
    owners = [("", ph, ph.__all__)]
    for module in MODULES:
        owner = importlib.import_module(f"polhode.{module}")
        owners.append((f"{module}.", owner, [name for name in dir(owner) if not name.startswith("_")]))
    named = ((prefix + name, getattr(owner, name)) for prefix, owner, names in owners for name in names)
    return {name: found for name, found in named if inspect.isclass(found) or inspect.isroutine(found)}


def test_every_public_name_is_on_one_page():
    names = shown("api")
    assert len(names) == len(set(names))
    assert set(names) == set(ph.__all__) - set(MODULES)
    assert sorted(shown("api-module")) == sorted(MODULES)


def methods(found):
    """The public methods and properties that a class defines itself, by name."""
    return {name: member for name, member in vars(found).items() if not name.startswith("_")}


def run(name, documented):
    """Run the example in a docstring, and return whether there is one."""
    text = inspect.getdoc(documented) or ""
    example = doctest.DocTestParser().get_doctest(text, {"ph": ph, "np": np}, name, None, 0)
    result = doctest.DocTestRunner(optionflags=FLAGS).run(example)
    assert result.failed == 0, f"the example of {name} fails"
    return bool(example.examples)


@pytest.mark.parametrize("name", public())
def test_every_public_name_has_an_example_that_runs(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert run(name, public()[name]), f"{name} has no example"


@pytest.mark.parametrize("name", [name for name, found in public().items() if inspect.isclass(found)])
def test_examples_of_methods_run(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for method, documented in methods(public()[name]).items():
        if f"{name}.{method}" not in NEEDED:
            run(f"{name}.{method}", documented)


@pytest.mark.slow
@pytest.mark.parametrize("name", NEEDED)
def test_examples_with_other_libraries_run(name, monkeypatch, tmp_path):
    pytest.importorskip(NEEDED[name])
    monkeypatch.chdir(tmp_path)
    owner, method = name.split(".")
    assert run(name, methods(public()[owner])[method]), f"{name} has no example"
