//! Straight-line arithmetic on numbers, in which equal parts occur once.

use std::collections::HashMap;

/// A number that a line of code can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Atom {
    /// A nonnegative number, by its bits.
    Number(u64),
    /// A component of an input.
    Component(usize, usize),
    /// The result of an earlier line.
    Line(usize),
}

/// An atom, or minus an atom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Scalar {
    pub negative: bool,
    pub atom: Atom,
}

/// The functions of numbers that all languages have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Call {
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Sinh,
    Cosh,
    Atan2,
    Abs,
    Max,
}

/// A line.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Line {
    /// A sum of numbers and of products of two.
    Sum(Vec<(Scalar, Option<Atom>)>),
    Quotient(Scalar, Scalar),
    Call(Call, Vec<Scalar>),
}

impl Scalar {
    pub const ZERO: Scalar = Scalar { negative: false, atom: Atom::Number(0) };

    pub fn new(atom: Atom) -> Scalar {
        Scalar { negative: false, atom }
    }

    pub fn number(x: f64) -> Scalar {
        Scalar { negative: x < 0.0, atom: Atom::Number(x.abs().to_bits()) }
    }

    /// Its value, if it is a number.
    fn value(self) -> Option<f64> {
        match self.atom {
            Atom::Number(bits) if self.negative => Some(-f64::from_bits(bits)),
            Atom::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub fn is_zero(self) -> bool {
        self.value() == Some(0.0)
    }

    /// ±1 times the number.
    pub fn signed(self, sign: i8) -> Scalar {
        Scalar { negative: self.negative ^ (sign < 0 && !self.is_zero()), ..self }
    }
}

/// The lines, each using only earlier ones.
#[derive(Default)]
pub(super) struct Scalars {
    pub lines: Vec<Line>,
    known: HashMap<Line, usize>,
    /// The number of terms of all sums.
    pub terms: usize,
}

impl Scalars {
    fn line(&mut self, line: Line) -> Scalar {
        let next = self.lines.len();
        let number = *self.known.entry(line).or_insert_with_key(|line| {
            self.lines.push(line.clone());
            next
        });
        Scalar::new(Atom::Line(number))
    }

    /// A sum of products. Terms that are 0 and factors 1 are left out.
    pub fn sum(&mut self, products: impl IntoIterator<Item = (Scalar, Scalar)>) -> Scalar {
        let (mut terms, mut constant) = (Vec::new(), 0.0);
        for (a, b) in products {
            let (number, other) = if b.value().is_some() { (b, a) } else { (a, b) };
            match (number.value(), other.value()) {
                (Some(x), Some(y)) => constant += x * y,
                (Some(0.0), None) => {}
                (Some(1.0), None) => terms.push((other, None)),
                (Some(-1.0), None) => terms.push((other.signed(-1), None)),
                _ => {
                    let negative = a.negative ^ b.negative;
                    terms.push((Scalar { negative, atom: number.atom }, Some(other.atom)));
                }
            }
        }
        if constant != 0.0 || terms.is_empty() {
            terms.push((Scalar::number(constant), None));
        }
        self.terms += terms.len();
        if let [(only, None)] = terms[..] { only } else { self.line(Line::Sum(terms)) }
    }

    pub fn plus(&mut self, a: Scalar, b: Scalar) -> Scalar {
        let one = Scalar::number(1.0);
        self.sum([(one, a), (one, b)])
    }

    pub fn times(&mut self, a: Scalar, b: Scalar) -> Scalar {
        self.sum([(a, b)])
    }

    pub fn quotient(&mut self, a: Scalar, b: Scalar) -> Scalar {
        if a.is_zero() { Scalar::ZERO } else { self.line(Line::Quotient(a, b)) }
    }

    pub fn call(&mut self, call: Call, arguments: &[Scalar]) -> Scalar {
        self.line(Line::Call(call, arguments.to_vec()))
    }

    /// Marks the lines that these results need.
    pub fn used(&self, results: &[Scalar]) -> Vec<bool> {
        let mut used = vec![false; self.lines.len()];
        let number = |atom| if let Atom::Line(number) = atom { Some(number) } else { None };
        results.iter().filter_map(|result| number(result.atom)).for_each(|line| used[line] = true);
        for line in (0..self.lines.len()).rev() {
            if used[line] {
                self.lines[line].atoms().filter_map(number).for_each(|line| used[line] = true);
            }
        }
        used
    }
}

impl Line {
    /// The atoms that it uses.
    fn atoms(&self) -> Box<dyn Iterator<Item = Atom> + '_> {
        match self {
            Line::Sum(terms) => Box::new(terms.iter().flat_map(|(a, b)| [Some(a.atom), *b]).flatten()),
            Line::Quotient(a, b) => Box::new([a.atom, b.atom].into_iter()),
            Line::Call(_, arguments) => Box::new(arguments.iter().map(|a| a.atom)),
        }
    }
}
