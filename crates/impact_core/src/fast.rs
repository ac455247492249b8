//! Metrics of impacts side by side, for responses of the usual shape.
//!
//! Cells are short here, so that the first coefficients of each are the nodes at which signs are
//! read, and every maximum or zero lies inside one cell of low order. An impact whose signs do
//! not have the usual pattern (one rise, one fall, then the zero), or whose Newton steps have not
//! settled, is refused; the caller takes the general search for it. What a lane does depends on
//! its own numbers only, so its bits are the same at any width.

use crate::criteria::HELD_WINDOW;
use crate::series::{Cell, Drive, Plant, State, derivatives, integrated};
use lanes::{Mask, Real};

/// Coefficients of a rate.
const SHORT: usize = 16;
/// Length of a cell times the bound of the fastest root: `0.75^15 / 15!` is `1e-14`.
const SHORT_ANGLE: f64 = 0.75;
/// Cells after which an impact is refused.
const MAX_CELLS: usize = 28;
/// Last step to a maximum, in cells; its third power, over 6, is what the value may be wrong by.
const SETTLED_PEAK: f64 = 2e-4;
/// Last step to a zero, in cells; its square is what the place may be wrong by.
const SETTLED_ZERO: f64 = 2e-7;
/// Last step of a window, over the impact period; the value depends on its square's square.
const SETTLED_WINDOW: f64 = 1e-5;
/// Last step of a held level's window, over the impact period; the level depends on its square.
const SETTLED_LEVEL: f64 = 1e-7;

type Short<R> = Cell<R, SHORT>;

/// Space for the cells of a group.
pub struct Workspace<R> {
    cells: Vec<Short<R>>,
}

impl<R: Real> Workspace<R> {
    /// Space for one group after the other.
    #[must_use]
    pub fn new() -> Self {
        Self {
            cells: vec![Cell::empty(); MAX_CELLS + 1],
        }
    }
}

impl<R: Real> Default for Workspace<R> {
    fn default() -> Self {
        Self::new()
    }
}

/// A group of impacts.
pub struct Group<R> {
    /// Their numbers.
    pub plant: Plant<R>,
    /// `v_c`, in m/s.
    pub closing_speed: R,
    /// `v_r`, in m/s.
    pub manipulator_speed: R,
    /// Time until which a release counts, in s.
    pub horizon: f64,
}

/// Peaks and duration.
pub struct GroupPeaks<R: Real> {
    /// Acceleration of the head, in m/s^2.
    pub head_acceleration: R,
    /// Contact force, in N.
    pub contact_force: R,
    /// Compression, in m.
    pub compression: R,
    /// Impact period, in s.
    pub duration: R,
    /// Lanes whose numbers hold.
    pub accepted: R::Mask,
    /// Lanes whose impact period holds, and with it all that depends on the acceleration only.
    pub shaped: R::Mask,
}

/// All other metrics, accelerations in m/s^2.
pub struct GroupRest<R: Real> {
    /// Mean acceleration.
    pub mean: R,
    /// Injury criteria for both windows.
    pub injury: [R; 2],
    /// Largest 3 ms mean.
    pub average: R,
    /// Largest level held for 3 ms.
    pub clip: R,
    /// Power from the manipulator, in W.
    pub manipulator_power: R,
    /// Power of compression, in W.
    pub foam_power: R,
    /// Lanes whose numbers hold.
    pub accepted: R::Mask,
}

/// A place where a sign changes: the cell it is in and a first guess.
#[derive(Clone, Copy)]
struct Place<R: Real> {
    found: R::Mask,
    cell: R,
    guess: R,
}

impl<R: Real> Place<R> {
    #[inline(always)]
    fn none() -> Self {
        Self {
            found: R::Mask::none(),
            cell: R::zero(),
            guess: R::zero(),
        }
    }

    /// Notes a change of sign between two node values.
    #[inline(always)]
    fn note(&mut self, mask: R::Mask, index: R, [left, right]: [R; 2]) {
        self.found = self.found | mask;
        self.cell = R::select(mask, index, self.cell);
        self.guess = R::select(mask, left / (left - right), self.guess);
    }
}

