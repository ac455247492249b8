//! Effective masses of arrays of poses, points and directions, over all cores.

use nalgebra::Vector3;
use numeric::error::{Failure, Given, Result};
use numeric::parallel::{Work, each_run};

use super::mobility::{Extremes, Mobility};
use super::model::{Arm, sized};
use super::pose::{Pose, Singular, singular};

/// Elements that a thread does before it takes others.
const BLOCK: usize = 1024;

/// Rows of numbers, and how many rows apart neighbors along each axis of the result are.
#[derive(Clone, Copy)]
pub struct Broadcast<'a> {
    /// Rows one after the other.
    pub rows: &'a [f64],
    /// Numbers in a row.
    pub width: usize,
    /// Rows between neighbors along each axis; zero where the array has one row for all.
    pub strides: &'a [usize],
}

impl Broadcast<'_> {
    fn row(&self, index: usize) -> &[f64] {
        &self.rows[index * self.width..(index + 1) * self.width]
    }

    fn vector(&self, index: usize) -> Vector3<f64> {
        Vector3::from_column_slice(self.row(index))
    }

    /// Whether all rows that the strides reach are there.
    fn reaches(&self, shape: &[usize]) -> bool {
        let last: usize = shape
            .iter()
            .zip(self.strides)
            .map(|(length, stride)| length.saturating_sub(1).saturating_mul(*stride))
            .sum();
        self.strides.len() == shape.len()
            && (shape.contains(&0) || (last + 1).saturating_mul(self.width) <= self.rows.len())
    }
}

/// Poses and points of one link.
#[derive(Clone, Copy)]
pub struct Places<'a> {
    /// The link.
    pub link: usize,
    /// Values of all joints.
    pub joints: Broadcast<'a>,
    /// Points in the frame of the link.
    pub points: Broadcast<'a>,
    /// Axes of the result.
    pub shape: &'a [usize],
    /// Whether values have to keep the limits of the joints.
    pub check_limits: bool,
}

/// Position and mobility of a point.
#[derive(Clone, Copy, Debug)]
pub struct PointState {
    /// Position in the world (m).
    pub position: Vector3<f64>,
    /// Its mobility (1/kg).
    pub mobility: Mobility,
    /// The heaviest and the lightest direction.
    pub extremes: Extremes,
}

impl Arm {
    /// Effective masses along directions, which need not be unit vectors (kg).
    ///
    /// # Errors
    /// A value is not finite or outside the limits of its joint, a direction is zero, the mass
    /// matrix of a pose is singular, or the caller asked to stop.
    pub fn effective_masses(
        &self,
        places: &Places<'_>,
        directions: &Broadcast<'_>,
        work: Work<'_>,
    ) -> Result<Vec<f64>> {
        self.check(places)?;
        check_rows("direction", directions, places.shape)?;
        let units = units(directions)?;
        let directions = Broadcast {
            rows: &units,
            ..*directions
        };
        sized!(self, SIZE => self.each::<SIZE, _>(places, Some(&directions), work, |_, _, mobility, along| {
            mobility.effective_mass(along)
        }))
    }

    /// Positions, mobilities, heaviest and lightest directions of points.
    ///
    /// # Errors
    /// Errors of `effective_masses`.
    pub fn point_states(&self, places: &Places<'_>, work: Work<'_>) -> Result<Vec<PointState>> {
        self.check(places)?;
        sized!(self, SIZE => self.each::<SIZE, _>(places, None, work, |pose, point, mobility, _| PointState {
            position: pose.position(places.link, point),
            mobility: *mobility,
            extremes: mobility.extremes(),
        }))
    }

    /// Velocities of points for rates of all joints (m/s).
    ///
    /// # Errors
    /// Errors of `effective_masses`.
    pub fn velocities(
        &self,
        places: &Places<'_>,
        rates: &Broadcast<'_>,
        work: Work<'_>,
    ) -> Result<Vec<Vector3<f64>>> {
        self.check(places)?;
        check_rows("rates", rates, places.shape)?;
        sized!(self, SIZE => self.each_velocity::<SIZE>(places, rates, work))
    }

