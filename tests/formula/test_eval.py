"""``polhode eval``: output, sources of formulas, and every kind of error message."""

import json
import os
import sys

import numpy as np
import pytest

import processes
from command_line import POLHODE, polhode


def evaluate(*arguments, **options):
    return polhode("eval", *arguments, **options)


def printed(*arguments, **options):
    done = evaluate(*arguments, **options)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.splitlines()


def complaint(*arguments, code=3, **options):
    done = evaluate(*arguments, **options)
    assert done.returncode == code
    assert done.stdout == ""
    return done.stderr


# --- values


def test_the_example_of_the_requirements():
    assert printed("exp(-θ/2 e1∧e2) e1", "--let", "θ=90deg") == ["0.70710678 e1 + 0.70710678 e2"]


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("e1 e2", "e1∧e2"),
        ("-I e1∧e2", "e3"),
        ("-I e1^e2", "e3"),
        ("-e1∧e2", "-e1∧e2"),  # not an option
        ("-2", "-2"),
        ("½ π", "1.5707963"),
        ("2e1 + 1e-1", "0.1 + 2 e1"),
        ("⟨(e1+e2) e1⟩_2", "-e1∧e2"),
        ("  e1  # comments are not allowed in arguments", None),
    ],
)
def test_values_print_as_on_paper(formula, value):
    if value is None:
        assert "`#` has no meaning" in complaint(formula)
    else:
        assert printed(formula) == [value]


def test_one_result_a_line_in_the_order_given():
    assert printed("e1", "e2", "e1 == e1") == ["e1", "e2", "true, residual 0 of terms of size 1"]


def test_names_are_given_in_order_and_in_any_spelling():
    lets = ["--let", "a∥=e1", "--let", "R'=2 a_∥", "--let", "x_1 = R′", "--let", "ω=5 rev/s"]
    assert printed("a∥", "R'", "x₁", "ω", *lets) == ["e1", "2 e1", "2 e1", "31.415927"]


def test_functions_are_defined():
    lets = ["--let", "V(x)=½ x·x", "--let", "W(a, b)=V(a) - V(b)"]
    assert printed("V(3e1)", "W(2e1, e2)", *lets) == ["4.5", "1.5"]


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("90deg", np.pi / 2),
        ("-90 deg", -np.pi / 2),
        ("90°", np.pi / 2),
        ("5 rev/s", 10 * np.pi),
        ("7.85 g/cm^3", 7850.0),
        ("12 deg/s", np.pi / 15),
        ("3 kg·m²", 3.0),
        ("2 min", 120.0),
        ("1e3 m", None),
        ("17", 17.0),
        ("1e-3", 0.001),
        ("1E3", 1000.0),
        ("1e3", None),
        ("cos(60deg) + 2 m", 2.5),
        ("(1/2) 2 s", 1.0),
    ],
)
def test_quantities_become_si(value, expected):
    if expected is None:
        assert "`1e3` has two readings; write `1e+3` for the number" in complaint("x", "--let", f"x={value}")
        return
    (result,) = json.loads(evaluate("x", "--let", f"x={value}", "--json").stdout)
    # A unit's factor and the cosine round once each.
    np.testing.assert_allclose(result["components"], [expected], rtol=4 * np.finfo(float).eps)


@pytest.mark.parametrize("value", ["5 rev/s e1∧e2", "5rev/s e1e2", "10 π e12", "e1∧(5 rev/s e2)"])
def test_quantities_stand_within_formulas(value):
    assert printed("Ω", "--let", f"Ω={value}") == ["31.415927 e1∧e2"]


def test_units_are_names_in_formulas():
    assert printed("3 m", "g m s", "--let", "m=2 kg", "--let", "g=e1", "--let", "s=e1") == ["6", "2"]
    error = complaint("3 m", "exp(-45deg/2 e1e2)")
    assert "`m` has no value; no names have values here. Units are read where a name gets a value" in error
    assert "as in `x = 2 deg`\n" in error


# --- equations


def test_equations_are_true_or_false():
    done = evaluate("a∧b + b∧a = 0", "a b = b a", "a a = a·a", "--let", "a=e1", "--let", "b=e1+3e2")
    assert done.returncode == 1
    assert done.stderr == ""
    true, false, again = done.stdout.splitlines()
    assert true.startswith("true, residual 0 of terms of size ")
    assert false.startswith("false, residual 6 of terms of size ")
    assert again == "true, residual 0 of terms of size 1"


