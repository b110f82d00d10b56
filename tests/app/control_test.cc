// The control socket with real clients on real sockets; the service runs on fakes.

#include "app/control.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/wire/decoder.h"
#include "core/wire/encoder.h"
#include "hal/local/local_port.h"
#include "tests/app/performer.h"
#include "tests/app/scratch.h"
#include "tests/app/service_context.h"

namespace facewire::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using wire::CommandCode;
using wire::CommandResult;

// One program that commands the service.
class Client {
 public:
  explicit Client(const std::string& path) : port_(path) { EXPECT_TRUE(port_.Open()); }

  void Send(CommandCode code, std::uint16_t id, float value = 0) {
    std::array<std::byte, wire::kCommandFrameBytes> buffer;
    const auto frame =
        encoder_.Encode(wire::Command{.id = id, .code = code, .value = value}, buffer);
    ASSERT_TRUE(frame);
    SendRaw(*frame);
  }
  void SendRaw(std::span<const std::byte> bytes) { (void)port_.Write(bytes, milliseconds(0)); }
  // What has arrived by now.
  const std::vector<wire::Acknowledgement>& Answers() {
    std::array<std::byte, 4096> buffer;
    while (const auto read = port_.Read(buffer, milliseconds(0))) {
      std::span<const std::byte> rest = std::span(buffer).first(*read);
      while (!rest.empty()) {
        const auto received = decoder_.Next(rest);
        const auto* answer =
            received ? std::get_if<wire::Acknowledgement>(&received->message) : nullptr;
        if (answer != nullptr) answers_.push_back(*answer);
      }
    }
    return answers_;
  }
  // The service has sent it away.
  bool SentAway() {
    std::byte byte{};
    Result<std::size_t> read = port_.Read({&byte, 1}, milliseconds(0));
    while (read) read = port_.Read({&byte, 1}, milliseconds(0));
    return read.error() == Errc::kDisconnected;
  }

 private:
  hal::local::LocalPort port_;
  wire::Encoder encoder_;
  wire::Decoder decoder_;
  std::vector<wire::Acknowledgement> answers_;
};

class ControlContext : public ServiceContext {
 public:
  ControlContext() {
    EXPECT_TRUE(control.Open(path()));
    follower.face = StillPerformer();
  }
  std::string path() const { return scratch / "control"; }
  std::unique_ptr<Client> Connect() {
    auto client = std::make_unique<Client>(path());
    Tick();
    return client;
  }
  Scratch scratch;
};

TEST(Control, AnswersACommandWithinATick) {
  ControlContext c;
  const auto client = c.Connect();
  client->Send(CommandCode::kPing, 9);
  c.Tick();
  ASSERT_EQ(client->Answers().size(), 1U);
  EXPECT_EQ(client->Answers()[0].id, 9);
  EXPECT_EQ(client->Answers()[0].result, CommandResult::kOk);
  EXPECT_TRUE(c.answers.empty()) << "the host did not ask";
}

TEST(Control, RefusesLandmarksWhichAreForTheLine) {
  ControlContext c;
  c.BringToTracking();
  const auto client = c.Connect();
  client->Send(CommandCode::kLandmarks, 1, 30);
  c.For(seconds(1));
  ASSERT_EQ(client->Answers().size(), 1U);
  EXPECT_EQ(client->Answers()[0].result, CommandResult::kRefused);
  EXPECT_TRUE(c.parts.empty());
}

TEST(Control, CommandsWhatAHostCommands) {
  ControlContext c;
  c.GivePersonalProfile();
  c.BringToTracking();
  const auto client = c.Connect();
  client->Send(CommandCode::kStop, 1);
  c.Tick();
  EXPECT_EQ(c.last_pose.state, ServiceState::kStopped);
  client->Send(CommandCode::kRelease, 2);
  client->Send(CommandCode::kBlendProfile, 3, 0.5F);
  client->Send(static_cast<CommandCode>(99), 4);
  c.For(seconds(1));
  EXPECT_EQ(c.last_pose.state, ServiceState::kTracking);
  EXPECT_EQ(c.character.retargeter.blend(), 0.5F);
  ASSERT_EQ(client->Answers().size(), 4U);
  EXPECT_EQ(client->Answers()[3].result, CommandResult::kUnknown);
}

TEST(Control, CalibratesAPerformerWhoHoldsStill) {
  ControlContext c;
  c.BringToTracking();
  const auto client = c.Connect();
  client->Send(CommandCode::kCalibrateNeutral, 1);
  c.For(milliseconds(1200));
  ASSERT_EQ(client->Answers().size(), 1U);
  EXPECT_EQ(client->Answers()[0].result, CommandResult::kOk);
  EXPECT_EQ(c.kept, 1);
}

TEST(Control, RefusesAPerformerWhoMovesOrBlinksAndSaysSo) {
  const std::pair<void (*)(FacePose&), CommandResult> table[] = {
      {ShakeHead, CommandResult::kHeadTurned}, {BlinkTwiceASecond, CommandResult::kEyesClosed}};
  for (const auto& [act, result] : table) {
    ControlContext c;
    c.follower.act = act;
    c.BringToTracking();
    const auto client = c.Connect();
    client->Send(CommandCode::kCalibrateNeutral, 1);
    c.For(seconds(9));
    EXPECT_TRUE(client->Answers().empty()) << "it keeps trying";
    c.For(seconds(2));
    ASSERT_EQ(client->Answers().size(), 1U);
    EXPECT_EQ(client->Answers()[0].result, result);
    EXPECT_GT(client->Answers()[0].measure, 0);
    EXPECT_EQ(c.kept, 0);
  }
}

