/* USB as the Arduino core switches it on, with an interrupt for each frame that begins: it toggles
 * PB5. Mark 1 is when the PLL has locked. */
#include <avr/interrupt.h>
#include <avr/io.h>

ISR(USB_GEN_vect)
{
  if (UDINT & 1 << SOFI) PINB = 1 << 5;
  UDINT &= ~(1 << EORSTI | 1 << SOFI);
}

int main(void)
{
  DDRB = 1 << 5;
  UHWCON |= 1 << UVREGE;
  USBCON = 1 << USBE | 1 << FRZCLK;
  PLLCSR |= 1 << PINDIV;
  PLLCSR |= 1 << PLLE;
  while (!(PLLCSR & 1 << PLOCK)) {
  }
  EEDR = 1;
  USBCON = (USBCON & ~(1 << FRZCLK)) | 1 << OTGPADE;
  UDCON &= ~(1 << RSTCPU | 1 << LSM | 1 << RMWKUP | 1 << DETACH);
  UDIEN = 1 << EORSTE | 1 << SOFE | 1 << SUSPE;
  sei();
  for (;;) {
  }
}