def test_the_residual_is_relative_to_the_terms():
    """The sine of a float near π is not 0, but small beside the rotor."""
    (line,) = printed("R e1 ~R = -1e-9 e1 + 1e-9 e1 + e1", "--let", "R=exp(-180deg e1e2)")
    assert line.startswith("true, residual ")
    done = evaluate("R e1 ~R = 1.00001 e1", "--let", "R=exp(-180deg e1e2)")
    assert (done.returncode, done.stdout) == (1, "false, residual 1e-05 of terms of size 1\n")


# --- JSON and LaTeX


def test_json_is_one_strict_document():
    done = evaluate("a b", "a·b = b·a", "a b = 0", "--let", "a=e1", "--let", "b=e1 + 0.1 e2", "--json")
    assert done.returncode == 1
    value, true, false = json.loads(done.stdout, parse_constant=pytest.fail)
    assert value["formula"] == "a b"
    assert value["grades"] == [0, 2]
    assert value["components"] == [1.0, 0.0, 0.0, 0.1]
    assert value["repr"] == "1 + 0.1 e1∧e2"
    assert (true["holds"], true["residual"]) == (True, 0.0)
    assert (false["holds"], false["size"] > 0) == (False, True)
    assert {"text", "ascii", "latex"} < set(value) & set(true)


def test_json_has_errors_with_places():
    done = evaluate("e1", "e1 +", "e2", "--json")
    assert (done.returncode, done.stderr) == (3, "")
    first, second, third = json.loads(done.stdout)
    assert (first["repr"], third["repr"]) == ("e1", "e2")
    assert second["formula"] == "e1 +"
    assert second["error"].startswith("formula 2:1:5: error: the formula ends where")


@pytest.mark.parametrize("formula", ["x x", "x x - x x", "x e1 + 1", "exp(x e1)", "x x = 1"])
def test_overflow_is_an_error_and_json_stays_valid(formula):
    done = evaluate(formula, "e1", "--let", "x=1e+200", "--json")
    assert done.returncode in (0, 3)
    for record in json.loads(done.stdout, parse_constant=pytest.fail):
        assert ("error" in record) == (done.returncode == 3 and record["formula"] == formula)
    text = evaluate(formula, "--let", "x=1e+200")
    assert text.returncode == done.returncode
    assert "inf" not in text.stdout
    assert "nan" not in text.stdout


def test_latex_has_the_formula_and_its_value():
    formula, equation = printed("-I a∧b", "a a = 1", "--let", "a=e1", "--let", "b=e2", "--latex")
    assert formula == r"-I\,a{\wedge}b = e_{3}"
    assert equation.startswith("a a = 1 % true")


# --- files and standard input

LINES = """\
# Turning a vector.
let θ = 90 deg     # units are read here

let R = exp(-θ/2 e1∧e2)
R e1 ~R
~R R = 1
"""
TOLD = ["e2", "true, residual"]


def check_lines(lines):
    assert len(lines) == 2
    assert lines[0].endswith("e2")
    assert lines[1].startswith("true, residual")


def test_a_file_has_one_formula_a_line(tmp_path):
    (tmp_path / "turn.ga").write_text(LINES, encoding="utf-8")
    check_lines(printed("-f", tmp_path / "turn.ga"))
    # Formulas that are arguments come after those of the file, and know its names.
    *lines, last = printed("-f", tmp_path / "turn.ga", "θ")
    check_lines(lines)
    assert last == "1.5707963"


@pytest.mark.parametrize("arguments", [[], ["-f", "-"]])
@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
def test_standard_input_has_one_formula_a_line(arguments, line_end):
    check_lines(printed(*arguments, input="\ufeff" + LINES.replace("\n", line_end)))


def test_lines_are_answered_as_they_arrive():
    with processes.start([POLHODE, "eval"], stdin=processes.PIPE, stderr=None) as process:
        process.stdin.write("e1 e2\n")
        process.stdin.flush()
        assert process.stdout.readline() == "e1∧e2\n"
        process.stdin.close()
        assert process.wait() == 0


