/* Each way to toggle pins by PINx, from PORTB = 0x24 on. */
#include <avr/io.h>

int main(void)
{
  DDRB = 0x3C;
  PORTB = 0x24;
  PINB = 0x0C;
  asm volatile("sbi %0, 4" ::"I"(_SFR_IO_ADDR(PINB)));
  asm volatile("cbi %0, 4" ::"I"(_SFR_IO_ADDR(PINB)));
  asm volatile("sts %0, %1" ::"i"(_SFR_MEM_ADDR(PINB)), "r"((uint8_t)0x21));
  asm volatile("sbi %0, 2" ::"I"(_SFR_IO_ADDR(PORTB)));
#ifdef PINH
  PORTH = 0x18;
  PINH = 0x10;
#endif
  EEDR = 1;
  for (;;) {
  }
}
