//! Maxima of quantities over the impact, impacts side by side.

use super::apart::apart;
use super::arithmetic::{MapWith, product, third_order};
use super::modes::{Basis, Wave};
use super::scan::Tops;
use super::{GroupPeaks, Known, MAX_STEPS, Solved};
use numeric::lanes::{Number, Truth};
use pulp::Simd;

/// Last step to a maximum, in cells; its fifth power, over 120, is what the value may be wrong by.
const SETTLED: f64 = 1e-2;
/// What has a maximum.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Acceleration,
    Compression,
    Force,
    ManipulatorPower,
    FoamPower,
}

impl<S: Simd, R: Number> Solved<'_, S, R> {
    /// A quantity with four derivatives.
    #[inline(always)]
    fn jet(&self, quantity: Quantity, basis: &Basis<R>, time: R) -> [R; 5] {
        if quantity == Quantity::Acceleration {
            return Wave::values(&self.motion.head, 1, basis);
        }
        let compression = self.motion.compression(basis, time);
        let [value, first, second, third, fourth, fifth] = compression;
        match quantity {
            Quantity::Force => self.motion.force(&compression),
            Quantity::ManipulatorPower => {
                product(self.motion.force(&compression), self.manipulator(basis))
            }
            Quantity::FoamPower => product(
                self.motion.force(&compression),
                [first, second, third, fourth, fifth],
            ),
            _ => [value, first, second, third, fourth],
        }
    }

    /// Largest value of a quantity, at its tops or at the ends.
    #[inline(always)]
    fn largest(&self, quantity: Quantity, tops: &Tops<R>, ends: [R; 2]) -> Largest<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.largest_here(quantity, tops, ends),
        )
    }

    #[inline(always)]
    fn largest_here(&self, quantity: Quantity, tops: &Tops<R>, ends: [R; 2]) -> Largest<R> {
        let mut accepted = self.accepted & !tops.odd;
        let mut best = R::select(ends[0].gt(ends[1]), ends[0], ends[1]);
        let zero = best.like(0.0);
        let mut top = [zero; 3];
        for place in &tops.places {
            let mut open = accepted & place.found;
            if !open.any() {
                break;
            }
            let mut time = place.piece().zero();
            let mut bracket = [place.piece().from, place.piece().from + place.piece().width];
            let mut peak = best;
            for _ in 0..MAX_STEPS {
                let basis = self.motion.modes.basis(time);
                let [value, slope, curve, third, fourth] = self.jet(quantity, &basis, time);
                let wanted = third_order(slope, curve, third);
                let rising = slope.gt(zero);
                bracket = [
                    R::select(rising, time, bracket[0]),
                    R::select(rising, bracket[1], time),
                ];
                let next = time + wanted;
                let inside = next.ge(bracket[0]) & next.le(bracket[1]);
                let middle = (bracket[0] + bracket[1]) * 0.5;
                let step = R::select(inside, wanted, middle - time);
                let bend = third * (1.0 / 6.0) + step * (1.0 / 24.0) * fourth;
                let found = value + step * (slope + step * (curve * 0.5 + step * bend));
                time = R::select(open, time + step, time);
                let higher = open & found.gt(best);
                peak = R::select(open, R::select(higher, found, best), peak);
                top = [time, curve, third].map_with(
                    top,
                    #[inline(always)]
                    |new, old| R::select(higher, new, old),
                );
                open = open & !step.abs().lt(zero.like(SETTLED));
                if !open.any() {
                    break;
                }
            }
            accepted = accepted & !open;
            best = peak;
        }
        let (hidden, time, excess) = tops.hidden;
        if (hidden & accepted).any() {
            let basis = self.motion.modes.basis(time);
            let [near, ..] = self.jet(quantity, &basis, time);
            accepted = accepted & !(hidden & (near + excess).ge(best));
        }
        Largest {
            known: Known {
                value: best,
                holds: accepted,
            },
            top,
        }
    }

    /// Peaks that are wanted, duration and mean.
    #[inline(always)]
    pub fn peaks(&self) -> GroupPeaks<R> {
        let zero = self.end.like(0.0);
        let searches = self.searches;
        let (length, rate) = (self.motion.modes.length, self.motion.modes.rate);
        let first = self.space.head[0][1];
        let at_end = self.motion.compression(&self.at_end, self.end);
        let mut acceleration = Known::nothing(zero);
        let mut top = [zero; 3];
        // A window needs its top.
        if searches.acceleration || searches.windows() {
            let tops = &self.space.found.acceleration;
            let last = self.motion.head[1].at(&self.at_end);
            let last = R::select(self.lasting, last, zero);
            let largest = self.largest(Quantity::Acceleration, tops, [first, last]);
            acceleration = largest.known.times(rate * rate);
            top = largest.top;
        }
        let mut compression = Known::nothing(zero);
        if searches.compression {
            let tops = &self.space.found.compression;
            let ends = [zero, at_end[0]];
            compression = self.largest(Quantity::Compression, tops, ends).known;
        }
        let mut force = Known::nothing(zero);
        if searches.force {
            let ends = [self.first_force(), self.motion.force(&at_end)[0]];
            let tops = &self.space.found.force;
            force = self.largest(Quantity::Force, tops, ends).known;
        }
        let velocity = self.motion.head[0];
        let gained = velocity.at(&self.at_end) - velocity.at_contact();
        let known = |value: R| Known {
            value,
            holds: self.accepted,
        };
        GroupPeaks {
            head_acceleration: acceleration,
            contact_force: force,
            compression,
            duration: known(R::select(
                self.lasting,
                zero.like(f64::INFINITY),
                self.end * length,
            )),
            mean: known(gained / self.end * rate * rate),
            top,
        }
    }

    /// Force at first contact.
    #[inline(always)]
    fn first_force(&self) -> R {
        self.motion.foam[1] * self.first_rate()
    }

    /// Rate of compression at first contact.
    #[inline(always)]
    fn first_rate(&self) -> R {
        self.motion.compression[1].at_contact() + self.motion.ramp[1]
    }

    /// Largest powers from the manipulator and of compression, in W.
    #[inline(always)]
    pub(super) fn powers(&self) -> [Known<R>; 2] {
        let rate = self.motion.modes.rate;
        let at_end = self.motion.compression(&self.at_end, self.end);
        let force = self.motion.force(&at_end)[0];
        let [speed, ..] = self.manipulator::<1>(&self.at_end);
        let ends = [self.first_force() * self.manipulator_speed, force * speed];
        let tops = &self.space.found.manipulator_power;
        let manipulator = self.largest(Quantity::ManipulatorPower, tops, ends);
        let ends = [self.first_force() * self.first_rate(), force * at_end[1]];
        let foam = self.largest(Quantity::FoamPower, &self.space.found.foam_power, ends);
        [manipulator.known.times(rate), foam.known.times(rate)]
    }
}

/// The largest value of a quantity.
struct Largest<R: Number> {
    known: Known<R>,
    /// Time, second and third derivative of the top that it is at, if it is one.
    top: [R; 3],
}
