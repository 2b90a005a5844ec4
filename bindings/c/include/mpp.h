/* The flight core in C. docs/c.md explains the loop of calls.
 *
 * Axes and signs. The aircraft flies in one vertical plane: x points downrange along the track, z points up, both in metres from
 * an origin that the caller chooses. All units are SI, and angles are radians. Pitch, pitch rate and flight path angle are
 * positive nose up, against the horizontal. Wind is the velocity of the air: a tailwind and an updraught are positive.
 * Thrust acts along the body axis, forwards. A beam's angle is against the body axis: 0 is straight ahead, positive is above.
 * The elevator has the unit and the sign that the derivatives give it: with a positive moment_elevator a greater
 * command raises the nose. elevator_below and elevator_above are distances from the command of level flight at cruise in this
 * unit, and elevator_rate is this unit per second. A tick is 10 ms. */

#ifndef MPP_H
#define MPP_H

/* Made from bindings/c/core by its test; do not change it by hand. */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define MPP_VERSION "0.2.0"

// Alignment that the storage needs [bytes].
#define MPP_ALIGNMENT 16

// Room for the text of a name or a unit, its end included [bytes].
#define MPP_TEXT 64

// Greatest number of beams of a scan.
#define MPP_BEAMS 128

// Places of a plan.
#define MPP_KNOTS 19

// Counters of events.
#define MPP_COUNTERS 24

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
  // No planning cycle is under way: none was begun, or a step has dropped it.
  MPP_STATUS_IDLE = 6,
  // A time is not finite, or goes back.
  MPP_STATUS_TIME = 7,
  // The number of beams is not that of the configuration.
  MPP_STATUS_SCAN_LENGTH = 8,
  // A range is not finite, negative or too long, or an angle is not finite.
  MPP_STATUS_SCAN_RANGE = 9,
  // The scan is older than the poses that the core remembers.
  MPP_STATUS_SCAN_AGE = 10,
  // The plan does not start yet. The cycle goes on.
  MPP_STATUS_EARLY = 11,
  // The time has jumped, and no position has told since where the aircraft is.
  MPP_STATUS_LOST = 12,
  // The scan is not newer than the last one, or repeats its ranges to the last bit.
  MPP_STATUS_SCAN_REPEATED = 13,
  // The number of paths.
  MPP_STATUS_PATHS = 20,
  // The latency.
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
  // A number is out of its range; `mpp_refused` names it.
  MPP_STATUS_OUT_OF_RANGE = 29,
  // The planner cannot be set up.
  MPP_STATUS_PLANNER = 30,
} mpp_status;

