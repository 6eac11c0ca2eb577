"""GLSL of formulas, compiled by the browser as a shader of WebGL 2."""

from formula_cases import CASES

COMPILE = """(code) => {
    const gl = document.createElement("canvas").getContext("webgl2");
    const shader = gl.createShader(gl.FRAGMENT_SHADER);
    gl.shaderSource(shader, code);
    gl.compileShader(shader);
    return gl.getShaderParameter(shader, gl.COMPILE_STATUS) ? "" : gl.getShaderInfoLog(shader);
}"""


def test_code_of_formulas_compiles(browser):
    codes = [case.formula().code("glsl", f"case{i}", **case.kinds) for i, case in enumerate(CASES)]
    head = "#version 300 es\nprecision highp float;\nout vec4 colour;\n"
    main = (
        "void main() { float moved[3]; case0(float[4](1.0, 0.0, 0.0, 0.0), float[3](1.0, 2.0, 3.0), moved);\n"
    )
    page = browser.new_page()
    assert page.evaluate(COMPILE, head + "\n".join(codes) + main + "colour = vec4(moved[0]); }\n") == ""
    assert "syntax error" in page.evaluate(COMPILE, head + "void main() { colour = ; }\n")
    page.close()
