#include "mcus.h"

#include <string.h>

/* PORTx of the ports with compare outputs. */
enum { PORTB = 0x25, PORTC = 0x28, PORTD = 0x2B, PORTE = 0x2E, PORTH = 0x102, PORTL = 0x10B };

/* The 16-bit timers share a prescaler; timer 2 has its own, with more taps. */
#define SHARED_PRESCALER .restart = 0x01, .prescaler = {0, 1, 8, 64, 256, 1024, 0, 0}
#define TIMER2(ovf, compa, compb, ...)                                                            \
    {                                                                                             \
        .output = {__VA_ARGS__},                                                                  \
        .name = '2', .base = 0xB0, .timsk = 0x70, .tifr = 0x37, .channels = 2,                    \
        .vector = {ovf, compa, compb}, .is_small = 1, .restart = 0x02,                            \
        .prescaler = {0, 1, 8, 32, 64, 128, 256, 1024},                                           \
    }

/* The ATmega1280 is an ATmega2560 with half the flash. */
#define MEGA_FACTS                                                                                \
    .usart = {'0', 0xC0},                                                                         \
    .ports = "ABCDEFGHJKL",                                                                       \
    .pin_address = {0x20, 0x23, 0x26, 0x29, 0x2C, 0x2F, 0x32, 0x100, 0x103, 0x106, 0x109},        \
    .timer_count = 5,                                                                             \
    .timers = {                                                                                   \
        {'1', 0x80, 0x6F, 0x36, 3, {20, 17, 18, 19, 0, 16},                                       \
         .output = {{PORTB, 5}, {PORTB, 6}, {PORTB, 7}}, SHARED_PRESCALER},                       \
        {'3', 0x90, 0x71, 0x38, 3, {35, 32, 33, 34, 0, 31},                                       \
         .output = {{PORTE, 3}, {PORTE, 4}, {PORTE, 5}}, SHARED_PRESCALER},                       \
        {'4', 0xA0, 0x72, 0x39, 3, {45, 42, 43, 44, 0, 41},                                       \
         .output = {{PORTH, 3}, {PORTH, 4}, {PORTH, 5}}, SHARED_PRESCALER},                       \
        {'5', 0x120, 0x73, 0x3A, 3, {50, 47, 48, 49, 0, 46},                                      \
         .output = {{PORTL, 3}, {PORTL, 4}, {PORTL, 5}}, SHARED_PRESCALER},                       \
        TIMER2(15, 13, 14, {PORTB, 4}, {PORTH, 6}),                                               \
    }

static const mcu_facts MCUS[] = {
    {
        .name = "atmega328p",
        .ports = "BCD",
        .pin_address = {0x23, 0x26, 0x29},
        .usart = {'0', 0xC0},
        .timer_count = 2,
        .timers = {
            {'1', 0x80, 0x6F, 0x36, 2, {13, 11, 12, 0, 0, 10}, .output = {{PORTB, 1}, {PORTB, 2}},
             SHARED_PRESCALER},
            TIMER2(9, 7, 8, {PORTB, 3}, {PORTD, 3}),
        },
    },
    {
        .name = "atmega32u4",
        .ports = "BCDEF",
        .pin_address = {0x23, 0x26, 0x29, 0x2C, 0x2F},
        .usart = {'1', 0xC8},
        .timer_count = 2,
        .timers = {
            {'1', 0x80, 0x6F, 0x36, 3, {20, 17, 18, 19, 0, 16},
             .output = {{PORTB, 5}, {PORTB, 6}, {PORTB, 7}}, SHARED_PRESCALER},
            {'3', 0x90, 0x71, 0x38, 3, {35, 32, 33, 34, 0, 31}, .output = {{PORTC, 6}},
             SHARED_PRESCALER},
        },
    },
    {.name = "atmega1280", MEGA_FACTS},
    {.name = "atmega2560", MEGA_FACTS},
};

const mcu_facts *mcu_find(const char *name)
{
    for (size_t i = 0; i < sizeof(MCUS) / sizeof(MCUS[0]); i++)
        if (!strcmp(MCUS[i].name, name))
            return &MCUS[i];
    return NULL;
}
