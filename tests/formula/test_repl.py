"""``polhode repl``: answers, typed or piped; history and completion."""

import contextlib
import os
import pty
import sys
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

import processes
from command_line import POLHODE, polhode
from polhode._formula.shell.repl import Prompt, _history_path, _keep
from polhode._formula.shell.session import FUNCTIONS, LineError


@pytest.fixture
def prompt():
    return Prompt()


def answers(prompt, *lines):
    return [prompt.answer(line) for line in lines]


# --- lines


def test_names_get_values_and_formulas_print_theirs(prompt):
    assert answers(prompt, "a = e1", "b = 2a + e2", "a∧b", "a^b", "ab") == [
        "", "", "e1∧e2", "e1∧e2", "2 + e1∧e2",
    ]  # fmt: skip


def test_a_name_whose_letters_have_values_is_remarked(prompt):
    note = "`aB` is now one name, not the product `a B`; `a B == …` compares"
    lines = ("a = e1", "B = e12", "aB = a·B + a∧B", "aB = a", "ab = 2", "let Ba = a", "a1 = a")
    assert answers(prompt, *lines) == ["", "", note, "", "", "", ""]
    assert answers(prompt, "aB", "a B == a·B + a∧B")[0] == "e1"


def test_equations_compare(prompt):
    prompt.answer("a = e1 + e2")
    assert prompt.answer("a a == 2") == "true, residual 0 of terms of size 2"
    # The left side is not a name: nothing is assigned.
    assert prompt.answer("a a = 3") == "false, residual 1 of terms of size 3"
    assert prompt.answer("a == e1 + e2").startswith("true")


def test_functions_are_defined_and_redefined(prompt):
    assert answers(prompt, "c = 2", "f(x) = c x", "g(x, y) = f(x) + f(y)", "g(e1, e2)") == [
        "", "", "", "2 e1 + 2 e2",
    ]  # fmt: skip
    assert answers(prompt, "c = 3", "f(e1)", "f(x) = x x", "g(e1, 2)") == ["", "3 e1", "", "5"]
    with pytest.raises(LineError, match="`f` would call itself; formulas have no recursion"):
        prompt.answer("f(x) = f(x) + 1")
    assert prompt.answer("f(2e1)") == "4"
    # A name is a value or a function, whichever came last.
    assert answers(prompt, "h(x) = x", "h = e3", "h", "h(x) = 2x", "h(e1)") == ["", "", "e3", "", "2 e1"]


def test_let_assigns_as_in_files_of_formulas(prompt):
    assert answers(prompt, "let a = 2 e1", "let f(x) = x x", "f(a)", "let θ = 180 deg", "cos(θ)") == [
        "", "", "4", "", "-1",
    ]  # fmt: skip
    with pytest.raises(LineError):
        prompt.answer("let a")


def test_words_of_other_prompts(prompt):
    assert prompt.answer("help") == prompt.answer("help()") == prompt.answer(":help")
    for word in ("exit", "quit", "quit()"):
        with pytest.raises(EOFError):
            prompt.answer(word)
    assert answers(prompt, "quit = e1", "quit") == ["", "e1"]


def test_units_are_read_in_assignments(prompt):
    assert (
        answers(prompt, "θ = 90 deg", "R = exp(-45deg e1e2)", "Ω = 1 rev/s e12", "v(t) = (2 m/s) t e1")
        == [""] * 4
    )
    assert answers(prompt, "θ", "R e1 ~R - e2", "Ω", "v(2)")[::2] == ["1.5707963", "6.2831853 e1∧e2"]
    assert prompt.answer("v(2)") == "4 e1"
    with pytest.raises(LineError, match="`t` is a unit and a name here"):
        prompt.answer("v(t) = 2 t e1")
    with pytest.raises(LineError, match=r"`deg` has no value .*Units are read where a name gets a value"):
        prompt.answer("sin(90 deg)")


def test_the_last_value_is_an_underscore(prompt):
    with pytest.raises(LineError, match="`_` is the last value; there is none yet"):
        prompt.answer("_ + 1")
    assert answers(prompt, "e1 + e2", "_ _", "2 _", "_", "⟨e1 + _⟩_1") == ["e1 + e2", "2", "4", "4", "e1"]
    # Subscripts are not last values.
    assert answers(prompt, "a_1 = e3", "Ω_B = e12", "a_1 Ω_B", "_ == I") == [
        "",
        "",
        "I",
        "true, residual 0 of terms of size 1",
    ]
    # The outcome of an equation is not a value.
    assert prompt.answer("_") == "I"


def test_a_function_cannot_use_the_last_value(prompt):
    prompt.answer("e1")
    with pytest.raises(LineError, match="a function cannot use `_`") as caught:
        prompt.answer("f(x) = _ x")
    assert (caught.value.start, caught.value.end) == (7, 10)


