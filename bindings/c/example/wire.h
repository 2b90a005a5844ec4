/* What the host and a flight computer send each other as bytes, for the example alone: first the seed, then in each
 * tick a `wire_tick` to the flight computer and a `wire_answer` back. Both sides are little-endian and align numbers to
 * their size; the sizes below hold on both, or they do not compile. */
#ifndef WIRE_H
#define WIRE_H

#include "mpp_plant.h"

typedef struct wire_tick {
  uint32_t tick;
  bool has_scan;
  mpp_sensors sensors;
  uint32_t age;
  uint32_t count;
  double angle_min;
  double angle_increment;
  float ranges[MPP_BEAMS];
} wire_tick;

typedef struct wire_answer {
  int32_t status;
  mpp_answer answer;
} wire_answer;

_Static_assert(sizeof(wire_tick) == 632, "the same layout on both sides");
_Static_assert(sizeof(wire_answer) == 1536, "the same layout on both sides");

#endif
