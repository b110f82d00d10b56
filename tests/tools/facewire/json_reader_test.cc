#include "tools/facewire/json_reader.h"

#include <gtest/gtest.h>

#include <string>

namespace facewire::tools::json {
namespace {

TEST(JsonReader, WalksOverAnObject) {
  Reader text(" { \"a\" : -1.5e1 , \"b\":null } ");
  EXPECT_TRUE(text.Take('{'));
  EXPECT_EQ(text.String(), "a");
  EXPECT_TRUE(text.Take(':'));
  EXPECT_EQ(text.Number(), -15);
  EXPECT_TRUE(text.Take(','));
  EXPECT_EQ(text.String(), "b");
  EXPECT_TRUE(text.Take(':'));
  EXPECT_FALSE(text.Number());
  EXPECT_TRUE(text.Null());
  EXPECT_TRUE(text.Take('}'));
  EXPECT_TRUE(text.AtEnd());
}

TEST(JsonReader, SkipsAnyValueWhole) {
  Reader text("{\"a\":[1,{\"b]\":\"}\\\"\"},[],{},true,false,null]},7");
  EXPECT_TRUE(text.Skip());
  EXPECT_TRUE(text.Take(','));
  EXPECT_EQ(text.Number(), 7);
}

TEST(JsonReader, StaysWhereItIsWhenItDoesNotFindWhatItLooksFor) {
  for (const char* broken :
       {"[1,2", "{\"a\" 1}", "{1:2}", "\"open", "nul", "", "nan", "inf", "-", "[1,]"}) {
    Reader text(broken);
    EXPECT_FALSE(text.Skip()) << broken;
    EXPECT_EQ(text.AtEnd(), std::string(broken).empty()) << broken;
  }
  const std::string brackets(100000, '[');
  Reader deep(brackets);
  EXPECT_FALSE(deep.Skip());
}

}  // namespace
}  // namespace facewire::tools::json
