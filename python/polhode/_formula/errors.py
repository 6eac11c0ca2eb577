"""Why a text is no formula, or a formula has no value."""

from __future__ import annotations

from polhode import _native


class FormulaError(ValueError):
    """What is wrong with a formula, or with the values it was given, with the place in the text.

    Attributes
    ----------
    message
        What is wrong, and what to do.
    text, span
        The formula, and which of its characters are meant: the first, and the one after the last.
    """

    def __init__(self, message: str, text: str, span: tuple[int, int]) -> None:
        super().__init__(message, text, span)
        self.message, self.text, self.span = message, text, span

    def __str__(self) -> str:
        return self.message + _native.marked(self.text, self.span)
