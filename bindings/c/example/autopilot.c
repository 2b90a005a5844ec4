#include "autopilot.h"

#define TICK 0.01      /* s */
#define STORAGE 262144 /* bytes; mpp_storage_size() says how many are needed */

static _Alignas(MPP_ALIGNMENT) unsigned char storage[STORAGE];

mpp_status autopilot_init(autopilot *own) {
  *own = (autopilot){0};
  return mpp_init(storage, sizeof storage, &own->core);
}

mpp_status autopilot_set_up(autopilot *own, uint64_t seed) {
  mpp_config config;
  mpp_status status = mpp_usual(&config);
  if (status != MPP_STATUS_OK) return status;
  config.seed = seed;
  own->planning = false;
  own->refused = MPP_STATUS_OK;
  own->latency = config.latency_ticks;
  return mpp_set_up(own->core, &config);
}

/* Takes a plan over at its time: the best one so far is flown from the step of this tick on. */
static void take_over(autopilot *own, uint32_t tick, mpp_answer *answer) {
  if (!own->planning || tick - own->begin_tick < own->latency) return;
  mpp_status status = mpp_finish(own->core, tick * TICK, &answer->plan);
  if (status == MPP_STATUS_OK) {
    answer->has_plan = true;
    answer->plan_tick = own->scan_tick;
  } else {
    own->refused = status;
  }
  /* A plan that does not start yet is there in the next tick. After any other refusal the next scan begins anew. */
  own->planning = status == MPP_STATUS_EARLY;
}

/* Begins a cycle from a scan if none is under way, and works on it. */
static void plan(autopilot *own, uint32_t tick, const mpp_scan *scan) {
  mpp_status status = MPP_STATUS_OK;
  if (scan != NULL && !own->planning) {
    status = mpp_begin(own->core, scan);
    own->planning = status == MPP_STATUS_OK;
    own->begin_tick = tick;
    own->scan_tick = tick - scan->age;
  }
  /* A flight computer does a few slices between two steps, or as many as it has time for. */
  for (bool more = own->planning; more && status == MPP_STATUS_OK;) status = mpp_advance(own->core, &more);
  if (status != MPP_STATUS_OK) own->refused = status;
}

mpp_status autopilot_fly(void *context, uint32_t tick, const mpp_sensors *sensors, const mpp_scan *scan,
                         mpp_answer *answer) {
  autopilot *own = context;
  take_over(own, tick, answer);
  /* The step comes in each tick, whatever the planner says. */
  mpp_status status = mpp_step(own->core, tick * TICK, sensors, &answer->output);
  if (status != MPP_STATUS_OK) return status;
  if (answer->output.cycle_dropped) own->planning = false;
  plan(own, tick, scan);
  return mpp_counters(own->core, &answer->counters);
}

int autopilot_misuse(autopilot *own) {
  mpp_core *core = own->core, *none = NULL;
  mpp_config config, bad;
  mpp_sensors sensors = {0};
  mpp_output output;
  mpp_plan plan;
  mpp_refusal refused;
  bool more;
  double cruise;
  float ranges[MPP_BEAMS] = {0};
  mpp_scan scan = {.count = 0, .ranges = ranges};
  int wrong = 0;
#define EXPECT(call, expected) wrong += (call) != (expected)
  EXPECT(mpp_usual(NULL), MPP_STATUS_NULL);
  EXPECT(mpp_usual(&config), MPP_STATUS_OK);
  EXPECT(mpp_init(NULL, STORAGE, &none), MPP_STATUS_NULL);
  EXPECT(mpp_init(storage, 16, &none), MPP_STATUS_STORAGE);
  EXPECT(mpp_init(storage + 1, STORAGE - 1, &none), MPP_STATUS_ALIGNMENT);
  EXPECT(mpp_step(NULL, 0, &sensors, &output), MPP_STATUS_NULL);
  EXPECT(mpp_step(core, 0, &sensors, &output), MPP_STATUS_NOT_SET_UP);
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_NOT_SET_UP);
  EXPECT(mpp_begin_blind(core), MPP_STATUS_NOT_SET_UP);
  EXPECT(mpp_begin_blind(NULL), MPP_STATUS_NULL);
  EXPECT(mpp_finish(core, 0, &plan), MPP_STATUS_NOT_SET_UP);
  bad = config, bad.aircraft.airframe.mass = 0.0 / 0.0;
  EXPECT(mpp_set_up(core, &bad), MPP_STATUS_OUT_OF_RANGE);
  EXPECT(mpp_refused(core, NULL), MPP_STATUS_NULL);
  EXPECT(mpp_refused(core, &refused), MPP_STATUS_OK);
  EXPECT(refused.name[0], 'a'); /* airframe.mass */
  bad = config, bad.beams = 0;
  EXPECT(mpp_set_up(core, &bad), MPP_STATUS_BEAMS);
  bad = config, bad.latency_ticks = 0;
  EXPECT(mpp_set_up(core, &bad), MPP_STATUS_PERIOD);
  EXPECT(mpp_step(core, 0, &sensors, &output), MPP_STATUS_NOT_SET_UP);
  EXPECT(mpp_set_up(core, &config), MPP_STATUS_OK);
  EXPECT(mpp_advance(core, &more), MPP_STATUS_IDLE);
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_TIME);
  EXPECT(mpp_begin_blind(core), MPP_STATUS_TIME);
  EXPECT(mpp_step(core, 0.0 / 0.0, &sensors, &output), MPP_STATUS_TIME);
  EXPECT(mpp_step(core, 0, &sensors, &output), MPP_STATUS_OK);
  EXPECT(mpp_step(core, 0, &sensors, &output), MPP_STATUS_TIME);
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_SCAN_LENGTH);
  scan.count = 1u << 30;
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_SCAN_LENGTH);
  scan.count = config.beams;
  for (uint32_t beam = 0; beam < config.beams; beam++) ranges[beam] = -1;
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_SCAN_RANGE);
  for (uint32_t beam = 0; beam < config.beams; beam++) ranges[beam] = 0;
  scan.age = 1000000;
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_SCAN_AGE);
  scan.age = 0;
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_OK);
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_BUSY);
  EXPECT(mpp_begin_blind(core), MPP_STATUS_BUSY);
  EXPECT(mpp_finish(core, 0, &plan), MPP_STATUS_EARLY);
  for (more = true; more;)
    if (mpp_advance(core, &more) != MPP_STATUS_OK) return wrong + 1;
  EXPECT(mpp_finish(core, 0.1, &plan), MPP_STATUS_OK);
  cruise = plan.knots[MPP_KNOTS - 1].airspeed;
  EXPECT(mpp_begin(core, &scan), MPP_STATUS_SCAN_REPEATED);
  EXPECT(mpp_begin_blind(core), MPP_STATUS_OK);
  for (more = true; more;)
    if (mpp_advance(core, &more) != MPP_STATUS_OK) return wrong + 1;
  EXPECT(mpp_finish(core, 0.2, &plan), MPP_STATUS_OK);
  if (!plan.blind || !(plan.knots[MPP_KNOTS - 1].airspeed < cruise - 1)) wrong++; /* slow flight */
  if (mpp_text(-7) == NULL || mpp_text(MPP_STATUS_TRIM) == mpp_text(MPP_STATUS_OK)) wrong++;
  return wrong;
}
