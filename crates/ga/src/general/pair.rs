//! Squares of bivectors as numbers `x + yU`, with U of grade 4 and `U² = q` a number.
//!
//! With up to five generators a bivector has `B² = s + W`, W of grade 4, and `W²` is a number: complex numbers for q < 0,
//! dual ones for q = 0, split ones for q > 0. All functions are smooth in q, so rotations, boosts and translations need
//! no special cases. Only well above q = 0 the two numbers are kept apart: one may be a large boost, the other a rotation.

/// Above this q the idempotents `½(1 ± U/√q)` split the ring into two numbers, losing three bits.
pub(super) const SPLITS: f64 = 1.0 / 64.0;

/// The ring of the pairs with `U² = q`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub q: f64,
}

/// `x + yU`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub x: f64,
    pub y: f64,
}

impl Pair {
    pub const ZERO: Pair = Pair { x: 0.0, y: 0.0 };
    pub const ONE: Pair = Pair { x: 1.0, y: 0.0 };

    pub fn scale(self, s: f64) -> Pair {
        Pair { x: self.x * s, y: self.y * s }
    }

    pub fn plus(self, o: Pair) -> Pair {
        Pair { x: self.x + o.x, y: self.y + o.y }
    }
}

impl Ring {
    pub fn mul(self, a: Pair, b: Pair) -> Pair {
        Pair { x: a.x * b.x + self.q * (a.y * b.y), y: a.x * b.y + a.y * b.x }
    }

    /// The largest magnitude of the two numbers `x ± y√q`.
    pub fn radius(self, a: Pair) -> f64 {
        let y = a.y * self.q.abs().sqrt();
        if self.q < 0.0 { a.x.hypot(y) } else { a.x.abs() + y.abs() }
    }

    /// `1/a = (x − yU)/(x² − q y²)`.
    pub fn inverse(self, a: Pair) -> Pair {
        let scale = self.radius(a);
        let b = a.scale(1.0 / scale);
        let determinant = b.x * b.x - self.q * b.y * b.y;
        Pair { x: b.x, y: -b.y }.scale(1.0 / determinant / scale)
    }

    /// The root whose numbers `x ± y√q` have positive real part; None if one of those of `a` is 0 or on the negative
    /// axis. With `(u + vU)² = a`: `u² = (x + √(x² − q y²))/2`, `v = y/2u`.
    pub fn sqrt(self, a: Pair) -> Option<Pair> {
        let scale = self.radius(a);
        let b = a.scale(1.0 / scale);
        let root = (b.x * b.x - self.q * b.y * b.y).sqrt();
        // For a negative real part x + |z| = q y²/(x − |z|) avoids cancellation.
        let square = if b.x >= 0.0 { b.x + root } else { self.q * b.y * b.y / (b.x - root) };
        let u = (0.5 * square).sqrt();
        let result = Pair { x: u, y: b.y / (2.0 * u) }.scale(scale.sqrt());
        (u > 0.0 && result.x.is_finite() && result.y.is_finite()).then_some(result)
    }

    /// `Σ cⱼ aʲ`.
    pub fn series(self, coefficients: &[f64], a: Pair) -> Pair {
        coefficients.iter().rev().fold(Pair::ZERO, |sum, &c| self.mul(sum, a).plus(Pair { x: c, y: 0.0 }))
    }
}

#[cfg(test)]
mod tests;
