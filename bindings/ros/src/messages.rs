//! The standard messages that the node takes and gives, field by field as their `.msg` files say.

use serde::{Deserialize, Serialize};

/// Makes structs that travel.
macro_rules! messages {
    ($($(#[$doc:meta])* $name:ident { $($field:ident: $kind:ty),* $(,)? })*) => {
        $(
            $(#[$doc])*
            #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
            pub(crate) struct $name {
                $(pub(crate) $field: $kind),*
            }
        )*
    };
}

messages! {
    /// `builtin_interfaces/Time` and `Duration`.
    Time { sec: i32, nanosec: u32 }
    /// `std_msgs/Header`.
    Header { stamp: Time, frame_id: String }
    /// `std_msgs/ColorRGBA`.
    Color { r: f32, g: f32, b: f32, a: f32 }
    /// `geometry_msgs/Vector3` and `Point`.
    Vector { x: f64, y: f64, z: f64 }
    /// `geometry_msgs/Quaternion`.
    Quaternion { x: f64, y: f64, z: f64, w: f64 }
    /// `geometry_msgs/Pose`.
    Pose { position: Vector, orientation: Quaternion }
    /// `geometry_msgs/PoseStamped`.
    PoseStamped { header: Header, pose: Pose }
    /// `geometry_msgs/Twist`.
    Twist { linear: Vector, angular: Vector }
    /// `geometry_msgs/TwistStamped`.
    TwistStamped { header: Header, twist: Twist }
    /// `geometry_msgs/Transform`.
    Transform { translation: Vector, rotation: Quaternion }
    /// `geometry_msgs/PoseWithCovariance`.
    PoseWithCovariance { pose: Pose, covariance: [[f64; 6]; 6] }
    /// `geometry_msgs/TwistWithCovariance`.
    TwistWithCovariance { twist: Twist, covariance: [[f64; 6]; 6] }
    /// `nav_msgs/Odometry`.
    Odometry {
        header: Header,
        child_frame_id: String,
        pose: PoseWithCovariance,
        twist: TwistWithCovariance,
    }
    /// `nav_msgs/Path`.
    Path { header: Header, poses: Vec<PoseStamped> }
    /// `nav_msgs/MapMetaData`.
    MapMetaData {
        map_load_time: Time,
        resolution: f32,
        width: u32,
        height: u32,
        origin: Pose,
    }
    /// `nav_msgs/OccupancyGrid`.
    OccupancyGrid { header: Header, info: MapMetaData, data: Vec<i8> }
    /// `sensor_msgs/LaserScan`.
    LaserScan {
        header: Header,
        angle_min: f32,
        angle_max: f32,
        angle_increment: f32,
        time_increment: f32,
        scan_time: f32,
        range_min: f32,
        range_max: f32,
        ranges: Vec<f32>,
        intensities: Vec<f32>,
    }
    /// `sensor_msgs/PointField`.
    PointField { name: String, offset: u32, datatype: u8, count: u32 }
    /// `sensor_msgs/PointCloud2`.
    PointCloud {
        header: Header,
        height: u32,
        width: u32,
        fields: Vec<PointField>,
        is_bigendian: bool,
        point_step: u32,
        row_step: u32,
        data: Vec<u8>,
        is_dense: bool,
    }
    /// `sensor_msgs/JointState`.
    JointState {
        header: Header,
        name: Vec<String>,
        position: Vec<f64>,
        velocity: Vec<f64>,
        effort: Vec<f64>,
    }
    /// `trajectory_msgs/MultiDOFJointTrajectoryPoint`.
    TrajectoryPoint {
        transforms: Vec<Transform>,
        velocities: Vec<Twist>,
        accelerations: Vec<Twist>,
        time_from_start: Time,
    }
    /// `trajectory_msgs/MultiDOFJointTrajectory`.
    MultiDofTrajectory {
        header: Header,
        joint_names: Vec<String>,
        points: Vec<TrajectoryPoint>,
    }
    /// `sensor_msgs/CompressedImage`, of a marker.
    CompressedImage { header: Header, format: String, data: Vec<u8> }
    /// `visualization_msgs/UVCoordinate`.
    UvCoordinate { u: f32, v: f32 }
    /// `visualization_msgs/MeshFile`.
    MeshFile { filename: String, data: Vec<u8> }
    /// `visualization_msgs/Marker`.
    Marker {
        header: Header,
        ns: String,
        id: i32,
        kind: i32,
        action: i32,
        pose: Pose,
        scale: Vector,
        color: Color,
        lifetime: Time,
        frame_locked: bool,
        points: Vec<Vector>,
        colors: Vec<Color>,
        texture_resource: String,
        texture: CompressedImage,
        uv_coordinates: Vec<UvCoordinate>,
        text: String,
        mesh_resource: String,
        mesh_file: MeshFile,
        mesh_use_embedded_materials: bool,
    }
    /// `visualization_msgs/MarkerArray`.
    MarkerArray { markers: Vec<Marker> }
    /// `diagnostic_msgs/KeyValue`.
    KeyValue { key: String, value: String }
    /// `diagnostic_msgs/DiagnosticStatus`.
    DiagnosticStatus {
        level: u8,
        name: String,
        message: String,
        hardware_id: String,
        values: Vec<KeyValue>,
    }
    /// `diagnostic_msgs/DiagnosticArray`.
    DiagnosticArray { header: Header, status: Vec<DiagnosticStatus> }
}

/// Nanoseconds in a second.
const NANOS: i64 = 1_000_000_000;

impl Time {
    /// Of nanoseconds; those that do not fit are cut.
    pub(crate) fn of(nanos: i64) -> Self {
        let sec = nanos.div_euclid(NANOS);
        Self {
            sec: i32::try_from(sec).unwrap_or(if sec < 0 { i32::MIN } else { i32::MAX }),
            nanosec: nanos.rem_euclid(NANOS) as u32,
        }
    }

    /// In nanoseconds.
    pub(crate) fn nanos(&self) -> i64 {
        i64::from(self.sec) * NANOS + i64::from(self.nanosec)
    }
}

impl Header {
    /// Of a time \[ns\] and a frame.
    pub(crate) fn of(nanos: i64, frame: &str) -> Self {
        Self {
            stamp: Time::of(nanos),
            frame_id: frame.to_owned(),
        }
    }
}
