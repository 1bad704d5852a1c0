/* The watchdog in its system reset mode, in place of simavr's own, which leaves the reset to whoever
 * runs it; its interrupt is not simulated. Its oscillator runs at 128 kHz to the tick, where a
 * chip's is some ten per cent off. After a reset the program starts at once: the chip waits for
 * its start-up time first. */

#include <simavr/avr_watchdog.h>
#include <simavr/sim_core.h>

#include "machine.h"

enum { WDIE = 1 << 6, WDP3 = 1 << 5, WDCE = 1 << 4, WDE = 1 << 3, WDP = 7 };
enum { CHANGE_CYCLES = 4, SHORTEST_TICKS = 2048, OSCILLATOR_HZ = 128000 };

static uint8_t *control(const machine *m)
{
    return &m->avr->data[ADDRESS_WDTCSR];
}

/* Table "Watchdog Timer Prescale Select". */
static uint64_t period_cycles(const machine *m)
{
    unsigned select = (*control(m) & WDP) | (*control(m) & WDP3) >> 2;
    return (uint64_t)(SHORTEST_TICKS << select) * m->avr->frequency / OSCILLATOR_HZ;
}

static uint64_t due(const machine *m)
{
    return m->dog_fed + period_cycles(m);
}

static avr_cycle_count_t on_due(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr;
    machine *m = param;
    if (!(*control(m) & WDE))
        return 0;
    if (due(m) > when)
        return due(m);
    m->reset_due = 1;
    return 0;
}

static void schedule(machine *m)
{
    avr_t *avr = m->avr;
    if (*control(m) & WDE)
        avr_cycle_timer_register(avr, due(m) > avr->cycle ? due(m) - avr->cycle : 1, on_due, m);
    else
        avr_cycle_timer_cancel(avr, on_due, m);
}

/* WDE and the prescaler change only within four cycles of a write of WDCE and WDE together; WDE
 * stays set while WDRF is. */
void watchdog_write(machine *m, uint8_t value, uint64_t edge)
{
    uint8_t before = *control(m), locked = WDE | WDP3 | WDP;
    if (value & WDIE)
        machine_fail(m, "the watchdog's interrupt is not simulated");
    if ((value & WDCE) && (value & WDE)) {
        m->dog_open_until = edge + CHANGE_CYCLES;
        value = (uint8_t)(before | WDE);
    } else if (edge > m->dog_open_until) {
        value = (uint8_t)(before | (value & WDE));
    } else {
        m->dog_open_until = 0;
    }
    if (m->avr->data[ADDRESS_MCUSR] & WDRF_MASK)
        value |= WDE;
    if (!(before & WDE))
        m->dog_fed = edge;
    *control(m) = value & locked;
    schedule(m);
}

/* The instruction WDR, of one cycle. */
static int on_request(avr_io_t *io, uint32_t request, void *param)
{
    (void)param;
    if (request != AVR_IOCTL_WATCHDOG_RESET)
        return -1;
    machine *m = io->avr->custom.data;
    m->dog_fed = m->avr->cycle + 1;
    return 0;
}

/* On after its own reset, with the shortest time. */
void watchdog_install(machine *m)
{
    m->dog = (avr_io_t){.kind = "watchdog of stepgen", .ioctl = on_request};
    avr_register_io(m->avr, &m->dog); /* it is asked before simavr's */
    m->dog_fed = m->avr->cycle;
    if (m->avr->data[ADDRESS_MCUSR] & WDRF_MASK)
        *control(m) = WDE;
    schedule(m);
}
