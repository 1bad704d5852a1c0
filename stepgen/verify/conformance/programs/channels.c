/* Normal mode: compare A adds STEP_A to OCR1A, compare B adds STEP_B to OCR1B, and meanwhile the main
 * program reads TCNT1, all by way of the one TEMP; the main program has interrupts off for that. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint16_t last;

ISR(TIMER1_COMPA_vect)
{
  OCR1A += STEP_A;
}

ISR(TIMER1_COMPB_vect)
{
  OCR1B += STEP_B;
}

int main(void)
{
  OCR1A = STEP_A;
  OCR1B = STEP_B;
  TIMSK1 = 1 << OCIE1A | 1 << OCIE1B;
  sei();
  TCCR1B = 1;
  for (;;) {
    cli();
    last = TCNT1;
    sei();
  }
}
