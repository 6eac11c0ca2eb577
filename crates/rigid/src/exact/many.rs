//! Motions in closed form of many bodies in SIMD lanes.
//!
//! One formula serves all motions of a form in any regime: of free bodies, steady rotation and symmetric tops are circular,
//! motions near the separatrix hyperbolic. Motions are stored in tiles, and those of a tile that have the same form in
//! blocks, one motion per lane. A lane depends only on its own numbers, so a state has the same bits as
//! [`ExactMotion::at`].

use super::damped::{DampedMotions, flow::Flow as Damped};
use super::flow::Form;
use super::free::flow::Flow as Free;
use super::free::series::{Circular, Hyperbolic};
use super::free::{FreeBody, FreeMotions};
use super::lagrange::flow::Flow as Lagrange;
use super::lagrange::series::{Circular as LagrangeCircular, Hyperbolic as LagrangeHyperbolic};
use super::lagrange::{HeavyTop, LagrangeTops};
use super::lanes::{Coefficients, SetUp};
use super::larmor::flow::Flow as Larmor;
use super::motion::ExactMotion;
use polhode_ga::rows::curve::{Curve, TOGETHER, expect, sample, together};
use polhode_ga::simd::threads::{Threads, for_each};
use std::array;
use std::ops::Range;

/// Motions in a tile: enough to fill the blocks of the forms of a law, few enough for the caches.
pub const TILE: usize = 1024;

/// Number of times from which lanes of times are faster than lanes of motions.
pub(crate) const TIMES_IN_LANES: usize = 48;

/// Number of states from which another thread pays.
const SHARED: usize = 2048;

/// The times at which many motions are evaluated.
#[derive(Clone, Copy, Debug)]
pub enum Times<'a> {
    /// The same times for each motion.
    Common(&'a [f64]),
    /// This number of times for each motion in turn, repeated after the last motion.
    Own(&'a [f64], usize),
}

/// At most [`TILE`] motions, in an order.
#[derive(Clone, Debug, Default)]
pub struct Tile {
    free_circular: Blocks<Free<Circular<TOGETHER>, TOGETHER>>,
    free_hyperbolic: Blocks<Free<Hyperbolic<TOGETHER>, TOGETHER>>,
    lagrange_circular: Blocks<Lagrange<LagrangeCircular<TOGETHER>, TOGETHER>>,
    lagrange_hyperbolic: Blocks<Lagrange<LagrangeHyperbolic<TOGETHER>, TOGETHER>>,
    damped_circular: Blocks<Damped<Circular<TOGETHER>, TOGETHER>>,
    damped_hyperbolic: Blocks<Damped<Hyperbolic<TOGETHER>, TOGETHER>>,
    larmor: Blocks<Larmor<TOGETHER>>,
    horizons: Vec<[f64; 2]>,
}

/// The motions of one form. Blocks are large: in boxes they are not copied when the list grows.
#[derive(Clone, Debug)]
struct Blocks<K>(Vec<Box<Block<K>>>);

/// Motions of one form in their lanes, in whole cache lines: a register that spans two takes twice as long to read.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Block<K> {
    coefficients: K,
    /// Their places in the tile, ascending.
    places: [u16; TOGETHER],
    /// Number of motions, at most the lanes.
    count: usize,
}

/// Some states of the motions of a tile: `rows` of them, motion by motion, of `each` times.
struct Part<'a> {
    times: Times<'a>,
    each: usize,
    rows: Range<usize>,
    rotors: &'a mut [[f64; 4]],
    omegas: &'a mut [[f64; 3]],
}

impl Tile {
    /// Takes the next motions, at most [`TILE`].
    ///
    /// # Errors
    /// The first error of the iterator, with its index.
    pub fn new<M: ExactMotion, E>(motions: impl Iterator<Item = Result<M, E>>) -> Result<Tile, (usize, E)> {
        let mut tile = Tile::default();
        for (place, motion) in motions.take(TILE).enumerate() {
            tile.add(&motion.map_err(|error| (place, error))?);
        }
        Ok(tile)
    }

