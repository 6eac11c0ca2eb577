"""The pages of the handout have every equation, as it is tested, and the tests of each."""

import ast
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

import handout_tests
from handout_equations import EQUATIONS
from notation import mathml

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
SHOWN = handout_tests.shown_equations(DOCS)
FORMULAS = handout_tests.formulas_of_equations(ROOT)
TESTS = handout_tests.tests_of_equations(ROOT)
PAGES = {path.stem: path.read_text() for path in sorted((DOCS / "handout").glob("*.md"))}
# Lines that formulas cannot say: a list of elements, and integrals, which are tested as sums over points.
UNTESTED_LINES = {
    "1, e1, e2, e3, e2e3, e3e1, e1e2, e1e2e3",
    "∫ρ d³x = m",
    "∫ρ x d³x = 0",
    "L = ∫ρ (y − x0)∧v d³x",
    "I(B) = ∫ρ x∧(x·B) d³x",
}


def test_every_equation_has_tests():
    assert len(handout_tests.NUMBERS) == 72
    assert [number for number in handout_tests.NUMBERS if number not in TESTS] == []
    # The basis is a list.
    assert [number for number in handout_tests.NUMBERS if number not in FORMULAS] == ["1.4"]


def test_every_equation_stands_on_one_page_in_the_order_of_the_handout():
    shown = [number for equation in SHOWN for number in equation.numbers]
    assert [number for number in shown if number != "quaternions"] == handout_tests.NUMBERS
    assert shown.count("quaternions") == 1


def test_the_lines_of_the_pages_are_the_tested_ones():
    untested = set()
    for equation in SHOWN:
        tested = {formula.text for number in equation.numbers for formula in FORMULAS.get(number, [])}
        untested |= set(equation.lines) - tested
    assert untested == UNTESTED_LINES


def test_the_formulas_found_in_the_file_are_those_that_run():
    found = {(number, formula.text) for number, formulas in FORMULAS.items() for formula in formulas}
    assert found == {(number, eq.text) for eq in EQUATIONS for number in eq.number.split(", ")}


@pytest.mark.parametrize(
    ("name", "numbers"),
    [
        ("test_eq_1_1_bivector_times_vector", ["1.1"]),
        ("test_eq_1_2_and_1_3_wedges", ["1.2", "1.3"]),
        ("test_eq_4_5_to_4_9_the_rate", ["4.5", "4.6", "4.7", "4.8", "4.9"]),
        ("test_eq_4_35_the_rotor_of_2_turns", ["4.35"]),
        ("test_quaternions", []),
    ],
)
def test_numbers_in_names_of_tests(name, numbers):
    assert handout_tests.numbers_in(name) == numbers


def test_the_lines_of_a_test_are_its_own():
    for test in TESTS["4.13"]:
        lines = (ROOT / test.path).read_text().splitlines()
        assert "\n".join(lines[test.first - 1 : test.last]) == test.source
        assert f"def {test.name}(" in test.source


def test_every_page_is_in_the_index():
    assert sorted(handout_tests.pages(DOCS)) == [f"handout/{page}" for page in PAGES if page != "index"]


@pytest.mark.parametrize("page", [page for page in PAGES if page != "index"])
def test_every_page_has_code_a_picture_reasons_and_solved_exercises(page):
    text = PAGES[page]
    assert "```python" in text
    assert "```{picture}" in text
    assert "## Why" in text
    exercises = text.partition("## Exercises")[2]
    solutions = exercises.count('<details class="solution">\n<summary>Solution</summary>\n\n')
    assert len(re.findall(r"^\*\*\d\.\*\*", exercises, flags=re.MULTILINE)) == solutions >= 2
    assert exercises.count("\n\n</details>\n") == solutions
    assert exercises.count("```python") == solutions


def test_pictures_are_drawn_by_functions_and_all_are_shown():
    named = [
        re.findall(r"^```\{picture\} (\w+)\n:alt: \S", text, flags=re.MULTILINE)
        for text in (*PAGES.values(), (DOCS / "start.md").read_text())
    ]
    used = [name for names in named for name in names]
    tree = ast.parse((DOCS / "handout/pictures.py").read_text())
    functions = [node.name for node in tree.body if isinstance(node, ast.FunctionDef) and not node.args.args]
    assert sorted(used) == sorted(functions)


# --- formulas as MathML

LINES = re.compile(r"^```\{(?:formula|equation)\}[^\n]*\n(.*?)```", re.MULTILINE | re.DOTALL)


def formulas():
    texts = [formula.text for found in FORMULAS.values() for formula in found]
    for page in PAGES.values():
        texts += re.findall(r"\{formula\}`([^`]*)`", page)
        for block in LINES.findall(page):
            texts += block.splitlines()
    return texts


def test_every_formula_of_the_pages_can_be_read():
    texts = formulas()
    assert len(texts) > 400
    for text in texts:
        letters = "".join(ElementTree.fromstring(mathml(text)).itertext())
        # Nothing is lost but what becomes a place in the picture.
        assert re.sub(r"[\s_^()~'′]", "", letters) == kept(text), text


def kept(text):
    text = text.translate(str.maketrans("Σ⨯", "∑×"))
    return re.sub(r"[\s_^()~'′]", "", text)


@pytest.mark.parametrize(
    ("text", "inside"),
    [
        ("~R", '<mover accent="true"><mi>R</mi><mo stretchy="false">~</mo></mover>'),
        ("Ω_B", "<msub><mi>Ω</mi><mrow><mi>B</mi></mrow></msub>"),
        ("B²", '<mrow><mi>B</mi><mn class="raised">²</mn></mrow>'),
        ("e^(−B)", '<msup><mi>e</mi><mrow><mo form="prefix">−</mo><mi>B</mi></mrow></msup>'),
        ("a b", '<mi>a</mi><mspace width="0.22em"/><mi>b</mi>'),
        ("a + b", "<mi>a</mi><mo>+</mo><mi>b</mi>"),
        ("exp(t)", "<mi>exp</mi>"),
        ("a<b", "<mo>&lt;</mo>"),
    ],
)
def test_signs_become_places(text, inside):
    assert inside in mathml(text)


@pytest.mark.parametrize("text", ["(a", "a)", "e^(a", "~", "~(a)", "²"])
def test_formulas_that_cannot_be_read_are_errors(text):
    with pytest.raises(ValueError, match="formula"):
        mathml(text)
