/* The 16-bit timers of the ATmega328P and ATmega2560, from the chapter "16-bit
 * Timer/Counter with PWM" of their datasheets, and their 8-bit timer 2, from "8-bit
 * Timer/Counter2 with PWM and Asynchronous Operation". They replace simavr's, which differ from
 * the chip in double buffering, prescaler phase, ICRn as TOP and missed compares.
 *
 * Time. A register holds a value from one CPU clock edge to the next; edge c starts CPU
 * cycle c. An instruction of n cycles that starts at c writes at edge c + n and reads what
 * the register holds in its last cycle, c + n - 1. The timer clock ticks at the edges
 * that are multiples of the prescaler since reset, whatever the timer does (the prescaler
 * of the 16-bit timers is shared, timer 2 has its own; both run freely, and GTCCR.PSRSYNC or
 * PSRASY restarts them).
 *
 * At a tick the counter leaves its value for the next one, and flags whose condition was
 * that value are set at this same edge: OCFnx at the edge where TCNTn goes from OCRnx to
 * OCRnx + 1, TOVn where it goes from MAX (normal, CTC) or TOP (fast PWM) to 0. The CPU
 * sees a flag at the first instruction boundary at or after the edge. So the period of
 * CTC and fast PWM is exactly prescaler * (TOP + 1) cycles.
 *
 * A write wins over the tick of its own edge: the count is the value written, and goes on
 * at the next tick. A TIFRn bit cleared at the edge that sets it is clear.
 *
 * TCNTn written: the compare units see no match until the next tick has passed, TOP by
 * OCRnA included; TOP by ICRn is no compare unit and is not blocked.
 *
 * OCRnx: the CPU reads and writes a buffer. In normal and CTC modes the compare unit
 * takes a write at once; in fast PWM it takes the buffer when the counter itself goes
 * to BOTTOM (a TCNTn = 0 by the CPU does not count).
 *
 * OCnx, in normal and CTC modes: it is set, cleared or toggled at the edge that sets the flag, or where
 * FOCnx is written, which sets no flag. While COMnx is 0 it stays, and PORTx drives the pin.
 *
 * Timer 2 has no ICR, no channel C and no TEMP: its registers are single bytes.
 *
 * Left out: compare outputs of the PWM modes, whose pins show PORTx, input capture, external clocks, ASSR, PRR. Phase
 * correct modes count as they should, but set TOVn when leaving BOTTOM. */

#ifndef STEPGEN_TIMER_H
#define STEPGEN_TIMER_H

#include <stdint.h>

#include "mcus.h"

struct machine;

typedef struct {
    struct machine *owner;
    const timer_facts *facts;
    uint8_t control_a, control_b;
    uint8_t temp;         /* the one TEMP byte of the timer */
    uint8_t down;         /* counting down (phase correct modes) */
    uint8_t blocked;      /* TCNTn written, no tick since */
    uint16_t count;       /* TCNTn after all ticks up to and including edge synced */
    uint16_t capture;     /* ICRn */
    uint16_t active[3];   /* what the compare units use */
    uint16_t buffer[3];   /* what the CPU wrote last */
    uint8_t output;       /* OCnx, a bit for each channel */
    uint64_t synced;
    uint64_t prescaler_origin; /* its prescaler was zero at this edge */
} timer;

/* Take the registers of *t* over from simavr. */
void timer_install(timer *t, struct machine *owner, const timer_facts *facts);

/* Let FOCnx act as a match of each channel in *channels*, but for the flag. */
void timer_force(timer *t, unsigned channels, uint64_t edge);

/* Let the counter run up to and including the tick at *edge*, if there is one. */
void timer_sync(timer *t, uint64_t edge);

/* Its prescaler begins anew at *edge*. */
void timer_restart(timer *t, uint64_t edge);

/* Tell simavr when the next interrupt may come; after each change. */
void timer_schedule(timer *t);

/* Its mode: ICRn is TOP; OCRnx are double buffered; it counts up and down. */
int timer_top_is_icr(const timer *t);
int timer_is_buffered(const timer *t);
int timer_turns(const timer *t);

/* Whether the compare unit *channel* drives its pin, and so is not in a PWM mode. */
int timer_drives(const timer *t, unsigned channel);

/* A write that takes effect at *edge*, a read during the cycle that starts at *edge*. */
void timer_write(timer *t, uint16_t address, uint8_t value, uint64_t edge);
uint8_t timer_read(timer *t, uint16_t address, uint64_t edge);

/* The same as a read, without the side effect on TEMP. */
uint8_t timer_peek(timer *t, uint16_t address, uint64_t edge);

/* Whether *address* is a register of *t*. */
int timer_owns(const timer *t, uint16_t address);

#endif
