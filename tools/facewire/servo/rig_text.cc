#include "tools/facewire/servo/rig_text.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "app/error.h"
#include "app/rig_file.h"
#include "app/servo_rig_file.h"
#include "app/toml_reader.h"
#include "tools/facewire/output_file.h"
#include "tools/facewire/servo/temporary_file.h"

namespace facewire::tools {
namespace {

// Finds places of TOML's (lines and columns, in characters) in the text's bytes.
class Places {
 public:
  explicit Places(std::string_view text) : text_(text) {
    lines_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') lines_.push_back(i + 1);
    }
  }
  std::size_t At(toml::source_position place) const {
    std::size_t at = lines_[place.line - 1];
    for (unsigned column = 1; column < place.column; ++column) {
      ++at;
      while (at < text_.size() && IsContinuation(text_[at])) ++at;
    }
    return at;
  }
  std::size_t LineStart(unsigned line) const { return lines_[line - 1]; }
  std::size_t NextLine(unsigned line) const {
    return line < lines_.size() ? lines_[line] : text_.size();
  }

 private:
  static bool IsContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

  std::string_view text_;
  std::vector<std::size_t> lines_;  // where each begins
};

class Editor {
 public:
  Editor(std::string_view text, const toml::table& servo)
      : text_(text), places_(text), servo_(servo) {}

  void Set(std::string_view key, double value) {
    if (const toml::node* node = servo_.get(key)) {
      Replace(*node, value);
    } else {
      Insert(key, value);
    }
  }
  void SetIfThere(std::string_view key, double value) {
    if (const toml::node* node = servo_.get(key)) Replace(*node, value);
  }
  // The outs of the map's points, moved so that its ends are min and max, and, where both lie
  // between the ends, neutral is taken to neutral.
  void Stretch(const ServoEdit& edit) {
    const toml::array& map = *servo_.get("map")->as_array();
    const double first = Out(map, 0);
    const double last = Out(map, map.size() - 1);
    const double to_first = first < last ? *edit.min : *edit.max;
    const double to_last = first < last ? *edit.max : *edit.min;
    const double middle = edit.neutral_was.value_or(first);
    const double to_middle = edit.neutral.value_or(to_first);
    const bool bends = Between(first, middle, last) && Between(to_first, to_middle, to_last);
    for (std::size_t i = 0; i < map.size(); ++i) {
      const double out = Out(map, i);
      double to = Along(out, first, last, to_first, to_last);
      if (bends && Between(first, out, middle)) {
        to = Along(out, first, middle, to_first, to_middle);
      } else if (bends) {
        to = i == 0 ? to_first : Along(out, middle, last, to_middle, to_last);
      }
      Replace(*map[i].as_array()->get(1), to);
    }
  }

  std::string Result() {
    std::ranges::sort(changes_, std::ranges::greater{}, &Change::at);
    std::string result(text_);
    if (!inserted_.empty()) {
      const std::size_t at = places_.NextLine(Anchor().source().end.line);
      const bool ended = at > 0 && text_[at - 1] == '\n';
      changes_.insert(std::ranges::find_if(changes_, [&](const Change& c) { return c.at < at; }),
                      {at, 0, (ended ? "" : "\n") + inserted_});
    }
    for (const Change& change : changes_) result.replace(change.at, change.size, change.text);
    return result;
  }

 private:
  struct Change {
    std::size_t at;
    std::size_t size;
    std::string text;
  };

  static bool Between(double a, double x, double b) { return (x - a) * (b - x) > 0; }
  static double Along(double x, double from, double until, double to_from, double to_until) {
    return to_from + (x - from) / (until - from) * (to_until - to_from);
  }
  static double Out(const toml::array& map, std::size_t i) {
    return map[i].as_array()->get(1)->value<double>().value_or(0);
  }
  // New keys stand below the map, or the id: what follows may be tables of their own.
  const toml::node& Anchor() const {
    const toml::node* map = servo_.get("map");
    return map != nullptr ? *map : *servo_.get("id");
  }
  void Replace(const toml::node& node, double value) {
    const std::size_t begin = places_.At(node.source().begin);
    const std::size_t end = places_.At(node.source().end);
    changes_.push_back({begin, end - begin, PositionText(value)});
  }
  void Insert(std::string_view key, double value) {
    const std::size_t line = places_.LineStart(Anchor().source().begin.line);
    const std::size_t word = text_.find_first_not_of(" \t", line);
    const bool dos = text_.find("\r\n") != std::string_view::npos;
    inserted_ += std::string(text_.substr(line, word - line)) + std::string(key) + " = " +
                 PositionText(value) + (dos ? "\r\n" : "\n");
  }

  std::string_view text_;
  Places places_;
  const toml::table& servo_;
  std::vector<Change> changes_;
  std::string inserted_;
};

toml::table Parse(std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw app::BadInput("line " + std::to_string(error.source().begin.line) + ": " +
                        std::string(error.description()));
  }
}

const toml::table& FindServo(const toml::table& root, std::string_view name) {
  const auto* servos = root.get_as<toml::array>("servo");
  for (std::size_t i = 0; servos != nullptr && i < servos->size(); ++i) {
    const toml::table* servo = (*servos)[i].as_table();
    if (servo == nullptr || (*servo)["name"].value<std::string_view>() != name) continue;
    if (servo->is_inline()) {
      throw app::BadInput("servo \"" + std::string(name) +
                          "\" is written in { }; write it as a [[servo]] to have it edited");
    }
    return *servo;
  }
  throw app::BadInput("no servo \"" + std::string(name) + "\" in this rig");
}

}  // namespace

std::string PositionText(double position) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2f", position);
  std::string shown = text.data();
  shown.erase(shown.find_last_not_of('0') + 1);
  if (shown.back() == '.') shown.pop_back();
  return shown == "-0" ? "0" : shown;
}

std::string EditServo(std::string_view text, std::string_view servo, const ServoEdit& edit) {
  const toml::table root = Parse(text);
  const toml::table& table = FindServo(root, servo);
  Editor editor(text, table);
  const bool stretch = edit.map_ends && edit.min && edit.max && table.contains("map");
  if (stretch) editor.Stretch(edit);
  for (const auto& [key, value] : {std::pair("min", edit.min), std::pair("max", edit.max)}) {
    if (value) stretch ? editor.SetIfThere(key, *value) : editor.Set(key, *value);
  }
  if (edit.neutral) editor.Set("neutral", *edit.neutral);
  return editor.Result();
}

void CheckRigText(const std::filesystem::path& file, const std::string& text) {
  CheckAsFile(std::filesystem::temp_directory_path(), text, file.string(),
              [](const std::filesystem::path& copy) {
                const Rig rig = app::LoadRig(copy);
                (void)app::LoadServoRig(copy, rig);
              });
}

void ReplaceRig(const std::filesystem::path& file, const std::string& text) {
  CheckRigText(file, text);
  OutputFile out(file.string());
  out.Write(text);
  out.Commit();
}

void RequireWritable(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (::access(file.c_str(), W_OK) == 0 && ::access(folder.c_str(), W_OK) == 0) return;
  throw app::BadInput(file.string() + " cannot be written: " + std::strerror(errno) +
                      (errno == EACCES ? "; try again with sudo" : ""));
}

}  // namespace facewire::tools
