/* Writes bytes to I/O registers as a table in RAM says, with waits between, then mark 1. */
#include <avr/io.h>

struct {
  uint16_t address;
  uint8_t value, wait;
} script[200]; /* filled in at mark 2 */

int main(void)
{
  TIMSK1 = 1 << ICIE1 | 1 << OCIE1B | 1 << OCIE1A | 1 << TOIE1;
  EEDR = 2;
  for (uint8_t i = 0; i < 200; i++) {
    *(volatile uint8_t *)script[i].address = script[i].value;
    for (volatile uint8_t wait = script[i].wait; wait; wait--) {
    }
  }
  EEDR = 1;
  for (;;) {
  }
}
