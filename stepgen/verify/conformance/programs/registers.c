/* What the 16-bit registers of a stopped or slow timer hold after accesses by bytes. */
#include <avr/io.h>

volatile uint8_t bytes[6];
volatile uint8_t flags[3];
volatile uint16_t counts[2];

int main(void)
{
  TCNT1 = 0x1234;
  bytes[0] = TCNT1L; /* latches 0x12 */
  OCR1AH = 0x56;     /* the same TEMP */
  bytes[1] = TCNT1H;
  OCR1AL = 0x78;
  bytes[2] = OCR1AL;
  bytes[3] = OCR1AH;
  ICR1H = 0x03;      /* normal mode: ICR1 is read-only */
  ICR1L = 0xE7;
  bytes[4] = ICR1L;
  bytes[5] = ICR1H;

  /* A write to TCNT1 blocks the compare of the next timer clock. */
  OCR1A = 100;
  TCNT1 = 100;
  TIFR1 = 0xFF;
  TCCR1B = 1;
  __builtin_avr_delay_cycles(20);
  TCCR1B = 0;
  flags[0] = TIFR1;
  TCNT1 = 99;
  TCCR1B = 1;
  __builtin_avr_delay_cycles(20);
  TCCR1B = 0;
  flags[1] = TIFR1;

  /* sbi clears only its own flag. */
  OCR1B = 150;
  TCNT1 = 90;
  TCCR1B = 1;
  __builtin_avr_delay_cycles(100);
  TCCR1B = 0;
  asm volatile("sbi %0, 1" ::"I"(_SFR_IO_ADDR(TIFR1)));
  flags[2] = TIFR1;

  /* Clock on for exactly 10 cycles: from the end of one sts to the end of the other. */
  TCNT1 = 1000;
  asm volatile("sts %0, %1\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tsts %0, "
               "__zero_reg__" ::"i"(_SFR_MEM_ADDR(TCCR1B)),
               "r"((uint8_t)1));
  counts[0] = TCNT1;
  counts[1] = TCNT1;
  EEDR = 1;
  for (;;) {
  }
}
