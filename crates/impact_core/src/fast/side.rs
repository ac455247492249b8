//! Rows of numbers side by side, from their columns to their criteria.

use std::ops::Range;

use super::apart::{apart, inlined};
use super::{CELL_ANGLE, FINE_CELL_ANGLE, Group, GroupPeaks, GroupRest, MaskedValue, Workspace};
use crate::columns::{Column, Columns, HeadColumns};
use crate::metrics::{
    CRITERIA, FREE_HORIZON, Loads, MetricOptions, Metrics, Missing, Searches, Status,
};
use crate::parameters::{System, Target};
use crate::series::Plant;
use numeric::lanes::{Number, Truth, vectors};
use pulp::{Scalar, Simd};

/// Most rows side by side.
pub const MOST_LANES: usize = 8;

/// Settings of the walk along the responses of rows side by side.
#[derive(Clone, Copy)]
pub struct Walk {
    /// Time until which a release counts, in s.
    pub horizon: f64,
    /// Length of a cell times the fastest root.
    pub cell_angle: f64,
    /// Whether rows with two humps or a shelf are followed.
    pub humps: bool,
    /// Quantities to search for.
    pub searches: Searches,
}

/// Metrics of rows side by side.
pub struct Side<R: Number> {
    peaks: GroupPeaks<R>,
    rest: Option<GroupRest<R>>,
    /// Lanes whose compression stays in the linear range.
    within: R::Mask,
}

/// Rows side by side.
#[derive(Clone, Copy)]
pub enum Rows {
    /// One after the other.
    From(usize),
    /// One for each lane.
    Each([usize; MOST_LANES]),
}

impl Rows {
    /// Numbers of a column.
    #[inline(always)]
    fn gather<R: Number>(self, zero: R, column: &Column<'_>) -> R {
        match (column, self) {
            (Column::Value(value), _) => zero.like(*value),
            (Column::Array(values), Self::From(first)) => {
                let values = &values[first..first + R::WIDTH];
                zero.like_each(
                    #[inline(always)]
                    |lane| values[lane],
                )
            }
            (Column::Array(values), Self::Each(rows)) => zero.like_each(
                #[inline(always)]
                |lane| values[rows[lane]],
            ),
        }
    }
}

impl<R: Number> Side<R> {
    /// Solves rows side by side.
    #[inline(always)]
    pub fn of<S: Simd, const ALL: bool>(
        space: &mut Workspace<S, R>,
        columns: &Columns<'_>,
        walk: Walk,
        rows: Rows,
    ) -> Self {
        let zero = space.zero;
        let one = inlined(
            #[inline(always)]
            |column: &Column<'_>| rows.gather(zero, column),
        );
        let arm = [
            one(&columns.manipulator_mass),
            one(&columns.manipulator_damping),
            one(&columns.manipulator_stiffness),
        ];
        let foam = [one(&columns.foam_stiffness), one(&columns.foam_damping)];
        let head = match &columns.head {
            HeadColumns::Free {
                mass,
                damping,
                stiffness,
            } => [one(mass), one(damping), one(stiffness)],
            HeadColumns::Constrained => [zero.like(f64::INFINITY); 3],
        };
        let range = one(&columns.linear_range);
        let closing_speed = one(&columns.closing_speed);
        let manipulator_speed = match &columns.manipulator_speed {
            Some(speed) => one(speed),
            None => closing_speed,
        };
        let largest = zero.like(f64::MAX);
        let mut valid = manipulator_speed.abs().le(largest);
        for value in [arm[0], head[0], range, closing_speed] {
            valid = valid & value.gt(zero) & value.le(largest);
        }
        for value in [arm[1], arm[2], head[1], head[2], foam[0], foam[1]] {
            valid = valid & value.ge(zero) & value.le(largest);
        }
        let over = inlined(
            #[inline(always)]
            |[mass, damping, stiffness]: [R; 3]| {
                let inverse = mass.like(1.0) / mass;
                [inverse, damping * inverse, stiffness * inverse]
            },
        );
        let group = Group {
            plant: Plant {
                manipulator: over(arm),
                head: over(head),
                foam,
            },
            closing_speed,
            manipulator_speed,
            horizon: walk.horizon,
            cell_angle: walk.cell_angle,
            humps: walk.humps,
            searches: walk.searches,
        };
        let mut solved = group.solve::<S, ALL>(space, valid);
        let peaks = solved.peaks();
        let rest = if ALL { Some(solved.rest(&peaks)) } else { None };
        Self {
            within: peaks.compression.value.le(range),
            peaks,
            rest,
        }
    }

    /// Whether a lane is left for later.
    #[inline(always)]
    pub fn is_put_off(&self, lane: usize) -> bool {
        self.rest
            .as_ref()
            .is_some_and(|rest| rest.put_off.lane(lane))
    }

    /// The criteria; NaN where they were not asked for.
    #[inline(always)]
    fn loads(&self, gravity: f64) -> Loads<MaskedValue<R>> {
        let peaks = &self.peaks;
        let per_g = peaks.mean.value.like(gravity);
        let nothing = MaskedValue::nothing(per_g);
        let loads = Loads {
            peak_head_acceleration: peaks.head_acceleration,
            peak_head_acceleration_g: peaks.head_acceleration.over(per_g),
            mean_head_acceleration_g: peaks.mean.over(per_g),
            peak_contact_force: peaks.contact_force,
            max_compression: peaks.compression,
            impact_duration: peaks.duration,
            hic15: nothing,
            hic36: nothing,
            average_3ms_g: nothing,
            clip_3ms_g: nothing,
            peak_power_manipulator: peaks.powers[0],
            peak_power_foam: peaks.powers[1],
        };
        let Some(rest) = &self.rest else {
            return loads;
        };
        // T mean^2.5 with the mean in g.
        let scale = per_g.like(gravity * gravity * gravity.sqrt());
        Loads {
            hic15: rest.injury[0].over(scale),
            hic36: rest.injury[1].over(scale),
            average_3ms_g: rest.held[0].over(per_g),
            clip_3ms_g: rest.held[1].over(per_g),
            ..loads
        }
    }

