/* Timer 2 in normal mode that interrupts once a lap: CLOCK are its CS bits, MATCH its OCR2A, NOPS
 * shifts the start, RESTART is written to GTCCR 1000 cycles later. */
#include <avr/interrupt.h>
#include <avr/io.h>

#ifndef RESTART
#define RESTART 0
#endif

EMPTY_INTERRUPT(TIMER2_COMPA_vect)

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
