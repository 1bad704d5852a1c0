/* The chip: made from simavr's parts, and made again by each reset. */

#include <simavr/avr_extint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "machine.h"

static void log_to_machine(avr_t *avr, const int level, const char *format, va_list arguments)
{
    machine *m = avr ? avr->custom.data : NULL;
    if (!m || level > LOG_ERROR || m->error[0])
        return;
    vsnprintf(m->error, sizeof m->error, format, arguments);
    m->stop = 1;
}

static void no_sleep(avr_t *avr, avr_cycle_count_t cycles)
{
    (void)avr, (void)cycles;
}

/* A chip whose clock has counted to *cycle* at the end of its reset, and what the harness makes of
 * it. MCUSR holds *causes*. */
static void start(machine *m, avr_t *avr, uint64_t cycle, uint8_t causes)
{
    m->avr = avr;
    avr->custom.data = m;
    avr->cycle = cycle;
    avr->sleep = no_sleep;
    avr->data[ADDRESS_MCUSR] = causes;
    m->lowest = avr->ramend;
    interrupts_install(m);
    registers_install(m);
    serial_install(m);
    usb_install(m);
    watchdog_install(m);
    for (uint8_t number = 0; number < EXTINT_COUNT; number++)
        avr_extint_set_strict_lvl_trig(avr, number, 0); /* else a low INTn pin is polled each cycle */
}

static avr_t *make_chip(const char *mcu, uint32_t f_cpu_hz)
{
    avr_t *avr = avr_make_mcu_by_name(mcu);
    if (avr) {
        avr_init(avr);
        avr->frequency = f_cpu_hz;
    }
    return avr;
}

static void discard(avr_t *avr)
{
    avr_terminate(avr);
    free(avr);
}

machine *machine_new(const char *mcu, uint32_t f_cpu_hz, const uint8_t *code, uint32_t size)
{
    enum { POWER_ON = 1 };
    avr_global_logger_set(log_to_machine);
    const mcu_facts *facts = mcu_find(mcu);
    avr_t *avr = facts ? make_chip(mcu, f_cpu_hz) : NULL;
    machine *m = avr ? calloc(1, sizeof *m) : NULL;
    if (!m)
        return NULL;
    m->facts = facts;
    m->wanted_mark = -1;
    m->lowest_ever = avr->ramend;
    start(m, avr, 0, POWER_ON);
    if (size > avr->flashend + 1)
        machine_fail(m, "the program has %u bytes, the flash %u", size, avr->flashend + 1);
    else
        avr_loadcode(avr, (uint8_t *)code, size, 0);
    avr->codeend = size;
    return m;
}

/* Each pin is an input now, without a pull-up. */
static void let_go(machine *m)
{
    for (unsigned i = 0; m->facts->ports[i]; i++)
        for (unsigned offset = 1; offset <= 2; offset++) { /* DDRx and PORTx */
            uint16_t address = (uint16_t)(m->facts->pin_address[i] + offset);
            if (offset == 2 ? m->shown[i] : m->avr->data[address])
                machine_record(m, EVENT_PORT, m->avr->cycle, address, 0);
        }
}

/* Registers have their initial values, RAM and flash are as they were. MCUSR gets the bit *cause*. */
void machine_reset(machine *m, int cause)
{
    avr_t *before = m->avr, *after = make_chip(before->mmcu, before->frequency);
    if (!after) {
        machine_fail(m, "no memory for a reset");
        return;
    }
    uint64_t cycle = before->cycle;
    uint8_t causes = (uint8_t)(before->data[ADDRESS_MCUSR] | cause);
    let_go(m);
    machine_record(m, EVENT_RESET, cycle, ADDRESS_MCUSR, causes);
    memcpy(after->flash, before->flash, before->flashend + 1u);
    after->codeend = before->codeend;
    memcpy(after->data + before->ioend + 1, before->data + before->ioend + 1,
           (size_t)(before->ramend - before->ioend));
    discard(before); /* m->dog is one of its parts */
    machine old = *m;
    *m = (machine){
        .facts = old.facts,
        .recorder = old.recorder,
        .lowest_ever = old.lowest_ever,
        .serial = old.serial,
        .serial_lost = old.serial_lost,
        .host.line = old.host.line,
        .until = old.until,
        .stop = old.stop,
        .wanted_mark = old.wanted_mark,
        .marked = old.marked,
        .fine = old.fine,
        .silent = old.silent,
    };
    memcpy(m->isr_stack, old.isr_stack, sizeof m->isr_stack);
    memcpy(m->error, old.error, sizeof m->error);
    start(m, after, cycle, causes);
    for (unsigned i = 0; i < MAX_IOs; i++)
        if (old.slots[i].watched)
            machine_watch(m, (uint16_t)(i + 32));
}

void machine_free(machine *m)
{
    discard(m->avr);
    free(m->serial.bytes);
    free(m->host.line.bytes);
    free(m);
}