/// Sign pattern of a slope along the nodes.
#[derive(Clone, Copy)]
struct Pattern<R: Real> {
    top: Place<R>,
    odd: R::Mask,
}

impl<R: Real> Pattern<R> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            top: Place::none(),
            odd: R::Mask::none(),
        }
    }

    /// Looks at the slope and its own slope at both ends of a cell. One top is usual; valleys do
    /// not matter, since the ends count too.
    #[inline(always)]
    fn look(&mut self, inside: R::Mask, index: R, slope: [R; 2], curve: [R; 2]) {
        let zero = R::zero();
        let [up, still_up] = slope.map(|value| value.gt(zero));
        let top = inside & up & !still_up;
        self.odd = self.odd | (top & self.top.found) | (inside & hidden_pair(slope, curve));
        self.top.note(top, index, slope);
    }

    /// Refuses lanes with a valley, which may reach zero.
    #[inline(always)]
    fn refuse_valley(&mut self, inside: R::Mask, on: R::Mask, slope: [R; 2], curve: [R; 2]) {
        let [up, still_up] = slope.map(|value| value.gt(R::zero()));
        self.odd = self.odd | (on & !up & still_up) | (inside & turns_back(slope, curve));
    }
}

/// Whether a slope of one sign at two nodes turns towards zero and back between them, and so
/// steeply that it may reach it: tangents of twice the steepness do.
#[inline(always)]
fn hidden_pair<R: Real>(slope: [R; 2], curve: [R; 2]) -> R::Mask {
    let zero = R::zero();
    let two = R::splat(2.0);
    let [up, still_up] = slope.map(|value| value.gt(zero));
    let far = [slope[0] + two * curve[0], slope[1] - two * curve[1]];
    let [low, also_low] = far.map(|value| value.le(zero));
    let [high, also_high] = far.map(|value| value.ge(zero));
    turns_back(slope, curve)
        & ((up & still_up & (low | also_low)) | (!up & !still_up & (high | also_high)))
}

/// Whether a slope of one sign at two nodes turns towards zero and back between them.
#[inline(always)]
fn turns_back<R: Real>(slope: [R; 2], curve: [R; 2]) -> R::Mask {
    let zero = R::zero();
    let [up, still_up] = slope.map(|value| value.gt(zero));
    let [bent_up, still_bent_up] = curve.map(|value| value.gt(zero));
    (up & still_up & !bent_up & still_bent_up) | (!up & !still_up & bent_up & !still_bent_up)
}

/// What the first look along the nodes gives.
struct March<R: Real> {
    length: R,
    cells: usize,
    end: Place<R>,
    acceleration: Pattern<R>,
    force: Pattern<R>,
    compression: Pattern<R>,
    manipulator_power: Pattern<R>,
    foam_power: Pattern<R>,
}

/// A group with its cells.
pub struct Solved<'a, R: Real> {
    group: &'a Group<R>,
    cells: &'a [Short<R>],
    march: March<R>,
    /// Impact period in cells.
    end: R,
    /// Cell and place of the end.
    end_cell: [R; 2],
    accepted: R::Mask,
}

/// Values of the slopes at a node, in units of cells.
struct Node<R> {
    acceleration: [R; 3],
    force: [R; 2],
    compression: [R; 2],
    manipulator_power: [R; 2],
    foam_power: [R; 2],
}

impl<R: Real> Group<R> {
    #[inline(always)]
    fn node<const POWERS: bool>(&self, cell: &Short<R>, length: R, foam: [R; 2]) -> Node<R> {
        let two = R::splat(2.0);
        let six = R::splat(6.0);
        let rate = cell.compression_rate[0];
        let second = cell.compression_rate[1];
        let third = two * cell.compression_rate[2];
        let force_slope = foam[0] * rate + foam[1] * second;
        let force_curve = foam[0] * second + foam[1] * third;
        let (mut manipulator_power, mut foam_power) = ([R::zero(); 2], [R::zero(); 2]);
        if POWERS {
            let force = foam[0] * cell.start.compression[0] + foam[1] * rate;
            let speed = self.manipulator_speed * length - cell.lag_rate[0];
            let jet = [force, force_slope, force_curve];
            let lag = [cell.lag_rate[1], two * cell.lag_rate[2]];
            let [_, slope, curve] = product(jet, [speed, -lag[0], -lag[1]]);
            manipulator_power = [slope, curve];
            let [_, slope, curve] = product(jet, [rate, second, third]);
            foam_power = [slope, curve];
        }
        Node {
            acceleration: [
                cell.head_rate[1],
                two * cell.head_rate[2],
                six * cell.head_rate[3],
            ],
            force: [force_slope, force_curve],
            compression: [rate, second],
            manipulator_power,
            foam_power,
        }
    }

