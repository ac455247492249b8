//! The joint between its events: which equations hold, and when they change.

use super::{DirectDrive, DriveImpact};
use crate::parameters::{Foam, Head};

/// Halvings of a step that locate an event: to rounding.
const HALVINGS: u32 = 60;

/// Positions and velocities of impact point and head.
type DriveState = [f64; 4];

/// State of the command: free, or at a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Command {
    Free,
    AtLimit(f64),
}

/// State of dry friction: against a direction of motion, or holding the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FrictionMode {
    Moving(f64),
    Stuck,
}

/// Whether the foam touches the head.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FoamContact {
    Touching,
    /// Time and compression at release; the foam relaxes by itself.
    Apart(f64, f64),
}

#[derive(Clone, Copy, Debug)]
struct Mode {
    command: Command,
    joint: FrictionMode,
    contact: FoamContact,
}

/// Part of the mode that an event changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ModeChange {
    Command,
    Joint,
    Contact,
}

/// Recorded quantities at one time.
pub(super) struct Quantities {
    pub(super) manipulator: [f64; 2],
    pub(super) head: [f64; 2],
    pub(super) head_acceleration: f64,
    pub(super) contact_force: f64,
    pub(super) compression: f64,
    pub(super) command: f64,
    pub(super) requested_command: f64,
}

/// Joint, foam and head in time.
pub(super) struct Machine {
    drive: DirectDrive,
    foam: Foam,
    head: Head,
    speed: f64,
    torso_speed: f64,
    /// Command that compensates friction along the desired motion, in V.
    feed_forward: f64,
    mass: f64,
    time: f64,
    state: DriveState,
    mode: Mode,
    impact_end: Option<f64>,
    saturated_from: Option<f64>,
    saturated_time: f64,
}

impl Machine {
    pub(super) fn new(drive: &DirectDrive, foam: &Foam, head: &Head, impact: &DriveImpact) -> Self {
        let speed = impact.manipulator_speed;
        let torso_speed = speed - impact.closing_speed;
        let direction = if speed == 0.0 { 0.0 } else { speed.signum() };
        let friction =
            drive.viscous_friction * speed / drive.lever_arm + drive.static_friction * direction;
        let feed_forward = friction / (drive.torque_constant * drive.amplifier_gain);
        let mut machine = Self {
            drive: *drive,
            foam: *foam,
            head: *head,
            speed,
            torso_speed,
            feed_forward,
            mass: drive.inertia / (drive.lever_arm * drive.lever_arm),
            time: 0.0,
            state: [0.0, speed, 0.0, torso_speed],
            mode: Mode {
                command: Command::Free,
                joint: FrictionMode::Moving(direction),
                contact: FoamContact::Touching,
            },
            impact_end: None,
            saturated_from: None,
            saturated_time: 0.0,
        };
        if feed_forward.abs() > drive.voltage_limit {
            machine.change(ModeChange::Command);
        }
        if speed == 0.0 {
            machine.change(ModeChange::Joint);
        }
        machine
    }

    /// Sum of the natural frequencies and decays of the parts, in 1/s: no motion is faster.
    pub(super) fn fastest_rate(&self) -> f64 {
        let joint = self.drive.linear();
        let foam = (self.foam.stiffness, self.foam.damping);
        let rate = |mass: f64, (stiffness, damping): (f64, f64)| {
            (stiffness / mass).sqrt() + damping / mass
        };
        rate(joint.mass, (joint.stiffness, joint.damping))
            + rate(joint.mass, foam)
            + rate(self.head.mass, foam)
            + rate(self.head.mass, (self.head.stiffness, self.head.damping))
    }

    pub(super) fn impact_end(&self) -> Option<f64> {
        self.impact_end
    }

    pub(super) fn saturated_from(&self) -> Option<f64> {
        self.saturated_from
    }

    pub(super) fn saturated_time(&self) -> f64 {
        self.saturated_time
    }

    pub(super) fn quantities(&self) -> Quantities {
        let (time, state) = (self.time, &self.state);
        let contact_force = self.contact_force(state);
        Quantities {
            manipulator: [state[0], state[1]],
            head: [self.foam.thickness + state[2], state[3]],
            head_acceleration: self.head_acceleration(time, state),
            contact_force,
            compression: state[0] - state[2],
            command: self.command(time, state),
            requested_command: self.requested(time, state),
        }
    }

