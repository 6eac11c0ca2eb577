//! Bodies side by side, each by steps of its own that keep to its tolerance.
//!
//! In every round each body attempts a step of its own length and takes it or not, by the rules of a single body: its
//! passes, its stops at output times and where its laws are not smooth. A body that is done gives its lane to the next
//! one, so that a hard one does not hold up the others. The last few go on in fewer lanes, to the same bits.

use super::body_run::Seat;
use super::crew::{Crew, Member, SIDE_BY_SIDE};
use super::laws::{Laws, Nothing};
use crate::error::SimulateError;
use crate::laws::forcing::Forcing;
use crate::laws::torque::Torque;
use crate::methods::classical::Bodies;
use crate::methods::runge_kutta::{DOP853, Points, step};
use crate::run::Progress;
use crate::state::carried::Carried;
use crate::state::phase::Gyrostat;
use polhode_ga::simd::lanes::{Lanes, Work};
use std::{array, mem};

/// So many lanes hold the last bodies: one register of the widest machines.
const LAST: usize = 8;

/// Rounds between looks at whether to go on.
const BETWEEN_LOOKS: u32 = 256;

/// All bodies that no one has taken yet.
pub(super) struct AdaptedSteps<'a, 'b> {
    pub crew: &'b Crew<'a>,
    pub progress: &'b mut dyn FnMut(Progress) -> bool,
}

/// A body on its way that has no lane.
struct Standing<'a> {
    seat: Seat<'a>,
    torques: Vec<Torque>,
    at: Carried,
    /// The largest angular velocity on the way, rad/s.
    fastest: f64,
}

/// Bodies in lanes and how far they are.
struct Deck<'a, const W: usize, const F: bool> {
    seats: [Option<Seat<'a>>; W],
    bodies: Bodies<W, F>,
    at: Points<W, F>,
    /// The largest angular velocities on the way, and rates below which they do not count, in rad/s.
    fastest: Lanes<W, F>,
    least: Lanes<W, F>,
}

impl Work for AdaptedSteps<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<const F: bool>(self) {
        let AdaptedSteps { crew, progress } = self;
        let last = follow::<SIDE_BY_SIDE, F>(crew, Vec::new(), LAST, progress);
        follow::<LAST, F>(crew, last, 0, progress);
    }
}

/// Follows bodies, those that stand first, until no more than so many are left, which stand then.
#[inline(always)]
fn follow<'a, const W: usize, const F: bool>(
    crew: &Crew<'a>,
    mut standing: Vec<Standing<'a>>,
    enough: usize,
    progress: &mut dyn FnMut(Progress) -> bool,
) -> Vec<Standing<'a>> {
    let nobody = Gyrostat::rigid([1.0; 3]);
    let mut deck = Deck::<W, F> {
        seats: [const { None }; W],
        bodies: Bodies::new([(nobody, 0.0); W]),
        at: Points::NONE,
        fastest: Lanes::ZERO,
        least: Lanes::ZERO,
    };
    let mut torques: [Vec<Torque>; W] = [const { Vec::new() }; W];
    let mut gyrostats = [nobody; W];
    loop {
        for l in 0..W {
            while deck.seats[l].is_none()
                && let Some(next) = standing.pop().or_else(|| Some(Standing::new(crew.next(progress)?, crew)))
            {
                gyrostats[l] = next.seat.member.gyrostat;
                torques[l] = deck.sit(l, next, crew);
            }
        }
        if deck.taken() <= enough {
            return deck.stand(torques);
        }
        let go_on = if crew.ensemble.laws.is_empty() {
            deck.rounds(crew, &torques, &mut Nothing, progress)
        } else {
            // An empty lane has laws of the same kinds.
            let taken = deck.seats.iter().position(Option::is_some).unwrap_or(0);
            let of = |l: usize| if torques[l].is_empty() { taken } else { l };
            let laws = &mut Laws::new(gyrostats, array::from_fn(|l| &torques[of(l)][..]));
            deck.rounds(crew, &torques, laws, progress)
        };
        if !go_on {
            return Vec::new();
        }
    }
}

impl<'a> Standing<'a> {
    fn new(mut member: Member<'a>, crew: &Crew<'a>) -> Standing<'a> {
        let torques = mem::take(&mut member.torques);
        let mut seat = Seat::new(member, &torques, crew);
        let at = seat.begin_pass();
        Standing { fastest: seat.rate(&at), seat, torques, at }
    }
}

impl<'a, const W: usize, const F: bool> Deck<'a, W, F> {
    /// Puts a body into an empty lane, unless it is done at once. Gives its laws.
    fn sit(&mut self, l: usize, body: Standing<'a>, crew: &Crew<'a>) -> Vec<Torque> {
        let Standing { seat, torques, at, fastest } = body;
        let gyrostat = seat.member.gyrostat;
        self.bodies.set(l, &gyrostat, torques.iter().map(Torque::damping_rate).sum());
        (self.least.0[l], self.fastest.0[l]) = (gyrostat.least_rate(), fastest);
        self.at.set(l, &at);
        self.seats[l] = Some(seat);
        self.proceed(l, &torques, crew);
        torques
    }

