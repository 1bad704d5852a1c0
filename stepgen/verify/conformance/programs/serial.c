/* Sends back each byte plus one, by interrupts, at 250 kbaud. */
#include <avr/interrupt.h>
#include <avr/io.h>

#ifndef UDR0 /* the ATmega32U4 has one, too, and calls it USART1 */
#define USART_RX_vect USART1_RX_vect
#define USART_UDRE_vect USART1_UDRE_vect
#define UDR0 UDR1
#define UBRR0 UBRR1
#define UCSR0B UCSR1B
#define UDRIE0 UDRIE1
#define RXEN0 RXEN1
#define TXEN0 TXEN1
#define RXCIE0 RXCIE1
#endif

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
