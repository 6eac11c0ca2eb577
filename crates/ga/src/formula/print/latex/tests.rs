use super::{Function, Named, Node, Tight};
use crate::formula::tests::build::*;

#[track_caller]
fn check(node: Node, latex: &str) {
    assert_eq!(node.latex(), latex);
}

#[test]
fn names_have_indices_primes_and_accents() {
    for (name, latex) in [
        ("Ω_B", "\\Omega_{B}"),
        ("a1", "a_{1}"),
        ("f_k'", "f_{k}'"),
        ("omega_body", "\\mathrm{omega}_{\\mathrm{body}}"),
        ("a∥", "a_{\\parallel}"),
        ("R(0)", "R(0)"),
        ("I(Ω_B')", "I(\\Omega_{B}')"),
        ("a\u{302}\u{20d7}_k", "\\vec{\\hat{a}}_{k}"),
        ("T_a_b", "T_{a,b}"),
        ("ω''", "\\omega''"),
    ] {
        check(x(name), latex);
    }
    check(x("I"), "I");
    check(x("e12"), "e_{12}");
}

#[test]
fn a_tilde_stands_over_the_letter_or_after_the_bracket() {
    check(reverse(x("R_1'")), "\\tilde{R}_{1}'");
    check(derivative(reverse(x("R"))), "(\\tilde{R})'");
    check(reverse(x("spin")), "\\widetilde{\\mathrm{spin}}");
    check(reverse(product([x("e1"), x("e2")])), "\\widetilde{e_{1} e_{2}}");
    check(reverse(plus(x("a"), x("b"))), "(a + b)^{\\sim}");
    check(power(reverse(plus(x("a"), x("b"))), 2), "((a + b)^{\\sim})^{2}");
    check(power(reverse(x("R")), 2), "\\tilde{R}^{2}");
}

#[test]
fn tight_products_are_set_close_beside_other_factors() {
    let (a, b) = (|| x("a"), || x("b"));
    check(wedge(a(), b()), "a \\wedge b");
    check(minus(product([x("I"), wedge(a(), b())])), "-I\\,a{\\wedge}b");
    let turned = product([x("R"), tight(Tight::Dot, [x("x"), x("Ω")]), reverse(x("R"))]);
    check(turned, "R\\,x{\\cdot}\\Omega\\,\\tilde{R}");
    let crossed = tight(Tight::Cross, [a(), wedge(a(), b())]);
    check(crossed, "a \\boldsymbol{\\times} (a \\wedge b)");
    check(product([x("R"), plus(a(), b()), x("spin")]), "R\\,(a + b)\\,\\mathrm{spin}");
}

#[test]
fn fractions_and_exponents_need_no_brackets() {
    let sum = || plus(x("a"), x("b"));
    check(over(sum(), product([x("2"), x("c")])), "\\frac{a + b}{2 c}");
    check(minus(product([x("½"), x("Ω_S"), x("R")])), "-\\frac{1}{2} \\Omega_{S} R");
    check(exp(minus(over(x("θ"), x("2")))), "e^{-\\frac{\\theta}{2}}");
    check(power(exp(x("a")), 2), "(e^{a})^{2}");
    check(power(over(x("a"), x("b")), 2), "\\left(\\frac{a}{b}\\right)^{2}");
    check(function(Named::Function(Function::Inverse), sum()), "(a + b)^{-1}");
    check(function(Named::Function(Function::Sqrt), sum()), "\\sqrt{a + b}");
    check(function(Named::Sin, over(x("θ"), x("2"))), "\\sin{\\left(\\frac{\\theta}{2}\\right)}");
    check(function(Named::Dual, x("B")), "\\operatorname{dual}(B)");
    check(function(Named::Norm, minus(x("a"))), "\\left\\Vert -a \\right\\Vert");
}

#[test]
fn numbers_grades_and_sums_over_an_index() {
    check(product([x("2"), x("3"), x("a")]), "2 (3) a");
    check(product([x("1.5e-7"), x("a")]), "1.5 {\\times} 10^{-7} a");
    check(part(over(x("A"), x("B")), 4), "\\left\\langle \\frac{A}{B} \\right\\rangle_{2}");
    check(part(x("A"), 5), "\\langle A \\rangle_{0,2}");
    let sum = total("k", product([x("ω_k"), x("I"), x("e_k")]));
    check(product([sum, x("a")]), "\\left(\\sum_{k} \\omega_{k} I e_{k}\\right)\\,a");
    let equation = tree([x("a"), x("b"), x("c")]);
    assert_eq!(equation.latex(), "a = b = c");
}
