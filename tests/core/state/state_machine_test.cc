#include "core/state/state_machine.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace facewire::state {
namespace {

using std::chrono::milliseconds;

// A machine with round times, ticking every 10 ms.
class Context {
 public:
  static StateConfig Config() {
    StateConfig config;
    config.start_ramp = milliseconds(200);
    config.acquire = milliseconds(100);
    config.hold = milliseconds(300);
    config.ease = milliseconds(400);
    config.rest_after = milliseconds(2000);
    config.camera_timeout = milliseconds(1000);
    config.neutral_frames = 5;
    return config;
  }
  Context() { EXPECT_TRUE(machine.Configure(Config())); }

  Outputs Call(Inputs in) {
    in.now = now;
    now += milliseconds(10);
    return last = machine.Update(in);
  }
  // Ticks with the same inputs for `time`; the last answer.
  Outputs For(milliseconds time, Inputs in) {
    for (const Time end = now + time; now < end;) Call(in);
    return last;
  }
  // Brings a fresh machine into the state.
  void Bring(ServiceState state) {
    if (state == ServiceState::kStarting) return void(Call(kNoFace));
    if (state == ServiceState::kStopped) return void(Call(kStop));
    For(milliseconds(300), kNoFace);
    if (state == ServiceState::kSearching) return;
    if (state == ServiceState::kResting) return void(For(milliseconds(2500), kNoFace));
    if (state == ServiceState::kFault) return void(For(milliseconds(1500), kSilence));
    For(milliseconds(200), kFace);
    if (state == ServiceState::kHolding) Call(kNoFace);
    if (state == ServiceState::kEasing) For(milliseconds(400), kNoFace);
  }

  static constexpr Inputs kFace{.sight = Sight::kFace};
  static constexpr Inputs kNoFace{.sight = Sight::kNoFace};
  static constexpr Inputs kRejected{.sight = Sight::kRejected};
  static constexpr Inputs kSilence{.sight = Sight::kSilent};
  static constexpr Inputs kStop{.sight = Sight::kFace, .stop = true};
  static constexpr Inputs kRelease{.sight = Sight::kFace, .release = true};
  static constexpr Inputs kRest{.sight = Sight::kFace, .rest = true};
  static constexpr Inputs kQuit{.sight = Sight::kFace, .quit = true};
  static constexpr Inputs kLineGone{.sight = Sight::kFace, .line_gone = true};

