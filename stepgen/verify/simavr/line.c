#include "line.h"

#include <stdlib.h>
#include <string.h>

uint32_t line_waiting(const line *l)
{
    return l->size - l->next;
}

const uint8_t *line_next(const line *l)
{
    return l->bytes + l->next;
}

int line_add(line *l, const uint8_t *bytes, uint32_t size)
{
    uint32_t waiting = line_waiting(l);
    uint8_t *all = malloc(waiting + size + 1u);
    if (!all)
        return 0;
    if (waiting)
        memcpy(all, line_next(l), waiting);
    memcpy(all + waiting, bytes, size);
    free(l->bytes);
    *l = (line){.bytes = all, .size = waiting + size};
    return 1;
}
