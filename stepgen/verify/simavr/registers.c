/* Hooks on writes to I/O registers: they put right what simavr does not do, and record. */

#include "machine.h"

#include <simavr/sim_core.h>

static unsigned opcode_of(const avr_t *avr)
{
    return avr->flash[avr->pc] | (unsigned)avr->flash[avr->pc + 1] << 8;
}

/* Cycles of the instruction at PC up to and with its I/O access. */
static unsigned access_cycles(const avr_t *avr)
{
    unsigned opcode = opcode_of(avr);
    int one = (opcode & 0xF000) == 0xB000      /* in, out */
              || (opcode & 0xFD00) == 0x9900;  /* sbic, sbis */
    return one ? 1 : 2;                        /* lds, sts, ld, st, sbi, cbi */
}

uint64_t registers_write_edge(const avr_t *avr)
{
    return avr->cycle + access_cycles(avr);
}

uint64_t registers_read_edge(const avr_t *avr)
{
    return avr->cycle + access_cycles(avr) - 1;
}

/* What the chip writes to a register of strobes: sbi and cbi change one bit only there,
 * where simavr reads, modifies and writes the whole. */
static uint8_t strobes(const avr_t *avr, uint8_t value)
{
    unsigned opcode = opcode_of(avr);
    if ((opcode & 0xFF00) == 0x9A00)
        return (uint8_t)(1u << (opcode & 7));
    return (opcode & 0xFF00) == 0x9800 ? 0 : value;
}

static void pass_on(slot *s, uint16_t address, uint8_t value)
{
    avr_t *avr = s->owner->avr;
    if (s->write)
        s->write(avr, address, value, s->write_param);
    else
        avr->data[address] = value;
}

/* PORTx changes, or toggles by way of PINx. */
static void write_port(slot *s, uint16_t address, uint16_t port, uint8_t value)
{
    uint64_t edge = registers_write_edge(s->owner->avr);
    outputs_catch_up(s->owner, edge);
    pass_on(s, address, value);
    outputs_settle(s->owner, port, edge);
}

static void write_direction(slot *s, uint16_t changed, uint8_t value)
{
    avr_t *avr = s->owner->avr;
    uint8_t before = avr->data[changed];
    pass_on(s, changed, value);
    if (avr->data[changed] != before)
        machine_record(s->owner, EVENT_PORT, registers_write_edge(avr), changed,
                       avr->data[changed]);
}

static void note_stack(machine *m)
{
    uint16_t sp = _avr_sp_get(m->avr);
    if (sp < m->lowest)
        m->lowest = sp;
    if (sp < m->lowest_ever)
        m->lowest_ever = sp;
}

/* A prologue writes SPH with out, then SPL: between them SP means nothing. Pushes and
 * calls set SPL, then SPH. */
static void write_stack_pointer(slot *s, uint16_t address, uint8_t value)
{
    machine *m = s->owner;
    m->avr->data[address] = value;
    int by_out = !m->entering && (opcode_of(m->avr) & 0xF800) == 0xB800;
    if (by_out == (s->role == ROLE_SPL))
        note_stack(m);
}

static void write_mark(machine *m, uint16_t address, uint8_t value)
{
    machine_record(m, EVENT_MARK, registers_write_edge(m->avr), address, value);
    if (value != m->wanted_mark)
        return;
    m->marked = m->stop = 1;
    m->avr->run_cycle_count = 1; /* return after this instruction */
}

/* GTCCR: PSRSYNC restarts the prescaler that the 16-bit timers share, PSRASY that of timer 2. */
static void write_prescaler(machine *m, uint8_t value)
{
    if (value & 0x80)
        machine_fail(m, "GTCCR.TSM was set, which is not simulated");
    uint64_t edge = registers_write_edge(m->avr);
    for (unsigned i = 0; i < m->facts->timer_count; i++)
        if (value & m->timers[i].facts->restart)
            timer_restart(&m->timers[i], edge);
}

static void act(slot *s, uint16_t address, uint8_t value)
{
    machine *m = s->owner;
    switch (s->role) {
    case ROLE_PIN:
        write_port(s, address, (uint16_t)(address + 2), strobes(m->avr, value));
        break;
    case ROLE_DDR:
        write_direction(s, address, value);
        break;
    case ROLE_PORT:
        write_port(s, address, address, value);
        break;
    case ROLE_FLAGS:
        pass_on(s, address, strobes(m->avr, value));
        break;
    case ROLE_TIMER:
        if (address == s->timer->facts->tifr)
            value = strobes(m->avr, value);
        timer_write(s->timer, address, value, registers_write_edge(m->avr));
        break;
    case ROLE_SPL:
    case ROLE_SPH:
        write_stack_pointer(s, address, value);
        break;
    case ROLE_MARK:
        pass_on(s, address, value);
        write_mark(m, address, value);
        break;
    case ROLE_PRESCALER:
        pass_on(s, address, value);
        write_prescaler(m, value);
        break;
    case ROLE_DATA:
        serial_transmit(m, value, registers_write_edge(m->avr));
        break;
    case ROLE_CONTROL:
        pass_on(s, address, value);
        serial_settle(m);
        break;
    case ROLE_STATUS:
        serial_status(m, value);
        break;
    case ROLE_USB:
        usb_write(m, address, value);
        break;
    case ROLE_WATCHDOG:
        watchdog_write(m, value, registers_write_edge(m->avr));
        break;
    default:
        pass_on(s, address, value);
    }
}