  StateMachine machine;
  Time now{milliseconds(5000)};
  Outputs last;
};

using S = ServiceState;
constexpr S kAll[] = {S::kStarting, S::kSearching, S::kTracking, S::kHolding,
                      S::kEasing,   S::kResting,   S::kStopped,  S::kFault};

TEST(StateMachine, BringsEveryStateAboutAsTheTestsAssume) {
  for (const S state : kAll) {
    Context c;
    c.Bring(state);
    EXPECT_EQ(c.machine.state(), state) << Name(state);
  }
}

struct Row {
  S from;
  Inputs in;
  milliseconds time;
  S to;
  const char* reason;
};

TEST(StateMachine, FollowsTheTransitionTable) {
  using C = Context;
  constexpr milliseconds kTick{10};
  const std::vector<Row> table = {
      {S::kStarting, C::kFace, kTick, S::kStarting, "a face must not cut the start short"},
      {S::kStarting, C::kFace, milliseconds(30), S::kStarting, "neutral frames come first"},
      {S::kFault, C::kFace, milliseconds(150), S::kStarting, "the ramp takes 200 ms"},
      {S::kStarting, C::kNoFace, milliseconds(400), S::kSearching, "they were sent"},
      {S::kStarting, C::kSilence, milliseconds(400), S::kSearching, "that needs no camera"},
      {S::kStarting, C::kLineGone, kTick, S::kFault, "nobody receives them"},
      {S::kSearching, C::kFace, kTick, S::kTracking, "found"},
      {S::kSearching, C::kRejected, kTick, S::kSearching, "a wrong face is no face"},
      {S::kSearching, C::kNoFace, milliseconds(2100), S::kResting, "neutral for rest_after"},
      {S::kSearching, C::kSilence, milliseconds(900), S::kSearching, "not silent for long enough"},
      {S::kSearching, C::kSilence, milliseconds(1100), S::kFault, "the camera is silent"},
      {S::kSearching, C::kLineGone, kTick, S::kFault, "the line is gone"},
      {S::kTracking, C::kFace, milliseconds(5000), S::kTracking, "as long as there is a face"},
      {S::kTracking, C::kNoFace, kTick, S::kHolding, "lost"},
      {S::kTracking, C::kRejected, kTick, S::kHolding, "a wrong face is no face"},
      {S::kTracking, C::kSilence, milliseconds(150), S::kTracking, "a late picture is no loss"},
      {S::kTracking, C::kSilence, milliseconds(250), S::kHolding, "too late: no picture"},
      {S::kTracking, C::kSilence, milliseconds(600), S::kEasing, "silence is a loss as any other"},
      {S::kTracking, C::kSilence, milliseconds(3000), S::kFault, "silence for good"},
      {S::kTracking, C::kLineGone, kTick, S::kFault, "the line is gone"},
      {S::kHolding, C::kFace, kTick, S::kTracking, "found again"},
      {S::kHolding, C::kNoFace, milliseconds(250), S::kHolding, "hold has not passed"},
      {S::kHolding, C::kNoFace, milliseconds(350), S::kEasing, "hold has passed"},
      {S::kHolding, C::kLineGone, kTick, S::kFault, "the line is gone"},
      {S::kEasing, C::kFace, kTick, S::kTracking, "found on the way to neutral"},
      {S::kEasing, C::kNoFace, milliseconds(200), S::kEasing, "the way takes 400 ms"},
      {S::kEasing, C::kNoFace, milliseconds(450), S::kSearching, "neutral is reached"},
      {S::kEasing, C::kSilence, milliseconds(250), S::kEasing, "ease first, then complain"},
      {S::kEasing, C::kLineGone, kTick, S::kFault, "the line is gone"},
      {S::kResting, C::kFace, kTick, S::kTracking, "wakes up"},
      {S::kResting, C::kNoFace, milliseconds(9000), S::kResting, "nobody there"},
      {S::kResting, C::kSilence, milliseconds(1100), S::kFault, "the camera is silent"},
      {S::kFault, C::kSilence, milliseconds(9000), S::kFault, "still silent"},
      {S::kFault, C::kFace, kTick, S::kStarting, "pictures are back: from neutral, with a ramp"},
      {S::kFault, C::kNoFace, milliseconds(400), S::kSearching, "and on"},
      {S::kFault, C::kLineGone, milliseconds(9000), S::kFault, "the camera alone does not help"},
      {S::kStopped, C::kFace, milliseconds(9000), S::kStopped, "latched"},
      {S::kStopped, C::kNoFace, milliseconds(9000), S::kStopped, "latched"},
      {S::kStopped, C::kSilence, milliseconds(9000), S::kStopped, "latched"},
      {S::kStopped, C::kLineGone, milliseconds(9000), S::kStopped, "latched"},
      {S::kStopped, C::kRelease, kTick, S::kStarting, "released: from here, with a ramp"},
      {S::kStopped, {.stop = true, .release = true}, kTick, S::kStopped, "still asserted"},
      {S::kStopped,
       {.release = true, .quit = true},
       kTick,
       S::kStopped,
       "no motion on the way out"},
      {S::kTracking, {.release = true}, kTick, S::kHolding, "a release without a stop is nothing"},
      {S::kTracking, C::kRest, kTick, S::kEasing, "asked to rest: at once, without holding"},
      {S::kHolding, C::kRest, kTick, S::kEasing, "asked to rest"},
      {S::kSearching, C::kRest, kTick, S::kSearching, "neutral already; the face does not count"},
      {S::kSearching, C::kRest, milliseconds(2100), S::kResting, "and at last the torque goes"},
      {S::kResting, C::kRest, milliseconds(9000), S::kResting, "as long as it is asked for"},
      {S::kTracking, C::kQuit, kTick, S::kEasing, "leaves at neutral"},
      {S::kHolding, C::kQuit, kTick, S::kEasing, "leaves at neutral"},
      {S::kResting, C::kQuit, kTick, S::kResting, "limp servos stay limp"},
      {S::kFault, C::kQuit, kTick, S::kEasing, "leaves at neutral"},
      {S::kTracking, {.sight = static_cast<Sight>(77)}, kTick, S::kHolding, "unknown is no face"},
  };
  for (const Row& row : table) {
    Context c;
    c.Bring(row.from);
    c.For(row.time, row.in);
    EXPECT_STREQ(Name(c.machine.state()), Name(row.to))
        << Name(row.from) << " after " << row.time.count() << " ms: " << row.reason;
  }
}

TEST(StateMachine, StopsFromEveryStateAtOnceWithTorqueOffAndFrozen) {
  for (const S state : kAll) {
    Context c;
    c.Bring(state);
    const Outputs out = c.Call(Context::kStop);
    EXPECT_EQ(out.state, S::kStopped) << Name(state);
    EXPECT_EQ(out.target, Target::kHeld) << Name(state);
    EXPECT_FALSE(out.torque) << Name(state);
  }
}

TEST(StateMachine, KeepsAStopThroughARestart) {
  Context c;
  c.Bring(S::kStopped);
  c.machine.Restart(c.now);
  EXPECT_EQ(c.Call(Context::kFace).state, S::kStopped);
}

TEST(StateMachine, SendsNeutralFramesAtTheStartEvenWithoutARamp) {
  Context c;
  StateConfig config = Context::Config();
  config.start_ramp = {};
  ASSERT_TRUE(c.machine.Configure(config));
  for (int i = 0; i < 5; ++i) {
    const Outputs out = c.Call(Context::kFace);
    EXPECT_EQ(out.state, S::kStarting) << i;
    EXPECT_EQ(out.target, Target::kNeutral) << i;
    EXPECT_FLOAT_EQ(out.blend, 1) << i;
  }
  EXPECT_EQ(c.Call(Context::kFace).state, S::kSearching);
  EXPECT_EQ(c.Call(Context::kFace).state, S::kTracking);
}

TEST(StateMachine, FinishesOnlyAfterNeutralFrames) {
  for (const S state : {S::kStarting, S::kSearching, S::kTracking, S::kHolding, S::kEasing,
                        S::kFault, S::kResting}) {
    Context c;
    c.Bring(state);
    int neutral_frames = 0;
    int ticks = 0;
    for (Outputs out; !out.finished; ++ticks) {
      ASSERT_LT(ticks, 100) << Name(state);
      out = c.Call(ticks == 0 ? Context::kQuit : Context::kFace);  // quitting is latched
      neutral_frames = out.target == Target::kNeutral && out.blend >= 1 ? neutral_frames + 1 : 0;
    }
    EXPECT_GE(neutral_frames, 5) << Name(state);
  }
}

TEST(StateMachine, FinishesWithoutMotionWhenStopped) {
  Context c;
  c.Bring(S::kStopped);
  const Outputs out = c.Call(Context::kQuit);
  EXPECT_TRUE(out.finished);
  EXPECT_EQ(out.target, Target::kHeld);
}

TEST(StateMachine, BlendsSmoothlyFromZeroToOneWhenAFaceIsFound) {
  Context c;
  c.Bring(S::kSearching);
  Outputs out = c.Call(Context::kFace);
  EXPECT_TRUE(out.blend_begins);
  EXPECT_FLOAT_EQ(out.blend, 0);
  float last = 0;
  for (int i = 0; i < 10; ++i) {
    out = c.Call(Context::kFace);
    EXPECT_FALSE(out.blend_begins);
    EXPECT_GT(out.blend, last);
    EXPECT_LT(out.blend - last, 0.2F) << "no jump";
    last = out.blend;
  }
  EXPECT_FLOAT_EQ(last, 1);
}

TEST(StateMachine, HealsAShortLossWithAShortFade) {
  Context c;
  c.Bring(S::kTracking);
  c.Call(Context::kNoFace);
  c.Call(Context::kFace);  // 20 ms after the last face
  c.Call(Context::kFace);
  EXPECT_FLOAT_EQ(c.last.blend, 0.5F);
  EXPECT_FLOAT_EQ(c.Call(Context::kFace).blend, 1);
}

TEST(StateMachine, DoesNotRestartTheBlendBetweenNeutralStates) {
  Context c;
  c.Bring(S::kEasing);
  for (int i = 0; i < 400; ++i) EXPECT_FALSE(c.Call(Context::kNoFace).blend_begins) << i;
  EXPECT_EQ(c.machine.state(), S::kResting);
}

TEST(StateMachine, CutsTheTorqueWhileRestingAndInALongFault) {
  for (const S state : kAll) {
    Context c;
    c.Bring(state);
    EXPECT_EQ(c.last.torque, state != S::kResting && state != S::kStopped) << Name(state);
  }
  Context c;
  c.Bring(S::kFault);
  EXPECT_FALSE(c.For(milliseconds(2000), Context::kSilence).torque);
  EXPECT_TRUE(c.Call(Context::kFace).torque);
}

TEST(StateMachine, SurvivesTimeThatStepsBackwards) {
  Context c;
  c.Bring(S::kTracking);
  c.now -= milliseconds(3000);
  const Outputs out = c.Call(Context::kFace);
  EXPECT_EQ(out.state, S::kTracking);
  EXPECT_FLOAT_EQ(out.blend, 1);
  EXPECT_EQ(c.For(milliseconds(500), Context::kNoFace).state, S::kHolding) << "time stands still";
  EXPECT_EQ(c.For(milliseconds(3200), Context::kNoFace).state, S::kSearching) << "and goes on";
}

TEST(StateMachine, FindsAFaceAnewAfterALongGapBetweenTicks) {
  Context c;
  c.Bring(S::kTracking);
  c.now += milliseconds(10'000);
  const Outputs out = c.Call(Context::kFace);
  EXPECT_EQ(out.state, S::kTracking);
  EXPECT_TRUE(out.blend_begins);
  EXPECT_FLOAT_EQ(out.blend, 0);
}

TEST(StateMachine, FollowsAFaceOnAComputerThatTakesASecondForAPicture) {
  Context c;
  c.Bring(S::kTracking);
  Outputs out;
  for (int i = 0; i < 10; ++i) {
    c.now += milliseconds(1000);
    out = c.Call(Context::kFace);
    EXPECT_EQ(out.state, S::kTracking) << i;
    EXPECT_EQ(out.blend_begins, i == 0) << i;
  }
  EXPECT_FLOAT_EQ(out.blend, 1);
}

TEST(StateMachine, IgnoresJitterOfTicks) {
  Context c;
  c.Bring(S::kTracking);
  for (int i = 0; i < 100; ++i) {
    c.now += milliseconds((i * 37) % 90);
    const Outputs out = c.Call(i % 3 == 0 ? Context::kSilence : Context::kFace);
    EXPECT_EQ(out.state, S::kTracking) << i;
    EXPECT_FALSE(out.blend_begins) << i;
  }
}

TEST(StateMachine, StartsOverWhenTheLineComesBack) {
  Context c;
  c.Bring(S::kTracking);
  c.For(milliseconds(100), Context::kLineGone);
  const Outputs out = c.Call(Context::kFace);
  EXPECT_EQ(out.state, S::kStarting);
  EXPECT_EQ(out.target, Target::kNeutral);
}

TEST(StateMachine, RefusesANegativeTime) {
  StateMachine machine;
  StateConfig config;
  config.hold = milliseconds(-1);
  const Result<> result = machine.Configure(config);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error(), Errc::kOutOfRange);
}

TEST(ServiceStateName, NamesEveryState) {
  EXPECT_STREQ(Name(S::kTracking), "tracking");
  for (const S state : kAll) EXPECT_NE(std::string_view(Name(state)), "unknown");
  EXPECT_STREQ(Name(static_cast<S>(99)), "unknown");
}

}  // namespace
}  // namespace facewire::state
