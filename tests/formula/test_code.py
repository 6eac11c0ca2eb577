"""Formulas as functions in other languages, compiled, run and compared with the formulas."""

import ctypes
import shutil

import numpy as np
import pytest

import polhode as ph
import processes
from formula_cases import CASES, ROWS
from missing import left_out
from samples import EPS

NAMES = [f"case{i}" for i in range(len(CASES))]
IDS = [f"{case.text} {case.algebra}" for case in CASES]
DOUBLES = ctypes.POINTER(ctypes.c_double)


def sources(language):
    return [
        case.formula().code(language, name, **case.kinds) for case, name in zip(CASES, NAMES, strict=True)
    ]


def arguments(case):
    """Return the arguments in order: numbers of shape (rows,), arrays of shape (rows, components)."""
    found = []
    for name, value in case.values().items():
        if not isinstance(value, ph.LinearMap):
            found.append(getattr(value, "components", value))
            continue
        rows = [value.matrix if value.grade == 1 else value.bivector_matrix]
        if name == "F":  # applied to all grades
            rows = [value.matrix, value.bivector_matrix]
        found += [np.tile(matrix.reshape(9), (ROWS, 1)) for matrix in rows]
        if name == "F":
            found.append(np.full(ROWS, value.determinant))
    return found


def value(case):
    """Return the components of the formula's value, for each row."""
    result = case.formula()(case.values())
    components = result.components if isinstance(result, ph.Multivector) else np.asarray(result)[..., None]
    return np.broadcast_to(components, (ROWS, components.shape[-1]))


def require_near(got, case, eps=EPS):
    expected = value(case)
    # A result is a sum of at most 32² products of four numbers. An inverse of values of size 3 multiplies
    # their rounding by less than 10.
    assert np.all(np.abs(got - expected) <= 1000 * eps * (1 + np.abs(expected).max()))


@pytest.mark.parametrize(("case", "name"), list(zip(CASES, NAMES, strict=True)), ids=IDS)
def test_python_takes_batches_and_single_values(case, name):
    module = {}
    exec(case.formula().code("python", name, **case.kinds), module)
    given = arguments(case)
    size = value(case).shape[-1]
    got = module[name](*given)
    is_number = case.formula().grades(**case.kinds) == (0,)
    require_near(got[..., None] if is_number else got, case)
    first = module[name](*(x[0].tolist() for x in given))
    assert np.shape(first) == (() if is_number else (size,))


def run(library, case, name, number=ctypes.c_double):
    """Return the rows that a compiled function computes."""
    function, size = getattr(library, name), value(case).shape[-1]
    is_number = case.formula().grades(**case.kinds) == (0,)
    function.restype = number if is_number else None
    got = np.empty((ROWS, size))
    for row in range(ROWS):
        given = [
            number(x[row]) if x.ndim == 1 else (number * x.shape[1])(*x[row].tolist())
            for x in arguments(case)
        ]
        result = (number * size)()
        returned = function(*given) if is_number else function(*given, result)
        got[row] = [returned] if is_number else list(result)
    return got


def compiled_c(folder, text, *options):
    compiler = shutil.which("cc")
    if compiler is None:
        left_out("a C compiler was not found")
    (folder / "code.c").write_text(text)
    command = [compiler, "-std=c99", "-Wall", "-Wextra", "-Werror", *options]
    command += ["-shared", "-fPIC", "-o", str(folder / "code.so"), str(folder / "code.c"), "-lm"]
    done = processes.run(command)
    assert done.returncode == 0, done.stderr
    return ctypes.CDLL(str(folder / "code.so"))


def test_c(tmp_path):
    library = compiled_c(tmp_path, "\n".join(sources("c")), "-pedantic", "-Wno-unused-parameter")
    for case, name in zip(CASES, NAMES, strict=True):
        require_near(run(library, case, name), case)


def test_glsl_has_the_arithmetic_of_the_formula(tmp_path):
    """As C, whose functions have other names; tests of the viewer compile it as GLSL."""
    single = ["sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh"]
    other = {"in": "", "out": "", "abs": "fabsf", "max": "fmaxf", "atan": "atan2f"}
    words = other | {name: f"{name}f" for name in single}
    head = "#include <math.h>\n" + "".join(f"#define {name} {word}\n" for name, word in words.items())
    library = compiled_c(tmp_path, head + "\n".join(sources("glsl")), "-Wno-unused-parameter")
    for case, name in zip(CASES, NAMES, strict=True):
        require_near(run(library, case, name, ctypes.c_float), case, 2.0**-23)


