#include "timer.h"

#include <string.h>

#include "machine.h"

enum { FIXED, BY_OCRA, BY_ICR };                   /* where TOP comes from */
enum { NORMAL, CTC, FAST, PHASE, PHASE_FREQUENCY }; /* how it counts */

typedef struct {
    uint8_t kind, top;
    uint16_t fixed;
} mode;

static const mode MODES[16] = {
    /* Table "Waveform Generation Mode Bit Description"; 13 is reserved. */
    {NORMAL, FIXED, 0xFFFF},      {PHASE, FIXED, 0x00FF},       {PHASE, FIXED, 0x01FF},
    {PHASE, FIXED, 0x03FF},       {CTC, BY_OCRA, 0},            {FAST, FIXED, 0x00FF},
    {FAST, FIXED, 0x01FF},        {FAST, FIXED, 0x03FF},        {PHASE_FREQUENCY, BY_ICR, 0},
    {PHASE_FREQUENCY, BY_OCRA, 0}, {PHASE, BY_ICR, 0},          {PHASE, BY_OCRA, 0},
    {CTC, BY_ICR, 0},             {NORMAL, FIXED, 0xFFFF},      {FAST, BY_ICR, 0},
    {FAST, BY_OCRA, 0},
};

static const mode SMALL_MODES[8] = {
    /* The same table of timer 2; 4 and 6 are reserved. */
    {NORMAL, FIXED, 0xFF}, {PHASE, FIXED, 0xFF},  {CTC, BY_OCRA, 0},     {FAST, FIXED, 0xFF},
    {NORMAL, FIXED, 0xFF}, {PHASE, BY_OCRA, 0},   {NORMAL, FIXED, 0xFF}, {FAST, BY_OCRA, 0},
};

static const mode *mode_of(const timer *t)
{
    if (t->facts->is_small)
        return &SMALL_MODES[(t->control_b >> 1 & 0x04) | (t->control_a & 0x03)];
    return &MODES[(t->control_b >> 1 & 0x0C) | (t->control_a & 0x03)];
}

static uint32_t max_of(const timer *t)
{
    return t->facts->is_small ? 0xFF : 0xFFFF;
}

int timer_top_is_icr(const timer *t)
{
    return mode_of(t)->top == BY_ICR;
}

int timer_is_buffered(const timer *t)
{
    return mode_of(t)->kind >= FAST;
}

int timer_turns(const timer *t)
{
    return mode_of(t)->kind >= PHASE;
}

static uint32_t prescaler_of(const timer *t)
{
    return t->facts->prescaler[t->control_b & 7];
}

static uint32_t top_of(const timer *t)
{
    switch (mode_of(t)->top) {
    case BY_OCRA:
        return t->active[0];
    case BY_ICR:
        return t->capture;
    default:
        return mode_of(t)->fixed;
    }
}

/* The number of ticks at the edges 1 .. edge. */
static uint64_t ticks_until(const timer *t, uint64_t edge, uint32_t prescaler)
{
    return (edge - t->prescaler_origin) / prescaler;
}

static uint64_t first_tick_after(const timer *t, uint64_t edge, uint32_t prescaler)
{
    return t->prescaler_origin + (ticks_until(t, edge, prescaler) + 1) * prescaler;
}

static void set_flag(timer *t, unsigned bit, uint64_t edge)
{
    machine *m = t->owner;
    uint8_t *data = m->avr->data;
    uint8_t mask = (uint8_t)(1u << bit), vector = t->facts->vector[bit];
    int already = (data[t->facts->tifr] & mask) != 0;
    if (!already)
        m->raised_at[vector] = edge;
    data[t->facts->tifr] |= mask;
    if (data[t->facts->timsk] & mask) {
        machine_record(m, EVENT_RAISE, edge, vector, (uint32_t)already);
        machine_attend(m);
    }
}

static unsigned action_of(const timer *t, unsigned channel)
{
    return t->control_a >> (6 - 2 * channel) & 3; /* COMnx */
}

int timer_drives(const timer *t, unsigned channel)
{
    return t->facts->output[channel].port && action_of(t, channel) && mode_of(t)->kind <= CTC;
}

static void change_output(timer *t, unsigned channel, uint64_t edge)
{
    enum { TOGGLE = 1, CLEAR, SET };
    uint8_t bit = (uint8_t)(1u << channel);
    if (!timer_drives(t, channel))
        return;
    switch (action_of(t, channel)) {
    case TOGGLE:
        t->output ^= bit;
        break;
    case CLEAR:
        t->output &= (uint8_t)~bit;
        break;
    case SET:
        t->output |= bit;
        break;
    }
    outputs_settle(t->owner, t->facts->output[channel].port, edge);
}

void timer_force(timer *t, unsigned channels, uint64_t edge)
{
    for (unsigned i = 0; i < t->facts->channels; i++)
        if (channels & (1u << i))
            change_output(t, i, edge);
}

static void load_buffers(timer *t)
{
    memcpy(t->active, t->buffer, sizeof t->active);
}

/* One tick of a mode that counts up only. */
static void tick_up(timer *t, uint64_t edge, int at_top)
{
    const mode *m = mode_of(t);
    int fast = m->kind == FAST, at_max = t->count == max_of(t);
    if (at_top && m->top == BY_ICR)
        set_flag(t, FLAG_ICF, edge);
    if (fast ? at_top : at_max)
        set_flag(t, FLAG_TOV, edge);
    if (at_top || at_max) {
        t->count = 0;
        if (fast)
            load_buffers(t);
    } else {
        t->count++;
    }
}

