/* A running timer in mode 15 is set to work anew, in the order that the datasheet asks for:
 * stop, mode 12 (in which OCR1A is taken at once), OCR1A, TCNT1, mode 15, OCR1A, clock.
 * With LATE the old compare value goes to the comparator: mode 15 first, then OCR1A. */
#include <avr/interrupt.h>
#include <avr/io.h>

EMPTY_INTERRUPT(TIMER1_OVF_vect)

int main(void)
{
  TIMSK1 = 1 << TOIE1;
  sei();
#ifdef LATE
  TCCR1A = 3;
  TCCR1B = 3 << 3;
  OCR1A = TO;
#else
  OCR1A = FROM;
  TCCR1A = 3;
  TCCR1B = 3 << 3 | 1;
  __builtin_avr_delay_cycles(2 * FROM + FROM / 2);
  cli();
  TCCR1B = 3 << 3;
  TCCR1A = 0;
  OCR1A = TO;
  TCNT1 = ELAPSED;
  TCCR1A = 3;
  OCR1A = TO;
  TIFR1 = 1 << TOV1;
  sei();
#endif
  TCCR1B = 3 << 3 | CLOCK;
  EEDR = 1;
  for (;;) {
  }
}