    /// Mass matrices (lower triangles, kg m^2 or kg) and weights (N m or N) of the free joints in each pose.
    ///
    /// # Errors
    /// Errors of `effective_masses`, but for singular matrices.
    pub fn dynamics(
        &self,
        places: &Places<'_>,
        gravity: f64,
        work: Work<'_>,
    ) -> Result<Vec<[Vec<f64>; 2]>> {
        self.check(places)?;
        let spots = Spots::new(places, None);
        sized!(self, SIZE => each_block(spots.count, work, |range| {
            let mut pose = Pose::<SIZE>::new(self);
            let rows = range.map(|element| places.joints.row(spots.rows(element)[0]));
            Ok(rows.map(|joints| pose.dynamics(joints, gravity)).collect())
        }))
    }

    fn each_velocity<const N: usize>(
        &self,
        places: &Places<'_>,
        rates: &Broadcast<'_>,
        work: Work<'_>,
    ) -> Result<Vec<Vector3<f64>>> {
        let spots = Spots::new(places, Some(rates));
        each_block(spots.count, work, |range| {
            let mut pose = Pose::<N>::new(self);
            let mut found = Vec::with_capacity(range.len());
            for element in range {
                let [joints, point, rate] = spots.rows(element);
                self.set(&mut pose, places, joints)?;
                let point = places.points.vector(point);
                found.push(pose.velocity(places.link, &point, rates.row(rate)));
            }
            Ok(found)
        })
    }

