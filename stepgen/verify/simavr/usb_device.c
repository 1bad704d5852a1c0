/* The USB device controller of the ATmega32U4 (datasheet, chapters 21 and 22) for full speed:
 * endpoint 0, bulk and interrupt endpoints of one or two banks, and their interrupts. A packet
 * passes as a whole; there are no errors on the line, no suspend and no isochronous endpoints.
 * simavr's own model is not used but for the PLL. */

#include <simavr/avr_usb.h>
#include <string.h>

#include "machine.h"

/* Data addresses, from avr-libc's iom32u4.h. */
enum {
    UDCON = 0xE0, UDINT = 0xE1, UDIEN = 0xE2, UDADDR = 0xE3,
    UEINTX = 0xE8, UENUM = 0xE9, UERST = 0xEA, UECONX = 0xEB, UECFG0X = 0xEC, UECFG1X = 0xED,
    UESTA0X = 0xEE, UESTA1X = 0xEF, UEIENX = 0xF0, UEDATX = 0xF1, UEBCLX = 0xF2, UEBCHX = 0xF3,
    UEINT = 0xF4,
};

/* Bits of theirs. */
enum { DETACH = 1, EORSTI = 1 << 3, ADDEN = 1 << 7 };
enum { TXINI = 1, STALLEDI = 2, RXOUTI = 4, RXSTPI = 8, NAKOUTI = 16, RWAL = 32, NAKINI = 64, FIFOCON = 128 };
enum { KILLBK = 4, INTERRUPTS = TXINI | STALLEDI | RXOUTI | RXSTPI | NAKOUTI | NAKINI };
enum { EPEN = 1, STALLRQC = 1 << 4, STALLRQ = 1 << 5, ALLOC = 2, CFGOK = 1 << 7 };

static usb_endpoint *selected(machine *m)
{
    unsigned number = m->avr->data[UENUM] & 7;
    return number < USB_ENDPOINTS ? &m->usb.endpoints[number] : NULL;
}

static int is_active(const usb_endpoint *e)
{
    return (e->control & EPEN) && (e->shape & ALLOC);
}

static int is_control(const usb_endpoint *e)
{
    return !(e->type >> 6);
}

static int is_in(const usb_endpoint *e)
{
    return e->type & 1;
}

static unsigned banks_of(const usb_endpoint *e)
{
    return e->shape & 0x0C ? 2 : 1;
}

static unsigned bytes_of(const usb_endpoint *e)
{
    return 8u << (e->shape >> 4 & 7);
}

static usb_bank *bank_at(usb_endpoint *e, unsigned further)
{
    return &e->banks[(e->current + further) % banks_of(e)];
}

static void empty(usb_bank *bank)
{
    bank->size = bank->read = 0;
}

/* Whether the CPU may fill its bank, or else read it. */
static int takes_bytes(const usb_endpoint *e)
{
    return is_control(e) ? e->flags & TXINI : is_in(e) && e->full < banks_of(e);
}

static int holds_bytes(const usb_endpoint *e)
{
    return is_control(e) ? e->flags & (RXSTPI | RXOUTI) : !is_in(e) && e->full;
}

/* Its FIFO anew: what sends has room. */
static void restart(usb_endpoint *e)
{
    e->current = e->full = 0;
    empty(&e->banks[0]);
    empty(&e->banks[1]);
    e->flags = is_active(e) && (is_control(e) || is_in(e)) ? TXINI : 0;
}

/* UEINTX of the selected endpoint: FIFOCON and RWAL are 0 on a control endpoint (22.18.2). */
static uint8_t interrupt_flags(usb_endpoint *e)
{
    usb_bank *bank = bank_at(e, 0);
    uint8_t flags = e->flags;
    if (is_control(e) || !is_active(e))
        return flags;
    if (takes_bytes(e))
        flags |= FIFOCON | (bank->size < bytes_of(e) ? RWAL : 0);
    if (holds_bytes(e))
        flags |= FIFOCON | (bank->read < bank->size ? RWAL : 0);
    return flags;
}

/* The CPU has done with a bank of a bulk or interrupt endpoint: the next one is its own. */
static void release(usb_endpoint *e)
{
    if (is_in(e)) {
        e->full++;
        e->current = (e->current + 1) % banks_of(e);
        if (takes_bytes(e)) {
            empty(bank_at(e, 0));
            e->flags |= TXINI;
        }
    } else {
        e->full--;
        e->current = (e->current + 1) % banks_of(e);
        if (e->full)
            e->flags |= RXOUTI;
    }
}

/* The bank of a control endpoint is for receiving until what came is acknowledged; then clearing
 * TXINI sends what was filled in. */