    /// The motions of the next bodies without a torque, set up in lanes.
    ///
    /// # Errors
    /// The first error of the iterator, with its index.
    pub fn free<E>(bodies: impl Iterator<Item = Result<FreeBody, E>>) -> Result<Tile, (usize, E)> {
        let mut motions = FreeMotions::default();
        Tile::in_groups(bodies, |tile, bodies, count| {
            motions.set_up(bodies, count);
            let first = tile.horizons.len();
            tile.horizons.extend(motions.horizons[..count].iter().map(|&horizon| [horizon; 2]));
            let [circular, hyperbolic] = motions.lanes(count);
            tile.free_circular.add_lanes(first, &mut motions.circular, &circular);
            tile.free_hyperbolic.add_lanes(first, &mut motions.hyperbolic, &hyperbolic);
            Ok(())
        })
    }

    /// The same of bodies with the torque `−g L`, from each [`super::damped::DampedTop::body`] and its g.
    ///
    /// # Errors
    /// An error of the iterator or of a motion, with its index.
    pub fn damped<E: From<String>>(
        bodies: impl Iterator<Item = Result<(FreeBody, f64), E>>,
    ) -> Result<Tile, (usize, E)> {
        let mut motions = DampedMotions::default();
        Tile::in_groups(bodies, |tile, bodies, count| {
            motions.set_up(bodies, count);
            let first = tile.horizons.len();
            for (l, horizons) in motions.horizons[..count].iter().enumerate() {
                tile.horizons.push(*horizons.as_ref().map_err(|error| (l, error.to_string().into()))?);
            }
            let [circular, hyperbolic] = motions.lanes(count);
            tile.damped_circular.add_lanes(first, &mut motions.circular, &circular);
            tile.damped_hyperbolic.add_lanes(first, &mut motions.hyperbolic, &hyperbolic);
            Ok(())
        })
    }

    /// The same of heavy symmetric tops.
    ///
    /// # Errors
    /// An error of the iterator or of a motion, with its index.
    pub fn lagrange<E: From<String>>(
        tops: impl Iterator<Item = Result<HeavyTop, E>>,
    ) -> Result<Tile, (usize, E)> {
        let mut motions = LagrangeTops::default();
        Tile::in_groups(tops, |tile, tops, count| {
            motions.set_up(tops, count);
            let (first, mut lanes) = (tile.horizons.len(), [Vec::new(), Vec::new()]);
            for (l, top) in tops[..count].iter().enumerate() {
                if motions.has(l) {
                    tile.horizons.push([motions.horizons[l]; 2]);
                    lanes[usize::from(!motions.is_circular[l])].push(l);
                } else {
                    tile.add(&top.motion().map_err(|error| (l, error.to_string().into()))?);
                }
            }
            tile.lagrange_circular.add_lanes(first, &mut motions.circular, &lanes[0]);
            tile.lagrange_hyperbolic.add_lanes(first, &mut motions.hyperbolic, &lanes[1]);
            Ok(())
        })
    }

    /// Takes as many at a time as there are lanes, the number of them, and copies of the last one in the other lanes. An
    /// error has the index in its group.
    fn in_groups<B: Copy, E>(
        all: impl Iterator<Item = Result<B, E>>,
        mut take: impl FnMut(&mut Tile, &[B; TOGETHER], usize) -> Result<(), (usize, E)>,
    ) -> Result<Tile, (usize, E)> {
        let (mut tile, mut all) = (Tile::default(), all.take(TILE));
        let mut group = Vec::with_capacity(TOGETHER);
        loop {
            let (first, mut failed) = (tile.horizons.len(), None);
            group.clear();
            for one in all.by_ref().take(TOGETHER) {
                match one {
                    Ok(one) => group.push(one),
                    Err(error) => {
                        failed = Some((first + group.len(), error));
                        break;
                    }
                }
            }
            if let Some(last) = group.last() {
                let lanes = array::from_fn(|l| *group.get(l).unwrap_or(last));
                take(&mut tile, &lanes, group.len()).map_err(|(l, error)| (first + l, error))?;
            }
            match failed {
                Some(error) => return Err(error),
                None if group.is_empty() => return Ok(tile),
                None => {}
            }
        }
    }

