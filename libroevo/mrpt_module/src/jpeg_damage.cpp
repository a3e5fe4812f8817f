#include "jpeg_damage.h"

#include <csetjmp>
#include <cstdio>
#include <new>
// After <cstdio>: it uses FILE
#include <jerror.h>
#include <jpeglib.h>

namespace roevo {
namespace {

constexpr JDIMENSION kLargest = 8192;  ///< px; no camera is larger, and what claims to be takes gigabytes
constexpr int kPadding = 8;            ///< bytes before the end that cameras leave there

/// libjpeg goes on after damage, and tells of it here.
struct Reports {
    jpeg_error_mgr base;  // first: libjpeg knows this part
    std::jmp_buf failed;
    char text[JMSG_LENGTH_MAX];
    bool damaged;
};

Reports& reportsOf(j_common_ptr decoder) {
    return *reinterpret_cast<Reports*>(decoder->err);
}

void note(j_common_ptr decoder, int level) {
    Reports& reports = reportsOf(decoder);
    const bool is_padding = reports.base.msg_code == JWRN_EXTRANEOUS_DATA &&
                            reports.base.msg_parm.i[0] <= kPadding && reports.base.msg_parm.i[1] == JPEG_EOI;
    if (level >= 0 || is_padding || reports.damaged) return;  // warnings have level -1
    reports.base.format_message(decoder, reports.text);
    reports.damaged = true;
}

[[noreturn]] void fail(j_common_ptr decoder) {
    Reports& reports = reportsOf(decoder);
    reports.base.format_message(decoder, reports.text);
    reports.damaged = true;
    std::longjmp(reports.failed, 1);
}

/// Decodes the coefficients, not the pixels. Nothing here has a destructor, which longjmp would pass over.
void readCoefficients(const std::uint8_t* bytes, std::size_t size, Reports& reports) {
    jpeg_decompress_struct decoder{};
    decoder.err = jpeg_std_error(&reports.base);
    reports.base.emit_message = note;
    reports.base.error_exit = fail;
    if (setjmp(reports.failed) == 0) {
        jpeg_create_decompress(&decoder);
        jpeg_mem_src(&decoder, bytes, size);
        jpeg_read_header(&decoder, TRUE);
        // Coefficients of the whole image are held in memory
        if (decoder.image_width > kLargest || decoder.image_height > kLargest) {
            std::snprintf(reports.text, sizeof reports.text, "%u x %u pixels", decoder.image_width,
                          decoder.image_height);
            reports.damaged = true;
        } else {
            jpeg_read_coefficients(&decoder);
            jpeg_finish_decompress(&decoder);
        }
    }
    jpeg_destroy_decompress(&decoder);
}

}  // namespace

std::string jpegDataDamage(const std::vector<std::uint8_t>& bytes) {
    Reports reports{};
    readCoefficients(bytes.data(), bytes.size(), reports);
    if (reports.damaged && reports.base.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    return reports.damaged ? reports.text : "";
}

}  // namespace roevo
