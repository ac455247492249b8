//! Settings of the follower.

use nalgebra::Vector2;

use navigation_laws::impedance::bank::BankLayout;
use navigation_laws::impedance::{Attraction, BankOptions, Impedance};
use navigation_world::robots::differential::{VelocityDrive, VelocityRule};
use navigation_world::sensing::Vision;
use navigation_world::sensing::fixes::Fixes;
use navigation_world::sensing::sonar::{Beam, Firing, Ranging, SonarArray};
use navigation_world::world::frame::Frame;
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};

/// Longest run, in steps.
pub const MOST_STEPS: f64 = 1e7;

/// Three ultrasonic sensors in front of the robot, and three more behind if wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// Distance of the sensors ahead of the center, `P_0`, in m.
    pub forward: f64,
    /// Distance of the outer sensors from the middle one, in m.
    pub spacing: f64,
    /// Angle between neighboring axes, in rad.
    pub fan: f64,
    /// Full angle of each beam, in rad.
    pub beam_width: f64,
    /// Rays of each beam.
    pub rays: usize,
    /// Limits, temperature and noise.
    pub ranging: Ranging,
    /// Which sensors fire when.
    pub firing: Firing,
    /// Three more sensors, turned by half a turn about the center.
    pub rear: bool,
}

impl Default for Sensors {
    fn default() -> Self {
        Self {
            forward: 0.20,
            spacing: 0.15,
            fan: 30.0_f64.to_radians(),
            beam_width: 30.0_f64.to_radians(),
            rays: 13,
            ranging: Ranging::default(),
            firing: Firing::default(),
            rear: false,
        }
    }
}

impl Sensors {
    /// The three sensors in the axes of their bank.
    ///
    /// # Errors
    /// A number is not finite, or negative.
    pub fn layout(&self) -> Result<BankLayout> {
        not_negative("sensor_forward", self.forward)?;
        not_negative("sensor_spacing", self.spacing)?;
        finite("sensor_fan", self.fan)?;
        let mount = |side: f64| Frame::at([0.0, side * self.spacing], side * self.fan);
        Ok(BankLayout {
            mounts: [mount(-1.0), mount(0.0), mount(1.0)],
        })
    }

    /// Origins and fronts of the banks on the robot.
    #[must_use]
    pub fn banks(&self) -> Vec<Frame> {
        let bank = |sign: f64| Frame {
            position: Vector2::new(sign * self.forward, 0.0),
            direction: Vector2::new(sign, 0.0),
        };
        let signs: &[f64] = if self.rear { &[1.0, -1.0] } else { &[1.0] };
        signs.iter().map(|sign| bank(*sign)).collect()
    }

    /// All sensors on the robot, bank by bank.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn array(&self) -> Result<SonarArray> {
        let layout = self.layout()?;
        let mounts = self
            .banks()
            .iter()
            .flat_map(|bank| layout.mounts.iter().map(|mount| bank.carrying(mount)))
            .collect();
        let beam = Beam::new(self.beam_width, self.rays)?;
        SonarArray::new(mounts, beam, self.ranging, self.firing)
    }
}

/// Everything about the follower.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The robot.
    pub drive: VelocityDrive,
    /// Its ultrasonic sensors.
    pub sensors: Sensors,
    /// A camera that tells of the obstacles in place of the sonar, as far as the sonar reaches.
    pub obstacle_vision: Option<Vision>,
    /// Its ear.
    pub fixes: Fixes,
    /// Attraction to the source.
    pub attraction: Attraction,
    /// Repulsion.
    pub impedance: Impedance,
    /// From readings to forces.
    pub bank: BankOptions,
    /// Rule for the virtual velocity.
    pub velocity: VelocityRule,
    /// Control period, in s.
    pub step: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            drive: VelocityDrive::default(),
            sensors: Sensors::default(),
            obstacle_vision: None,
            fixes: Fixes::default(),
            attraction: Attraction::default(),
            impedance: Impedance::default(),
            bank: BankOptions::default(),
            velocity: VelocityRule::default(),
            step: 0.025,
        }
    }
}

impl Settings {
    /// Returns the settings if they are valid.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn checked(self) -> Result<Self> {
        self.drive.checked()?;
        self.sensors.array()?;
        let vision = self.obstacle_vision;
        vision.map(Vision::checked).transpose()?;
        self.attraction.checked()?;
        self.impedance.checked()?;
        self.bank.checked()?;
        positive("step", self.step)?;
        let fixes = self.fixes.checked()?;
        Ok(Self { fixes, ..self })
    }

    /// Number of steps of a run of a duration in s.
    ///
    /// # Errors
    /// The duration is not positive, or there would be too many steps.
    pub fn steps(&self, duration: f64) -> Result<usize> {
        positive("duration", duration)?;
        let steps = (duration / self.step).round();
        if !(1.0..=MOST_STEPS).contains(&steps) {
            let rule = "be from one step to ten million steps";
            return Err(Failure::invalid("duration", rule, Given::Number(duration)));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 1 to 1e7
        Ok(steps as usize)
    }
}
