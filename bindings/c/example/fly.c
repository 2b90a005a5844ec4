/* Flies the core from C against the simulated aircraft: fly [SEED [SECONDS [FOLDER]]]. The hash is that of
 * `sil-harness fly --seed SEED --duration SECONDS`. The core runs in this process, or with FOLDER on the flight
 * computer whose FIFOs are there (flight_computer.c). */
#include <stdio.h>
#include <stdlib.h>

#include "autopilot.h"
#include "wire.h"

/* A flight computer behind two FIFOs. */
typedef struct {
  FILE *to_core, *to_harness;
} remote;

static mpp_status fly_remotely(void *context, uint32_t tick, const mpp_sensors *sensors, const mpp_scan *scan,
                               mpp_answer *answer) {
  remote *own = context;
  wire_tick sent = {.tick = tick, .sensors = *sensors};
  static wire_answer received;
  if (scan != NULL) {
    sent.has_scan = true;
    sent.age = scan->age;
    sent.count = (uint32_t)scan->count;
    sent.angle_min = scan->angle_min;
    sent.angle_increment = scan->angle_increment;
    for (size_t beam = 0; beam < scan->count && beam < MPP_BEAMS; beam++) sent.ranges[beam] = scan->ranges[beam];
  }
  if (fwrite(&sent, sizeof sent, 1, own->to_core) != 1 || fflush(own->to_core) != 0 ||
      fread(&received, sizeof received, 1, own->to_harness) != 1) {
    fprintf(stderr, "the flight computer has ended at tick %u\n", (unsigned)tick);
    exit(1);
  }
  *answer = received.answer;
  return (mpp_status)received.status;
}

static FILE *open_fifo(const char *folder, const char *name, const char *mode) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, mode);
  if (file == NULL) {
    perror(path);
    exit(1);
  }
  return file;
}

static mpp_status fly_on(const char *folder, uint64_t seed, uint32_t seconds, char (*hash)[17], bool *survived) {
  /* In the flight computer's order, because each end waits for the other one. */
  remote own;
  own.to_core = open_fifo(folder, "to-core", "wb");
  own.to_harness = open_fifo(folder, "to-harness", "rb");
  fwrite(&seed, sizeof seed, 1, own.to_core);
  mpp_status status = mpp_plant_fly(seed, seconds, fly_remotely, &own, hash, survived);
  fclose(own.to_core);
  fclose(own.to_harness);
  return status;
}

static mpp_status fly_here(uint64_t seed, uint32_t seconds, char (*hash)[17], bool *survived) {
  autopilot own;
  mpp_status status = autopilot_init(&own);
  if (status != MPP_STATUS_OK) return status;
  int wrong = autopilot_misuse(&own);
  if (wrong > 0) {
    fprintf(stderr, "%d calls that make no sense were not refused as the header says\n", wrong);
    exit(1);
  }
  status = autopilot_set_up(&own, seed);
  if (status != MPP_STATUS_OK) return status;
  status = mpp_plant_fly(seed, seconds, autopilot_fly, &own, hash, survived);
  if (own.refused != MPP_STATUS_OK) fprintf(stderr, "the planner refused: %s\n", mpp_text(own.refused));
  return status;
}

int main(int count, char **arguments) {
  uint64_t seed = count > 1 ? strtoull(arguments[1], NULL, 10) : 1;
  uint32_t seconds = count > 2 ? (uint32_t)strtoul(arguments[2], NULL, 10) : 20;
  char hash[17] = "";
  bool survived = false;
  mpp_status status = count > 3 ? fly_on(arguments[3], seed, seconds, &hash, &survived)
                                : fly_here(seed, seconds, &hash, &survived);
  if (status != MPP_STATUS_OK) {
    fprintf(stderr, "the flight failed: %s\n", mpp_text(status));
    return 1;
  }
  printf("seed %llu, %s, log %s\n", (unsigned long long)seed, survived ? "survived" : "lost", hash);
  return 0;
}
