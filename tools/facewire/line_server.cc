#include "tools/facewire/line_server.h"

#include <libwebsockets.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "app/error.h"

namespace facewire::tools {
namespace {

constexpr const char* kLinePath = "/line";
constexpr std::size_t kBufferBytes = std::size_t{64} * 1024;  // of a file, sent at a time

std::string Header(lws* connection, lws_token_indexes which) {
  std::array<char, 512> text{};
  const int size = lws_hdr_copy(connection, text.data(), text.size(), which);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

// Browsers say which page opens a connection; a program that says nothing is trusted as a local
// one.
bool FromOwnPage(lws* connection) {
  const std::string origin = Header(connection, WSI_TOKEN_ORIGIN);
  return origin.empty() || origin == "http://" + Header(connection, WSI_TOKEN_HOST);
}

// Only what comes from here runs, no other page shows this one, and the characters that people drop
// stay readable: their parts are blob: and data:, and their decoder is WebAssembly.
constexpr lws_protocol_vhost_options kNoSniffing{nullptr, nullptr,
                                                 "x-content-type-options:", "nosniff"};
constexpr lws_protocol_vhost_options kNoReferrer{&kNoSniffing, nullptr,
                                                 "referrer-policy:", "no-referrer"};
constexpr lws_protocol_vhost_options kHeaders{
    &kNoReferrer, nullptr, "content-security-policy:",
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
    "img-src 'self' data: blob:; connect-src 'self' ws: wss: data: blob:; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"};

}  // namespace

class LineServer::Impl {
 public:
  explicit Impl(const Config& config) : files_(config.files.string()) {
    mount_.mountpoint = "/";
    mount_.mountpoint_len = 1;
    mount_.origin = files_.c_str();
    mount_.def = "index.html";
    mount_.origin_protocol = LWSMPRO_FILE;
    // Browsers name no protocol, and then get the first.
    protocols_[0].name = "facewire";
    protocols_[0].callback = &Impl::Callback;
    protocols_[0].rx_buffer_size = 4096;
    protocols_[0].user = this;

    lws_set_log_level(0, nullptr);
    lws_context_creation_info info{};
    info.port = config.port;
    info.iface = config.address == "0.0.0.0" ? nullptr : config.address.c_str();
    info.protocols = protocols_.data();
    info.mounts = &mount_;
    info.pt_serv_buf_size = kBufferBytes;
    info.gid = static_cast<gid_t>(-1);
    info.uid = static_cast<uid_t>(-1);
    info.headers = &kHeaders;
    info.options = LWS_SERVER_OPTION_DISABLE_IPV6;
    context_ = lws_create_context(&info);
    lws_vhost* host = context_ != nullptr ? lws_get_vhost_by_name(context_, "default") : nullptr;
    port_ = host != nullptr ? lws_get_vhost_listen_port(host) : 0;
    if (port_ <= 0) {
      if (context_ != nullptr) lws_context_destroy(context_);
      throw app::Failure("cannot listen on " + config.address + " port " +
                         std::to_string(config.port));
    }
  }
  ~Impl() { lws_context_destroy(context_); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int port() const noexcept { return port_; }
  std::size_t viewers() const noexcept { return waiting_.size(); }

  void Send(std::span<const std::byte> bytes) {
    for (auto& [connection, waiting] : waiting_) {
      waiting.insert(waiting.end(), bytes.begin(), bytes.end());
      if (waiting.size() > kMaxWaiting) {
        waiting.erase(waiting.begin(), waiting.end() - static_cast<std::ptrdiff_t>(kMaxWaiting));
      }
      (void)lws_callback_on_writable(connection);
    }
  }

  std::vector<std::byte> Service() {
    (void)lws_service(context_, -1);
    return std::exchange(received_, {});
  }

 private:
  static int Callback(lws* connection, lws_callback_reasons reason, void* session, void* data,
                      std::size_t size) {
    const lws_protocols* protocol = lws_get_protocol(connection);
    auto* self = protocol != nullptr ? static_cast<Impl*>(protocol->user) : nullptr;
    if (self == nullptr) return lws_callback_http_dummy(connection, reason, session, data, size);
    switch (reason) {
      case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return self->MayConnect(connection) ? 0 : 1;
      case LWS_CALLBACK_ESTABLISHED:
        self->waiting_[connection];
        return 0;
      case LWS_CALLBACK_CLOSED:
        self->waiting_.erase(connection);
        return 0;
      case LWS_CALLBACK_RECEIVE: {
        const auto* bytes = static_cast<const std::byte*>(data);
        self->received_.insert(self->received_.end(), bytes, bytes + size);
        return 0;
      }
      case LWS_CALLBACK_SERVER_WRITEABLE:
        return self->Write(connection);
      default:
        return lws_callback_http_dummy(connection, reason, session, data, size);
    }
  }

  bool MayConnect(lws* connection) const {
    return waiting_.size() < kMaxViewers && FromOwnPage(connection) &&
           Header(connection, WSI_TOKEN_GET_URI) == kLinePath;
  }

  // The library wants room before what it sends.
  int Write(lws* connection) {
    auto& waiting = waiting_[connection];
    if (waiting.empty()) return 0;
    std::vector<unsigned char> buffer(LWS_PRE + waiting.size());
    std::ranges::transform(waiting, buffer.begin() + LWS_PRE,
                           [](std::byte b) { return std::to_integer<unsigned char>(b); });
    const int written =
        lws_write(connection, buffer.data() + LWS_PRE, waiting.size(), LWS_WRITE_BINARY);
    waiting.clear();
    return written < 0 ? -1 : 0;
  }

  std::string files_;
  lws_http_mount mount_{};
  std::array<lws_protocols, 2> protocols_{};  // the last one is empty
  lws_context* context_ = nullptr;
  int port_ = 0;
  std::map<lws*, std::vector<std::byte>> waiting_;  // for each viewer
  std::vector<std::byte> received_;
};

LineServer::LineServer(const Config& config) : impl_(std::make_unique<Impl>(config)) {}
LineServer::~LineServer() = default;
int LineServer::port() const noexcept { return impl_->port(); }
std::size_t LineServer::viewers() const noexcept { return impl_->viewers(); }
void LineServer::Send(std::span<const std::byte> bytes) { impl_->Send(bytes); }
std::vector<std::byte> LineServer::Service() { return impl_->Service(); }

}  // namespace facewire::tools
