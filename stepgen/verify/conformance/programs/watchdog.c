/* The watchdog. What it does is seen in marks and in bytes of RAM, which a reset leaves alone. */
#include <avr/io.h>

uint8_t starts __attribute__((section(".noinit")));
uint8_t seen[16] __attribute__((section(".noinit")));

/* The first thing after a reset; RAM holds anything after the first. */
void begin(void) __attribute__((naked, used, section(".init0")));
void begin(void)
{
  EEDR = 1;
}

#define WDR() asm volatile("wdr" ::: "memory")
/* Writes *second* to WDTCSR so many instructions after a write of WDCE and WDE. */
#define CHANGE(second, nops)                                                                      \
  asm volatile("sts %0, %1\n\t.rept " #nops "\n\tnop\n\t.endr\n\tsts %0, %2" ::"n"(               \
                   _SFR_MEM_ADDR(WDTCSR)),                                                        \
               "r"((uint8_t)(1 << WDCE | 1 << WDE)), "r"((uint8_t)(second))                       \
               : "memory")

/* Waits until the bit for a later write of WDTCSR is closed again. */
static uint8_t control(void)
{
  asm volatile(".rept 8\n\tnop\n\t.endr");
  return WDTCSR;
}

static void first_start(void)
{
#ifdef SELECT
  WDR();
  CHANGE(1 << WDE | SELECT, 0);
  EEDR = 2;
#ifdef FED
  for (uint8_t i = 0; i < FED; i++) {
    for (uint32_t rounds = 0; rounds < 30000; rounds++) { /* 210 000 cycles of 256 000 or so */
      asm volatile("");
    }
    EEDR = 3;
    WDR();
  }
#endif
#else
  WDR();
  CHANGE(1 << WDE | 1 << WDP0, 0);
  seen[0] = control();
  WDTCSR = 1 << WDE | 1 << WDP2;
  seen[1] = control();
  WDTCSR = 0;
  seen[2] = control();
  CHANGE(0, 4);
  seen[3] = control();
  CHANGE(1 << WDE, 1);
  seen[4] = control();
  CHANGE(0, 0);
  seen[5] = control();
  EEDR = 4;
#endif
}

static void second_start(void)
{
  seen[0] = MCUSR;
  seen[1] = WDTCSR;
  seen[2] = DDRB | PORTB | TCCR1B | OCR1AL | (SREG & 0x80);
  CHANGE(0, 0);
  seen[3] = control();
  MCUSR &= ~(1 << WDRF);
  CHANGE(0, 0);
  seen[4] = control();
  EEDR = 5;
}

int main(void)
{
  if (MCUSR & 1 << WDRF) {
    starts++;
    second_start();
  } else {
    starts = 1;
    DDRB = PORTB = 0xFF;
    OCR1AL = TCCR1B = 3;
    SREG = 0x80;
    first_start();
  }
  for (;;) {
  }
}
