"""The command ``polhode eval``: evaluate formulas from arguments, a file or standard input."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from typing import Any, BinaryIO, NamedTuple

from polhode._formula.agreement import Agreement
from polhode._formula.shell.session import Answer, LineError, Session, after_let, text_of, without_comment
from polhode._support.files import UnreadableError, is_endless

OK, FALSE, BAD_INPUT = 0, 1, 3

# Longer lines, in bytes, are refused.
_LONGEST = 100_000


class Line(NamedTuple):
    """A line of some source, and its error if it cannot be read."""

    source: str
    number: int
    text: str
    mistake: LineError | None = None
    assigns: bool = False


def run(options: argparse.Namespace) -> int:
    """Evaluate all formulas; return the exit code: errors before false equations."""
    session, records, codes = Session(only_finite=True), [], {OK}
    for line in _lines(options):
        try:
            answer = _answer(session, line)
        except LineError as mistake:
            codes.add(BAD_INPUT)
            shown = mistake.shown(line.source, line.number, line.text)
            records.append({"formula": line.text, "error": shown})
            if not options.json:
                print(shown, file=sys.stderr)
            continue
        if answer is None:
            continue
        if isinstance(answer.value, Agreement) and not answer.value:
            codes.add(FALSE)
        if options.json:
            records.append(_record(line, answer))
        else:
            # Flushed, so that values and errors appear in order.
            print(_latex(answer) if options.latex else text_of(answer.value), flush=True)
    if options.json:
        print(json.dumps(records, indent=2, allow_nan=False))
    return max(codes)


def _answer(session: Session, line: Line) -> Answer | None:
    """Return the answer to a line; None for an assignment."""
    if line.mistake:
        raise line.mistake
    start = 0 if line.assigns else after_let(line.text)
    answer = session.run(line.text, start, line.assigns or start > 0)
    return None if answer.name else answer


# --- where the lines come from


def _lines(options: argparse.Namespace) -> Iterator[Line]:
    """Yield the values of ``--let``, the lines of the file or of standard input, then the arguments."""
    for text in options.let:
        yield _checked(Line("--let", 1, text, assigns=True))
    if options.file or not options.formulas:
        yield from _file(options.file or "-")
    for number, text in enumerate(options.formulas, 1):
        source = f"formula {number}" if len(options.formulas) > 1 else "formula"
        yield _checked(Line(source, 1, text.strip()))


def _file(path: str) -> Iterator[Line]:
    """Yield the lines of a file as they arrive."""
    source = "<stdin>" if path == "-" else path.encode(errors="replace").decode()
    empty = True
    if is_endless(path):
        raise UnreadableError(f"{source}: error: not a regular file; give the path of a file of formulas")
    try:
        with _standard_input() if path == "-" else open(path, "rb") as file:
            for number, data in enumerate(iter(lambda: file.readline(_LONGEST + 1), b""), 1):
                line = _decoded(source, number, data)
                if line.text or line.mistake:
                    empty = False
                    yield line
                if len(data) > _LONGEST:
                    return
    except OSError as error:
        raise UnreadableError(f"{source}: error: {(error.strerror or str(error)).lower()}") from error
    if empty:
        raise UnreadableError(f"{source}: error: no formula found; write one on each line")


def _standard_input() -> BinaryIO:
    stream = getattr(sys, "stdin", None)
    if stream is None:  # as after `<&-`
        raise OSError("standard input is closed")
    return stream.buffer  # type: ignore[no-any-return]


def _decoded(source: str, number: int, data: bytes) -> Line:
    if len(data) > _LONGEST:
        shown = data[:80].decode(errors="replace")
        return Line(source, number, shown, LineError(f"the line is longer than {_LONGEST} bytes", 0, 1))
    try:
        return Line(source, number, without_comment(data.decode().removeprefix("\ufeff")))
    except UnicodeDecodeError as error:
        at = len(data[: error.start].decode())
        return Line(
            source, number, data.decode(errors="replace").rstrip(), LineError("not UTF-8", at, at + 1)
        )


def _checked(line: Line) -> Line:
    """Return an argument; bytes that are not UTF-8 become its error."""
    try:
        line.text.encode()
    except UnicodeEncodeError as error:
        text = line.text.encode(errors="replace").decode()
        return line._replace(text=text, mistake=LineError("not UTF-8", error.start, error.start + 1))
    return line


# --- output


def _record(line: Line, answer: Answer) -> dict[str, Any]:
    value = answer.value
    spelled = {"text": "unicode", "ascii": "ascii", "latex": "latex"}
    record = {"formula": line.text} | {key: answer.spelled(style) for key, style in spelled.items()}
    if isinstance(value, Agreement):
        return record | {
            "holds": bool(value),
            "residual": float(value.residual),
            "size": float(value.size),
        }
    return record | {
        "grades": list(value.grades),
        "components": value.components.tolist(),
        "repr": repr(value),
    }


def _latex(answer: Answer) -> str:
    """Return an equation with its result as a comment, or a formula and its value."""
    formula = answer.spelled("latex")
    if isinstance(answer.value, Agreement):
        return f"{formula} % {text_of(answer.value)}"
    return f"{formula} = {answer.value._repr_latex_().strip('$')}"
