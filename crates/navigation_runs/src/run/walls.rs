//! Contacts with maps: what stands counts whether or not it is an obstacle of the scenario.

use navigation_world::sensing::SensorOptions;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::frame::Frame;
use navigation_world::world::map::StaticMap;
use navigation_world::world::scenario::Scenario;
use numeric::lanes::{Planar, Real, Truth, Vector2};

/// Clearances are looked up to this beyond the least one so far, in m: a robot that far off need not
/// be looked at until it has gone that way.
const AHEAD: f64 = 1.0;

/// Room for rounding where a distance bound spares work, in m.
const ROUNDING: f64 = 1e-9;

/// The maps of a run: walls and map of the scenario, of its law and of its sensors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Maps(Vec<StaticMap>);

impl Maps {
    /// Of a scenario and a law that knows a map.
    pub fn of_law(scenario: &Scenario, known: Option<&StaticMap>) -> Self {
        let mut maps = Self::default();
        maps.add(scenario.walls.as_ref());
        maps.add(scenario.map.as_ref());
        maps.add(known);
        maps
    }

    /// Maps of a scenario, a law and sensors.
    pub fn of(scenario: &Scenario, known: Option<&StaticMap>, sensors: &[SensorOptions]) -> Self {
        let mut maps = Self::of_law(scenario, known);
        for sensor in sensors {
            maps.add(sensor.map());
        }
        maps
    }