def test_all_lines_are_evaluated_and_errors_have_places():
    done = evaluate(input="e1\ne1 + q\n\nlet = 3\n  e2 e2)\ne3\n")
    assert done.returncode == 3
    assert done.stdout.splitlines() == ["e1", "e3"]
    assert done.stderr == (
        "<stdin>:2:6: error: `q` has no value; no names have values here\n"
        "  |\n2 | e1 + q\n  |      ^\n"
        "<stdin>:4:5: error: `` is not a name; names are letters with subscripts and primes, "
        "`Ω_B`, `R'`, or words\n"
        "  |\n4 | let = 3\n  |     ^\n"
        "<stdin>:5:6: error: `)` closes no bracket\n"
        "  |\n5 | e2 e2)\n  |      ^\n"
    )


# --- errors


MISTAKES = {
    "unknown name": ("a + q", "formula:1:5: error: `q` has no value; names with values: a, b\n"),
    "a word": ("omega", "formula:1:1: error: `omega` has no value as one name; read as adjacent letters"),
    "unbalanced bracket": ("(a + b", "formula:1:1: error: "),
    "bracket too many": ("a + b)", "formula:1:6: error: `)` closes no bracket"),
    "wrong grade": ("cross(a∧b, b)", "formula:1:7: error: "),
    "ambiguous chain": ("a·b∧a", "ambiguous without brackets: `(a·b)∧a` or `a·(b∧a)`"),
    "a number between": ("b∧2a", "ambiguous without brackets: `(b∧2) a` or `b∧(2 a)`"),
    "a command of LaTeX": (
        r"a \wedge b",
        r"formula:1:3: error: `\wedge` has no meaning in a formula; write `∧`",
    ),
    "a division": ("a/2b", "formula:1:1: error: ambiguous divisor; write"),
    "deep nesting": (
        "(" * 150 + "a" + ")" * 150,
        "formula:1:101: error: more than 100 nested levels",
    ),
    "20,000 factors": ("a" * 20_000, "has more than 10000 names, numbers and signs; define its parts first"),
    "no blade": ("e4", "`e4` is not a basis element; the basis vectors are e1 to e3"),
    "nothing": ("", "formula:1:1: error: the formula is empty"),
    "a stray sign": ("a $ b", "formula:1:3: error: `$`"),
    "log of 0": ("log(a - a)", "formula:1:"),
    "no inverse": ("a/(a-a)", "formula:1:"),
    "overflow": ("1e+200*1e+200 a", "formula:1:1: error: "),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_error_messages(name):
    formula, expected = MISTAKES[name]
    error = complaint(formula, "--let", "a=e1", "--let", "b=e2")
    assert expected in error
    place, source, line, caret = error.splitlines()
    assert ": error: " in place
    assert (source.strip(), line[:4].strip()) == ("|", "1 |")
    assert set(caret.strip(" |")) == {"^"}
    assert max(map(len, error.splitlines())) < 300


WRONG_LETS = {
    "no name": ("2x=e1", "--let:1:1: error: `2x` is not a name; names are letters"),
    "built in": ("a b=e1", "--let:1:1: error: `a b` is not a name"),
    "an equation": (
        "x=e1=e1",
        "--let:1:3: error: an equation is not a value that a name can have",
    ),
    "unknown": ("x=2 q", "--let:1:5: error: `q` has no value"),
    "components": ("x=1,2,3", "--let:1:4: error: commas are allowed only between arguments"),
    "later name": ("x=y", "--let:1:3: error: `y` has no value"),
    "unknown unit": ("x=5 degs", ". Did you mean the unit `deg`?"),
    "a unit in words": ("x=2 revolutions", ". Did you mean the unit `rev`?"),
    "a unit after no number": (
        "x=½ deg + 1",
        ". The unit `deg` stands right after a number, as in `0.5 deg`",
    ),
    "broken unit": (
        "x=5 m^12",
        "--let:1:5: error: a power must be a whole number from -9 to 9 and not 0 after the unit `m`",
    ),
    "a divided unit": ("x=1/2 deg", "--let:1:5: error: `/` before a quantity has two readings; put brackets"),
    "beyond floats": ("x=1e+400 m", "--let:1:3: error: `1e+400 m` is beyond the range"),
    "no body": ("f(x)=x +", "--let:1:9: error: the formula ends where"),
    "a parameter twice": ("f(x,x)=x", "--let:1:1: error: expected a name, `c`, or a function"),
    "recursion": ("f(x)=1 + f(x)", "--let:1:6: error: `f` would call itself; formulas have no recursion"),
    "unknown in a body": ("f(x)=c x", "--let:1:6: error: `c` has no value"),
}


@pytest.mark.parametrize("name", WRONG_LETS)
def test_invalid_assignments_have_places(name):
    let, expected = WRONG_LETS[name]
    # The formula does not need the name.
    done = evaluate("1", "--let", let)
    assert (done.returncode, done.stdout) == (3, "1\n")
    assert expected in done.stderr
    assert f"1 | {let}\n" in done.stderr


def test_a_unit_that_is_also_a_name_is_refused():
    error = complaint("p", "--let", "m=2 kg", "--let", "p=3 m")
    assert error.startswith("--let:1:5: error: `m` is a unit and a name here; for the name write `3*m`\n")
    assert "formula:1:1: error: `p` has no value; names with values: m" in error


@pytest.mark.parametrize(
    "arguments",
    [["--let", "x"], ["--let", "=3"], ["--let", "x="], ["e1", "--fast"], ["--json", "--latex", "e1"]],
)
def test_wrong_usage_is_2(arguments):
    assert "usage: polhode" in complaint(*arguments, code=2)


def test_files_that_cannot_be_read(tmp_path):
    assert complaint("-f", "absent.ga", cwd=tmp_path) == "absent.ga: error: no such file or directory\n"
    assert "is a directory" in complaint("-f", tmp_path)
    assert complaint(input="") == "<stdin>: error: no formula found; write one on each line\n"
    (tmp_path / "empty.ga").write_text("\n# nothing\n")
    assert (
        complaint("-f", "empty.ga", cwd=tmp_path)
        == "empty.ga: error: no formula found; write one on each line\n"
    )


@pytest.mark.parametrize(("command", "code"), [("eval", 3), ("repl", 1)])
def test_a_closed_standard_input(command, code):
    done = processes.run(["bash", "-c", f"'{POLHODE}' {command} <&-"])
    assert done.returncode == code
    assert done.stderr.endswith("error: standard input is closed\n")


def test_bytes_that_are_not_utf_8_have_places(tmp_path):
    (tmp_path / "latin.ga").write_bytes("e1\nn = café\ne2\n".encode("latin-1"))
    done = evaluate("-f", "latin.ga", cwd=tmp_path)
    assert done.returncode == 3
    assert done.stdout.splitlines() == ["e1", "e2"]
    assert "latin.ga:2:8: error: not UTF-8\n" in done.stderr
    error = complaint(b"e1 + \xff")
    assert error.startswith("formula:1:6: error: not UTF-8\n")
    assert complaint("x", "--let", b"x=\xff").startswith("--let:1:3: error: not UTF-8\n")
    (tmp_path / os.fsdecode(b"\xff.ga")).write_text("q")
    assert complaint("-f", b"\xff.ga", cwd=tmp_path).startswith("?.ga:1:1: error: `q` has no value")


def test_endless_lines_are_refused():
    with open("/dev/zero", "rb") as zeros:
        done = evaluate(stdin=zeros)
    assert done.returncode == 3
    assert "longer than 100000 bytes" in done.stderr


# --- pipes


def test_a_reader_that_leaves_early():
    command = f"yes e1 | head -100000 | '{POLHODE}' eval | head -1"
    done = processes.run(command, shell=True)
    assert (done.stdout, done.stderr) == ("e1\n", "")


def test_a_closed_output():
    with open("/dev/full", "wb") as stdout:
        done = evaluate("e1", stdout=stdout)
    assert done.returncode == 1
    assert "error: no space left" in done.stderr


def test_any_terminal_encoding_gets_an_answer():
    done = evaluate("e1∧e2", encoding="ascii", env={"PYTHONIOENCODING": "ascii"})
    assert (done.returncode, done.stdout) == (0, "e1?e2\n")


def test_eval_imports_little():
    """``eval`` imports neither mechanics nor SciPy."""
    code = (
        "import sys; from polhode._cli.main import main; main(['eval', 'e1']); "
        "print([m for m in sys.modules if m.startswith(('scipy', 'polhode._mechanics.simulate', 'rich'))])"
    )
    done = processes.run([sys.executable, "-c", code], check=True)
    assert done.stdout.splitlines() == ["e1", "[]"]
