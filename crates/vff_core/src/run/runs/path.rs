//! The path of one robot, how far it is from straight, and the least distance to an obstacle on it.

use super::means::{Mark, Means};
use crate::lanes::Vector2;
use crate::run::options::Clock;
use crate::run::scene::body_at;
use crate::world::motion::Piece;
use crate::world::obstacle::Shape;
use crate::world::scenario::PlacedObstacle;

type Vector = Vector2<f64>;

/// Motion steps of the shortest piece that is known to be nearly straight.
const SHORTEST: usize = 8;

/// Fewest motion steps for which it pays to look first where the robot is about nearest.
const APPROACHED: usize = 8 * SHORTEST;

/// Most motion steps on each side of the nearest one that are looked at one by one.
const FEW: f64 = SHORTEST as f64;

/// Motion steps between two marks of a path, as a power of two of [`SHORTEST`].
const MARKED: usize = 2;

/// Places of a robot after motion steps.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// Step of the first place.
    begin: usize,
    places: Vec<[f64; 2]>,
    /// Most by which the robot was off the straight way at constant speed, in m: in each piece of
    /// [`SHORTEST`] steps, of twice as many, and so on.
    bends: Vec<Vec<f64>>,
    /// The same for what is left over behind the last piece, with its first step after the first place.
    rest: (usize, f64),
}

impl Path {
    pub fn from(start: [f64; 2]) -> Self {
        Self {
            begin: 0,
            places: vec![start],
            bends: Vec::new(),
            rest: (0, 0.0),
        }
    }

    #[inline]
    pub fn push(&mut self, place: [f64; 2]) {
        self.places.push(place);
    }

    /// Number of places.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Step of the first place.
    pub fn first(&self) -> usize {
        self.begin
    }

    /// Step of the last place.
    pub fn last(&self) -> usize {
        self.begin + self.places.len() - 1
    }

    /// Forgets all places but the last one.
    pub fn forget(&mut self) {
        let last = self.places.len() - 1;
        self.begin += last;
        self.places.drain(..last);
        self.bends.clear();
    }

    pub fn at(&self, step: usize) -> Vector {
        self.places[step - self.begin].into()
    }

    /// Measures the pieces that are new.
    pub fn measure(&mut self) {
        let steps = self.places.len() - 1;
        let (mut level, mut size) = (0, SHORTEST);
        while size <= steps {
            if self.bends.len() == level {
                self.bends.push(Vec::new());
            }
            while (self.bends[level].len() + 1) * size <= steps {
                let bend = self.bend_of(level, self.bends[level].len(), size);
                self.bends[level].push(bend);
            }
            (level, size) = (level + 1, 2 * size);
        }
        let whole = steps / SHORTEST * SHORTEST;
        self.rest = (whole, self.off_straight(whole, steps - whole));
    }

    /// Most by which places between two were off the straight way, in m.
    fn off_straight(&self, first: usize, steps: usize) -> f64 {
        let place = |step: usize| Vector::from(self.places[first + step]);
        let way = (place(steps) - place(0)) * (1.0 / steps as f64);
        let off = |step: usize| (place(step) - (place(0) + way * step as f64)).norm_squared();
        (1..steps).map(off).fold(0.0, f64::max).sqrt()
    }

    /// End of the head, the first few steps: a robot at rest mostly has sped up by then.
    pub fn head(&self) -> usize {
        self.last().min(self.begin + (SHORTEST << MARKED))
    }

    /// Mean velocities on all of the path, which has been measured.
    pub fn means(&self) -> Means {
        let (size, last) = (SHORTEST << MARKED, self.places.len() - 1);
        let mark = |steps: usize, bend: f64| Mark {
            steps,
            place: self.places[steps].into(),
            bend,
        };
        let single = |steps: usize| mark(steps, 0.0);
        // Single steps at both ends, and whole pieces between them.
        let head = self.head() - self.begin;
        let tail = head.max(last.saturating_sub(1) / size * size);
        let piece = |number: usize| mark(number * size, self.bends[MARKED][number - 1]);
        let pieces = (head / size + 1..=tail / size).map(piece);
        let marks = (1..=head).map(single).chain(pieces);
        let marks = marks.chain((tail + 1..=last).map(single));
        Means::of(marks, [0, head, last].map(single))
    }

    fn bend_of(&self, level: usize, piece: usize, size: usize) -> f64 {
        let place = |step: usize| Vector::from(self.places[piece * size + step]);
        if level == 0 {
            return self.off_straight(piece * size, size);
        }
        let (from, to) = (place(0), place(size));
        let halves = &self.bends[level - 1][2 * piece..2 * piece + 2];
        (place(size / 2) - (from + to) * 0.5).norm() + halves[0].max(halves[1])
    }

