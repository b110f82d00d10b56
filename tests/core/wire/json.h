#ifndef FACEWIRE_TESTS_CORE_WIRE_JSON_H_
#define FACEWIRE_TESTS_CORE_WIRE_JSON_H_

#include <cstddef>
#include <span>
#include <string>

#include "core/wire/decoder.h"

namespace facewire::wire {

// {"sequence": 3, "type": "pose", ...} on one line.
std::string ToJson(const Received& received);
std::string ToJson(const LinkStats& stats);

// What a decoder makes of the whole stream: {"about": ..., "messages": [...], "stats": {...}}.
std::string DecodeToJson(const std::string& about, std::span<const std::byte> stream);

}  // namespace facewire::wire

#endif  // FACEWIRE_TESTS_CORE_WIRE_JSON_H_
