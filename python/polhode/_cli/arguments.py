"""Values of the command's arguments: what cannot be read is wrong usage."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from polhode._support.files import form_of


def file_name(what: str) -> Callable[[str], str]:
    """Return what checks the name of a file to be written; one of another form is wrong usage."""

    def checked(name: str) -> str:
        try:
            form_of(name, what)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        return name

    return checked
