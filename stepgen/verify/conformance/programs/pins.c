/* Compare outputs OC1A (PB1) in normal mode: toggled, set, cleared; levels read from PINB. */
#include <avr/io.h>

volatile uint8_t levels[4];

static uint8_t after_match(uint8_t mode)
{
  TCCR1A = mode << 6;
  TCNT1 = 0;
  OCR1A = 50;
  TCCR1B = 1;
  __builtin_avr_delay_cycles(100);
  TCCR1B = 0;
  return PINB >> 1 & 1;
}

int main(void)
{
  DDRB = 1 << 1;
  levels[0] = after_match(3); /* set */
  levels[1] = after_match(1); /* toggle */
  levels[2] = after_match(1);
  levels[3] = after_match(2); /* clear */
  EEDR = 1;
  for (;;) {
  }
}
