#ifndef FACEWIRE_APP_ADDRESS_READER_H_
#define FACEWIRE_APP_ADDRESS_READER_H_

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/toml_reader.h"

namespace facewire::app {

// "kind:rest" with one of the kinds; a kind that ends in ':' wants a rest, others stand alone.
// `form` is what a message says is expected.
void ReadAddress(TableReader& table, std::string_view key, std::string_view form,
                 const std::vector<std::string>& kinds, std::string& value);

// The address of a serial line, for MakeHostLine: "serial:PATH" or "pty:LINK", and "none" where
// `optional`. Paths become absolute, relative ones in `folder`.
void ReadLineAddress(TableReader& table, std::string_view key, const std::filesystem::path& folder,
                     bool optional, std::string& value);

}  // namespace facewire::app

#endif  // FACEWIRE_APP_ADDRESS_READER_H_
