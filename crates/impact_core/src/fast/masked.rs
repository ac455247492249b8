//! Numbers of impacts side by side, with the lanes in which they hold.

use numeric::lanes::Number;

/// A number of each lane, with the lanes in which it holds.
#[derive(Clone, Copy)]
pub struct MaskedValue<R: Number> {
    /// The number.
    pub value: R,
    /// Lanes in which it holds.
    pub holds: R::Mask,
}

impl<R: Number> MaskedValue<R> {
    /// A number that was not asked for, with lanes like those of another one.
    #[inline(always)]
    pub fn nothing(like: R) -> Self {
        Self {
            value: like.like(f64::NAN),
            holds: like.truth(false),
        }
    }

    /// The number times another one.
    #[inline(always)]
    pub fn times(self, factor: R) -> Self {
        Self {
            value: self.value * factor,
            ..self
        }
    }

    /// The number over another one.
    #[inline(always)]
    pub fn over(self, divisor: R) -> Self {
        Self {
            value: self.value / divisor,
            ..self
        }
    }
}

/// Peaks, duration, mean and powers, accelerations in m/s^2.
pub struct GroupPeaks<R: Number> {
    /// Acceleration of the head.
    pub head_acceleration: MaskedValue<R>,
    /// Contact force, in N.
    pub contact_force: MaskedValue<R>,
    /// Compression, in m.
    pub compression: MaskedValue<R>,
    /// Impact period, in s.
    pub duration: MaskedValue<R>,
    /// Mean acceleration.
    pub mean: MaskedValue<R>,
    /// Power from the manipulator and power of compression, in W.
    pub powers: [MaskedValue<R>; 2],
    /// Time of the peak acceleration and two derivatives after it.
    pub(super) top: [R; 3],
}

/// All other metrics, accelerations in m/s^2.
pub struct GroupRest<R: Number> {
    /// Injury criteria for both windows.
    pub injury: [MaskedValue<R>; 2],
    /// Largest 3 ms mean and largest level held for 3 ms.
    pub held: [MaskedValue<R>; 2],
    /// Deferred lanes.
    pub put_off: R::Mask,
}
