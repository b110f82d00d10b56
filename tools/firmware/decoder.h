#ifndef FACEWIRE_TOOLS_FIRMWARE_DECODER_H_
#define FACEWIRE_TOOLS_FIRMWARE_DECODER_H_

#include <stdbool.h>
#include <stdint.h>

#include "tools/firmware/message.h"

// Finds the frames in a stream of bytes, as core/wire/README.md says: COBS and CRC as the bytes
// come, so that a frame of any type may be longer than the memory here. Of each payload only the
// front is kept, which is all of every message that this program reads.

typedef struct {
  uint32_t sound;        // frames of this version, of any type
  uint32_t versions;     // sound frames of another version
  uint32_t crc_errors;   // damaged on the way
  uint32_t cobs_errors;  // bytes missing
  uint32_t truncated;    // too short for header and CRC
  uint32_t overflows;    // longer than any frame
  uint32_t lost;         // from the gaps in the numbers
  uint32_t restarts;     // of the sender, from the numbers
  uint32_t resyncs;      // times that a sound frame followed damage
} FwLinkStats;

typedef struct {
  uint8_t type;
  uint16_t sequence;
  uint16_t size;           // of the payload, in bytes
  const uint8_t* payload;  // its first bytes: the smaller of `size` and FW_MAX_PAYLOAD_BYTES
} FwFrame;

#define FW_HEADER_BYTES 4
#define FW_FRAME_GAP_TICKS 5  // 100 ms: a USB adapter holds bytes back for 16

typedef struct {
  uint8_t buffer[FW_HEADER_BYTES + FW_MAX_PAYLOAD_BYTES];
  uint16_t size;  // without COBS, also of what was not kept
  uint32_t crc;
  uint8_t left_in_block;
  bool zero_pending;  // the COBS block stands for a zero if another block follows
  bool started;       // bytes came since the last delimiter
  bool joined;        // a delimiter was seen: what follows is a frame from its beginning
  bool damaged;       // since the last sound frame
  bool numbered;      // `last_sequence` is one
  uint8_t quiet;      // ticks since the last byte, within a frame
  uint16_t last_sequence;
  FwLinkStats stats;
} FwDecoder;

void FwDecoderInit(FwDecoder* decoder);

// Takes the next byte of the stream. True when it ended a sound frame: `frame` is that frame, and
// its payload stays until the next call.
bool FwDecoderTake(FwDecoder* decoder, uint8_t byte, FwFrame* frame);

// Once a tick. A frame whose bytes stop coming for FW_FRAME_GAP_TICKS is given up: its end would
// come with whatever the device says next, and seconds later nobody means it any more.
void FwDecoderTick(FwDecoder* decoder);

uint32_t FwDamaged(const FwLinkStats* stats);

#endif  // FACEWIRE_TOOLS_FIRMWARE_DECODER_H_
