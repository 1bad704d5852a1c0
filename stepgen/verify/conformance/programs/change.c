/* A running timer whose compare value and prescaler change once, DELAY cycles after an
 * overflow or compare: FROM and TO are OCR1A, CLOCK_TO the new CS bits. */
#include <avr/interrupt.h>
#include <avr/io.h>

EMPTY_INTERRUPT(TIMER1_OVF_vect)
EMPTY_INTERRUPT(TIMER1_COMPA_vect)

int main(void)
{
  OCR1A = FROM;
  TCCR1A = MODE & 3;
  TCCR1B = (MODE >> 2) << 3;
  TIMSK1 = MODE == 15 ? 1 << TOIE1 : 1 << OCIE1A;
  sei();
  TCCR1B |= 1;
  __builtin_avr_delay_cycles(3 * (FROM + 1UL) + DELAY);
  OCR1A = TO;
  TCCR1B = (MODE >> 2) << 3 | CLOCK_TO;
#ifdef RESTART
  TCNT1 = 0;
#endif
  EEDR = 1;
  for (;;) {
  }
}
