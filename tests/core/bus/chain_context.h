#ifndef FACEWIRE_TESTS_CORE_BUS_CHAIN_CONTEXT_H_
#define FACEWIRE_TESTS_CORE_BUS_CHAIN_CONTEXT_H_

#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <functional>
#include <set>
#include <vector>

#include "core/bus/dynamixel_bus.h"
#include "core/bus/feetech_bus.h"
#include "tests/core/bus/dynamixel_peer.h"
#include "tests/core/bus/feetech_peer.h"

namespace facewire::bus {

using std::chrono::milliseconds;

struct DynamixelKind {
  using Bus = DynamixelBus;
  using Config = DynamixelConfig;
  using Peer = DynamixelPeer;
  static constexpr int kHeatError = 1 << 2;
  static constexpr int kOverloadError = 1 << 5;
  static constexpr int kVoltageError = 1 << 0;
  // Of 400 counts/s: 0.229 rev/min = 15.633 counts/s.
  static constexpr int kSlow = 26;
  static constexpr int kTop = 51;  // of 800 counts/s
  // Of 2000 counts/s^2: 214.577 rev/min^2 = 244.14 counts/s^2.
  static constexpr int kGentle = 8;
  static constexpr int kFast = 0;
};
struct FeetechKind {
  using Bus = FeetechBus;
  using Config = FeetechConfig;
  using Peer = FeetechPeer;
  static constexpr int kHeatError = 1 << 2;
  static constexpr int kOverloadError = 1 << 5;
  static constexpr int kVoltageError = 1 << 0;
  static constexpr int kSlow = 400;
  static constexpr int kTop = 800;
  static constexpr int kGentle = 20;
  static constexpr int kFast = 4000;
};

// A driver and its chain in virtual time: servos 1 to n, from 1000 to 3000, ticks of 10 ms; what is
// answered comes 2 ms after it was asked for.
template <class Kind>
struct ChainContext {
  typename Kind::Config config;
  typename Kind::Bus bus;
  typename Kind::Peer peer;
  std::vector<ServoCommand> commands;
  Time now = Time(Duration(1'000'000));
  Duration period = milliseconds(10);
  Duration delay = milliseconds(2);
  std::size_t last_bytes = 0;
  // May change the replies on their way.
  std::function<void(Bytes&)> damage;

  explicit ChainContext(int servos = 3) {
    for (int id = 1; id <= servos; ++id) {
      (void)config.bus.servos.try_push(
          {.id = static_cast<std::uint8_t>(id), .min = 1000, .max = 3000});
      peer.servos[id] = {};
      peer.servos[id].position = 2000 + 10 * id;
    }
    commands.resize(static_cast<std::size_t>(servos));
    EXPECT_TRUE(bus.Configure(config));
  }

  PeerServo& servo(int id) { return peer.servos.at(id); }
  const ServoFeedback& feedback(int id) { return bus.feedback()[static_cast<std::size_t>(id - 1)]; }
  ServoState state(int id) { return feedback(id).state; }

  void Command(int id, float position, bool torque = true) {
    commands[static_cast<std::size_t>(id - 1)] = {.position = position, .torque = torque};
  }
  // As a motion does: everybody gets torque where it is.
  void StartAll() {
    for (const auto& [id, s] : peer.servos) {
      Command(id, feedback(id).position.value_or(2000));
    }
  }
  void LimpAll() {
    for (ServoCommand& command : commands) command = {};
  }

  std::span<const std::byte> Tick() {
    Deliver(now);
    const auto bytes = bus.Tick(now, commands);
    last_bytes = bytes.size();
    Reply(peer.Hear(bytes));
    now += period;
    return bytes;
  }
  void Reply(const std::vector<Bytes>& replies) {
    Bytes all;
    for (const Bytes& reply : replies) all.insert(all.end(), reply.begin(), reply.end());
    if (all.empty()) return;
    if (damage) damage(all);
    line.push_back({now + delay, all});
  }
  void Deliver(Time until) {
    while (!line.empty() && line.front().first <= until) {
      bus.Receive(line.front().second, line.front().first);
      line.pop_front();
    }
  }
  void Run(Duration time) {
    for (const Time end = now + time; now < end;) {
      Tick();
      peer.Move(1000);
    }
  }
  // Until everybody has torque.
  void RunUp() {
    Run(milliseconds(500));
    StartAll();
    Run(milliseconds(1500));
    for (const auto& [id, s] : peer.servos) EXPECT_EQ(state(id), ServoState::kOn) << id;
  }

  std::deque<std::pair<Time, Bytes>> line;
};

}  // namespace facewire::bus

#endif  // FACEWIRE_TESTS_CORE_BUS_CHAIN_CONTEXT_H_
