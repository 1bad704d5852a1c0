/* FOC1A on a timer that stands still: OC1A (PB1) is set, toggled and cleared, and PORTB shows again
 * where the unit is disconnected; no flag is set. PINB is read a clock later, behind its latch. */
#include <avr/cpufunc.h>
#include <avr/io.h>

volatile uint8_t levels[7];
volatile uint8_t flag;

static uint8_t after_strobe(uint8_t mode)
{
  TCCR1A = mode << COM1A0;
  TCCR1C = 1 << FOC1A;
  _NOP();
  return PINB >> 1 & 1;
}

int main(void)
{
  DDRB = 1 << 1;
  levels[0] = after_strobe(3); /* set */
  levels[1] = after_strobe(0); /* PORTB1, which is 0 */
  levels[2] = after_strobe(3);
  levels[3] = after_strobe(1); /* toggle */
  levels[4] = after_strobe(1);
  levels[5] = after_strobe(2); /* clear */
  PORTB = 1 << 1;
  levels[6] = after_strobe(0); /* PORTB1, which is 1 */
  flag = TIFR1 >> OCF1A & 1;
  EEDR = 1;
  for (;;) {
  }
}
