//! The node on the network: its topics, their types and their quality of service.

use crate::args::Args;
use crate::messages::{
    DiagnosticArray, JointState, LaserScan, MarkerArray, MultiDofTrajectory, OccupancyGrid,
    Odometry, Path, PointCloud, PoseStamped, TwistStamped,
};
use crate::pilot::{Output, Pilot};
use ros2_client::qos::{History, Reliability, WhenFull};
use ros2_client::{MessageTypeName, Name, Node, Publisher, QosProfile, Subscription};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::error::Error;

/// The topics. Their names are those before remapping.
pub(crate) struct Topics {
    /// The one that drives the node.
    pub(crate) odometry: Subscription<Odometry>,
    scan: Subscription<LaserScan>,
    cloud: Subscription<PointCloud>,
    airspeed: Subscription<TwistStamped>,
    goal: Subscription<PoseStamped>,
    setpoint: Publisher<JointState>,
    plan: Publisher<Path>,
    trajectory: Publisher<MultiDofTrajectory>,
    candidates: Publisher<MarkerArray>,
    map: Publisher<OccupancyGrid>,
    diagnostics: Publisher<DiagnosticArray>,
}

/// Makes topics with their whole names.
struct Maker<'a> {
    node: &'a mut Node,
    args: &'a Args,
}

/// Sensor data: it goes with best-effort and with reliable publishers.
const SENSOR: QosProfile = QosProfile {
    history: History::KeepLast { depth: 10 },
    ..QosProfile::subscription_default()
};

/// Reliable, but a peer that does not keep up never holds the loop.
const RELIABLE: QosProfile = QosProfile {
    reliability: Reliability::Reliable {
        when_full: WhenFull::Fail,
    },
    ..SENSOR
};

impl Maker<'_> {
    fn take<M: 'static>(
        &mut self,
        name: &str,
        (package, kind): (&str, &str),
        qos: &QosProfile,
    ) -> Result<Subscription<M>, Box<dyn Error>> {
        let name = Name::parse(&self.args.topic(name))?;
        let kind = MessageTypeName::new(package, kind);
        let topic = self.node.create_topic(&name, kind, qos)?;
        Ok(self.node.create_subscription(&topic, None)?)
    }

    fn give<M: Serialize>(
        &mut self,
        name: &str,
        (package, kind): (&str, &str),
    ) -> Result<Publisher<M>, Box<dyn Error>> {
        let name = Name::parse(&self.args.topic(name))?;
        let kind = MessageTypeName::new(package, kind);
        let topic = self.node.create_topic(&name, kind, &RELIABLE)?;
        Ok(self.node.create_publisher(&topic, None)?)
    }
}

impl Topics {
    /// The topics of a node.
    ///
    /// # Errors
    /// What the middleware says.
    pub(crate) fn of(node: &mut Node, args: &Args) -> Result<Self, Box<dyn Error>> {
        let mut make = Maker { node, args };
        Ok(Self {
            odometry: make.take("odometry", ("nav_msgs", "Odometry"), &SENSOR)?,
            scan: make.take("scan", ("sensor_msgs", "LaserScan"), &SENSOR)?,
            cloud: make.take("cloud", ("sensor_msgs", "PointCloud2"), &SENSOR)?,
            airspeed: make.take("airspeed", ("geometry_msgs", "TwistStamped"), &SENSOR)?,
            goal: make.take("goal", ("geometry_msgs", "PoseStamped"), &RELIABLE)?,
            setpoint: make.give("setpoint", ("sensor_msgs", "JointState"))?,
            plan: make.give("plan", ("nav_msgs", "Path"))?,
            trajectory: make.give("trajectory", ("trajectory_msgs", "MultiDOFJointTrajectory"))?,
            candidates: make.give("candidates", ("visualization_msgs", "MarkerArray"))?,
            map: make.give("map", ("nav_msgs", "OccupancyGrid"))?,
            diagnostics: make.give("diagnostics", ("diagnostic_msgs", "DiagnosticArray"))?,
        })
    }

    /// Gives the pilot everything that came beside odometry.
    pub(crate) fn hear(&self, pilot: &mut Pilot) {
        drain(&self.goal, "goal", pilot, Pilot::hear_goal);
        drain(&self.airspeed, "airspeed", pilot, Pilot::hear_airspeed);
        drain(&self.cloud, "cloud", pilot, Pilot::hear_cloud);
        drain(&self.scan, "scan", pilot, Pilot::hear_scan);
    }

    /// Sends a message. One that does not go out is told.
    pub(crate) fn send(&self, output: Output, pilot: &mut Pilot) {
        let sent = match output {
            Output::Setpoint(it) => self.setpoint.publish(it).is_ok(),
            Output::Plan(it) => self.plan.publish(it).is_ok(),
            Output::Trajectory(it) => self.trajectory.publish(it).is_ok(),
            Output::Candidates(it) => self.candidates.publish(it).is_ok(),
            Output::Map(it) => self.map.publish(it).is_ok(),
            Output::Diagnostics(it) => self.diagnostics.publish(it).is_ok(),
        };
        if !sent {
            let text = "a message did not go out: a subscription does not keep up".to_owned();
            pilot.told.tell("output", text);
        }
    }
}

fn drain<M: DeserializeOwned + 'static>(
    from: &Subscription<M>,
    name: &str,
    pilot: &mut Pilot,
    hear: fn(&mut Pilot, &M),
) {
    // More than a reader keeps does not wait.
    for _ in 0..100 {
        match from.take() {
            Ok(Some((message, _))) => hear(pilot, &message),
            Ok(None) => return,
            Err(error) => pilot
                .told
                .tell(name, format!("the message is damaged: {error}")),
        }
    }
}
