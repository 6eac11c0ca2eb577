//! Motions in closed form, one in each lane: their coefficients and set-up, the sums that end every form, and products of
//! rotors.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::lanes::{Phase, in_lane};
use polhode_ga::rows::curve::TOGETHER;
use std::array::from_fn;

/// Coefficients of `C` motions of one form, one in each lane; with `C = 1` they are common to all lanes, which hold times.
pub(crate) trait Coefficients<const C: usize>: Copy + Sync {
    /// Those of one motion.
    type One: Coefficients<1>;

    /// Zeros.
    fn empty() -> Self;

    /// All coefficients, always in the same order.
    fn each(&mut self) -> impl Iterator<Item = &mut [f64; C]>;

    /// Puts a motion into lane l.
    fn put(&mut self, l: usize, motion: &Self::One) {
        let (mut motion, mut numbers) = (*motion, [0.0; MOST]);
        // One after the other: iterating two chains together is several times slower.
        zip_through(motion.each(), &mut numbers, |one, number| *number = one[0]);
        zip_through(self.each(), &mut numbers, |lanes, number| lanes[l] = *number);
    }

    /// Puts motions from other lanes into lanes `first` and up.
    fn put_from(&mut self, first: usize, from: &mut Self, lanes: &[usize]) {
        // Coefficient by coefficient, which is one pass through the memory of both.
        let mut sources = [const { None }; MOST];
        let mut count = 0;
        from.each().for_each(|lanes| {
            sources[count] = Some(lanes);
            count += 1;
        });
        let mut sources = sources.iter().flatten();
        self.each().for_each(|to| {
            if let Some(from) = sources.next() {
                for (to, &l) in to[first..].iter_mut().zip(lanes) {
                    // Less than C, which the compiler does not know.
                    *to = from[l % C];
                }
            }
        });
    }

    /// The motion in lane l.
    fn take(mut self, l: usize) -> Self::One {
        let mut motion = Self::One::empty();
        let mut numbers = [0.0; MOST];
        zip_through(self.each(), &mut numbers, |lanes, number| *number = lanes[l]);
        zip_through(motion.each(), &mut numbers, |one, number| *one = [*number]);
        motion
    }
}

/// The numbers of each lane, component by component.
#[inline(always)]
pub(crate) fn by_component<const K: usize, const W: usize>(of: impl Fn(usize) -> [f64; K]) -> [[f64; W]; K] {
    let mut components = [[0.0; W]; K];
    for l in 0..W {
        let numbers = of(l);
        for k in 0..K {
            components[k][l] = numbers[k];
        }
    }
    components
}

/// Most coefficients of a motion.
const MOST: usize = 128;

/// Calls a function of each element and the next number, by internal iteration.
fn zip_through<T>(
    each: impl Iterator<Item = T>,
    numbers: &mut [f64; MOST],
    mut function: impl FnMut(T, &mut f64),
) {
    let mut count = 0;
    each.for_each(|element| {
        function(element, &mut numbers[count]);
        count += 1;
    });
}

/// Motions in lanes that are set up from bodies.
pub(crate) trait SetUp {
    /// What a motion follows from.
    type Body: Copy;

    /// Whether all invariants of the orbit, with their low parts, are in the range of floats.
    fn is_moderate(body: &Self::Body) -> bool;

    /// Replaces the motions by those of moderate bodies. Each has the bits that it has alone. None if lanes do not pay on
    /// this machine.
    fn set_up_together(&mut self, bodies: &[Self::Body; TOGETHER]) -> Option<()>;

    /// Replaces the motion in lane l.
    fn set_up_alone(&mut self, l: usize, body: &Self::Body);

    /// Replaces the first motions by those of other bodies. Lanes beyond the number of bodies hold any, and their motions are
    /// arbitrary.
    fn set_up(&mut self, bodies: &[Self::Body; TOGETHER], count: usize) {
        let mut alone = bodies.each_ref().map(|body| !Self::is_moderate(body));
        if let Some(moderate) = alone.iter().position(|alone| !alone) {
            // Every lane needs a body.
            let together = from_fn(|l| bodies[if alone[l] { moderate } else { l }]);
            if self.set_up_together(&together).is_none() {
                alone = [true; TOGETHER];
            }
        }
        for l in 0..count {
            if alone[l] {
                self.set_up_alone(l, &bodies[l]);
            }
        }
    }
}

/// The least rate, or component of a rotor, of moderate bodies, in units of the largest: below the rounding of any sum, and its
/// sixth power far from the smallest floats.
pub(crate) const LEAST_RATE: f64 = 1e-20;

