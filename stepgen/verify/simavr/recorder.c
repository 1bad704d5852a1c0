#define _GNU_SOURCE

#include "recorder.h"

#include <stddef.h>
#include <sys/mman.h>

event *recorder_map(void)
{
    void *region = mmap(NULL, RECORDER_CAPACITY * sizeof(event), PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return region == MAP_FAILED ? NULL : region;
}

void events_unmap(event *region)
{
    if (region)
        munmap(region, RECORDER_CAPACITY * sizeof(event));
}

event *recorder_add(recorder *r, uint16_t kind, uint64_t cycle, uint16_t source, uint32_t value)
{
    if (!r->events || r->count == RECORDER_CAPACITY)
        return NULL;
    event *e = &r->events[r->count++];
    *e = (event){.cycle = cycle, .value = value, .source = source, .kind = kind};
    return e;
}
