#include "tools/facewire/monitor_view.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string_view>
#include <vector>

#include "core/wire/pose.h"

namespace facewire::tools {
namespace {

constexpr const char* kBold = "1";
constexpr const char* kDim = "2";
constexpr const char* kRed = "1;31";
constexpr const char* kGreen = "1;32";
constexpr const char* kYellow = "33";
constexpr const char* kBlue = "34";
constexpr const char* kMagenta = "35";
constexpr const char* kCyan = "36";

[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...) {
  std::array<char, 256> text{};
  va_list arguments;
  va_start(arguments, format);
  (void)std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

unsigned long long Big(std::uint64_t n) { return n; }

// One line of the screen: counts what a person sees, and takes no more than fits.
class Line {
 public:
  Line(int columns, ScreenStyle style) : left_(columns), style_(style) {}

  Line& Add(std::string_view text, const char* sgr = nullptr) {
    std::string seen;
    for (std::size_t i = 0; i < text.size() && left_ > 0; --left_) {
      do seen += text[i++];
      while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U);
    }
    const bool paint = style_.colour && sgr != nullptr && !seen.empty();
    text_ += paint ? "\x1b[" + std::string(sgr) + "m" + seen + "\x1b[0m" : seen;
    return *this;
  }
  // Spaces up to so many columns from the end.
  Line& FillTo(int from_end) {
    while (left_ > from_end) Add(" ");
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  int left_;
  ScreenStyle style_;
};

int Width(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string Padded(const std::string& text, int width, bool right) {
  const int missing = std::max(0, width - Width(text));
  const std::string spaces(static_cast<std::size_t>(missing), ' ');
  return right ? spaces + text : text + spaces;
}

std::string Shortened(std::string_view name, int width, bool unicode) {
  if (static_cast<int>(name.size()) <= width) return std::string(name);
  return std::string(name.substr(0, static_cast<std::size_t>(width - 1))) + (unicode ? "…" : "~");
}

const char* StateColour(ServiceState state) {
  switch (state) {
    case ServiceState::kTracking:
      return kGreen;
    case ServiceState::kStopped:
    case ServiceState::kFault:
      return kRed;
    case ServiceState::kHolding:
    case ServiceState::kEasing:
      return kYellow;
    default:
      return kBold;
  }
}

const char* BarColour(ChannelKind kind) {
  if (IsRotation(kind)) return kMagenta;
  return IsPosition(kind) ? kBlue : kCyan;
}

std::string UptimeText(std::uint32_t s) {
  return s < 86'400 ? Format("%u:%02u:%02u", s / 3600, s / 60 % 60, s % 60)
                    : Format("%u d %u:%02u", s / 86'400, s / 3600 % 24, s / 60 % 60);
}

std::string RateText(const MonitorModel& m) {
  const auto fps = m.rate.fps();
  return fps ? Format("%.1f fps", *fps) : "- fps";
}

std::string TitleLine(const MonitorModel& m, int columns, ScreenStyle style) {
  std::string rig = "waiting for poses";
  const bool described = m.rig.Complete() && m.RigKnown();
  if (described) {
    const Rig& r = m.rig.rig();
    rig = Format("%.*s  %zu bones  %zu channels", static_cast<int>(r.name.view().size()),
                 r.name.view().data(), r.bones.size(), r.channels.size());
  } else if (m.pose) {
    const std::size_t missing = m.rig.missing();
    rig = "waiting for the rig description";
    if (missing > 0) rig += Format(" (%zu to come)", missing);
  }
  Line line(columns, style);
  // Of a long path the end tells ports apart.
  constexpr int kTitle = 17;
  const int room = std::max(columns - kTitle - Width(rig) - 5, 8);
  std::string port = m.port;
  if (Width(port) > room) {
    port =
        (style.unicode ? "…" : "~") + port.substr(port.size() - static_cast<std::size_t>(room) + 1);
  }
  line.Add(" facewire monitor", kBold).Add("  " + port, kDim);
  line.Add("  ").FillTo(Width(rig) + 1).Add(rig, described ? kBold : kYellow);
  return line.text();
}

std::string StateLine(const MonitorModel& m, int columns, ScreenStyle style) {
  Line line(columns, style);
  const char* colour = m.state ? StateColour(*m.state) : kDim;
  line.Add(style.unicode ? " ● " : " * ", colour);
  line.Add(Padded(m.state ? Name(*m.state) : "silent", 11, false), colour);
  line.Add(Padded(RateText(m), 10, false));
  if (m.pose) {
    line.Add(Format(" latency %.0f ms", m.pose->age_us / 1000.0));
    line.Add(Format("  p50 %d  p99 %d", m.ages.Quantile(0.5), m.ages.Quantile(0.99)), kDim);
    line.Add(Format("  frame %u", m.pose->frame_seq));
  }
  return line.text();
}

std::string LinkLine(const MonitorModel& m, int columns, ScreenStyle style) {
  const auto count = [&](Line& line, const char* what, std::uint64_t n) {
    line.Add(std::string("  ") + what + " ", kDim)
        .Add(Format("%llu", Big(n)), n > 0 ? kRed : nullptr);
  };
  Line line(columns, style);
  line.Add(" line ", kDim).Add(Format("%llu frames", Big(m.link.frames)));
  count(line, "crc", m.link.crc_errors);
  count(line, "cut", m.link.Damaged() - m.link.crc_errors);
  count(line, "lost", m.link.lost);
  count(line, "resyncs", m.link.resyncs);
  if (m.link.restarts > 0) count(line, "restarts", m.link.restarts);
  return line.text();
}

std::string DeviceLine(const MonitorModel& m, int columns, ScreenStyle style) {
  Line line(columns, style);
  line.Add(" device ", kDim);
  if (!m.status) {
    line.Add("no status yet", kDim);
  } else {
    const wire::Status& s = *m.status;
    line.Add("up " + UptimeText(s.uptime_s)).Add(Format("  %.1f fps", s.centi_fps / 100.0));
    line.Add(Format("  dropped %u", s.dropped), s.dropped > 0 ? kYellow : nullptr);
    line.Add(Format("  face lost %u", s.losses));
    line.Add(Format("  link errors %u", s.link_errors), s.link_errors > 0 ? kRed : nullptr);
  }
  return line.text();
}

// One channel's place on the screen.
struct Cell {
  std::string name;
  std::string value;
  std::string bar;
  const char* colour = nullptr;
  bool at_limit = false;
};

struct CellWidths {
  int name, value, bar;
};

constexpr int kFrameRows = 6;       // title, state, line, device, a blank one before and one after
constexpr int kNarrowestCell = 38;  // a name, a bar and a value that can be read
constexpr int kValueWidth = 10;

CellWidths WidthsFor(int cell_columns, int longest_name) {
  // Blank, name, blank, bar in its two ends, blank, value.
  const int name = std::clamp(std::min(longest_name, cell_columns / 2 - 5), 4, 24);
  return {name, kValueWidth, std::max(4, cell_columns - name - kValueWidth - 5)};
}

Cell MakeCell(const Channel& channel, float value, CellWidths widths, bool unicode) {
  Cell cell;
  cell.name = Padded(Shortened(channel.name.view(), widths.name, unicode), widths.name, false);
  cell.value = Padded(ValueText(channel, value, unicode), widths.value, true);
  cell.bar = DrawBar(value, channel.neutral, channel.min, channel.max, widths.bar, unicode);
  cell.colour = BarColour(channel.kind);
  cell.at_limit = value != channel.neutral && (value <= channel.min || value >= channel.max);
  return cell;
}

// The channels of the last pose; a rig that is not known yet gives numbered channels from 0 to 1.
std::vector<Channel> ChannelsOf(const MonitorModel& m) {
  if (m.RigKnown()) {
    const auto channels = m.rig.rig().channels.span();
    return {channels.begin(), channels.end()};
  }
  std::vector<Channel> channels(m.pose ? m.pose->values.size() : 0);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    channels[i].name = *ShortName::From("channel" + std::to_string(i));
  }
  return channels;
}

std::string FooterLine(const MonitorModel& m, std::size_t hidden, int columns, ScreenStyle style) {
  Line line(columns, style);
  line.Add(" Ctrl-C ends", kDim);
  if (hidden > 0) line.Add(Format("  %zu more channels: enlarge the terminal", hidden), kYellow);
  if (m.bytes > 2000 && m.link.frames == 0 && m.note.empty()) {
    line.Add("  bytes arrive, but no frame: is the baud rate right?", kYellow);
  }
  if (!m.note.empty()) line.Add("  " + m.note, kYellow);
  return line.text();
}

}  // namespace

std::string DrawBar(double value, double neutral, double min, double max, int width, bool unicode) {
  // In half characters, so that a bar moves twice as finely as there are columns.
  const int halves = 2 * width;
  const auto at = [&](double v) {
    const double part = max > min ? (std::clamp(v, min, max) - min) / (max - min) : 0;
    return static_cast<int>(std::lround(part * halves));
  };
  if (std::isnan(value)) value = neutral;
  const int from = std::min(at(value), at(neutral));
  const int to = std::max(at(value), at(neutral));
  const int mark = std::min(at(neutral) / 2, width - 1);
  std::string bar;
  for (int i = 0; i < width; ++i) {
    const bool left = from <= 2 * i && 2 * i < to;
    const bool right = from <= 2 * i + 1 && 2 * i + 1 < to;
    if (!unicode) {
      bar += left || right ? '#' : (i == mark ? '|' : '.');
    } else if (left || right) {
      bar += left && right ? "█" : (left ? "▌" : "▐");
    } else {
      bar += i == mark ? "│" : "·";
    }
  }
  return bar;
}

std::string ValueText(const Channel& channel, float value, bool unicode) {
  const double v = std::abs(value) < 0.0005F ? 0.0 : static_cast<double>(value);  // no "-0.00"
  if (IsRotation(channel.kind)) return Format("%.1f%s", v, unicode ? "°" : " deg");
  if (IsPosition(channel.kind)) return Format("%.2f cm", v);
  return std::max(std::abs(channel.min), std::abs(channel.max)) < 100 ? Format("%.2f", v)
                                                                      : Format("%.0f", v);
}

std::string DrawScreen(const MonitorModel& m, ScreenSize size, ScreenStyle style) {
  const int columns = std::max(size.columns, 1);
  const int rows = std::max(size.rows, 1);
  std::vector<std::string> lines = {TitleLine(m, columns, style), StateLine(m, columns, style),
                                    LinkLine(m, columns, style), DeviceLine(m, columns, style), ""};

  const std::vector<Channel> channels = ChannelsOf(m);
  const int count = static_cast<int>(channels.size());
  const int room = std::max(rows - kFrameRows, 0);
  const int widest = std::max(columns / kNarrowestCell, 1);
  const int beside = room == 0 ? 1 : std::clamp((count + room - 1) / room, 1, widest);
  const int used = std::min(room, (count + beside - 1) / beside);
  int longest = 4;
  for (const Channel& c : channels) {
    longest = std::max(longest, static_cast<int>(c.name.view().size()));
  }
  const CellWidths widths = WidthsFor(columns / beside, longest);
  Rig numbered;
  for (const Channel& c : channels) (void)numbered.channels.try_push(c);
  const RigPose pose = m.pose ? wire::ValuesOf(*m.pose, numbered) : numbered.NeutralPose();

  for (int row = 0; row < used; ++row) {
    Line line(columns, style);
    for (int b = 0; b < beside; ++b) {
      const int i = b * used + row;
      if (i >= count) break;
      const auto at = static_cast<std::size_t>(i);
      const Cell cell = MakeCell(channels[at], pose.values[at], widths, style.unicode);
      line.Add(" " + cell.name + " ").Add(style.unicode ? "▕" : "[", kDim);
      line.Add(cell.bar, cell.colour).Add(style.unicode ? "▏" : "]", kDim);
      line.Add(cell.value, cell.at_limit ? kYellow : nullptr)
          .Add(cell.at_limit ? "!" : " ", kYellow);
    }
    lines.push_back(line.text());
  }
  lines.resize(static_cast<std::size_t>(rows));
  const int shown = std::min(count, used * beside);
  lines.back() = FooterLine(m, static_cast<std::size_t>(count - shown), columns, style);

  std::string screen;
  for (const std::string& line : lines) screen += (screen.empty() ? "" : "\n") + line;
  return screen;
}

std::string PlainLine(const MonitorModel& m) {
  std::string line = Format("%8.1f s  %-10s", m.elapsed_s, m.state ? Name(*m.state) : "silent");
  line += Format("  %-9s", RateText(m).c_str());
  line += m.pose ? Format("  latency %.0f ms", m.pose->age_us / 1000.0) : "  latency -";
  line += Format("  poses %llu  crc %llu  cut %llu  lost %llu  resyncs %llu", Big(m.poses),
                 Big(m.link.crc_errors), Big(m.link.Damaged() - m.link.crc_errors),
                 Big(m.link.lost), Big(m.link.resyncs));
  if (m.pose && !m.RigKnown()) line += "  rig description incomplete";
  return line;
}

std::string SummaryText(const MonitorModel& m) {
  std::string text =
      Format("%s: %.1f s, %llu bytes, %llu frames, of them %llu poses\n", m.port.c_str(),
             m.elapsed_s, Big(m.bytes), Big(m.link.frames), Big(m.poses));
  const Rig& rig = m.rig.rig();
  if (m.rig.Complete()) {
    text += Format("rig: %.*s, %zu bones, %zu channels\n", static_cast<int>(rig.name.view().size()),
                   rig.name.view().data(), rig.bones.size(), rig.channels.size());
  } else {
    text += "rig: no complete description arrived\n";
  }
  text +=
      Format("damage: %llu crc errors, %llu cut, %llu lost, %llu resyncs\n", Big(m.link.crc_errors),
             Big(m.link.Damaged() - m.link.crc_errors), Big(m.link.lost), Big(m.link.resyncs));
  if (m.link.restarts + m.link.unknown + m.link.versions + m.link.malformed > 0) {
    text += Format(
        "also: %llu restarts of the sender, %llu unknown, %llu of another version, "
        "%llu malformed\n",
        Big(m.link.restarts), Big(m.link.unknown), Big(m.link.versions), Big(m.link.malformed));
  }
  if (!m.ages.empty()) {
    text += Format("latency from capture to sending: p50 %d ms, p99 %d ms; %s\n",
                   m.ages.Quantile(0.5), m.ages.Quantile(0.99), RateText(m).c_str());
  }
  return text;
}

}  // namespace facewire::tools