TEST(Control, AnswersEachOfTwoClientsAndNotTheOther) {
  ControlContext c;
  c.BringToTracking();
  const auto first = c.Connect();
  const auto second = c.Connect();
  first->Send(CommandCode::kCalibrateNeutral, 1);
  c.Tick();
  second->Send(CommandCode::kCalibrateNeutral, 1);
  c.Tick();
  ASSERT_EQ(second->Answers().size(), 1U);
  EXPECT_EQ(second->Answers()[0].result, CommandResult::kRefused) << "one at a time";
  EXPECT_TRUE(first->Answers().empty());
  c.For(milliseconds(1200));
  ASSERT_EQ(first->Answers().size(), 1U);
  EXPECT_EQ(first->Answers()[0].result, CommandResult::kOk);
  EXPECT_EQ(second->Answers().size(), 1U);
}

TEST(Control, AnswersNobodyInPlaceOfAClientThatLeft) {
  ControlContext c;
  c.BringToTracking();
  auto gone = c.Connect();
  gone->Send(CommandCode::kCalibrateNeutral, 1);
  c.Tick();
  gone.reset();
  c.Tick();
  const auto next = c.Connect();  // takes its place
  c.For(milliseconds(1200));
  EXPECT_EQ(c.kept, 1) << "what was asked for is done";
  EXPECT_TRUE(next->Answers().empty());
}

TEST(Control, GarbageCostsNothingButItself) {
  ControlContext c;
  const auto client = c.Connect();
  for (int round = 0; round < 256; ++round) {
    std::vector<std::byte> garbage;
    for (int i = 0; i < 200; ++i) garbage.push_back(static_cast<std::byte>(i * i + 7 * round));
    client->SendRaw(garbage);
    c.Tick();
  }
  EXPECT_FALSE(client->SentAway());
  client->Send(CommandCode::kPing, 5);
  c.Tick();
  ASSERT_FALSE(client->Answers().empty());
  EXPECT_EQ(client->Answers().back().id, 5);
}

TEST(Control, SendsAwayAClientThatFloodsAndServesTheOthers) {
  ControlContext c;
  const auto client = c.Connect();
  const auto flood = c.Connect();
  flood->SendRaw(std::vector<std::byte>(Control::kMaxBytesPerTick + 1, std::byte{1}));
  client->Send(CommandCode::kPing, 5);
  c.Tick();
  EXPECT_TRUE(flood->SentAway());
  EXPECT_EQ(client->Answers().size(), 1U);
  EXPECT_EQ(c.control.counters().dropped, 1U);
}

TEST(Control, SendsAwayAClientThatNeverReads) {
  ControlContext c;
  const auto client = c.Connect();
  const auto stuck = c.Connect();
  for (int i = 0; i < 100'000 && c.control.counters().dropped == 0; ++i) {
    stuck->Send(CommandCode::kPing, 1);
    c.control.Poll();
    while (const auto request = c.control.Next()) {
      c.control.Answer(request->asker, {.id = request->command.id});
    }
  }
  EXPECT_EQ(c.control.counters().dropped, 1U);
  EXPECT_TRUE(stuck->SentAway());
  client->Send(CommandCode::kPing, 5);
  c.Tick();
  EXPECT_EQ(client->Answers().size(), 1U);
}

TEST(Control, LetsANewcomerInForTheClientThatWasSilentForLongest) {
  ControlContext c;
  std::vector<std::unique_ptr<Client>> clients;
  for (std::size_t i = 0; i < Control::kMaxClients; ++i) clients.push_back(c.Connect());
  clients[0]->Send(CommandCode::kPing, 1);
  c.Tick();
  const auto newcomer = c.Connect();
  newcomer->Send(CommandCode::kStop, 2);
  c.Tick();
  EXPECT_EQ(newcomer->Answers().size(), 1U) << "whoever wants to stop it gets in";
  EXPECT_FALSE(clients[0]->SentAway());
  EXPECT_TRUE(clients[1]->SentAway());
  for (std::size_t i = 2; i < clients.size(); ++i) EXPECT_FALSE(clients[i]->SentAway()) << i;
}

TEST(Control, KeepsThePaceOfTheServiceWhateverItsClientsDo) {
  ControlContext c;
  c.BringToTracking();
  const std::uint64_t frames = c.service->stats().frames;
  const Time before = c.clock.Now();
  for (int i = 0; i < 300; ++i) {
    const auto passing = std::make_unique<Client>(c.path());
    passing->SendRaw(std::vector<std::byte>(1000, std::byte{0x55}));
    c.Tick();
  }
  EXPECT_EQ(c.service->stats().frames - frames, 300U);
  EXPECT_NEAR(static_cast<double>((c.clock.Now() - before).count()), 10e6, 0.1e6);
}

}  // namespace
}  // namespace facewire::app
