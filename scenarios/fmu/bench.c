/* A bench as a co-simulation FMU of FMI 3.0. "numbers.h" has its arrays and tables; the steps are in the object file.

   A tick is cut before the voltages: the steps up to there begin it, so that measurements are there when the importer
   asks; fmi3DoStep takes the voltages, ends the tick and begins the next. When a severity or a parameter changes between
   two steps, the tick that has begun is taken back and begun again, so that the change acts from this tick on. */

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void Step(double *p, double *s, double *w, const int64_t *io);
typedef struct { Step *step; int64_t p, s, io, every; int fault; } Row;
typedef struct { int count; const int64_t *places; const double *factors; int points; const double *grid, *numbers; } Dependence;
typedef struct { const char *name; int64_t p, size, s, states, start; const double *packed; int signals; const int64_t *places;
                 double low, high, first; Dependence follows; } Fault;
typedef struct { const char *name; double low, high, first; Dependence follows; } Value;
typedef struct { const char *unit; int count; const int64_t *places; } Command;

#include "numbers.h"

#define API __attribute__((visibility("default")))
typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } fmi3Status;
typedef void Log(void *environment, fmi3Status status, const char *category, const char *message);

typedef struct {
  double p[P], s[S], w[W], s_before[S], w_before[W];
  double commands[COMMANDS + 1], severities[FAULTS + 1], values[VALUES + 1];
  bool fault_changed[FAULTS + 1], value_changed[VALUES + 1], begun, changed, tripped;
  int64_t tick;
  double time;
  void *environment;
  Log *log;
} Bench;

static fmi3Status refuse(Bench *b, const char *text, const char *name, double value) {
  char line[400];
  snprintf(line, sizeof line, text, name, value);
  if (b->log) b->log(b->environment, ERROR, "logStatusError", line);
  return ERROR;
}

static void start(Bench *b) {
  memcpy(b->p, p_first, sizeof b->p);
  memcpy(b->s, s_first, sizeof b->s);
  memcpy(b->w, w_first, sizeof b->w);
  memset(b->commands, 0, sizeof b->commands);
  for (int k = 0; k < FAULTS; k++) b->severities[k] = faults[k].first, b->fault_changed[k] = false;
  for (int k = 0; k < VALUES; k++) b->values[k] = values[k].first, b->value_changed[k] = false;
  b->begun = b->changed = b->tripped = false;
  b->tick = 0;
  b->time = 0.0;
}

static int point(const Dependence *d, double value) {
  for (int i = 0; i < d->points; i++)
    if (d->grid[i] == value) return i;
  return -1;
}

static void follow(double *numbers, const Dependence *d, double value) {
  int at = d->factors ? 0 : point(d, value);
  for (int i = 0; i < d->count; i++)
    numbers[d->places[i]] = d->factors ? value * d->factors[i] : d->numbers[at * d->count + i];
}

static void run(Bench *b, int first, int end) {
  for (int i = first; i < end; i++) {
    const Row *r = &rows[i];
    if (r->fault >= 0 && b->severities[r->fault] == 0.0) continue;
    if (r->every == 1 || b->tick % r->every == 0) r->step(b->p + r->p, b->s + r->s, b->w, io + r->io);
  }
}

static void begin(Bench *b) {
  memcpy(b->s_before, b->s, sizeof b->s);
  memcpy(b->w_before, b->w, sizeof b->w);
  b->w[TICK] = (double)b->tick;
  b->w[TIME_MS] = (double)b->tick * DT_MS;
  run(b, 0, CUT);
  b->begun = true;
}

/* Begin the tick, if it has not begun since the last change. */
static void settle(Bench *b) {
  if (b->begun && !b->changed) return;
  if (b->begun) {
    memcpy(b->s, b->s_before, sizeof b->s);
    memcpy(b->w, b->w_before, sizeof b->w);
  }
  for (int k = 0; k < FAULTS; k++) {
    if (!b->fault_changed[k]) continue;
    const Fault *f = &faults[k];
    b->fault_changed[k] = false;
    if (b->severities[k] == 0.0) {
      memcpy(b->s + f->s, s_first + f->s, f->states * sizeof(double));
      for (int i = 0; i < f->signals; i++) b->w[f->places[i]] = 0.0;
    } else {
      memcpy(b->p + f->p, f->packed, f->size * sizeof(double));
      follow(b->p + f->p, &f->follows, b->severities[k]);
      if (f->start >= 0) b->p[f->p + f->start] = (double)b->tick;
    }
  }
  for (int k = 0; k < VALUES; k++)
    if (b->value_changed[k]) follow(b->p, &values[k].follows, b->values[k]), b->value_changed[k] = false;
  b->changed = false;
  begin(b);
}