// A counter of events: its place in what `mpp_counters` writes. Counters only grow, and a full one stays full.
typedef enum mpp_counter {
  // Measured values of airspeed or pitch that were not finite.
  MPP_COUNTER_MEASUREMENTS_NOT_FINITE = 0,
  // Those that the sensor only repeated.
  MPP_COUNTER_MEASUREMENTS_FROZEN = 1,
  // Those that came later than the ones before.
  MPP_COUNTER_MEASUREMENTS_LATE = 2,
  // Those of a sensor that was not trusted.
  MPP_COUNTER_MEASUREMENTS_DISTRUSTED = 3,
  // Those that were too far from the estimate.
  MPP_COUNTER_MEASUREMENTS_GATED = 4,
  // Times between two steps that were longer than 0.5 s.
  MPP_COUNTER_TIME_JUMPS = 5,
  // Predictions that were not finite.
  MPP_COUNTER_PREDICTIONS_DIVERGED = 6,
  // Positions with a value that was not finite, or with a negative standard deviation.
  MPP_COUNTER_POSITIONS_NOT_FINITE = 7,
  // Positions that repeated the one before.
  MPP_COUNTER_POSITIONS_HELD = 8,
  // Positions that were too old, or older than the one before.
  MPP_COUNTER_POSITIONS_LATE = 9,
  // Positions that were too far from the estimate.
  MPP_COUNTER_POSITIONS_GATED = 10,
  // Positions from which the estimate began anew.
  MPP_COUNTER_POSITIONS_RESTARTED = 11,
  // Commands that were not finite; trim was commanded instead.
  MPP_COUNTER_COMMANDS_NOT_FINITE = 12,
  // Commands of thrust that were limited.
  MPP_COUNTER_THRUST_LIMITED = 13,
  // Commands of the elevator that were limited.
  MPP_COUNTER_ELEVATOR_LIMITED = 14,
  // Cycles that gave a feasible plan.
  MPP_COUNTER_PLANS_FEASIBLE = 15,
  // Cycles without a plan, after which the last plan was kept.
  MPP_COUNTER_PLANS_KEPT = 16,
  // Cycles that gave a plan that lacks margin.
  MPP_COUNTER_PLANS_LEAST_VIOLATING = 17,
  // Cycles without a plan, after which there was no last plan either.
  MPP_COUNTER_PLANS_TRIM_HOLD = 18,
  // Cycles that the planner ended early because of a defect of the planner. Report one that is not 0.
  MPP_COUNTER_PLANNER_INCONSISTENT = 19,
  // Cycles whose best plan the gate refused.
  MPP_COUNTER_PLANS_REFUSED = 20,
  // Cycles after which a path of the lattice was flown, because no plan passed the gate.
  MPP_COUNTER_PLANS_PURSUIT = 21,
  // Cycles after which a reserve was flown, because no plan and no path passed the gate.
  MPP_COUNTER_PLANS_RESERVE = 22,
  // Cycles in which nothing passed the gate.
  MPP_COUNTER_PLANS_LATEST = 23,
} mpp_counter;

// A core. Its content is private.
typedef struct mpp_core mpp_core;

// The airframe, by its longitudinal coefficients: `L = q S (C_L + C_La' alpha' + C_Lq theta')`, `D = q S C_D`,
// `M = q S l C_M` with the dynamic pressure `q = rho v^2 / 2` and
// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`,
// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`.
//
// The elevator may be in any unit. Command, limits and derivatives have the same one.
//
// The four derivatives by rates are in s/rad: the usual coefficient, which counts per radian of `rate c / (2 v)`,
// times `c / (2 v)` at cruise. With `c` = 0.2 m and `v` = 15 m/s a usual `C_Mq` of -10 becomes -0.067. The usual
// number itself is about 150 times too large, and the core does not refuse it. An aircraft file (docs/aircraft.md)
// takes the usual numbers; `sil-harness aircraft FILE` converts them itself and prints the modes that follow.
typedef struct mpp_airframe {
  // Mass `m` [kg].
  double mass;
  // Moment of inertia in pitch `I_yy` [kg m^2].
  double pitch_inertia;
  // Wing area `S` [m^2].
  double wing_area;
  // Reference length of the pitching moment `l` [m]: usually the chord `c`.
  double moment_length;
  // Air density `rho` [kg/m^3].
  double air_density;
  // Lift coefficient at zero angle of attack `C_L0` [-].
  double lift_zero;
  // Lift slope `C_La` [1/rad].
  double lift_alpha;
  // Lift by the rate of the angle of attack `C_La'` [s/rad]: the usual coefficient times `c / (2 v)` at cruise.
  double lift_alpha_rate;
  // Lift by the pitch rate `C_Lq` [s/rad]: the usual coefficient times `c / (2 v)` at cruise.
  double lift_pitch_rate;
  // Lift of the elevator `C_Le` [1 per unit of elevator].
  double lift_elevator;
  // Parasitic drag coefficient `C_D0` [-].
  double drag_zero;
  // Induced drag factor `K` [-].
  double drag_induced;
  // Pitching moment coefficient at zero angle of attack `C_M0` [-].
  double moment_zero;
  // Pitch stiffness `C_Ma` [1/rad], negative.
  double moment_alpha;
  // Pitch damping through the rate of the angle of attack `C_Ma'` [s/rad]: the usual coefficient times
  // `c / (2 v)` at cruise; 0 or negative.
  double moment_alpha_rate;
  // Pitch damping through the pitch rate `C_Mq` [s/rad]: the usual coefficient times `c / (2 v)` at cruise; 0 or
  // negative.
  double moment_pitch_rate;
  // Elevator effectiveness `C_Me` [1 per unit of elevator]. If it is positive, a greater elevator raises the nose.
  double moment_elevator;
} mpp_airframe;

