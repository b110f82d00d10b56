#include "tests/tools/firmware/avr/messages.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "tools/firmware/bytes.h"

#define MOST_SERVOS 64
#define MOST_CHANNELS 240
#define MOST_NAME 31
#define MOST_TEXT 480
#define MOST_LANDMARKS 478
#define MOST_POINTS 32

// A field is a letter for how it reads, its key, and what it must stay below if that matters:
//   1 2 4 unsigned of so many bytes   t signed, of 8   f float   v three floats
//   n name   x text   k kind of a channel   b bone, 255 as -1   s, r state of a service, a receiver
//   q, p list of steps, of pulses   l list of points, within the two u16 before it   m c i float or
//   byte that only some results and commands have
typedef struct {
  uint8_t type;
  const char* name;
  const char* fields;
} Layout;

static const Layout kLayouts[] = {
    {0x01, "rig_header", "4rig_id 1bones<81 1channels<241 nname"},
    {0x02, "bone", "4rig_id 1index<80 vrest_cm nname"},
    {0x03, "channel", "4rig_id 1index<240 kkind bbone fneutral fmin fmax nname"},
    {0x10, "pose", "4rig_id 4frame_seq tcaptured_us 4age_us sstate qsteps"},
    {0x11, "status",
     "4rig_id sstate tnow_us 4uptime_s 2centi_fps 4frames 4dropped 4losses 4link_errors "
     "4latency_p50_us 4latency_p99_us"},
    {0x12, "acknowledgement", "2id 1code 1result tnow_us mmeasure"},
    {0x13, "text", "2id xtext"},
    {0x16, "landmarks", "4frame_seq tcaptured_us 2width_px 2height_px 2total 2first leighth_px"},
    {0x80, "command", "2id 1code cvalue iitem"},
    {0x81, "receiver_status",
     "4setup_id rstate 1capacity<65 1version_major 1version_minor 1reset_causes 2supply_mv "
     "4uptime_ms 4frames 4damaged 4lost 4refused pquarter_us"},
};
#define LAYOUTS (sizeof kLayouts / sizeof kLayouts[0])

static const char* const kKinds[] = {"parameter", "position_x", "position_y", "position_z",
                                     "pitch",     "yaw",        "roll"};
#define KINDS (sizeof kKinds / sizeof kKinds[0])

void WriteText(const char* text) {
  while (*text != '\0') WriteCharacter(*text++);
}

void WriteNumber(uint32_t number) {
  char digits[11];
  WriteText(ultoa(number, digits, 10));
}

static void WriteSigned(uint64_t bits) {
  char digits[21];
  char* at = digits + sizeof digits - 1;
  *at = '\0';
  const bool negative = (bits >> 63U) != 0;
  uint64_t left = negative ? -bits : bits;
  do {
    *--at = (char)('0' + left % 10);
    left /= 10;
  } while (left != 0);
  if (negative) WriteCharacter('-');
  WriteText(at);
}

static void WriteQuoted(const uint8_t* bytes, uint16_t size) {
  WriteCharacter('"');
  for (uint16_t i = 0; i < size; ++i) {
    if (bytes[i] == '"' || bytes[i] == '\\') WriteCharacter('\\');
    WriteCharacter((char)bytes[i]);
  }
  WriteCharacter('"');
}

static void WriteBits(uint32_t bits) {
  WriteCharacter('"');
  for (uint8_t shift = 32; shift > 0; shift -= 4) {
    WriteCharacter("0123456789abcdef"[(bits >> (shift - 4)) & 0xFU]);
  }
  WriteCharacter('"');
}

// A payload on its way through its fields. Each payload goes twice: first to be checked, then,
// being sound, to be written.
typedef struct {
  const uint8_t* payload;
  uint16_t size;
  uint16_t at;
  bool sound;
  bool writes;
} Walk;

static const uint8_t* Take(Walk* w, uint16_t bytes) {
  static const uint8_t kZeros[8];
  if (w->size - w->at < bytes) {
    w->sound = false;
    return bytes <= sizeof kZeros ? kZeros : w->payload;
  }
  w->at += bytes;
  return w->payload + w->at - bytes;
}

static void Require(Walk* w, bool condition) { w->sound = w->sound && condition; }

static void Number(Walk* w, uint32_t number) {
  if (w->writes) WriteNumber(number);
}

static void Float(Walk* w) {
  const uint32_t bits = FwGet32(Take(w, 4));
  Require(w, (bits & 0x7F800000U) != 0x7F800000U);
  if (w->writes) WriteBits(bits);
}

