/* The USB controller of an ATmega32U4 as a device, and the computer at the other end. */

#ifndef STEPGEN_USB_H
#define STEPGEN_USB_H

#include <simavr/sim_avr.h>
#include <stdint.h>

#include "line.h"

enum { USB_ENDPOINTS = 7, BANK_BYTES = 64, SETUP_BYTES = 8, ANSWER_BYTES = 256 + BANK_BYTES };

struct machine;

typedef struct {
    uint8_t bytes[BANK_BYTES];
    uint8_t size, read; /* how many it holds, and how many of them the CPU has read */
} usb_bank;

typedef struct {
    uint8_t control, type, shape, enables; /* UECONX, UECFG0X, UECFG1X, UEIENX */
    uint8_t flags;   /* of UEINTX, less FIFOCON and RWAL, which follow from the banks */
    uint8_t current; /* the bank that the CPU sees */
    uint8_t full;    /* banks that wait: for the CPU, or to go to the computer */
    usb_bank banks[2];
} usb_endpoint;

/* What the board answers to a token; SILENCE: the token is for nobody here. */
typedef enum { USB_ACK, USB_NAK, USB_STALL, USB_SILENCE } usb_answer;

typedef struct {
    avr_int_vector_t *general, *endpoint; /* USB_GEN and USB_COM; NULL without USB */
    usb_endpoint endpoints[USB_ENDPOINTS];
    uint8_t attached;
} usb_device;

/* What the computer is at; usb_host.c. */
typedef struct {
    uint16_t frame;
    uint8_t wanted;   /* somebody opens the port */
    uint8_t step;     /* which request is next */
    uint8_t stage;    /* what of it */
    uint8_t address;  /* that the board has */
    uint8_t packet;   /* bytes of a full packet of endpoint 0 */
    uint8_t port_in, port_out, port_packet, interface; /* found in the configuration */
    uint8_t answer[ANSWER_BYTES];
    uint16_t answered;
    line line;        /* what was typed */
} usb_host;

/* usb_device.c: the registers, and what the computer's tokens do to them. */
void usb_install(struct machine *m);
void usb_write(struct machine *m, uint16_t address, uint8_t value);
int usb_is_pending(const struct machine *m, const avr_int_vector_t *v);
void usb_raise(struct machine *m, uint8_t flags);
void usb_reset(struct machine *m);
usb_answer usb_setup(struct machine *m, uint8_t address, const uint8_t request[SETUP_BYTES]);
usb_answer usb_out(struct machine *m, uint8_t address, uint8_t endpoint, const uint8_t *bytes,
                   uint8_t size);
usb_answer usb_in(struct machine *m, uint8_t address, uint8_t endpoint, uint8_t *bytes,
                  uint8_t *size);

/* usb_host.c: it begins with frames once the board is there. */
void usb_host_attach(struct machine *m);

#endif
