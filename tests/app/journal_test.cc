// The journal's entries as systemd receives them.

#include "app/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "hal/posix/unique_fd.h"
#include "tests/app/scratch.h"

namespace facewire::app {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

using Fields = std::map<std::string, std::string>;

// What stands behind /run/systemd/journal/socket.
class Journald {
 public:
  Journald() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path().c_str());
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
              0);
  }
  std::string path() const { return scratch_ / "journal"; }
  // The next entry; empty: none.
  Fields Next() {
    std::array<char, 8192> buffer;
    const ssize_t size = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    Fields fields;
    if (size <= 0) return fields;
    std::istringstream text(std::string(buffer.data(), static_cast<std::size_t>(size)));
    for (std::string line; std::getline(text, line);) {
      const std::size_t at = line.find('=');
      EXPECT_NE(at, std::string::npos) << line;
      EXPECT_TRUE(fields.emplace(line.substr(0, at), line.substr(at + 1)).second) << line;
    }
    return fields;
  }

 private:
  Scratch scratch_;
  hal::posix::UniqueFd socket_;
};

TEST(Journal, WritesFieldsToFilterBy) {
  Journald journald;
  Journal journal(journald.path());
  ASSERT_TRUE(journal.structured());
  journal.SetState("fault");
  journal.Write(Event::kFault, "fault: the camera is gone", "the camera is gone");
  const Fields entry = journald.Next();
  EXPECT_EQ(entry.at("MESSAGE"), "fault: the camera is gone");
  EXPECT_EQ(entry.at("FACEWIRE_EVENT"), "fault");
  EXPECT_EQ(entry.at("FACEWIRE_STATE"), "fault");
  EXPECT_EQ(entry.at("FACEWIRE_REASON"), "the camera is gone");
  EXPECT_EQ(entry.at("PRIORITY"), "4");
  EXPECT_EQ(entry.at("SYSLOG_IDENTIFIER"), "facewired");
  EXPECT_EQ(entry.at("MESSAGE_ID"), EventKinds()[static_cast<std::size_t>(Event::kFault)].id);
  EXPECT_THAT(entry.at("CODE_FILE"), EndsWith("journal_test.cc"));
  EXPECT_NE(entry.at("CODE_LINE"), "0");
  EXPECT_EQ(entry.at("CODE_FUNC"), "TestBody");
  EXPECT_TRUE(journald.Next().empty());
}

TEST(Journal, MakesAnEntryOfEveryLineAndCutsWhatIsTooLong) {
  Journald journald;
  Journal journal(journald.path());
  journal.Write(Event::kReloadProblem, "one\n\ntwo\n" + std::string(5000, 'x'),
                std::string(5000, 'y'));
  EXPECT_EQ(journald.Next().at("MESSAGE"), "one");
  EXPECT_EQ(journald.Next().at("MESSAGE"), "two");
  const Fields entry = journald.Next();
  EXPECT_THAT(entry.at("MESSAGE"), HasSubstr("xxxxx"));
  EXPECT_LT(entry.at("MESSAGE").size(), 1000U);
  EXPECT_EQ(entry.at("FACEWIRE_EVENT"), "reload_problem");
  EXPECT_TRUE(journald.Next().empty());
}

TEST(Journal, WritesPlainTextWhereThereIsNoJournal) {
  testing::internal::CaptureStderr();
  Journal none("/nowhere/at/all");
  EXPECT_FALSE(none.structured());
  none.Write(Event::kReady, "ready\nand set", "for no reason");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "facewired: ready\nfacewired: and set\n");
}

TEST(Journal, LosesNothingToAJournalThatIsGoneOrFull) {
  auto journald = std::make_unique<Journald>();
  Journal journal(journald->path());
  testing::internal::CaptureStderr();
  for (int i = 0; i < 2000; ++i) journal.Write(Event::kState, "full");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("facewired: full\n"));
  journald.reset();
  testing::internal::CaptureStderr();
  journal.Write(Event::kState, "gone");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "facewired: gone\n");
}

TEST(Journal, IsAskedOnlyWhenStderrIsItsStream) {
  ::setenv("JOURNAL_STREAM", "1:1", 1);
  EXPECT_FALSE(Journal().structured()) << "somebody else's";
  ::setenv("JOURNAL_STREAM", "nonsense", 1);
  EXPECT_FALSE(Journal().structured());
  ::unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(Journal().structured());
}

TEST(Journal, HasANumberOfItsOwnForEveryEventAndTheCatalogExplainsThemAll) {
  const std::string catalog = Scratch::Read(FACEWIRE_SOURCE_DIR "/systemd/facewire.catalog");
  const std::string table = Scratch::Read(FACEWIRE_SOURCE_DIR "/systemd/README.md");
  std::set<std::string> names, ids;
  std::size_t index = 0;
  for (const EventKind& kind : EventKinds()) {
    EXPECT_EQ(static_cast<std::size_t>(kind.event), index++) << kind.name;
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(ids.insert(kind.id).second) << kind.name;
    EXPECT_EQ(std::string(kind.id).size(), 32U) << kind.name;
    EXPECT_EQ(std::string(kind.id).find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_THAT(catalog, HasSubstr(std::string("\n-- ") + kind.id + "\n")) << kind.name;
    EXPECT_THAT(table, HasSubstr("| `" + std::string(kind.name) + "` | " +
                                 std::to_string(kind.priority) + " | `" + kind.id + "` |"))
        << "in the table of systemd/README.md";
  }
}

}  // namespace
}  // namespace facewire::app