    /// Steps along the cells until every impact has ended or is refused.
    #[inline(always)]
    pub fn solve<'a, const POWERS: bool>(&'a self, space: &'a mut Workspace<R>) -> Solved<'a, R> {
        let zero = R::zero();
        let length = R::splat(SHORT_ANGLE) / self.plant.fastest();
        let numbers = self.plant.recurrence(length);
        let foam = [self.plant.foam[0], self.plant.foam[1] / length];
        let mut march = March {
            length,
            cells: 0,
            end: Place::none(),
            acceleration: Pattern::new(),
            force: Pattern::new(),
            compression: Pattern::new(),
            manipulator_power: Pattern::new(),
            foam_power: Pattern::new(),
        };
        let mut state = State::contact(self.closing_speed, length);
        let cells = &mut space.cells;
        state = cells[0].fill(&numbers, &Drive::none(), &state);
        let mut left = self.node::<POWERS>(&cells[0], length, foam);
        // Also false for what is not a number.
        let mut alive = left.acceleration[0].ge(zero) & length.gt(zero);
        for (index, cell) in cells.iter_mut().enumerate().skip(1) {
            state = cell.fill(&numbers, &Drive::none(), &state);
            march.cells = index;
            let right = self.node::<POWERS>(cell, length, foam);
            let here = R::splat((index - 1) as f64);
            let [value, slope, curve] =
                [0, 1, 2].map(|order| [left.acceleration[order], right.acceleration[order]]);
            let ends = alive & value[1].lt(zero);
            let on = alive & !ends;
            march.end.note(ends, here, value);
            march.acceleration.look(alive, here, slope, curve);
            march.acceleration.refuse_valley(alive, on, slope, curve);
            let pair = |of: fn(&Node<R>) -> R| [of(&left), of(&right)];
            let [force, bend] = [pair(|node| node.force[0]), pair(|node| node.force[1])];
            march.force.look(alive, here, force, bend);
            let rate = pair(|node| node.compression[0]);
            let bend = pair(|node| node.compression[1]);
            march.compression.look(alive, here, rate, bend);
            if POWERS {
                let power = pair(|node| node.manipulator_power[0]);
                let bend = pair(|node| node.manipulator_power[1]);
                march.manipulator_power.look(alive, here, power, bend);
                // A foam that expands takes no power.
                let closing = alive & rate[0].gt(zero);
                let power = pair(|node| node.foam_power[0]);
                let bend = pair(|node| node.foam_power[1]);
                march.foam_power.look(closing, here, power, bend);
            }
            alive = on;
            left = right;
            if !alive.any() {
                break;
            }
        }
        self.finish(cells, march)
    }

    /// Newton steps to the end of the impact.
    #[inline(always)]
    fn finish<'a>(&'a self, cells: &'a [Short<R>], march: March<R>) -> Solved<'a, R> {
        let series: [R; SHORT] = gathered(cells, march.end.cell, |cell| &cell.head_rate);
        let mut x = march.end.guess;
        let mut step = R::zero();
        for _ in 0..4 {
            let [_, value, slope] = derivatives(&series, x);
            step = value / slope;
            x = x - step;
        }
        let end = march.end.cell + x;
        let settled = step.abs().lt(R::splat(SETTLED_ZERO)) & in_cell(x);
        let accepted = march.end.found
            & settled
            & (end * march.length).lt(R::splat(self.horizon))
            & !march.acceleration.odd;
        Solved {
            group: self,
            cells,
            end_cell: [march.end.cell, x],
            march,
            end,
            accepted,
        }
    }
}