def test_commands(prompt):
    assert prompt.answer(":names") == "no names have values yet; assign one with `a = 2 e1 + e2`"
    answers(prompt, "b = e2", "a = 2 e1", "R = exp(e12)", "V(x) = ½ x·x")
    assert prompt.answer(":names").splitlines() == [
        "R = 0.54030231 + 0.84147098 e1∧e2", "V(x) = ½ x·x", "a = 2 e1", "b = e2",
    ]  # fmt: skip
    assert prompt.answer(":grades a b") == "0, 2"
    assert prompt.answer(":grades R a ~R") == "1"
    assert prompt.answer(":tree Ra") == ("product  Ra  grade 1, 3\n  name  R  grade 0, 2\n  name  a  grade 1")
    assert prompt.answer(":latex -½ a∧b") == r"-\frac{1}{2}\,a{\wedge}b"
    assert answers(prompt, ":clear a", ":names")[1].count("\n") == 2
    assert ":clear NAME" in prompt.answer(":help")
    with pytest.raises(EOFError):
        prompt.answer(":quit")


def test_names_in_use_are_not_cleared(prompt):
    answers(prompt, "c = 2", "f(x) = c x")
    with pytest.raises(LineError, match="`c` is used in the definition `c x`"):
        prompt.answer(":clear c")
    assert answers(prompt, ":clear f", ":clear c", ":names")[:2] == ["", ""]


