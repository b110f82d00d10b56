#ifndef FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_H_
#define FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_H_

// The firmware's headers are C, and know of no other language.
extern "C" {
#include "tools/firmware/decoder.h"
#include "tools/firmware/edges.h"
#include "tools/firmware/message.h"
#include "tools/firmware/motion.h"
#include "tools/firmware/receiver.h"
#include "tools/firmware/retained.h"
}

#endif  // FACEWIRE_TESTS_TOOLS_FIRMWARE_FIRMWARE_H_
