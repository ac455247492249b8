//! A walk along the response that notes where signs change.

use super::apart::inlined;
use super::arithmetic::Each;
use numeric::lanes::{Number, Truth};

/// A piece of time with the values and slopes of a function at both of its ends.
#[derive(Clone, Copy)]
pub struct Piece<R> {
    /// Start, in cells.
    pub from: R,
    /// Duration, in cells.
    pub width: R,
    /// Values at both ends.
    pub values: [R; 2],
    /// Slopes at both ends, per cell.
    pub slopes: [R; 2],
}

impl<R: Number> Piece<R> {
    #[inline(always)]
    fn select(mask: R::Mask, new: Self, old: Self) -> Self {
        let pair = inlined(
            #[inline(always)]
            |[a, b]: [R; 2], [c, d]: [R; 2]| [R::select(mask, a, c), R::select(mask, b, d)],
        );
        Self {
            from: R::select(mask, new.from, old.from),
            width: R::select(mask, new.width, old.width),
            values: pair(new.values, old.values),
            slopes: pair(new.slopes, old.slopes),
        }
    }

    /// Coefficients of the cubic over the piece, from 0 to 1.
    #[inline(always)]
    fn cubic(&self) -> [R; 4] {
        let [left, right] = self.values;
        let [first, last] = self.slopes.each(
            #[inline(always)]
            |slope| slope * self.width,
        );
        let rise = right - left;
        let bend = rise.mul_add(rise.like(3.0), -first) - first - last;
        [left, first, bend, first + last - rise - rise]
    }

    /// Where the cubic is zero if its ends differ in sign, in cells.
    #[inline(always)]
    pub fn zero(&self) -> R {
        let [c0, c1, c2, c3] = self.cubic();
        let (none, whole) = (c0.like(0.0), c0.like(1.0));
        let mut x = self.values[0] / (self.values[0] - self.values[1]);
        for _ in 0..2 {
            let value = c3.mul_add(x, c2).mul_add(x, c1).mul_add(x, c0);
            let slope = (c3 * 3.0).mul_add(x, c2 + c2).mul_add(x, c1);
            x = (x - value / slope).max(none).min(whole);
        }
        x.mul_add(self.width, self.from)
    }

    /// Value of the cubic at its extremum if its slopes differ in sign.
    #[inline(always)]
    fn turn(&self) -> R {
        let [c0, c1, c2, c3] = self.cubic();
        let zero = c0.like(0.0);
        // Where the slope c1 + 2 c2 x + 3 c3 x^2 changes sign the way that it does over the piece. Steps
        // from the secant may run out of a piece in which it bends.
        let rises = self.slopes[1].gt(zero);
        let [a, b, c] = [c1, c2, c3].each(
            #[inline(always)]
            |number| R::select(rises, number, -number),
        );
        let triple = c * 3.0;
        let root = (-a).mul_add(triple, b * b).max(zero).sqrt();
        let early = b.ge(zero);
        let x = R::select(early, -a, root - b) / R::select(early, root + b, triple);
        let x = x.max(zero).min(zero.like(1.0));
        c3.mul_add(x, c2).mul_add(x, c1).mul_add(x, c0)
    }
}

/// A place where a function changes sign.
#[derive(Clone, Copy)]
pub struct SignChange<R: Number> {
    /// Lanes that have one.
    pub found: R::Mask,
    /// The piece that it is in, and what it was before the last note: written where it was read it would
    /// be a store under a mask, which some processors have no fast one of.
    pieces: [Piece<R>; 2],
    latest: usize,
}

impl<R: Number> SignChange<R> {
    /// No place yet, with lanes like those of zero.
    #[inline(always)]
    pub fn none(zero: R) -> Self {
        Self {
            found: zero.truth(false),
            pieces: [Piece {
                from: zero,
                width: zero,
                values: [zero; 2],
                slopes: [zero; 2],
            }; 2],
            latest: 0,
        }
    }

    /// The piece that it is in.
    #[inline(always)]
    pub fn piece(&self) -> &Piece<R> {
        &self.pieces[self.latest % 2]
    }

    /// Forgets the place.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.found = self.piece().from.truth(false);
    }

    /// Notes a piece.
    #[inline(always)]
    pub fn note(&mut self, mask: R::Mask, piece: Piece<R>) {
        self.found = self.found | mask;
        let noted = Piece::select(mask, piece, *self.piece());
        self.latest = 1 - self.latest % 2;
        self.pieces[self.latest] = noted;
    }
}

/// How near to zero, over the difference of slopes, the cubic may turn back: it is nearer than
/// that to the function.
const CLEAR: f64 = 0.01;

