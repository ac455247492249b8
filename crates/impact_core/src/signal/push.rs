//! The push around a window of a sampled acceleration, which tells its unit.

/// Area below a signal from where it changes its sign before the window `start..end` in s to where
/// it does after it, by the trapezoid rule, in its unit times s.
///
/// Times rise and both slices are of one length.
#[must_use]
pub fn push_around(time: &[f64], acceleration: &[f64], start: f64, end: f64) -> f64 {
    let ended = |value: &f64| *value <= 0.0;
    let first = time.partition_point(|now| *now < start);
    let last = time.partition_point(|now| *now < end);
    let begin = acceleration[..first]
        .iter()
        .rposition(ended)
        .map_or(0, |place| place + 1);
    let finish = acceleration[last..]
        .iter()
        .position(ended)
        .map_or(acceleration.len(), |place| last + place);
    let push = begin..finish;
    let steps = time[push.clone()].windows(2);
    acceleration[push]
        .windows(2)
        .zip(steps)
        .map(|(value, time)| 0.5 * (value[0] + value[1]) * (time[1] - time[0]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_push_ends_where_the_sign_changes_and_not_with_the_window() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let signal = [5.0, -1.0, 2.0, 4.0, 2.0, 1.0, 0.0, 9.0];
        // From 2 s to 5 s.
        assert!((push_around(&time, &signal, 3.0, 4.0) - (3.0 + 3.0 + 1.5)).abs() < 1e-15);
    }

    #[test]
    fn a_push_without_an_end_is_the_whole_signal() {
        let found = push_around(&[0.0, 0.5, 2.0], &[1.0, 3.0, 1.0], 0.0, 0.5);
        assert!((found - 4.0).abs() < 1e-15);
        assert_eq!(push_around(&[0.0, 1.0], &[-1.0, -2.0], 0.0, 1.0), 0.0);
    }
}
