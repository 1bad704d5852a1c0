/* The smallest serial port over USB (CDC ACM): it sends each byte that it gets plus one. `seen`
 * holds the bRequest of each request; mark 1 is the refusal of one that it does not know. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <stdint.h>

enum { KILLBK = RXOUTI };  /* of an endpoint that sends; avr-libc has no name for it */

enum { COMMUNICATION_IN = 1, PORT_OUT = 2, PORT_IN = 3, FROM_BOARD = 0x80 };
enum { SET_ADDRESS = 5, GET_DESCRIPTOR = 6, SET_CONFIGURATION = 9, SET_LINE_CODING = 0x20, SET_LINE_STATE = 0x22 };

static const uint8_t DEVICE[] PROGMEM = {18, 1, 0, 2, 2, 0, 0, 8, 0x41, 0x23, 1, 0, 0, 1, 0, 0, 0, 1};
static const uint8_t CONFIGURATION[] PROGMEM = {
    9, 2, 67, 0, 2, 1, 0, 0x80, 50,                    /* two interfaces */
    9, 4, 0, 0, 1, 2, 2, 0, 0,                         /* communication */
    5, 0x24, 0, 0x10, 1, 5, 0x24, 1, 0, 1,
    4, 0x24, 2, 2, 5, 0x24, 6, 0, 1,
    7, 5, FROM_BOARD | COMMUNICATION_IN, 3, 8, 0, 64,
    9, 4, 1, 0, 2, 10, 0, 0, 0,                        /* data */
    7, 5, PORT_OUT, 2, 8, 0, 0,
    7, 5, FROM_BOARD | PORT_IN, 2, 8, 0, 0,
};

volatile uint8_t seen[8], coding[7], count;

static void configure(uint8_t number, uint8_t type, uint8_t shape)
{
  UENUM = number;
  UECONX = 1 << EPEN;
  UECFG0X = type;
  UECFG1X = shape | 1 << ALLOC;
}

ISR(USB_GEN_vect)
{
  UDINT = 0;
  configure(0, 0, 0);  /* 8 bytes */
  UEIENX = 1 << RXSTPE;
}

static void send(const uint8_t *bytes, uint8_t size)
{
  for (;;) {
    uint8_t part = size < 8 ? size : 8;
    while (!(UEINTX & (1 << TXINI | 1 << RXOUTI))) {
    }
    if (UEINTX & 1 << RXOUTI) return;
    for (uint8_t i = 0; i < part; i++) UEDATX = pgm_read_byte(bytes++);
    UEINTX = (uint8_t)~(1 << TXINI);
    size -= part;
    if (part < 8) return;
  }
}

/* The status stage of a request to the board: a packet without bytes, and until it has gone. */
static void agree(void)
{
  UEINTX = (uint8_t)~(1 << TXINI);
  while (!(UEINTX & 1 << TXINI)) {
  }
}

static void receive_coding(void)
{
  while (!(UEINTX & 1 << RXOUTI)) {
  }
  for (uint8_t i = 0; i < sizeof coding; i++) coding[i] = UEDATX;
  UEINTX = (uint8_t)~(1 << RXOUTI);
}

ISR(USB_COM_vect)
{
  uint8_t before = UENUM;
  UENUM = 0;
  uint8_t setup[8];
  for (uint8_t i = 0; i < 8; i++) setup[i] = UEDATX;
  UEINTX = (uint8_t)~(1 << RXSTPI);
  if (count < sizeof seen) seen[count++] = setup[1];
  switch (setup[1]) {
    case GET_DESCRIPTOR:
      if (setup[3] == 1) send(DEVICE, sizeof DEVICE);
      else send(CONFIGURATION, sizeof CONFIGURATION);
      break;
    case SET_ADDRESS:
      agree();
      UDADDR = setup[2];
      UDADDR |= 1 << ADDEN;
      break;
    case SET_CONFIGURATION:
      configure(COMMUNICATION_IN, 1 << EPTYPE1 | 1 << EPTYPE0 | 1 << EPDIR, 0);
      configure(PORT_OUT, 1 << EPTYPE1, 1 << EPBK0);
      configure(PORT_IN, 1 << EPTYPE1 | 1 << EPDIR, 1 << EPBK0);
      UENUM = 0;
      agree();
      break;
    case SET_LINE_CODING:
      receive_coding();
      agree();
      break;
#ifdef STALLS
    case SET_LINE_STATE:
      UECONX = 1 << STALLRQ | 1 << EPEN;
      EEDR = 1;
      break;
#endif
    default:
      agree();
  }
  UENUM = before;
}

static uint8_t flags_of(uint8_t endpoint)
{
  UENUM = endpoint;
  return UEINTX;
}

/* Bytes in FIFO to bytes out: each packet that came is answered by one. */
static void echo(void)
{
  if (!(flags_of(PORT_OUT) & 1 << RXOUTI) || !(flags_of(PORT_IN) & 1 << TXINI)) return;
  UENUM = PORT_OUT;
  UEINTX = (uint8_t)~(1 << RXOUTI | 1 << NAKOUTI);
  while (UEINTX & 1 << RWAL) {
    uint8_t letter = UEDATX;
    UENUM = PORT_IN;
    UEDATX = letter + 1;
    UENUM = PORT_OUT;
  }
  UEINTX = (uint8_t)~(1 << FIFOCON);
  UENUM = PORT_IN;
  UEINTX = (uint8_t)~(1 << TXINI | 1 << KILLBK);
  UEINTX = (uint8_t)~(1 << FIFOCON | 1 << KILLBK);
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
  UDCON &= ~(1 << RSTCPU | 1 << LSM | 1 << RMWKUP | 1 << DETACH);
  UDIEN = 1 << EORSTE;
  sei();
  for (;;) echo();
}
