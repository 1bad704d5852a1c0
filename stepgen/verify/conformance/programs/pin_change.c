/* Counts changes of PB0, which is an input. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t runs;
ISR(PCINT0_vect) { runs++; }

int main(void)
{
  PCMSK0 = 1;
  PCICR = 1;
  sei();
  EEDR = 1;
  for (;;) {
  }
}
