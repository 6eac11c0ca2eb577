//! Rotors: the unit even elements, which rotate by `X ↦ R X ~R`.
//!
//! `R = exp(−Bθ/2)` turns by `θ` in the plane and sense of the unit bivector `B` (handout eq. 2.4).
//! Active; `S*R` turns by `R` first. Components `(1, e2e3, e3e1, e1e2)`. `R` and `−R` turn alike.
//!
//! Since `B1 B2 = −B3` for the basis planes, the quaternion units are `i = −e2e3`, `j = −e3e1`,
//! `k = −e1e2`, and the rotor of the quaternion `w + xi + yj + zk` is `w − x e2e3 − y e3e1 − z e1e2`.

use super::values::{Bivector, Multivector, Vector, norm, operator, scale_of};
use crate::error::{MATRIX_TOLERANCE, MathError};
use crate::rows::rotor_functions;
use std::ops::{Mul, Neg};

/// A squared norm within this of 1 is not rescaled: the rounding of a product of rotors and of the squares.
const UNIT_SQUARED: f64 = 8.0 * f64::EPSILON;

/// A unit even element `s + b`; the constructors keep it so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    scalar: f64,
    bivector: Bivector,
}

impl Rotor {
    /// The identity.
    pub const IDENTITY: Rotor = Rotor { scalar: 1.0, bivector: Bivector([0.0; 3]) };

    /// From components `(1, e2e3, e3e1, e1e2)`, divided by their norm unless it is 1 to rounding.
    pub fn from_components(c: [f64; 4]) -> Result<Rotor, MathError> {
        if !c.iter().all(|x| x.is_finite()) {
            return Err(MathError::NotFinite);
        }
        let length = norm(&c);
        if length == 0.0 {
            return Err(MathError::ZeroRotor);
        }
        if (length - 1.0).abs() <= 4.0 * f64::EPSILON {
            return Ok(Rotor::from_unit_components(c));
        }
        // Scaling by a power of two keeps the quotient accurate for subnormal components.
        let scale = scale_of(&c);
        let d = c.map(|x| x / scale);
        let n = norm(&d);
        Ok(Rotor::from_unit_components(d.map(|x| x / n)))
    }

    /// From components of norm 1 to rounding, which is not checked.
    #[inline]
    pub fn from_unit_components([s, x, y, z]: [f64; 4]) -> Rotor {
        Rotor { scalar: s, bivector: Bivector([x, y, z]) }
    }

    /// The components `(1, e2e3, e3e1, e1e2)`.
    #[inline]
    pub fn components(self) -> [f64; 4] {
        let [x, y, z] = self.bivector.0;
        [self.scalar, x, y, z]
    }

    /// `exp(B)`: turns by `−2|B|` in the plane of `B`, i.e. by `θ` in the plane `P` for `B = −Pθ/2`. Each
    /// component is within 2 ulps, however large the angle or near to a quarter turn.
    pub fn exp(b: Bivector) -> Rotor {
        Rotor::from_unit_components(rotor_functions::exp_one(b.0))
    }

    /// Turns by `angle` in the plane and sense of `plane`, whose size is ignored.
    pub fn from_plane_angle(plane: Bivector, angle: f64) -> Result<Rotor, MathError> {
        if !angle.is_finite() {
            return Err(MathError::NotFinite);
        }
        let unit = unit3(plane.0).ok_or(MathError::NoPlane)?;
        let (sin, cos) = (0.5 * angle).sin_cos();
        Ok(Rotor { scalar: cos, bivector: Bivector(unit) * -sin })
    }

    /// Turns the direction of `a` into that of `b` in the plane `a∧b`; for opposite directions in a
    /// plane through `a` and the basis vector farthest from it.
    ///
    /// For unit vectors `c = a + b` halves the angle, and `R = ĉ a` reflects twice. For angles near π the rounding of
    /// the small `c` along `d = a − b`, to which it is perpendicular, is removed.
    pub fn from_vectors(a: Vector, b: Vector) -> Result<Rotor, MathError> {
        let a = Vector(unit3(a.0).ok_or(MathError::NoDirection)?);
        let b = Vector(unit3(b.0).ok_or(MathError::NoDirection)?);
        let (sum, difference) = (a + b, a - b);
        let mut c = sum;
        if difference.norm_squared() > 1.0 {
            c = sum - difference * (sum.dot(difference) / difference.norm_squared());
        }
        if c.norm() < f64::EPSILON {
            let farthest = (0..3).min_by(|&i, &j| a.0[i].abs().total_cmp(&a.0[j].abs())).unwrap_or(0);
            let mut axis = Vector::default();
            axis.0[farthest] = 1.0;
            c = axis - a * axis.dot(a);
        }
        let c = c / c.norm();
        let w = c.wedge(a).0;
        Rotor::from_components([c.dot(a), w[0], w[1], w[2]])
    }