// The aircraft and the limits of its actuators.
typedef struct mpp_aircraft {
  // Mass, inertia and aerodynamics.
  struct mpp_airframe airframe;
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
  // Greatest distance of the elevator below its trim, which is that of level flight at cruise [unit of elevator].
  double elevator_below;
  // Greatest distance of the elevator above its trim [unit of elevator].
  double elevator_above;
  // Greatest rate of the elevator [unit of elevator per s].
  double elevator_rate;
  // Dead time from a command of the elevator to its effect, at most 0.3 [s]; 0 for none.
  double elevator_delay;
  // Dead time of the thrust, at most 0.3 [s]; 0 for none.
  double thrust_delay;
} mpp_aircraft;

// What a flight needs to know before it begins.
typedef struct mpp_config {
  // The aircraft.
  struct mpp_aircraft aircraft;
  // Candidate paths of a planning cycle, 1 to 50.
  uint16_t paths;
  // Beams of each scan, 1 to 128.
  uint16_t beams;
  // Ticks of 10 ms from `mpp_begin` until the plan of this cycle is flown, at least 1.
  uint32_t latency_ticks;
  // Seed of the planner's random numbers.
  uint64_t seed;
  // Longest range that the lidar reports [m], 1 to 100000.
  float range_max;
  // Height to which the aircraft returns [m], -1000 to 20000.
  double altitude;
} mpp_config;

// A number that `mpp_set_up` has refused.
typedef struct mpp_refusal {
  // Its name in the core; empty if no number was out of its range. Behind `airframe.` and `actuators.` stands the
  // name of the field of the aircraft.
  char name[MPP_TEXT];
  // Its unit; 1 for a number without one.
  char unit[MPP_TEXT];
  // Least value.
  double least;
  // Greatest value.
  double most;
} mpp_refusal;

// The measurements that are new in a tick. Ages are in ticks of 10 ms, at most 30.
//
// What has nothing new has `has_air` or `has_position` false, and not its old value: a value that repeats to the last bit
// counts as missing, a position at once and air data after 5 repeats. Values that are not finite and negative standard
// deviations are not used either; the counters tell of them.
typedef struct mpp_sensors {
  // Whether there is new airspeed and pitch.
  bool has_air;
  // Their age.
  uint32_t air_age;
  // True airspeed [m/s].
  double airspeed;
  // Pitch against the horizontal [rad], nose up positive.
  double pitch;
  // Whether there is a new position.
  bool has_position;
  // Its age.
  uint32_t position_age;
  // Downrange [m].
  double x;
  // Height [m].
  double z;
  // Standard deviation of the white part of its error along an axis [m].
  double sigma;
  // Whether the position has a velocity over ground.
  bool has_velocity;
  // Velocity downrange [m/s].
  double velocity_x;
  // Velocity upwards [m/s].
  double velocity_z;
  // Standard deviation of its error along an axis [m/s].
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
  // Angle of the motion through the air above the horizontal [rad].
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
  // Whether this step has dropped the planning cycle that was under way: the estimates have jumped, and its plan does
  // not fit them. Begin a new one with the next scan.
  bool cycle_dropped;
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
  // Age in ticks at the last step, at most 120.
  uint32_t age;
  // Angle of the first beam against the body axis [rad]: 0 is straight ahead, positive is above.
  double angle_min;
  // Angle from a beam to the next [rad]; positive if the next one is above.
  double angle_increment;
  // Number of ranges.
  size_t count;
  // Ranges [m]; 0, infinite, not a number or beyond `range_max` for no return, negative for a bad beam, which shows nothing.
  const float *ranges;
} mpp_scan;

