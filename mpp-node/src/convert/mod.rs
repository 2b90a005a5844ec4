//! Conversion between the messages of the link and the types of the core.

use crate::duration;
use hil_protocol::{
    Configure, ConfigureVerdict, ControlMode, LidarScan as WireScan, PlanControls, PlanOutcome,
    PlanTrajectory, Preset, RejectionCause, SensorFrame as WireFrame, SensorState, SensorStates,
    StepReport,
};
use mpp_core::config::{KNOTS, MAX_BEAMS, MAX_PATHS, STAGE_PERIOD, STAGES};
use mpp_core::control::RiccatiError;
use mpp_core::estimate::{Sensors, Trust};
use mpp_core::flight::{Adoption, FlightLoop, Mode, StepOutput};

use mpp_core::planner::SetupError;
use mpp_core::qp::CondenseError;
use mpp_core::sense::Measurement;
use mpp_core::sense::{AirData, GroundVelocity, LidarScan, Position, ScanError, SensorFrame};
use mpp_core::settings::{Setting, Settings};
use mpp_core::trajectory::{Reference, Trajectory};
use mpp_core::vehicle::Conditions;
use mpp_core::vehicle::{Control, TrimError, VehicleState};

/// The settings that a configuration asks for, or the first fault of the configuration.
pub(crate) fn settings(configure: &Configure) -> Result<Settings, ConfigureVerdict> {
    let mut settings = preset(configure)?;
    settings.planner.paths = usize::from(configure.paths);
    settings.planner.altitude = configure.altitude;
    settings.planner.seed = configure.seed;
    // The paper's method stays as published: it uses neither the lidar's range nor limits.
    if let Some(own) = settings.planner.plane_mut() {
        own.sight = f64::from(configure.range_max);
        own.latency = duration(configure.latency_ticks);
    }

    if settings.planner.paths > MAX_PATHS {
        return Err(ConfigureVerdict::TooManyPaths {
            max: MAX_PATHS as u16,
        });
    }
    check(configure)?;
    check_latency(configure, &settings)?;
    Ok(settings)
}

/// Checks that a plan is taken over before its horizon.
pub(crate) fn check_latency(
    configure: &Configure,
    settings: &Settings,
) -> Result<(), ConfigureVerdict> {
    let horizon = STAGES as f64 * STAGE_PERIOD * settings.units.time;
    if duration(configure.latency_ticks) > horizon {
        return Err(ConfigureVerdict::OutOfRange(Setting::Latency));
    }
    Ok(())
}

/// The settings of the preset for the aircraft, if this build contains its planner. The paper's presets have a
/// cruise of their own and know no limits.
fn preset(configure: &Configure) -> Result<Settings, ConfigureVerdict> {
    #[cfg(feature = "paper")]
    let of_paper = |settings: Settings| Settings {
        airframe: configure.aircraft.airframe,
        ..settings
    };
    match configure.preset {
        Preset::Flight => Ok(Settings::flight_of(
            &configure.aircraft,
            &configure.actuators,
        )),
        #[cfg(feature = "paper")]
        Preset::Reference => Ok(of_paper(Settings::reference())),
        #[cfg(feature = "paper")]
        Preset::Paper => Ok(of_paper(Settings::paper())),
        Preset::Space => Err(ConfigureVerdict::NoSuchPlanner),
        #[cfg(not(feature = "paper"))]
        Preset::Reference | Preset::Paper => Err(ConfigureVerdict::PresetNotBuilt),
    }
}

/// Checks the values of a configuration.
pub(crate) fn check(configure: &Configure) -> Result<(), ConfigureVerdict> {
    if configure.replan_period_ticks == 0 {
        return Err(ConfigureVerdict::ReplanPeriod);
    }
    if configure.latency_ticks == 0 || configure.latency_ticks > configure.replan_period_ticks {
        return Err(ConfigureVerdict::Latency);
    }
    if configure.slices_per_tick == 0 {
        return Err(ConfigureVerdict::SlicesPerTick);
    }
    if configure.beams == 0 || usize::from(configure.beams) > MAX_BEAMS {
        return Err(ConfigureVerdict::Beams {
            max: MAX_BEAMS as u16,
        });
    }
    if !configure.range_max.is_finite() || configure.range_max <= 0.0 {
        return Err(ConfigureVerdict::RangeMax);
    }
    if !configure.altitude.is_finite() {
        return Err(ConfigureVerdict::NonFinite);
    }
    if !configure.actuators.is_valid() {
        return Err(ConfigureVerdict::Actuators);
    }
    Ok(())
}

/// The verdict on a failed set-up. The match has no catch-all arm, so that each new cause needs a verdict.
pub(crate) fn setup_verdict(error: SetupError) -> ConfigureVerdict {
    match error {
        SetupError::Trim(error) => trim_verdict(error),
        SetupError::Regulator(error) => match error {
            RiccatiError::NotFinite => ConfigureVerdict::RegulatorNotFinite,
            RiccatiError::Singular => ConfigureVerdict::RegulatorSingular,
            RiccatiError::NotConverged => ConfigureVerdict::RegulatorNotConverged,
            RiccatiError::NotStabilising => ConfigureVerdict::RegulatorNotStabilising,
        },
        SetupError::NoSteadyState => ConfigureVerdict::PlanModel,
        SetupError::Condense(CondenseError) => ConfigureVerdict::PlanWeights,
        SetupError::Unstable => ConfigureVerdict::Unstable,
        SetupError::TooManyPaths => ConfigureVerdict::TooManyPaths {
            max: MAX_PATHS as u16,
        },
        SetupError::OutOfRange(setting) => ConfigureVerdict::out_of_range(setting),
        SetupError::NoPaths => ConfigureVerdict::PathsZero,
        SetupError::OtherMethod => ConfigureVerdict::OtherPreset,
        SetupError::ThrustTooLow => ConfigureVerdict::ThrustTooLow,
    }
}