    /// Results of `of` for every element; what neighbors have in common is computed once.
    fn each<const N: usize, T: Send>(
        &self,
        places: &Places<'_>,
        directions: Option<&Broadcast<'_>>,
        work: Work<'_>,
        of: impl Fn(&Pose<'_, N>, &Vector3<f64>, &Mobility, &Vector3<f64>) -> T + Sync,
    ) -> Result<Vec<T>> {
        let spots = Spots::new(places, directions);
        each_block(spots.count, work, |range| {
            let mut pose = Pose::<N>::new(self);
            let mut last: Option<[usize; 2]> = None;
            let (mut point, mut mobility) = (Vector3::zeros(), Mobility::default());
            let mut found = Vec::with_capacity(range.len());
            for element in range {
                let [joints, spot, direction] = spots.rows(element);
                if last != Some([joints, spot]) {
                    if last.is_none_or(|[before, _]| before != joints) {
                        self.set(&mut pose, places, joints)?;
                    }
                    point = places.points.vector(spot);
                    mobility = pose.mobility(places.link, &point);
                    last = Some([joints, spot]);
                }
                let along = directions.map_or_else(Vector3::zeros, |all| all.vector(direction));
                found.push(of(&pose, &point, &mobility, &along));
            }
            Ok(found)
        })
    }

    fn set<const N: usize>(
        &self,
        pose: &mut Pose<'_, N>,
        places: &Places<'_>,
        row: usize,
    ) -> Result<()> {
        pose.set(places.joints.row(row))
            .map_err(|Singular { column }| singular(self, column, &format!(" in joints[{row}]")))
    }

    fn check(&self, places: &Places<'_>) -> Result<()> {
        check_rows("joints", &places.joints, places.shape)?;
        check_rows("point", &places.points, places.shape)?;
        self.check_joints(places.joints.rows, places.check_limits)
    }

    /// Refuses values by rows that are not finite or, if asked for, outside the limits of their joints.
    pub(crate) fn check_joints(&self, rows: &[f64], check_limits: bool) -> Result<()> {
        if self.joints.is_empty() {
            return Ok(());
        }
        for (row, values) in rows.chunks_exact(self.joints.len()).enumerate() {
            let name = |joint: &str| match rows.len() / values.len() {
                1 => format!("joints[{joint:?}]"),
                _ => format!("joints[{row}][{joint:?}]"),
            };
            for (joint, value) in self.joints.iter().zip(values) {
                if !value.is_finite() {
                    let given = Given::Number(*value);
                    return Err(Failure::invalid(name(&joint.name), "be finite", given));
                }
                if check_limits {
                    within(&joint.limits, *value, || name(&joint.name))?;
                }
            }
            let follow = self.segments.iter().filter(|_| check_limits);
            for segment in follow.filter(|segment| segment.own_limits.is_some()) {
                let value = segment.multiplier * values[segment.source] + segment.addend;
                let limits = segment.own_limits.unwrap_or_default();
                within(&limits, value, || {
                    format!(
                        "{}, which follows another joint,",
                        name(&segment.joint_name)
                    )
                })?;
            }
        }
        Ok(())
    }
}

/// Refuses a value outside the limits of its joint.
fn within(limits: &[f64; 2], value: f64, name: impl Fn() -> String) -> Result<()> {
    let [lower, upper] = *limits;
    if value >= lower && value <= upper {
        return Ok(());
    }
    let past = if value < lower {
        lower - value
    } else {
        value - upper
    };
    let rule = format!("be from {lower:?} to {upper:?}");
    let failure = Failure::invalid(name(), rule, Given::Number(value));
    let radians = value.to_radians();
    // Nobody turns a joint by more than a turn and means radians if the same number of degrees is within its limits.
    let degrees = value.abs() > std::f64::consts::TAU && radians >= lower && radians <= upper;
    Err(failure.mended_by(if degrees {
        format!("joints are in rad, sliding ones in m: {value:?} degrees are {radians:.4} rad")
    } else {
        format!("it is {past:.3e} outside the limits of the joint; check_limits=False leaves them unchecked")
    }))
}

fn check_rows(name: &str, given: &Broadcast<'_>, shape: &[usize]) -> Result<()> {
    if !given.reaches(shape) {
        let found = Given::Found("too few rows".into());
        return Err(Failure::invalid(name, "have a row for each result", found));
    }
    if name == "joints" {
        return Ok(()); // checked with their limits
    }
    match given.rows.iter().position(|value| !value.is_finite()) {
        Some(index) => {
            let place = format!("{name}[{}]", index / given.width.max(1));
            Err(Failure::invalid(
                place,
                "be finite",
                Given::Number(given.rows[index]),
            ))
        }
        None => Ok(()),
    }
}

/// Rows as unit vectors.
fn units(directions: &Broadcast<'_>) -> Result<Vec<f64>> {
    let mut found = Vec::with_capacity(directions.rows.len());
    for (row, values) in directions.rows.chunks_exact(3).enumerate() {
        let given = Vector3::from_column_slice(values);
        // Scaled first, so that the square of a small or large number is a number.
        let largest = given.amax();
        if largest == 0.0 {
            let place = format!("direction[{row}]");
            let found = Given::Found("(0, 0, 0)".into());
            return Err(Failure::invalid(place, "not be zero", found));
        }
        found.extend_from_slice((given / largest).normalize().as_slice());
    }
    Ok(found)
}

/// Rows that belong to each element of the result.
struct Spots<'a> {
    shape: &'a [usize],
    strides: [Option<&'a [usize]>; 3],
    count: usize,
}

impl<'a> Spots<'a> {
    fn new(places: &Places<'a>, third: Option<&Broadcast<'a>>) -> Self {
        Self {
            shape: places.shape,
            strides: [
                Some(places.joints.strides),
                Some(places.points.strides),
                third.map(|given| given.strides),
            ],
            count: places.shape.iter().product(),
        }
    }

    /// Rows of the joints, of the point and of the third array.
    fn rows(&self, element: usize) -> [usize; 3] {
        let (mut rest, mut rows) = (element, [0; 3]);
        for (axis, length) in self.shape.iter().enumerate().rev() {
            let place = rest % length;
            rest /= length;
            for (row, strides) in rows.iter_mut().zip(&self.strides) {
                *row += strides.map_or(0, |strides| strides[axis] * place);
            }
        }
        rows
    }
}

/// Results of blocks of elements on all cores, in order.
fn each_block<T: Send>(
    count: usize,
    work: Work<'_>,
    block: impl Fn(std::ops::Range<usize>) -> Result<Vec<T>> + Sync,
) -> Result<Vec<T>> {
    let blocks = each_run(count.div_ceil(BLOCK), work, |index| {
        block(index * BLOCK..count.min((index + 1) * BLOCK))
    })?;
    let mut found = Vec::with_capacity(count);
    found.extend(blocks.into_iter().flatten());
    Ok(found)
}
