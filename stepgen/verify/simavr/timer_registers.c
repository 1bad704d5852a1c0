/* The registers of a timer, as the CPU sees them. */

#include <simavr/avr_timer.h>
#include <string.h>

#include "machine.h"
#include "timer.h"

/* Offsets from TCCRnA; OCRnx follow each other, high bytes are odd. */
enum { TCCRA = 0, TCCRB = 1, TCCRC = 2, TCNTL = 4, TCNTH = 5, ICRL = 6, ICRH = 7, OCRAL = 8, LAST = 13 };

/* The same of timer 2, whose registers follow each other. */
enum { SMALL_TCNT = 2, SMALL_OCRA = 3, SMALL_LAST = 4 };

static void write_compare(timer *t, unsigned channel, uint16_t value)
{
    t->buffer[channel] = value;
    if (!timer_is_buffered(t))
        t->active[channel] = value;
}

/* The strobes FOCnA, FOCnB and FOCnC, bits 7 to 5, as bits 0 to 2. */
static unsigned strobed(uint8_t value)
{
    return (value >> 7 & 1u) | (value >> 5 & 2u) | (value >> 3 & 4u);
}

static void write_enables(timer *t, uint8_t value, uint64_t edge)
{
    machine *m = t->owner;
    uint8_t fresh = (uint8_t)(value & ~m->avr->data[t->facts->timsk]);
    m->avr->data[t->facts->timsk] = value;
    for (unsigned bit = 0; bit < FLAG_BITS; bit++)
        if (fresh & (1u << bit))
            m->enabled_at[t->facts->vector[bit]] = edge;
    machine_attend(m);
}

static void write_small(timer *t, unsigned offset, uint8_t value)
{
    if (offset >= SMALL_OCRA) {
        write_compare(t, offset - SMALL_OCRA, value);
    } else {
        t->count = value;
        t->blocked = 1;
    }
}

static void write_block(timer *t, unsigned offset, uint8_t value, uint64_t edge)
{
    uint16_t both = (uint16_t)(t->temp << 8 | value);
    if (offset == TCCRA) {
        t->control_a = value;
    } else if (offset == TCCRB) {
        t->control_b = t->facts->is_small ? value & 0x3F : value;
        if (t->facts->is_small)
            timer_force(t, strobed(value) & 3u, edge);
    } else if (t->facts->is_small) {
        write_small(t, offset, value);
    } else if (offset == TCCRC) {
        timer_force(t, strobed(value), edge);
    } else if (offset == TCNTL) {
        t->count = both;
        t->blocked = 1;
    } else if (offset == ICRL) {
        if (timer_top_is_icr(t)) /* read-only in the other modes */
            t->capture = both;
    } else if (offset >= OCRAL && !(offset & 1)) {
        write_compare(t, (offset - OCRAL) / 2, both);
    } else if (offset >= TCNTH) {
        t->temp = value;
    }
    if (!timer_turns(t))
        t->down = 0;
}

void timer_write(timer *t, uint16_t address, uint8_t value, uint64_t edge)
{
    timer_sync(t, edge);
    if (address == t->facts->tifr)
        t->owner->avr->data[address] &= (uint8_t)~value;
    else if (address == t->facts->timsk)
        write_enables(t, value, edge);
    else
        write_block(t, address - t->facts->base, value, edge);
    for (unsigned i = 0; i < t->facts->channels; i++) /* they may drive their pins from now on */
        outputs_settle(t->owner, t->facts->output[i].port, edge);
    timer_schedule(t);
}

uint8_t timer_peek(timer *t, uint16_t address, uint64_t edge)
{
    timer_sync(t, edge);
    if (address == t->facts->tifr || address == t->facts->timsk)
        return t->owner->avr->data[address];
    unsigned offset = address - t->facts->base, shift = offset & 1 ? 8 : 0;
    if (t->facts->is_small && offset >= SMALL_TCNT)
        return (uint8_t)(offset == SMALL_TCNT ? t->count : t->buffer[offset - SMALL_OCRA]);
    switch (offset) {
    case TCCRA:
        return t->control_a;
    case TCCRB:
        return t->control_b;
    case TCNTL:
    case TCNTH:
        return (uint8_t)(t->count >> shift);
    case ICRL:
    case ICRH:
        return (uint8_t)(t->capture >> shift);
    default:
        return offset < OCRAL ? 0 : (uint8_t)(t->buffer[(offset - OCRAL) / 2] >> shift);
    }
}

uint8_t timer_read(timer *t, uint16_t address, uint64_t edge)
{
    unsigned offset = address - t->facts->base;
    if (t->facts->is_small)
        return timer_peek(t, address, edge);
    int latched = address >= t->facts->base && (offset == TCNTH || offset == ICRH);
    uint8_t value = latched ? t->temp : timer_peek(t, address, edge);
    if (offset == TCNTL || offset == ICRL)
        t->temp = timer_peek(t, (uint16_t)(address + 1), edge);
    return value;
}

int timer_owns(const timer *t, uint16_t address)
{
    const timer_facts *f = t->facts;
    return address == f->timsk || address == f->tifr ||
           (address >= f->base && address <= f->base + (f->is_small ? SMALL_LAST : LAST));
}

void timer_install(timer *t, machine *owner, const timer_facts *facts)
{
    uint64_t now = owner->avr->cycle; /* of the reset */
    *t = (timer){.owner = owner, .facts = facts, .synced = now, .prescaler_origin = now};
    if (facts->is_small)
        return;
    for (avr_io_t *io = owner->avr->io_port; io; io = io->next) {
        avr_timer_t *theirs = (avr_timer_t *)io;
        /* simavr still follows its input capture pin: this makes it think ICRn is TOP. */
        if (!strcmp(io->kind, "timer") && theirs->name == facts->name)
            theirs->mode.top = avr_timer_wgm_reg_icr;
    }
}