pub(crate) fn trim_verdict(error: TrimError) -> ConfigureVerdict {
    match error {
        TrimError::Airspeed => ConfigureVerdict::CruiseAirspeed,
        TrimError::Airframe => ConfigureVerdict::AirframeNotFinite,
        TrimError::NotCarried => ConfigureVerdict::NotCarried,
        TrimError::NoElevator => ConfigureVerdict::NoElevator,
        // `Angle` cannot occur here, because the angle of level flight is 0.
        TrimError::Angle | TrimError::NotConverged => ConfigureVerdict::NotTrimmable,
    }
}

/// The measurements with their ages. A measurement from the future gets an age beyond all that the
/// estimators use.
#[must_use]
pub fn sensor_frame(frame: &WireFrame) -> SensorFrame {
    let age = |tick: u32| frame.tick.wrapping_sub(tick);
    SensorFrame {
        air: frame.air.map(|air| AirData {
            age: age(air.tick),
            measurement: Measurement {
                airspeed: air.airspeed,
                pitch: air.pitch,
            },
        }),
        position: frame.position.map(|position| Position {
            age: age(position.tick),
            x: position.x,
            z: position.z,
            sigma: f64::from(position.sigma),
            velocity: position.velocity.map(|velocity| GroundVelocity {
                x: f64::from(velocity.x),
                z: f64::from(velocity.z),
                sigma: f64::from(velocity.sigma),
            }),
        }),
    }
}

/// Copies a scan. Both types have room for the same number of beams.
pub(crate) fn scan(wire: &WireScan, scan: &mut LidarScan) {
    scan.angle_min = f64::from(wire.angle_min);
    scan.angle_increment = f64::from(wire.angle_increment);
    scan.ranges.clone_from(&wire.ranges);
}

const _: () = assert!(hil_protocol::MAX_BEAMS == MAX_BEAMS);

pub(crate) fn scan_rejection(error: ScanError) -> RejectionCause {
    match error {
        ScanError::Length { expected, found } => RejectionCause::ScanLength {
            expected: expected as u16,
            found: found as u16,
        },
        ScanError::BadBeams { beam } => RejectionCause::ScanRange { beam: beam as u16 },
        ScanError::AngleNotFinite => RejectionCause::ScanAngle,
    }
}

pub(crate) fn outcome(adoption: Adoption) -> PlanOutcome {
    match adoption {
        Adoption::Feasible => PlanOutcome::Adopted,
        Adoption::LeastViolating => PlanOutcome::LeastViolating,
        Adoption::Kept => PlanOutcome::KeptPrevious,
        Adoption::TrimHold => PlanOutcome::TrimHold,
        Adoption::Pursuit => PlanOutcome::Pursuit,
        Adoption::Reserve => PlanOutcome::Reserve,
        Adoption::Latest => PlanOutcome::Latest,
    }
}

pub(crate) fn trajectory(scan_tick: u32, trajectory: &Trajectory) -> PlanTrajectory {
    let knot = |reference: &Reference| {
        let state = &reference.state;
        [state.x, state.z, state.air.flight_path].map(|value| value as f32)
    };
    PlanTrajectory {
        scan_tick,
        period: trajectory.stage_period as f32,
        knots: trajectory.knots.iter().map(knot).collect(),
    }
}

/// The commands along the trajectory that is flown.
pub(crate) fn controls(scan_tick: u32, flown: &FlightLoop) -> Option<PlanControls> {
    let knot = |reference: &Reference| {
        let Control { thrust, elevator } = flown.command_for(reference.feedforward);
        [thrust, elevator].map(|value| value as f32)
    };
    let knots = flown.trajectory()?.knots.iter().map(knot).collect();
    Some(PlanControls { scan_tick, knots })
}

const _: () = assert!(hil_protocol::MAX_KNOTS == KNOTS);

pub(crate) fn mode(mode: Mode) -> ControlMode {
    match mode {
        Mode::TrimHold => ControlMode::TrimHold,
        Mode::Tracking => ControlMode::Tracking,
    }
}

pub(crate) fn step_report(
    tick: u32,
    plan_age_ticks: u32,
    estimate: &VehicleState,
    conditions: &Conditions,
    sensors: SensorStates,
    output: &StepOutput,
) -> StepReport {
    let state = &output.reference.state;
    let air = state.air.to_vector();
    StepReport {
        tick,
        estimate: estimate.air.to_vector().into(),
        position: [estimate.x, estimate.z],
        wind: [conditions.wind.x, conditions.wind.z],
        lift: conditions.lift,
        reference: [state.x, state.z, air.x, air.y, air.z, air.w],
        plan_age_ticks,
        sensors,
    }
}

pub(crate) fn sensor_states(sensors: Sensors, lidar: Trust) -> SensorStates {
    let state = |trust| match trust {
        Trust::Healthy => SensorState::Healthy,
        Trust::Suspected => SensorState::Suspected,
        Trust::Excluded => SensorState::Excluded,
        Trust::Recovering => SensorState::Recovering,
    };
    SensorStates {
        airspeed: state(sensors.airspeed),
        pitch: state(sensors.pitch),
        position: state(sensors.position),
        lidar: state(lidar),
        elevator: state(sensors.elevator),
        motor: state(sensors.motor),
    }
}

#[cfg(test)]
mod tests;
