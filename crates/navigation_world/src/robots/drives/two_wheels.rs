//! A two-wheel robot that follows the point mass which a law drives, or turns with a virtual
//! torque; Zeng (2011), sections 7.2 and 2.2.5.

use crate::robots::differential::{
    DifferentialLimits, Pose, Reference, TorqueSteering, Tracker, Tracking, Twist, VirtualTorque,
};
use crate::robots::drives::driven::{DrivenWheels, WheelSize};
use crate::robots::drives::velocity::VelocitySteering;
use crate::robots::drives::{Drive, MotorDrive, Order, PointMass, PoseFix, Reading, Start, WHEELS};
use crate::robots::wheels::{DifferentialKinematics, Slip, WheelDrive};
use crate::robots::{DifferentialDriveRobot, DifferentialWheels};
use crate::world::geometry::RobotState;
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};

/// How a two-wheel robot is steered.
#[derive(Clone, Debug, PartialEq)]
pub enum SteeringLaw {
    /// It follows the point mass that the law drives.
    Following(Tracking),
    /// It turns toward the force of the law.
    Torque(VirtualTorque),
    /// It takes up the velocity that the law commands, turning within the control period.
    Velocity,
}

impl Default for SteeringLaw {
    fn default() -> Self {
        Self::Following(Tracking::default())
    }
}

/// How a two-wheel robot joins the pose that its wheels tell with the measured one; a share of the
/// difference is taken over at every measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseFusion {
    /// Share of the difference of positions.
    pub position: f64,
    /// Share of the difference of headings.
    pub heading: f64,
    /// Distance in m from the center of the robot to the second mark, which tells the heading.
    pub mark: f64,
}

impl Default for PoseFusion {
    /// The mark is that of Zeng (2011), section 7.3.1; the shares are not in the source.
    fn default() -> Self {
        Self {
            position: 0.3,
            heading: 0.1,
            mark: 0.1,
        }
    }
}

/// Driven wheels.
pub(super) const DRIVEN: usize = 2;

/// Wheel speeds below this stand for standstill, so that friction has no sign, in rad/s.
const WHEEL_STANDSTILL: f64 = 1e-9;

/// Steering that turns an order into a twist.
#[derive(Clone, Debug)]
enum Steering {
    /// Follows the point mass.
    Follow(Box<Tracker>),
    /// Turns toward the force.
    Torque(TorqueSteering),
    /// Takes up a velocity.
    Velocity(VelocitySteering),
}

/// The robot.
#[derive(Clone, Debug)]
pub struct TwoWheels {
    ideal: DifferentialWheels,
    limits: DifferentialLimits,
    kinematics: DifferentialKinematics,
    /// Wheels with controllers; ideal ones do at once what they are told.
    wheels: Option<DrivenWheels>,
    reference: PointMass,
    steering: Steering,
    fusion: PoseFusion,
    goal: [f64; 2],
    step: f64,
    force: [f64; 2],
    pose: Pose,
    /// The pose as the robot knows it.
    known: Pose,
    /// Set where the pose is known exactly.
    exact: bool,
    /// Commanded twist, within all limits.
    twist: Twist,
    wheel_speeds: [f64; WHEELS],
}

impl TwoWheels {
    /// A robot at rest; its wheels have controllers where they are given.
    ///
    /// # Errors
    /// A wheel, or what steers the robot, is out of range.
    pub fn new(
        start: &Start,
        robot: &DifferentialDriveRobot,
        (wheels, slip): (Option<&[WheelDrive]>, Slip),
        (steering_law, fusion): (&SteeringLaw, PoseFusion),
    ) -> Result<Self> {
        let limits = DifferentialLimits::from(robot);
        let pose = Pose {
            position: start.position,
            heading: start.heading,
        };
        let size = WheelSize {
            radius: robot.wheels.radius,
            resistance: robot.wheels.resistance,
        };
        let driven = |drives| DrivenWheels::new(drives, slip, size, start.step);
        let steering = match steering_law {
            SteeringLaw::Following(tracking) => {
                let tracking = tracking.checked()?;
                Steering::Follow(Box::new(Tracker::new(&tracking, &limits, start.step)))
            }
            SteeringLaw::Torque(law) => {
                let law = law.checked()?;
                Steering::Torque(TorqueSteering::new(&law, robot, &limits, start.step))
            }
            SteeringLaw::Velocity => Steering::Velocity(VelocitySteering::new(start)),
        };
        Ok(Self {
            ideal: robot.wheels,
            limits,
            kinematics: DifferentialKinematics {
                wheel_radius: robot.wheels.radius,
                span: robot.wheels.span,
            },
            wheels: wheels.map(driven).transpose()?,
            reference: PointMass::new(start),
            steering,
            fusion,
            goal: start.goal,
            step: start.step,
            force: [0.0; 2],
            pose,
            known: pose,
            exact: true,
            twist: Twist::default(),
            wheel_speeds: [0.0; WHEELS],
        })
    }

    /// Takes over a share of the difference from the measured pose.
    fn correct(&mut self, fix: &PoseFix) {
        let measured = fix.position.lane(0);
        for (known, measured) in self.known.position.iter_mut().zip(measured) {
            *known += self.fusion.position * (measured - *known);
        }
        if let Some(heading) = fix.heading {
            let (sin, cos) = (heading - self.known.heading).sin_cos();
            self.known.heading += self.fusion.heading * sin.atan2(cos);
        }
    }

