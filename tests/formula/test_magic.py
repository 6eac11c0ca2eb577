"""``%ga`` and ``%%ga``, in a shell of IPython."""

import numpy as np
import pytest

import polhode as ph

interactiveshell = pytest.importorskip("IPython.core.interactiveshell")


@pytest.fixture(scope="module")
def only_shell():
    shell = interactiveshell.InteractiveShell.instance()
    yield shell
    interactiveshell.InteractiveShell.clear_instance()


@pytest.fixture
def shell(only_shell):
    only_shell.reset(new_session=False)
    run(only_shell, "%reload_ext polhode")
    return only_shell


def run(shell, cell):
    result = shell.run_cell(cell)
    result.raise_error()
    return result.result


def test_a_line_is_a_formula(shell):
    shell.user_ns |= {"a": ph.e1, "b": ph.e1 + 2 * ph.e2}
    assert run(shell, "%ga a∧b") == 2 * (ph.e1 ^ ph.e2)
    assert not run(shell, "%ga ab == ba")
    assert run(shell, "B = %ga a b") is None
    assert run(shell, "B.grades") == (0, 2)


def test_a_cell_assigns_and_displays_its_last_value(shell):
    result = run(shell, "%%ga\nθ = 90 deg  # units\nR = exp(-θ/2 e1∧e2)\n\nR e1 ~R\nx' = 3 e1")
    assert result.is_close(ph.e2)
    assert result._repr_latex_().startswith("$")
    assert isinstance(shell.user_ns["R"], ph.Rotor)
    assert float(shell.user_ns["θ"]) == np.pi / 2
    assert run(shell, "θ + 1").grades == (0,)
    # Names that Python cannot spell are kept beside the others.
    assert run(shell, "%ga x' x'") == 9


def test_functions_and_the_last_value_stay(shell):
    assert run(shell, "%%ga\nV(x) = ½ x·x\nV(2 e1)") == 2
    assert run(shell, "%ga V(4 e1) + _") == 10


def test_values_of_the_notebook_of_every_kind(shell):
    rows = np.arange(6.0).reshape(2, 3)
    shell.user_ns |= {
        "many": ph.vector(rows),
        "weights": np.array([2, 3]),
        "inertia": ph.Inertia.from_principal_moments(1, 2, 3),
        "F": ph.LinearMap.from_matrix(2 * np.eye(3)),
        "n": 2,
        "text": "no value",
        "module": np,
        "e": np.e,
    }
    assert run(shell, "%ga weights many").shape == (2,)
    assert run(shell, "%ga inertia(n e12) + F(e23)") == 6 * (ph.e1 ^ ph.e2) + 4 * (ph.e2 ^ ph.e3)
    with pytest.raises(ValueError, match="`text` has no value as one name"):
        run(shell, "%ga text e1")


def test_spellings_of_one_name(shell):
    """a₁, a_1 and a1 are one name in formulas, and two in Python."""
    run(shell, "a_1 = 2\na2 = 3")
    assert run(shell, "%ga a₁ + a_2") == 5
    run(shell, "%ga a₁ = 7")
    assert run(shell, "float(a_1)") == 7.0
    assert "a1" not in shell.user_ns


def test_values_of_other_algebras_do_not_disturb(shell):
    pga = ph.algebra(3, 0, 1)
    x, *_, null = pga.basis_vectors
    shell.user_ns |= {"P": null, "Q": x, "a": ph.e1, "exponent": pga.scalar(1)}
    assert run(shell, "%ga a a + exp(0)") == 2
    assert run(shell, "%ga P∧Q").algebra is pga


def test_symbols(shell):
    sympy = pytest.importorskip("sympy")
    shell.user_ns |= {"t": sympy.Symbol("t", real=True)}
    assert run(shell, "%ga (t e1)²").components[0] == shell.user_ns["t"] ** 2


MISTAKES = {
    "%ga a + q": "%ga:1:5: error: `q` has no value; names with values: a\n  |\n1 | a + q\n  |     ^",
    "%%ga\na\n(a": "%ga:3:1: error: `(` is never closed\n  |\n3 | (a\n  | ^",
    "%ga m = 3 m": "%ga:1:7: error: `m` is a unit and a name here",
    "%ga b = a == a": "%ga:1:5: error: an equation is not a value",
    "%ga log(a - a)": "%ga:1:1: error: no logarithm",
}


@pytest.mark.parametrize("cell", MISTAKES)
def test_mistakes_are_shown_without_a_traceback(cell, shell, capsys):
    shell.user_ns |= {"a": ph.e1}
    if "3 m" in cell:
        shell.user_ns["m"] = 2.0
    result = shell.run_cell(cell)
    assert isinstance(result.error_in_exec, ValueError)
    shown = capsys.readouterr().out
    assert MISTAKES[cell] in shown
    assert "Traceback" not in shown
    assert "session.py" not in shown
    assert "b" not in shell.user_ns


def test_lines_before_an_error_take_effect(shell):
    result = shell.run_cell("%%ga\nc = 2 e1\nd = q")
    assert not result.success
    assert shell.user_ns["c"] == 2 * ph.e1
    assert "d" not in shell.user_ns


def test_empty_cells(shell):
    assert run(shell, "%ga") is None
    assert run(shell, "%%ga\n# a comment\n") is None