MISTAKES = {
    "unknown name": ("2 q", 2, 3, "`q` has no value"),
    "unknown command": (":foo a", 0, 4, "unknown command `:foo`; expected one of :names, :clear"),
    "unbalanced": ("(a", 0, 1, "`(` is never closed"),
    "unknown to clear": (":clear q", 7, 8, "`q` has no value"),
    "a place in a command": (":tree a + q", 10, 11, "`q` has no value"),
    "a place after a quantity": ("x = 90 deg + q", 13, 14, "`q` has no value"),
    "a place after the last value": ("x = _ + _ q", 10, 11, "`q` has no value"),
    "grades": ("cross(a, a∧b)", 9, 12, "the cross product needs a vector"),
    "an equation as a value": (
        "x = a == b",
        4,
        10,
        "an equation is not a value that a name can have",
    ),
    "overflow": ("1e+300*1e+300", 0, 13, "beyond the range of floating point"),
    "an infinite value": ("x = 1e+300*1e+300", 4, 17, "beyond the range of floating point"),
    "no logarithm": ("log(a - a)", 0, 10, "no logarithm"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_errors_have_places(name, prompt):
    answers(prompt, "a = e1", "b = e2", "a")
    line, start, end, message = MISTAKES[name]
    with pytest.raises(LineError) as caught:
        prompt.answer(line)
    assert message in caught.value.message
    assert (caught.value.start, caught.value.end) == (start, end)
    # Nothing was assigned.
    assert "x" not in prompt.session.names


PIECES = [
    *(
        "a",
        "b",
        "x",
        "f(",
        "V(x)",
        "(",
        ")",
        "=",
        "==",
        "+",
        "-",
        "∧",
        "^",
        "·",
        "/",
        "~",
        "⟨",
        "⟩_2",
        "_",
        "'",
        "²",
    ),
    *(
        "2",
        "0.5",
        "1e3",
        "1e-400",
        "deg",
        "m",
        "rev/s",
        "°",
        "e1",
        "I",
        "Σ_k",
        "e_k",
        "exp(",
        "log(",
        "norm(",
        ",",
    ),
    *(" ", " ", ":tree ", ":clear ", ":grades ", ":latex ", "#", "\u0303", "\ufffd", "𝑅", "½", "let ", "$"),
]


@given(st.lists(st.sampled_from(PIECES), max_size=12).map("".join) | st.text(max_size=30))
def test_any_line_has_an_answer_or_a_place(line):
    prompt = Prompt()
    answers(prompt, "a = e1 + 2e2", "b = e12", "f(x) = a x", "a")
    try:
        assert isinstance(prompt.answer(line), str)
    except EOFError:  # a word that leaves
        return
    except LineError as error:
        wrong = error
    else:
        return
    assert 0 <= wrong.start <= wrong.end <= len(line)
    assert wrong.shown("input", 1, line).count("\n") == 3


def test_names_are_completed(prompt):
    answers(prompt, "omega_body = e12", "Ω_B = e23", "energy(x) = x·x")
    assert prompt.candidates("om") == ["omega_body"]
    assert prompt.candidates("Ω") == ["Ω_B"]
    assert prompt.candidates("e") == ["energy(", "exp("]
    assert prompt.candidates(":c") == [":clear"]
    assert prompt.candidates("qq") == []


def test_completion_knows_every_function(prompt):
    prompt.answer("a = e1 + e3")
    two = {"commutator", "cross", "dot", "left_contraction", "right_contraction", "wedge"}
    one_number = {"cos", "sin", "tan"}
    for name in FUNCTIONS:
        arguments = "a, a" if name in two else "0.5" if name in one_number else "2 a a"
        assert prompt.answer(f"{name}({arguments})")


# --- through a pipe


def test_piped_lines_are_answered_without_a_prompt():
    done = polhode("repl", input="# nothing\na = 2 e1\na a\n\nq\n:quit\nnever\n")
    assert (done.returncode, done.stdout) == (0, "4\n")
    assert done.stderr == ("input:5:1: error: `q` has no value; names with values: a\n  |\n5 | q\n  | ^\n")


def test_piped_bytes_that_are_not_utf_8(tmp_path):
    (tmp_path / "lines").write_bytes(b"e1 \xff\ne2")
    with open(tmp_path / "lines", "rb") as lines:
        done = polhode("repl", stdin=lines)
    assert (done.returncode, done.stdout) == (0, "e2\n")
    assert "input:1:4: error: " in done.stderr


def test_a_reader_that_leaves_early():
    command = f"yes e1 | head -20000 | '{POLHODE}' repl | head -1"
    done = processes.run(command, shell=True)
    assert (done.stdout, done.stderr) == ("e1\n", "")


# --- typed


# Ctrl-C interrupts the programs whose terminal it is. (A `preexec_fn` would fork, which JAX forbids.)
_LAUNCH = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execv(sys.argv[1], sys.argv[1:])
"""


class Terminal:
    """The prompt in a terminal of its own."""

    def __init__(self, process, master):
        self.process, self.master = process, master
        self.until("> ")

    def until(self, end):
        """What is shown, up to some text."""
        shown = b""
        while not shown.endswith(end.encode()):
            shown += os.read(self.master, 4096)  # an OSError when the prompt has ended
        return shown.decode().replace("\r\n", "\n")

    def type(self, keys, end="\n> "):
        os.write(self.master, keys.encode())
        return self.until(end)

    def leave(self, keys="\x04"):
        os.write(self.master, keys.encode())
        shown = b""
        with contextlib.suppress(OSError):  # the terminal is gone
            while data := os.read(self.master, 4096):
                shown += data
        return self.process.wait(), shown.decode().replace("\r\n", "\n")


@contextlib.contextmanager
def terminal_of(state):
    """The prompt, which keeps its history in this directory."""
    pytest.importorskip("readline")
    master, slave = pty.openpty()
    environment = {**os.environ, "XDG_STATE_HOME": str(state), "TERM": "dumb", "LC_ALL": "C.UTF-8"}
    ends = {"stdin": slave, "stdout": slave, "stderr": slave}
    command = [sys.executable, "-c", _LAUNCH, POLHODE, "repl"]
    with processes.start(command, **ends, env=environment, start_new_session=True) as process:
        os.close(slave)
        yield Terminal(process, master)
    os.close(master)


@pytest.fixture
def terminal(tmp_path):
    with terminal_of(tmp_path) as terminal:
        yield terminal


def test_a_typed_session(terminal, tmp_path):
    assert terminal.type("speed = 2 e1\n") == "speed = 2 e1\n> "
    assert terminal.type("speed∧e2\n").endswith("\n2 e1∧e2\n> ")
    assert "no value" in terminal.type("q\n")
    # Tab completes; Ctrl-C clears the line and nothing else; Ctrl-D leaves.
    assert terminal.type("spe\t\n").endswith("speed\n2 e1\n> ")
    terminal.type("spe", "spe")
    # Python sees a signal while it waits for keys; within an instant after one it would only at the next key.
    time.sleep(0.5)
    terminal.type("\x03")
    assert terminal.type("speed\n").endswith("\n2 e1\n> ")
    code, _ = terminal.leave()
    assert code == 0
    history = (tmp_path / "polhode" / "history").read_text(encoding="utf-8")
    assert history.splitlines() == ["speed = 2 e1", "speed∧e2", "q", "speed"]


def test_the_history_is_restored(tmp_path):
    (tmp_path / "polhode").mkdir()
    (tmp_path / "polhode" / "history").write_text("7 e3\n")
    with terminal_of(tmp_path) as terminal:
        # Ctrl-P goes back in the history.
        assert terminal.type("\x10\n").endswith("7 e3\n> ")
        assert terminal.leave()[0] == 0
    # A line that repeats the one before it is kept once.
    assert (tmp_path / "polhode" / "history").read_text() == "7 e3\n"


def test_a_history_that_cannot_be_saved_is_reported(tmp_path):
    (tmp_path / "polhode").write_text("a file where a directory should be")
    with terminal_of(tmp_path) as terminal:
        terminal.type("e1\n")
        code, shown = terminal.leave(":quit\n")
    assert code == 0
    assert "polhode: cannot save the history: " in shown
    assert "Traceback" not in shown


def test_the_history_is_bounded_and_shared(tmp_path):
    path = tmp_path / "polhode" / "history"
    _keep(path, [f"{i}" for i in range(900)])
    _keep(path, [f"x{i}" for i in range(300)])
    lines = path.read_text().splitlines()
    assert (len(lines), lines[0], lines[-1]) == (1000, "200", "x299")


def test_the_path_of_the_history(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert _history_path() == tmp_path / "polhode" / "history"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")  # which the standard has ignored
    monkeypatch.setenv("HOME", str(tmp_path))
    assert _history_path() == tmp_path / ".local" / "state" / "polhode" / "history"
