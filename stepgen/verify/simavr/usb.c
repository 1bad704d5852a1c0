/* What a computer does at the USB connector while nothing opens the port: it resets the bus once
 * the board is there, and begins a frame each millisecond (USB 2.0, 7.1.12). No request is sent, so
 * the board stays as it is before a driver has found it: Serial takes and gives nothing. */

#include <simavr/avr_usb.h>
#include <string.h>

#include "machine.h"

/* Data addresses, from avr-libc's iom32u4.h, and bits. */
enum { UDINT = 0xE1, UDIEN = 0xE2, SOFI = 1 << 2 };

static avr_cycle_count_t on_frame(avr_t *avr, avr_cycle_count_t when, void *param)
{
    machine *m = param;
    avr->data[UDINT] |= SOFI;
    if (avr->data[UDIEN] & SOFI) {
        avr_raise_interrupt(avr, m->frame_begins);
        machine_attend(m);
    }
    return when + avr->frequency / 1000;
}

/* The board pulls its line up: DETACH was cleared. */
static void on_attach(avr_irq_t *irq, uint32_t attached, void *param)
{
    (void)irq;
    machine *m = param;
    if (!attached || avr_cycle_timer_status(m->avr, on_frame, m))
        return;
    avr_ioctl(m->avr, AVR_IOCTL_USB_RESET, NULL);
    machine_attend(m);
    avr_cycle_timer_register(m->avr, m->avr->frequency / 1000, on_frame, m);
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
        m->frame_begins = vector_numbered(m, ((avr_usb_t *)io)->usb_gen_vect);
        avr_irq_register_notify(io->irq + USB_IRQ_ATTACH, on_attach, m);
    }
}