    /// The rotor of a rotation matrix (`m[i][j]` multiplies component j), or of the rotation nearest to
    /// it when it is one within [`MATRIX_TOLERANCE`]. The scalar part is >= 0.
    pub fn from_matrix(m: [[f64; 3]; 3]) -> Result<Rotor, MathError> {
        if !m.iter().flatten().all(|x| x.is_finite()) {
            return Err(MathError::NotFinite);
        }
        let column = |j: usize| Vector([m[0][j], m[1][j], m[2][j]]);
        let deviation_at = |(i, j)| (column(i).dot(column(j)) - f64::from(i == j)).abs();
        let pairs = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        let deviation = pairs.map(deviation_at).fold(0.0, f64::max);
        if deviation > MATRIX_TOLERANCE {
            return Err(MathError::NotOrthogonal { deviation });
        }
        if column(0).cross(column(1)).dot(column(2)) < 0.0 {
            return Err(MathError::Reflection);
        }
        Ok(Rotor::from_orthogonal(nearest_rotation(m)))
    }

    /// Shepperd's method: of 4s², 4x², 4y², 4z² start from the largest, which is at least 1.
    fn from_orthogonal(m: [[f64; 3]; 3]) -> Rotor {
        let trace = m[0][0] + m[1][1] + m[2][2];
        let squares = [
            1.0 + trace,
            1.0 + 2.0 * m[0][0] - trace,
            1.0 + 2.0 * m[1][1] - trace,
            1.0 + 2.0 * m[2][2] - trace,
        ];
        let largest = (0..4).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
        // Components of the quaternion (w, x, y, z) times 4 × its largest one.
        let (p, q, r) = (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]);
        let (u, v, w) = (m[2][1] + m[1][2], m[0][2] + m[2][0], m[1][0] + m[0][1]);
        let quaternion = match largest {
            0 => [squares[0], p, q, r],
            1 => [p, squares[1], w, v],
            2 => [q, w, squares[2], u],
            _ => [r, v, u, squares[3]],
        };
        let sign = if quaternion[0] < 0.0 { -1.0 } else { 1.0 };
        let length = sign * norm(&quaternion);
        let [s, x, y, z] = quaternion.map(|c| c / length);
        Rotor { scalar: s, bivector: Bivector([-x, -y, -z]) }
    }

    /// The matrix of `x ↦ R x ~R` on columns: `(w² − b²) x + 2 b (b·x) + 2w b x x` for the quaternion `w + b`.
    ///
    /// The squares on the diagonal are subtracted, so that turns by 90° have exact zeros there; `1 − 2(y² + z²)` would
    /// leave a rounding.
    pub fn to_matrix(self) -> [[f64; 3]; 3] {
        let [w, x, y, z] = self.to_quaternion_wxyz();
        [
            [(w * w + x * x) - (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), (w * w + y * y) - (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), (w * w + z * z) - (x * x + y * y)],
        ]
    }

    /// From the unit quaternion `(w, x, y, z)`, Hamilton's, active.
    pub fn from_quaternion_wxyz([w, x, y, z]: [f64; 4]) -> Result<Rotor, MathError> {
        Rotor::from_components([w, -x, -y, -z])
    }

    /// The quaternion `(w, x, y, z)`, Hamilton's, active.
    pub fn to_quaternion_wxyz(self) -> [f64; 4] {
        let [s, x, y, z] = self.components();
        [s, -x, -y, -z]
    }

    /// From the vector along the axis whose length is the angle.
    pub fn from_rotation_vector(v: Vector) -> Result<Rotor, MathError> {
        if !v.0.iter().all(|x| x.is_finite()) {
            return Err(MathError::NotFinite);
        }
        Ok(Rotor::exp(v.undual() * -0.5))
    }

    /// The vector along the axis whose length is the angle, at most π: the shorter way round.
    pub fn to_rotation_vector(self) -> Vector {
        let shorter = if self.scalar < 0.0 { -self } else { self };
        shorter.log().dual() * -2.0
    }

    /// `log R`, the bivector with `exp(log R) = R` and `|log R| <= π`, on the double cover; `log(−1) = π e1e2` by
    /// convention. Each component is within 2 ulps.
    pub fn log(self) -> Bivector {
        Bivector(rotor_functions::log_one(self.components()))
    }

    /// The unit plane `B` and the angle `θ` in [0, 2π] with `R = exp(−Bθ/2)`. For `R = ±1`, e1e2.
    pub fn plane_angle(self) -> (Bivector, f64) {
        let size = self.bivector.norm();
        let angle = 2.0 * size.atan2(self.scalar);
        if size == 0.0 {
            return (Bivector([0.0, 0.0, 1.0]), angle);
        }
        (-self.bivector / size, angle)
    }

    /// `~R`, the inverse turn.
    pub fn reverse(self) -> Rotor {
        Rotor { scalar: self.scalar, bivector: -self.bivector }
    }

    /// `R a ~R`. With `q` the axial vector of the quaternion: `a + 2s q x a + 2 q x (q x a)`.
    #[inline]
    pub fn apply(self, a: Vector) -> Vector {
        let q = -self.bivector.dual();
        let t = q.cross(a) * 2.0;
        a + t * self.scalar + q.cross(t)
    }

    /// `R B ~R` (handout eq. 2.6): the dual vector turns with the plane.
    pub fn apply_bivector(self, b: Bivector) -> Bivector {
        self.apply(b.dual()).undual()
    }

    /// `R M ~R`: scalar and trivector stay.
    pub fn apply_multivector(self, m: Multivector) -> Multivector {
        let (Vector(a), Bivector(b)) = (self.apply(m.vector_part()), self.apply_bivector(m.bivector_part()));
        Multivector([m.0[0], a[0], a[1], a[2], b[0], b[1], b[2], m.0[7]])
    }

    /// `S*R`, rescaled by `(1 + x)^(−½) = 1 − x/2 + 3x²/8 − …` if its norm differs from 1 by more than the rounding of
    /// one product, as for rotors of single precision.
    #[inline(always)]
    pub fn compose(self, r: Rotor) -> Rotor {
        let product = self * r;
        let [s, x, y, z] = product.components();
        let excess = s * s + x * x + y * y + z * z - 1.0;
        let missing = if excess.abs() > UNIT_SQUARED { excess * (0.375 * excess - 0.5) } else { 0.0 };
        let [s, x, y, z] = [s, x, y, z].map(|c| c + c * missing);
        Rotor { scalar: s, bivector: Bivector([x, y, z]) }
    }

    /// Rescaled by one Newton step towards norm 1: removes the rounding of many products.
    pub fn renormalized(self) -> Rotor {
        let c = self.components();
        let excess = c.iter().map(|x| x * x).sum::<f64>() - 1.0;
        // Adding rounds shrinking and growing alike; multiplying by 1 + x would not.
        let missing = -0.5 * excess;
        Rotor {
            scalar: self.scalar + self.scalar * missing,
            bivector: self.bivector + self.bivector * missing,
        }
    }
}

