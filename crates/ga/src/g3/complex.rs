//! The centre of G3: elements `x + yI` commute with everything and multiply as complex numbers.

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

impl Add for Complex {
    type Output = Complex;
    fn add(self, o: Complex) -> Complex {
        Complex::new(self.re + o.re, self.im + o.im)
    }
}

impl Sub for Complex {
    type Output = Complex;
    fn sub(self, o: Complex) -> Complex {
        Complex::new(self.re - o.re, self.im - o.im)
    }
}

impl Neg for Complex {
    type Output = Complex;
    fn neg(self) -> Complex {
        Complex::new(-self.re, -self.im)
    }
}

impl Mul for Complex {
    type Output = Complex;
    fn mul(self, o: Complex) -> Complex {
        Complex::new(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)
    }
}

impl Div for Complex {
    type Output = Complex;
    /// Smith's division, without intermediate overflow.
    fn div(self, o: Complex) -> Complex {
        if o.re.abs() >= o.im.abs() {
            let t = o.im / o.re;
            let d = o.re + o.im * t;
            Complex::new((self.re + self.im * t) / d, (self.im - self.re * t) / d)
        } else {
            let t = o.re / o.im;
            let d = o.re * t + o.im;
            Complex::new((self.re * t + self.im) / d, (self.im * t - self.re) / d)
        }
    }
}
