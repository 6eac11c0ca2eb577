//! Programs of formulas: steps of known grades, each an operation on earlier steps.
//!
//! The same program runs on single values, on blocks of rows, and in Python on other coefficients.

use crate::formula::syntax::names::Type;
use crate::formula::syntax::number::Number;
use crate::formula::syntax::tree::Span;
use crate::g3::functions::Function;
use crate::graded::size;
use crate::product::Product;
use crate::table::Signature;

/// The number of a step, and of its value.
pub type Id = usize;

/// Steps, each using only earlier ones. Equal steps occur once.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The algebra of all its values.
    pub signature: Signature,
    /// Its inputs, in order; only names that it uses.
    pub inputs: Vec<Input>,
    /// The steps.
    pub steps: Vec<Step>,
    /// The value, or the two or more sides of an equation; for an equation in free indices, the sides for each
    /// of their values.
    pub results: Vec<Vec<Id>>,
}

impl Program {
    /// Whether it is an equation.
    pub fn is_equation(&self) -> bool {
        self.results[0].len() > 1
    }
}

/// An input of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// The canonical name.
    pub name: String,
    /// Its kind.
    pub kind: InputKind,
}

/// The kinds of inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A value.
    Value(Type),
    /// The matrix of a linear map on the components of grade 1 or 2, by rows: 9 numbers. On bivectors that of a
    /// map of vectors is the one of its cofactors.
    Matrix {
        /// Of its argument and its value.
        grade: u8,
    },
    /// The determinant of a linear map of vectors: the factor of trivectors.
    Determinant,
}

impl InputKind {
    /// The number of components of a row, in 3-d space.
    pub fn size(self) -> usize {
        match self {
            InputKind::Value(ty) => size(ty.grades),
            InputKind::Matrix { .. } => 9,
            InputKind::Determinant => 1,
        }
    }
}

/// A step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The operation.
    pub op: Op,
    /// The type of its value.
    pub ty: Type,
    /// Its place in the text.
    pub span: Span,
}

/// The operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// An input that is a value, by its number.
    Input(usize),
    /// A number times a basis element, by its index in the basis.
    Constant(Number, usize),
    /// π
    Pi,
    /// A + B, over the grades of both.
    Add(Id, Id),
    /// A − B, over the grades of both.
    Subtract(Id, Id),
    /// −A
    Negate(Id),
    /// A named product; of its grades those of the step's type are kept.
    Product(Product, Id, Id),
    /// The product of two rotors, of norm 1 again.
    Compose(Id, Id),
    /// `R X ~R` with a rotor R: the grades of X.
    Turn(Id, Id),
    /// A divided by the scalar s.
    Divide(Id, Id),
    /// ~A
    Reverse(Id),
    /// The part in the grades of the step's type; missing grades are zero.
    Part(Id),
    /// `A I⁻¹`
    Dual(Id),
    /// `A I`
    Undual(Id),
    /// exp, log, sqrt, inverse.
    Function(Function, Id),
    /// An integer power of a rotor, which is a rotor. Powers of other values are products.
    RotorPower(Id, i32),
    /// `√abs⟨A ~A⟩`
    Norm(Id),
    /// sin of a scalar.
    Sin(Id),
    /// cos of a scalar.
    Cos(Id),
    /// tan of a scalar.
    Tan(Id),
    /// A linear map by its input, a matrix (of a vector or bivector) or a determinant (of a trivector).
    Map {
        /// The number of the input.
        input: usize,
        /// The argument.
        argument: Id,
    },
}

impl Op {
    /// The steps that are its operands.
    pub fn operands(&self) -> impl Iterator<Item = Id> {
        let mut op = *self;
        op.slots().map(|slot| slot.copied()).into_iter().flatten()
    }

    /// References to its operands.
    fn slots(&mut self) -> [Option<&mut Id>; 2] {
        match self {
            Op::Input(_) | Op::Constant(..) | Op::Pi => [None, None],
            Op::Add(a, b)
            | Op::Subtract(a, b)
            | Op::Product(_, a, b)
            | Op::Compose(a, b)
            | Op::Turn(a, b)
            | Op::Divide(a, b) => [Some(a), Some(b)],
            Op::Negate(a)
            | Op::Reverse(a)
            | Op::Part(a)
            | Op::Dual(a)
            | Op::Undual(a)
            | Op::Function(_, a)
            | Op::RotorPower(a, _)
            | Op::Norm(a)
            | Op::Sin(a)
            | Op::Cos(a)
            | Op::Tan(a)
            | Op::Map { argument: a, .. } => [Some(a), None],
        }
    }

    /// Renumbers its operands and inputs.
    pub(crate) fn renumber(&mut self, step: impl Fn(Id) -> Id, mut other_input: impl FnMut(usize) -> usize) {
        for id in self.slots().into_iter().flatten() {
            *id = step(*id);
        }
        if let Op::Input(input) | Op::Map { input, .. } = self {
            *input = other_input(*input);
        }
    }
}
