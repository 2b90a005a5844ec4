//! The messages that the vehicle and its ground stations exchange: a part of the common dialect of MAVLink, and
//! our own, whose ids begin with 54,100. For other tools the file `dialect/mpp.xml` has our own.
//!
//! Ids, names, types and order are the protocol's: fields stand in the order of their bytes, the largest
//! types first; extensions stand behind them as the protocol appends them. Where a field has another name in
//! Rust, its own stands in quotation marks.
//!
//! No field is bound to an enum, because a reader would then refuse a whole message for one value that its
//! enum does not list, and a command that nobody knows would stay without an answer.

use super::data::{CharArray, Field, MessageData, Signature, extra_crc, length};

/// Version of the common dialect, which each heartbeat tells.
pub const MINOR_MAVLINK_VERSION: u8 = 3;

/// Defines the messages: `id NAME NAME_DATA { fields }`, and ` + { extensions }` where the message has some.
macro_rules! messages {
    ($(
        $(#[$about:meta])*
        $id:literal $name:ident $data:ident {
            $($(#[$doc:meta])* $field:ident $($own:literal)?: $type:ty $(= $value:ident)?,)*
        } $(+ { $($more:ident: $more_type:ty,)* })?
    )*) => {
        $(
            $(#[$about])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $data {
                $($(#[$doc])* pub $field: $type,)*
                $($(pub $more: $more_type,)*)?
            }

            impl $data {
                /// The message with zeros in its fields.
                pub const DEFAULT: Self = Self {
                    $($field: value!($($value)?),)*
                    $($($more: Field::ZERO,)*)?
                };
            }

            impl Default for $data {
                fn default() -> Self {
                    Self::DEFAULT
                }
            }

            impl MessageData for $data {
                const ID: u32 = $id;
                const NAME: &'static str = stringify!($name);
                const EXTRA_CRC: u8 = extra_crc(
                    Self::NAME,
                    &[$(Signature::of::<$type>(name!($field $($own)?)),)*],
                );
                const ENCODED_LEN: usize = 0
                    $(+ <$type as Field>::SIZE)*
                    $($(+ <$more_type as Field>::SIZE)*)?;

                fn ser(&self, payload: &mut [u8; 255]) -> usize {
                    let mut rest = &mut payload[..];
                    $(self.$field.write(&mut rest);)*
                    $($(self.$more.write(&mut rest);)*)?
                    payload.get(..Self::ENCODED_LEN).map_or(0, length)
                }

                fn deser(mut payload: &[u8]) -> Self {
                    Self {
                        $($field: Field::read(&mut payload),)*
                        $($($more: Field::read(&mut payload),)*)?
                    }
                }
            }
        )*

        /// Any message.
        #[derive(Clone, Debug, PartialEq)]
        #[allow(clippy::large_enum_variant)]
        pub enum MavMessage {
            $($(#[$about])* $name($data),)*
        }

        impl MavMessage {
            /// The ids of all messages.
            pub const IDS: &[u32] = &[$($id),*];

            /// The message of a payload; `None` if the dialect does not have this id.
            #[must_use]
            pub fn parse(id: u32, payload: &[u8]) -> Option<Self> {
                Some(match id {
                    $($id => Self::$name($data::deser(payload)),)*
                    _ => return None,
                })
            }

            /// The [`MessageData::EXTRA_CRC`] of a message; `None` if the dialect does not have this id.
            #[must_use]
            pub const fn extra_crc(id: u32) -> Option<u8> {
                Some(match id {
                    $($id => $data::EXTRA_CRC,)*
                    _ => return None,
                })
            }
        }
    };
}

/// Name of a field in the dialect.
macro_rules! name {
    ($field:ident) => {
        stringify!($field)
    };
    ($field:ident $own:literal) => {
        $own
    };
}

/// A field's value in `DEFAULT`.
macro_rules! value {
    () => {
        Field::ZERO
    };
    ($value:ident) => {
        $value
    };
}

messages! {
    0 HEARTBEAT HEARTBEAT_DATA {
        custom_mode: u32, mavtype "type": u8, autopilot: u8, base_mode: u8, system_status: u8,
        mavlink_version: u8 = MINOR_MAVLINK_VERSION,
    }
    1 SYS_STATUS SYS_STATUS_DATA {
        onboard_control_sensors_present: u32, onboard_control_sensors_enabled: u32,
        onboard_control_sensors_health: u32, load: u16, voltage_battery: u16, current_battery: i16,
        drop_rate_comm: u16, errors_comm: u16, errors_count1: u16, errors_count2: u16,
        errors_count3: u16, errors_count4: u16, battery_remaining: i8,
    } + {
        onboard_control_sensors_present_extended: u32,
        onboard_control_sensors_enabled_extended: u32, onboard_control_sensors_health_extended: u32,
    }
    2 SYSTEM_TIME SYSTEM_TIME_DATA {
        time_unix_usec: u64, time_boot_ms: u32,
    }
    4 PING PING_DATA {
        time_usec: u64, seq: u32, target_system: u8, target_component: u8,
    }
    11 SET_MODE SET_MODE_DATA {
        custom_mode: u32, target_system: u8, base_mode: u8,
    }
    20 PARAM_REQUEST_READ PARAM_REQUEST_READ_DATA {
        param_index: i16, target_system: u8, target_component: u8, param_id: CharArray<16>,
    }
    21 PARAM_REQUEST_LIST PARAM_REQUEST_LIST_DATA {
        target_system: u8, target_component: u8,
    }
    22 PARAM_VALUE PARAM_VALUE_DATA {
        param_value: f32, param_count: u16, param_index: u16, param_id: CharArray<16>,
        param_type: u8,
    }
    23 PARAM_SET PARAM_SET_DATA {
        param_value: f32, target_system: u8, target_component: u8, param_id: CharArray<16>,
        param_type: u8,
    }
    24 GPS_RAW_INT GPS_RAW_INT_DATA {
        time_usec: u64, lat: i32, lon: i32, alt: i32, eph: u16, epv: u16, vel: u16, cog: u16,
        fix_type: u8, satellites_visible: u8,
    } + {
        alt_ellipsoid: i32, h_acc: u32, v_acc: u32, vel_acc: u32, hdg_acc: u32, yaw: u16,
    }
    30 ATTITUDE ATTITUDE_DATA {
        time_boot_ms: u32, roll: f32, pitch: f32, yaw: f32, rollspeed: f32, pitchspeed: f32,
        yawspeed: f32,
    }
    32 LOCAL_POSITION_NED LOCAL_POSITION_NED_DATA {
        time_boot_ms: u32, x: f32, y: f32, z: f32, vx: f32, vy: f32, vz: f32,
    }
    33 GLOBAL_POSITION_INT GLOBAL_POSITION_INT_DATA {
        time_boot_ms: u32, lat: i32, lon: i32, alt: i32, relative_alt: i32, vx: i16, vy: i16,
        vz: i16, hdg: u16,
    }
    38 MISSION_WRITE_PARTIAL_LIST MISSION_WRITE_PARTIAL_LIST_DATA {
        start_index: i16, end_index: i16, target_system: u8, target_component: u8,
    } + {
        mission_type: u8,
    }
    40 MISSION_REQUEST MISSION_REQUEST_DATA {
        seq: u16, target_system: u8, target_component: u8,
    } + {
        mission_type: u8,
    }
    41 MISSION_SET_CURRENT MISSION_SET_CURRENT_DATA {
        seq: u16, target_system: u8, target_component: u8,
    }
    43 MISSION_REQUEST_LIST MISSION_REQUEST_LIST_DATA {
        target_system: u8, target_component: u8,
    } + {
        mission_type: u8,
    }
    44 MISSION_COUNT MISSION_COUNT_DATA {
        count: u16, target_system: u8, target_component: u8,
    } + {
        mission_type: u8, opaque_id: u32,
    }
    45 MISSION_CLEAR_ALL MISSION_CLEAR_ALL_DATA {
        target_system: u8, target_component: u8,
    } + {
        mission_type: u8,
    }
    47 MISSION_ACK MISSION_ACK_DATA {
        target_system: u8, target_component: u8, mavtype "type": u8,
    } + {
        mission_type: u8, opaque_id: u32,
    }
    49 GPS_GLOBAL_ORIGIN GPS_GLOBAL_ORIGIN_DATA {
        latitude: i32, longitude: i32, altitude: i32,
    } + {
        time_usec: u64,
    }
    51 MISSION_REQUEST_INT MISSION_REQUEST_INT_DATA {
        seq: u16, target_system: u8, target_component: u8,
    } + {
        mission_type: u8,
    }
    66 REQUEST_DATA_STREAM REQUEST_DATA_STREAM_DATA {
        req_message_rate: u16, target_system: u8, target_component: u8, req_stream_id: u8,
        start_stop: u8,
    }
    74 VFR_HUD VFR_HUD_DATA {
        airspeed: f32, groundspeed: f32, alt: f32, climb: f32, heading: i16, throttle: u16,
    }
    75 COMMAND_INT COMMAND_INT_DATA {
        param1: f32, param2: f32, param3: f32, param4: f32, x: i32, y: i32, z: f32, command: u16,
        target_system: u8, target_component: u8, frame: u8, current: u8, autocontinue: u8,
    }
    76 COMMAND_LONG COMMAND_LONG_DATA {
        param1: f32, param2: f32, param3: f32, param4: f32, param5: f32, param6: f32, param7: f32,
        command: u16, target_system: u8, target_component: u8, confirmation: u8,
    }
    77 COMMAND_ACK COMMAND_ACK_DATA {
        command: u16, result: u8,
    } + {
        progress: u8, result_param2: i32, target_system: u8, target_component: u8,
    }
    105 HIGHRES_IMU HIGHRES_IMU_DATA {
        time_usec: u64, xacc: f32, yacc: f32, zacc: f32, xgyro: f32, ygyro: f32, zgyro: f32,
        xmag: f32, ymag: f32, zmag: f32, abs_pressure: f32, diff_pressure: f32, pressure_alt: f32,
        temperature: f32, fields_updated: u16,
    } + {
        id: u8,
    }
    110 FILE_TRANSFER_PROTOCOL FILE_TRANSFER_PROTOCOL_DATA {
        target_network: u8, target_system: u8, target_component: u8, payload: [u8; 251],
    }
    111 TIMESYNC TIMESYNC_DATA {
        tc1: i64, ts1: i64,
    } + {
        target_system: u8, target_component: u8,
    }
    117 LOG_REQUEST_LIST LOG_REQUEST_LIST_DATA {
        start: u16, end: u16, target_system: u8, target_component: u8,
    }
    118 LOG_ENTRY LOG_ENTRY_DATA {
        time_utc: u32, size: u32, id: u16, num_logs: u16, last_log_num: u16,
    }
    132 DISTANCE_SENSOR DISTANCE_SENSOR_DATA {
        time_boot_ms: u32, min_distance: u16, max_distance: u16, current_distance: u16,
        mavtype "type": u8, id: u8, orientation: u8, covariance: u8,
    } + {
        horizontal_fov: f32, vertical_fov: f32, quaternion: [f32; 4], signal_quality: u8,
    }
    141 ALTITUDE ALTITUDE_DATA {
        time_usec: u64, altitude_monotonic: f32, altitude_amsl: f32, altitude_local: f32,
        altitude_relative: f32, altitude_terrain: f32, bottom_clearance: f32,
    }
    148 AUTOPILOT_VERSION AUTOPILOT_VERSION_DATA {
        capabilities: u64, uid: u64, flight_sw_version: u32, middleware_sw_version: u32,
        os_sw_version: u32, board_version: u32, vendor_id: u16, product_id: u16,
        flight_custom_version: [u8; 8], middleware_custom_version: [u8; 8],
        os_custom_version: [u8; 8],
    } + {
        uid2: [u8; 18],
    }
    231 WIND_COV WIND_COV_DATA {
        time_usec: u64, wind_x: f32, wind_y: f32, wind_z: f32, var_horiz: f32, var_vert: f32,
        wind_alt: f32, horiz_accuracy: f32, vert_accuracy: f32,
    }
    242 HOME_POSITION HOME_POSITION_DATA {
        latitude: i32, longitude: i32, altitude: i32, x: f32, y: f32, z: f32, q: [f32; 4],
        approach_x: f32, approach_y: f32, approach_z: f32,
    } + {
        time_usec: u64,
    }
    244 MESSAGE_INTERVAL MESSAGE_INTERVAL_DATA {
        interval_us: i32, message_id: u16,
    }
    245 EXTENDED_SYS_STATE EXTENDED_SYS_STATE_DATA {
        vtol_state: u8, landed_state: u8,
    }
    253 STATUSTEXT STATUSTEXT_DATA {
        severity: u8, text: CharArray<50>,
    } + {
        id: u16, chunk_seq: u8,
    }
    300 PROTOCOL_VERSION PROTOCOL_VERSION_DATA {
        version: u16, min_version: u16, max_version: u16, spec_version_hash: [u8; 8],
        library_version_hash: [u8; 8],
    }
    331 ODOMETRY ODOMETRY_DATA {
        time_usec: u64, x: f32, y: f32, z: f32, q: [f32; 4], vx: f32, vy: f32, vz: f32,
        rollspeed: f32, pitchspeed: f32, yawspeed: f32, pose_covariance: [f32; 21],
        velocity_covariance: [f32; 21], frame_id: u8, child_frame_id: u8,
    } + {
        reset_counter: u8, estimator_type: u8, quality: i8,
    }
    345 PARAM_ERROR PARAM_ERROR_DATA {
        param_index: i16, target_system: u8, target_component: u8, param_id: CharArray<16>,
        error: u8,
    }
    397 COMPONENT_METADATA COMPONENT_METADATA_DATA {
        time_boot_ms: u32, file_crc: u32, uri: CharArray<100>,
    }
    435 AVAILABLE_MODES AVAILABLE_MODES_DATA {
        custom_mode: u32, properties: u32, number_modes: u8, mode_index: u8, standard_mode: u8,
        mode_name: CharArray<35>,
    }
    436 CURRENT_MODE CURRENT_MODE_DATA {
        custom_mode: u32, intended_custom_mode: u32, standard_mode: u8,
    }
    /// One sweep of the lidar in the vertical plane.
    54100 MPP_LIDAR_SCAN MPP_LIDAR_SCAN_DATA {
        /// Time since the vehicle's start. \[ms\]
        time_boot_ms: u32,
        /// Tick of the flight, 100 Hz, as in its log.
        tick: u32,
        /// First beam against the body axis, nose-up positive. \[rad\]
        angle_min: f32,
        /// From a beam to the next, nose-up positive. \[rad\]
        angle_increment: f32,
        /// The lidar's reach. \[cm\]
        range_max: u16,
        /// Range of each beam; UINT16_MAX: nothing came back. \[cm\]
        ranges: [u16; 100],
        /// Beams in use.
        count: u8,
    }
    /// How a planning cycle ended.
    54101 MPP_PLAN_STATUS MPP_PLAN_STATUS_DATA {
        /// Time since the vehicle's start. \[ms\]
        time_boot_ms: u32,
        /// Tick of the scan that was planned from.
        scan_tick: u32,
        /// First tick that flies the outcome.
        used_from_tick: u32,
        /// Slices of planning work that were used.
        slices: u32,
        /// Cost of the trajectory to be flown; infinite without one.
        cost: f32,
        /// How far it leaves its corridor at the worst stage. \[m\]
        violation: f32,
        /// Candidate paths that were refined.
        candidates: u16,
        /// Candidates of these that keep every constraint.
        feasible: u16,
        /// Trees that were grown.
        tree_runs: u16,
        /// What will be flown, an MPP_PLAN_OUTCOME.
        outcome: u8,
        /// 1: all work was done before the deadline.
        complete: u8,
    }
    /// The trajectory that a planning cycle chose. World frame: x downrange, z up.
    54102 MPP_TRAJECTORY MPP_TRAJECTORY_DATA {
        /// Time since the vehicle's start. \[ms\]
        time_boot_ms: u32,
        /// Tick of the scan that it was planned from. A plan of preset flight starts when it is taken over, others at the scan.
        scan_tick: u32,
        /// From a knot to the next. \[s\]
        dt: f32,
        /// Downrange. \[m\]
        x: [f32; 19],
        /// Height, up positive. \[m\]
        z: [f32; 19],
        /// Flight path angle, nose-up positive. \[rad\]
        gamma: [f32; 19],
        /// Knots in use.
        count: u8,
    }
}
