/* Events in one reserved region of memory that never moves, so that Python may look at
 * it without copying; pages become real only when they are written. */

#ifndef STEPGEN_RECORDER_H
#define STEPGEN_RECORDER_H

#include <stdint.h>

#include "harness.h"

#define RECORDER_CAPACITY (UINT64_C(1) << 26) /* 64 Mi events, 2 GiB of address space */

typedef struct {
    event *events;
    uint64_t count;
} recorder;

event *recorder_map(void);

/* The next free record, zeroed but for cycle, kind, source and value; NULL when full. */
event *recorder_add(recorder *r, uint16_t kind, uint64_t cycle, uint16_t source, uint32_t value);

#endif