static void Floats(Walk* w) {
  for (uint8_t i = 0; i < 3; ++i) {
    if (w->writes) WriteCharacter(i == 0 ? '[' : ',');
    Float(w);
  }
  if (w->writes) WriteCharacter(']');
}

static void Name(Walk* w) {
  const uint8_t size = Take(w, 1)[0];
  Require(w, size <= MOST_NAME && size <= w->size - w->at);
  if (!w->sound) return;
  const uint8_t* const name = Take(w, size);
  for (uint8_t i = 0; i < size; ++i) Require(w, name[i] >= '!' && name[i] <= '~');
  if (w->writes) WriteQuoted(name, size);
}

static void TextField(Walk* w) {
  const uint16_t size = FwGet16(Take(w, 2));
  Require(w, size <= MOST_TEXT && size <= w->size - w->at);
  if (!w->sound) return;
  const uint8_t* const text = Take(w, size);
  if (w->writes) WriteQuoted(text, size);
}

static void List(Walk* w, uint8_t most, bool pulses) {
  const uint8_t count = Take(w, 1)[0];
  Require(w, count <= most);
  if (w->writes) WriteCharacter('[');
  for (uint8_t i = 0; i < count && w->sound; ++i) {
    const uint16_t value = FwGet16(Take(w, 2));
    Require(w, !pulses || value == 0 || (value >= FW_MIN_PULSE && value <= FW_MAX_PULSE));
    if (w->writes && i > 0) WriteCharacter(',');
    Number(w, value);
  }
  if (w->writes) WriteCharacter(']');
}

static void Points(Walk* w) {
  const uint8_t* const range = w->payload + w->at - 4;
  const uint16_t total = FwGet16(range);
  const uint32_t first = FwGet16(range + 2);
  const uint8_t count = Take(w, 1)[0];
  Require(w, count <= MOST_POINTS && total <= MOST_LANDMARKS && first + count <= total);
  if (w->writes) WriteCharacter('[');
  for (uint8_t i = 0; i < 2 * count && w->sound; ++i) {
    const int16_t value = (int16_t)FwGet16(Take(w, 2));
    if (!w->writes) continue;
    if (i > 0) WriteCharacter(',');
    WriteSigned((uint64_t)(int64_t)value);
  }
  if (w->writes) WriteCharacter(']');
}

static void Kind(Walk* w) {
  const uint8_t kind = Take(w, 1)[0];
  if (!w->writes) return;
  WriteCharacter('"');
  WriteText(kKinds[kind < KINDS ? kind : 0]);
  WriteCharacter('"');
}

static void Bone(Walk* w) {
  const uint8_t bone = Take(w, 1)[0];
  Require(w, bone < 80 || bone == 255);
  if (!w->writes) return;
  if (bone == 255) {
    WriteText("-1");
  } else {
    WriteNumber(bone);
  }
}

static void Time(Walk* w) {
  const uint8_t* const bytes = Take(w, 8);
  const uint64_t bits = FwGet32(bytes) | (uint64_t)FwGet32(bytes + 4) << 32U;
  if (w->writes) WriteSigned(bits);
}

// Whether a field that only some messages have is in this one. What it depends on lies before it.
static bool Has(const Walk* w, char kind) {
  const uint8_t code = w->payload[2];
  const uint8_t result = w->payload[3];
  if (kind == 'm') return result >= 5 && result <= 9;
  if (kind == 'c') return code == 7 || code == 10 || code == 11;
  if (kind == 'i') return code == 10;
  return true;
}

static void Value(Walk* w, char kind, uint8_t below) {
  uint8_t byte;
  switch (kind) {
    case '1':
      byte = Take(w, 1)[0];
      Require(w, below == 0 || byte < below);
      Number(w, byte);
      break;
    case '2':
      Number(w, FwGet16(Take(w, 2)));
      break;
    case '4':
      Number(w, FwGet32(Take(w, 4)));
      break;
    case 's':
      byte = Take(w, 1)[0];
      Number(w, byte > 7 ? 7 : byte);
      break;
    case 'r':
      byte = Take(w, 1)[0];
      Number(w, byte > 7 ? 0 : byte);
      break;
    case 'i':
      Number(w, Take(w, 1)[0]);
      break;
    case 't':
      Time(w);
      break;
    case 'f':
    case 'm':
    case 'c':
      Float(w);
      break;
    case 'v':
      Floats(w);
      break;
    case 'n':
      Name(w);
      break;
    case 'x':
      TextField(w);
      break;
    case 'k':
      Kind(w);
      break;
    case 'b':
      Bone(w);
      break;
    case 'q':
      List(w, MOST_CHANNELS, false);
      break;
    case 'p':
      List(w, MOST_SERVOS, true);
      break;
    case 'l':
      Points(w);
      break;
  }
}

