//! Functions of motors over many rows.
//!
//! A motor is an even element of an algebra with generators a, b, c of square 1 and n of square 0. With
//! `I₃ = abc` and `J = I₃ n` it is `s + I₃ b + m n + p J`. The number `ε = −J` has ε² = 0 and commutes with even elements,
//! and `m n = ε I₃ m`. So a motor is a rotor whose components are dual numbers, `(s − εp) + I₃ (b + εm)`, and every
//! function f of numbers continues to `f(x + εy) = f(x) + ε y f′(x)` (Clifford, 1873; Study, 1903): see `formulas`.
//!
//! Rows outside the range of these formulas, such as logarithms far from norm 1, take the functions of any algebra
//! ([`Calculus`]), which also find the errors.

mod formulas;

use crate::error::MathError;
use crate::g3::functions::Function;
use crate::g3::values::scale_of;
use crate::general::Calculus;
use crate::product::Grades;
use crate::rows::rotor_functions;
use crate::simd::map::{BUILT_WITH_FMA, Map, alone, lanes_of_one, run};
use crate::simd::threads::Threads;
use crate::simd::{Element, Path};
use crate::table::Algebra;
use formulas::Parts;
use std::array::from_fn;

/// Numbers of a row of a motor: its scalar, bivector and pseudoscalar, in the order of the basis.
pub use formulas::SIZE;

/// Numbers of a row of a bivector.
pub const BIVECTOR: usize = 6;

/// The grades of motors.
pub const GRADES: Grades = Grades(0b10101);

/// The functions of motors of one algebra.
#[derive(Clone, Debug)]
pub struct Motors {
    /// Where `1, bc, ca, ab, an, bn, cn, J` stand in a row, each with its sign.
    order: [(usize, f64); SIZE],
    /// Where the numbers of a row stand among all components.
    places: [usize; SIZE],
    /// For numbers of double and of single precision.
    calculus: [Calculus; 2],
}

impl Motors {
    /// `None` unless the generators are three of square 1 and one of square 0.
    pub fn new(algebra: &Algebra) -> Option<Motors> {
        let squares = algebra.squares();
        let with = |square: i8| (0..squares.len()).filter(move |&i| squares[i] == square).map(|i| 1 << i);
        let (units, null): (Vec<u32>, Vec<u32>) = (with(1).collect(), with(0).collect());
        let ([a, b, c], [n]) = (<[u32; 3]>::try_from(units).ok()?, <[u32; 1]>::try_from(null).ok()?);
        if squares.len() != 4 {
            return None;
        }
        let held = GRADES.indices(algebra);
        let place = |generators: &[u32]| {
            let (sign, bits) = generators.iter().fold((1, 0), |(sign, bits), &e| {
                let (more, bits) = algebra.blade_product(bits, e);
                (sign * more, bits)
            });
            let at = held.iter().position(|&i| algebra.blades()[i].bits == bits)?;
            Some((at, f64::from(sign * algebra.blades()[held[at]].sign)))
        };
        let elements: [&[u32]; SIZE] =
            [&[], &[b, c], &[c, a], &[a, b], &[a, n], &[b, n], &[c, n], &[a, b, c, n]];
        let mut order = [(0, 1.0); SIZE];
        for (slot, generators) in order.iter_mut().zip(elements) {
            *slot = place(generators)?;
        }
        let double = Calculus::new(algebra);
        let single = double.clone().rounded_to(f32::EPSILON.into());
        Some(Motors { order, places: held.try_into().ok()?, calculus: [double, single] })
    }

    /// A function of rows of motors, or for `exp` of bivectors, as rows of motors. Fails with the index of the first row
    /// that has no value; the result is then unspecified.
    ///
    /// `log M` is the bivector of `M/|M|` with θ in [0, π], plus `ln|M|` unless |M| is 1 to rounding. A δ that is rounding
    /// is removed as by [`Motors::normalize`].
    ///
    /// # Panics
    /// If the numbers of rows do not fit together. One row may stand for all.
    pub fn run<T: Element>(
        &self,
        f: Function,
        threads: Threads,
        rows: &[T],
        out: &mut [T],
    ) -> Result<(), usize> {
        let (of, how) = (self.rounded_to(T::EPSILON), (Path::best(), threads));
        match f {
            Function::Exp => run(Exp(of), how, rows, &[], out),
            Function::Log => run(Log(of), how, rows, &[], out),
            Function::Sqrt => run(Sqrt(of), how, rows, &[], out),
            Function::Inverse => run(Inverse(of), how, rows, &[], out),
        }
    }

