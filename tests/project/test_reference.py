"""The reference shows every public name once, with an example that runs."""

import doctest
import inspect
import operator
import re
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from public_names import MODULES, methods, public

PAGES = Path(__file__).parents[2] / "docs" / "reference"
# The optional libraries that examples of methods need, which take seconds to import.
NEEDED = {
    "Fit.plot": "matplotlib",
    "Formula.grad": "jax",
    "Multivector.diff": "sympy",
    "Multivector.simplify": "sympy",
    "Multivector.subs": "sympy",
    "ReducedEnsemble.to_xarray": "xarray",
    "RigidTransform.from_scipy": "scipy",
    "RigidTransform.to_scipy": "scipy",
    "Rotor.from_numpy_quaternion": "quaternion",
    "Rotor.from_scipy": "scipy",
    "Rotor.to_numpy_quaternion": "quaternion",
    "Rotor.to_scipy": "scipy",
    "Trajectory.plot": "matplotlib",
}
# Methods without an example: they need a notebook or a browser, or only raise an error.
CLOSED = ("DampedTop", "FreeMotion", "LagrangeTop", "LarmorSphere")
WITHOUT = {
    "Inertia.identity",
    "Scene.view",
    "Trajectory.film",
    "Trajectory.view",
    *(f"{name}.view" for name in CLOSED),
}
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def shown(directive):
    """The words after a directive of the pages."""
    found = [
        re.findall(rf"^```{{{directive}}}\s+(.+)$", page.read_text(), re.M) for page in PAGES.glob("*.md")
    ]
    return [word for lines in found for line in lines for word in line.split()]


def test_every_public_name_is_on_one_page():
    names = shown("api")
    assert len(names) == len(set(names))
    assert set(names) == set(ph.__all__) - set(MODULES)
    assert sorted(shown("api-module")) == sorted(MODULES)


def test_modules_of_the_crates_exist():
    page = (PAGES / "rust.md").read_text()
    linked = re.findall(r"docs\.rs/polhode-(\w+)/latest/polhode_\1/(\w+)/", page)
    assert len(linked) > 8
    for crate, module in linked:
        source = (PAGES.parents[1] / f"crates/{crate}/src/lib.rs").read_text()
        assert f"pub mod {module};" in source, module
    series = ph.__version__.rpartition(".")[0]
    assert re.findall(r'^polhode-\w+ = "(.*)"$', page, re.M) == [series, series]


def is_method(member):
    return inspect.isroutine(member) or isinstance(member, classmethod | staticmethod)


def run(name, documented):
    """Run the example in a docstring, and return whether there is one."""
    text = inspect.getdoc(documented) or ""
    example = doctest.DocTestParser().get_doctest(text, {"ph": ph, "np": np}, name, None, 0)
    result = doctest.DocTestRunner(optionflags=FLAGS).run(example)
    assert result.failed == 0, f"the example of {name} fails"
    return bool(example.examples)


def test_the_package_has_an_overview_whose_example_runs_and_whose_names_exist():
    assert run("polhode", ph)
    names = re.findall(r"`([\w.]+)`", re.sub(r"``.*?``", "", ph.__doc__))
    assert len(names) > 30
    for name in names:
        assert operator.attrgetter(name)(ph) is not None


@pytest.mark.parametrize("name", public())
def test_every_public_name_has_an_example_that_runs(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert run(name, public()[name]), f"{name} has no example"


@pytest.mark.parametrize("name", [name for name, found in public().items() if inspect.isclass(found)])
def test_every_method_has_an_example_that_runs(name, monkeypatch, tmp_path):
    """Those of properties run too; a property needs none."""
    monkeypatch.chdir(tmp_path)
    without = set()
    for method, documented in methods(public()[name]).items():
        whole = f"{name}.{method}"
        if whole not in NEEDED and not run(whole, documented) and is_method(documented):
            without.add(whole)
    assert without == {whole for whole in WITHOUT if whole.startswith(f"{name}.")}


@pytest.mark.slow
@pytest.mark.parametrize("name", NEEDED)
def test_examples_with_other_libraries_run(name, monkeypatch, tmp_path):
    pytest.importorskip(NEEDED[name])
    monkeypatch.chdir(tmp_path)
    owner, method = name.split(".")
    assert run(name, methods(public()[owner])[method]), f"{name} has no example"