/* One tick of a mode that counts up to TOP and down to BOTTOM. */
static void tick_both_ways(timer *t, uint64_t edge, int at_top)
{
    const mode *m = mode_of(t);
    uint32_t top = top_of(t);
    if (t->down && t->count == 0) {
        set_flag(t, FLAG_TOV, edge);
        if (m->kind == PHASE_FREQUENCY)
            load_buffers(t);
        t->down = 0;
        t->count = top ? 1 : 0;
    } else if (t->down) {
        t->count--;
    } else if (at_top) {
        if (m->top == BY_ICR)
            set_flag(t, FLAG_ICF, edge);
        t->down = 1;
        t->count = (uint16_t)(top ? top - 1 : 0);
        if (m->kind == PHASE)
            load_buffers(t);
    } else {
        t->count = (uint16_t)((t->count + 1) & max_of(t)); /* beyond TOP: on to MAX and round */
    }
}

static void tick(timer *t, uint64_t edge)
{
    const mode *m = mode_of(t);
    int at_top = t->count == top_of(t);
    if (m->top == BY_OCRA && t->blocked)
        at_top = 0;
    if (m->kind == NORMAL)
        at_top = 0;
    for (unsigned i = 0; i < t->facts->channels; i++)
        if (t->count == t->active[i] && !t->blocked) {
            set_flag(t, FLAG_OCA + i, edge);
            change_output(t, i, edge);
        }
    t->blocked = 0;
    if (m->kind >= PHASE)
        tick_both_ways(t, edge, at_top);
    else
        tick_up(t, edge, at_top);
}

void timer_restart(timer *t, uint64_t edge)
{
    timer_sync(t, edge);
    t->prescaler_origin = edge;
    timer_schedule(t);
}

/* Ticks that only count, before one that may set a flag, turn or wrap. Of the compare
 * units only those in *channels* are looked at. */
static uint32_t quiet_ticks(const timer *t, unsigned channels)
{
    uint32_t count = t->count, top = top_of(t);
    uint32_t turn = t->down ? 0 : count <= top ? top : max_of(t);
    uint32_t quiet = t->down ? count : turn - count;
    for (unsigned i = 0; i < t->facts->channels; i++) {
        uint32_t match = t->active[i];
        if (!(channels & (1u << i)) || (t->down ? match > count : match < count))
            continue;
        uint32_t distance = t->down ? count - match : match - count;
        if (distance < quiet)
            quiet = distance;
    }
    return quiet;
}

/* After two laps every flag that can be set is set and the buffers are loaded, so whole
 * laps change nothing: keeps long idle timers cheap. Not with enabled interrupts, whose
 * every RAISE is recorded; those are never far behind. */
static uint64_t skip_laps(const timer *t, uint64_t ticks)
{
    if (t->owner->avr->data[t->facts->timsk])
        return 0;
    for (unsigned i = 0; i < t->facts->channels; i++)
        if (timer_drives(t, i)) /* it may toggle */
            return 0;
    uint32_t top = top_of(t);
    uint64_t lap = mode_of(t)->kind >= PHASE ? 2 * (uint64_t)(top ? top : 1) : top + 1;
    return ticks / lap * lap;
}

void timer_sync(timer *t, uint64_t edge)
{
    uint32_t prescaler = prescaler_of(t);
    if (edge <= t->synced)
        return;
    if (prescaler) {
        uint64_t ticks = ticks_until(t, edge, prescaler) - ticks_until(t, t->synced, prescaler);
        uint64_t next = first_tick_after(t, t->synced, prescaler);
        unsigned laps = 0;
        while (ticks) {
            uint64_t quiet = quiet_ticks(t, ~0u);
            if (quiet > ticks)
                quiet = ticks;
            if (quiet) {
                t->count = (uint16_t)(t->down ? t->count - quiet : t->count + quiet);
                t->blocked = 0;
                ticks -= quiet;
                next += quiet * prescaler;
                continue;
            }
            tick(t, next);
            ticks--;
            next += prescaler;
            if (t->count == 0 && ++laps > 2) {
                uint64_t skipped = skip_laps(t, ticks);
                ticks -= skipped;
                next += skipped * prescaler;
            }
        }
    }
    t->synced = edge;
}

/* The edge of the next tick that may raise an enabled interrupt, or 0. */
static uint64_t next_event(const timer *t)
{
    uint32_t prescaler = prescaler_of(t);
    unsigned enabled = t->owner->avr->data[t->facts->timsk];
    if (!prescaler || !enabled)
        return 0;
    uint64_t quiet = quiet_ticks(t, enabled >> FLAG_OCA);
    return first_tick_after(t, t->synced, prescaler) + quiet * prescaler;
}

static avr_cycle_count_t on_event(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr;
    timer_sync(param, when);
    return next_event(param);
}

void timer_schedule(timer *t)
{
    avr_t *avr = t->owner->avr;
    uint64_t edge = next_event(t);
    if (edge)
        avr_cycle_timer_register(avr, edge > avr->cycle ? edge - avr->cycle : 1, on_event, t);
    else
        avr_cycle_timer_cancel(avr, on_event, t);
}