/// Lanes in which a function of one sign at both ends of a piece turns towards zero and back
/// between them, so near to it that it may reach it, from above and from below, and how far it
/// reaches beyond zero at most. The cubic may be wrong by `slack` beside that.
#[inline(always)]
pub fn touching<R: Number>(inside: R::Mask, piece: &Piece<R>, slack: R) -> ([R::Mask; 2], R) {
    let zero = slack.like(0.0);
    let [up, still_up] = piece.values.each(
        #[inline(always)]
        |value| value.gt(zero),
    );
    let [bent_up, still_bent_up] = piece.slopes.each(
        #[inline(always)]
        |slope| slope.gt(zero),
    );
    let from_above = inside & up & still_up & !bent_up & still_bent_up;
    let from_below = inside & !(up | still_up) & bent_up & !still_bent_up;
    if !(from_above | from_below).any() {
        return ([zero.truth(false); 2], zero);
    }
    // The cubic stays on one side of its control points: most pieces need no look at its extremum.
    let third = piece.width * (1.0 / 3.0);
    let difference = ((piece.slopes[0] - piece.slopes[1]) * piece.width).abs();
    let clear = difference.mul_add(slack.like(CLEAR), slack);
    let first = third.mul_add(piece.slopes[0], piece.values[0]);
    let last = (-third).mul_add(piece.slopes[1], piece.values[1]);
    let from_above = from_above & first.min(last).le(clear);
    let from_below = from_below & (-first.max(last)).le(clear);
    if !(from_above | from_below).any() {
        return ([zero.truth(false); 2], zero);
    }
    let turn = piece.turn();
    let beyond = R::select(from_above, clear - turn, clear + turn);
    let may = beyond.ge(zero);
    ([from_above & may, from_below & may], beyond)
}

/// Tops of a function, from the signs of its slope along the way.
#[derive(Clone, Copy)]
pub struct Tops<R: Number> {
    /// Up to two tops.
    pub places: [SignChange<R>; 2],
    /// A piece that may hide a top: the function is not above its value at this time by more than
    /// what follows.
    pub hidden: (R::Mask, R, R),
    /// Lanes with more of them.
    pub odd: R::Mask,
}

impl<R: Number> Tops<R> {
    /// No top yet, with lanes like those of zero.
    #[inline(always)]
    pub fn new(zero: R) -> Self {
        Self {
            places: [SignChange::none(zero); 2],
            hidden: (zero.truth(false), zero, zero),
            odd: zero.truth(false),
        }
    }

    /// Forgets the tops; numbers of lanes without one are not read.
    #[inline(always)]
    pub fn clear(&mut self) {
        for place in &mut self.places {
            place.clear();
        }
        let none = self.hidden.1.truth(false);
        self.hidden.0 = none;
        self.odd = none;
    }

    /// Looks at a piece of the slope.
    #[inline(always)]
    pub fn look(&mut self, inside: R::Mask, piece: &Piece<R>) {
        let zero = piece.from.like(0.0);
        let [up, still_up] = piece.values.each(
            #[inline(always)]
            |value| value.gt(zero),
        );
        let top = inside & up & !still_up;
        let ([from_above, from_below], beyond) = touching(inside, piece, zero);
        let touches = from_above | from_below;
        if touches.any() {
            let (found, time, excess) = self.hidden;
            self.odd = self.odd | (found & touches);
            // The higher end of the piece.
            let end = R::select(from_above, piece.from + piece.width, piece.from);
            self.hidden = (
                found | touches,
                R::select(touches, end, time),
                R::select(touches, beyond * piece.width, excess),
            );
        }
        let again = top & self.places[0].found;
        if again.any() {
            self.odd = self.odd | (again & self.places[1].found);
            self.places[1].note(again, *piece);
        }
        let first = top & !again;
        if first.any() {
            self.places[0].note(first, *piece);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_that_bends_within_a_piece_cannot_hide_a_top() {
        // The slope of an acceleration with tops on both sides of a low valley: below zero at both ends
        // and above it by 0.005 between them, where steps from the secant run out of the piece.
        let piece = Piece {
            from: 4.0,
            width: 1.0,
            values: [-0.0016, -0.0348],
            slopes: [0.0155, -0.1669],
        };
        assert!((piece.turn() - 0.005_019_4).abs() < 1e-6);
        let mut tops = Tops::<f64>::new(0.0);
        tops.look(true, &piece);
        let (hidden, time, excess) = tops.hidden;
        assert!(hidden && time == 4.0 && excess > 0.005, "{excess}");
    }

    #[test]
    fn the_extremum_of_a_cubic_is_found_wherever_it_bends() {
        for index in 0..2000 {
            let mix = |factor: usize| ((index * factor) % 997) as f64 / 997.0;
            let slopes = [-mix(31) - 1e-9, mix(577) + 1e-9];
            for sign in [1.0, -1.0] {
                let piece = Piece {
                    from: 0.0,
                    width: 1.0,
                    values: [sign * mix(113), sign * mix(293)],
                    slopes: slopes.map(|slope| sign * slope),
                };
                let [c0, c1, c2, c3] = piece.cubic();
                let least = (0..=10_000)
                    .map(|step| f64::from(step) * 1e-4)
                    .map(|x| sign * (((c3 * x + c2) * x + c1) * x + c0))
                    .fold(f64::INFINITY, f64::min);
                assert!((sign * piece.turn() - least).abs() < 1e-7, "{index}");
            }
        }
    }
}
