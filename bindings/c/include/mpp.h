#ifndef MPP_H
#define MPP_H

/* Made from bindings/c/core by its test; do not change it by hand. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Alignment that the storage needs [bytes].
#define MPP_ALIGNMENT 16

// Greatest number of beams of a scan.
#define MPP_BEAMS 128

// Places of a plan.
#define MPP_KNOTS 19

// Counters of events.
#define MPP_COUNTERS 19

// The result of a call. Every result but `Ok` leaves the core as it was; only a refused `mpp_set_up` leaves it
// without a configuration.
typedef enum mpp_status {
  // The call did what it says.
  MPP_STATUS_OK = 0,
  // A pointer is null.
  MPP_STATUS_NULL = 1,
  // The storage is too small.
  MPP_STATUS_STORAGE = 2,
  // The storage is not aligned.
  MPP_STATUS_ALIGNMENT = 3,
  // The core has no configuration.
  MPP_STATUS_NOT_SET_UP = 4,
  // A planning cycle is under way.
  MPP_STATUS_BUSY = 5,
  // No planning cycle is under way.
  MPP_STATUS_IDLE = 6,
  // A time is not finite, or goes back.
  MPP_STATUS_TIME = 7,
  // The number of beams is not that of the configuration.
  MPP_STATUS_SCAN_LENGTH = 8,
  // A range is not finite, negative or too long, or an angle is not finite.
  MPP_STATUS_SCAN_RANGE = 9,
  // The scan is older than the poses that the core remembers.
  MPP_STATUS_SCAN_AGE = 10,
  // The number of paths.
  MPP_STATUS_PATHS = 20,
  // The replanning period or the latency.
  MPP_STATUS_PERIOD = 21,
  // The number of beams.
  MPP_STATUS_BEAMS = 22,
  // The range of the lidar.
  MPP_STATUS_RANGE = 23,
  // The altitude.
  MPP_STATUS_ALTITUDE = 24,
  // A limit of an actuator.
  MPP_STATUS_ACTUATORS = 25,
  // The aircraft does not fly level.
  MPP_STATUS_TRIM = 26,
  // The greatest thrust does not carry level flight.
  MPP_STATUS_THRUST = 27,
  // No regulator holds the aircraft.
  MPP_STATUS_REGULATOR = 28,
  // A number is out of its range.
  MPP_STATUS_OUT_OF_RANGE = 29,
  // The planner cannot be set up.
  MPP_STATUS_PLANNER = 30,
} mpp_status;

// A core. Its content is private.
typedef struct mpp_core mpp_core;

// The aircraft, by its coefficients: `L = q S (C_L + C_La' alpha' + C_Lq theta')`,
// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`,
// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`. The elevator may be in any unit.
typedef struct mpp_aircraft {
  // Mass [kg].
  double mass;
  // Moment of inertia in pitch [kg m^2].
  double pitch_inertia;
  // Wing area [m^2].
  double wing_area;
  // Reference length of the pitching moment [m].
  double moment_length;
  // Air density [kg/m^3].
  double air_density;
  // `C_L0` [-].
  double lift_zero;
  // `C_La` [1/rad].
  double lift_alpha;
  // `C_La'` [s/rad].
  double lift_alpha_rate;
  // `C_Lq` [s/rad].
  double lift_pitch_rate;
  // `C_Le` [1 per unit of elevator].
  double lift_elevator;
  // `C_D0` [-].
  double drag_zero;
  // `K` [-].
  double drag_induced;
  // `C_M0` [-].
  double moment_zero;
  // `C_Ma` [1/rad].
  double moment_alpha;
  // `C_Ma'` [s/rad].
  double moment_alpha_rate;
  // `C_Mq` [s/rad].
  double moment_pitch_rate;
  // `C_Me` [1 per unit of elevator].
  double moment_elevator;
  // Airspeed of level flight [m/s].
  double cruise;
  // Radius of the circle that holds the aircraft [m].
  double body_radius;
  // Distance of the stall from the angle of attack of level flight [rad]; 0 if it is not known.
  double stall;
  // Greatest thrust [N]; 0 for no limit. The same holds for the four limits below.
  double thrust_max;
  // Time constant of the thrust [s].
  double thrust_lag;
  // Greatest distance of the elevator below its trim.
  double elevator_below;
  // Greatest distance of the elevator above its trim.
  double elevator_above;
  // Greatest rate of the elevator [1/s].
  double elevator_rate;
} mpp_aircraft;

// What a flight needs to know before it begins.
typedef struct mpp_config {
  // The aircraft.
  struct mpp_aircraft aircraft;
  // Candidate paths of a planning cycle, 1 to 100.
  uint16_t paths;
  // Beams of each scan, 1 to 128.
  uint16_t beams;
  // Ticks of 10 ms from a scan until its plan is flown, at least 1.
  uint32_t latency_ticks;
  // Seed of the planner's random numbers.
  uint64_t seed;
  // Longest range that the lidar reports [m].
  float range_max;
  // Height to which the aircraft returns [m].
  double altitude;
} mpp_config;

// The measurements that are new in a tick. Ages are in ticks of 10 ms.
typedef struct mpp_sensors {
  // Whether there is new airspeed and pitch.
  bool has_air;
  // Their age.
  uint32_t air_age;
  // Airspeed [m/s].
  double airspeed;
  // Pitch [rad].
  double pitch;
  // Whether there is a new position.
  bool has_position;
  // Its age.
  uint32_t position_age;
  // Downrange [m].
  double x;
  // Height [m].
  double z;
  // Standard deviation of the white part of its error [m].
  double sigma;
  // Whether the position has a velocity over ground.
  bool has_velocity;
  // Velocity downrange [m/s].
  double velocity_x;
  // Velocity upwards [m/s].
  double velocity_z;
  // Standard deviation of its error [m/s].
  double velocity_sigma;
} mpp_sensors;

// Position and motion.
typedef struct mpp_state {
  // Downrange [m].
  double x;
  // Height [m].
  double z;
  // Airspeed [m/s].
  double airspeed;
  // Pitch [rad].
  double pitch;
  // Pitch rate [rad/s].
  double pitch_rate;
  // Flight path angle [rad].
  double flight_path;
} mpp_state;

// What a step gives.
typedef struct mpp_output {
  // Thrust along the body axis [N].
  double thrust;
  // Elevator, in the unit of the aircraft's coefficients.
  double elevator;
  // Whether a plan is tracked; otherwise the core holds level flight.
  bool tracking;
  // Trust in airspeed: 0 good, 1 suspected, 2 not used, 3 recovering.
  uint8_t airspeed_trust;
  // Trust in pitch.
  uint8_t pitch_trust;
  // Trust in positions.
  uint8_t position_trust;
  // Trust in the elevator: 1 while the core makes up for its weakness, 2 while it does not answer.
  uint8_t elevator_trust;
  // Trust in the motor: 2 while it gives no thrust.
  uint8_t motor_trust;
  // The estimate.
  struct mpp_state estimate;
  // Estimated wind downrange [m/s].
  double wind_x;
  // Estimated wind upwards [m/s].
  double wind_z;
  // Estimated excess of the lift coefficient [-].
  double lift;
  // What was to be flown.
  struct mpp_state reference;
} mpp_output;

// A sweep of the lidar.
typedef struct mpp_scan {
  // Age in ticks.
  uint32_t age;
  // Angle of the first beam against the body axis [rad].
  double angle_min;
  // Angle from a beam to the next [rad].
  double angle_increment;
  // Number of ranges.
  size_t count;
  // Ranges [m]; 0 for no return.
  const float *ranges;
} mpp_scan;

// What a planning cycle came to.
typedef struct mpp_plan {
  // 0: a feasible plan is flown. 1: the least violating plan is flown. 2: the last plan is kept. 3: straight
  // and level.
  uint8_t outcome;
  // Whether the cycle did all its work.
  bool complete;
  // Programs that were solved.
  uint32_t candidates;
  // Those that gave a feasible trajectory.
  uint32_t feasible;
  // Trees.
  uint32_t trees;
  // Slices.
  uint32_t slices;
  // Cost [-]; infinite without a trajectory.
  double cost;
  // Worst violation [m or rad].
  double violation;
  // Time from a place to the next [s].
  double period;
  // The places, if the outcome is 0 or 1.
  struct mpp_state knots[MPP_KNOTS];
  // Thrust from each place to the next [N].
  double thrust[MPP_KNOTS];
  // Elevator command at each place.
  double elevator[MPP_KNOTS];
} mpp_plan;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Bytes that the storage of a core needs.
size_t mpp_storage_size(void);

// Makes a core in the caller's storage, aligned to `MPP_ALIGNMENT`. The storage must stay where it is for as
// long as the core is used. A core needs no end; the storage is free when nobody uses it.
//
// # Safety
// `storage` is null or points to `size` bytes that nobody else uses; `made` is null or points to a pointer.
enum mpp_status mpp_init(void *storage, size_t size, struct mpp_core **made);

// Writes the usual configuration: the reference aircraft, the paper's lidar, 25 paths.
//
// # Safety
// `config` is null or points to a configuration.
enum mpp_status mpp_usual(struct mpp_config *config);

// Sets the core up, or anew, for a flight that begins with its next step. A refused configuration leaves it
// without one.
//
// # Safety
// `core` is null or comes from `mpp_init`; `config` is null or points to a configuration.
enum mpp_status mpp_set_up(struct mpp_core *core, const struct mpp_config *config);

// Makes the 100 Hz step at a time [s], which grows by 0.01 from step to step.
//
// # Safety
// `core` is null or comes from `mpp_init`; the others are null or point to their values.
enum mpp_status mpp_step(struct mpp_core *core,
                         double time,
                         const struct mpp_sensors *sensors,
                         struct mpp_output *output);

// Begins a planning cycle from a scan and the estimate of the last step.
//
// # Safety
// `core` is null or comes from `mpp_init`; `scan` is null or points to a scan whose `ranges` are null or `count`
// numbers.
enum mpp_status mpp_begin(struct mpp_core *core,
                          const struct mpp_scan *scan);

// Begins a planning cycle without a scan, because the lidar is silent or its scans are refused: slow flight in the map that
// earlier scans have left. Call it when a scan is late by a few ticks.
//
// # Safety
// `core` is null or comes from `mpp_init`.
enum mpp_status mpp_begin_blind(struct mpp_core *core);

// Does one bounded slice of the cycle. `more` says whether there is another one to do.
//
// # Safety
// `core` is null or comes from `mpp_init`; `more` is null or points to a value.
enum mpp_status mpp_advance(struct mpp_core *core, bool *more);

// Ends the cycle and takes its best plan over at a time [s]: that of the step that follows.
//
// # Safety
// `core` is null or comes from `mpp_init`; `plan` is null or points to a plan.
enum mpp_status mpp_finish(struct mpp_core *core, double time, struct mpp_plan *plan);

// Writes the counters of events, in the order of `hil_protocol::HealthReport::NAMES`.
//
// # Safety
// `core` is null or comes from `mpp_init`; `counters` is null or points to `MPP_COUNTERS` numbers.
enum mpp_status mpp_counters(const struct mpp_core *core, uint32_t (*counters)[MPP_COUNTERS]);

// Text of a status, for people: what is wrong and what to do. Any number may be given.
const char *mpp_text(int32_t status);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* MPP_H */
