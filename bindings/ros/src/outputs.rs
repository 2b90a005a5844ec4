//! What the core plans and sees, as messages that RViz and Foxglove show.

use crate::flight::Flight;
use crate::frames::Track;
use crate::messages::{
    Color, Header, JointState, MapMetaData, Marker, MarkerArray, MultiDofTrajectory, OccupancyGrid,
    Path, Pose, PoseStamped, Quaternion, Time, TrajectoryPoint, Transform, Twist, Vector,
};
use hil_protocol::{ActuatorCommand, Configure, PlanTrajectory, StepReport};
use mpp_core::map::RollingGrid;
use mpp_core::trajectory::Trajectory;
use mpp_core::tuning::grid::CELL;

/// The command to the aircraft. `elevator`: its position, in the unit of the aircraft file. `thrust`: its effort \[N\], and
/// the share of the greatest thrust as its position, if the aircraft file has one. `pitch`, nose up positive \[rad\], only
/// if the aircraft file has a `pitch_loop`: then the elevator is an angle of attack.
pub(crate) fn setpoint(
    header: Header,
    configure: &Configure,
    (command, step): &(ActuatorCommand, StepReport),
) -> JointState {
    let share = |most: f64| command.thrust / most;
    let throttle = configure.actuators.thrust_max.map_or(0.0, share);
    let mut joints = vec![
        ("elevator", command.elevator, 0.0),
        ("thrust", throttle, command.thrust),
    ];
    if configure.aircraft.airframe.commands_angle_of_attack() {
        let [.., path] = step.estimate;
        let [.., rate, _] = step.reference;
        // The command acts later, and the path turns on until then.
        let lead = configure.actuators.elevator_delay.unwrap_or(0.0);
        joints.push(("pitch", command.elevator + path + lead * rate, 0.0));
    }
    JointState {
        header,
        name: joints.iter().map(|(name, ..)| (*name).to_owned()).collect(),
        position: joints.iter().map(|(_, position, _)| *position).collect(),
        velocity: Vec::new(),
        effort: joints.iter().map(|(.., effort)| *effort).collect(),
    }
}

/// A plan as a path and as a trajectory.
pub(crate) fn plan(
    header: &Header,
    track: &Track,
    plan: &PlanTrajectory,
) -> (Path, MultiDofTrajectory) {
    let knots = || plan.knots.iter().map(|knot| knot.map(f64::from));
    let pose = |[x, z, angle]: [f64; 3]| track.pose(x, z, angle);
    let poses = (0..).zip(knots()).map(|(knot, at)| PoseStamped {
        header: Header {
            stamp: Time::of(header.stamp.nanos() + nanos(plan, knot)),
            frame_id: header.frame_id.clone(),
        },
        pose: pose(at),
    });
    let path = Path {
        header: header.clone(),
        poses: poses.collect(),
    };
    let trajectory = MultiDofTrajectory {
        header: header.clone(),
        joint_names: vec!["base_link".to_owned()],
        points: (0..)
            .zip(knots())
            .map(|(knot, at)| TrajectoryPoint {
                transforms: vec![transform(pose(at))],
                velocities: vec![Twist {
                    linear: velocity(track, plan, knot as usize),
                    angular: Vector::default(),
                }],
                accelerations: Vec::new(),
                time_from_start: Time::of(nanos(plan, knot)),
            })
            .collect(),
    };
    (path, trajectory)
}

/// Time from the start of a plan to a knot \[ns\].
fn nanos(plan: &PlanTrajectory, knot: i64) -> i64 {
    knot * (f64::from(plan.period) * 1e9).round() as i64
}

fn transform(pose: Pose) -> Transform {
    Transform {
        translation: pose.position,
        rotation: pose.orientation,
    }
}

/// The mean velocity over ground from a knot to the next; at the last one, to it.
fn velocity(track: &Track, plan: &PlanTrajectory, knot: usize) -> Vector {
    let from = knot.min(plan.knots.len().saturating_sub(2));
    match plan.knots.get(from..from + 2) {
        Some([a, b]) => {
            let speed = |axis: usize| f64::from(b[axis] - a[axis]) / f64::from(plan.period);
            track.velocity(speed(0), speed(1))
        }
        _ => Vector::default(),
    }
}

/// The candidates of the last cycle as lines, the cheaper the greener.
pub(crate) fn candidates(header: &Header, track: &Track, flight: &Flight) -> MarkerArray {
    // The first one deletes those of the cycle before.
    let mut markers = vec![Marker {
        header: header.clone(),
        action: 3,
        ..Marker::default()
    }];
    let (mut offered, mut prices) = (Trajectory::new(), Vec::new());
    if let Some(planner) = flight.planner() {
        while let Some(price) = planner.offer(prices.len(), &mut offered) {
            let points = offered.knots.iter().map(|knot| {
                let at = &knot.state;
                track.point(at.x, at.z)
            });
            markers.push(line(header, prices.len(), points.collect()));
            prices.push(price);
        }
    }
    let least = prices.iter().copied().fold(f64::INFINITY, f64::min);
    for (marker, price) in markers.iter_mut().skip(1).zip(prices) {
        let share = if price.is_finite() {
            least / price
        } else {
            0.0
        };
        marker.color = Color {
            r: 1.0 - share as f32,
            g: share as f32,
            b: 0.2,
            a: 0.8,
        };
    }
    MarkerArray { markers }
}

fn line(header: &Header, index: usize, points: Vec<Vector>) -> Marker {
    Marker {
        header: header.clone(),
        ns: "candidates".to_owned(),
        id: index as i32,
        // LINE_STRIP
        kind: 4,
        pose: Pose {
            orientation: Quaternion {
                w: 1.0,
                ..Quaternion::default()
            },
            ..Pose::default()
        },
        scale: Vector {
            x: 0.1,
            ..Vector::default()
        },
        points,
        ..Marker::default()
    }
}

/// The map with memory, upright in the plane of the track: 100 occupied, 0 free, -1 unknown.
pub(crate) fn map(header: &Header, track: &Track, flight: &Flight) -> Option<OccupancyGrid> {
    let planner = flight.planner()?;
    let (map, length) = (planner.map(), planner.units().length);
    let [rows, columns] = RollingGrid::SHAPE;
    let row = |row| {
        let (occupied, unknown) = map.row(row);
        (0..columns).map(
            move |column| match (occupied >> column & 1, unknown >> column & 1) {
                (1, _) => 100,
                (_, 1) => -1,
                _ => 0,
            },
        )
    };
    Some(OccupancyGrid {
        header: header.clone(),
        info: MapMetaData {
            map_load_time: header.stamp.clone(),
            resolution: (CELL * length) as f32,
            width: columns as u32,
            height: rows as u32,
            origin: track.upright(map.first_x() * length, map.floor() * length),
        },
        data: (0..rows).flat_map(row).collect(),
    })
}
