//! The range of every number of the settings. A number outside of its range, also one that is not finite,
//! is a mistake: no aircraft that the core is made for has it.

use super::{PlannerSettings, Settings};
use crate::config::{MAX_PATHS, STAGE_PERIOD, STAGES};
use crate::units::REFERENCE_CRUISE;
use core::fmt;

/// Defines the numbers, with their ranges and where they stand. A setting that has no value is in range.
macro_rules! numbers {
    ($($of:ident as $settings:ident { $(
        $variant:ident, $name:literal, $unit:literal, $range:expr, $get:expr;
    )* })*) => {
        /// A number of [`Settings`]. [`Display`](fmt::Display) gives the name of its field.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Setting {
            $($(
                #[doc = concat!("`", $name, "`, unit: ", $unit, ".")]
                $variant,
            )*)*
        }

        impl Setting {
            /// All numbers of the settings.
            pub const ALL: &'static [Self] = &[$($(Self::$variant),*),*];

            /// Least and greatest value.
            #[must_use]
            pub const fn range(self) -> [f64; 2] {
                match self {
                    $($(Self::$variant => $range,)*)*
                }
            }

            /// The unit of value and range.
            #[must_use]
            pub const fn unit(self) -> &'static str {
                match self {
                    $($(Self::$variant => $unit,)*)*
                }
            }
        }

        impl fmt::Display for Setting {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $($(Self::$variant => $name,)*)*
                })
            }
        }

        $(impl $of {
            /// The first number of these settings that is outside of its range. A number that is not finite
            /// is in no range.
            fn own_out_of_range(&self) -> Option<Setting> {
                let $settings = self;
                $(
                    let [least, most] = Setting::$variant.range();
                    let number: Option<f64> = $get;
                    if number.is_some_and(|number| !(least..=most).contains(&number)) {
                        return Some(Setting::$variant);
                    }
                )*
                None
            }
        })*
    };
}

impl Settings {
    /// The force of lift that a derivative by an angular rate [s/rad] gives at cruise, over the force that turns
    /// the path at this rate [-].
    fn share_of_momentum(&self, per_rate: f64) -> f64 {
        let (a, airspeed) = (&self.airframe, self.cruise.airspeed());
        let airspeed = airspeed.unwrap_or(REFERENCE_CRUISE);
        0.5 * a.air_density * airspeed * a.wing_area * per_rate / a.mass
    }

    /// The first number that is outside of its range. A number that is not finite is in no range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<Setting> {
        self.own_out_of_range()
            .or_else(|| self.planner.out_of_range())
    }
}

impl PlannerSettings {
    /// The first number that is outside of its range. A number that is not finite is in no range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<Setting> {
        self.own_out_of_range()
    }

    /// The padding of the paper's method near and far, if it is the chosen method.
    fn padding(&self) -> Option<[f64; 2]> {
        #[cfg(feature = "paper")]
        let padding = self.paper().map(|own| [own.padding.near, own.padding.far]);
        #[cfg(not(feature = "paper"))]
        let padding = None;
        padding
    }
}