/// Coefficients of the cell that each lane is in.
#[inline(always)]
fn gathered<R: Real>(
    cells: &[Short<R>],
    index: R,
    series: impl Fn(&Short<R>) -> &[R; SHORT],
) -> [R; SHORT] {
    let mut gathered = [R::zero(); SHORT];
    if R::WIDTH == 1 {
        return *series(&cells[place(index.lane(0), cells.len())]);
    }
    let first = place(index.lane(0), cells.len());
    let mut same = true;
    for lane in 1..R::WIDTH {
        same &= place(index.lane(lane), cells.len()) == first;
    }
    if same {
        return *series(&cells[first]);
    }
    let mut places = [0; 16];
    for (lane, place_of) in places.iter_mut().enumerate().take(R::WIDTH) {
        *place_of = place(index.lane(lane), cells.len());
    }
    for (order, coefficient) in gathered.iter_mut().enumerate() {
        *coefficient = R::from_fn(|lane| series(&cells[places[lane]])[order].lane(lane));
    }
    gathered
}

/// Index of a cell.
#[inline(always)]
fn place(index: f64, cells: usize) -> usize {
    // The cast saturates; NaN gives 0.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let index = index as usize;
    index.min(cells - 1)
}

/// Whether a place is in its own cell, up to rounding.
#[inline(always)]
fn in_cell<R: Real>(x: R) -> R::Mask {
    x.ge(R::splat(-1e-9)) & x.le(R::splat(1.0 + 1e-9))
}

/// Value at a maximum, from value, slope and curvature near it.
#[inline(always)]
fn top<R: Real>([value, slope, curve]: [R; 3]) -> R {
    value - R::splat(0.5) * slope * slope / curve
}

