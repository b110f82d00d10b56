#include "tests/sim/dynamixel_table.h"

#include <array>

namespace facewire::sim {
namespace {

constexpr bool kR = false, kRW = true;

// emanual.robotis.com, XL330-M288-T: its two tables, without gains, LED and indirect addresses'
// use. What is read-only has no range.
constexpr auto kXl330Items = std::to_array<DynamixelItem>({
    {0, 2, kR, 1200, 0, 0},
    {2, 4, kR, 0, 0, 0},
    {6, 1, kR, 52, 0, 0},
    {7, 1, kRW, 1, 0, 252},
    {8, 1, kRW, 1, 0, 6},
    {9, 1, kRW, 250, 0, 254},
    {10, 1, kRW, 0, 0, 5},
    {11, 1, kRW, 3, 0, 16},
    {12, 1, kRW, 255, 0, 255},
    {13, 1, kRW, 2, 2, 22},
    {20, 4, kRW, 0, -1044479, 1044479},
    {24, 4, kRW, 10, 0, 1023},
    {31, 1, kRW, 70, 0, 100},
    {32, 2, kRW, 70, 31, 70},
    {34, 2, kRW, 35, 31, 70},
    {36, 2, kRW, 885, 0, 885},
    {38, 2, kRW, 1750, 0, 1750},
    {44, 4, kRW, 445, 0, 2047},
    {48, 4, kRW, 4095, 0, 4095},
    {52, 4, kRW, 0, 0, 4095},
    {60, 1, kRW, 0, 0, 3},
    {62, 1, kRW, 140, 1, 255},
    {63, 1, kRW, 53, 0, 63},
    {64, 1, kRW, 0, 0, 1},
    {65, 1, kRW, 0, 0, 1},
    {68, 1, kRW, 2, 0, 2},
    {69, 1, kR, 0, 0, 0},
    {70, 1, kR, 0, 0, 0},
    {76, 2, kRW, 1600, 0, 16383},
    {78, 2, kRW, 180, 0, 16383},
    {80, 2, kRW, 0, 0, 16383},
    {82, 2, kRW, 0, 0, 16383},
    {84, 2, kRW, 400, 0, 16383},
    {88, 2, kRW, 0, 0, 16383},
    {90, 2, kRW, 0, 0, 16383},
    {98, 1, kRW, 0, 0, 127},
    {100, 2, kRW, 885, -885, 885},
    {102, 2, kRW, 1750, -1750, 1750},
    {104, 4, kRW, 0, -2047, 2047},
    {108, 4, kRW, 0, 0, 32767},
    {112, 4, kRW, 0, 0, 32767},
    {116, 4, kRW, 0, -1048575, 1048575},
    {120, 2, kR, 0, 0, 0},
    {122, 1, kR, 0, 0, 0},
    {123, 1, kR, 0, 0, 0},
    {124, 2, kR, 0, 0, 0},
    {126, 2, kR, 0, 0, 0},
    {128, 4, kR, 0, 0, 0},
    {132, 4, kR, 0, 0, 0},
    {136, 4, kR, 0, 0, 0},
    {140, 4, kR, 0, 0, 0},
    {144, 2, kR, 0, 0, 0},
    {146, 1, kR, 0, 0, 0},
    {147, 1, kR, 0, 0, 0},
});

// The XL430-W250-T's tables as the differences: no current sensor, other limits.
constexpr auto MakeXl430Items() {
  std::array<DynamixelItem, kXl330Items.size() - 3> items{};
  std::size_t count = 0;
  for (DynamixelItem item : kXl330Items) {
    switch (item.address) {
      case 38:
      case 62:
      case 102:
        continue;
      case 0:
        item.initial = 1060;
        break;
      case 8:
        item.high = 7;
        break;
      case 10:
        item.high = 13;
        break;
      case 13:
        item.low = 1;
        item.high = 2;
        break;
      case 31:
        item.initial = 72;
        break;
      case 32:
        item = {32, 2, kRW, 140, 60, 140};
        break;
      case 34:
        item = {34, 2, kRW, 60, 60, 140};
        break;
      case 44:
        item = {44, 4, kRW, 265, 0, 1023};
        break;
      case 63:
        item.initial = 52;
        break;
      case 76:
        item.initial = 1000;
        break;
      case 78:
        item.initial = 100;
        break;
      case 80:
        item.initial = 4000;
        break;
      case 84:
        item.initial = 640;
        break;
      case 104:
        item = {104, 4, kRW, 0, -1023, 1023};
        break;
      default:
        break;
    }
    items[count++] = item;
  }
  return items;
}
constexpr auto kXl430Items = MakeXl430Items();

}  // namespace

const DynamixelModel& Xl330() {
  static const DynamixelModel model{Xl330M288(), 5.0, true, kXl330Items};
  return model;
}

const DynamixelModel& Xl430() {
  static const DynamixelModel model{Xl430W250(), 11.1, false, kXl430Items};
  return model;
}

std::int32_t FromBytes(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::uint32_t{bytes[i]} << (8 * i);
  if (bytes.size() == 2) return static_cast<std::int16_t>(value);
  return static_cast<std::int32_t>(value);  // single bytes are unsigned
}

DynamixelTable::DynamixelTable(const DynamixelModel& model) : model_(&model) {
  for (const DynamixelItem& item : model.items) {
    for (std::size_t i = 0; i < item.size; ++i) item_at_[item.address + i] = &item;
  }
  Reset();
}

void DynamixelTable::Reset() {
  for (const DynamixelItem& item : model_->items) Set(item.address, item.initial);
}

void DynamixelTable::ResetRam() {
  for (const DynamixelItem& item : model_->items) {
    if (item.address >= dynamixel::kFirstOfRam) Set(item.address, item.initial);
  }
}

std::int32_t DynamixelTable::Get(std::uint16_t address) const {
  const DynamixelItem* item = Find(address);
  return item == nullptr ? 0 : FromBytes(std::span(bytes_).subspan(address, item->size));
}

void DynamixelTable::Set(std::uint16_t address, std::int32_t value) {
  const DynamixelItem* item = Find(address);
  if (item == nullptr) return;
  for (std::size_t i = 0; i < item->size; ++i) {
    bytes_[address + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i));
  }
}

dynamixel::Code DynamixelTable::Read(std::uint16_t address, std::span<std::uint8_t> bytes) const {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = address + i;
    if (Find(at) == nullptr) return dynamixel::Code::kAccess;
    bytes[i] = bytes_[at];
  }
  return dynamixel::Code::kNone;
}

}  // namespace facewire::sim
