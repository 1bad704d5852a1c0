/* An ISR that calls a function with a frame of 20 bytes; variables to poke and peek. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint16_t asked = 0x0102, answered;

ISR(TIMER1_OVF_vect, ISR_NAKED)
{
  asm volatile(
      "push r24\n\t"
      "rcall 1f\n\t"
      "pop r24\n\t"
      "reti\n"
      "1:\n\t"
      "push r24\n\t"
      "push r24\n\t"
      "push r24\n\t"
      "pop r24\n\t"
      "pop r24\n\t"
      "pop r24\n\t"
      "ret");
}

int main(void)
{
  TIMSK1 = 1 << TOIE1;
  TCNT1 = 0xFF00;
  TCCR1B = 1;
  sei();
  for (;;) {
    answered = asked + 1;
    if (answered == 0x1000) EEDR = 9;
  }
}