    /// Empties all lanes.
    fn stand(&mut self, torques: [Vec<Torque>; W]) -> Vec<Standing<'a>> {
        let mut all = Vec::new();
        for (l, torques) in torques.into_iter().enumerate() {
            let (at, fastest) = (self.at.get(l), self.fastest.0[l]);
            all.extend(self.seats[l].take().map(|seat| Standing { seat, torques, at, fastest }));
        }
        all
    }

    /// Goes on with the body of a lane from where it stopped. Empties the lane where it is done.
    fn proceed(&mut self, l: usize, torques: &[Torque], crew: &Crew<'a>) {
        let Some(seat) = &mut self.seats[l] else { return };
        let mut at = self.at.get(l);
        match seat.proceed(&mut at, &mut self.fastest.0[l], crew.times) {
            Ok(None) => self.at.set(l, &at),
            Ok(Some(converged)) => {
                if let Some(seat) = self.seats[l].take() {
                    seat.done(converged, torques, crew);
                }
            }
            Err(error) => self.fail(l, error, crew),
        }
    }

    /// Rounds until a lane is empty that was not. Whether to go on.
    #[inline(always)]
    fn rounds<E: Forcing<W, F>>(
        &mut self,
        crew: &Crew<'a>,
        torques: &[Vec<Torque>; W],
        exert: &mut E,
        progress: &mut dyn FnMut(Progress) -> bool,
    ) -> bool {
        let before = self.taken();
        let mut rounds = 0;
        while self.taken() == before {
            let (h, ends) = self.plan(crew);
            let fastest = self.fastest.max(self.least);
            let (mut next, error) = step::<6, W, F, E>(&DOP853, &self.bodies, exert, &self.at, h, fastest);
            next.time = ends;
            let rates = next.rates(&self.bodies);
            let stands = self.judge(crew, torques, &h, &next, &error);
            self.at.take(&stands, &next);
            self.fastest = rates.max(self.fastest).or(&stands, self.fastest);
            for l in 0..W {
                if stands[l]
                    && let Some(noise) = self.seats[l].as_mut().and_then(|seat| seat.noise.as_mut())
                {
                    self.at.set(l, &noise.shake(&self.at.get(l)));
                }
                let stops = |seat: &Seat| seat.stop == self.at.time.0[l];
                if stands[l] && self.seats[l].as_ref().is_some_and(stops) {
                    self.proceed(l, &torques[l], crew);
                }
            }
            rounds += 1;
            if rounds % BETWEEN_LOOKS == 0 {
                for l in 0..W {
                    let time = self.at.time.0[l];
                    let Some(seat) = &mut self.seats[l] else { continue };
                    seat.count(time, crew);
                }
                if !crew.report(progress) {
                    return false;
                }
            }
        }
        true
    }

    fn taken(&self) -> usize {
        self.seats.iter().filter(|seat| seat.is_some()).count()
    }

    /// The lengths of the next steps and where they end; empty lanes stay where they are.
    fn plan(&mut self, crew: &Crew<'a>) -> (Lanes<W, F>, Lanes<W, F>) {
        let (mut h, mut ends) = (Lanes::ZERO, self.at.time);
        for l in 0..W {
            let Some(seat) = &mut self.seats[l] else { continue };
            let from = self.at.time.0[l];
            match seat.stride.end(from, seat.stop) {
                Ok(to) => (h.0[l], ends.0[l]) = (to - from, to),
                Err(error) => self.fail(l, error, crew),
            }
        }
        (h, ends)
    }

    /// Which steps may stand.
    fn judge(
        &mut self,
        crew: &Crew<'a>,
        torques: &[Vec<Torque>; W],
        h: &Lanes<W, F>,
        next: &Points<W, F>,
        error: &Lanes<W, F>,
    ) -> [bool; W] {
        let mut stands = [false; W];
        for l in 0..W {
            let Some(seat) = &mut self.seats[l] else { continue };
            let (h, estimate) = (h.0[l], error.0[l]);
            let error = estimate / seat.tolerance;
            seat.pass.evaluations += DOP853.rows.len() as u64;
            if error.is_nan()
                && let Err(error) = seat.diagnose(&self.at.get(l), h, &torques[l])
            {
                self.fail(l, error, crew);
                continue;
            }
            if seat.stride.judge(h, error) {
                seat.pass.errors += estimate;
                match seat.arrive(h, next, l, crew) {
                    Ok(()) => stands[l] = true,
                    Err(error) => self.fail(l, error, crew),
                }
            }
        }
        stands
    }

    #[cold]
    fn fail(&mut self, l: usize, error: SimulateError, crew: &Crew<'a>) {
        if let Some(seat) = self.seats[l].take() {
            seat.failed(error, crew);
        }
    }
}
