use super::*;
use crate::formula::tests::build::*;

#[track_caller]
fn check(node: Node, unicode: &str, ascii: &str) {
    assert_eq!(node.text(Style::Unicode), unicode);
    assert_eq!(node.text(Style::Ascii), ascii);
}

#[test]
fn formulas_print_as_on_paper() {
    let turned = product([x("R"), x("v"), reverse(x("R"))]);
    let inner = tight(Tight::Dot, [wedge(x("a"), x("b")), x("c")]);
    check(plus(turned, inner), "R v ~R + (a∧b)·c", "R v ~R + (a^b)|c");
    check(minus(product([x("½"), x("Ω_S"), x("R")])), "−½ Ω_S R", "-1/2 Ω_S R");
    check(minus(product([x("I"), wedge(x("a"), x("b"))])), "−I a∧b", "-I a^b");
    let half_turn = minus(product([over(x("θ"), x("2")), wedge(x("e1"), x("e2"))]));
    check(product([exp(half_turn), x("e1")]), "exp(−θ/2 e1∧e2) e1", "exp(-θ/2 e1^e2) e1");
    check(tight(Tight::Wedge, [x("a"), x("b"), x("c")]), "a∧b∧c", "a^b^c");
    check(part(product([x("A"), x("B")]), 4), "⟨A B⟩_2", "<A B>_2");
    check(part(x("A"), 1), "⟨A⟩", "<A>");
    check(part(x("A"), 5), "⟨A⟩_{0,2}", "<A>_{0,2}");
    check(product([power(x("a"), -1), power(x("B"), 12)]), "a⁻¹ B¹²", "a^-1 B^12");
    check(product([x("2"), x("π"), x("e12")]), "2 π e12", "2 pi e12");
    let equation = tree([derivative(product([x("R"), x("S")])), x("T'")]);
    assert_eq!(equation.text(Style::Unicode), "(R S)' = T'");
}

#[test]
fn signs_that_a_keyboard_lacks_are_functions() {
    let (a, b) = (|| x("a"), || x("b"));
    check(tight(Tight::Dot, [a(), b()]), "a·b", "a|b");
    let product = product([tight(Tight::Commutator, [a(), minus(b())]), x("c")]);
    check(product, "a×(−b) c", "commutator(a, -b) c");
    check(tight(Tight::Cross, [a(), b()]), "a⨯b", "cross(a, b)");
    let contracted = tight(Tight::LeftContraction, [a(), b()]);
    check(power(contracted, 2), "(a⌋b)²", "left_contraction(a, b)^2");
    check(tight(Tight::RightContraction, [a(), wedge(a(), b())]), "a⌊(a∧b)", "right_contraction(a, a^b)");
}

#[test]
fn brackets_stand_where_they_are_needed() {
    let (a, b, c) = (|| x("a"), || x("b"), || x("c"));
    check(product([plus(a(), b()), minus(c())]), "(a + b) (−c)", "(a + b) (-c)");
    check(plus(minus(a()), plus(b(), c())), "(−a) + (b + c)", "(-a) + (b + c)");
    check(product([a(), product([b(), c()])]), "a (b c)", "a (b c)");
    check(product([over(a(), b()), c()]), "a/b c", "a/b c");
    check(product([c(), over(a(), b())]), "c (a/b)", "c (a/b)");
    check(over(product([a(), b()]), c()), "a b/c", "a b/c");
    check(over(over(a(), b()), product([b(), c()])), "a/b/(b c)", "a/b/(b c)");
    check(wedge(wedge(a(), b()), over(a(), c())), "(a∧b)∧(a/c)", "(a^b)^(a/c)");
    check(reverse(power(a(), 2)), "~a²", "~a^2");
    check(power(reverse(a()), 2), "(~a)²", "(~a)^2");
    check(power(power(a(), 2), 3), "(a²)³", "(a^2)^3");
    check(derivative(a()), "(a)'", "(a)'");
    check(wedge(a(), reverse(b())), "a∧~b", "a^~b");
    check(reverse(reverse(wedge(a(), b()))), "~~(a∧b)", "~~(a^b)");
}

#[test]
fn a_sum_over_an_index_takes_the_product_after_it() {
    let one = || total("k", product([x("ω_k"), x("I"), x("e_k")]));
    check(one(), "Σ_k ω_k I e_k", "sum_k ω_k I e_k");
    check(total("k", plus(x("a_k"), x("b"))), "Σ_k (a_k + b)", "sum_k (a_k + b)");
    check(plus(one(), x("b")), "Σ_k ω_k I e_k + b", "sum_k ω_k I e_k + b");
    check(product([x("½"), one()]), "½ Σ_k ω_k I e_k", "1/2 sum_k ω_k I e_k");
    check(product([one(), x("b")]), "(Σ_k ω_k I e_k) b", "(sum_k ω_k I e_k) b");
    check(over(product([x("a"), one()]), x("b")), "a (Σ_k ω_k I e_k)/b", "a (sum_k ω_k I e_k)/b");
}

#[test]
fn numbers_stay_apart_and_are_no_exponents() {
    check(product([x("2"), x("3"), x("a")]), "2 * 3 a", "2 * 3 a");
    check(product([power(x("2"), 3), x("½")]), "2³ ½", "2^3 (1/2)");
    check(product([over(x("a"), x("2")), x("3")]), "a/2 * 3", "a/2 * 3");
    check(power(x("½"), 2), "(½)²", "(1/2)^2");
    check(power(x("0.1"), 2), "(0.1)²", "(0.1)^2");
    check(over(x("½"), x("½")), "½/½", "1/2/(1/2)");
    check(wedge(x("2"), x("a")), "2∧a", "2^a");
    check(wedge(x("a"), x("2")), "a∧2", "wedge(a, 2)");
    check(wedge(x("a"), minus(x("2"))), "a∧(−2)", "wedge(a, -2)");
    check(wedge(x("a"), power(x("2"), 2)), "a∧2²", "wedge(a, 2^2)");
    check(product([x("1e-7"), x("a")]), "1e-7 a", "1e-7 a");
}

#[test]
fn functions_keep_their_brackets_and_products_their_space() {
    check(call("V", [x("x"), minus(x("y"))]), "V(x, −y)", "V(x, -y)");
    check(product([x("R"), plus(x("a"), x("b"))]), "R (a + b)", "R (a + b)");
    check(product([x("I"), plus(x("a"), x("b"))]), "I * (a + b)", "I * (a + b)");
    check(product([call("c", []), plus(x("a"), x("b"))]), "c (a + b)", "c (a + b)");
    check(function(Named::Norm, x("a")), "norm(a)", "norm(a)");
    check(function(Named::Reverse, plus(x("a"), x("b"))), "(a + b)~", "(a + b)~");
}