static void acknowledge_control(usb_endpoint *e, uint8_t cleared)
{
    int received = e->flags & cleared & (RXSTPI | RXOUTI);
    e->flags &= (uint8_t)~cleared;
    if (received) {
        empty(&e->banks[0]);
        e->flags |= TXINI;
    }
}

/* Zeros clear flags; ones change nothing. */
static void write_flags(machine *m, usb_endpoint *e, uint8_t value)
{
    if (!is_active(e))
        return;
    uint8_t cleared = (uint8_t)(~value & INTERRUPTS);
    if (is_control(e)) {
        acknowledge_control(e, cleared);
        return;
    }
    if (is_in(e) && value & KILLBK && e->full)
        machine_fail(m, "UEINTX.KILLBK takes back a bank, which is not simulated");
    e->flags &= (uint8_t)~cleared;
    if (!(value & FIFOCON) && (takes_bytes(e) || holds_bytes(e)))
        release(e);
}

static void write_control(usb_endpoint *e, uint8_t value)
{
    uint8_t stall = (e->control | value) & STALLRQ;
    int switched = (e->control ^ value) & EPEN;
    e->control = (uint8_t)((value & EPEN) | (value & STALLRQC ? 0 : stall));
    if (switched)
        restart(e);
}

static void write_shape(machine *m, usb_endpoint *e, uint8_t value)
{
    e->shape = value;
    if (value & ALLOC && bytes_of(e) > BANK_BYTES)
        machine_fail(m, "an endpoint of more than %d bytes is not simulated", BANK_BYTES);
    restart(e);
}

static uint8_t read_data(usb_endpoint *e)
{
    usb_bank *bank = bank_at(e, 0);
    return holds_bytes(e) && bank->read < bank->size ? bank->bytes[bank->read++] : 0;
}

static void write_data(usb_endpoint *e, uint8_t value)
{
    usb_bank *bank = bank_at(e, 0);
    if (takes_bytes(e) && bank->size < bytes_of(e))
        bank->bytes[bank->size++] = value;
}

static uint8_t waiting_endpoints(const machine *m)
{
    uint8_t found = 0;
    for (unsigned i = 0; i < USB_ENDPOINTS; i++) {
        const usb_endpoint *e = &m->usb.endpoints[i];
        if (e->flags & e->enables & INTERRUPTS)
            found |= (uint8_t)(1 << i);
    }
    return found;
}

int usb_is_pending(const machine *m, const avr_int_vector_t *v)
{
    const uint8_t *data = m->avr->data;
    return v == m->usb.general ? data[UDINT] & data[UDIEN] : waiting_endpoints(m);
}

static void write_device(machine *m, uint16_t address, uint8_t value)
{
    uint8_t *data = m->avr->data;
    switch (address) {
    case UDINT:
        data[UDINT] &= value; /* zeros clear */
        break;
    case UERST:
        data[UERST] = value;
        for (unsigned i = 0; i < USB_ENDPOINTS; i++)
            if (value >> i & 1)
                restart(&m->usb.endpoints[i]);
        break;
    case UDCON:
        data[UDCON] = value;
        if (value & DETACH || m->usb.attached)
            break;
        m->usb.attached = 1;
        usb_host_attach(m);
        break;
    default:
        data[address] = value;
    }
}

/* A write of the CPU. An endpoint's registers are those of the one that UENUM selects. */
void usb_write(machine *m, uint16_t address, uint8_t value)
{
    usb_endpoint *e = selected(m);
    if (address < UEINTX || address == UENUM || address == UERST)
        write_device(m, address, value);
    else if (e && address == UEINTX)
        write_flags(m, e, value);
    else if (e && address == UECONX)
        write_control(e, value);
    else if (e && address == UECFG0X)
        e->type = value;
    else if (e && address == UECFG1X)
        write_shape(m, e, value);
    else if (e && address == UEIENX)
        e->enables = value;
    else if (e && address == UEDATX)
        write_data(e, value);
    machine_attend(m);
}

static uint8_t on_read(avr_t *avr, avr_io_addr_t address, void *param)
{
    machine *m = param;
    usb_endpoint *e = selected(m);
    usb_bank *bank = e ? bank_at(e, 0) : NULL;
    if (address == UEINT)
        return waiting_endpoints(m);
    if (!e)
        return 0;
    switch (address) {
    case UEINTX:
        return interrupt_flags(e);
    case UECONX:
        return e->control;
    case UECFG0X:
        return e->type;
    case UECFG1X:
        return e->shape;
    case UESTA0X:
        return (uint8_t)((is_active(e) ? CFGOK : 0) | e->full);
    case UEIENX:
        return e->enables;
    case UEDATX:
        return read_data(e);
    case UEBCLX:
        return (uint8_t)(bank->size - bank->read);
    default:
        return avr->data[address];
    }
}

