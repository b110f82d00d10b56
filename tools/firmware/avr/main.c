// A receiver of servo pulses on an ATmega328P at 16 MHz: wiring and building in
// tools/firmware/README.md.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>
#include <stddef.h>

#include "tools/firmware/avr/pulses.h"
#include "tools/firmware/avr/serial.h"
#include "tools/firmware/decoder.h"
#include "tools/firmware/receiver.h"
#include "tools/firmware/retained.h"

// A0 is high while a tick is computed: for a test, or an oscilloscope.
#define BUSY_PIN _BV(PC0)

// Neither is cleared at the start.
static FwRetained retained __attribute__((section(".noinit")));
static uint8_t reset_causes __attribute__((section(".noinit")));

// Before anything else: after a reset by the watchdog it is still running, at its shortest time.
__attribute__((naked, used, section(".init3"))) void NoteReset(void);
void NoteReset(void) {
  reset_causes = MCUSR & 0x0FU;  // the numbers are those of the protocol
  MCUSR = 0;
  wdt_disable();
}

// The processor's supply from its own reference of 1.1 V, measured in turn with everything else.
static void SupplyStart(void) {
  ADMUX = _BV(REFS0) | 0x0EU;
  ADCSRA = _BV(ADEN) | _BV(ADSC) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
}

static uint16_t SupplyMillivolts(void) {
  const uint16_t reading = ADC;
  ADCSRA |= _BV(ADSC);
  return reading == 0 ? 0 : (uint16_t)(UINT32_C(1100) * 1024 / reading);
}

int main(void) {
  static FwDecoder decoder;
  static FwReceiver receiver;
  FwDecoderInit(&decoder);
  FwReceiverInit(&receiver, FwRemember(&retained));
  DDRC |= BUSY_PIN;
  SupplyStart();
  SerialStart();
  PulsesStart();
  // Pulses go on by themselves when this loop hangs, so something else must end it.
  wdt_enable(WDTO_120MS);
  sei();
  for (;;) {
    uint8_t byte;
    FwFrame frame;
    if (SerialRead(&byte) && FwDecoderTake(&decoder, byte, &frame)) {
      FwReceiverTake(&receiver, &frame);
    }
    if (!PulsesTick()) continue;
    wdt_reset();
    PORTC |= BUSY_PIN;
    FwDecoderTick(&decoder);
    FwReceiverTick(&receiver);
    uint16_t values[FW_SERVOS];
    for (uint8_t i = 0; i < FW_SERVOS; ++i) values[i] = FwReceiverPulse(&receiver, i);
    PulsesSet(values);
    for (uint8_t i = 0; i < FW_SERVOS; ++i) values[i] = FwReceiverPosition(&receiver, i);
    FwRetain(&retained, (uint8_t)receiver.ticks, values);
    uint8_t* status = FwReceiverStatusDue(&receiver) ? SerialFrame() : NULL;
    if (status != NULL) {
      SerialSend(FwReceiverWriteStatus(&receiver, &decoder.stats, reset_causes, SupplyMillivolts(),
                                       status));
    }
    PORTC &= (uint8_t)~BUSY_PIN;
  }
}
