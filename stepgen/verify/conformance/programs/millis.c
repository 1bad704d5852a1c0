/* Timer 0 as the Arduino core sets it: fast PWM to 255, prescaler 64, overflow interrupt. */
#include <avr/interrupt.h>
#include <avr/io.h>

ISR(TIMER0_OVF_vect, ISR_NAKED)
{
  asm volatile("sbi %0, 5\n\treti" ::"I"(_SFR_IO_ADDR(PINB)));
}

int main(void)
{
  DDRB = 1 << 5;
  TCCR0A = 3;
  TCCR0B = 3;
  TIMSK0 = 1 << TOIE0;
  sei();
  for (;;) {
  }
}
