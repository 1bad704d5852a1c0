/* An endpoint of two banks of 8 bytes that sends, without a computer: how its flags and counters
 * follow what the CPU fills in and gives away. Mark 1 is the end. */
#include <avr/io.h>
#include <stdint.h>

enum { KILLBK = RXOUTI };  /* of an endpoint that sends; avr-libc has no name for it */

volatile uint8_t seen[9];

static void fill(uint8_t count)
{
  while (count--) UEDATX = count;
}

int main(void)
{
  UHWCON |= 1 << UVREGE;
  USBCON = 1 << USBE | 1 << FRZCLK;
  PLLCSR |= 1 << PINDIV;
  PLLCSR |= 1 << PLLE;
  while (!(PLLCSR & 1 << PLOCK)) {
  }
  USBCON = (USBCON & ~(1 << FRZCLK)) | 1 << OTGPADE;
  UENUM = 3;
  UECONX = 1 << EPEN;
  UECFG0X = 1 << EPTYPE1 | 1 << EPDIR;
  UECFG1X = 1 << EPBK0 | 1 << ALLOC;
  seen[0] = UESTA0X;
  seen[1] = UEINTX;
  fill(7);
  seen[2] = UEBCLX;
  fill(1);
  seen[3] = UEINTX;
  UEINTX = (uint8_t)~(1 << FIFOCON | 1 << TXINI | 1 << KILLBK);
  seen[4] = UEINTX;
  seen[5] = UEBCLX;
  seen[6] = UESTA0X;
  fill(1);
  UEINTX = (uint8_t)~(1 << FIFOCON | 1 << TXINI | 1 << KILLBK);
  seen[7] = UEINTX;
  seen[8] = UESTA0X;
  EEDR = 1;
  for (;;) {
  }
}
