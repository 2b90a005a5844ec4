//! Flies the aircraft of the usual configuration through the C interface, at the edges of the order of calls.

#![expect(unsafe_code, reason = "a C interface takes pointers")]

use core::mem::MaybeUninit;
use core::ptr::{from_mut, null_mut};
use mpp_c::{
    MPP_COUNTERS, MppConfig, MppCore, MppCounter, MppOutput, MppPlan, MppRefusal, MppScan,
    MppSensors, MppStatus, mpp_advance, mpp_begin, mpp_begin_blind, mpp_counters, mpp_finish,
    mpp_init, mpp_refused, mpp_set_up, mpp_step, mpp_storage_size, mpp_usual,
};
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{AirState, Airframe, Control, Trim, VehicleState, vehicle_rate};
use std::ffi::CStr;

#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct Line([u8; 16]);

/// A core, and the aircraft that it flies.
struct Flight {
    core: *mut MppCore,
    _storage: Vec<Line>,
    aircraft: VehicleState,
    control: Control,
    /// By how much the pitch reads too much [rad].
    bias: f64,
    /// Steps so far.
    steps: u32,
    time: f64,
}

fn usual() -> MppConfig {
    let mut config = MaybeUninit::uninit();
    // SAFETY: the place is that of a configuration, and the call writes it.
    unsafe {
        assert_eq!(mpp_usual(config.as_mut_ptr()), MppStatus::Ok);
        config.assume_init()
    }
}

impl Flight {
    fn new() -> Self {
        let size = mpp_storage_size();
        let mut storage = vec![Line([0; 16]); size.div_ceil(16)];
        let mut core = null_mut();
        // SAFETY: the storage is as large as it must be, and lives as long as the core.
        let made = unsafe { mpp_init(storage.as_mut_ptr().cast(), size, &mut core) };
        assert_eq!(made, MppStatus::Ok);
        let trim = Trim::at_speed(&Airframe::REFERENCE, 12.0, 0.0).unwrap();
        Self {
            core,
            _storage: storage,
            aircraft: VehicleState {
                x: 0.0,
                z: 50.0,
                air: trim.state,
            },
            control: trim.control,
            bias: 0.0,
            steps: 0,
            time: 0.0,
        }
    }

    fn with_latency(ticks: u32) -> Self {
        let mut flight = Self::new();
        let config = MppConfig {
            latency_ticks: ticks,
            ..usual()
        };
        assert_eq!(flight.set_up(&config), MppStatus::Ok);
        flight
    }

    fn set_up(&mut self, config: &MppConfig) -> MppStatus {
        // SAFETY: the core was made, and the configuration lives.
        unsafe { mpp_set_up(self.core, config) }
    }

    fn refused(&self) -> (String, [f64; 2]) {
        let mut refused = MaybeUninit::<MppRefusal>::uninit();
        // SAFETY: the core was made, and the call writes its place.
        let refused = unsafe {
            assert_eq!(mpp_refused(self.core, refused.as_mut_ptr()), MppStatus::Ok);
            refused.assume_init()
        };
        // SAFETY: the core ends the text.
        let name = unsafe { CStr::from_ptr(refused.name.as_ptr()) };
        let name = name.to_str().unwrap().to_owned();
        (name, [refused.least, refused.most])
    }

    /// What the sensors read. No value repeats.
    fn sensors(&self) -> MppSensors {
        let last_digits = 1e-9 * f64::from(self.steps % 2);
        MppSensors {
            has_air: true,
            air_age: 0,
            airspeed: self.aircraft.air.airspeed + last_digits,
            pitch: self.aircraft.air.pitch + self.bias + last_digits,
            has_position: true,
            position_age: 0,
            x: self.aircraft.x,
            z: self.aircraft.z,
            sigma: 0.0,
            has_velocity: false,
            velocity_x: 0.0,
            velocity_z: 0.0,
            velocity_sigma: 0.0,
        }
    }

    /// Makes a step with these sensors, and flies a tick.
    fn step_with(&mut self, sensors: &MppSensors) -> MppOutput {
        let mut output = MppOutput::default();
        // SAFETY: the core was made, and the values live.
        let status = unsafe { mpp_step(self.core, self.time, sensors, &mut output) };
        assert_eq!(status, MppStatus::Ok);
        self.control = Control {
            thrust: output.thrust,
            elevator: output.elevator,
        };
        for _ in 0..10 {
            let rate = vehicle_rate(&Airframe::REFERENCE, &self.aircraft, self.control);
            let own = &mut self.aircraft;
            own.x += rate.x * TICK_PERIOD / 10.0;
            own.z += rate.z * TICK_PERIOD / 10.0;
            let air = own.air.to_vector() + rate.air.to_vector() * (TICK_PERIOD / 10.0);
            own.air = AirState::from_vector(&air);
        }
        self.steps += 1;
        self.time = f64::from(self.steps) * TICK_PERIOD;
        output
    }