    /// Twist to ask for until the next step.
    fn wish(&mut self) -> Twist {
        let position = self.reference.state.position.lane(0);
        self.reference.advance();
        match &mut self.steering {
            Steering::Follow(tracker) => {
                let reference = Reference {
                    position,
                    velocity: self.reference.state.velocity.lane(0),
                    acceleration: self.reference.acceleration.lane(0),
                };
                tracker.command(&self.known, &reference, self.goal)
            }
            Steering::Torque(torque) => torque.command(&self.known, self.twist, self.force),
            Steering::Velocity(velocity) => velocity.command(),
        }
    }

    /// Moves with the commanded twist; returns the twist that it really has at the end.
    fn roll(&mut self) -> Twist {
        let (step, kinematics) = (self.step, self.kinematics);
        let Some(wheels) = &mut self.wheels else {
            let moved = self.pose.after(self.twist, step);
            // Ideal wheels leave no doubt about where a known pose leads to.
            self.known = if self.exact {
                moved
            } else {
                self.known.after(self.twist, step)
            };
            self.pose = moved;
            return self.twist;
        };
        let wanted = spread(kinematics.wheel_speeds([self.twist.speed, self.twist.turn_rate]));
        // Who knows the pose does not ask where the wheels seem to lead.
        let exact = self.exact;
        let period = wheels.period;
        let (mut pose, mut known, mut twist) = (self.pose, self.known, Twist::default());
        let turned = |speeds: [f64; WHEELS]| {
            let [speed, turn_rate] = kinematics.body_velocity([speeds[0], speeds[1]]);
            Twist { speed, turn_rate }
        };
        wheels.step(wanted, |rolling, speeds| {
            twist = turned(rolling);
            pose = pose.after(twist, period);
            if !exact {
                known = known.after(turned(speeds), period);
            }
        });
        (self.pose, self.known) = (pose, if exact { pose } else { known });
        twist
    }

    /// Wheel speeds in rad/s, mean currents in A and loss in J of the step.
    fn motors(&mut self) -> ([f64; WHEELS], [f64; WHEELS], f64) {
        if let Some(wheels) = &self.wheels {
            return (wheels.speeds, wheels.currents, wheels.loss);
        }
        let twist = [self.twist.speed, self.twist.turn_rate];
        let speeds = spread(self.kinematics.wheel_speeds(twist));
        let currents = ideal_currents(&self.ideal, &self.wheel_speeds, &speeds, self.step);
        let squared: f64 = currents.iter().map(|current| current * current).sum();
        (
            speeds,
            currents,
            squared * self.ideal.resistance * self.step,
        )
    }
}

/// The two wheels among the most that a robot may have.
fn spread([right, left]: [f64; DRIVEN]) -> [f64; WHEELS] {
    [right, left, 0.0]
}

impl MotorDrive for TwoWheels {
    fn wheels(&self) -> usize {
        DRIVEN
    }

    fn known_heading(&self) -> f64 {
        if self.exact {
            self.pose.heading
        } else {
            self.known.heading
        }
    }
}

impl Drive for TwoWheels {
    type Order = Order;
    type Reading = Reading;

    fn hold(&mut self, order: &Order) {
        self.force = order.force.lane(0);
        self.reference.hold(order.force);
        self.exact = order.fix.is_none();
        match &order.fix {
            Some(fix) => self.correct(fix),
            None => self.known = self.pose,
        }
        match &mut self.steering {
            Steering::Follow(tracker) => tracker.permit_goal_phase(order.clear),
            Steering::Torque(_) => {}
            Steering::Velocity(velocity) => {
                let heading = self.known.heading;
                let target = order
                    .twist
                    .unwrap_or_else(|| velocity.reached_by(order.force, heading, self.twist));
                velocity.hold(self.twist, target);
            }
        }
    }

    fn step(&mut self) -> Reading {
        let before = self.pose.position;
        let wish = self.wish();
        self.twist = self.limits.toward(self.twist, wish, self.step);
        let twist = self.roll();
        let (wheel_speeds, currents, loss) = self.motors();
        self.wheel_speeds = wheel_speeds;
        let (sin, cos) = self.pose.heading.sin_cos();
        let position = self.pose.position;
        let way = (position[0] - before[0]).hypot(position[1] - before[1]);
        Reading {
            robot: RobotState {
                position: Vector2::splat(position),
                velocity: Vector2::splat([twist.speed * cos, twist.speed * sin]),
            },
            speed: way / self.step,
            heading: self.pose.heading,
            wheel_speeds,
            currents,
            loss,
            reference: self.reference.state.position,
        }
    }
}

/// Motor currents in A from the wheel speeds before and after a step, (E.3.2) with 1 A/V:
/// `i = J/K theta'' + B/K theta' + tau/K sgn(theta')`.
fn ideal_currents(
    wheels: &DifferentialWheels,
    before: &[f64; WHEELS],
    after: &[f64; WHEELS],
    step: f64,
) -> [f64; WHEELS] {
    let mut currents = [0.0; WHEELS];
    for wheel in 0..DRIVEN {
        let speed = after[wheel];
        let friction = if speed.abs() < WHEEL_STANDSTILL {
            0.0
        } else {
            wheels.static_friction[wheel].copysign(speed)
        };
        currents[wheel] = wheels.inertia[wheel] * (speed - before[wheel]) / step
            + wheels.viscous_friction[wheel] * speed
            + friction;
    }
    currents
}