/* The endpoint that a token is for, NULL if the board does not answer. */
static usb_endpoint *called(machine *m, uint8_t address, uint8_t number)
{
    uint8_t own = m->avr->data[UDADDR];
    usb_endpoint *e = &m->usb.endpoints[number % USB_ENDPOINTS];
    return (own & ADDEN ? own & ~ADDEN : 0) == address && is_active(e) ? e : NULL;
}

static void flag(machine *m, usb_endpoint *e, uint8_t flags)
{
    if (!waiting_endpoints(m))
        m->raised_at[m->usb.endpoint->vector] = m->avr->cycle;
    e->flags |= flags;
    machine_attend(m);
}

/* Always taken: it ends whatever endpoint 0 was at (22.12). */
usb_answer usb_setup(machine *m, uint8_t address, const uint8_t request[SETUP_BYTES])
{
    usb_endpoint *e = called(m, address, 0);
    if (!e)
        return USB_SILENCE;
    e->control &= (uint8_t)~STALLRQ;
    e->flags = 0;
    e->banks[0].read = 0;
    e->banks[0].size = SETUP_BYTES;
    memcpy(e->banks[0].bytes, request, SETUP_BYTES);
    flag(m, e, RXSTPI);
    return USB_ACK;
}

static usb_answer refused(machine *m, usb_endpoint *e, uint8_t nak)
{
    int stalled = e->control & STALLRQ;
    flag(m, e, stalled ? STALLEDI : nak);
    return stalled ? USB_STALL : USB_NAK;
}

usb_answer usb_out(machine *m, uint8_t address, uint8_t number, const uint8_t *bytes, uint8_t size)
{
    usb_endpoint *e = called(m, address, number);
    if (!e || (!is_control(e) && is_in(e)))
        return USB_SILENCE;
    int occupied = is_control(e) ? e->flags & (RXSTPI | RXOUTI) : e->full == banks_of(e);
    if (occupied || e->control & STALLRQ)
        return refused(m, e, NAKOUTI);
    usb_bank *bank = bank_at(e, e->full);
    bank->read = 0;
    bank->size = size;
    memcpy(bank->bytes, bytes, size);
    if (is_control(e))
        e->flags &= (uint8_t)~TXINI; /* one bank: what it was to send is gone */
    if (is_control(e) || !e->full++)
        flag(m, e, RXOUTI);
    return USB_ACK;
}

usb_answer usb_in(machine *m, uint8_t address, uint8_t number, uint8_t *bytes, uint8_t *size)
{
    usb_endpoint *e = called(m, address, number);
    if (!e || (!is_control(e) && !is_in(e)))
        return USB_SILENCE;
    int ready = is_control(e) ? !(e->flags & (RXSTPI | RXOUTI | TXINI)) : e->full;
    if (!ready || e->control & STALLRQ)
        return refused(m, e, NAKINI);
    int had_room = !is_control(e) && takes_bytes(e);
    usb_bank *bank = bank_at(e, is_control(e) ? 0 : banks_of(e) - e->full);
    *size = bank->size;
    memcpy(bytes, bank->bytes, bank->size);
    empty(bank);
    e->full -= !is_control(e);
    if (!had_room)
        flag(m, e, TXINI);
    return USB_ACK;
}

void usb_raise(machine *m, uint8_t flags)
{
    if (!usb_is_pending(m, m->usb.general))
        m->raised_at[m->usb.general->vector] = m->avr->cycle;
    m->avr->data[UDINT] |= flags;
    machine_attend(m);
}

/* The line at rest for long enough: what the CPU sees is the end of it (22.5). Endpoints are off but for 0. */
void usb_reset(machine *m)
{
    for (unsigned i = 1; i < USB_ENDPOINTS; i++)
        m->usb.endpoints[i] = (usb_endpoint){0};
    m->avr->data[UDADDR] = 0;
    usb_raise(m, EORSTI);
}

static avr_int_vector_t *vector_numbered(machine *m, unsigned number)
{
    for (unsigned i = 0; i < m->vector_count; i++)
        if (m->vectors[i]->vector == number)
            return m->vectors[i];
    return NULL;
}

void usb_install(machine *m)
{
    for (avr_io_t *io = m->avr->io_port; io; io = io->next) {
        if (strcmp(io->kind, "usb"))
            continue;
        m->usb.general = vector_numbered(m, ((avr_usb_t *)io)->usb_gen_vect);
        m->usb.endpoint = vector_numbered(m, ((avr_usb_t *)io)->usb_com_vect);
        m->avr->data[UDCON] = DETACH;
        for (uint16_t address = UDCON; address <= UEINT; address++)
            registers_take_usb(m, address, address < UEINTX ? NULL : on_read);
    }
}
