/* The first USART's line: bytes out are recorded, bytes in arrive one per byte time. simavr's own
 * pacing has a bit too many and no transmit buffer, and is not used. */

#include <string.h>

#include "machine.h"

DEFINE_FIFO(uint16_t, uart_fifo);

enum { RETRY_CYCLES = 1000, RECEIVER_BYTES = 3, RXEN = 1 << 4, TXEN = 1 << 3, U2X = 1 << 1 };

/* One of its registers. */
static uint8_t *at(const machine *m, unsigned offset)
{
    return &m->avr->data[m->facts->usart.base + offset];
}

/* Cycles of a frame: start, data, parity and stop bits. simavr always counts a parity bit. */
static uint64_t byte_cycles(const machine *m)
{
    uint8_t format = *at(m, UCSRC);
    unsigned ubrr = *at(m, UBRRL) | (*at(m, UBRRL + 1) & 0x0Fu) << 8;
    unsigned parity = format & 0x20 ? 1 : 0, stop = format & 0x08 ? 2 : 1;
    unsigned bits = 1 + 5 + (format >> 1 & 3) + parity + stop;
    return (uint64_t)bits * (*at(m, UCSRA) & U2X ? 8 : 16) * (ubrr + 1);
}

/* The shift register is empty: the buffered byte follows, or the line falls silent. */
static avr_cycle_count_t on_shifted(avr_t *avr, avr_cycle_count_t when, void *param)
{
    machine *m = param;
    avr_int_vector_t *done = m->buffered ? &m->uart->udrc : &m->uart->txc;
    done->pending = 0;
    avr_raise_interrupt(avr, done);
    if (!m->buffered)
        return 0;
    m->buffered = 0;
    m->shifting_until = when + byte_cycles(m);
    return m->shifting_until;
}

/* A byte for UDRn. It goes into the shift register at once, or waits in the buffer while
 * that is busy; UDRE is clear only then. simavr has no such buffer. */
void serial_transmit(machine *m, uint8_t value, uint64_t edge)
{
    avr_t *avr = m->avr;
    if (!m->uart || !(*at(m, UCSRB) & TXEN) || m->buffered)
        return; /* a write to a full buffer is ignored */
    machine_record(m, EVENT_UART, edge, (uint16_t)(m->facts->usart.base + UDR), value);
    if (edge < m->shifting_until) {
        m->buffered = 1;
        avr_regbit_clear(avr, m->uart->udrc.raised);
        return;
    }
    m->shifting_until = edge + byte_cycles(m);
    avr_cycle_timer_register(avr, m->shifting_until - avr->cycle, on_shifted, m);
}

/* UDRE says that the buffer is free, whatever the CPU does. simavr sets it with UDRIE, and
 * clears it where the interrupt is entered. */
void serial_settle(machine *m)
{
    if (!m->uart)
        return;
    m->uart->udrc.pending = 0;
    avr_regbit_setto(m->avr, m->uart->udrc.raised, !m->buffered);
}

/* Writing UCSRnA sets U2X and MPCM, and a one clears TXC. The other bits are the chip's own,
 * where simavr takes UDRE from the CPU. */
void serial_status(machine *m, uint8_t value)
{
    enum { TXC = 1 << 6, MODE = U2X | 1 };
    uint8_t *status = at(m, UCSRA);
    *status = (uint8_t)((*status & ~MODE) | (value & MODE));
    if (m->uart && value & TXC)
        avr_clear_interrupt(m->avr, &m->uart->txc);
}

/* A byte is complete. The receiver holds two and a third in its shift register; one more
 * is lost. While the receiver is off the line waits. */
static avr_cycle_count_t on_byte_time(avr_t *avr, avr_cycle_count_t when, void *param)
{
    machine *m = param;
    if (!line_waiting(&m->serial))
        return 0;
    if (!(*at(m, UCSRB) & RXEN))
        return when + RETRY_CYCLES;
    if (uart_fifo_get_read_size(&m->uart->input) < RECEIVER_BYTES)
        uart_fifo_write(&m->uart->input, *line_next(&m->serial));
    else
        m->serial_lost++;
    m->serial.next++;
    m->uart->rx_cnt = 0;
    m->uart->rxc_raise_time = when;
    avr_raise_interrupt(avr, &m->uart->rxc);
    return when + byte_cycles(m);
}

void machine_send_serial(machine *m, const uint8_t *bytes, uint32_t size)
{
    if (!m->uart || !line_add(&m->serial, bytes, size)) {
        machine_fail(m, "no memory for the input of the USART");
        return;
    }
    if (!avr_cycle_timer_status(m->avr, on_byte_time, m))
        avr_cycle_timer_register(m->avr, 1, on_byte_time, m);
}

uint32_t machine_serial_lost(const machine *m)
{
    return m->serial_lost;
}

uint32_t machine_serial_waiting(const machine *m)
{
    return line_waiting(&m->serial);
}

void serial_install(machine *m)
{
    *at(m, UCSRC) = 0x06; /* 8 data bits; simavr forgets this initial value */
    for (avr_io_t *io = m->avr->io_port; io; io = io->next) {
        if (strcmp(io->kind, "uart"))
            continue;
        avr_uart_t *uart = (avr_uart_t *)io;
        uart->flags = 0; /* neither print nor sleep in real time */
        if (uart->name == m->facts->usart.name)
            m->uart = uart;
    }
}