static const char *tripped(const Bench *b) {
  for (int i = 0; i < GUARDS; i++) {
    int code = (int)b->w[guards[i]];
    if (code > 0) return reasons[code];
  }
  return NULL;
}

API const char *fmi3GetVersion(void) { return "3.0"; }

API void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                      bool events, bool early, const uint32_t *required, size_t count, void *environment,
                                      Log *log, void *update) {
  if (!token || strcmp(token, TOKEN)) {
    if (log) log(environment, ERROR, "logStatusError", "the instantiation token is the token of another FMU");
    return NULL;
  }
  Bench *b = calloc(1, sizeof *b);
  if (!b) return NULL;
  b->environment = environment;
  b->log = log;
  start(b);
  return b;
}

API void fmi3FreeInstance(void *b) { free(b); }
API fmi3Status fmi3SetDebugLogging(void *b, bool on, size_t count, const char *const *categories) { return OK; }
API fmi3Status fmi3EnterInitializationMode(void *b, bool has_tolerance, double tolerance, double time, bool has_stop, double stop) {
  ((Bench *)b)->time = time;
  return OK;
}
API fmi3Status fmi3ExitInitializationMode(void *b) {
  settle(b);
  return OK;
}
API fmi3Status fmi3Terminate(void *b) { return OK; }
API fmi3Status fmi3Reset(void *b) {
  start(b);
  return OK;
}

API fmi3Status fmi3GetFloat64(void *instance, const uint32_t *references, size_t count, double *found, size_t room) {
  Bench *b = instance;
  if (room < count) return ERROR;
  settle(b);
  for (size_t i = 0; i < count; i++) {
    uint32_t k = references[i];
    if (k == 0) found[i] = b->time;
    else if ((k -= 1) < COMMANDS) found[i] = b->commands[k];
    else if ((k -= COMMANDS) < FAULTS) found[i] = b->severities[k];
    else if ((k -= FAULTS) < VALUES) found[i] = b->values[k];
    else if ((k -= VALUES) < OUTPUTS) found[i] = b->w[outputs[k]];
    else return refuse(b, "%s has the reference %g, which no variable has", "a variable", (double)references[i]);
  }
  return OK;
}

static fmi3Status change(Bench *b, const char *name, double value, double low, double high, const Dependence *d, double *kept,
                         bool *changed, bool may_be_zero) {
  if (*kept == value) return OK;
  if (!(value >= low && value <= high)) return refuse(b, "%s is out of its range, got %g", name, value);
  if (!d->factors && !(may_be_zero && value == 0.0) && point(d, value) < 0)
    return refuse(b, "%s must be a point of its grid (see its description), got %.17g", name, value);
  *kept = value;
  *changed = b->changed = true;
  return OK;
}

API fmi3Status fmi3SetFloat64(void *instance, const uint32_t *references, size_t count, const double *given, size_t room) {
  Bench *b = instance;
  if (room < count) return ERROR;
  for (size_t i = 0; i < count; i++) {
    uint32_t k = references[i] - 1;
    fmi3Status status = OK;
    if (references[i] == 0) status = refuse(b, "%s cannot be set, got %g", "time", given[i]);
    else if (k < COMMANDS) b->commands[k] = given[i];
    else if ((k -= COMMANDS) < FAULTS) {
      const Fault *f = &faults[k];
      status = change(b, f->name, given[i], f->low, f->high, &f->follows, &b->severities[k], &b->fault_changed[k], true);
    } else if ((k -= FAULTS) < VALUES) {
      const Value *v = &values[k];
      status = change(b, v->name, given[i], v->low, v->high, &v->follows, &b->values[k], &b->value_changed[k], false);
    } else status = refuse(b, "%s cannot be set, got %g", "an output", given[i]);
    if (status != OK) return status;
  }
  return OK;
}

