#include "tools/firmware/decoder.h"

#include <string.h>

#include "tools/firmware/bytes.h"
#include "tools/firmware/crc32.h"

#define VERSION 1
#define CRC_BYTES 4
#define MAX_INSIDE 1024

static void Restart(FwDecoder* d) {
  d->size = 0;
  d->crc = FW_CRC_START;
  d->left_in_block = 0;
  d->zero_pending = false;
  d->started = false;
}

void FwDecoderInit(FwDecoder* decoder) {
  memset(decoder, 0, sizeof *decoder);
  Restart(decoder);
}

static void Append(FwDecoder* d, uint8_t byte) {
  if (d->size > MAX_INSIDE) return;  // one more than may be is enough to know
  if (d->size < sizeof d->buffer) d->buffer[d->size] = byte;
  ++d->size;
  d->crc = FwCrcAdd(d->crc, byte);
}

// Undoes COBS: a code says how many plain bytes follow, and stands for a zero after them unless it
// is 0xFF or nothing follows.
static void Unstuff(FwDecoder* d, uint8_t byte) {
  d->started = true;
  if (d->left_in_block > 0) {
    --d->left_in_block;
    Append(d, byte);
    return;
  }
  if (d->zero_pending) Append(d, 0);
  d->left_in_block = (uint8_t)(byte - 1U);
  d->zero_pending = byte != 0xFF;
}

static void CountSequence(FwDecoder* d, uint16_t sequence) {
  if (d->numbered) {
    const uint16_t expected = d->last_sequence == 0xFFFF ? 1 : (uint16_t)(d->last_sequence + 1U);
    // (sequence - expected) mod 65535: a borrow takes one number more than the numbers have.
    uint16_t gap = (uint16_t)(sequence - expected);
    if (sequence < expected) --gap;
    if (sequence == 0 || gap > 0x7FFF) {
      ++d->stats.restarts;
    } else {
      d->stats.lost += gap;
    }
  }
  d->numbered = true;
  d->last_sequence = sequence;
}

// The counter of what is wrong with the piece that just ended; null when nothing is.
static uint32_t* Damage(FwDecoder* d) {
  if (d->size > MAX_INSIDE) return &d->stats.overflows;
  if (d->left_in_block > 0) return &d->stats.cobs_errors;
  if (d->size < FW_HEADER_BYTES + CRC_BYTES) return &d->stats.truncated;
  if (d->crc != FW_CRC_SOUND) return &d->stats.crc_errors;
  return NULL;
}

static bool Finish(FwDecoder* d, bool tail, FwFrame* frame) {
  uint32_t* const damage = Damage(d);
  if (damage != NULL) {
    if (!tail) {
      ++*damage;
      d->damaged = true;
    }
    return false;
  }
  if (d->damaged) ++d->stats.resyncs;
  d->damaged = false;
  if (d->buffer[0] != VERSION) {
    ++d->stats.versions;
    return false;
  }
  frame->type = d->buffer[1];
  frame->sequence = FwGet16(d->buffer + 2);
  frame->size = (uint16_t)(d->size - FW_HEADER_BYTES - CRC_BYTES);
  frame->payload = d->buffer + FW_HEADER_BYTES;
  CountSequence(d, frame->sequence);
  ++d->stats.sound;
  return true;
}

bool FwDecoderTake(FwDecoder* decoder, uint8_t byte, FwFrame* frame) {
  decoder->quiet = 0;
  if (byte != 0) {
    Unstuff(decoder, byte);
    return false;
  }
  const bool tail = !decoder->joined;  // perhaps of a frame whose beginning nobody saw
  decoder->joined = true;
  if (!decoder->started) return false;
  const bool sound = Finish(decoder, tail, frame);
  Restart(decoder);
  return sound;
}

void FwDecoderTick(FwDecoder* decoder) {
  if (!decoder->started || ++decoder->quiet < FW_FRAME_GAP_TICKS) return;
  if (decoder->joined) {
    ++decoder->stats.truncated;
    decoder->damaged = true;
  }
  Restart(decoder);
  decoder->joined = false;  // what follows may be the rest of it
  decoder->quiet = 0;
}

uint32_t FwDamaged(const FwLinkStats* stats) {
  return stats->crc_errors + stats->cobs_errors + stats->truncated + stats->overflows;
}
