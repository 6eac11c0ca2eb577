//! A table of torques shared by all bodies in lanes.

use crate::laws::forcing::Place;
use crate::laws::torque::Table;
use crate::laws::torque::lanes::Three;
use polhode_ga::simd::lanes::Lanes;

/// A table with its last value, at a time of a step with this middle.
pub(super) struct CachedTable<'t> {
    pub table: &'t Table,
    at: [f64; 2],
    torque: [f64; 3],
}

impl<'t> CachedTable<'t> {
    pub fn new(table: &'t Table) -> CachedTable<'t> {
        CachedTable { table, at: [f64::NAN; 2], torque: [f64::NAN; 3] }
    }

    /// The torques at the places of all bodies, NaN where the table has none.
    #[inline(never)]
    pub fn at<const W: usize, const F: bool>(
        &mut self,
        place: &Place<W, F>,
        middle: &Lanes<W, F>,
    ) -> Three<W, F> {
        let mut torques = [Lanes::ZERO; 3];
        for l in 0..W {
            let at = [place.time.of(l), middle.0[l]];
            if at != self.at {
                self.at = at;
                self.torque = self.table.within(at[0], at[1]).map_or([f64::NAN; 3], |torque| torque.0);
            }
            for k in 0..3 {
                torques[k].0[l] = self.torque[k];
            }
        }
        torques
    }
}
