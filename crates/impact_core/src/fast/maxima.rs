//! Maxima of quantities over the impact, impacts side by side.

use super::apart::{apart, inlined};
use super::arithmetic::{MapWith, product, third_order};
use super::modes::{Basis, Wave};
use super::scan::Tops;
use super::{GroupPeaks, MAX_STEPS, MaskedValue, Solved};
use numeric::lanes::{Number, Truth};
use pulp::Simd;

/// Last step to a maximum, in cells; its fifth power, over 120, is what the value may be wrong by.
const SETTLED: f64 = 1e-2;
/// Quantity with a maximum.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PeakQuantity {
    Acceleration,
    Compression,
    Force,
    ManipulatorPower,
    FoamPower,
}

impl<S: Simd, R: Number> Solved<'_, S, R> {
    /// A quantity with four derivatives.
    #[inline(always)]
    fn jet(&self, quantity: PeakQuantity, basis: &Basis<R>, time: R) -> [R; 5] {
        if quantity == PeakQuantity::Acceleration {
            return Wave::values(&self.motion.head, 1, basis);
        }
        let compression = self.motion.compression(basis, time);
        let [value, first, second, third, fourth, fifth] = compression;
        match quantity {
            PeakQuantity::Force => self.motion.force(&compression),
            PeakQuantity::ManipulatorPower => {
                product(self.motion.force(&compression), self.manipulator(basis))
            }
            PeakQuantity::FoamPower => product(
                self.motion.force(&compression),
                [first, second, third, fourth, fifth],
            ),
            _ => [value, first, second, third, fourth],
        }
    }

    /// Largest values of quantities, at their tops or at the ends. They are looked for side by side: a step
    /// of one waits for its own numbers only.
    #[inline(always)]
    fn climb(&self, climbs: &mut [Option<Climb<'_, R>>]) {
        apart(
            self.simd,
            #[inline(always)]
            || self.climb_here(climbs),
        );
    }

    #[inline(always)]
    fn climb_here(&self, climbs: &mut [Option<Climb<'_, R>>]) {
        let modes = &self.motion.modes;
        for place in 0..2 {
            for climb in climbs.iter_mut().flatten() {
                climb.start(place, self.accepted);
            }
            for _ in 0..MAX_STEPS {
                for climb in climbs.iter_mut().flatten() {
                    if climb.open.any() {
                        climb.basis = modes.basis(climb.time);
                    }
                }
                let mut open = false;
                for climb in climbs.iter_mut().flatten() {
                    if climb.open.any() {
                        climb.step(self.jet(climb.quantity, &climb.basis, climb.time));
                        open = open || climb.open.any();
                    }
                }
                if !open {
                    break;
                }
            }
            for climb in climbs.iter_mut().flatten() {
                climb.settle();
            }
        }
        for climb in climbs.iter_mut().flatten() {
            let (hidden, time, excess) = climb.tops.hidden;
            let hidden = hidden & self.accepted & !climb.lost;
            if hidden.any() {
                let [near, ..] = self.jet(climb.quantity, &modes.basis(time), time);
                climb.lost = climb.lost | (hidden & (near + excess).ge(climb.best));
            }
        }
    }

    /// Peaks that are wanted, duration and mean, powers.
    #[inline(always)]
    pub fn peaks(&self) -> GroupPeaks<R> {
        let zero = self.end.like(0.0);
        let searches = self.searches;
        let (length, rate) = (self.motion.modes.length, self.motion.modes.rate);
        let found = &self.space.found;
        let velocity = self.motion.head[0];
        let compression = self.motion.compression(&self.at_end, self.end);
        let force = self.motion.force(&compression)[0];
        let last = self.motion.head[1].at(&self.at_end);
        let accelerations = [self.space.head[0][1], R::select(self.lasting, last, zero)];
        let first_rate = self.motion.compression[1].at_contact() + self.motion.ramp[1];
        let first_force = self.motion.foam[1] * first_rate;
        let [speed, ..] = self.manipulator::<1>(&self.at_end);
        let at_contact = first_force * self.manipulator_speed;
        let climb = inlined(
            #[inline(always)]
            |asked: bool, quantity, tops, ends| asked.then_some(Climb::new(quantity, tops, ends)),
        );
        let mut climbs = [
            // A window needs its top.
            climb(
                searches.acceleration || searches.windows(),
                PeakQuantity::Acceleration,
                &found.acceleration,
                accelerations,
            ),
            climb(
                searches.compression,
                PeakQuantity::Compression,
                &found.compression,
                [zero, compression[0]],
            ),
            climb(
                searches.force,
                PeakQuantity::Force,
                &found.force,
                [first_force, force],
            ),
            climb(
                searches.powers,
                PeakQuantity::ManipulatorPower,
                &found.manipulator_power,
                [at_contact, force * speed],
            ),
            climb(
                searches.powers,
                PeakQuantity::FoamPower,
                &found.foam_power,
                [first_force * first_rate, force * compression[1]],
            ),
        ];
        self.climb(&mut climbs);
        let known = inlined(
            #[inline(always)]
            |value: R| MaskedValue {
                value,
                holds: self.accepted,
            },
        );
        let largest = inlined(
            #[inline(always)]
            |index: usize| match &climbs[index] {
                Some(climb) => MaskedValue {
                    value: climb.best,
                    holds: self.accepted & !climb.lost,
                },
                None => MaskedValue::nothing(zero),
            },
        );
        let gained = velocity.at(&self.at_end) - velocity.at_contact();
        let duration = R::select(self.lasting, zero.like(f64::INFINITY), self.end * length);
        GroupPeaks {
            head_acceleration: largest(0).times(rate * rate),
            contact_force: largest(2),
            compression: largest(1),
            duration: known(duration),
            mean: known(gained / self.end * rate * rate),
            powers: [largest(3).times(rate), largest(4).times(rate)],
            top: climbs[0].as_ref().map_or([zero; 3], |climb| climb.top),
        }
    }
}

/// The search for the largest value of a quantity.
struct Climb<'a, R: Number> {
    quantity: PeakQuantity,
    tops: &'a Tops<R>,
    /// The largest value so far.
    best: R,
    /// Time, second and third derivative of the top that it is at, if it is one.
    top: [R; 3],
    /// Lanes in which it was not found.
    lost: R::Mask,
    /// Lanes whose steps to a top have not come to rest.
    open: R::Mask,
    time: R,
    basis: Basis<R>,
    bracket: [R; 2],
    /// The best so far with what the last step gives.
    peak: R,
}

