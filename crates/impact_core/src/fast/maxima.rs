//! Maxima of quantities over the impact, impacts side by side.

use super::apart::apart;
use super::scan::Tops;
use super::{Each, GroupPeaks, MAX_STEPS, MapWith, Solved, product, third_order};
use lanes::{Mask, Real};
use pulp::Simd;

/// Last step to a maximum, in cells; its fourth power is what the value may be wrong by.
const SETTLED_PEAK: f64 = 1e-3;
/// The same where its third power counts.
const SETTLED_POWER: f64 = 1e-4;
/// What has a maximum.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Acceleration,
    Compression,
    Force,
    ManipulatorPower,
    FoamPower,
}

impl Quantity {
    /// Last step to a maximum, in cells.
    fn limit(self) -> f64 {
        match self {
            Self::Acceleration | Self::Compression | Self::Force => SETTLED_PEAK,
            Self::ManipulatorPower | Self::FoamPower => SETTLED_POWER,
        }
    }
}

impl<S: Simd, R: Real> Solved<'_, S, R> {
    /// A quantity with three derivatives.
    #[inline(always)]
    fn jet(&self, quantity: Quantity, time: R) -> [R; 4] {
        let basis = self.motion.modes.basis(time);
        if quantity == Quantity::Acceleration {
            return [1, 2, 3, 4].each(|order: usize| self.motion.head[order].at(&basis));
        }
        let compression = self.motion.compression(&basis, time);
        let [value, first, second, third, _] = compression;
        let force = self.motion.force(compression);
        let powers = [force[0], force[1], force[2]];
        match quantity {
            Quantity::Force => force,
            Quantity::ManipulatorPower => with_zero(product(powers, self.manipulator(&basis))),
            Quantity::FoamPower => with_zero(product(powers, [first, second, third])),
            _ => [value, first, second, third],
        }
    }

    /// Largest value of a quantity, at its tops or at the ends, and the time, second and third
    /// derivative of that top.
    #[inline(always)]
    fn largest(&mut self, quantity: Quantity, tops: &Tops<R>, ends: [R; 2]) -> (R, [R; 3]) {
        apart(
            self.simd,
            #[inline(always)]
            || self.largest_here(quantity, tops, ends),
        )
    }

    #[inline(always)]
    fn largest_here(&mut self, quantity: Quantity, tops: &Tops<R>, ends: [R; 2]) -> (R, [R; 3]) {
        self.accepted = self.accepted & !tops.odd;
        let limit = R::splat(quantity.limit());
        let mut best = R::select(ends[0].gt(ends[1]), ends[0], ends[1]);
        let mut top = [R::zero(); 3];
        for place in &tops.places {
            let mut open = self.accepted & place.found;
            if !open.any() {
                break;
            }
            let mut time = place.piece.zero();
            let mut bracket = [place.piece.from, place.piece.from + place.piece.width];
            let mut peak = best;
            for _ in 0..MAX_STEPS {
                let [value, slope, curve, third] = self.jet(quantity, time);
                let wanted = third_order(slope, curve, third);
                let rising = slope.gt(R::zero());
                bracket = [
                    R::select(rising, time, bracket[0]),
                    R::select(rising, bracket[1], time),
                ];
                let next = time + wanted;
                let inside = next.ge(bracket[0]) & next.le(bracket[1]);
                let middle = R::splat(0.5) * (bracket[0] + bracket[1]);
                let step = R::select(inside, wanted, middle - time);
                let bend = R::splat(0.5) * curve + step * R::splat(1.0 / 6.0) * third;
                let found = value + step * (slope + step * bend);
                time = R::select(open, time + step, time);
                let higher = open & found.gt(best);
                peak = R::select(open, R::select(higher, found, best), peak);
                top = [time, curve, third].map_with(top, |new, old| R::select(higher, new, old));
                open = open & !step.abs().lt(limit);
                if !open.any() {
                    break;
                }
            }
            self.accepted = self.accepted & !open;
            best = peak;
        }
        let (hidden, time, excess) = tops.hidden;
        if (hidden & self.accepted).any() {
            let [near, ..] = self.jet(quantity, time);
            self.accepted = self.accepted & !(hidden & (near + excess).ge(best));
        }
        (best, top)
    }

    /// The peaks.
    #[inline(always)]
    pub fn peaks(&mut self) -> GroupPeaks<R> {
        let zero = R::zero();
        let length = self.motion.modes.length;
        let first = self.space.head[0][1];
        let tops = self.acceleration;
        let (acceleration, top) = self.largest(Quantity::Acceleration, &tops, [first, zero]);
        let at_end = self.motion.compression(&self.at_end, self.end);
        let tops = self.compression;
        let (compression, _) = self.largest(Quantity::Compression, &tops, [zero, at_end[0]]);
        let ends = [self.first_force(), self.motion.force(at_end)[0]];
        let tops = self.force;
        let (force, _) = self.largest(Quantity::Force, &tops, ends);
        GroupPeaks {
            head_acceleration: acceleration / (length * length),
            contact_force: force,
            compression,
            duration: self.end * length,
            accepted: self.accepted,
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

    #[inline(always)]
    pub(super) fn powers(&mut self) -> [R; 2] {
        let at_end = self.motion.compression(&self.at_end, self.end);
        let force = self.motion.force(at_end)[0];
        let speed = self.manipulator(&self.at_end)[0];
        let ends = [self.first_force() * self.manipulator_speed, force * speed];
        let tops = self.manipulator_power;
        let (manipulator, _) = self.largest(Quantity::ManipulatorPower, &tops, ends);
        let ends = [self.first_force() * self.first_rate(), force * at_end[1]];
        let tops = self.foam_power;
        let (foam, _) = self.largest(Quantity::FoamPower, &tops, ends);
        [manipulator, foam]
    }
}

/// A jet without its last term.
#[inline(always)]
fn with_zero<R: Real>([value, slope, curve]: [R; 3]) -> [R; 4] {
    [value, slope, curve, R::zero()]
}