    /// `M/√(M ~M)` of rows of even elements, with the dual number `√(M ~M) = |M| + εδ/|M|`. Fails with the first row whose
    /// norm |M| is 0, or that is not finite; the result is then unspecified.
    ///
    /// # Panics
    /// As [`Motors::run`].
    pub fn normalize<T: Element>(&self, threads: Threads, rows: &[T], out: &mut [T]) -> Result<(), usize> {
        run(Normalized(self.rounded_to(T::EPSILON)), (Path::best(), threads), rows, &[], out)
    }

    /// A function of one row, with the bits of [`Motors::run`].
    ///
    /// # Panics
    /// If the row has another length.
    pub fn run_row(&self, f: Function, row: &[f64]) -> Result<[f64; SIZE], MathError> {
        const ONE: &str = "a row of a motor, or for exp of a bivector";
        let of = self.rounded_to(f64::EPSILON);
        let value = match f {
            Function::Exp => Exp(of).value(row.try_into().expect(ONE), []),
            Function::Log => Log(of).value(row.try_into().expect(ONE), []),
            Function::Sqrt => Sqrt(of).value(row.try_into().expect(ONE), []),
            Function::Inverse => Inverse(of).value(row.try_into().expect(ONE), []),
        };
        if value[0].is_nan() { Err(self.error(f, row)) } else { Ok(value) }
    }

    /// [`Motors::normalize`] of one row; `None` if it fails.
    pub fn normalize_row(&self, row: &[f64; SIZE]) -> Option<[f64; SIZE]> {
        let value = Normalized(self.rounded_to(f64::EPSILON)).value(*row, []);
        (!value[0].is_nan()).then_some(value)
    }

    /// Why a row has no value.
    pub fn error<T: Element>(&self, f: Function, row: &[T]) -> MathError {
        let row: Vec<f64> = row.iter().map(|&x| x.into()).collect();
        if f == Function::Exp && row.iter().all(|x| x.is_finite()) {
            return MathError::Overflow;
        }
        let found = self.rounded_to(T::EPSILON).general(f, &row);
        found.err().unwrap_or(MathError::Overflow)
    }

    /// For numbers of this spacing at 1.
    fn rounded_to(&self, epsilon: f64) -> Rounded<'_> {
        Rounded { motors: self, epsilon, calculus: &self.calculus[usize::from(epsilon > f64::EPSILON)] }
    }
}

/// The functions for numbers of some precision.
#[derive(Clone, Copy)]
struct Rounded<'a> {
    motors: &'a Motors,
    /// The spacing of numbers at 1.
    epsilon: f64,
    calculus: &'a Calculus,
}

impl Rounded<'_> {
    /// A function by the methods for any algebra.
    fn general(self, f: Function, row: &[f64]) -> Result<[f64; SIZE], MathError> {
        let places = &self.motors.places;
        let mut all = vec![0.0; self.calculus.size()];
        // A row is a motor, or its bivector.
        for (&place, x) in places[usize::from(row.len() < SIZE)..].iter().zip(row) {
            all[place] = *x;
        }
        let value = self.calculus.apply(f, &all)?;
        Ok(places.map(|place| value[place]))
    }

    /// As [`Rounded::general`], NaN for a row without a value.
    fn any(self, f: Function, row: &[f64]) -> [f64; SIZE] {
        self.general(f, row).unwrap_or([f64::NAN; SIZE])
    }

    /// The lanes of a motor in the order s, b, m, p.
    #[inline(always)]
    fn parts<const W: usize>(self, row: [&[f64; W]; SIZE]) -> Parts<W> {
        let mut parts = [[0.0; W]; SIZE];
        for (part, (at, sign)) in parts.iter_mut().zip(self.motors.order) {
            for l in 0..W {
                part[l] = sign * row[at][l];
            }
        }
        parts
    }

    /// The lanes of a row from those in the order s, b, m, p; the first is NaN where one of them is not finite.
    #[inline(always)]
    fn row<const W: usize>(self, parts: Parts<W>) -> Parts<W> {
        let mut row = [[0.0; W]; SIZE];
        let mut sum = [0.0; W];
        for (part, (at, sign)) in parts.iter().zip(self.motors.order) {
            for l in 0..W {
                row[at][l] = sign * part[l];
                sum[l] += 0.0 * part[l];
            }
        }
        for l in 0..W {
            row[0][l] += sum[l];
        }
        row
    }
}

#[derive(Clone, Copy)]
struct Exp<'a>(Rounded<'a>);

