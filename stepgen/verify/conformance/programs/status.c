/* Reads UCSR0A after writes to it, before and after a byte has gone out. */
#include <avr/io.h>

volatile uint8_t seen[4];

int main(void)
{
  UCSR0B = 1 << TXEN0;
  UCSR0A = 1 << U2X0 | 1 << TXC0;
  seen[0] = UCSR0A;
  UDR0 = 'A';
  while (!(UCSR0A & 1 << TXC0)) {
  }
  seen[1] = UCSR0A;
  UCSR0A = 1 << U2X0;
  seen[2] = UCSR0A;
  UCSR0A = 1 << U2X0 | 1 << TXC0;
  seen[3] = UCSR0A;
  EEDR = 1;
  for (;;) {
  }
}
