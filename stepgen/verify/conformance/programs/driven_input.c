/* Looks at PB0, an input that is pulled up, while other bits of its port change. */
#include <avr/io.h>

volatile uint8_t seen[4];

/* Waits for the next look, which is asked for with a mark; then PB5 has changed. */
static uint8_t look(uint8_t mark)
{
  PORTB ^= 0x20;
  EEDR = mark;
  for (uint8_t i = 0; i < 50; i++)
    __asm__ volatile("nop");
  PORTB ^= 0x20;
  return PINB & 1;
}

int main(void)
{
  DDRB = 0x20;
  PORTB = 1;
  for (uint8_t i = 0; i < 4; i++)
    seen[i] = look(i + 1);
  EEDR = 5;
  for (;;) {
  }
}
