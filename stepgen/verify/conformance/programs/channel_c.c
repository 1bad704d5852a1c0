/* Compare C of timer 5 matches while interrupts are off: first its enable bit is cleared (marks 1 and 2), then
 * its flag by a write (marks 3 and 4), at last nothing (marks 5 and 6). */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t runs;
ISR(TIMER5_COMPC_vect) { runs++; }

/* Lets a match come while interrupts are off. */
static void match(void)
{
  TIMSK5 = 1 << OCIE5C;
  TCNT5 = 0;
  __builtin_avr_delay_cycles(2000);
}

int main(void)
{
  OCR5C = 1000;
  TCCR5B = 1;
  match();
  TIMSK5 = 0;
  EEDR = 1;
  sei();
  __builtin_avr_delay_cycles(100);
  cli();
  EEDR = 2;
  match();
  TIFR5 = 1 << OCF5C;
  EEDR = 3;
  sei();
  __builtin_avr_delay_cycles(100);
  cli();
  EEDR = 4;
  match();
  EEDR = 5;
  sei();
  __builtin_avr_delay_cycles(100);
  cli();
  EEDR = 6;
  for (;;) {
  }
}