impl<R: Real> Solved<'_, R> {
    /// Largest value of a function with one maximum at most inside the period.
    #[inline(always)]
    fn largest(
        &self,
        pattern: &Pattern<R>,
        start: R,
        end: R,
        jet: impl Fn(R) -> [R; 3],
    ) -> (R, R::Mask) {
        let mut x = pattern.top.guess;
        let mut near = jet(x);
        for _ in 0..2 {
            x = x - near[1] / near[2];
            near = jet(x);
        }
        let step = near[1] / near[2];
        let inside = pattern.top.found & (pattern.top.cell + x).le(self.end);
        let settled = !pattern.top.found | (step.abs().lt(R::splat(SETTLED_PEAK)) & in_cell(x));
        let ends = R::select(start.gt(end), start, end);
        let peak = top(near);
        let peak = R::select(inside & peak.gt(ends), peak, ends);
        (peak, settled & !pattern.odd)
    }

    /// The peaks.
    #[inline(always)]
    pub fn peaks(&self) -> GroupPeaks<R> {
        let length = self.march.length;
        let group = self.group;
        let foam = [group.plant.foam[0], group.plant.foam[1] / length];
        let head = gathered(self.cells, self.march.acceleration.top.cell, |cell| {
            &cell.head_rate
        });
        let (acceleration, settled) = self.largest(
            &self.march.acceleration,
            self.cells[0].head_rate[1],
            R::zero(),
            |x| {
                let [_, value, slope, curve] = derivatives(&head, x);
                [value, slope, curve]
            },
        );
        let mut accepted = self.accepted & settled;
        let end_rate = gathered(self.cells, self.end_cell[0], |cell| &cell.compression_rate);
        let end_start = self.start_of(self.end_cell[0]);
        let end_compression = integrated(end_start, &end_rate, self.end_cell[1]);
        let [end_speed] = derivatives(&end_rate, self.end_cell[1]);
        let end_force = foam[0] * end_compression + foam[1] * end_speed;
        let index = self.march.compression.top.cell;
        let rate = gathered(self.cells, index, |cell| &cell.compression_rate);
        let start = self.start_of(index);
        let (compression, settled) =
            self.largest(&self.march.compression, R::zero(), end_compression, |x| {
                let [slope, curve] = derivatives(&rate, x);
                [integrated(start, &rate, x), slope, curve]
            });
        accepted = accepted & settled;
        let index = self.march.force.top.cell;
        let rate = gathered(self.cells, index, |cell| &cell.compression_rate);
        let start = self.start_of(index);
        let first = foam[1] * self.cells[0].compression_rate[0];
        let (force, settled) = self.largest(&self.march.force, first, end_force, |x| {
            force_jet(foam, start, &rate, x)
        });
        GroupPeaks {
            head_acceleration: acceleration / (length * length),
            contact_force: force,
            compression,
            duration: self.end * length,
            accepted: accepted & settled,
            shaped: self.accepted,
        }
    }

    /// Compression at the start of the cell that each lane is in.
    #[inline(always)]
    fn start_of(&self, index: R) -> R {
        R::from_fn(|lane| {
            let cell = &self.cells[place(index.lane(lane), self.cells.len())];
            cell.start.compression[0].lane(lane)
        })
    }

    /// Velocity, acceleration and slope of the head at a time in cells.
    #[inline(always)]
    fn head(&self, time: R) -> [R; 3] {
        let index = R::from_fn(|lane| place(time.lane(lane), self.march.cells) as f64);
        let series = gathered(self.cells, index, |cell| &cell.head_rate);
        derivatives(&series, time - index)
    }

    /// The other metrics.
    #[inline(always)]
    pub fn rest(&self) -> GroupRest<R> {
        let length = self.march.length;
        let [velocity, _, _] = self.head(self.end);
        let (manipulator_power, foam_power, powered) = self.powers();
        let (average, clip, held) = self.held();
        let (injury, found) = self.injuries();
        GroupRest {
            mean: velocity / (self.end * length * length),
            injury,
            average,
            clip,
            manipulator_power,
            foam_power,
            accepted: self.accepted & powered & held & found,
        }
    }

    #[inline(always)]
    fn powers(&self) -> (R, R, R::Mask) {
        let length = self.march.length;
        let group = self.group;
        let foam = [group.plant.foam[0], group.plant.foam[1] / length];
        let speed = group.manipulator_speed * length;
        let end = self.end_cell;
        let end_rate = gathered(self.cells, end[0], |cell| &cell.compression_rate);
        let end_lag = gathered(self.cells, end[0], |cell| &cell.lag_rate);
        let [end_force, _, _] = force_jet(foam, self.start_of(end[0]), &end_rate, end[1]);
        let [end_lag] = derivatives(&end_lag, end[1]);
        let [end_closing] = derivatives(&end_rate, end[1]);
        let first_closing = self.cells[0].compression_rate[0];
        let first_force = foam[1] * first_closing;

        let pattern = &self.march.manipulator_power;
        let rate = gathered(self.cells, pattern.top.cell, |cell| &cell.compression_rate);
        let lag = gathered(self.cells, pattern.top.cell, |cell| &cell.lag_rate);
        let start = self.start_of(pattern.top.cell);
        let (manipulator, settled) = self.largest(
            pattern,
            first_force * speed,
            end_force * (speed - end_lag),
            |x| {
                let [rate_of_lag, second, third] = derivatives(&lag, x);
                product(
                    force_jet(foam, start, &rate, x),
                    [speed - rate_of_lag, -second, -third],
                )
            },
        );
        let pattern = &self.march.foam_power;
        let rate = gathered(self.cells, pattern.top.cell, |cell| &cell.compression_rate);
        let start = self.start_of(pattern.top.cell);
        let (power, also) = self.largest(
            pattern,
            first_force * first_closing,
            end_force * end_closing,
            |x| product(force_jet(foam, start, &rate, x), derivatives(&rate, x)),
        );
        (manipulator / length, power / length, settled & also)
    }

    /// Start of the window of a width, in cells, over which the acceleration is equal at both
    /// ends, or 0 if the best window starts with the impact; its last step, and both jets.
    #[inline(always)]
    fn window(&self, width: R, guess: R) -> (R, R, [[R; 3]; 2]) {
        let zero = R::zero();
        let room = self.end - width;
        let mut start = guess.min(room).max(zero);
        let mut step = zero;
        for _ in 0..4 {
            let [left, right] = [self.head(start), self.head(start + width)];
            let (gain, bend) = (right[1] - left[1], right[2] - left[2]);
            // Towards the better side where the mean is not concave.
            let uphill = R::select(gain.lt(zero), -start, R::splat(0.5) * width);
            let move_by = R::select(bend.lt(zero), -gain / bend, uphill);
            let next = (start + move_by).min(room).max(zero);
            step = (next - start).abs();
            start = next;
        }
        let [left, right] = [self.head(start), self.head(start + width)];
        // At the end of the room the mean would have to grow still.
        let stuck = start.ge(room) & right[1].lt(left[1]);
        let step = R::select(stuck, width, step);
        (start, step, [left, right])
    }

    #[inline(always)]
    fn held(&self) -> (R, R, R::Mask) {
        let length = self.march.length;
        let width = R::splat(HELD_WINDOW) / length;
        let (_, step, [left, right]) = self.window(width, self.peak_time() - R::splat(0.5) * width);
        let per_square = R::splat(1.0) / (length * length);
        let nan = R::splat(f64::NAN);
        let exists = width.le(self.end);
        let average = (right[0] - left[0]) / (length * R::splat(HELD_WINDOW));
        let clip = left[1].min(right[1]) * per_square;
        let settled = step.lt(self.end * R::splat(SETTLED_LEVEL)) | !exists;
        (
            R::select(exists, average, nan),
            R::select(exists, clip, nan),
            settled,
        )
    }

    /// Time of the peak acceleration, in cells, as first seen.
    #[inline(always)]
    fn peak_time(&self) -> R {
        let top = &self.march.acceleration.top;
        R::select(top.found, top.cell + top.guess, R::zero())
    }

    /// Injury criteria: the window with free ends, where it is not too wide; else the full one.
    #[inline(always)]
    fn injuries(&self) -> ([R; 2], R::Mask) {
        let length = self.march.length;
        let (free, settled) = self.free_window();
        let free_width = free[1] - free[0];
        let middle = R::splat(0.5) * (free[0] + free[1]);
        let free_value = self.criterion(free);
        let mut accepted = R::Mask::splat(true);
        let values = crate::criteria::INJURY_WINDOWS.map(|width| {
            let width = R::splat(width) / length;
            let fits = free_width.le(width);
            let mut value = free_value;
            if (!fits & self.accepted).any() {
                let (_, step, [left, right]) = self.window(width, middle - R::splat(0.5) * width);
                let full = criterion(right[0] - left[0], width, length);
                value = R::select(fits, free_value, full);
                let near = step.lt(self.end * R::splat(SETTLED_WINDOW));
                accepted = accepted & (fits | near);
            }
            value
        });
        (values, accepted & settled)
    }

    #[inline(always)]
    fn criterion(&self, [start, end]: [R; 2]) -> R {
        let rise = self.head(end)[0] - self.head(start)[0];
        criterion(rise, end - start, self.march.length)
    }

    /// Newton steps to the best window without a limit of its width.
    #[inline(always)]
    fn free_window(&self) -> ([R; 2], R::Mask) {
        let zero = R::zero();
        let [mut start, mut end] = self.half_level();
        let mut moved = zero;
        for _ in 0..5 {
            let [v1, a1, d1] = self.head(start);
            let [v2, a2, d2] = self.head(end);
            let (rise, width) = (v2 - v1, end - start);
            let per_rise = R::splat(1.0) / rise;
            let (u1, u2) = (a1 * per_rise, a2 * per_rise);
            let over = R::splat(1.5) / width;
            let factor = R::splat(2.5);
            let (g1, g2) = (over - factor * u1, factor * u2 - over);
            let curve = over / width;
            let h11 = curve - factor * (d1 * per_rise + u1 * u1);
            let h22 = curve + factor * (d2 * per_rise - u2 * u2);
            let h12 = factor * u1 * u2 - curve;
            let determinant = h11 * h22 - h12 * h12;
            let pinned = start.le(zero) & g1.le(zero);
            let s1 = R::select(pinned, zero, (h12 * g2 - h22 * g1) / determinant);
            let s2 = R::select(pinned, -g2 / h22, (h12 * g1 - h11 * g2) / determinant);
            let next_start = (start + s1).max(zero);
            let next_end = (end + s2).min(self.end);
            moved = (next_start - start).abs() + (next_end - end).abs();
            start = next_start;
            end = next_end;
        }
        let settled = moved.lt(self.end * R::splat(SETTLED_WINDOW)) & start.lt(end);
        ([start, end], settled)
    }

    /// Where the acceleration crosses half its peak at the nodes, in cells.
    #[inline(always)]
    fn half_level(&self) -> [R; 2] {
        let half = R::splat(0.5) * self.node_peak();
        let (mut start, mut end) = (R::zero(), self.end);
        for index in 0..self.march.cells {
            let [left, right] = [index, index + 1].map(|node| self.cells[node].head_rate[1]);
            let place = R::splat(index as f64) + (half - left) / (right - left);
            let rises = left.lt(half) & right.ge(half) & place.lt(self.end);
            let falls = left.ge(half) & right.lt(half) & place.lt(self.end);
            start = R::select(rises, place, start);
            end = R::select(falls, place, end);
        }
        [start, end]
    }

    /// Largest acceleration at the nodes, or by a parabola at the peak.
    #[inline(always)]
    fn node_peak(&self) -> R {
        let mut peak = self.cells[0].head_rate[1];
        for index in 1..=self.march.cells {
            let inside = R::splat(index as f64).lt(self.end);
            let value = self.cells[index].head_rate[1];
            peak = R::select(inside & value.gt(peak), value, peak);
        }
        peak
    }
}

