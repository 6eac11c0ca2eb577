"""The command ``polhode repl``: an interactive prompt with history and completion."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from polhode._formula.formula import Formula
from polhode._formula.shell.session import (
    FUNCTIONS,
    LineError,
    Session,
    after_let,
    text_of,
    without_comment,
)
from polhode._support.files import write_atomically

_PROMPT = "> "
_KEPT = 1000
# Longer lines, in characters, are read in pieces.
_LONGEST = 100_000
# Delimiters of names for completion.
_DELIMITERS = " \t\n()[]{}⟨⟩<>=+-−*/^∧|·×⨯⌋⌊~,"

_HELP = """\
A formula prints its value:   -I a∧b   or   -I a^b
name = value gives a name a value, which may have units:   θ = 90 deg
f(x) = … defines a function:   V(x) = ½ x·x
lhs == rhs compares two sides; _ is the last value; # begins a comment.

:names            list names and their values
:clear NAME       remove a name
:grades FORMULA   the grades of its value
:tree FORMULA     its syntax tree
:latex FORMULA    the formula in LaTeX
:help, :quit      this text; leave (also Ctrl-D)"""


class Prompt:
    """The prompt: it answers formulas and commands."""

    def __init__(self) -> None:
        self.session = Session(only_finite=True)
        self._commands: dict[str, Callable[[str, int], str]] = {
            ":names": self._names,
            ":clear": self._clear,
            ":grades": self._grades,
            ":tree": self._tree,
            ":latex": self._latex,
            ":help": lambda _line, _start: _HELP,
            ":quit": self._quit,
        }
        # As at other prompts, unless they are names of values.
        self._words = {"help": ":help", "exit": ":quit", "quit": ":quit"}

    def answer(self, line: str) -> str:
        """Return the output of a line; raise LineError for an error in it, EOFError to leave."""
        plain = line.strip().removesuffix("()")
        if plain in self._words and plain not in self.session.names:
            line = self._words[plain]
        if not line.startswith(":"):
            start = after_let(line)
            answer = self.session.run(line, start, assigns=True if start else None)
            return answer.note if answer.name else text_of(answer.value)
        word = line.split()[0]
        command = self._commands.get(word)
        if command is None:
            known = ", ".join(self._commands)
            raise LineError(f"unknown command `{word}`; expected one of {known}", 0, len(word))
        start = len(line) - len(line[len(word) :].lstrip())
        return command(line, start)

    def candidates(self, text: str) -> list[str]:
        """Return the names or commands that begin with `text`."""
        if text.startswith(":"):
            return [command for command in self._commands if command.startswith(text)]
        session = self.session
        names = [f"{name}(" if name in session.functions else name for name in session.names]
        functions = [f"{name}(" for name in FUNCTIONS]
        return [name for name in (*names, *functions, "pi") if name.startswith(text)]

    # --- commands

    def _names(self, _line: str, _start: int) -> str:
        session = self.session
        lines = []
        for name in session.names:
            head, body = session.functions.get(name) or (name, repr(session.values[name]))
            lines.append(f"{head} = {body.strip()}")
        return "\n".join(lines) or "no names have values yet; assign one with `a = 2 e1 + e2`"

    def _clear(self, line: str, start: int) -> str:
        name = line[start:]
        try:
            self.session.forget(name)
        except LookupError as error:
            raise LineError(str(error), start, len(line)) from None
        return ""

    def _grades(self, line: str, start: int) -> str:
        tree = self.session.about(line, start, Formula.tree)
        sides = [tree] if tree["grades"] is not None else tree["children"]
        return "\n".join(", ".join(map(str, side["grades"])) for side in sides)

    def _tree(self, line: str, start: int) -> str:
        return "\n".join(_branches(self.session.about(line, start, Formula.tree), ""))

    def _latex(self, line: str, start: int) -> str:
        def latex(read: Formula, **given: Any) -> str:
            return read.spelled("latex", **given)

        return self.session.about(line, start, latex)

    def _quit(self, _line: str, _start: int) -> str:
        raise EOFError


def _branches(node: dict[str, Any], indent: str) -> Iterator[str]:
    """Yield the lines of a syntax tree: kind, text and grades of each node."""
    grades = "" if node["grades"] is None else f"  grade {', '.join(map(str, node['grades']))}"
    yield f"{indent}{node['kind']}  {node['text']}{grades}"
    for child in node["children"]:
        yield from _branches(child, indent + "  ")


def run() -> int:
    """Answer the lines of standard input until it ends."""
    prompt = Prompt()
    if getattr(sys, "stdin", None) is None:  # as after `<&-`
        raise OSError("standard input is closed")
    typed = sys.stdin.isatty()
    if not typed and isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(encoding="utf-8", errors="replace")
    with _editing(prompt) if typed else nullcontext():
        number = 0
        while (line := _typed_line() if typed else _piped_line()) is not None:
            number += 1
            line = without_comment(line.encode(errors="replace").decode())  # a terminal may send any bytes
            try:
                text = prompt.answer(line) if line else ""
            except LineError as mistake:
                print(mistake.shown("input", number, line), file=sys.stderr)
            except EOFError:
                break
            except KeyboardInterrupt:
                if not typed:
                    raise
                print()
            else:
                # Flushed, so that values and errors appear in order.
                print(text, end="\n" if text else "", flush=True)
    return 0


def _typed_line() -> str | None:
    try:
        return input(_PROMPT)
    except KeyboardInterrupt:
        print()
        return ""
    except EOFError:
        print()
        return None


def _piped_line() -> str | None:
    return sys.stdin.readline(_LONGEST) or None


# --- history and completion


@contextmanager
def _editing(prompt: Prompt) -> Iterator[None]:
    """Enable line editing, completion and the history."""
    try:
        import readline
    except ImportError:  # not on every system
        yield
        return
    path = _history_path()
    for line in _history(path):
        readline.add_history(line)
    before = readline.get_current_history_length()

    def complete(text: str, number: int) -> str | None:
        return dict(enumerate(prompt.candidates(text))).get(number)

    readline.set_completer(complete)
    readline.set_completer_delims(_DELIMITERS)
    libedit = "libedit" in (readline.__doc__ or "")
    readline.parse_and_bind("bind ^I rl_complete" if libedit else "tab: complete")
    try:
        yield
    finally:
        count = readline.get_current_history_length()
        _keep(path, [readline.get_history_item(i + 1) for i in range(before, count)])


def _history_path() -> Path:
    """Return the path of the history by the XDG base directory standard."""
    state = os.environ.get("XDG_STATE_HOME", "")
    return Path(state if os.path.isabs(state) else "~/.local/state").expanduser() / "polhode" / "history"


def _history(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:  # none yet
        return []


def _keep(path: Path, lines: list[str]) -> None:
    """Append lines to the history, which another prompt may have extended meanwhile."""
    if not lines:
        return
    kept = [*_history(path), *lines][-_KEPT:]
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_atomically({path: "".join(f"{line}\n" for line in kept).encode(errors="replace")})
    except OSError as error:
        print(f"polhode: cannot save the history: {error}", file=sys.stderr)
