/* Normal mode: compare A adds STEP to OCR1A; at SLOW_AT it comes too late for the next match. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t runs;

ISR(TIMER1_COMPA_vect)
{
  if (++runs == SLOW_AT) __builtin_avr_delay_cycles(2 * STEP);
  OCR1A += STEP;
}

int main(void)
{
  OCR1A = STEP;
  TIMSK1 = 1 << OCIE1A;
  sei();
  TCCR1B = 1;
  for (;;) {
  }
}
