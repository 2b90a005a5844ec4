//! Between wire messages and the core's types.

use hil_protocol::{
    ActuatorLimits as WireLimits, AirframeId, Configure, ConfigureVerdict, ControlMode,
    LidarScan as WireScan, PlanOutcome, PlanTrajectory, Preset, RejectionCause,
    SensorFrame as WireFrame, StepReport,
};
use mpp_core::config::{KNOTS, MAX_BEAMS, MAX_PATHS, STAGE_PERIOD};
use mpp_core::estimate::Measurement;
use mpp_core::flight::{Adoption, Mode, StepOutput};
use mpp_core::planner::SetupError;
use mpp_core::sense::{LidarScan, ScanError, SensorFrame};
use mpp_core::settings::Settings;
use mpp_core::trajectory::{Reference, Trajectory};
use mpp_core::vehicle::{ActuatorLimits, AirState, Airframe};

/// The settings that a configuration asks for, or what is wrong with it.
pub(crate) fn settings(configure: &Configure) -> Result<Settings, ConfigureVerdict> {
    let mut settings = match configure.preset {
        Preset::Reference => Settings::reference(),
        Preset::Paper => Settings::paper(),
        Preset::Flight => Settings::flight(),
    };
    settings.airframe = match configure.airframe {
        AirframeId::Paper => Airframe::PAPER,
        AirframeId::Reference => Airframe::REFERENCE,
    };
    settings.planner.paths = usize::from(configure.paths);
    settings.planner.altitude = configure.altitude;
    settings.planner.sight = f64::from(configure.range_max);
    settings.planner.seed = configure.seed;
    // The others are kept as published: they know of no limits.
    if configure.preset == Preset::Flight {
        settings.actuators = actuators(&configure.actuators);
    }

    if settings.planner.paths > MAX_PATHS {
        return Err(ConfigureVerdict::TooManyPaths {
            max: MAX_PATHS as u16,
        });
    }
    check(configure)?;
    Ok(settings)
}

/// What is wrong with a configuration, apart from its settings.
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
    if !actuators(&configure.actuators).is_valid() {
        return Err(ConfigureVerdict::Actuators);
    }
    Ok(())
}

fn actuators(wire: &WireLimits) -> ActuatorLimits {
    ActuatorLimits {
        thrust_max: wire.thrust_max.map(f64::from),
        thrust_lag: wire.thrust_lag.map(f64::from),
        elevator_range: wire.elevator_range.map(f64::from),
        elevator_rate: wire.elevator_rate.map(f64::from),
    }
}

/// How a failed set-up is told.
pub(crate) fn setup_verdict(error: SetupError) -> ConfigureVerdict {
    match error {
        SetupError::TooManyPaths => ConfigureVerdict::TooManyPaths {
            max: MAX_PATHS as u16,
        },
        SetupError::Number => ConfigureVerdict::NonFinite,
        SetupError::Actuators => ConfigureVerdict::Actuators,
        _ => ConfigureVerdict::NotTrimmable,
    }
}

pub(crate) fn sensor_frame(frame: &WireFrame) -> SensorFrame {
    SensorFrame {
        measurement: Measurement {
            airspeed: frame.airspeed,
            pitch: frame.pitch,
        },
        x: frame.x,
        z: frame.z,
    }
}

/// Copies a scan; both sides hold the same number of beams.
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
        ScanError::NotFinite { beam } => RejectionCause::ScanNotFinite { beam: beam as u16 },
        ScanError::OutOfRange { beam } => RejectionCause::ScanRange { beam: beam as u16 },
        // The angles stand for every beam.
        _ => RejectionCause::ScanNotFinite { beam: 0 },
    }
}

pub(crate) fn outcome(adoption: Adoption) -> PlanOutcome {
    match adoption {
        Adoption::Feasible => PlanOutcome::Adopted,
        Adoption::LeastViolating => PlanOutcome::LeastViolating,
        Adoption::Kept => PlanOutcome::KeptPrevious,
        Adoption::TrimHold => PlanOutcome::TrimHold,
    }
}

pub(crate) fn trajectory(scan_tick: u32, trajectory: &Trajectory) -> PlanTrajectory {
    let knot = |reference: &Reference| {
        let state = &reference.state;
        [state.x, state.z, state.air.flight_path].map(|value| value as f32)
    };
    PlanTrajectory {
        scan_tick,
        period: STAGE_PERIOD as f32,
        knots: trajectory.knots.iter().map(knot).collect(),
    }
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
    estimate: &AirState,
    output: &StepOutput,
) -> StepReport {
    let state = &output.reference.state;
    let air = state.air.to_vector();
    StepReport {
        tick,
        estimate: estimate.to_vector().into(),
        reference: [state.x, state.z, air.x, air.y, air.z, air.w],
        plan_age_ticks,
    }
}
