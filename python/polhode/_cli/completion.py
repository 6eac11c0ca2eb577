"""Completion of the command in a shell: ``polhode --print-completion``."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

from polhode._support.extras import optional

_SHELLS = ("bash", "zsh")


def add(parser: argparse.ArgumentParser) -> None:
    """Add the option ``--print-completion``."""
    words = "print a script that completes this command in a shell (needs polhode[completion])"
    parser.add_argument("--print-completion", metavar="SHELL", choices=_SHELLS, action=_Print, help=words)


class _Print(argparse.Action):
    """Prints the script and exits; an ImportError without shtab."""

    def __call__(
        self, parser: argparse.ArgumentParser, _: Any, shell: Any, option_string: str | None = None
    ) -> None:
        shtab = optional("shtab", "completion", "completion in a shell")
        for argument in _arguments(parser):
            metavar = argument.metavar if isinstance(argument.metavar, str) else ""
            if metavar.startswith(("FILE", "SCENE")) or metavar in ("A", "B"):
                argument.complete = shtab.FILE  # type: ignore[attr-defined]
            elif metavar.startswith("FOLDER"):
                argument.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
        print(shtab.complete(parser, shell))
        parser.exit()


def _arguments(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the arguments of a parser and of its commands."""
    for argument in parser._actions:
        yield argument
        if isinstance(argument, argparse._SubParsersAction):
            for command in argument.choices.values():
                yield from _arguments(command)
