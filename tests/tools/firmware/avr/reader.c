// A host on an ATmega1284P at 16 MHz: the firmware's decoder reads the serial line at 115200 baud,
// and every message goes to GPIOR0, character by character, where the simulator listens. When
// GPIOR1 is set and the line's bytes are read, it writes what it counted and sleeps for ever.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <util/atomic.h>

#include "tests/tools/firmware/avr/messages.h"
#include "tools/firmware/decoder.h"

// Writing the longest message takes as long as so many bytes at most.
#define RECEIVED 4096

static uint8_t received[RECEIVED];
static volatile uint16_t received_to;
static uint16_t received_from;
static volatile bool overrun;

ISR(USART0_RX_vect) {
  const uint8_t byte = UDR0;
  const uint16_t after = (received_to + 1U) % RECEIVED;
  if (after == received_from) {
    overrun = true;
    return;
  }
  received[received_to] = byte;
  received_to = after;
}

static bool Next(uint8_t* byte) {
  bool any = false;
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    any = received_from != received_to;
    if (any) {
      *byte = received[received_from];
      received_from = (received_from + 1U) % RECEIVED;
    }
  }
  return any;
}

void WriteCharacter(char character) { GPIOR0 = (uint8_t)character; }

static uint32_t outcomes[4];

static void Count(const char* key, uint32_t count) {
  WriteText(key);
  WriteNumber(count);
}

static void WriteCounts(const FwLinkStats* stats) {
  Count("{\"frames\":", outcomes[kRead]);
  Count(",\"unknown\":", outcomes[kUnknown]);
  Count(",\"versions\":", stats->versions);
  Count(",\"malformed\":", outcomes[kMalformed]);
  Count(",\"crc_errors\":", stats->crc_errors);
  Count(",\"cobs_errors\":", stats->cobs_errors);
  Count(",\"truncated\":", stats->truncated);
  Count(",\"overflows\":", stats->overflows);
  Count(",\"lost\":", stats->lost);
  Count(",\"restarts\":", stats->restarts);
  Count(",\"resyncs\":", stats->resyncs);
  // What a large memory never has.
  if (outcomes[kUnread] > 0) Count(",\"unread\":", outcomes[kUnread]);
  if (overrun) Count(",\"overrun\":", 1);
  WriteText("}\n");
}

int main(void) {
  static FwDecoder decoder;
  FwDecoderInit(&decoder);
  UCSR0A = _BV(U2X0);
  UBRR0 = 16;  // 117647 baud, as the firmware
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXCIE0) | _BV(RXEN0);
  sei();
  for (;;) {
    const bool over = GPIOR1 != 0;
    uint8_t byte;
    if (Next(&byte)) {
      FwFrame frame;
      if (FwDecoderTake(&decoder, byte, &frame)) ++outcomes[WriteMessage(&frame)];
    } else if (over) {
      WriteCounts(&decoder.stats);
      cli();
      sleep_mode();
    }
  }
}
