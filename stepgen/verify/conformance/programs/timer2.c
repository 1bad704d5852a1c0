/* Timer 2 in normal mode: CLOCK are its CS bits, MATCH its OCR2A, to which each interrupt adds STEP
 * (0: one interrupt a lap), at number SLOW_AT SLOW cycles late. NOPS shifts the start, RESTART is
 * written to GTCCR 1000 cycles later. */
#include <avr/interrupt.h>
#include <avr/io.h>

#ifndef RESTART
#define RESTART 0
#endif
#ifndef STEP
#define STEP 0
#define SLOW_AT 0
#define SLOW 0
#endif

volatile uint16_t runs;

ISR(TIMER2_COMPA_vect)
{
  if (++runs == SLOW_AT) __builtin_avr_delay_cycles(SLOW);
  OCR2A += STEP;
}

int main(void)
{
  OCR2A = MATCH;
  TIMSK2 = 1 << OCIE2A;
  sei();
  __builtin_avr_delay_cycles(NOPS);
  TCCR2B = CLOCK;
  __builtin_avr_delay_cycles(1000);
  GTCCR = RESTART;
  for (;;) {
  }
}
