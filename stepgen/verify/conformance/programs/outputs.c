/* Normal mode: OC1A (PB1) is set at each match and cleared by FOC1A; the next match is STEP later.
 * From LAST matches on they are to change nothing: OC1A is cleared at them. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t matches;

ISR(TIMER1_COMPA_vect)
{
  TCCR1A = 1 << COM1A1;
  TCCR1C = 1 << FOC1A;
  if (++matches < LAST) TCCR1A = 1 << COM1A1 | 1 << COM1A0;
  OCR1A += STEP;
}

int main(void)
{
  DDRB = 1 << 1;
  OCR1A = STEP;
  TIMSK1 = 1 << OCIE1A;
  TCCR1A = 1 << COM1A1 | 1 << COM1A0;
  sei();
  TCCR1B = 1;
  for (;;) {
  }
}
