#include "tools/facewire/servo/keys.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string_view>
#include <utility>

#include "app/animatronic/servo_words.h"
#include "tools/facewire/servo/setting_value.h"

namespace facewire::tools {
namespace {

using Kind = Key::Kind;

std::optional<Kind> KindOf(const std::optional<Key>& key) {
  return key ? std::optional(key->kind) : std::nullopt;
}

TEST(Keys, ArrowsAreReadHoweverTheyAreCut) {
  for (const auto& [bytes, kind] :
       {std::pair("\x1b[A", Kind::kUp), std::pair("\x1b[B", Kind::kDown),
        std::pair("\x1b[C", Kind::kRight), std::pair("\x1bOD", Kind::kLeft)}) {
    for (int cut = 1; cut < 3; ++cut) {
      KeyDecoder decoder;
      decoder.Add(std::string(bytes).substr(0, static_cast<std::size_t>(cut)));
      EXPECT_FALSE(decoder.Next(false));
      decoder.Add(std::string(bytes).substr(static_cast<std::size_t>(cut)));
      EXPECT_EQ(KindOf(decoder.Next(false)), kind);
      EXPECT_FALSE(decoder.Next(false));
    }
  }
}

TEST(Keys, ALoneEscapeIsAKeyOnceNothingFollows) {
  KeyDecoder decoder;
  decoder.Add("\x1b");
  EXPECT_FALSE(decoder.Next(false));
  EXPECT_EQ(KindOf(decoder.Next(true)), Kind::kOther);
}

TEST(Keys, LettersEnterAndTheEnd) {
  KeyDecoder decoder;
  decoder.Add("n\rq\x03");
  EXPECT_EQ(decoder.Next(false), (Key{.kind = Kind::kOther, .character = 'n'}));
  EXPECT_EQ(KindOf(decoder.Next(false)), Kind::kEnter);
  EXPECT_EQ(KindOf(decoder.Next(false)), Kind::kQuit);
  EXPECT_EQ(KindOf(decoder.Next(false)), Kind::kQuit);
}

TEST(Keys, WordsOfAScript) {
  EXPECT_EQ(KindOf(KeyOfWord("left")), Kind::kLeft);
  EXPECT_EQ(KindOf(KeyOfWord("q")), Kind::kQuit);
  EXPECT_EQ(KeyOfWord("space"), (Key{.kind = Kind::kOther, .character = ' '}));
  EXPECT_EQ(KeyOfWord("=1500.25"), (Key{.kind = Kind::kPosition, .position = 1500.25F}));
  for (const char* word : {"=", "=x", "=1500us", "lefty", "1500"}) EXPECT_FALSE(KeyOfWord(word));
}

TEST(SettingValues, AreReadAsTheServiceAndTheFindingsWriteThem) {
  using bus::Setting;
  constexpr bus::HardwareFaults kAll = 0x3F;
  for (const auto& [setting, value] :
       std::initializer_list<std::pair<Setting, std::int32_t>>{{Setting::kOperatingMode, 3},
                                                               {Setting::kMinPosition, 0},
                                                               {Setting::kMaxPosition, 4095},
                                                               {Setting::kShutdown, 0},
                                                               {Setting::kShutdown, kAll},
                                                               {Setting::kReturnDelay, 250},
                                                               {Setting::kProfileUnit, 0},
                                                               {Setting::kProfileUnit, 1},
                                                               {Setting::kLock, 0},
                                                               {Setting::kLock, 1}}) {
    const app::Words argument = app::SettingArgument(setting, value);
    EXPECT_EQ(SettingOfWord(app::SettingWord(setting)), setting);
    EXPECT_EQ(SettingValue(setting, argument.data()), value) << argument.data();
    EXPECT_EQ(std::string_view(argument.data()).find(' '), std::string_view::npos);
  }
}

TEST(SettingValues, AreNothingElse) {
  using bus::Setting;
  EXPECT_FALSE(SettingValue(Setting::kShutdown, "heat,hunger"));
  EXPECT_FALSE(SettingValue(Setting::kLock, "1"));
  EXPECT_FALSE(SettingValue(Setting::kReturnDelay, "250us"));
}

}  // namespace
}  // namespace facewire::tools
