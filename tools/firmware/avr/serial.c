#include "tools/firmware/avr/serial.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stddef.h>

#ifndef FW_BAUD
#define FW_BAUD 115200UL
#endif
// The nearest to the wanted rate, with the divider by 8: 115200 becomes 117647, which is 2.1 % off
// and well within what 8N1 bears; 250000, 500000 and 1000000 are exact.
#define DIVIDER ((F_CPU + 4 * FW_BAUD) / (8 * FW_BAUD) - 1)

// At 115200 baud 11 ms of bytes: longer than one tick's computing takes.
#define RECEIVED 128  // a power of 2

static uint8_t received[RECEIVED];
static volatile uint8_t received_to;  // where the next byte goes; the interrupt's
static uint8_t received_from;

static uint8_t frame[FW_STATUS_FRAME_BYTES];
static volatile uint8_t left;  // bytes to send
static const uint8_t* to_send;

void SerialStart(void) {
  UCSR0A = _BV(U2X0);
  UBRR0 = DIVIDER;
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXCIE0) | _BV(RXEN0) | _BV(TXEN0);
}

ISR(USART_RX_vect) {
  const uint8_t byte = UDR0;
  const uint8_t to = received_to;
  const uint8_t after = (to + 1U) & (RECEIVED - 1U);
  if (after == received_from) return;
  received[to] = byte;
  received_to = after;
}

bool SerialRead(uint8_t* byte) {
  const uint8_t from = received_from;
  if (from == received_to) return false;
  *byte = received[from];
  *(volatile uint8_t*)&received_from = (from + 1U) & (RECEIVED - 1U);
  return true;
}

ISR(USART_UDRE_vect) {
  UDR0 = *to_send++;
  if (--left == 0) UCSR0B &= (uint8_t)~_BV(UDRIE0);
}

uint8_t* SerialFrame(void) { return left == 0 ? frame : NULL; }

void SerialSend(uint8_t size) {
  to_send = frame;
  left = size;
  UCSR0B |= _BV(UDRIE0);
}
