/* The simulated flight for the example: bindings/c/plant. Not a part of the core. */
#ifndef MPP_PLANT_H
#define MPP_PLANT_H

#include "mpp.h"

/* What an autopilot gives back in a tick. */
typedef struct mpp_answer {
  mpp_output output;
  bool has_plan;
  mpp_plan plan;
  uint32_t plan_tick;
  uint32_t counters[MPP_COUNTERS];
} mpp_answer;

/* An autopilot: it gets a tick, its sensors, and a scan or null. */
typedef mpp_status (*mpp_autopilot)(void *context, uint32_t tick, const mpp_sensors *sensors,
                                    const mpp_scan *scan, mpp_answer *answer);

/* Flies the reference aircraft past 20 obstacles; writes the hash of the log and whether the aircraft survived. */
mpp_status mpp_plant_fly(uint64_t seed, uint32_t seconds, mpp_autopilot autopilot, void *context,
                         char (*hash)[17], bool *survived);

#endif
