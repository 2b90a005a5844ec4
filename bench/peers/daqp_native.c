/* DAQP by its C interface, built for this machine. A workspace is set up once; the time holds update and solve. */
#include <stdlib.h>
#include <time.h>

#include "api.h"
#include "utils.h"

typedef struct {
  DAQPWorkspace work;
  DAQPProblem problem;
} held;

void held_free(held *own) {
  free_daqp_workspace(&own->work);
  free_daqp_ldp(&own->work);
  free(own);
}

/* A workspace for these factors, or null. The arrays have to stay. */
held *held_new(int variables, int rows, double *H, double *f, double *A, double *upper, double *lower, int *sense) {
  held *own = calloc(1, sizeof *own);
  if (own == NULL) return NULL;
  allocate_daqp_settings(&own->work);
  own->problem = (DAQPProblem){.n = variables, .m = rows, .H = H, .f = f, .A = A, .bupper = upper, .blower = lower,
                               .sense = sense};
  if (setup_daqp(&own->problem, &own->work, NULL) < 0) {
    held_free(own);
    return NULL;
  }
  return own;
}

/* Solves with these vectors, from no active rows. Gives the time [s]; the flag is DAQP's. */
double held_solve(held *own, double *f, double *upper, double *lower, int *sense, double *x, double *lam, int *flag) {
  struct timespec begin, end;
  DAQPResult result = {.x = x, .lam = lam};
  clock_gettime(CLOCK_MONOTONIC, &begin);
  own->problem.f = f;
  own->problem.bupper = upper;
  own->problem.blower = lower;
  own->problem.sense = sense;
  *flag = daqp_update_ldp(DAQP_UPDATE_v + DAQP_UPDATE_d + DAQP_UPDATE_sense, &own->work, &own->problem);
  if (*flag >= 0) {
    daqp_solve(&result, &own->work);
    *flag = result.exitflag;
  }
  clock_gettime(CLOCK_MONOTONIC, &end);
  return (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
}