/// Contact force in a cell with two derivatives.
#[inline(always)]
fn force_jet<R: Real>(foam: [R; 2], start: R, rate: &[R; SHORT], x: R) -> [R; 3] {
    let [first, second, third] = derivatives(rate, x);
    let value = integrated(start, rate, x);
    [
        foam[0] * value + foam[1] * first,
        foam[0] * first + foam[1] * second,
        foam[0] * second + foam[1] * third,
    ]
}

/// Value and two derivatives of a product.
#[inline(always)]
fn product<R: Real>([f, f1, f2]: [R; 3], [g, g1, g2]: [R; 3]) -> [R; 3] {
    let cross = f1 * g1;
    [f * g, f1 * g + f * g1, f2 * g + cross + cross + f * g2]
}

/// `T^-1.5 rise^2.5` from a rise in m per cell and a width in cells.
#[inline(always)]
fn criterion<R: Real>(rise: R, width: R, length: R) -> R {
    let duration = width * length;
    let mean = rise / (length * duration);
    R::select(
        rise.gt(R::zero()),
        duration * mean * mean * mean.sqrt(),
        R::zero(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{Foam, HEAD_MINIMUM, MANIPULATOR_1, System, Target};

    #[test]
    fn a_map_of_foams_has_the_usual_shape() {
        let mut refused = [0_usize; 10];
        let nodes = 60;
        for row in 0..nodes * nodes {
            let system = System {
                manipulator: MANIPULATOR_1,
                foam: Foam {
                    stiffness: 10e3 + 50e3 * (row % nodes) as f64 / nodes as f64,
                    damping: 200.0 * (row / nodes) as f64 / nodes as f64,
                    thickness: 0.0254,
                    linear_range: 0.02,
                },
                head: Target::Free(HEAD_MINIMUM),
            };
            let group = Group {
                plant: Plant::of(&system),
                closing_speed: 1.25,
                manipulator_speed: 1.25,
                horizon: 0.2,
            };
            let mut space = Workspace::new();
            let solved = group.solve::<true>(&mut space);
            let march = &solved.march;
            for (count, bad) in refused.iter_mut().zip([
                !march.end.found,
                march.acceleration.odd,
                march.force.odd,
                march.compression.odd,
                !solved.accepted,
                !solved.peaks().accepted,
                !solved.powers().2,
                !solved.held().2,
                !solved.free_window().1,
                !solved.rest().accepted,
            ]) {
                *count += usize::from(bad);
            }
        }
        println!("{refused:?}");
        // One in a hundred costs about as much as all the others.
        assert!(refused[9] * 100 < nodes * nodes);
    }
}
