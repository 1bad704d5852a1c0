/* All 16-bit timers but an Uno's one, in mode 15, with TOPs of their own, and timer 0 of simavr
 * waking the CPU from idle sleep. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

EMPTY_INTERRUPT(TIMER0_OVF_vect)
EMPTY_INTERRUPT(TIMER1_OVF_vect)
EMPTY_INTERRUPT(TIMER3_OVF_vect)
#ifdef TCCR5A /* timer 4 of the ATmega32U4 has 10 bits */
EMPTY_INTERRUPT(TIMER4_OVF_vect)
EMPTY_INTERRUPT(TIMER5_OVF_vect)
#endif

#define START(n, top)           \
  OCR##n##A = top;              \
  TCCR##n##A = 3;               \
  TIMSK##n = 1 << TOIE##n;      \
  TCCR##n##B = 3 << 3 | 1

int main(void)
{
  START(1, 999);
  START(3, 1999);
#ifdef TCCR5A
  START(4, 2999);
  START(5, 3999);
#endif
  TIMSK0 = 1 << TOIE0;
  TCCR0B = 2;
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
  for (;;) sleep_cpu();
}
