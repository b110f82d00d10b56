#ifndef FACEWIRE_TOOLS_FIRMWARE_AVR_SERIAL_H_
#define FACEWIRE_TOOLS_FIRMWARE_AVR_SERIAL_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/message.h"

// The serial line, 8N1 at FW_BAUD, by interrupts.

void SerialStart(void);

// The next byte that came. When the buffer was full, bytes are missing: the CRC tells.
bool SerialRead(uint8_t* byte);

// The memory for the next frame to send; null while one is on its way.
uint8_t* SerialFrame(void);
// Sends the first `size` bytes of it.
void SerialSend(uint8_t size);

#endif  // FACEWIRE_TOOLS_FIRMWARE_AVR_SERIAL_H_