API fmi3Status fmi3DoStep(void *instance, double now, double step, bool no_going_back, bool *needs_event, bool *ends, bool *early,
                          double *reached) {
  Bench *b = instance;
  *needs_event = *ends = *early = false;
  *reached = b->time;
  if (b->tripped) return refuse(b, "%s has tripped, so there is no step of %g s", "the bench", step);
  double ticks = floor(step / DT_S + 0.5);
  double last_digit = 2.0 * (nextafter(now + step, INFINITY) - (now + step)), share = 0.1 * DT_S;
  if (ticks < 1.0 || fabs(ticks * DT_S - step) > 1e-6 * step + (last_digit < share ? last_digit : share))
    return refuse(b, "%s must be a whole number of samples, got %g s", "a step", step);
  settle(b);
  for (int64_t i = 0; i < (int64_t)ticks; i++) {
    for (int k = 0; k < COMMANDS; k++)
      for (int j = 0; j < commands[k].count; j++) b->w[commands[k].places[j]] = b->commands[k];
    run(b, CUT, ROWS);
    b->tick++;
    const char *reason = tripped(b);
    if (reason) {
      b->tripped = *ends = true;
      b->time = *reached = now + (double)(i + 1) * DT_S;
      if (b->log) b->log(b->environment, WARNING, "logStatusWarning", reason);
      return OK;
    }
    begin(b);
  }
  b->time = *reached = now + step;
  return OK;
}

API fmi3Status fmi3GetFMUState(void *b, void **state) {
  if (!*state && !(*state = malloc(sizeof(Bench)))) return ERROR;
  memcpy(*state, b, sizeof(Bench));
  return OK;
}
API fmi3Status fmi3SetFMUState(void *instance, void *state) {
  Bench *b = instance;
  void *environment = b->environment;
  Log *log = b->log;
  memcpy(b, state, sizeof *b);
  b->environment = environment;
  b->log = log;
  return OK;
}
API fmi3Status fmi3FreeFMUState(void *b, void **state) {
  free(*state);
  *state = NULL;
  return OK;
}
API fmi3Status fmi3SerializedFMUStateSize(void *b, void *state, size_t *size) {
  *size = sizeof(Bench);
  return OK;
}
API fmi3Status fmi3SerializeFMUState(void *b, void *state, uint8_t *bytes, size_t size) {
  if (size != sizeof(Bench)) return ERROR;
  memcpy(bytes, state, size);
  return OK;
}
API fmi3Status fmi3DeserializeFMUState(void *b, const uint8_t *bytes, size_t size, void **state) {
  if (size != sizeof(Bench) || (!*state && !(*state = malloc(size)))) return ERROR;
  memcpy(*state, bytes, size);
  return OK;
}

/* All other functions that an FMU must have; this one has no variables or modes for them. */
#define ABSENT(name) API fmi3Status fmi3##name() { return ERROR; }
API void *fmi3InstantiateModelExchange() { return NULL; }
API void *fmi3InstantiateScheduledExecution() { return NULL; }
#define OF_TYPE(name) ABSENT(Get##name) ABSENT(Set##name)
OF_TYPE(Float32) OF_TYPE(Int8) OF_TYPE(UInt8) OF_TYPE(Int16) OF_TYPE(UInt16) OF_TYPE(Int32) OF_TYPE(UInt32) OF_TYPE(Int64)
OF_TYPE(UInt64) OF_TYPE(Boolean) OF_TYPE(String) OF_TYPE(Binary) OF_TYPE(Clock) OF_TYPE(IntervalDecimal)
OF_TYPE(IntervalFraction) OF_TYPE(ShiftDecimal) OF_TYPE(ShiftFraction)
ABSENT(EnterEventMode) ABSENT(EnterConfigurationMode) ABSENT(ExitConfigurationMode) ABSENT(EnterContinuousTimeMode)
ABSENT(EnterStepMode) ABSENT(GetNumberOfVariableDependencies) ABSENT(GetVariableDependencies) ABSENT(GetDirectionalDerivative)
ABSENT(GetAdjointDerivative) ABSENT(EvaluateDiscreteStates) ABSENT(UpdateDiscreteStates) ABSENT(CompletedIntegratorStep)
ABSENT(SetTime) ABSENT(SetContinuousStates) ABSENT(GetContinuousStates) ABSENT(GetContinuousStateDerivatives)
ABSENT(GetEventIndicators) ABSENT(GetNominalsOfContinuousStates) ABSENT(GetNumberOfEventIndicators)
ABSENT(GetNumberOfContinuousStates) ABSENT(ActivateModelPartition) ABSENT(GetOutputDerivatives)
