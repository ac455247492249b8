//! Who has stood still for a while.

use nalgebra::Vector2;

/// A person who moved less than this, in m ...
pub(super) const MOVED: f64 = 0.1;
/// ... in this time, in s, stands.
pub(super) const WINDOW: f64 = 2.0;

/// Recent positions of a person.
#[derive(Clone, Copy, Debug)]
struct PersonHistory {
    /// Place from which the person has moved less than [`MOVED`], in m.
    anchor: Vector2<f64>,
    /// Since when, in s.
    since: f64,
    stands: bool,
}

/// Who moved less than 0.1 m in 2 s.
#[derive(Clone, Debug, Default)]
pub struct Standing {
    tracks: Vec<Option<PersonHistory>>,
}

impl Standing {
    /// Looks at people at a time in s: where they are, `None` for who is away. Returns whether
    /// others stand than before.
    pub fn observe(
        &mut self,
        time: f64,
        people: impl Iterator<Item = Option<Vector2<f64>>>,
    ) -> bool {
        let mut changed = false;
        let mut seen = 0;
        for place in people {
            if seen == self.tracks.len() {
                self.tracks.push(None);
            }
            changed |= follow(&mut self.tracks[seen], time, place);
            seen += 1;
        }
        for track in self.tracks.drain(seen..) {
            changed |= track.is_some_and(|track| track.stands);
        }
        changed
    }

    /// Indices and places of those who stand.
    pub fn places(&self) -> impl Iterator<Item = (usize, Vector2<f64>)> {
        let tracks = self.tracks.iter().enumerate();
        tracks.filter_map(|(index, track)| {
            track
                .filter(|track| track.stands)
                .map(|track| (index, track.anchor))
        })
    }
}

fn follow(slot: &mut Option<PersonHistory>, time: f64, place: Option<Vector2<f64>>) -> bool {
    let stood = slot.is_some_and(|track| track.stands);
    let Some(place) = place else {
        *slot = None;
        return stood;
    };
    let stays = slot.filter(|track| (place - track.anchor).norm() < MOVED);
    *slot = Some(match stays {
        Some(track) => PersonHistory {
            stands: time - track.since >= WINDOW - 1e-9,
            ..track
        },
        None => PersonHistory {
            anchor: place,
            since: time,
            stands: false,
        },
    });
    stood != slot.is_some_and(|track| track.stands)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_stands_is_told_once_when_he_stops_and_once_when_he_leaves() {
        let mut standing = Standing::default();
        let at = |x: f64| std::iter::once(Some(Vector2::new(x, 0.0)));
        assert!(!standing.observe(0.0, at(0.0)));
        assert!(!standing.observe(1.9, at(0.09)));
        assert!(standing.observe(2.0, at(0.05)));
        assert_eq!(standing.places().count(), 1);
        assert!(!standing.observe(3.0, at(0.02)));
        assert!(standing.observe(3.1, at(0.1)));
        assert!(!standing.observe(5.0, at(0.1)));
        assert!(standing.observe(5.1, at(0.1)));
        assert!(standing.observe(5.2, std::iter::once(None)));
        assert_eq!(standing.places().count(), 0);
    }
}