def test_rust(tmp_path):
    compiler = shutil.which("rustc")
    if compiler is None:
        left_out("rustc was not found")
    text = "#![deny(warnings)]\n" + "\n".join(sources("rust"))
    for case, name in zip(CASES, NAMES, strict=True):
        kinds = ["f64" if x.ndim == 1 else f"*const [f64; {x.shape[1]}]" for x in arguments(case)]
        names = [f"a{i}" for i in range(len(kinds))]
        head = ", ".join(f"{a}: {kind}" for a, kind in zip(names, kinds, strict=True))
        given = ", ".join(a if kind == "f64" else f"*{a}" for a, kind in zip(names, kinds, strict=True))
        size = value(case).shape[-1]
        if case.formula().grades(**case.kinds) == (0,):
            head, body = f"({head}) -> f64", f"{name}({given})"
        else:
            head, body = f"({head}{', ' if head else ''}out: *mut [f64; {size}])", f"*out = {name}({given})"
        text += f'#[export_name = "{name}"]\npub unsafe extern "C" fn run_{name}{head} {{ {body} }}\n'
    (tmp_path / "code.rs").write_text(text)
    command = [compiler, "--edition", "2021", "--crate-type", "cdylib", "-o", str(tmp_path / "code.so")]
    done = processes.run([*command, str(tmp_path / "code.rs")])
    assert done.returncode == 0, done.stderr
    library = ctypes.CDLL(str(tmp_path / "code.so"))
    for case, name in zip(CASES, NAMES, strict=True):
        require_near(run(library, case, name), case)


def test_small_angles_lose_nothing():
    """At 0 exp and log divide no 0 by 0."""
    module = {}
    exec(ph.formula("exp(B)").code("python", "turn", B=2), module)
    exec(ph.formula("log(R)").code("python", "angle", R="rotor"), module)
    for size in (0.0, 1e-200, 1e-30, 1e-9):
        turn = module["turn"]([0.0, size, 0.0])
        np.testing.assert_allclose(turn, [1.0, 0.0, size, 0.0], rtol=4 * EPS, atol=0)
        np.testing.assert_allclose(module["angle"](turn), [0.0, size, 0.0], rtol=4 * EPS, atol=0)


def test_the_comment_documents_the_arguments():
    f = ph.formula("m R  x ~R")
    lines = f.code("c", "turn", x=1, unused=2, R="rotor", m=0).splitlines()
    assert lines[0] == "// m R x ~R"
    assert "// x: grade 1, components e1, e2, e3" in lines
    assert "// R: rotor, components 1, e23, e31, e12" in lines
    assert "// m: number" in lines
    assert "// returns grade 1, components e1, e2, e3" in lines
    assert "void turn(const double x[3], const double R[4], double m, double result[3]) {" in lines


def test_latex_is_the_formula():
    f = ph.formula("½ m v·v")
    assert f.code("latex", m=0, v=1) == f.spelled("latex", m=0, v=1) == f.latex


def test_errors():
    f = ph.formula("exp(B) x")
    with pytest.raises(ValueError, match=r"one of 'python', 'c', 'rust', 'glsl', 'latex', got 'java'"):
        f.code("java", B=2, x=1)
    for name in ("float", "a b", "t1", "", "f'"):
        with pytest.raises(ValueError, match="must be an ASCII identifier"):
            f.code("c", name, B=2, x=1)
    with pytest.raises(TypeError, match="must be a string"):
        f.code("c", 3, B=2, x=1)
    motor = ph.formula("exp(B) x", algebra=ph.algebra(3, 0, 1))
    with pytest.raises(
        ph.FormulaError, match=r"`exp` of grade 2 in Cl\(3,0,1\) has no formula in numbers"
    ) as info:
        motor.code("c", B=2, x=1)
    assert info.value.span == (0, 6)
    full = tuple(range(9))
    long = ph.formula("M N M N M", algebra=ph.algebra(8))
    with pytest.raises(ph.FormulaError, match="the code would have more than 200000 terms"):
        long.code("c", M=full, N=full)
    with pytest.raises(ph.FormulaError, match="an equation has no value"):
        ph.formula("a b = c").code("c", a=1, b=1, c=(0, 2))
    with pytest.raises(ph.FormulaError, match="grade 2"):
        ph.formula("cross(a∧b, c)").code("rust", a=1, b=1, c=1)