    /// Lanes in which the status holds.
    #[inline(always)]
    fn status_holds(&self) -> R::Mask {
        self.peaks.duration.holds & self.peaks.compression.holds
    }

    /// Status of the row of each lane.
    #[inline(always)]
    pub fn status(&self) -> [Status; MOST_LANES] {
        let duration = self.peaks.duration.value;
        let lasting = duration.ge(duration.like(f64::INFINITY)).bits();
        let within = self.within.bits();
        let mut status = [Status::BeyondLinearRange; MOST_LANES];
        for (lane, status) in status.iter_mut().enumerate().take(R::WIDTH) {
            if lasting >> lane & 1 == 1 {
                *status = Status::NoRelease;
            } else if within >> lane & 1 == 1 {
                *status = Status::Released;
            }
        }
        status
    }

    /// Lanes in which something of what is missing does not hold.
    #[inline(always)]
    pub fn lacking(&self, missing: Missing) -> R::Mask {
        let mut holds = self.peaks.mean.value.truth(true);
        for (place, criterion) in self.loads(1.0).into_array().into_iter().enumerate() {
            if missing.has(place) {
                holds = holds & criterion.holds;
            }
        }
        if missing.has_status() {
            holds = holds & self.status_holds();
        }
        !holds
    }

    /// Metrics that hold in each lane.
    #[inline(always)]
    pub fn known(&self, gravity: f64) -> [Missing; MOST_LANES] {
        let mut known = [Missing::NOTHING; MOST_LANES];
        let mut note = |place: usize, bits: u32| {
            for (lane, known) in known.iter_mut().enumerate().take(R::WIDTH) {
                known.insert(place, bits >> lane & 1 == 1);
            }
        };
        for (place, criterion) in self.loads(gravity).into_array().into_iter().enumerate() {
            note(place, criterion.holds.bits());
        }
        note(CRITERIA.len(), self.status_holds().bits());
        known
    }

    /// Writes the first lanes into the columns that are there, beginning with a row.
    #[inline(always)]
    pub fn store(&self, columns: Loads<&mut [f64]>, rows: Range<usize>, gravity: f64) {
        columns.each_with(
            self.loads(gravity),
            #[inline(always)]
            |column, known| {
                if let Some(cells) = column.get_mut(rows.clone()) {
                    known.value.write(cells);
                }
            },
        );
    }

    /// Metrics of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize, gravity: f64) -> Metrics {
        Metrics {
            loads: self.loads(gravity).map(|known| known.value.lane(lane)),
            status: self.status()[lane],
        }
    }
}

/// Metrics of one impact as far as its response has the usual shape, and what they miss; numbers are
/// in range.
pub(crate) fn usual(
    system: &System,
    closing_speed: f64,
    options: &MetricOptions,
) -> (Metrics, Missing) {
    let mut found = Metrics::none(Status::InvalidParameter);
    let mut missing = Missing::ALL;
    let head = match system.head {
        Target::Free(head) => HeadColumns::Free {
            mass: Column::Value(head.mass),
            damping: Column::Value(head.damping),
            stiffness: Column::Value(head.stiffness),
        },
        Target::Constrained => return (found, missing),
    };
    let columns = Columns {
        manipulator_mass: Column::Value(system.manipulator.mass),
        manipulator_damping: Column::Value(system.manipulator.damping),
        manipulator_stiffness: Column::Value(system.manipulator.stiffness),
        foam_stiffness: Column::Value(system.foam.stiffness),
        foam_damping: Column::Value(system.foam.damping),
        linear_range: Column::Value(system.foam.linear_range),
        head,
        closing_speed: Column::Value(closing_speed),
        manipulator_speed: options.manipulator_speed.map(Column::Value),
    };
    let horizon = options.horizon.unwrap_or(FREE_HORIZON);
    for cell_angle in [CELL_ANGLE, FINE_CELL_ANGLE] {
        let walk = Walk {
            horizon,
            cell_angle,
            humps: true,
            searches: missing.searches(),
        };
        let (metrics, known) = one(&columns, walk, options.gravity);
        found.take(&metrics, missing.without(missing.without(known)));
        missing = missing.without(known);
        if missing.is_nothing() {
            break;
        }
    }
    (found, missing)
}

/// Metrics of the first row in cells of some length, and which of them hold.
#[inline(never)]
fn one(columns: &Columns<'_>, walk: Walk, gravity: f64) -> (Metrics, Missing) {
    match vectors() {
        Some(vectors) => alone(vectors, columns, walk, gravity),
        None => alone(Scalar, columns, walk, gravity),
    }
}

#[inline(always)]
fn alone<S: Simd>(simd: S, columns: &Columns<'_>, walk: Walk, gravity: f64) -> (Metrics, Missing) {
    apart(
        simd,
        #[inline(always)]
        || {
            let mut space = Workspace::new(simd, 0.0);
            let found = Side::of::<_, true>(&mut space, columns, walk, Rows::From(0));
            (found.lane(0, gravity), found.known(gravity)[0])
        },
    )
}
