/* The loop that an autopilot makes around the core. The host's example and the flight computer's share it. */
#ifndef AUTOPILOT_H
#define AUTOPILOT_H

#include "mpp_plant.h"

typedef struct autopilot {
  mpp_core *core;
  bool planning;
  uint32_t begin_tick; /* of the step before mpp_begin */
  uint32_t scan_tick;
  uint32_t latency;   /* ticks from begin_tick until the plan is flown */
  mpp_status refused; /* the planner's last refusal, for a log */
} autopilot;

/* Makes the core in storage of its own, without a configuration. */
mpp_status autopilot_init(autopilot *own);

/* Sets the core up for a flight with this seed. */
mpp_status autopilot_set_up(autopilot *own, uint64_t seed);

/* Makes one tick. A refusal of the planner ends no flight: the step goes on, and the next scan begins anew. It is an `mpp_autopilot`; the context is the autopilot. */
mpp_status autopilot_fly(void *context, uint32_t tick, const mpp_sensors *sensors, const mpp_scan *scan,
                         mpp_answer *answer);

/* Calls a core without a configuration as it must not be called. Returns the number of wrong answers. */
int autopilot_misuse(autopilot *own);

#endif
