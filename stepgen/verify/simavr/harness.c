#include "harness.h"

#include <simavr/avr_ioport.h>
#include <simavr/sim_core.h>
#include <stdio.h>

#include "machine.h"

enum { SE = 1, SM = 0x0E };
static const avr_cycle_count_t UNLIMITED = 1000000;

void machine_fail(machine *m, const char *format, ...)
{
    va_list arguments;
    if (m->error[0])
        return;
    va_start(arguments, format);
    vsnprintf(m->error, sizeof m->error, format, arguments);
    va_end(arguments);
    m->stop = 1;
    m->avr->run_cycle_count = 1;
}

event *machine_record(machine *m, uint16_t kind, uint64_t cycle, uint16_t source, uint32_t value)
{
    if (m->silent)
        return NULL;
    event *e = recorder_add(&m->recorder, kind, cycle, source, value);
    if (!e)
        machine_fail(m, "too many events: call clear_events() now and then");
    return e;
}

void machine_attend(machine *m)
{
    if (m->avr->sreg[S_I] && !m->avr->interrupt_state)
        m->avr->interrupt_state = 1;
}

const char *machine_error(const machine *m)
{
    return m->error;
}

int machine_watch(machine *m, uint16_t address)
{
    if (address < 32 || address >= MAX_IOs + 32 || address > m->avr->ioend)
        return 0;
    registers_hook(m, address);
    m->slots[AVR_DATA_TO_IO(address)].watched = 1;
    return 1;
}

static avr_cycle_count_t on_until(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr, (void)when;
    ((machine *)param)->stop = 1;
    return 0;
}

/* SLEEP does nothing without SE; only idle, where the timers go on, is simulated. */
static void check_sleep(machine *m)
{
    uint8_t control = m->avr->data[ADDRESS_SMCR];
    if (!(control & SE))
        m->avr->state = cpu_Running;
    else if (control & SM)
        machine_fail(m, "a sleep mode other than idle is not simulated");
    else if (!m->avr->sreg[S_I])
        machine_fail(m, "asleep with interrupts off, for ever");
    else
        m->asleep = 1;
}

static void note_masking(machine *m, uint64_t cycle)
{
    int enabled = m->avr->sreg[S_I];
    if (m->depth || enabled == m->was_enabled)
        return;
    machine_record(m, enabled ? EVENT_UNMASKED : EVENT_MASKED, cycle, 0, 0);
    m->was_enabled = enabled;
}

/* One round: instructions up to the next event, then what is due between instructions. */
static avr_cycle_count_t round_of(machine *m, avr_cycle_count_t wait)
{
    avr_t *avr = m->avr;
    if (m->asleep)
        avr->cycle += wait ? wait : 1;
    else
        avr->pc = avr_run_one(avr);
    if (avr->state == cpu_Sleeping && !m->asleep)
        check_sleep(m);
    else if (m->asleep)
        avr->state = cpu_Sleeping;
    else if (avr->state != cpu_Running)
        machine_fail(m, "simavr stopped in state %d", avr->state);
    if (m->fine)
        note_masking(m, avr->cycle);
    avr_cycle_timer_process(avr);
    if (!m->reset_due)
        interrupts_service(m);
    return avr_cycle_timer_process(avr);
}

/* Lets simavr run to where the run ends, or to its next event. */
static avr_cycle_count_t prepare(machine *m)
{
    avr_t *avr = m->avr;
    m->was_enabled = avr->sreg[S_I];
    avr->run_cycle_limit = m->fine ? 1 : UNLIMITED;
    if (!m->stop)
        avr_cycle_timer_register(avr, m->until - avr->cycle, on_until, m);
    return avr_cycle_timer_process(avr);
}

int machine_run(machine *m, uint64_t until, int wanted_mark)
{
    if (m->error[0])
        return RUN_FAILED;
    m->stop = until <= m->avr->cycle;
    m->marked = 0;
    m->wanted_mark = wanted_mark;
    m->until = until;
    avr_cycle_count_t wait = prepare(m);
    while (!m->stop) {
        wait = round_of(m, wait);
        if (m->reset_due) {
            machine_reset(m, WDRF_MASK);
            wait = prepare(m);
        }
    }
    avr_cycle_timer_cancel(m->avr, on_until, m);
    outputs_catch_up(m, m->avr->cycle);
    return m->error[0] ? RUN_FAILED : m->marked ? RUN_MARKED : RUN_REACHED;
}

/* RUN_MARKED once the byte at *address* is 0: it is looked at each *step* cycles. */
int machine_run_to_zero(machine *m, uint16_t address, uint64_t step, uint64_t until)
{
    while (m->avr->data[address]) {
        if (m->avr->cycle > until)
            return RUN_REACHED;
        if (machine_run(m, m->avr->cycle + step, -1) == RUN_FAILED)
            return RUN_FAILED;
    }
    return RUN_MARKED;
}

uint64_t machine_cycle(const machine *m)
{
    return m->avr->cycle;
}

uint32_t machine_pc(const machine *m)
{
    return m->avr->pc;
}

void machine_set_fine(machine *m, int on)
{
    m->fine = on;
}

void machine_set_recording(machine *m, int on)
{
    m->silent = !on;
}

uint32_t machine_ram_end(const machine *m)
{
    return m->avr->ramend;
}

uint8_t *machine_data(machine *m)
{
    return m->avr->data;
}

uint8_t machine_register(machine *m, uint16_t address)
{
    avr_t *avr = m->avr;
    if (address == ADDRESS_SREG)
        READ_SREG_INTO(avr, avr->data[ADDRESS_SREG]);
    slot *s = address >= 32 && address < MAX_IOs + 32 ? &m->slots[AVR_DATA_TO_IO(address)] : NULL;
    if (s && s->role == ROLE_TIMER)
        return timer_peek(s->timer, address, avr->cycle);
    if (s && s->role == ROLE_PIN) {
        uint8_t out = avr->data[address + 1];
        uint8_t levels = outputs_show(m, (uint16_t)(address + 2), avr->cycle);
        return (uint8_t)((avr->data[address] & ~out) | (levels & out));
    }
    return avr->data[address];
}

int machine_drive_pin(machine *m, uint16_t pin_address, int bit, int level)
{
    for (unsigned i = 0; m->facts->ports[i]; i++) {
        if (m->facts->pin_address[i] != pin_address)
            continue;
        /* simavr takes the level of an input that it is not told of from the pull-up, at each
           write of the port. */
        char letter = m->facts->ports[i];
        avr_ioport_external_t *driven = &m->driven[i];
        driven->name = (unsigned char)letter;
        driven->mask |= 1 << bit;
        driven->value = level ? driven->value | 1 << bit : driven->value & ~(1 << bit);
        avr_ioctl(m->avr, AVR_IOCTL_IOPORT_SET_EXTERNAL(letter), driven);
        uint32_t port = AVR_IOCTL_IOPORT_GETIRQ(letter);
        avr_raise_irq(avr_io_getirq(m->avr, port, bit), (uint32_t)level);
        return 1;
    }
    return 0;
}

uint32_t machine_isr_stack(const machine *m, int vector)
{
    return m->isr_stack[vector & (MAX_VECTORS - 1)];
}

uint32_t machine_stack_deepest(const machine *m)
{
    return (uint32_t)(m->avr->ramend - m->lowest_ever);
}

event *events_map(machine *m)
{
    return m->recorder.events = recorder_map();
}

uint64_t events_count(const machine *m)
{
    return m->recorder.count;
}

void events_clear(machine *m)
{
    m->recorder.count = 0;
}