    fn step(&mut self) -> MppOutput {
        self.step_with(&self.sensors())
    }

    fn begin(&mut self, age: u32, ranges: &[f32]) -> MppStatus {
        let scan = MppScan {
            age,
            angle_min: -0.8,
            angle_increment: 0.016,
            count: ranges.len(),
            ranges: ranges.as_ptr(),
        };
        // SAFETY: the core was made, and there are `count` ranges.
        unsafe { mpp_begin(self.core, &scan) }
    }

    fn begin_blind(&mut self) -> MppStatus {
        // SAFETY: the core was made.
        unsafe { mpp_begin_blind(self.core) }
    }

    fn advance(&mut self) -> (MppStatus, bool) {
        let mut more = false;
        // SAFETY: the core was made, and the value lives.
        let status = unsafe { mpp_advance(self.core, &mut more) };
        (status, more)
    }

    fn finish(&mut self) -> Result<MppPlan, MppStatus> {
        let mut plan = MaybeUninit::uninit();
        // SAFETY: the core was made, and it writes the plan unless it refuses.
        unsafe {
            match mpp_finish(self.core, self.time, plan.as_mut_ptr()) {
                MppStatus::Ok => Ok(plan.assume_init()),
                status => Err(status),
            }
        }
    }

    /// Plans from a scan, and flies on until the plan is taken over.
    fn plan(&mut self, ranges: &[f32]) -> MppPlan {
        assert_eq!(self.begin(0, ranges), MppStatus::Ok);
        while self.advance() == (MppStatus::Ok, true) {}
        loop {
            match self.finish() {
                Err(MppStatus::Early) => self.step(),
                plan => return plan.unwrap(),
            };
        }
    }

    fn counter(&self, which: MppCounter) -> u32 {
        let mut counters = [0; MPP_COUNTERS];
        // SAFETY: the core was made, and the counters live.
        let status = unsafe { mpp_counters(self.core, from_mut(&mut counters)) };
        assert_eq!(status, MppStatus::Ok);
        counters[which as usize]
    }
}

const NOTHING: [f32; 100] = [0.0; 100];

#[test]
fn a_plan_is_taken_over_when_it_starts_and_not_before() {
    let (latency, age) = (7, 3);
    let mut flight = Flight::with_latency(latency);
    for _ in 0..20 {
        flight.step();
    }
    let begun = flight.time - TICK_PERIOD;
    assert_eq!(flight.begin(age, &NOTHING), MppStatus::Ok);
    while flight.advance() == (MppStatus::Ok, true) {}
    // The scan's own time and the latency are over after four of these ticks.
    for _ in 1..latency {
        assert_eq!(flight.finish().err(), Some(MppStatus::Early));
        assert!(!flight.step().tracking);
    }
    assert_eq!(flight.advance(), (MppStatus::Ok, false));
    let plan = flight.finish().unwrap();
    assert!((plan.start - (begun + 0.07)).abs() < 1e-9, "{}", plan.start);
    assert!(plan.complete && !plan.blind && plan.outcome == 0);
    let output = flight.step();
    assert!(output.tracking && (output.reference.x - plan.knots[0].x).abs() < 1e-6);
}

/// A bias of the pitch that the core finds turns its estimates without a jump of the position.
#[test]
fn a_turn_of_the_estimates_drops_the_cycle_and_the_map_and_tells_it() {
    let mut flight = Flight::with_latency(100);
    flight.bias = 0.1;
    let mut wall = NOTHING;
    for _ in 0..600 {
        let output = flight.step();
        if output.cycle_dropped {
            assert_eq!(flight.counter(MppCounter::PositionsRestarted), 0);
            assert_eq!(flight.advance().0, MppStatus::Idle);
            assert_eq!(flight.finish().err(), Some(MppStatus::Idle));
            // A scan that sees nothing contradicts no map.
            assert!(!flight.plan(&NOTHING).blind);
            return;
        }
        // A cycle is always under way, and its scan is another one each time.
        wall[40..60].fill(20.0 + 1e-3 * flight.steps as f32);
        if flight.finish().err() != Some(MppStatus::Early) {
            assert_eq!(flight.begin(0, &wall), MppStatus::Ok);
            while flight.advance() == (MppStatus::Ok, true) {}
        }
    }
    panic!("no cycle was dropped");
}

