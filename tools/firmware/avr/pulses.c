#include "tools/firmware/avr/pulses.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "tools/firmware/edges.h"

// The interrupt comes LEAD ticks before its edge and waits for the exact time, so that neither
// another interrupt nor the instruction at work moves the edge. Entering takes at most about 18
// ticks (another interrupt 8, its own beginning 10); what is left is waited for with a loop of 5
// cycles: an edge is late by 0 to 0.3 us.
#define LEAD 32
// When to compute the next period's pulses: 11 ms before this one ends, of which it takes at
// most 8.
#define TICK_AT 16000

#define PORT_D_PINS 0xFC
#define PORT_B_PINS 0x3F
static const uint8_t kPins[FW_SERVOS] = {4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32};

static FwEdge lists[2][FW_MAX_EDGES];
static volatile uint8_t active;   // which of them is the present period's
static volatile uint8_t planned;  // the other one is ready for the next
// The interrupt's:
static const FwEdge* next;
static uint16_t period;  // when the present one began, in ticks of the timer, which wraps

void PulsesStart(void) {
  static const uint16_t kNone[FW_SERVOS];
  FwPlanEdges(kNone, lists[0]);
  next = lists[0];
  PORTD &= (uint8_t)~PORT_D_PINS;
  PORTB &= (uint8_t)~PORT_B_PINS;
  DDRD |= PORT_D_PINS;
  DDRB |= PORT_B_PINS;
  TCCR1A = 0;
  OCR1A = next->at - LEAD;
  OCR1B = TICK_AT;
  TIMSK1 = _BV(OCIE1A);
  TCCR1B = _BV(CS11);  // counts 2 ticks a microsecond
}

bool PulsesTick(void) {
  if (!(TIFR1 & _BV(OCF1B))) return false;
  TIFR1 = _BV(OCF1B);
  return true;
}

void PulsesSet(const uint16_t width[FW_SERVOS]) {
  planned = 0;  // also what was set and not taken over yet; from here on `active` stays
  FwPlanEdges(width, lists[active ^ 1U]);
  __asm__ volatile("" ::: "memory");  // the list is written before it is offered
  planned = 1;
}

static inline void WaitUntil(uint8_t low_byte_of_time) {
  uint8_t now;
  __asm__ volatile(
      "1: lds %0, %2\n\t"
      "sub %0, %1\n\t"
      "brmi 1b"
      : "=&r"(now)
      : "r"(low_byte_of_time), "n"(_SFR_MEM_ADDR(TCNT1L)));
}

// Only here are the pins written, and only here are 16-bit registers of the timer used after the
// start.
ISR(TIMER1_COMPA_vect) {
  const FwEdge* edge = next;
  uint16_t begin = period;
  uint16_t at = begin + edge->at;
  do {
    const uint8_t what = edge->what;
    if (what & kFwPeriodEnd) {
      active ^= planned;
      planned = 0;
      edge = lists[active];
      begin += FW_PERIOD;
      period = begin;
      OCR1B = begin + TICK_AT;
    } else {
      const uint8_t servo = what & 0x0FU;
      const uint8_t pin = kPins[servo];
      volatile uint8_t* const port = servo < FW_SERVOS / 2 ? &PORTD : &PORTB;
      const uint8_t value = (what & kFwRise) ? *port | pin : *port & (uint8_t)~pin;
      WaitUntil((uint8_t)at);
      *port = value;
      ++edge;
    }
    at = begin + edge->at;
    // So near, or missed, only when something kept this interrupt from its time.
  } while ((uint16_t)(TCNT1 + LEAD + 4 - at) < FW_PERIOD / 8);
  next = edge;
  OCR1A = at - LEAD;
}