    /// Steps of the largest piece that begins at a step and ends by another one; fewer than
    /// [`SHORTEST`] where there is none.
    fn piece(&self, from: usize, to: usize) -> usize {
        let (first, most) = (from - self.begin, to - from);
        let short = first % SHORTEST;
        if short > 0 || most < SHORTEST {
            return most.min(SHORTEST - short);
        }
        // A power of two, by which the first step is divisible.
        1 << most.ilog2().min(first.trailing_zeros())
    }

    /// How far the robot was off the straight way in a piece, in m.
    fn bend(&self, from: usize, steps: usize) -> Option<f64> {
        let first = from - self.begin;
        let Some(level) = (steps / SHORTEST).checked_ilog2() else {
            let (rest, bend) = self.rest;
            return (first == rest && from + steps == self.last()).then_some(bend);
        };
        let piece = (first / SHORTEST) >> level;
        self.bends.get(level as usize)?.get(piece).copied()
    }
}

/// An obstacle as the robot passes it.
pub(super) struct Passage<'a> {
    pub path: &'a Path,
    pub placed: &'a PlacedObstacle,
    pub clock: &'a Clock,
    /// Most by which the distance changes in a motion step, and room for rounding, in m.
    pub stride: f64,
    pub margin: f64,
    /// Least distance so far in m, and its square.
    pub nearest: f64,
    pub least: f64,
}

/// Whether all places of a straight way at constant speed between its first step and its last but one
/// are farther away than a distance.
#[inline]
fn is_farther(from: Vector, (way, steps): (Vector, f64), distance: f64) -> bool {
    let step = way * (1.0 / steps);
    let (first, inner) = (from + step, way - step * 2.0);
    let (along, square) = (-first.dot(&inner), inner.dot(&inner));
    let low = distance * distance;
    if along <= 0.0 {
        return first.dot(&first) > low;
    }
    if along >= square {
        let last = first + inner;
        return last.dot(&last) > low;
    }
    let across = first.perp(&inner);
    across * across > low * square
}

/// After how many steps a straight way at constant speed from one place to another is nearest to zero.
#[inline]
fn foot(from: Vector, to: Vector, steps: usize) -> f64 {
    let way = to - from;
    -from.dot(&way) / way.dot(&way) * steps as f64
}

/// The step next to a number of them, between two.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn step_at(place: f64, [first, last]: [usize; 2]) -> usize {
    ((place + 0.5) as usize).clamp(first, last)
}

/// First and last of the steps of a straight way at constant speed that may be nearer than a distance, and more,
/// where they are few.
#[inline]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn nearer_steps(from: Vector, (way, steps): (Vector, usize), distance: f64) -> Option<[usize; 2]> {
    let square = way.dot(&way);
    let across = from.perp(&way);
    let share = steps as f64 / square;
    let left = distance * distance * square - across * across;
    let half = left.max(0.0).sqrt() * share + 1.0;
    let foot = -from.dot(&way) * share;
    // Not where a number is not one.
    (half <= FEW).then(|| [foot - half, foot + half].map(|step| step as usize))
}

/// An obstacle as seen from the robot after a motion step.
#[derive(Clone, Copy)]
struct Sample {
    step: usize,
    offset: Vector,
    distance: f64,
    /// Piece of its motion.
    piece: usize,
}

