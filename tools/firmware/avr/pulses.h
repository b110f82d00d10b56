#ifndef FACEWIRE_TOOLS_FIRMWARE_AVR_PULSES_H_
#define FACEWIRE_TOOLS_FIRMWARE_AVR_PULSES_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/message.h"

// Servo pulses at the pins D2 .. D13 (PD2 .. PD7, PB0 .. PB5), servo 0 first, one period every
// FW_TICK_MS, by timer 1.

void PulsesStart(void);

// True once a period, late enough in it that what is set at once shows in the next.
bool PulsesTick(void);

// The pulses from the next period on, in half microseconds, 0 for none.
void PulsesSet(const uint16_t width[FW_SERVOS]);

#endif  // FACEWIRE_TOOLS_FIRMWARE_AVR_PULSES_H_
