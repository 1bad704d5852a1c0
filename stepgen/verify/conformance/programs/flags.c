/* Overflows while interrupts are off: the flag is seen, cleared by writing a one, and nothing
 * comes when interrupts are on again; then one that is not cleared comes. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t seen[3];
volatile uint8_t runs;
ISR(TIMER1_OVF_vect) { runs++; }

int main(void)
{
  OCR1A = 499;
  TCCR1A = 3;
  TIMSK1 = 1 << TOIE1;
  TCCR1B = 3 << 3 | 1;
  __builtin_avr_delay_cycles(600);
  seen[0] = TIFR1 & 1 << TOV1;
  TCCR1B = 3 << 3;
  TIFR1 = 1 << TOV1;
  seen[1] = TIFR1 & 1 << TOV1;
  sei();
  __builtin_avr_delay_cycles(100);
  cli();
  seen[2] = runs;
  EEDR = 1;
  for (;;) {
  }
}
