/* simavr as it comes, with nothing of the harness in it: what the benchmark compares with. */

#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <stdlib.h>

#include "harness.h"

static void no_sleep(avr_t *avr, avr_cycle_count_t cycles)
{
    (void)avr, (void)cycles;
}

struct avr_t *plain_new(const char *mcu, uint32_t f_cpu_hz, const uint8_t *code, uint32_t size)
{
    avr_t *avr = avr_make_mcu_by_name(mcu);
    if (!avr)
        return NULL;
    avr_init(avr);
    avr->frequency = f_cpu_hz;
    avr->sleep = no_sleep; /* else it would sleep in real time */
    avr_loadcode(avr, (uint8_t *)code, size, 0);
    avr->codeend = size;
    uint32_t flags = 0; /* neither print nor sleep in real time */
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    return avr;
}

void plain_run(struct avr_t *avr, uint64_t until)
{
    while (avr->cycle < until && avr->state < cpu_Done)
        avr_run(avr);
}

uint8_t *plain_data(struct avr_t *avr)
{
    return avr->data;
}

void plain_free(struct avr_t *avr)
{
    avr_terminate(avr);
    free(avr);
}
