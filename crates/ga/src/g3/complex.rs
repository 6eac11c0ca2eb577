//! The centre of G3: elements `x + yI` commute with everything and multiply as complex numbers.

use super::values::operator;
use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Complex {
    pub re: f64,
    pub im: f64,
}

impl Complex {
    pub const ONE: Complex = Complex { re: 1.0, im: 0.0 };

    pub fn new(re: f64, im: f64) -> Complex {
        Complex { re, im }
    }

    pub fn norm(self) -> f64 {
        self.re.hypot(self.im)
    }

    pub fn scale(self, s: f64) -> Complex {
        Complex::new(self.re * s, self.im * s)
    }

    pub fn exp(self) -> Complex {
        let (sin, cos) = self.im.sin_cos();
        Complex::new(cos, sin).scale(self.re.exp())
    }

    /// Principal value, imaginary part in [−π, π].
    pub fn ln(self) -> Complex {
        Complex::new(self.norm().ln(), self.im.atan2(self.re))
    }

    /// Principal value, real part >= 0. The larger part is a sum, so neither part cancels.
    pub fn sqrt(self) -> Complex {
        if self.re == 0.0 && self.im == 0.0 {
            return Complex::new(0.0, self.im);
        }
        let large = (0.5 * (self.norm() + self.re.abs())).sqrt();
        let small = self.im.abs() / (2.0 * large);
        if self.re >= 0.0 {
            Complex::new(large, small.copysign(self.im))
        } else {
            Complex::new(small, large.copysign(self.im))
        }
    }

    pub fn cosh(self) -> Complex {
        let (sin, cos) = self.im.sin_cos();
        Complex::new(self.re.cosh() * cos, self.re.sinh() * sin)
    }

    /// `sinh z / z`, 1 at 0.
    pub fn sinhc(self) -> Complex {
        if self.re == 0.0 && self.im == 0.0 {
            return Complex::ONE;
        }
        let (sin, cos) = self.im.sin_cos();
        Complex::new(self.re.sinh() * cos, self.re.cosh() * sin) / self
    }

    /// `artanh z / z`, 1 at 0, for `|z| < 1/2`: `ln((1 + z)/(1 − z)) / 2z` without cancellation.
    pub fn artanhc(self) -> Complex {
        if self.re == 0.0 && self.im == 0.0 {
            return Complex::ONE;
        }
        // (1 + z)/(1 − z) = 1 + w, w = 2z/(1 − z); ln|1 + w| = ½ ln1p(2 Re w + |w|²).
        let w = self.scale(2.0) / (Complex::ONE - self);
        let re = 0.5 * (2.0 * w.re + w.re * w.re + w.im * w.im).ln_1p();
        Complex::new(re, w.im.atan2(1.0 + w.re)).scale(0.5) / self
    }
}

operator!(Add::add(a: Complex, b: Complex) -> Complex { Complex::new(a.re + b.re, a.im + b.im) });
operator!(Sub::sub(a: Complex, b: Complex) -> Complex { Complex::new(a.re - b.re, a.im - b.im) });
operator!(Neg::neg(a: Complex) -> Complex { Complex::new(-a.re, -a.im) });
operator!(Mul::mul(a: Complex, b: Complex) -> Complex {
    Complex::new(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re)
});
// Smith's division, without intermediate overflow.
operator!(Div::div(a: Complex, b: Complex) -> Complex {
    if b.re.abs() >= b.im.abs() {
        let t = b.im / b.re;
        let d = b.re + b.im * t;
        Complex::new((a.re + a.im * t) / d, (a.im - a.re * t) / d)
    } else {
        let t = b.re / b.im;
        let d = b.re * t + b.im;
        Complex::new((a.re * t + a.im) / d, (a.im * t - a.re) / d)
    }
});
