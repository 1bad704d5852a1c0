/* Sleeps with interrupts off, or runs off the end of the flash. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

int main(void)
{
#ifdef LOST
  asm volatile("jmp 0x7F00");
#else
  cli();
  sleep_enable();
  sleep_cpu();
#endif
  for (;;) {
  }
}