    /// Takes the next motion.
    fn add(&mut self, motion: &impl ExactMotion) {
        let place = self.horizons.len();
        self.horizons.push(motion.horizons());
        match &motion.flow().0 {
            Form::FreeCircular(one) => self.free_circular.add(place, one),
            Form::FreeHyperbolic(one) => self.free_hyperbolic.add(place, one),
            Form::LagrangeCircular(one) => self.lagrange_circular.add(place, one),
            Form::LagrangeHyperbolic(one) => self.lagrange_hyperbolic.add(place, one),
            Form::DampedCircular(one) => self.damped_circular.add(place, one),
            Form::DampedHyperbolic(one) => self.damped_hyperbolic.add(place, one),
            Form::Larmor(one) => self.larmor.add(place, one),
        }
    }

    /// [`ExactMotion::horizons`] of each motion.
    pub fn horizons(&self) -> &[[f64; 2]] {
        &self.horizons
    }

    fn fill(&self, mut part: Part<'_>) {
        self.free_circular.fill(&mut part);
        self.free_hyperbolic.fill(&mut part);
        self.lagrange_circular.fill(&mut part);
        self.lagrange_hyperbolic.fill(&mut part);
        self.damped_circular.fill(&mut part);
        self.damped_hyperbolic.fill(&mut part);
        self.larmor.fill(&mut part);
    }
}

impl<K> Default for Blocks<K> {
    fn default() -> Blocks<K> {
        Blocks(Vec::new())
    }
}

impl<K: Lanes<TOGETHER>> Blocks<K> {
    /// The block with the next lane.
    fn open(&mut self) -> &mut Block<K> {
        let Blocks(blocks) = self;
        if blocks.last().is_none_or(|block| block.is_full()) {
            blocks.push(boxed(Block { coefficients: K::empty(), places: [0; TOGETHER], count: 0 }));
        }
        let last = blocks.len() - 1;
        &mut blocks[last]
    }

    /// Puts a motion into the next lane.
    fn add(&mut self, place: usize, motion: &K::One) {
        let block = self.open();
        block.coefficients.put(block.count, motion);
        block.places[block.count] = place as u16;
        block.count += 1;
    }

    /// Puts the motions in some lanes, those of the places `first` and up, into the next lanes.
    fn add_lanes(&mut self, first: usize, motions: &mut K, mut lanes: &[usize]) {
        if lanes.len() == TOGETHER && self.0.last().is_none_or(|block| block.is_full()) {
            // All lanes, in their order.
            let places = array::from_fn(|l| (first + l) as u16);
            return self.0.push(boxed(Block { coefficients: *motions, places, count: TOGETHER }));
        }
        while !lanes.is_empty() {
            let block = self.open();
            let (some, more) = lanes.split_at(lanes.len().min(TOGETHER - block.count));
            block.coefficients.put_from(block.count, motions, some);
            for &l in some {
                block.places[block.count] = (first + l) as u16;
                block.count += 1;
            }
            lanes = more;
        }
    }

    /// Fills in the part's states of all blocks, prefetching the next block, since memory is slower than the computation.
    fn fill(&self, part: &mut Part<'_>) {
        for (i, block) in self.0.iter().enumerate() {
            if let Some(next) = self.0.get(i + 1) {
                expect(next);
            }
            block.fill(part);
        }
    }
}

/// `Box::new` would build the block in the stack frame and copy it.
#[inline(always)]
fn boxed<K>(block: Block<K>) -> Box<Block<K>> {
    Box::write(Box::new_uninit(), block)
}

/// Motions in lanes, with their states.
trait Lanes<const C: usize>: Coefficients<C, One: Curve<4, 3>> + Curve<4, 3> {}

impl<K: Coefficients<C, One: Curve<4, 3>> + Curve<4, 3>, const C: usize> Lanes<C> for K {}

/// States `rows` of the motions at the times, motion by motion: rows of four rotor components and of three components of
/// the angular velocity. The same bits as [`ExactMotion::at`], for any number of threads.
///
/// # Panics
/// If the numbers of rows differ, states do not exist, or a tile other than the last has fewer motions than [`TILE`].
pub fn at_each(
    threads: Threads,
    tiles: &[Tile],
    times: Times<'_>,
    rows: Range<usize>,
    rotors: &mut [f64],
    omegas: &mut [f64],
) {
    let (mut rotors, mut omegas) = (rotors.as_chunks_mut().0, omegas.as_chunks_mut().0);
    assert!(rotors.len() == rows.len() && omegas.len() == rows.len(), "results of the wrong length");
    let pieces = threads.ranges(rows.len(), SHARED).map(|piece| {
        let length = piece.len();
        let a = rotors.split_off_mut(..length).expect("pieces fill the result");
        let b = omegas.split_off_mut(..length).expect("pieces fill the result");
        (rows.start + piece.start, a, b)
    });
    for_each(pieces, |(first, rotors, omegas)| in_order(tiles, times, first, rotors, omegas));
}