numbers! {
    Settings as all {
        LengthUnit, "units.length", "m", [1e-3, 1e3], Some(all.units.length);
        TimeUnit, "units.time", "s", [1e-2, 1e2], Some(all.units.time);
        MassUnit, "units.mass", "kg", [1e-4, 1e5], Some(all.units.mass);
        Mass, "airframe.mass", "kg", [0.01, 1e5], Some(all.airframe.mass);
        PitchInertia, "airframe.pitch_inertia", "kg m^2", [1e-6, 1e6], Some(all.airframe.pitch_inertia);
        WingArea, "airframe.wing_area", "m^2", [1e-3, 100.0], Some(all.airframe.wing_area);
        MomentLength, "airframe.moment_length", "m", [1e-3, 1e2], Some(all.airframe.moment_length);
        AirDensity, "airframe.air_density", "kg/m^3", [0.1, 2.0], Some(all.airframe.air_density);
        LiftZero, "airframe.lift_zero", "1", [-5.0, 5.0], Some(all.airframe.lift_zero);
        LiftAlpha, "airframe.lift_alpha", "1/rad", [0.1, 20.0], Some(all.airframe.lift_alpha);
        LiftElevator, "airframe.lift_elevator", "1", [-100.0, 100.0], Some(all.airframe.lift_elevator);
        DragZero, "airframe.drag_zero", "1", [0.0, 5.0], Some(all.airframe.drag_zero);
        DragInduced, "airframe.drag_induced", "1", [0.0, 5.0], Some(all.airframe.drag_induced);
        MomentZero, "airframe.moment_zero", "1", [-10.0, 10.0], Some(all.airframe.moment_zero);
        // Plans take the angle of attack that elevator and stiffness balance, so there must be a stiffness.
        MomentAlpha, "airframe.moment_alpha", "1/rad", [-100.0, -0.01], Some(all.airframe.moment_alpha);
        MomentAlphaRate, "airframe.moment_alpha_rate", "s/rad", [-100.0, 0.0],
            Some(all.airframe.moment_alpha_rate);
        MomentPitchRate, "airframe.moment_pitch_rate", "s/rad", [-100.0, 0.0],
            Some(all.airframe.moment_pitch_rate);
        // The elevator may count in either direction, but it must have an effect.
        MomentElevator, "the magnitude of airframe.moment_elevator", "1", [1e-4, 100.0],
            Some(libm::fabs(all.airframe.moment_elevator));
        MotorThrust, "actuators.thrust_max", "N", [1e-3, 1e5], all.actuators.thrust_max;
        ThrustLag, "actuators.thrust_lag", "s", [1e-4, 60.0], all.actuators.thrust_lag;
        ElevatorBelow, "actuators.elevator_below", "1", [1e-3, 1e4], all.actuators.elevator_below;
        ElevatorAbove, "actuators.elevator_above", "1", [1e-3, 1e4], all.actuators.elevator_above;
        ElevatorRate, "actuators.elevator_rate", "1/s", [1e-3, 1e6], all.actuators.elevator_rate;
        CruiseAirspeed, "cruise", "m/s", [1.0, 200.0], all.cruise.airspeed();
        // Plans divide by the momentum without these shares, also at more than the airspeed of level flight.
        LiftAlphaRate, "the momentum's share by airframe.lift_alpha_rate", "1", [-0.4, 0.4],
            Some(all.share_of_momentum(all.airframe.lift_alpha_rate));
        LiftPitchRate, "the momentum's share by airframe.lift_pitch_rate", "1", [-0.4, 0.4],
            Some(all.share_of_momentum(all.airframe.lift_pitch_rate));
        DesignThrust, "design_thrust", "N", [0.0, 1e6], all.design_thrust;
        SpeedNoise, "estimator.process_noise[0]", "m^2/s^2", [0.0, 1e4], Some(all.estimator.process_noise[0]);
        PitchNoise, "estimator.process_noise[1]", "rad^2", [0.0, 100.0], Some(all.estimator.process_noise[1]);
        RateNoise, "estimator.process_noise[2]", "rad^2/s^2", [0.0, 1e4],
            Some(all.estimator.process_noise[2]);
        PathNoise, "estimator.process_noise[3]", "rad^2", [0.0, 100.0], Some(all.estimator.process_noise[3]);
        AirspeedVariance, "estimator.airspeed_variance", "m^2/s^2", [1e-12, 1e4],
            Some(all.estimator.airspeed_variance);
        PitchVariance, "estimator.pitch_variance", "rad^2", [1e-12, 100.0],
            Some(all.estimator.pitch_variance);
        InitialVariance, "estimator.initial_variance", "1", [1e-12, 1e4],
            Some(all.estimator.initial_variance);
        Gate, "estimator.gate", "standard deviations", [1.0, 1e4], Some(all.estimator.gate);
        WindChange, "wind_change", "m/s in 1 s", [1e-3, 100.0], all.wind_change;
        SpeedWeight, "regulator.state[0]", "s^2/m^2", [0.0, 1e9], Some(all.regulator.state[0]);
        PitchWeight, "regulator.state[1]", "1/rad^2", [0.0, 1e9], Some(all.regulator.state[1]);
        RateWeight, "regulator.state[2]", "s^2/rad^2", [0.0, 1e9], Some(all.regulator.state[2]);
        PathWeight, "regulator.state[3]", "1/rad^2", [0.0, 1e9], Some(all.regulator.state[3]);
        ElevatorWeight, "regulator.elevator", "1", [1e-6, 1e9], Some(all.regulator.elevator);
        CrossTrack, "cross_track", "rad/m", [0.0, 10.0], Some(all.cross_track);
        AirspeedHold, "airspeed_hold", "N s/m", [0.0, 1e6], Some(all.airspeed_hold);
        // The clearance is known up to 3 of the planner's units of length; the rest is for the margin.
        BodyRadius, "body_radius", "m over the planner's unit of length", [0.0, 2.0],
            all.planner.plane().map(|own| own.body_radius / all.units.length);
        // A plan ends at the horizon; it is of no use if the vehicle takes it over later.
        Latency, "latency", "s of the planner's units", [0.0, STAGES as f64 * STAGE_PERIOD],
            all.planner.plane().map(|own| own.latency / all.units.time);
    }
    PlannerSettings as planner {
        Altitude, "planner.altitude", "m", [-1e3, 2e4], Some(planner.altitude);
        PlanElevatorWeight, "planner.weights.control[0]", "1", [1e-6, 1e9], Some(planner.weights.control[0]);
        PlanThrustWeight, "planner.weights.control[1]", "1/N^2", [1e-6, 1e9],
            Some(planner.weights.control[1]);
        PlanTerminalWeight, "planner.weights.terminal", "1", [0.0, 1e9], Some(planner.weights.terminal);
        Sight, "sight", "m", [1.0, 1e4], planner.plane().map(|own| own.sight);
        PenaltyLinear, "penalty.linear", "1/m", [1e-6, 1e12], planner.plane().map(|own| own.penalty.linear);
        PenaltyQuadratic, "penalty.quadratic", "1/m^2", [1e-6, 1e12],
            planner.plane().map(|own| own.penalty.quadratic);
        AngleOfAttackLimit, "attitude.angle_of_attack", "rad", [1e-3, 1.5],
            planner.plane().map(|own| own.attitude.angle_of_attack);
        FlightPathLimit, "attitude.flight_path", "rad", [1e-3, 1.5],
            planner.plane().map(|own| own.attitude.flight_path);
        SqpIterations, "sqp_iterations", "iterations", [1.0, 100.0], planner.plane().map(|own| f64::from(own.sqp_iterations));
        RefinedCandidates, "refined_candidates", "candidates", [0.0, MAX_PATHS as f64],
            planner.plane().map(|own| own.refined_candidates as f64);
        Margin, "margin", "m", [1e-3, 500.0], planner.plane().map(|own| own.margin);
        Stall, "stall", "rad", [1e-3, 1.5], planner.plane().and_then(|own| own.stall);
        Band, "band", "m", [0.1, 1e4], planner.plane().map(|own| own.band);
        PlanThrust, "thrust_max", "N", [0.1, 1e6], planner.plane().map(|own| own.thrust_max);
        PaddingNear, "padding.near", "m", [0.0, 20.0], planner.padding().map(|[near, _]| near);
        PaddingFar, "padding.far", "m", [0.0, 20.0], planner.padding().map(|[_, far]| far);
    }
}
