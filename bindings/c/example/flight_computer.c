/* The example on a bare Cortex-M7, QEMU's mps2-an500, without a C library: the loop of autopilot.c, its sensors and
 * scans from the host by semihosting (wire.h). At the end it writes to the file `report` how deep the stack was. */
#include "autopilot.h"
#include "wire.h"

/* Semihosting calls, and the two reasons to exit. */
enum { OPEN = 1, WRITE = 5, READ = 6, EXIT = 0x18 };
enum { FINISHED = 0x20026, FAILED = 0x20023 };
/* Modes of opening, as of fopen: "rb" and "wb". */
enum { READ_BINARY = 1, WRITE_BINARY = 5 };

static uint32_t call(uint32_t number, const void *block) {
  register uint32_t r0 __asm__("r0") = number;
  register const void *r1 __asm__("r1") = block;
  __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

static void leave(uint32_t reason) {
  for (;;) call(EXIT, (const void *)reason);
}

static uint32_t open_file(const char *name, uint32_t length, uint32_t mode) {
  const uint32_t block[] = {(uint32_t)name, mode, length};
  return call(OPEN, block);
}

/* Reads all of a value. Gives false when the host has closed its end. */
static bool receive(uint32_t file, void *place, uint32_t size) {
  while (size > 0) {
    const uint32_t block[] = {file, (uint32_t)place, size};
    uint32_t left = call(READ, block);
    if (left >= size) return false;
    place = (unsigned char *)place + (size - left);
    size = left;
  }
  return true;
}

static void send(uint32_t file, const void *place, uint32_t size) {
  while (size > 0) {
    const uint32_t block[] = {file, (uint32_t)place, size};
    uint32_t left = call(WRITE, block);
    if (left >= size) leave(FAILED);
    place = (const unsigned char *)place + (size - left);
    size = left;
  }
}

/* Of flight_computer.ld. */
extern uint32_t stack_end[], stack_start[], data_start[], data_end[], data_load[], bss_start[], bss_end[];

#define PAINT 0xCCCCCCCCu

/* Paints the stack below this function's frame. */
static __attribute__((noinline)) void paint(void) {
  volatile uint32_t *top = (volatile uint32_t *)__builtin_frame_address(0) - 16;
  for (volatile uint32_t *word = stack_end; word < top; word++) *word = PAINT;
}

/* Bytes of the stack that were used since it was painted. */
static __attribute__((noinline)) uint32_t depth(void) {
  const volatile uint32_t *word = stack_end;
  while (word < stack_start && *word == PAINT) word++;
  return (uint32_t)((unsigned char *)stack_start - (const unsigned char *)word);
}

static wire_tick ordered;
static wire_answer answered;
static autopilot own;

int main(void) {
  uint32_t report[5] = {0};
  uint32_t to_core = open_file("to-core", 7, READ_BINARY);
  uint32_t to_harness = open_file("to-harness", 10, WRITE_BINARY);
  uint64_t seed;
  report[0] = mpp_storage_size();
  paint();
  if (autopilot_init(&own) != MPP_STATUS_OK) return 1;
  report[1] = depth();
  report[2] = (uint32_t)autopilot_misuse(&own);
  if (!receive(to_core, &seed, sizeof seed)) return 1;
  paint();
  if (autopilot_set_up(&own, seed) != MPP_STATUS_OK) return 1;
  report[3] = depth();
  paint();
  while (receive(to_core, &ordered, sizeof ordered)) {
    mpp_scan scan = {
        .age = ordered.age,
        .angle_min = ordered.angle_min,
        .angle_increment = ordered.angle_increment,
        .count = ordered.count,
        .ranges = ordered.ranges,
    };
    answered = (wire_answer){0};
    answered.status = autopilot_fly(&own, ordered.tick, &ordered.sensors, ordered.has_scan ? &scan : NULL,
                                    &answered.answer);
    send(to_harness, &answered, sizeof answered);
  }
  report[4] = depth();
  send(open_file("report", 6, WRITE_BINARY), report, sizeof report);
  return 0;
}

/* A trap ends the emulation. */
static void trap(void) { leave(FAILED); }

void reset(void) {
  /* The FPU is on before the first floating-point instruction. */
  *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20;
  __asm__ volatile("dsb\n isb" ::: "memory");
  const uint32_t *from = data_load;
  for (uint32_t *word = data_start; word < data_end;) *word++ = *from++;
  for (uint32_t *word = bss_start; word < bss_end;) *word++ = 0;
  leave(main() == 0 ? FINISHED : FAILED);
}

/* The stack's start, reset, and the traps. No interrupt is used. */
__attribute__((section(".vectors"), used)) static void (*const vectors[7])(void) = {
    (void (*)(void))stack_start, reset, trap, trap, trap, trap, trap,
};