impl Passage<'_> {
    /// Looks at all steps of which any may be nearer than the nearest one.
    pub fn look(&mut self, first: usize, last: usize) {
        if let Some(motion) = self.placed.straight_disc() {
            return self.look_straight(motion, first, last);
        }
        // What comes nearer is nearest at last.
        let end = self.at(last, 0);
        let mut from = self.at(first, 0);
        while from.step < last {
            let step = from.step + self.path.piece(from.step, last);
            let to = if step == last {
                end
            } else {
                self.at(step, from.piece)
            };
            self.between(&from, &to);
            from = to;
        }
    }

    /// The same for a disc that moves straight on, or stands: without a root for each step.
    fn look_straight(&mut self, motion: &Piece, first: usize, last: usize) {
        let end = self.sees(motion, last);
        let (mut step, mut from) = (first, self.sees(motion, first));
        self.approach(motion, (first, from), (last, end));
        while step < last {
            let next = step + self.path.piece(step, last);
            let to = if next == last {
                end
            } else {
                self.sees(motion, next)
            };
            self.between_straight(motion, (step, from), (next, to));
            (step, from) = (next, to);
        }
    }

    /// Looks at steps near the nearest one, so that few others may be nearer still: where the straight way is nearest,
    /// and where one is that keeps the motion the robot has there.
    fn approach(
        &mut self,
        motion: &Piece,
        (first, from): (usize, Vector),
        (last, to): (usize, Vector),
    ) {
        if last - first <= APPROACHED {
            return;
        }
        let place = foot(from, to, last - first) + first as f64;
        let begin = step_at(place, [first, last - SHORTEST]);
        let ends = [begin, begin + SHORTEST].map(|step| self.sees(motion, step));
        let place = foot(ends[0], ends[1], SHORTEST) + begin as f64;
        self.sees(motion, step_at(place, [first, last]));
    }

    fn between_straight(
        &mut self,
        motion: &Piece,
        (first, from): (usize, Vector),
        (last, to): (usize, Vector),
    ) {
        let steps = last - first;
        if steps <= 1 {
            return;
        }
        if let Some(bend) = self.path.bend(first, steps) {
            let low = self.nearest + self.margin + bend;
            // Where both stand all steps are alike.
            let stands = || {
                let still = self.path.at(first) == self.path.at(last);
                bend == 0.0 && motion.velocity == [0.0; 2] && still
            };
            if is_farther(from, (to - from, steps as f64), low) || stands() {
                return;
            }
            if let Some([begin, end]) = nearer_steps(from, (to - from, steps), low) {
                for step in begin.max(1)..=end.min(steps - 1) {
                    self.sees(motion, first + step);
                }
                return;
            }
        }
        if steps > SHORTEST {
            let step = first + steps / 2;
            let middle = self.sees(motion, step);
            self.between_straight(motion, (first, from), (step, middle));
            self.between_straight(motion, (step, middle), (last, to));
            return;
        }
        for step in first + 1..last {
            self.sees(motion, step);
        }
    }

    #[inline]
    fn sees(&mut self, motion: &Piece, step: usize) -> Vector {
        let (place, _) = motion.at(self.clock.time(step));
        let offset = self.path.at(step) - Vector::from(place);
        let squared = offset.dot(&offset);
        if squared < self.least {
            (self.least, self.nearest) = (squared, squared.sqrt());
        }
        offset
    }

    fn at(&mut self, step: usize, mut piece: usize) -> Sample {
        let body = body_at(self.placed, self.clock.time(step), &mut piece);
        let seen = body.offset(self.path.at(step));
        let distance = seen.distance_squared.sqrt();
        if seen.distance_squared < self.least {
            (self.least, self.nearest) = (seen.distance_squared, distance);
        }
        Sample {
            step,
            offset: seen.vector,
            distance,
            piece,
        }
    }

    fn between(&mut self, from: &Sample, to: &Sample) {
        let steps = to.step - from.step;
        if self.is_above(from, to, steps) {
            return;
        }
        if steps > SHORTEST {
            let middle = self.at(from.step + steps / 2, from.piece);
            self.between(from, &middle);
            self.between(&middle, to);
            return;
        }
        let mut seen = *from;
        loop {
            let step = seen.step + 1 + self.steps_above(seen.distance);
            if step >= to.step {
                return;
            }
            seen = self.at(step, seen.piece);
        }
    }

    /// Whether no step between two is nearer than the nearest one.
    fn is_above(&self, from: &Sample, to: &Sample, steps: usize) -> bool {
        let low = self.nearest + self.margin;
        let count = steps as f64;
        if 0.5 * (from.distance + to.distance - count * self.stride) > low {
            return true;
        }
        let straight =
            from.piece == to.piece && matches!(self.placed.obstacle.shape, Shape::Disc { .. });
        let Some(bend) = self.path.bend(from.step, steps).filter(|_| straight) else {
            return false;
        };
        // Of the straight way the part from the first step to the last but one.
        let way = to.offset - from.offset;
        let step = way * (1.0 / count);
        let (first, inner) = (from.offset + step, way - step * 2.0);
        let square = inner.dot(&inner);
        let foot = if square > 0.0 {
            (-first.dot(&inner) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        if (first + inner * foot).norm() - bend > low {
            return true;
        }
        // Where both stand all steps are alike.
        let stands = self.path.at(from.step) == self.path.at(to.step);
        bend == 0.0
            && stands
            && self.placed.obstacle.motion.piece(from.piece).0.velocity == [0.0; 2]
    }

    /// Motion steps for which an obstacle at a distance in m is not nearer than the nearest one.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    fn steps_above(&self, distance: f64) -> usize {
        ((distance - self.nearest - self.margin) / self.stride) as usize
    }
}
