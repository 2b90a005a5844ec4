//! The inputs of the watches of elevator and motor, from the estimators.

use super::Estimator;
use crate::estimate::{Innovation, MeasurementStatus, PositionVerdict, Progress, Seen};
use crate::sense::AirData;
use crate::tuning::sensors::LONGEST_PREDICTION;

impl Estimator {
    /// Compares the turn with that of the commands, if the air data can be trusted.
    pub(super) fn watch_elevator(
        &mut self,
        elapsed: f64,
        air: Option<&AirData>,
        innovation: Innovation,
    ) {
        // A pitch that is not used is watched too: its turns show when it can be believed again.
        let good = matches!(
            innovation.pitch,
            MeasurementStatus::Accepted | MeasurementStatus::Gated | MeasurementStatus::Distrusted
        ) && self.air.lag() == 0;
        let Some(air) = air.filter(|_| good && elapsed > 0.0 && elapsed < LONGEST_PREDICTION)
        else {
            return;
        };
        let (pitch, lift) = (
            air.measurement.pitch - self.pitch_error,
            self.conditions().lift,
        );
        let altitude = self.navigation.quick().position().1;
        let failed = self.actuators.elevator().pitch_fails();
        (self.actuators).see_turn((pitch, altitude), self.air.present(), lift, elapsed);
        if self.actuators.elevator().pitch_fails() && !failed {
            self.drop_pitch();
        }
    }

    /// Excludes the pitch sensor and replaces what it has taught: the path is that over ground in still air, and the angle of
    /// attack is that of the commands.
    fn drop_pitch(&mut self) {
        self.pitch.exclude();
        let air = *self.air.present();
        let (_, climb) = self.conditions().wind.ground_velocity(&air);
        let path = libm::asin((climb / air.airspeed).clamp(-1.0, 1.0));
        let angle = self.actuators.elevator().angle_of_attack();
        self.air.restart_pitch(path, angle);
        self.navigation
            .turn(path - air.flight_path, self.air.present());
        self.actuators.see_speed(None, 0.0);
    }

    /// Compares the speed with the thrust, if the wind is known and the airspeed is measured.
    pub(super) fn watch_motor(&mut self, elapsed: f64, position: Option<PositionVerdict>) {
        let air = self.air.present();
        let along = 1.0 - 0.5 * (air.flight_path * air.flight_path); // The cosine, to 2 % at 45 degrees.
        let progress = Progress {
            x: self.navigation.quick().position().0,
            air: air.airspeed * along,
            corrected: self.corrected * along,
            wind: self.navigation.quick().wind().x,
        };
        let right = self.airspeed.uses() && self.biases.airspeed().is_right(self.conditions().lift);
        let settled = self.navigation.is_settled() && position != Some(PositionVerdict::Restarted);
        if elapsed > 0.0 {
            self.corrected = 0.0;
            (self.actuators).see_speed((right && settled).then_some(&progress), elapsed);
        }
    }

    /// Compares the air data with the motion over ground. If both sensors are wrong, the air is calm, and the airframe is the
    /// known one.
    pub(super) fn watch_ground(&mut self, elapsed: f64, air: Option<&AirData>) {
        let frozen = self.airspeed_changes.frozen() || self.pitch_changes.frozen();
        let usable = self.navigation.is_settled() && self.air.lag() == 0 && !frozen;
        let (Some(air), Some(lift)) = (air.filter(|_| usable), &mut self.lift) else {
            return;
        };
        let velocity = (self.navigation.quick().wind()).ground_velocity(self.air.present());
        let seen = Seen {
            velocity,
            airspeed: air.measurement.airspeed,
            pitch: air.measurement.pitch,
            angle_of_attack: self.actuators.elevator().angle_of_attack(),
            thrust: self.actuators.effective().thrust,
        };
        if self.biases.see_ground(&seen, elapsed) {
            let speed = libm::hypot(velocity.0, velocity.1);
            self.air.shift_airspeed(speed - self.air.present().airspeed);
            self.navigation.set_wind_along(0.0);
            lift.set_offset(0.0);
            self.actuators.see_speed(None, 0.0);
        }
    }
}
