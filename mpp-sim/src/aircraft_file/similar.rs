//! The same aircraft in other units and in other sizes. Each of them must fly as the first one does.

use super::{AircraftFile, Angle, ElevatorUnit};
use std::f64::consts::PI;

impl AircraftFile {
    /// The aircraft with its elevator's command in another unit: `factor` of the new units are one of the
    /// present.
    #[must_use]
    pub fn with_command(&self, factor: f64) -> Self {
        let per_command = |derivative: f64| match (self.elevator.unit, self.derivatives) {
            (ElevatorUnit::Command, _)
            | (ElevatorUnit::Rad, Angle::Radian)
            | (ElevatorUnit::Deg, Angle::Degree) => derivative / factor,
            (ElevatorUnit::Rad, Angle::Degree) => derivative * 180.0 / PI / factor,
            (ElevatorUnit::Deg, Angle::Radian) => derivative * PI / 180.0 / factor,
        };
        let mut other = self.clone();
        let elevator = &mut other.elevator;
        elevator.unit = ElevatorUnit::Command;
        elevator.moment = per_command(elevator.moment);
        elevator.lift = per_command(elevator.lift);
        for limit in [&mut elevator.min, &mut elevator.max, &mut elevator.rate] {
            *limit = limit.map(|limit| limit * factor);
        }
        other
    }

    /// The aircraft that is similar to this one by Froude's law: lengths times `scale`, times and speeds times
    /// its root, masses and forces times its cube.
    #[must_use]
    pub fn similar(&self, scale: f64) -> Self {
        let (time, cube) = (scale.sqrt(), scale.powi(3));
        let mut other = self.clone();
        other.mass *= cube;
        other.pitch_inertia *= cube * scale * scale;
        other.wing_area *= scale * scale;
        other.chord *= scale;
        other.cruise *= time;
        other.body_radius *= scale;
        other.moment.alpha_rate_time *= time;
        other.elevator.rate = other.elevator.rate.map(|rate| rate / time);
        other.thrust.max = other.thrust.max.map(|thrust| thrust * cube);
        other.thrust.lag = other.thrust.lag.map(|lag| lag * time);
        for delay in [&mut other.elevator.delay, &mut other.thrust.delay] {
            *delay = delay.map(|delay| delay * time);
        }
        if let Some(lateral) = &mut other.lateral {
            lateral.span *= scale;
            for inertia in [
                &mut lateral.roll_inertia,
                &mut lateral.yaw_inertia,
                &mut lateral.product_inertia,
            ] {
                *inertia *= cube * scale * scale;
            }
            let surfaces = [Some(&mut lateral.aileron), lateral.rudder.as_mut()];
            for surface in surfaces.into_iter().flatten() {
                surface.rate /= time;
                surface.bandwidth /= time;
            }
            if let Some(roll) = &mut lateral.roll_loop {
                roll.span *= scale;
                roll.frequency /= time;
                roll.delay *= time;
                roll.max_rate /= time;
            }
        }
        other
    }
}