static void on_write(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    slot *s = param;
    act(s, address, value);
    if (s->enables)
        machine_attend(s->owner);
    if (s->watched)
        machine_record(s->owner, EVENT_REGISTER, registers_write_edge(avr), address, value);
}

static uint8_t on_timer_read(avr_t *avr, avr_io_addr_t address, void *param)
{
    slot *s = param;
    return timer_read(s->timer, address, registers_read_edge(avr));
}

/* simavr shows PORTx on a pin that a compare unit drives. */
static uint8_t on_pin_read(avr_t *avr, avr_io_addr_t address, void *param)
{
    slot *s = param;
    uint8_t levels = s->read ? s->read(avr, address, s->read_param) : avr->data[address];
    uint16_t port = (uint16_t)(address + 2);
    uint8_t driven = outputs_driven(s->owner, port) & avr->data[address + 1];
    uint8_t shown = outputs_show(s->owner, port, registers_read_edge(avr));
    return (uint8_t)((levels & ~driven) | (shown & driven));
}

/* Put our hook before simavr's, once. */
void registers_hook(machine *m, uint16_t address)
{
    slot *s = &m->slots[AVR_DATA_TO_IO(address)];
    if (s->owner)
        return;
    avr_t *avr = m->avr;
    s->owner = m;
    s->write = avr->io[AVR_DATA_TO_IO(address)].w.c;
    s->write_param = avr->io[AVR_DATA_TO_IO(address)].w.param;
    avr->io[AVR_DATA_TO_IO(address)].w.c = on_write;
    avr->io[AVR_DATA_TO_IO(address)].w.param = s;
}

static slot *take(machine *m, uint16_t address, role as)
{
    registers_hook(m, address);
    slot *s = &m->slots[AVR_DATA_TO_IO(address)];
    s->role = as;
    return s;
}

/* Its reads are *read*'s; of what is stored if that is NULL. */
void registers_take_usb(machine *m, uint16_t address, avr_io_read_t read)
{
    take(m, address, ROLE_USB);
    m->avr->io[AVR_DATA_TO_IO(address)].r.c = read;
    m->avr->io[AVR_DATA_TO_IO(address)].r.param = m;
}

static void take_timer(machine *m, timer *t)
{
    for (uint16_t address = 32; address < MAX_IOs + 32; address++) {
        if (!timer_owns(t, address))
            continue;
        slot *s = take(m, address, ROLE_TIMER);
        s->timer = t;
        m->avr->io[AVR_DATA_TO_IO(address)].r.c = on_timer_read;
        m->avr->io[AVR_DATA_TO_IO(address)].r.param = s;
    }
}

static void take_pins(machine *m, uint16_t address)
{
    slot *s = take(m, address, ROLE_PIN);
    s->read = m->avr->io[AVR_DATA_TO_IO(address)].r.c;
    s->read_param = m->avr->io[AVR_DATA_TO_IO(address)].r.param;
    m->avr->io[AVR_DATA_TO_IO(address)].r.c = on_pin_read;
    m->avr->io[AVR_DATA_TO_IO(address)].r.param = s;
}

void registers_install(machine *m)
{
    static const uint16_t FLAGS[] = {0x35 /* TIFR0 */, 0x3B /* PCIFR */, 0x3C /* EIFR */};
    const mcu_facts *facts = m->facts;
    for (unsigned i = 0; facts->ports[i]; i++) {
        take_pins(m, facts->pin_address[i]);
        take(m, (uint16_t)(facts->pin_address[i] + 1), ROLE_DDR);
        take(m, (uint16_t)(facts->pin_address[i] + 2), ROLE_PORT);
    }
    for (unsigned i = 0; i < sizeof FLAGS / sizeof FLAGS[0]; i++)
        take(m, FLAGS[i], ROLE_FLAGS);
    take(m, (uint16_t)(facts->usart.base + UDR), ROLE_DATA);
    take(m, (uint16_t)(facts->usart.base + UCSRA), ROLE_STATUS);
    take(m, (uint16_t)(facts->usart.base + UCSRB), ROLE_CONTROL);
    take(m, ADDRESS_SPL, ROLE_SPL);
    take(m, ADDRESS_SPH, ROLE_SPH);
    take(m, ADDRESS_EEDR, ROLE_MARK);
    take(m, ADDRESS_GTCCR, ROLE_PRESCALER);
    take(m, ADDRESS_WDTCSR, ROLE_WATCHDOG);
    for (unsigned i = 0; i < facts->timer_count; i++) {
        timer_install(&m->timers[i], m, &facts->timers[i]);
        take_timer(m, &m->timers[i]);
    }
    for (unsigned i = 0; i < m->vector_count; i++) {
        uint16_t address = m->vectors[i]->enable.reg;
        if (!address)
            continue;
        registers_hook(m, address);
        m->slots[AVR_DATA_TO_IO(address)].enables = 1;
    }
}
