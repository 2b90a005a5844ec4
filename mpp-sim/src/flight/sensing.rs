//! The sensors of one flight with their faults: from the true state to what arrives at the link.

use crate::faults::{Delivery, MOST_AGE_MS, ScanFault, Scans, Signal};
use crate::lidar::LidarConfig;
use crate::navigation::{GroundTruth, NavigationSensor};
use crate::random::Stream;
use crate::scenario::Scenario;
use crate::sensors::{AirDataSensors, Measurement};
use hil_protocol::{AirData, LidarScan, Position, SensorFrame};
use mpp_core::vehicle::{VehicleState, Wind};
use std::collections::VecDeque;

/// The sensors of one flight, and what is wrong with them and on the way from them.
#[derive(Clone, Debug)]
pub struct Sensing {
    sensors: AirDataSensors,
    airspeed: Signal,
    pitch: Signal,
    air: Delivery<AirData>,
    navigation: NavigationSensor,
    x: Signal,
    z: Signal,
    position: Delivery<Position>,
    lidar: LidarConfig,
    scan_fault: ScanFault,
    scans: Scans,
    /// The last states, the newest first, for a lidar whose stamps hide the age of its ranges.
    past: VecDeque<VehicleState>,
}

impl Sensing {
    /// The sensors of a scenario.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let (seed, faults) = (scenario.seed, &scenario.faults);
        let pitch = faults.pitch.in_units_of(1_f64.to_radians());
        Self {
            sensors: AirDataSensors::new(seed, scenario.air_data),
            airspeed: Signal::new(seed, Stream::AirspeedFault, faults.airspeed),
            pitch: Signal::new(seed, Stream::PitchFault, pitch),
            air: Delivery::new(faults.air),
            navigation: NavigationSensor::new(seed, scenario.navigation),
            x: Signal::new(seed, Stream::XFault, faults.x),
            z: Signal::new(seed, Stream::ZFault, faults.z),
            position: Delivery::new(faults.position),
            lidar: scenario.lidar,
            scan_fault: faults.scan,
            scans: Scans::new(faults.scan, scenario.lidar.range_max),
            past: VecDeque::new(),
        }
    }

    /// Measures a tick. Returns what the air data sensors say, and the measurements that arrive at this tick.
    pub fn measure(
        &mut self,
        tick: u32,
        state: &VehicleState,
        wind: Wind,
    ) -> (Measurement, SensorFrame) {
        self.past.push_front(*state);
        self.past.truncate(MOST_AGE_MS as usize / 10 + 1);
        let sound = self.sensors.measure(state);
        let measured = Measurement {
            airspeed: self.airspeed.pass(tick, sound.airspeed),
            pitch: self.pitch.pass(tick, sound.pitch),
        };
        let air = AirData {
            tick,
            airspeed: measured.airspeed,
            pitch: measured.pitch,
        };
        let truth = GroundTruth {
            position: (state.x, state.z),
            velocity: wind.ground_velocity(&state.air),
        };
        let position = self.navigation.measure(tick, &truth).map(|sound| Position {
            x: self.x.pass(sound.tick, sound.x),
            z: self.z.pass(sound.tick, sound.z),
            ..sound
        });
        let frame = SensorFrame {
            tick,
            air: self.air.pass(tick, Some(air)),
            position: self.position.pass(tick, position),
        };
        (measured, frame)
    }

    /// The state of the lidar at a tick, which may be turned or belong to a tick before.
    #[must_use]
    pub fn lidar_state(&self, tick: u32, state: &VehicleState) -> VehicleState {
        let age = self.scan_fault.age(tick) as usize;
        let mut turned = *self.past.get(age).or(self.past.back()).unwrap_or(state);
        let rotation = self.scan_fault.rotation(tick);
        if rotation != 0.0 {
            turned.air.pitch += rotation;
        }
        turned
    }

    /// What the lidar shows at a tick, made from its ranges \[m\]; `None` if it shows nothing.
    pub fn show(&mut self, tick: u32, ranges: &[f32]) -> Option<LidarScan> {
        self.scans.show(self.lidar.wire_scan(tick, ranges))
    }

    /// Takes the scan of a tick, if there is one, and gives the one that arrives at this tick.
    pub fn scan(&mut self, tick: u32, shown: Option<LidarScan>) -> Option<LidarScan> {
        self.scans.pass(tick, shown)
    }
}
