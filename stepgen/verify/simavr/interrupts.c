/* Interrupts as the chip has them: an interrupt is pending while its flag and its enable
 * bit are set, however that came about; after the I flag is set, by whatever instruction,
 * one more instruction runs first; the response takes its cycles. simavr's own queue is
 * not used. */

#include "machine.h"

#include <simavr/sim_core.h>
#include <stddef.h>

static int is_pending(const machine *m, avr_int_vector_t *v)
{
    const avr_t *avr = m->avr;
    if (v == m->usb.general || v == m->usb.endpoint)
        return usb_is_pending(m, v);
    if (!avr_regbit_get((avr_t *)avr, v->enable))
        return 0;
    return v->raised.reg ? avr_regbit_get((avr_t *)avr, v->raised) : v->pending;
}

static avr_int_vector_t *first_pending(machine *m)
{
    for (unsigned i = 0; i < m->vector_count; i++)
        if (is_pending(m, m->vectors[i]))
            return m->vectors[i];
    return NULL;
}

/* simavr queues what it raises; we look at the flags instead. A vector that stays marked
 * as pending would not be raised again. */
static void drop_queue(machine *m)
{
    avr_int_pending_t *queue = &m->avr->interrupts.pending;
    const unsigned size = sizeof queue->buffer / sizeof queue->buffer[0];
    for (; queue->read != queue->write; queue->read = (queue->read + 1) % size)
        if (queue->buffer[queue->read]->raised.reg)
            queue->buffer[queue->read]->pending = 0;
}

static uint64_t latest(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

static void enter(machine *m, avr_int_vector_t *v, unsigned extra_cycles)
{
    avr_t *avr = m->avr;
    avr_int_table_t *table = &avr->interrupts;
    if (m->depth == MAX_DEPTH || table->running_ptr == MAX_DEPTH) {
        machine_fail(m, "more than %d nested interrupts", MAX_DEPTH);
        return;
    }
    event *e = machine_record(m, EVENT_ISR_ENTER, avr->cycle, v->vector, avr->pc);
    if (e) {
        uint64_t since = m->raised_at[v->vector];
        e->since = since;
        e->masked_until = latest(since, latest(m->unmasked_at, m->enabled_at[v->vector]));
    }
    m->frames[m->depth++] = (frame){
        .vector = v->vector,
        .stack_before = _avr_sp_get(avr),
        .lowest_before = m->lowest,
        .entered = avr->cycle,
    };
    m->lowest = _avr_sp_get(avr);
    m->entering = 1;
    _avr_push_addr(avr, avr->pc);
    m->entering = 0;
    avr_sreg_set(avr, S_I, 0);
    avr->pc = (avr_flashaddr_t)v->vector * avr->vector_size;
    table->running[table->running_ptr++] = v;
    avr_raise_irq(v->irq + AVR_INT_IRQ_RUNNING, 1);
    avr_clear_interrupt(avr, v);
    serial_settle(m);
    avr->cycle += 2u + avr->address_size + extra_cycles;
    avr_cycle_timer_process(avr);
}

void interrupts_service(machine *m)
{
    avr_t *avr = m->avr;
    drop_queue(m);
    if (!avr->sreg[S_I]) {
        avr->interrupt_state = 0;
        return;
    }
    if (avr->interrupt_state == -2) { /* just set: one more instruction */
        m->unmasked_at = avr->cycle;
        avr->interrupt_state = -1;
        return;
    }
    if (!avr->interrupt_state && !m->asleep)
        return;
    avr->interrupt_state = 0;
    avr_int_vector_t *v = first_pending(m);
    if (!v)
        return;
    enter(m, v, m->asleep ? 4 : 0);
    m->asleep = 0;
    avr->state = cpu_Running;
}

/* Called by simavr inside RETI, which started at avr->cycle. */
static void on_reti(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq, (void)value;
    machine *m = param;
    avr_t *avr = m->avr;
    if (!m->depth)
        return;
    frame f = m->frames[--m->depth];
    uint32_t used = (uint32_t)(f.stack_before - m->lowest);
    if (used > m->isr_stack[f.vector])
        m->isr_stack[f.vector] = used;
    if (f.lowest_before < m->lowest)
        m->lowest = f.lowest_before;
    uint64_t end = avr->cycle + 2u + avr->address_size;
    event *e = machine_record(m, EVENT_ISR_EXIT, end, f.vector, used);
    if (e)
        e->since = f.entered;
    avr->interrupt_state = -2; /* one more instruction even where I was set already */
}

/* Called when one of simavr's own peripherals raises its flag. */
static void on_raise(avr_irq_t *irq, uint32_t value, void *param)
{
    machine *m = param;
    if (value)
        m->raised_at[(irq->irq >> 8) & (MAX_VECTORS - 1)] = m->avr->cycle;
}

void interrupts_install(machine *m)
{
    avr_int_table_t *table = &m->avr->interrupts;
    for (unsigned i = 0; i < table->vector_count; i++) {
        avr_int_vector_t *v = table->vector[i];
        unsigned at = m->vector_count++;
        for (; at && m->vectors[at - 1]->vector > v->vector; at--)
            m->vectors[at] = m->vectors[at - 1];
        m->vectors[at] = v;
        avr_irq_register_notify(v->irq + AVR_INT_IRQ_PENDING, on_raise, m);
    }
    avr_irq_register_notify(table->irq + AVR_INT_IRQ_RUNNING, on_reti, m);
}
