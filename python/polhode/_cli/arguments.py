"""Types of command-line arguments."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from polhode._support.files import form_of


def file_name(what: str) -> Callable[[str], str]:
    """Return an argparse type that checks the suffix of a file to be written."""

    def checked(name: str) -> str:
        try:
            form_of(name, what)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return name

    return checked
