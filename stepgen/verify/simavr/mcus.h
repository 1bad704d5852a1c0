/* Facts of the simulated chips, from avr-libc's iom328p.h, iom32u4.h and iomxx0_1.h. */

#ifndef STEPGEN_MCUS_H
#define STEPGEN_MCUS_H

#include <stdint.h>

/* Bits of TIFRn and TIMSKn, the same in every timer; ICFn, of 16-bit ones, is bit 5. */
enum { FLAG_TOV = 0, FLAG_OCA = 1, FLAG_OCB = 2, FLAG_OCC = 3, FLAG_ICF = 5, FLAG_BITS = 6 };

enum { MOST_TIMERS = 5, PRESCALERS = 8 };

/* The pin of a compare unit: the data address of its PORTx, 0 where it has none, and its bit. */
typedef struct {
    uint16_t port;
    uint8_t bit;
} output_facts;

typedef struct {
    char name;                  /* '1', as simavr names its timer */
    uint16_t base;              /* data address of TCCRnA; the others follow at fixed offsets */
    uint16_t timsk, tifr;
    uint8_t channels;           /* compare units: 2 (A, B) or 3 (A, B, C) */
    uint8_t vector[FLAG_BITS];  /* by flag bit */
    uint8_t is_small;           /* 8 bits wide, with fewer registers */
    output_facts output[3];     /* OCnA, OCnB, OCnC */
    uint8_t restart;            /* the bit of GTCCR that restarts its prescaler */
    uint16_t prescaler[PRESCALERS]; /* by clock select; 0: stopped, or not simulated */
} timer_facts;

typedef struct {
    char name;                  /* '0', as simavr names it */
    uint16_t base;              /* data address of UCSRnA; the others follow at fixed offsets */
} usart_facts;

typedef struct {
    const char *name;
    const char *ports;          /* letters */
    uint16_t pin_address[12];   /* PINx by letter; DDRx and PORTx are the next two addresses */
    usart_facts usart;          /* the first one */
    uint8_t timer_count;
    timer_facts timers[MOST_TIMERS];
} mcu_facts;

/* The same address on each of them. */
enum {
    ADDRESS_EEDR = 0x40,
    ADDRESS_GTCCR = 0x43,
    ADDRESS_SMCR = 0x53,
    ADDRESS_MCUSR = 0x54,
    ADDRESS_SPL = 0x5D,
    ADDRESS_SPH = 0x5E,
    ADDRESS_SREG = 0x5F,
    ADDRESS_WDTCSR = 0x60,
};

/* Offsets from UCSRnA. */
enum { UCSRA = 0, UCSRB = 1, UCSRC = 2, UBRRL = 4, UDR = 6 };

/* The facts of *name*, or NULL for a chip that the harness does not know. */
const mcu_facts *mcu_find(const char *name);

#endif
