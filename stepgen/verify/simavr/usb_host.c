/* A computer at the USB connector. It resets the bus once the board is there and begins a frame
 * each millisecond (USB 2.0, 7.1.12). Until somebody opens the port it sends no request, so that
 * the board stays as it is before a driver has found it. Then it asks who is there, gives an
 * address (9.4), configures the port (CDC PSTN 1.2, 6.3), and carries bytes both ways.
 *
 * A real one makes many transactions in a frame; this one makes one of each kind, so the board
 * waits for it as long as it may have to. */

#include <stdlib.h>
#include <string.h>

#include "machine.h"

enum { UDFNUML = 0xE4, UDFNUMH = 0xE5, UEDATX = 0xF1, SOFI = 1 << 2 };
enum { FRAMES_PER_SECOND = 1000, FRAME_NUMBERS = 2048, TO_TOKENS_PER_SECOND = 10000 };
enum { ADDRESS = 5, FROM_BOARD = 0x80 };
enum { INTERFACE = 4, ENDPOINT = 5, COMMUNICATION = 2, DATA = 10, BULK = 2 };
enum { SET_ADDRESS = 1, GET_CONFIGURATION = 3, SET_CONFIGURATION = 4, LINE_CODING, LINE_STATE, REQUESTS };
enum { STAGE_SETUP, STAGE_DATA, STAGE_STATUS };

/* wIndex, of an interface, and the configuration's number are filled in. */
static const uint8_t SETUPS[REQUESTS][SETUP_BYTES] = {
    {FROM_BOARD, 6, 0, 1, 0, 0, 64, 0},  /* the device descriptor: how long packets are */
    {0x00, 5, ADDRESS, 0, 0, 0, 0, 0},
    {FROM_BOARD, 6, 0, 1, 0, 0, 18, 0},
    {FROM_BOARD, 6, 0, 2, 0, 0, 255, 0}, /* the configuration, with the port's endpoints */
    {0x00, 9, 0, 0, 0, 0, 0, 0},
    {0x21, 0x20, 0, 0, 0, 0, 7, 0},
    {0x21, 0x22, 3, 0, 0, 0, 0, 0},      /* DTR and RTS: the port is open */
};
static const uint8_t CODING[] = {0x00, 0xC2, 0x01, 0x00, 0, 0, 8}; /* 115200 baud, 8N1 */

static void request(const machine *m, uint8_t setup[SETUP_BYTES])
{
    memcpy(setup, SETUPS[m->host.step], SETUP_BYTES);
    if (m->host.step == SET_CONFIGURATION)
        setup[2] = m->host.answer[5];
    if (m->host.step >= LINE_CODING)
        setup[4] = m->host.interface;
}

/* Find the port: the bulk endpoints of the interface for data. */
static void read_configuration(machine *m)
{
    usb_host *h = &m->host;
    uint8_t class = 0;
    for (unsigned i = 0; i + 6 < h->answered && h->answer[i]; i += h->answer[i]) {
        const uint8_t *at = &h->answer[i];
        if (at[1] == INTERFACE)
            class = at[5];
        if (at[1] == INTERFACE && class == COMMUNICATION)
            h->interface = at[2];
        if (at[1] != ENDPOINT || class != DATA || at[3] != BULK)
            continue;
        if (at[2] & FROM_BOARD) {
            h->port_in = at[2] & 0x0F;
        } else {
            h->port_out = at[2];
            h->port_packet = at[4];
        }
    }
    if (!h->port_in || !h->port_out)
        machine_fail(m, "the board shows no serial port over USB");
}

static void finish_request(machine *m)
{
    usb_host *h = &m->host;
    if (h->step == 0)
        h->packet = h->answer[7];
    if (h->step == SET_ADDRESS)
        h->address = ADDRESS;
    if (h->step == GET_CONFIGURATION)
        read_configuration(m);
    h->stage = STAGE_SETUP;
    h->step++;
}

