//! Steps on blocks of rows.

use super::steps::{Ready, Selection, Sum, Work, applied};
use crate::g3::functions::Function;
use crate::g3::values::norm;
use crate::graded::Graded;
use crate::product::{Engine, Grades};
use crate::rows::compose::Compose;
use crate::rows::product::{Geometric, Turn};
use crate::rows::rotor_functions::{Cos, Exp, Log, Power, Sin, Tan};
use crate::simd::map;
use crate::simd::{Kernel, Lane, Path};

impl<const W: usize> Kernel<W> for Sum {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        for (out, place) in out.iter_mut().zip(&self.places) {
            match *place {
                [Some(i), Some(j)] => {
                    for l in 0..W {
                        out.0[l] = a[i].0[l] + self.sign * b[j].0[l];
                    }
                }
                [Some(i), None] => out.0 = a[i].0.map(|x| x + self.sign * 0.0),
                [None, Some(j)] => out.0 = b[j].0.map(|y| 0.0 + self.sign * y),
                [None, None] => out.0 = [0.0; W],
            }
        }
    }
}

impl<const W: usize> Kernel<W> for Selection {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], _: &[Lane<W>], out: &mut [Lane<W>]) {
        for (out, place) in out.iter_mut().zip(&self.places) {
            *out = Lane(place.map_or([0.0; W], |(sign, k)| a[k].0.map(|x| sign * x + self.start)));
        }
    }
}

/// Each component over the one of a scalar.
struct Divide;

impl<const W: usize> Kernel<W> for Divide {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], b: &[Lane<W>], out: &mut [Lane<W>]) {
        for (out, a) in out.iter_mut().zip(a) {
            for l in 0..W {
                out.0[l] = a.0[l] / b[0].0[l];
            }
        }
    }
}

/// A matrix, nine lanes, times three.
struct Times;

impl<const W: usize> Kernel<W> for Times {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], m: &[Lane<W>], out: &mut [Lane<W>]) {
        let (a, m, out) = (&a[..3], &m[..9], &mut out[..3]);
        for k in 0..3 {
            let row = &m[3 * k..3 * k + 3];
            for l in 0..W {
                out[k].0[l] = row[0].0[l] * a[0].0[l] + row[1].0[l] * a[1].0[l] + row[2].0[l] * a[2].0[l];
            }
        }
    }
}

/// A number times each component.
struct Scaled;

impl<const W: usize> Kernel<W> for Scaled {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], s: &[Lane<W>], out: &mut [Lane<W>]) {
        for (out, a) in out.iter_mut().zip(a) {
            for l in 0..W {
                out.0[l] = 0.0 + a.0[l] * s[0].0[l];
            }
        }
    }
}

/// The root of the sum of squares; the sum is kept to find rows where it overflows or underflows.
struct Norm;

impl<const W: usize> Kernel<W> for Norm {
    #[inline(always)]
    fn block(&self, a: &[Lane<W>], _: &[Lane<W>], out: &mut [Lane<W>]) {
        let mut sums = [0.0; W];
        for a in a {
            for l in 0..W {
                sums[l] += a.0[l] * a.0[l];
            }
        }
        let mut plain = true;
        for l in 0..W {
            plain &= (1e-290..1e290).contains(&sums[l]);
            out[0].0[l] = sums[l].sqrt();
        }
        if !plain {
            for l in 0..W {
                out[0].0[l] = norm(&row(a, l)[..a.len()]);
            }
        }
    }
}

/// Row `l` of at most eight lanes.
fn row<const W: usize>(lanes: &[Lane<W>], l: usize) -> [f64; 8] {
    std::array::from_fn(|k| lanes.get(k).map_or(0.0, |lane| lane.0[l]))
}

/// Evaluates a function for the first rows, one by one; whether each has a value.
fn function<const W: usize>(
    f: Function,
    grades: [Grades; 2],
    a: &[Lane<W>],
    out: &mut [Lane<W>],
    count: usize,
) -> bool {
    (0..count).all(|l| {
        let argument = Graded::from_fn(grades[0], |k| a[k].0[l]);
        let Ok(value) = applied(f, &argument, grades[1]) else { return false };
        out.iter_mut().zip(value.components()).for_each(|(lane, x)| lane.0[l] = *x);
        true
    })
}

impl Ready {
    /// Evaluates the step for a block of rows, `count` of which matter. False if some row may have no value.
    pub fn block<const W: usize>(
        &self,
        path: Path,
        of: Grades,
        count: usize,
        (a, b, out): (&[Lane<W>], &[Lane<W>], &mut [Lane<W>]),
    ) -> bool {
        match &self.work {
            Work::Input(_) | Work::Constant(_) => {}
            Work::Sum(sum) => path.apply(sum, a, b, out),
            Work::Selection(selection) => path.apply(selection, a, b, out),
            Work::Product(plan) if matches!(plan.engine, Engine::Geometric) => {
                path.apply(&Geometric(plan), a, b, out);
            }
            Work::Product(plan) => path.apply(plan, a, b, out),
            Work::Compose => path.apply(&Compose, a, b, out),
            Work::Turn => path.apply(&Turn(self.grades), a, b, out),
            Work::Divide => {
                path.apply(&Divide, a, b, out);
                return b[0].0.iter().all(|x| *x != 0.0);
            }
            Work::Exp => return map::block(Exp, path, a, &[], out),
            Work::Log => return map::block(Log, path, a, &[], out),
            Work::Power(t) => return map::block(Power, path, a, &[Lane::filled(*t)], out),
            Work::Function(f) => return function(*f, [of, self.grades], a, out, count),
            Work::Norm => path.apply(&Norm, a, b, out),
            Work::Sin => return map::block(Sin, path, a, &[], out),
            Work::Cos => return map::block(Cos, path, a, &[], out),
            Work::Tan => return map::block(Tan, path, a, &[], out),
            Work::Map(_) if b.len() == 9 => path.apply(&Times, a, b, out),
            Work::Map(_) => path.apply(&Scaled, a, b, out),
        }
        true
    }
}