/// Whether the sizes of numbers are 0 or within bounds.
#[inline(always)]
pub(crate) fn are_within(numbers: &[f64], least: f64, most: f64) -> bool {
    let mut are_within = true;
    for x in numbers {
        are_within &= (*x == 0.0) | ((x.abs() >= least) & (x.abs() <= most));
    }
    are_within
}

/// The [`Phase`] of each motion by numbers: two of the rate, two of the start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Phases<const C: usize>(pub [[f64; C]; 4]);

impl<const C: usize> Phases<C> {
    /// Phases that stay 0.
    pub const STILL: Phases<C> = Phases([[0.0; C]; 4]);

    /// That of lane l.
    #[inline(always)]
    pub fn of(&self, l: usize) -> Phase {
        let rate = DoubleDouble { hi: in_lane(&self.0[0], l), lo: in_lane(&self.0[1], l) };
        Phase { rate, start: [in_lane(&self.0[2], l), in_lane(&self.0[3], l)] }
    }
}

impl From<Phase> for Phases<1> {
    fn from(Phase { rate, start }: Phase) -> Phases<1> {
        Phases([[rate.hi], [rate.lo], [start[0]], [start[1]]])
    }
}

/// The rotor along `Σ m_ij z_j`.
#[inline(always)]
pub(crate) fn unit_rotor<const W: usize, const C: usize>(
    m: &[[[f64; C]; 4]; 4],
    z: &[[f64; W]; 4],
) -> [[f64; W]; 4] {
    let mut rotor = [[0.0; W]; 4];
    for l in 0..W {
        let mut r = [0.0; 4];
        for k in 0..4 {
            let [a, b, c, d] = &m[k];
            r[k] = (in_lane(a, l) * z[0][l] + in_lane(b, l) * z[1][l])
                + (in_lane(c, l) * z[2][l] + in_lane(d, l) * z[3][l]);
        }
        let square = (r[0] * r[0] + r[1] * r[1]) + (r[2] * r[2] + r[3] * r[3]);
        let factor = 1.0 / square.sqrt();
        for k in 0..4 {
            rotor[k][l] = r[k] * factor;
        }
    }
    rotor
}

/// `Σ m_ij f_j`.
#[inline(always)]
pub(crate) fn mapped<const W: usize, const C: usize>(
    m: &[[[f64; C]; 3]; 3],
    f: &[[f64; W]; 3],
) -> [[f64; W]; 3] {
    let mut sum = [[0.0; W]; 3];
    for k in 0..3 {
        let [x, y, z] = &m[k];
        for l in 0..W {
            sum[k][l] = (in_lane(x, l) * f[0][l] + in_lane(y, l) * f[1][l]) + in_lane(z, l) * f[2][l];
        }
    }
    sum
}

/// Products of rotors.
#[inline(always)]
pub(crate) fn product<const W: usize>(a: &[[f64; W]; 4], b: &[[f64; W]; 4]) -> [[f64; W]; 4] {
    let mut result = [[0.0; W]; 4];
    for l in 0..W {
        let ([s, x, y, z], [t, u, v, w]) =
            ([a[0][l], a[1][l], a[2][l], a[3][l]], [b[0][l], b[1][l], b[2][l], b[3][l]]);
        // Basis planes B1 B2 = −B3.
        result[0][l] = s * t - x * u - y * v - z * w;
        result[1][l] = s * u + x * t - (y * w - z * v);
        result[2][l] = s * v + y * t - (z * u - x * w);
        result[3][l] = s * w + z * t - (x * v - y * u);
    }
    result
}

/// Reverses of rotors.
#[inline(always)]
pub(crate) fn reverse<const W: usize>(a: &[[f64; W]; 4]) -> [[f64; W]; 4] {
    let mut result = *a;
    for k in 1..4 {
        for l in 0..W {
            result[k][l] = -a[k][l];
        }
    }
    result
}

/// The planes `R B ~R`: [`polhode_ga::Rotor::apply_bivector`].
#[inline(always)]
pub(crate) fn turned<const W: usize>(rotor: &[[f64; W]; 4], plane: &[[f64; W]; 3]) -> [[f64; W]; 3] {
    let mut result = [[0.0; W]; 3];
    for l in 0..W {
        let (s, [x, y, z]) = (rotor[0][l], [-rotor[1][l], -rotor[2][l], -rotor[3][l]]);
        let [a, b, c] = [plane[0][l], plane[1][l], plane[2][l]];
        let [t, u, v] = [2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)];
        result[0][l] = a + s * t + (y * v - z * u);
        result[1][l] = b + s * u + (z * t - x * v);
        result[2][l] = c + s * v + (x * u - y * t);
    }
    result
}

#[cfg(test)]
pub(in crate::exact) mod tests;