/* The next transaction of the data stage; the last one is a short one or makes it complete. */
static usb_answer move_data(machine *m, const uint8_t *setup)
{
    usb_host *h = &m->host;
    usb_answer answer;
    uint8_t size = sizeof CODING;
    if (setup[0] & FROM_BOARD)
        answer = usb_in(m, h->address, 0, h->answer + h->answered, &size);
    else
        answer = usb_out(m, h->address, 0, CODING, size);
    if (answer != USB_ACK)
        return answer;
    h->answered += size;
    if (size < h->packet || h->answered >= setup[6])
        h->stage = STAGE_STATUS;
    return answer;
}

static usb_answer end_request(machine *m, const uint8_t *setup)
{
    uint8_t nothing[BANK_BYTES] = {0}, size = 0;
    usb_answer answer = setup[0] & FROM_BOARD ? usb_out(m, m->host.address, 0, nothing, 0)
                                              : usb_in(m, m->host.address, 0, nothing, &size);
    if (answer == USB_ACK)
        finish_request(m);
    return answer;
}

/* One transaction of a request: setup, data or status. */
static void enumerate(machine *m)
{
    usb_host *h = &m->host;
    uint8_t setup[SETUP_BYTES];
    usb_answer answer;
    request(m, setup);
    if (h->stage == STAGE_SETUP) {
        answer = usb_setup(m, h->address, setup);
        h->answered = 0;
        if (answer == USB_ACK)
            h->stage = setup[6] ? STAGE_DATA : STAGE_STATUS;
    } else if (h->stage == STAGE_DATA) {
        answer = move_data(m, setup);
    } else {
        answer = end_request(m, setup);
    }
    if (answer == USB_STALL)
        machine_fail(m, "the board refuses request %d of %02x over USB", setup[1], setup[0]);
}

/* What the board has to say, then a packet of what was typed. */
static void carry(machine *m)
{
    usb_host *h = &m->host;
    uint8_t bytes[BANK_BYTES], size;
    while (usb_in(m, h->address, h->port_in, bytes, &size) == USB_ACK)
        for (unsigned i = 0; i < size; i++)
            machine_record(m, EVENT_UART, m->avr->cycle, UEDATX, bytes[i]);
    uint32_t waiting = line_waiting(&h->line);
    size = waiting < h->port_packet ? (uint8_t)waiting : h->port_packet;
    if (size && usb_out(m, h->address, h->port_out, line_next(&h->line), size) == USB_ACK)
        h->line.next += size;
}

static avr_cycle_count_t on_tokens(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)avr, (void)when;
    machine *m = param;
    if (m->host.wanted && m->host.step < REQUESTS)
        enumerate(m);
    else if (m->host.wanted)
        carry(m);
    return 0;
}

static avr_cycle_count_t on_frame(avr_t *avr, avr_cycle_count_t when, void *param)
{
    machine *m = param;
    m->host.frame = (uint16_t)((m->host.frame + 1) % FRAME_NUMBERS);
    avr->data[UDFNUML] = (uint8_t)m->host.frame;
    avr->data[UDFNUMH] = (uint8_t)(m->host.frame >> 8);
    usb_raise(m, SOFI);
    avr_cycle_timer_register(avr, avr->frequency / TO_TOKENS_PER_SECOND, on_tokens, m);
    return when + avr->frequency / FRAMES_PER_SECOND;
}

void usb_host_attach(machine *m)
{
    m->host.packet = BANK_BYTES; /* until the board has said it */
    usb_reset(m);
    avr_cycle_timer_register(m->avr, m->avr->frequency / FRAMES_PER_SECOND, on_frame, m);
}

void machine_send_usb(machine *m, const uint8_t *bytes, uint32_t size)
{
    if (!m->usb.general) {
        machine_fail(m, "the chip has no USB");
        return;
    }
    m->host.wanted = 1;
    if (!line_add(&m->host.line, bytes, size))
        machine_fail(m, "no memory for the input over USB");
}

uint32_t machine_usb_waiting(const machine *m)
{
    return line_waiting(&m->host.line);
}