static void Fields(Walk* w, const char* fields) {
  while (*fields != '\0' && w->sound) {
    const char kind = *fields++;
    const uint8_t length = (uint8_t)strcspn(fields, " <");
    const char* const key = fields;
    fields += length;
    uint8_t below = 0;
    if (*fields == '<') below = (uint8_t)strtoul(fields + 1, (char**)&fields, 10);
    if (*fields == ' ') ++fields;
    if (!Has(w, kind)) continue;
    if (w->writes) {
      WriteCharacter(',');
      WriteQuoted((const uint8_t*)key, length);
      WriteCharacter(':');
    }
    Value(w, kind, below);
  }
}

static float FloatAt(const uint8_t* bytes) {
  const uint32_t bits = FwGet32(bytes);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static bool InOrder(const uint8_t* channel) {
  const float neutral = FloatAt(channel + 7);
  return FloatAt(channel + 11) <= neutral && neutral <= FloatAt(channel + 15);
}

static void Open(const FwFrame* frame) {
  WriteText("{\"sequence\":");
  WriteNumber(frame->sequence);
  WriteText(",\"type\":");
}

static Outcome WriteLayout(const FwFrame* frame, const Layout* layout) {
  Walk w = {.payload = frame->payload, .size = frame->size, .sound = true};
  Fields(&w, layout->fields);
  if (w.sound && layout->type == 0x03) Require(&w, InOrder(frame->payload));
  if (!w.sound) return kMalformed;
  w.at = 0;
  w.writes = true;
  Open(frame);
  WriteCharacter('"');
  WriteText(layout->name);
  WriteCharacter('"');
  Fields(&w, layout->fields);
  WriteText("}\n");
  return kRead;
}

static void Entry(const char* key, uint32_t value) {
  WriteText(key);
  WriteNumber(value);
}

static Outcome WriteSetup(const FwFrame* frame) {
  static FwSetup setup;
  const FwReading reading = FwReadSetup(frame->payload, frame->size, &setup);
  if (reading != kFwOk) return reading == kFwTooMany ? kUnread : kMalformed;
  Open(frame);
  Entry("\"servo_setup\",\"setup_id\":", setup.id);
  Entry(",\"hold_ms\":", setup.hold_ms);
  Entry(",\"ease_ms\":", setup.ease_ms);
  Entry(",\"release_ms\":", setup.release_ms);
  WriteText(",\"servos\":[");
  for (uint8_t i = 0; i < setup.count; ++i) {
    const FwServo* const servo = &setup.servos[i];
    Entry(i == 0 ? "{\"min\":" : ",{\"min\":", servo->min);
    Entry(",\"neutral\":", servo->neutral);
    Entry(",\"max\":", servo->max);
    Entry(",\"speed\":", servo->speed);
    Entry(",\"ramp_speed\":", servo->ramp_speed);
    Entry(",\"ramp_acceleration\":", servo->ramp_acceleration);
    WriteCharacter('}');
  }
  WriteText("]}\n");
  return kRead;
}

static Outcome WritePulses(const FwFrame* frame) {
  static FwPulses pulses;
  const FwReading reading = FwReadPulses(frame->payload, frame->size, &pulses);
  if (reading != kFwOk) return reading == kFwTooMany ? kUnread : kMalformed;
  Open(frame);
  Entry("\"servo_pulses\",\"setup_id\":", pulses.setup_id);
  Entry(",\"stop\":", pulses.stop ? 1 : 0);
  WriteText(",\"quarter_us\":[");
  for (uint8_t i = 0; i < pulses.count; ++i) Entry(i == 0 ? "" : ",", pulses.width[i]);
  WriteText("]}\n");
  return kRead;
}

static Outcome WriteUnread(const FwFrame* frame) {
  Open(frame);
  WriteNumber(frame->type);
  Entry(",\"bytes\":", frame->size);
  WriteText("}\n");
  return kUnread;
}

Outcome WriteMessage(const FwFrame* frame) {
  Outcome outcome = kUnknown;
  if (frame->size > FW_MAX_PAYLOAD_BYTES) {
    outcome = kUnread;
  } else if (frame->type == kFwServoSetup) {
    outcome = WriteSetup(frame);
  } else if (frame->type == kFwServoPulses) {
    outcome = WritePulses(frame);
  } else {
    for (uint8_t i = 0; i < LAYOUTS; ++i) {
      if (kLayouts[i].type == frame->type) outcome = WriteLayout(frame, &kLayouts[i]);
    }
  }
  return outcome == kUnread ? WriteUnread(frame) : outcome;
}