    fn add(&mut self, map: Option<&StaticMap>) {
        // A law and a lidar mostly share one.
        let new = map.filter(|map| !self.0.iter().any(|own| own.is(map)));
        self.0.extend(new.cloned());
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Least distance of the points of a segment from the maps in m.
    pub fn segment_clearance(&self, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        let distances = self.0.iter().map(|map| map.segment_clearance(from, to));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Distance in m of an outline at a pose from the maps; all that is at least `most` away counts as that far.
    pub fn outline_clearance(&self, outline: &Footprint, pose: &Frame, most: f64) -> f64 {
        let nearer = |least: f64, map: &StaticMap| outline.clearance(pose, map, least);
        self.0.iter().fold(most, nearer)
    }

    /// Distance of a point from the nearest map in m; all that is at least `most` away counts as that
    /// far.
    pub fn clearance_up_to(&self, point: Vector2<f64>, most: f64) -> f64 {
        let nearer = |least: f64, map: &StaticMap| map.clearance_up_to(point, least);
        self.0.iter().fold(most, nearer)
    }
}

/// Numbers of a robot before it is looked at for the first time: no contact, and no room to spare.
const UNSEEN: [f64; 6] = [f64::INFINITY, f64::NAN, f64::NAN, -1.0, 0.0, 0.0];

/// Clearance of the robots of one lane group from walls, and contacts.
#[derive(Clone, Debug)]
pub(crate) struct WallContacts<R> {
    maps: Maps,
    radius: f64,
    /// Least distance of the surfaces in m, negative inside of a wall.
    pub least: R,
    /// First contact in s, NaN without.
    pub contact_time: R,
    /// Speed then, in m/s.
    pub contact_speed: R,
    /// Where each robot was looked at, and how far it may go from there without coming nearer than
    /// ever, in m.
    seen: Vector2<R>,
    spare: R,
}

impl<R: Real> WallContacts<R> {
    /// Around robots of a radius in m; `None` where there are no maps.
    pub fn new(maps: Maps, radius: f64) -> Option<Self> {
        let [least, contact_time, contact_speed, spare, x, y] = UNSEEN.map(R::splat);
        (!maps.is_empty()).then(|| Self {
            maps,
            radius,
            least,
            contact_time,
            contact_speed,
            seen: Vector2::new(x, y),
            spare,
        })
    }

    /// Distance in m of an outline at a pose from the maps; all that is at least `most` away counts as that far.
    pub fn clearance_of(&self, outline: &Footprint, pose: &Frame, most: f64) -> f64 {
        self.maps.outline_clearance(outline, pose, most)
    }

    /// Takes down a distance of the robot in the first lane in m, and a contact with its time in s and its speed in m/s;
    /// returns whether that is the first one.
    pub fn note(&mut self, distance: f64, contact: Option<(f64, f64)>) -> bool {
        self.least = self.least.replace(0, self.least.lane(0).min(distance));
        let Some((time, speed)) = contact.filter(|_| self.contact_time.lane(0).is_nan()) else {
            return false;
        };
        self.contact_time = self.contact_time.replace(0, time);
        self.contact_speed = self.contact_speed.replace(0, speed);
        true
    }

    /// A run begins in a lane.
    pub fn enter(&mut self, lane: usize) {
        for (number, value) in self.numbers().into_iter().zip(UNSEEN) {
            number.set(lane, value);
        }
    }

    /// A lane continues from where the first lane of another group is.
    pub fn follow(&mut self, lane: usize, leader: &mut Self) {
        for (number, own) in self.numbers().into_iter().zip(leader.numbers()) {
            number.set(lane, own.lane(0));
        }
    }

    fn numbers(&mut self) -> [&mut R; UNSEEN.len()] {
        let [[x, y]] = &mut self.seen.data.0;
        [
            &mut self.least,
            &mut self.contact_time,
            &mut self.contact_speed,
            &mut self.spare,
            x,
            y,
        ]
    }

    /// Looks at the robots of some lanes at an instant, after a motion step from where they were at another one if
    /// there was one; returns whether one touches a wall for the first time.
    #[inline(always)]
    pub fn watch(
        &mut self,
        now: (Vector2<R>, R),
        since: Option<(Vector2<R>, R)>,
        speed: R,
        lanes: R::Mask,
    ) -> bool {
        let moved = now.0 - self.seen;
        let off = moved.dot(&moved).lt(self.spare * self.spare) & R::zero().lt(self.spare);
        (lanes & !off).any() && self.look(now, since, speed, lanes & !off)
    }

    #[cold]
    #[inline(never)]
    fn look(
        &mut self,
        (place, time): (Vector2<R>, R),
        since: Option<(Vector2<R>, R)>,
        speed: R,
        lanes: R::Mask,
    ) -> bool {
        let mut touched = false;
        for lane in (0..R::WIDTH).filter(|lane| lanes.lane(*lane)) {
            let point = Vector2::from(place.lane(lane));
            let least = self.least.lane(lane);
            let most = least.max(0.0) + self.radius + AHEAD;
            let clearance = self.maps.clearance_up_to(point, most) - self.radius;
            let mut nearest = least.min(clearance);
            let mut contact = (clearance <= 0.0).then_some(time.lane(lane));
            let since = since.map(|(from, time)| (Vector2::from(from.lane(lane)), time.lane(lane)));
            // No point of the way is farther from its end than its length.
            if let (None, Some((from, begin))) = (contact, since)
                && (point - from).norm() >= clearance
                && let Some((share, gap)) = self.between(from, point)
            {
                nearest = nearest.min(gap);
                contact = Some(begin + share * (time.lane(lane) - begin));
            }
            self.least = self.least.replace(lane, nearest);
            let spare = clearance - nearest.max(0.0) - ROUNDING;
            self.spare = self.spare.replace(lane, spare);
            let [x, y] = point.into();
            self.seen = Vector2::new(self.seen.x.replace(lane, x), self.seen.y.replace(lane, y));
            if let Some(instant) = contact
                && self.contact_time.lane(lane).is_nan()
            {
                self.contact_time = self.contact_time.replace(lane, instant);
                self.contact_speed = self.contact_speed.replace(lane, speed.lane(lane));
                touched = true;
            }
        }
        touched
    }

    /// Where on a straight way a wall is touched first, as a share of it, and the least distance of the surfaces on
    /// the way in m, if they overlap by more than rounding; the share is found to a nanometer.
    fn between(&self, from: Vector2<f64>, to: Vector2<f64>) -> Option<(f64, f64)> {
        let gap =
            |end: f64| self.maps.segment_clearance(from, from + (to - from) * end) - self.radius;
        let least = gap(1.0);
        if least >= -ROUNDING {
            return None;
        }
        let [mut free, mut touching] = [0.0, 1.0];
        while (touching - free) * (to - from).norm() > ROUNDING {
            let middle = 0.5 * (free + touching);
            if gap(middle) > 0.0 {
                free = middle;
            } else {
                touching = middle;
            }
        }
        Some((touching, least))
    }
}