// What a planning cycle came to.
typedef struct mpp_plan {
  // 0: a feasible plan is flown. 1: the least violating plan is flown. 2: the last plan is kept. 3: straight
  // and level. No plan passes the gate, and there is flown 4: a path of the lattice, 5: a reserve, 6: what strikes latest.
  uint8_t outcome;
  // Whether the cycle did all its work.
  bool complete;
  // Whether the cycle had no scan, or one of a lidar that shows nothing where the map has obstacles. Its plans are slow
  // flight.
  bool blind;
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
  // Time from a place to the next [s]. The first place is flown at `start`.
  double period;
  // The places, if the outcome is 0 or 1.
  struct mpp_state knots[MPP_KNOTS];
  // Thrust from each place to the next [N].
  double thrust[MPP_KNOTS];
  // Elevator command at each place.
  double elevator[MPP_KNOTS];
  // Time from which the plan is flown [s]: that of the step before `mpp_begin`, and the latency.
  double start;
} mpp_plan;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The library's version, as `MPP_VERSION` is that of the header: "0.2.0".
const char *mpp_version(void);

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
// without one. If a number was out of its range, `mpp_refused` gives its name and range.
//
// # Safety
// `core` is null or comes from `mpp_init`; `config` is null or points to a configuration.
enum mpp_status mpp_set_up(struct mpp_core *core, const struct mpp_config *config);

// Writes which number `mpp_set_up` refused the last time, and the range that it must be in.
//
// # Safety
// `core` is null or comes from `mpp_init`; `refused` is null or points to its value.
enum mpp_status mpp_refused(const struct mpp_core *core, struct mpp_refusal *refused);

// Makes the 100 Hz step at a time [s], which grows by 0.01 from step to step.
//
// A step never fails because of its sensors. It does not use values that are not finite, negative standard deviations, and
// values that only repeat; it returns `MPP_STATUS_OK`, and `mpp_counters` tells of them.
//
// A step drops the planning cycle that is under way if the estimates jump, because its plan no longer fits:
// `output.cycle_dropped` is true then. `mpp_advance` and `mpp_finish` return `MPP_STATUS_IDLE` from then on, and the
// next scan begins a new cycle.
//
// # Safety
// `core` is null or comes from `mpp_init`; the others are null or point to their values.
enum mpp_status mpp_step(struct mpp_core *core,
                         double time,
                         const struct mpp_sensors *sensors,
                         struct mpp_output *output);

// Begins a planning cycle from a scan and the estimate of the last step. Its plan starts `latency_ticks` after that step.
//
// Give each scan once. The core refuses one that is not newer than the last one, or whose returns repeat those of the last one to
// the last bit, because the lidar is frozen then. It also refuses one while it does not know where the aircraft is, because the
// time has jumped: `MPP_STATUS_LOST`.
//
// # Safety
// `core` is null or comes from `mpp_init`; `scan` is null or points to a scan whose `ranges` are null or `count`
// numbers.
enum mpp_status mpp_begin(struct mpp_core *core,
                          const struct mpp_scan *scan);

// Begins a planning cycle without a scan, because the lidar is silent or its scans are refused: slow flight in the map that
// earlier scans have left. Call it when a scan is late by a few ticks. It returns `MPP_STATUS_LOST` when `mpp_begin` does.
//
// # Safety
// `core` is null or comes from `mpp_init`.
enum mpp_status mpp_begin_blind(struct mpp_core *core);

// Does one bounded slice of the cycle. `more` says whether there is another one to do.
//
// # Safety
// `core` is null or comes from `mpp_init`; `more` is null or points to a value.
enum mpp_status mpp_advance(struct mpp_core *core, bool *more);

// Ends the cycle and takes its best plan over at a time [s]: that of the step that follows. The plan starts `latency_ticks`
// after the step before `mpp_begin`. Before that time the call returns `MPP_STATUS_EARLY`, and the cycle goes on; call it
// again then.
//
// # Safety
// `core` is null or comes from `mpp_init`; `plan` is null or points to a plan.
enum mpp_status mpp_finish(struct mpp_core *core,
                           double time,
                           struct mpp_plan *plan);

// Writes the counters of events. `mpp_counter` names their places.
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