impl Map<BIVECTOR, 0, SIZE> for Exp<'_> {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(
        &self,
        row: [&[f64; W]; BIVECTOR],
        _: [&[f64; W]; 0],
    ) -> Parts<W> {
        let [a, b, c, d, e, f] = row;
        let parts = self.0.parts([&[0.0; W], a, b, c, d, e, f, &[0.0; W]]);
        self.0.row(formulas::exp::<W, FMA>(&parts))
    }

    /// With the unit `u = β/θ`, whose products neither overflow nor vanish.
    fn long(&self, [a, b, c, d, e, f]: [f64; BIVECTOR], _: [f64; 0]) -> [f64; SIZE] {
        let parts = alone(self.0.parts(lanes_of_one(&[0.0, a, b, c, d, e, f, 0.0])));
        let (beta, v): ([f64; 3], [f64; 3]) = (from_fn(|i| parts[1 + i]), from_fn(|i| parts[4 + i]));
        let dot = |x: [f64; 3], y: [f64; 3]| x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
        let scale = scale_of(&beta);
        let size = dot(beta.map(|x| x / scale), beta.map(|x| x / scale)).sqrt();
        let unit = beta.map(|x| x / scale / size);
        let [cosine, turned @ ..] = rotor_functions::Exp.value(beta, []);
        let (sine, along) = (dot(turned, unit), dot(v, unit));
        let sinc = sine / size / scale;
        let moved: [f64; 3] = from_fn(|i| sinc * v[i] + along * (cosine - sinc) * unit[i]);
        let [[x, y, z], [u, v, w]] = [turned, moved];
        alone(self.0.row([cosine, x, y, z, u, v, w, along * sine].map(|x| [x])))
    }
}

#[derive(Clone, Copy)]
struct Log<'a>(Rounded<'a>);

impl Map<SIZE, 0, SIZE> for Log<'_> {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, row: [&[f64; W]; SIZE], _: [&[f64; W]; 0]) -> Parts<W> {
        self.0.row(formulas::log::<W, FMA>(&self.0.parts(row), self.0.epsilon).1)
    }

    fn long(&self, row: [f64; SIZE], _: [f64; 0]) -> [f64; SIZE] {
        self.0.any(Function::Log, &row)
    }
}

/// `√|M| exp(B/2)`.
#[derive(Clone, Copy)]
struct Sqrt<'a>(Rounded<'a>);

impl Map<SIZE, 0, SIZE> for Sqrt<'_> {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, row: [&[f64; W]; SIZE], _: [&[f64; W]; 0]) -> Parts<W> {
        let (squares, mut log) = formulas::log::<W, FMA>(&self.0.parts(row), self.0.epsilon);
        for x in log.iter_mut().flatten() {
            *x *= 0.5;
        }
        let mut root = formulas::exp::<W, FMA>(&log);
        for part in &mut root {
            for l in 0..W {
                part[l] *= squares[l].sqrt().sqrt();
            }
        }
        for l in 0..W {
            root[0][l] += 0.0 * log[0][l]; // NaN where the logarithm is
        }
        self.0.row(root)
    }

    fn long(&self, row: [f64; SIZE], _: [f64; 0]) -> [f64; SIZE] {
        self.0.any(Function::Sqrt, &row)
    }
}

#[derive(Clone, Copy)]
struct Inverse<'a>(Rounded<'a>);

impl Map<SIZE, 0, SIZE> for Inverse<'_> {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, row: [&[f64; W]; SIZE], _: [&[f64; W]; 0]) -> Parts<W> {
        self.0.row(formulas::inverse::<W, FMA>(&self.0.parts(row)))
    }

    fn long(&self, row: [f64; SIZE], _: [f64; 0]) -> [f64; SIZE] {
        self.0.any(Function::Inverse, &row)
    }
}

#[derive(Clone, Copy)]
struct Normalized<'a>(Rounded<'a>);

impl Map<SIZE, 0, SIZE> for Normalized<'_> {
    #[inline(always)]
    fn short<const W: usize, const FMA: bool>(&self, row: [&[f64; W]; SIZE], _: [&[f64; W]; 0]) -> Parts<W> {
        self.0.row(formulas::normalized::<W, FMA>(&self.0.parts(row)))
    }

    /// Scaled so that the norm is in range.
    fn long(&self, row: [f64; SIZE], _: [f64; 0]) -> [f64; SIZE] {
        let rotor: [f64; 4] = from_fn(|k| row[self.0.motors.order[k].0]);
        let scale = scale_of(&rotor);
        if rotor == [0.0; 4] {
            return [f64::NAN; SIZE];
        }
        alone(self.short::<1, BUILT_WITH_FMA>(lanes_of_one(&row.map(|x| x / scale)), []))
    }
}

#[cfg(test)]
mod tests;
