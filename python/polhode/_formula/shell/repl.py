"""The command ``polhode repl``: formulas as they are typed, with a history and completion of names."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from polhode._formula.formula import Formula
from polhode._formula.shell.session import FUNCTIONS, LineError, Session, told, without_comment
from polhode._support.files import write_atomically

_PROMPT = "> "
_KEPT = 1000
# What is longer, in characters, is no formula; it is read in pieces.
_LONGEST = 100_000
# Between these a name ends for completion.
_DELIMITERS = " \t\n()[]{}⟨⟩<>=+-−*/^∧|·×⨯⌋⌊~,"

_HELP = """\
A formula, as on paper or in ASCII, prints its value:   -I a∧b   or   -I a^b
name = value gives a name a value, which may have units:   θ = 90 deg
f(x) = … defines a function:   V(x) = ½ x·x
lhs == rhs compares; _ is the last value; what follows # is a comment.

:names            what has a value
:clear NAME       take it away
:grades FORMULA   the grades of its value
:tree FORMULA     how it is read
:latex FORMULA    the formula in LaTeX
:help, :quit      this page; leave (as Ctrl-D does)"""


class Prompt:
    """What answers to lines that are typed."""

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

    def answer(self, line: str) -> str:
        """Return what a line prints; a LineError if something is wrong with it, EOFError to leave."""
        if not line.startswith(":"):
            answer = self.session.run(line)
            return "" if answer.name else told(answer.value)
        word = line.split()[0]
        command = self._commands.get(word)
        if command is None:
            known = ", ".join(self._commands)
            raise LineError(f"there is no command `{word}`; there are {known}", 0, len(word))
        start = len(line) - len(line[len(word) :].lstrip())
        return command(line, start)

    def candidates(self, text: str) -> list[str]:
        """Return what the beginning of a name or a command may become."""
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
        return "\n".join(lines) or "no name has a value yet; `a = 2 e1 + e2` gives one"

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
    """Return a syntax tree line by line: what each part is, how it is written, and its grades."""
    grades = "" if node["grades"] is None else f"  grade {', '.join(map(str, node['grades']))}"
    yield f"{indent}{node['kind']}  {node['text']}{grades}"
    for child in node["children"]:
        yield from _branches(child, indent + "  ")


def run() -> int:
    """Answer to standard input, line by line, until it ends."""
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
                # At once, so that values and errors come in order.
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
    """Let lines be edited, names completed, and keep what is typed for the next time."""
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
    """Return where the XDG base directories have it."""
    state = os.environ.get("XDG_STATE_HOME", "")
    return Path(state if os.path.isabs(state) else "~/.local/state").expanduser() / "polhode" / "history"


def _history(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:  # as the first time
        return []


def _keep(path: Path, lines: list[str]) -> None:
    """Add lines to the history, in which another prompt may have written meanwhile."""
    if not lines:
        return
    kept = [*_history(path), *lines][-_KEPT:]
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_atomically({path: "".join(f"{line}\n" for line in kept).encode(errors="replace")})
    except OSError as error:
        print(f"polhode: the history is not kept: {error}", file=sys.stderr)
