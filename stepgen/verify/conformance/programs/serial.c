/* Sends back each byte plus one, by interrupts, at 250 kbaud. */
#include <avr/interrupt.h>
#include <avr/io.h>

volatile uint8_t next;
ISR(USART_RX_vect)
{
  next = UDR0 + 1;
  UCSR0B |= 1 << UDRIE0;
}
ISR(USART_UDRE_vect)
{
  UDR0 = next;
  UCSR0B &= ~(1 << UDRIE0);
}

int main(void)
{
  UBRR0 = 3;
  UCSR0B = 1 << RXEN0 | 1 << TXEN0 | 1 << RXCIE0;
  sei();
  for (;;) {
  }
}
