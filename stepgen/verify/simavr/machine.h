/* The inside of a machine, shared by the harness's own files. */

#ifndef STEPGEN_MACHINE_H
#define STEPGEN_MACHINE_H

#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_io.h>

#include "harness.h"
#include "line.h"
#include "mcus.h"
#include "recorder.h"
#include "timer.h"
#include "usb.h"

enum { MAX_VECTORS = 64, MAX_DEPTH = 64, MAX_ERROR = 400 };

/* What a write to an I/O register means beside storing the byte. */
typedef enum {
    ROLE_PLAIN,
    ROLE_PIN,    /* writing ones toggles PORTx; sbi toggles its one bit */
    ROLE_DDR,
    ROLE_PORT,
    ROLE_FLAGS,  /* writing ones clears; sbi clears its one bit */
    ROLE_TIMER,  /* a register of a timer */
    ROLE_SPL,
    ROLE_SPH,
    ROLE_MARK,
    ROLE_PRESCALER,
    ROLE_DATA,   /* UDRn */
    ROLE_STATUS, /* UCSRnA */
    ROLE_CONTROL, /* UCSRnB */
    ROLE_USB,    /* of the USB device controller */
    ROLE_WATCHDOG,
} role;

typedef struct {
    struct machine *owner;
    role role;
    uint8_t watched;   /* record writes */
    uint8_t enables;   /* holds interrupt enable bits */
    timer *timer;
    avr_io_write_t write;  /* simavr's own handlers, or NULL */
    void *write_param;
    avr_io_read_t read;
    void *read_param;
} slot;

typedef struct {
    uint8_t vector;
    uint16_t stack_before;  /* SP before the return address was pushed */
    uint16_t lowest_before; /* lowest SP of the interrupted level so far */
    uint64_t entered;
} frame;

struct machine {
    avr_t *avr;
    const mcu_facts *facts;
    recorder recorder;
    slot slots[MAX_IOs];
    timer timers[MOST_TIMERS];
    uint8_t shown[12];       /* what each port was recorded to show last */
    avr_ioport_external_t driven[12];  /* the inputs that are driven from outside, by port */

    avr_int_vector_t *vectors[MAX_VECTORS];  /* by priority */
    uint8_t vector_count;
    uint64_t raised_at[MAX_VECTORS];
    uint64_t enabled_at[MAX_VECTORS];
    uint64_t unmasked_at;  /* the I flag was set last */

    frame frames[MAX_DEPTH];
    uint8_t depth;
    uint8_t entering;
    uint8_t asleep;  /* until an interrupt is taken; simavr itself wakes too early */
    uint16_t lowest, lowest_ever;  /* SP; lowest is of the current level */
    uint32_t isr_stack[MAX_VECTORS];

    avr_uart_t *uart;
    uint64_t shifting_until;  /* the transmitter's shift register is busy */
    uint8_t buffered;         /* and another byte waits */
    line serial;
    uint32_t serial_lost;

    usb_device usb;
    usb_host host;

    avr_io_t dog;
    uint64_t dog_fed;        /* the watchdog's counter began at 0 */
    uint64_t dog_open_until; /* its timed sequence goes on */
    int reset_due;

    uint64_t until; /* where the run ends */
    int stop, wanted_mark, marked;
    int fine, was_enabled;
    int silent; /* record nothing */
    char error[MAX_ERROR];
};

/* Record an event; a full recorder fails the machine. NULL if it fails or is silent. */
event *machine_record(machine *m, uint16_t kind, uint64_t cycle, uint16_t source, uint32_t value);

/* Stop the run with an error, once: the first one counts. */
void machine_fail(machine *m, const char *format, ...);

/* chip.c: what a reset by the watchdog makes of it, between two instructions. */

/* An interrupt may have become pending: look after the current instruction. */
void machine_attend(machine *m);

/* interrupts.c: what happens between two instructions, and at RETI. */
void interrupts_install(machine *m);
void interrupts_service(machine *m);

/* registers.c: the write hooks. */
void registers_install(machine *m);
void registers_hook(machine *m, uint16_t address);
void registers_take_usb(machine *m, uint16_t address, avr_io_read_t read);
uint64_t registers_write_edge(const avr_t *avr);
uint64_t registers_read_edge(const avr_t *avr);

/* outputs.c: pins that compare units drive, by the data address of their PORTx. */
uint8_t outputs_driven(machine *m, uint16_t port);                /* which bits */
uint8_t outputs_show(machine *m, uint16_t port, uint64_t edge);   /* the whole port */
void outputs_settle(machine *m, uint16_t port, uint64_t edge);    /* record what changed */
void outputs_catch_up(machine *m, uint64_t edge);                 /* up to *edge* */

/* serial.c */
void serial_install(machine *m);
void serial_transmit(machine *m, uint8_t value, uint64_t edge);
void serial_status(machine *m, uint8_t value);
void serial_settle(machine *m);

/* watchdog.c */
enum { WDRF_MASK = 1 << 3 }; /* of MCUSR */
void watchdog_install(machine *m);
void watchdog_write(machine *m, uint8_t value, uint64_t edge);

#endif
