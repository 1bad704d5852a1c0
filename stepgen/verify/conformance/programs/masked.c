/* A compare every 1000 cycles, first with interrupts off for 2500 cycles (mark 1 before,
 * mark 2 after), then a window of one instruction (marks 3 and 4), then none (5 and 6). */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t runs;
ISR(TIMER1_COMPA_vect) { runs++; }

int main(void)
{
  TCCR1B = 1 << WGM12;
  OCR1A = 999;
  TIMSK1 = 1 << OCIE1A;
  TCCR1B |= 1;
  EEDR = 1;
  __builtin_avr_delay_cycles(2500);
  asm volatile("sei\n\tnop\n\tnop\n\tcli");
  EEDR = 2;
  __builtin_avr_delay_cycles(1000);
  EEDR = 3;
  asm volatile("sei\n\tnop\n\tcli");
  EEDR = 4;
  __builtin_avr_delay_cycles(1000);
  EEDR = 5;
  asm volatile("sei\n\tcli");
  EEDR = 6;
  /* The flag is up. With its enable bit clear it waits, with the bit set it fires. */
  TIMSK1 = 0;
  sei();
  __builtin_avr_delay_cycles(100);
  EEDR = 7;
  TIMSK1 = 1 << OCIE1A;
  asm volatile("nop");
  EEDR = 8;
  for (;;) {
  }
}
