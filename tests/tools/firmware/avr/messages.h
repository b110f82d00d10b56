#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_MESSAGES_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_MESSAGES_H_

#include <stdint.h>

#include "tools/firmware/decoder.h"

// Every message of the native protocol (core/wire/README.md) as a line of JSON, with the keys and
// the order of the vectors' .json; floats are strings of their 32 bits in hexadecimal. What a
// receiver of servo pulses reads is read by its own functions.

typedef enum {
  kRead,       // written
  kUnknown,    // a type that is not known
  kMalformed,  // breaks a rule of its message
  kUnread,     // its payload was not kept whole, or has more servos than FW_SERVOS; written as its
               // sequence, type and bytes
} Outcome;

Outcome WriteMessage(const FwFrame* frame);
void WriteText(const char* text);
void WriteNumber(uint32_t number);

// Where the characters go; the program's.
void WriteCharacter(char character);

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_AVR_MESSAGES_H_
