/* What the ports show: PORTx, but for the pins that compare units drive in its place. */

#include "machine.h"

/* Calls for each compare unit whose pin is on *port*, the data address of a PORTx. */
#define EACH_OUTPUT(m, port_address, t, channel)                                                   \
    for (timer *t = (m)->timers; t < (m)->timers + (m)->facts->timer_count; t++)                  \
        for (unsigned channel = 0; channel < t->facts->channels; channel++)                       \
            if (t->facts->output[channel].port == (port_address) && timer_drives(t, channel))

uint8_t outputs_driven(machine *m, uint16_t port)
{
    uint8_t mask = 0;
    EACH_OUTPUT(m, port, t, channel)
        mask |= (uint8_t)(1u << t->facts->output[channel].bit);
    return mask;
}

static uint8_t shown(machine *m, uint16_t port)
{
    uint8_t levels = (uint8_t)(m->avr->data[port] & ~outputs_driven(m, port));
    EACH_OUTPUT(m, port, t, channel)
        if (t->output & (1u << channel))
            levels |= (uint8_t)(1u << t->facts->output[channel].bit);
    return levels;
}

uint8_t outputs_show(machine *m, uint16_t port, uint64_t edge)
{
    outputs_catch_up(m, edge);
    return shown(m, port);
}

void outputs_settle(machine *m, uint16_t port, uint64_t edge)
{
    for (unsigned i = 0; m->facts->ports[i]; i++) {
        if (m->facts->pin_address[i] + 2 != port)
            continue;
        uint8_t now = shown(m, port);
        if (now != m->shown[i])
            machine_record(m, EVENT_PORT, edge, port, now);
        m->shown[i] = now;
    }
}

void outputs_catch_up(machine *m, uint64_t edge)
{
    for (unsigned i = 0; i < m->facts->timer_count; i++)
        for (unsigned channel = 0; channel < m->facts->timers[i].channels; channel++)
            if (timer_drives(&m->timers[i], channel))
                timer_sync(&m->timers[i], edge);
}
