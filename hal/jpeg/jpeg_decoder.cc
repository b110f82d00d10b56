#include "hal/jpeg/jpeg_decoder.h"

// jpeglib.h needs these to come first.
#include <cstddef>
#include <cstdio>
//
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <memory>
#include <new>
#include <vector>

namespace facewire::hal::jpeg {
namespace {

// The vector code of libjpeg-turbo reads and writes whole vectors: its own manager aligns rows of
// samples so, and makes them multiples of it.
constexpr std::size_t kAlignment = 64;

constexpr std::size_t Aligned(std::size_t bytes) noexcept {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// What decoding one picture takes: tables of constant size (15 KiB measured), and rows of samples.
// A JPEG decodes at most 10 blocks at once, of 8 rows each, and turns up to 4 rows of three
// components into colour.
constexpr std::size_t WorkBytes(int width_px) noexcept {
  constexpr std::size_t kTables = std::size_t{32} << 10U;
  constexpr std::size_t kRows = 10 * 8 + 4 * 3;
  return kTables + kRows * (Aligned(static_cast<std::size_t>(width_px)) + sizeof(void*));
}

// Webcams are known for putting a few bytes too many before their restart and end markers, in every
// picture (a Logitech C270: 1 to 10). More than this is what a damaged stretch leaves behind.
constexpr int kMostPadding = 32;

// Remarks that leave the picture whole.
bool IsHarmless(const jpeg_error_mgr& remark) noexcept {
  switch (remark.msg_code) {
    case JWRN_EXTRANEOUS_DATA:
      return remark.msg_parm.i[0] <= kMostPadding;
    case JWRN_JFIF_MAJOR:
    case JWRN_ADOBE_XFORM:
      return true;
    default:
      return false;
  }
}

}  // namespace

// libjpeg's own interface and not its wrapper libturbojpeg, which takes and frees memory for every
// picture (2.1.5: tjDecompress2 8 times, tjDecompressToYUVPlanes 5 times). Here the library gets
// a memory manager whose one block is empty again before each picture.
class JpegDecoder::Library {
 public:
  Library(int width_px, int height_px)
      : width_px_(width_px),
        height_px_(height_px),
        work_(WorkBytes(width_px) + kAlignment),
        pixels_(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {
    void* at = work_.data();
    std::size_t room = work_.size();
    begin_ = static_cast<std::byte*>(std::align(kAlignment, WorkBytes(width_px), at, room));

    codec_.err = jpeg_std_error(&errors_);
    errors_.error_exit = [](j_common_ptr codec) { Of(codec).GiveUp(); };
    errors_.emit_message = [](j_common_ptr codec, int level) {
      if (level < 0 && !IsHarmless(*codec->err)) Of(codec).GiveUp();
    };
    errors_.output_message = [](j_common_ptr) {};
    codec_.client_data = this;
    if (!Create()) throw std::bad_alloc();

    source_.init_source = [](j_decompress_ptr) {};
    source_.term_source = [](j_decompress_ptr) {};
    source_.resync_to_restart = jpeg_resync_to_restart;
    source_.fill_input_buffer = [](j_decompress_ptr codec) { return Of(codec).EndInput(); };
    source_.skip_input_data = [](j_decompress_ptr codec, long bytes) { Of(codec).Skip(bytes); };
    codec_.src = &source_;

    codec_.mem->alloc_small = TakeBytes;
    codec_.mem->alloc_large = TakeBytes;
    codec_.mem->alloc_sarray = [](j_common_ptr codec, int /*pool*/, JDIMENSION samples,
                                  JDIMENSION rows) {
      return Of(codec).TakeRows<JSAMPLE>(samples, rows);
    };
    codec_.mem->alloc_barray = [](j_common_ptr codec, int /*pool*/, JDIMENSION blocks,
                                  JDIMENSION rows) {
      return Of(codec).TakeRows<JBLOCK>(blocks, rows);
    };
    codec_.mem->free_pool = [](j_common_ptr, int) {};
  }
  ~Library() { jpeg_destroy_decompress(&codec_); }  // gives back what Create took
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  bool Decode(std::span<const std::uint8_t> jpeg) noexcept {
    // Tables belong to the memory that is now empty; a picture that brings none of its own gets the
    // standard ones, as Motion JPEG has it, and never the (damaged?) ones of its predecessor.
    used_ = 0;
    for (JQUANT_TBL*& table : codec_.quant_tbl_ptrs) table = nullptr;
    for (JHUFF_TBL*& table : codec_.dc_huff_tbl_ptrs) table = nullptr;
    for (JHUFF_TBL*& table : codec_.ac_huff_tbl_ptrs) table = nullptr;
    source_.next_input_byte = jpeg.data();
    source_.bytes_in_buffer = jpeg.size();
    const bool whole = Run();
    jpeg_abort_decompress(&codec_);
    return whole;
  }

  ImageView View() const noexcept {
    ImageView view{.format = PixelFormat::kRgb24, .width_px = width_px_, .height_px = height_px_};
    view.planes[0] = {.data = pixels_.data(), .stride_bytes = 3 * width_px_};
    return view;
  }

 private:
  template <class Codec>
  static Library& Of(Codec* codec) noexcept {
    return *static_cast<Library*>(codec->client_data);
  }

  // A C library reports errors by a jump over its own frames: no object of C++ lives in them.

  [[noreturn]] void GiveUp() noexcept { std::longjmp(failed_, 1); }

  bool Create() noexcept {
    if (setjmp(failed_) != 0) return false;
    jpeg_create_decompress(&codec_);
    return true;
  }

  bool Run() noexcept {
    if (setjmp(failed_) != 0) return false;
    jpeg_read_header(&codec_, TRUE);
    const bool fits = codec_.image_width == static_cast<JDIMENSION>(width_px_) &&
                      codec_.image_height == static_cast<JDIMENSION>(height_px_) &&
                      codec_.data_precision == 8;
    // A picture in several passes needs memory for all its coefficients; no camera sends one.
    if (!fits || jpeg_has_multiple_scans(&codec_) != 0) return false;
    codec_.out_color_space = JCS_RGB;
    codec_.do_fancy_upsampling = FALSE;  // the tracker cannot tell, and it takes longer
    jpeg_start_decompress(&codec_);
    while (codec_.output_scanline < codec_.output_height) {
      std::array<JSAMPROW, 4> rows;  // as many as the library makes at once
      const JDIMENSION first = codec_.output_scanline;
      const JDIMENSION count = std::min<JDIMENSION>(rows.size(), codec_.output_height - first);
      for (JDIMENSION i = 0; i < count; ++i) {
        rows[i] = pixels_.data() + std::size_t{first + i} * 3 * static_cast<std::size_t>(width_px_);
      }
      jpeg_read_scanlines(&codec_, rows.data(), count);
    }
    jpeg_finish_decompress(&codec_);
    return true;
  }

  // Past the end: an end marker. A picture that lacks only that one is whole; the library notices
  // when anything else is missing.
  boolean EndInput() noexcept {
    static constexpr std::array<JOCTET, 2> kEnd = {0xFF, JPEG_EOI};
    source_.next_input_byte = kEnd.data();
    source_.bytes_in_buffer = kEnd.size();
    return TRUE;
  }
  void Skip(long bytes) noexcept {
    if (bytes <= 0) return;
    const auto count = static_cast<std::size_t>(bytes);
    if (count > source_.bytes_in_buffer) {
      EndInput();
      return;
    }
    source_.next_input_byte += count;
    source_.bytes_in_buffer -= count;
  }

  static void* TakeBytes(j_common_ptr codec, int /*pool*/, std::size_t bytes) {
    return Of(codec).Take(bytes);
  }
  std::byte* Take(std::size_t bytes) noexcept {
    const std::size_t room = WorkBytes(width_px_) - used_;
    if (bytes > room || Aligned(bytes) > room) GiveUp();
    std::byte* at = begin_ + used_;
    used_ += Aligned(bytes);
    return at;
  }
  template <class Item>
  Item** TakeRows(std::size_t items, std::size_t rows) noexcept {
    const std::size_t stride = Aligned(items * sizeof(Item));
    auto** row = reinterpret_cast<Item**>(Take(rows * sizeof(Item*)));
    std::byte* at = Take(rows * stride);
    for (std::size_t i = 0; i < rows; ++i) row[i] = reinterpret_cast<Item*>(at + i * stride);
    return row;
  }

  int width_px_;
  int height_px_;
  std::vector<std::byte> work_;
  std::byte* begin_ = nullptr;  // of work_, aligned
  std::size_t used_ = 0;
  std::vector<std::uint8_t> pixels_;
  jpeg_decompress_struct codec_{};
  jpeg_error_mgr errors_{};
  jpeg_source_mgr source_{};
  std::jmp_buf failed_{};
};

JpegDecoder::JpegDecoder(int width_px, int height_px)
    : library_(std::make_unique<Library>(width_px, height_px)) {}

JpegDecoder::~JpegDecoder() = default;

Result<ImageView> JpegDecoder::Decode(std::span<const std::uint8_t> jpeg) noexcept {
  if (!library_->Decode(jpeg)) return Errc::kCorrupt;
  return library_->View();
}

}  // namespace facewire::hal::jpeg
