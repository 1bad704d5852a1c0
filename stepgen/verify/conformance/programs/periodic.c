/* A timer that interrupts for ever: MODE and CLOCK are the WGM and CS bits of timer 1,
 * TOP_VALUE its TOP, NOPS shifts the start, IDLE sleeps instead of looping,
 * UNWATCHED enables no interrupt of the timer. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#ifndef NOPS
#define NOPS 0
#endif
#define HAS_ICR_TOP (MODE == 12 || MODE == 14)
#define HAS_OVERFLOW (MODE >= 14 || MODE <= 1)

static inline void toggle(void)
{
  asm volatile("sbi %0, 5" ::"I"(_SFR_IO_ADDR(PINB)));
}

ISR(TIMER1_OVF_vect, ISR_NAKED) { toggle(); reti(); }
ISR(TIMER1_COMPA_vect, ISR_NAKED) { toggle(); reti(); }
ISR(TIMER1_CAPT_vect, ISR_NAKED) { toggle(); reti(); }

int main(void)
{
  DDRB = 1 << 5;
  OCR1A = TOP_VALUE;
  TCCR1A = MODE & 3;
  TCCR1B = (MODE >> 2) << 3;
  if (HAS_ICR_TOP) ICR1 = TOP_VALUE;
#ifndef UNWATCHED
  TIMSK1 = HAS_OVERFLOW ? 1 << TOIE1 : HAS_ICR_TOP ? 1 << ICIE1 : 1 << OCIE1A;
#endif
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
  __builtin_avr_delay_cycles(NOPS);
  TCCR1B |= CLOCK;
  for (;;) {
#ifdef IDLE
    sleep_cpu();
#endif
  }
}