#[test]
fn a_scan_that_contradicts_the_map_is_told() {
    let mut flight = Flight::with_latency(1);
    let mut wall = NOTHING;
    wall[40..60].fill(20.0);
    flight.step();
    assert!(!flight.plan(&wall).blind);
    flight.step();
    assert!(flight.plan(&NOTHING).blind);
}

#[test]
fn no_cycle_begins_while_the_place_is_in_doubt() {
    let mut flight = Flight::with_latency(1);
    for _ in 0..50 {
        flight.step();
    }
    flight.steps += 80;
    flight.time += 0.8;
    let sensors = MppSensors {
        has_position: false,
        ..flight.sensors()
    };
    flight.step_with(&sensors);
    assert_eq!(flight.begin(0, &NOTHING), MppStatus::Lost);
    assert_eq!(flight.begin_blind(), MppStatus::Lost);
    flight.step();
    assert_eq!(flight.begin(0, &NOTHING), MppStatus::Ok);
    assert_eq!(flight.counter(MppCounter::TimeJumps), 1);
}

#[test]
fn a_scan_is_taken_once_and_a_frozen_lidar_is_told() {
    let mut flight = Flight::with_latency(1);
    for _ in 0..10 {
        flight.step();
    }
    let (mut scan, mut next) = (NOTHING, NOTHING);
    (scan[50], next[50]) = (40.0, 39.0);
    assert_eq!(flight.begin(2, &scan), MppStatus::Ok);
    flight.finish().unwrap();
    flight.step();
    // Another scan that is not newer, and a newer one that is the same.
    assert_eq!(flight.begin(3, &next), MppStatus::ScanRepeated);
    assert_eq!(flight.begin(0, &scan), MppStatus::ScanRepeated);
    assert_eq!(flight.begin(0, &next), MppStatus::Ok);
    // A lidar that sees nothing repeats that.
    for _ in 0..2 {
        flight.finish().unwrap();
        flight.step();
        assert_eq!(flight.begin(0, &NOTHING), MppStatus::Ok);
    }
    // The first scan of a flight repeats none.
    assert_eq!(flight.set_up(&usual()), MppStatus::Ok);
    flight.step();
    assert_eq!(flight.begin(0, &next), MppStatus::Ok);
}

#[test]
fn a_plan_without_a_scan_is_told() {
    let mut flight = Flight::with_latency(1);
    flight.step();
    assert_eq!(flight.begin_blind(), MppStatus::Ok);
    while flight.advance() == (MppStatus::Ok, true) {}
    assert!(flight.finish().unwrap().blind);
}

#[test]
fn a_step_goes_on_without_numbers_and_counts_them() {
    let mut flight = Flight::with_latency(1);
    flight.step();
    let sensors = MppSensors {
        airspeed: f64::NAN,
        sigma: -1.0,
        ..flight.sensors()
    };
    let output = flight.step_with(&sensors);
    assert!(output.thrust.is_finite() && output.estimate.airspeed.is_finite());
    assert_eq!(flight.counter(MppCounter::MeasurementsNotFinite), 1);
    assert_eq!(flight.counter(MppCounter::PositionsNotFinite), 1);
}

#[test]
fn a_refused_number_has_its_name_and_range() {
    let mut flight = Flight::new();
    let mut refuse = |change: fn(&mut MppConfig), status| {
        let mut config = usual();
        change(&mut config);
        assert_eq!(flight.set_up(&config), status);
        flight.refused()
    };
    let (name, range) = refuse(
        |config| config.aircraft.airframe.mass = -3.0,
        MppStatus::OutOfRange,
    );
    assert_eq!((name.as_str(), range), ("airframe.mass", [0.01, 1e6]));
    let (name, _) = refuse(
        |config| config.aircraft.cruise = 500.0,
        MppStatus::OutOfRange,
    );
    assert_eq!(name, "cruise");
    let (name, _) = refuse(|config| config.altitude = 1e6, MppStatus::Altitude);
    assert_eq!(name, "planner.altitude");
    let (name, _) = refuse(|config| config.range_max = 1e6, MppStatus::Range);
    assert_eq!(name, "the range of the lidar (sight)");
    // What no range refuses has no name.
    for (change, status) in [
        (
            (|config| config.paths = 51) as fn(&mut MppConfig),
            MppStatus::Paths,
        ),
        (|config| config.latency_ticks = 451, MppStatus::Period),
        (|config| config.aircraft.thrust_max = 1.0, MppStatus::Thrust),
        (
            |config| config.aircraft.airframe.moment_pitch_rate = -10.0,
            MppStatus::Ok,
        ),
        (|config| config.latency_ticks = 450, MppStatus::Ok),
    ] {
        assert_eq!(refuse(change, status).0, "");
    }
}
