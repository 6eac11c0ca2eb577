"""Formulas in the notation of the handout, as MathML for browsers.

The notation is that of the formula language (docs/formulas.md), plus integrals. Browsers draw MathML
themselves, so the pages need no script and no network.
"""

import re
from html import escape

FUNCTIONS = ("exp", "log", "cos", "sin", "tan", "dual", "det")
LETTER = "[^\\W\\d_⁰¹²³⁴⁵⁶⁷⁸⁹½]"
TOKEN = re.compile(
    rf"(?P<space>\s+)|(?P<function>(?:{'|'.join(FUNCTIONS)})\b)"
    rf"|(?P<name>{LETTER})(?P<index>_(?:{LETTER}|\d)+|\d+|[∥⊥])?(?P<primes>'*)"
    r"|(?P<number>\d+(?:\.\d+)?|½)"
    r"|(?P<sum>Σ)(?P<over>_\w)?"
    r"|(?P<open>[(\[⟨])|(?P<close>[)\]⟩])(?P<part>_\d)?(?P<marks>['~]*)"
    r"|(?P<power>[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)|(?P<raise>\^\()"
    r"|(?P<reverse>~)|(?P<sign>\S)"
)
# Fonts for text have primes and ² raised already. The style sheet chooses such a font: many machines have no
# mathematical font, and then browsers place superscripts too high.
PRIME = '<mo class="raised" lspace="0.05em" rspace="0.05em">′</mo>'
# Between two of these a space in the text is a space in the formula.
FACTORS = ("name", "number", "function", "sum", "open", "close", "reverse", "power")


def mathml(text: str, display: bool = False) -> str:
    """Return a formula as an element `math`; a formula that cannot be read is a ValueError."""
    try:
        row, _ = _row(_tokens(text), "")
    except (ValueError, IndexError) as error:
        raise ValueError(f"the formula {text!r} cannot be read: {error}") from None
    return f'<math display="{"block" if display else "inline"}"><mrow>{"".join(row)}</mrow></math>'


def _tokens(text):
    """Return the tokens of a formula as (kind, text, match); Σ before another letter is a sum."""
    found = []
    for match in TOKEN.finditer(text):
        kind = match.lastgroup
        if kind in ("index", "primes"):
            kind = "name"
        elif kind in ("part", "marks"):
            kind = "close"
        elif kind == "over":
            kind = "sum"
        if match["name"] == "Σ":
            kind = "sum"
        found.append((kind, match[0], match))
    return found


def _row(tokens, end):
    """Return the elements up to a closing bracket, and the tokens after it."""
    row, last = [], ""
    while tokens:
        (kind, text, match), tokens = tokens[0], tokens[1:]
        if end and kind == "close":
            return row, [(kind, text, match), *tokens]
        if kind == "space":
            if last in FACTORS and tokens and tokens[0][0] in (*FACTORS, "reverse"):
                row.append('<mspace width="0.22em"/>')
            continue
        if kind == "raise":
            inner, tokens = _row(tokens, ")")
            tokens = tokens[1:]
            row.append(_element("msup", row.pop(), _element("mrow", *inner)))
        elif kind == "power":
            row.append(_element("mrow", row.pop(), f'<mn class="raised">{text}</mn>'))
        elif kind == "reverse":
            following, tokens = tokens[0], tokens[1:]
            if following[0] != "name":
                raise ValueError("~ stands before a name")
            row.append(_name(following[2], tilde=True))
        elif kind == "open":
            inner, tokens = _row(tokens, ")")
            (_, _, closing), tokens = tokens[0], tokens[1:]
            row.append(_bracket(text, inner, closing))
        elif kind == "sign" and text in "+−-√" and last in ("", "sign"):
            row.append(f'<mo form="prefix">{text}</mo>')
        else:
            row.append(_single(kind, text, match))
        last = "close" if kind == "open" else "power" if kind == "raise" else kind
    if end:
        raise ValueError("a bracket is not closed")
    return row, tokens


def _single(kind, text, match):
    if kind == "name":
        return _name(match)
    if kind == "function":
        return f"<mi>{text}</mi>"
    if kind == "number":
        return f"<mn>{text}</mn>"
    if kind == "sum":
        over = text[2:]
        sign = '<mo largeop="true" movablelimits="false">∑</mo>'
        return _element("munder", sign, f"<mi>{over}</mi>") if over else sign
    if kind == "close":
        raise ValueError(f"unexpected {text!r}")
    if text in "|/":
        return f'<mo stretchy="false" lspace="0.05em" rspace="0.05em">{text}</mo>'
    # The sign of the vector cross product is bold, as in the handout.
    return '<mo style="font-weight: bold">×</mo>' if text == "⨯" else f"<mo>{escape(text)}</mo>"


def _name(match, tilde=False):
    """Return a letter with its index, primes and tilde."""
    letter = f"<mi>{match['name']}</mi>"
    if tilde:
        letter = f'<mover accent="true">{letter}<mo stretchy="false">~</mo></mover>'
    index = (match["index"] or "").removeprefix("_")
    if index:
        below = f"<mo>{index}</mo>" if index in "∥⊥" else _letters(index)
        letter = _element("msub", letter, below)
    return _element("mrow", letter, len(match["primes"]) * PRIME) if match["primes"] else letter


def _letters(index):
    tag = "mn" if index.isdigit() else "mi"
    return _element("mrow", *(f"<{tag}>{letter}</{tag}>" for letter in index))


def _bracket(opening, inner, closing):
    sign = closing["close"]
    both = _element(
        "mrow", f'<mo stretchy="false">{opening}</mo>', *inner, f'<mo stretchy="false">{sign}</mo>'
    )
    if closing["part"]:
        both = _element("msub", both, f"<mn>{closing['part'][1:]}</mn>")
    for mark in closing["marks"]:
        both = _element("mrow", both, PRIME) if mark == "'" else _element("msup", both, "<mo>~</mo>")
    return both


def _element(tag, *inside):
    return f"<{tag}>{''.join(inside)}</{tag}>"