    /// Goes on to a later time through all events on the way.
    pub(super) fn advance(&mut self, until: f64) {
        while self.time < until {
            let step = until - self.time;
            let mut reached = self.step(step);
            let mut length = step;
            let mut event = self.broken(self.time + step, &reached);
            if event.is_some() {
                // The later end of the bracket: there the old equations just stopped to hold.
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    let trial = self.step(step * middle);
                    let found = self.broken(self.time + step * middle, &trial);
                    if found.is_some() {
                        (high, reached, event) = (middle, trial, found);
                    } else {
                        low = middle;
                    }
                }
                length = step * high;
            }
            self.watch_head(length, &reached);
            if self.mode.command != Command::Free {
                self.saturated_time += length;
            }
            self.time = if event.is_some() {
                self.time + length
            } else {
                until
            };
            self.state = reached;
            if let Some(event) = event {
                self.change(event);
            }
        }
    }

    /// Notes the first zero of the head acceleration.
    fn watch_head(&mut self, length: f64, reached: &DriveState) {
        if self.impact_end.is_some() || self.head_acceleration(self.time + length, reached) >= 0.0 {
            return;
        }
        let (mut low, mut high) = (0.0, length);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if self.head_acceleration(self.time + middle, &self.step(middle)) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        self.impact_end = Some(self.time + high);
    }

    /// The first rule of the present mode that a state breaks.
    fn broken(&self, time: f64, state: &DriveState) -> Option<ModeChange> {
        let requested = self.requested(time, state);
        let limit = self.drive.voltage_limit;
        let command_holds = match self.mode.command {
            Command::Free => requested.abs() <= limit,
            Command::AtLimit(side) => side * requested >= limit,
        };
        let joint_holds = match self.mode.joint {
            FrictionMode::Moving(direction) => direction * state[1] >= 0.0,
            FrictionMode::Stuck => self.pull(time, state).abs() <= self.dry_friction(),
        };
        let contact_holds = match self.mode.contact {
            FoamContact::Touching => self.contact_force(state) >= 0.0,
            FoamContact::Apart(since, left) => {
                state[0] - state[2] <= self.relaxed(time - since, left)
            }
        };
        if !contact_holds {
            Some(ModeChange::Contact)
        } else if !command_holds {
            Some(ModeChange::Command)
        } else if !joint_holds {
            Some(ModeChange::Joint)
        } else {
            None
        }
    }

    fn change(&mut self, event: ModeChange) {
        let (time, state) = (self.time, self.state);
        match (event, self.mode.command, self.mode.joint, self.mode.contact) {
            (ModeChange::Command, Command::Free, _, _) => {
                let side = self.requested(time, &state).signum();
                self.mode.command = Command::AtLimit(side);
                self.saturated_from.get_or_insert(time);
            }
            (ModeChange::Command, Command::AtLimit(_), _, _) => self.mode.command = Command::Free,
            (ModeChange::Joint, ..) => {
                self.state[1] = 0.0;
                let pull = self.pull(time, &self.state);
                self.mode.joint = if pull.abs() <= self.dry_friction() {
                    FrictionMode::Stuck
                } else {
                    FrictionMode::Moving(pull.signum())
                };
            }
            (ModeChange::Contact, _, _, FoamContact::Touching) => {
                self.mode.contact = FoamContact::Apart(time, state[0] - state[2]);
            }
            (ModeChange::Contact, _, _, FoamContact::Apart(..)) => {
                self.mode.contact = FoamContact::Touching;
            }
        }
    }

    fn requested(&self, time: f64, state: &DriveState) -> f64 {
        let lag = self.speed * time - state[0];
        let slower = self.speed - state[1];
        (self.drive.proportional * lag + self.drive.derivative * slower) / self.drive.lever_arm
            + self.feed_forward
    }

    fn command(&self, time: f64, state: &DriveState) -> f64 {
        match self.mode.command {
            Command::Free => self.requested(time, state),
            Command::AtLimit(side) => side * self.drive.voltage_limit,
        }
    }

    fn contact_force(&self, state: &DriveState) -> f64 {
        match self.mode.contact {
            FoamContact::Touching => {
                self.foam.stiffness * (state[0] - state[2])
                    + self.foam.damping * (state[1] - state[3])
            }
            FoamContact::Apart(..) => 0.0,
        }
    }

    /// Compression that the free foam still has.
    fn relaxed(&self, since: f64, left: f64) -> f64 {
        if self.foam.damping > 0.0 {
            left * (-self.foam.stiffness / self.foam.damping * since).exp()
        } else {
            0.0
        }
    }

    /// Force on the impact point without dry friction.
    fn pull(&self, time: f64, state: &DriveState) -> f64 {
        let squared_arm = self.drive.lever_arm * self.drive.lever_arm;
        self.drive.force_per_volt() * self.command(time, state)
            - self.drive.viscous_friction / squared_arm * state[1]
            - self.contact_force(state)
    }

    fn dry_friction(&self) -> f64 {
        self.drive.static_friction / self.drive.lever_arm
    }

    fn head_acceleration(&self, time: f64, state: &DriveState) -> f64 {
        let neck = self.head.damping * (state[3] - self.torso_speed)
            + self.head.stiffness * (state[2] - self.torso_speed * time);
        (self.contact_force(state) - neck) / self.head.mass
    }

    fn derivative(&self, time: f64, state: &DriveState) -> DriveState {
        let acceleration = match self.mode.joint {
            FrictionMode::Moving(direction) => {
                (self.pull(time, state) - direction * self.dry_friction()) / self.mass
            }
            FrictionMode::Stuck => 0.0,
        };
        [
            state[1],
            acceleration,
            state[3],
            self.head_acceleration(time, state),
        ]
    }

    /// One Runge-Kutta step with the equations of the present mode.
    fn step(&self, step: f64) -> DriveState {
        let moved = |slope: &DriveState, share: f64| {
            let mut state = self.state;
            for (value, slope) in state.iter_mut().zip(slope) {
                *value += share * slope;
            }
            state
        };
        let half = 0.5 * step;
        let first = self.derivative(self.time, &self.state);
        let second = self.derivative(self.time + half, &moved(&first, half));
        let third = self.derivative(self.time + half, &moved(&second, half));
        let fourth = self.derivative(self.time + step, &moved(&third, step));
        let mut mean = [0.0; 4];
        for (k, mean) in mean.iter_mut().enumerate() {
            *mean = (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]) / 6.0;
        }
        moved(&mean, step)
    }
}
