#include "tools/facewire/training_sheet.h"

#include <charconv>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "app/error.h"
#include "app/profile_file.h"
#include "tools/sheet/training.h"

namespace facewire::tools {
namespace {

// Twenty lines of three: what one can still look through.
constexpr std::size_t kMostCards = 60;

std::optional<std::size_t> RowNumber(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// The rows of "A:B", from 0.
std::vector<std::size_t> ParseRows(const std::string& rows, std::size_t count) {
  const std::size_t colon = rows.find(':');
  const auto first = RowNumber(rows.substr(0, colon));
  const auto last = colon == std::string::npos ? std::nullopt : RowNumber(rows.substr(colon + 1));
  if (!first || !last || *first < 1 || *first > *last || *last > count)
    throw app::BadInput("--rows: \"" + rows + "\" is not A:B, rows A to B of 1 to " +
                        std::to_string(count));
  if (*last - *first >= kMostCards)
    throw app::BadInput("--rows: " + rows + " are " + std::to_string(*last - *first + 1) +
                        " rows; a sheet shows at most " + std::to_string(kMostCards));
  std::vector<std::size_t> chosen(*last - *first + 1);
  std::iota(chosen.begin(), chosen.end(), *first - 1);
  return chosen;
}

}  // namespace

cv::Mat SheetOfTraining(const std::string& profile, const std::optional<std::string>& rows) {
  const app::TrainingSet training = app::ReadTrainingSet(profile);
  std::vector<float> leave_one_out(training.targets.size());
  const app::Profile solved(training, profile, leave_one_out);
  std::vector<std::string> signals;
  for (const ShortName& signal : training.signals) signals.emplace_back(signal.view());

  TrainingPicture picture;
  picture.rows = training.view().sample_count();
  picture.neutral_row = training.neutral_sample;
  picture.signals = signals;
  picture.samples_cm = training.samples;
  picture.targets = training.targets;
  picture.leave_one_out = leave_one_out;

  const std::string of = " of " + std::to_string(picture.rows);
  if (rows) {
    const auto chosen = ParseRows(*rows, picture.rows);
    return DrawTrainingSheet("rows " + std::to_string(chosen.front() + 1) + " to " +
                                 std::to_string(chosen.back() + 1) + of,
                             picture, chosen);
  }
  const auto chosen = WorstRows(picture, kMostCards);
  return DrawTrainingSheet(chosen.size() == picture.rows
                               ? "all " + std::to_string(picture.rows) + " rows"
                               : "the face at rest and the " + std::to_string(chosen.size() - 1) +
                                     " worst rows" + of + "; --rows A:B shows others",
                           picture, chosen);
}

}  // namespace facewire::tools