impl<'a, R: Number> Climb<'a, R> {
    #[inline(always)]
    fn new(quantity: PeakQuantity, tops: &'a Tops<R>, ends: [R; 2]) -> Self {
        let zero = ends[0].like(0.0);
        let best = R::select(ends[0].gt(ends[1]), ends[0], ends[1]);
        Self {
            quantity,
            tops,
            best,
            top: [zero; 3],
            lost: tops.odd,
            open: zero.truth(false),
            time: zero,
            basis: [zero; 4],
            bracket: [zero; 2],
            peak: best,
        }
    }

    /// Begins with a top.
    #[inline(always)]
    fn start(&mut self, place: usize, accepted: R::Mask) {
        let place = &self.tops.places[place];
        self.open = accepted & !self.lost & place.found;
        if self.open.any() {
            let piece = place.piece();
            self.time = piece.zero();
            self.bracket = [piece.from, piece.from + piece.width];
        }
    }

    /// Takes a step from the quantity with four derivatives.
    #[inline(always)]
    fn step(&mut self, [value, slope, curve, third, fourth]: [R; 5]) {
        let (time, open) = (self.time, self.open);
        let wanted = third_order(slope, curve, third);
        let rising = slope.gt(time.like(0.0));
        self.bracket = [
            R::select(rising, time, self.bracket[0]),
            R::select(rising, self.bracket[1], time),
        ];
        let next = time + wanted;
        let inside = next.ge(self.bracket[0]) & next.le(self.bracket[1]);
        let middle = (self.bracket[0] + self.bracket[1]) * 0.5;
        let step = R::select(inside, wanted, middle - time);
        let bend = (step * (1.0 / 24.0)).mul_add(fourth, third * (1.0 / 6.0));
        let rise = step.mul_add(step.mul_add(bend, curve * 0.5), slope);
        let found = step.mul_add(rise, value);
        self.time = R::select(open, time + step, time);
        let higher = open & found.gt(self.best);
        self.peak = R::select(open, R::select(higher, found, self.best), self.peak);
        self.top = [self.time, curve, third].map_with(
            self.top,
            #[inline(always)]
            |new, old| R::select(higher, new, old),
        );
        self.open = open & !step.abs().lt(time.like(SETTLED));
    }

    /// Ends with a top.
    #[inline(always)]
    fn settle(&mut self) {
        self.lost = self.lost | self.open;
        self.best = self.peak;
    }
}