/// The states from row `first` on, tile by tile.
fn in_order(
    tiles: &[Tile],
    times: Times<'_>,
    mut first: usize,
    mut rotors: &mut [[f64; 4]],
    mut omegas: &mut [[f64; 3]],
) {
    let each = match times {
        Times::Common(times) => times.len(),
        Times::Own(_, each) => each,
    };
    let motions = tiles.iter().map(|tile| tile.horizons.len()).sum::<usize>();
    while !rotors.is_empty() {
        let place = first / each % motions;
        let tile = &tiles[place / TILE];
        let start = place % TILE * each + first % each;
        let count = (tile.horizons.len() * each - start).min(rotors.len());
        let (a, more_rotors) = rotors.split_at_mut(count);
        let (b, more_omegas) = omegas.split_at_mut(count);
        let times = match times {
            Times::Common(_) => times,
            Times::Own(times, each) => Times::Own(&times[first..first + count], each),
        };
        tile.fill(Part { times, each, rows: start..start + count, rotors: a, omegas: b });
        (rotors, omegas) = (more_rotors, more_omegas);
        first += count;
    }
}

impl<K> Block<K> {
    fn is_full(&self) -> bool {
        self.count == TOGETHER
    }
}

impl<K: Lanes<TOGETHER>> Block<K> {
    fn places(&self) -> &[u16] {
        &self.places[..self.count]
    }

    /// Fills in the part's states of these motions.
    fn fill(&self, part: &mut Part<'_>) {
        let (Some(&first), Some(&last)) = (self.places().first(), self.places().last()) else { return };
        let rows = usize::from(first) * part.each..(usize::from(last) + 1) * part.each;
        if rows.start >= part.rows.end || rows.end <= part.rows.start {
            return;
        }
        if part.each >= TIMES_IN_LANES {
            for (l, &place) in self.places().iter().enumerate() {
                part.one(usize::from(place), &self.coefficients.take(l));
            }
        } else {
            for k in 0..part.each {
                self.at_time(k, part);
            }
        }
    }

    /// All motions at their kth time.
    fn at_time(&self, k: usize, part: &mut Part<'_>) {
        let first = part.rows.start;
        let row = |place: &u16| usize::from(*place) * part.each + k;
        let mut times = [0.0; TOGETHER];
        for (time, place) in times.iter_mut().zip(self.places()) {
            *time = match part.times {
                Times::Common(times) => times[k],
                Times::Own(times, _) => times.get(row(place).wrapping_sub(first)).copied().unwrap_or(0.0),
            };
        }
        let (mut rotors, mut omegas) = ([[0.0; 4]; TOGETHER], [[0.0; 3]; TOGETHER]);
        together(&self.coefficients, &times, &mut rotors, &mut omegas);
        for (l, place) in self.places().iter().enumerate() {
            let row = row(place);
            if part.rows.contains(&row) {
                part.rotors[row - first] = rotors[l];
                part.omegas[row - first] = omegas[l];
            }
        }
    }
}

impl Part<'_> {
    /// One motion at its times.
    fn one(&mut self, place: usize, motion: &impl Curve<4, 3>) {
        let (first, each) = (self.rows.start, self.each);
        let rows = (place * each).max(first)..((place + 1) * each).min(self.rows.end);
        if rows.is_empty() {
            return;
        }
        let to = rows.start - first..rows.end - first;
        let times = match self.times {
            Times::Common(times) => &times[rows.start - place * each..rows.end - place * each],
            Times::Own(times, _) => &times[to.clone()],
        };
        let (rotors, omegas) = (&mut self.rotors[to.clone()], &mut self.omegas[to]);
        sample(motion, Threads::ONE, times, rotors.as_flattened_mut(), omegas.as_flattened_mut());
    }
}
