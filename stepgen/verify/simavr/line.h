/* Bytes on their way to the board. */

#ifndef STEPGEN_LINE_H
#define STEPGEN_LINE_H

#include <stdint.h>

typedef struct {
    uint8_t *bytes;
    uint32_t size, next; /* how many there are, and which goes next */
} line;

uint32_t line_waiting(const line *l);
const uint8_t *line_next(const line *l);

/* Add bytes behind those that wait; 0 without memory for them. */
int line_add(line *l, const uint8_t *bytes, uint32_t size);

#endif
