"""The exception for errors in formulas."""

from __future__ import annotations

from polhode import _native


class FormulaError(ValueError):
    """An error in a formula or in the values given to it, with its place in the text.

    Attributes
    ----------
    message
        What is wrong, and what to do.
    text, span
        The formula, and the place in it: the first character, and the one after the last.

    Examples
    --------
    >>> try:
    ...     ph.evaluate("2 (a∧b", a=ph.e1, b=ph.e2)
    ... except ph.FormulaError as error:
    ...     print(error)
    `(` is never closed
      |
    1 | 2 (a∧b
      |   ^
    """

    def __init__(self, message: str, text: str, span: tuple[int, int]) -> None:
        super().__init__(message, text, span)
        self.message, self.text, self.span = message, text, span

    def __str__(self) -> str:
        return self.message + _native.marked(self.text, self.span)


def check_encoding(text: str) -> None:
    """Raise a FormulaError for a surrogate, as in text decoded from bytes that are not UTF-8."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        words = f"{text[error.start]!a} is half of a character; decode the text as UTF-8"
        shown = text.encode("utf-8", "replace").decode()
        raise FormulaError(words, shown, (error.start, error.start + 1)) from None


_native.register("FormulaError", FormulaError)