// `S*R`, which turns by `R` first; `AB = A·B + A×B` for bivectors.
operator!(Mul::mul(left: Rotor, right: Rotor) -> Rotor {
    let (s, a, t, b) = (left.scalar, left.bivector, right.scalar, right.bivector);
    Rotor { scalar: s * t + a.dot(b), bivector: b * s + a * t + a.commutator(b) }
});
operator!(Neg::neg(r: Rotor) -> Rotor { Rotor { scalar: -r.scalar, bivector: -r.bivector } });

impl From<Rotor> for Multivector {
    fn from(r: Rotor) -> Multivector {
        let mut m = Multivector::from(r.bivector);
        m.0[0] = r.scalar;
        m
    }
}

/// The direction of three finite components that are not all zero.
fn unit3(c: [f64; 3]) -> Option<[f64; 3]> {
    let scale = scale_of(&c);
    let d = c.map(|x| x / scale);
    let length = norm(&d);
    (length > 0.0 && length.is_finite()).then(|| d.map(|x| x / length))
}

/// The orthogonal factor of the polar decomposition by Newton's iteration `X ← ½(X + X⁻ᵀ)`, which
/// converges quadratically (Higham 1986); from within 1e-4 three steps reach rounding.
fn nearest_rotation(mut m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    for _ in 0..3 {
        let rows = m.map(Vector);
        // Rows of the cofactor matrix are cross products; X⁻ᵀ is cofactor / determinant.
        let cofactor = [rows[1].cross(rows[2]), rows[2].cross(rows[0]), rows[0].cross(rows[1])];
        let determinant = rows[0].dot(cofactor[0]);
        m = [0, 1, 2].map(|i| ((rows[i] + cofactor[i] / determinant) * 0.5).0);
    }
    m
}
