//! The inputs of the watches of elevator and motor, from the estimators.

use super::Estimator;
use crate::estimate::{Innovation, MeasurementStatus, PositionVerdict, Progress};
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
}
