#include "app/address_reader.h"

namespace facewire::app {

void ReadAddress(TableReader& table, std::string_view key, std::string_view form,
                 const std::vector<std::string>& kinds, std::string& value) {
  std::string text = value;
  table.Text(key, text);
  for (const std::string& kind : kinds) {
    const bool wants_rest = kind.back() == ':';
    if (text == kind ? !wants_rest : wants_rest && text.starts_with(kind)) {
      value = text;
      return;
    }
  }
  table.Problem(key, "\"" + text + "\" is not understood; expected " + std::string(form));
}

void ReadLineAddress(TableReader& table, std::string_view key, const std::filesystem::path& folder,
                     bool optional, std::string& value) {
  const std::string lines = R"("serial:/dev/ttyACM0")";
  if (optional) {
    ReadAddress(table, key, lines + R"(, "pty:LINK" or "none")", {"serial:", "pty:", "none"},
                value);
  } else {
    ReadAddress(table, key, lines + R"( or "pty:LINK")", {"serial:", "pty:"}, value);
  }
  const std::size_t colon = value.find(':');
  if (colon == std::string::npos) return;
  const std::filesystem::path path = folder / value.substr(colon + 1);
  value = value.substr(0, colon + 1) + path.lexically_normal().string();
}

}  // namespace facewire::app
