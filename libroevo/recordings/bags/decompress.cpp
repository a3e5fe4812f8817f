#include "recordings/bags/decompress.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "input/excerpt.h"

namespace roevo {
namespace {

constexpr std::uint64_t kStep = std::uint64_t{1} << 20;     // bytes of room at a time
constexpr std::uint64_t kLargest = std::uint64_t{1} << 28;  // bytes; recorders end a piece after some MB

/// Room for more at the end of `out`: one byte beyond `size`, so that the decoder always has some and what is
/// longer is seen.
std::size_t grow(std::string& out, std::uint64_t size) {
    const std::size_t before = out.size();
    out.resize(std::min(size + 1, before + std::max<std::uint64_t>(kStep, before)));
    return before;
}

[[noreturn]] void damaged(const std::string& method) {
    throw std::runtime_error("damaged " + method + " data");
}

std::string bunzip(std::string_view bytes, std::uint64_t size) {
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
    const std::unique_ptr<bz_stream, int (*)(bz_stream*)> ended(&stream, &BZ2_bzDecompressEnd);
    stream.next_in = const_cast<char*>(bytes.data());
    stream.avail_in = static_cast<unsigned>(bytes.size());
    std::string out;
    for (int state = BZ_OK; state != BZ_STREAM_END;) {
        const std::size_t begin = grow(out, size);
        stream.next_out = out.data() + begin;
        stream.avail_out = static_cast<unsigned>(out.size() - begin);
        const unsigned room = stream.avail_out;
        state = BZ2_bzDecompress(&stream);
        if (state != BZ_OK && state != BZ_STREAM_END) damaged("bz2");
        if (state == BZ_OK && stream.avail_out == room) damaged("bz2");  // no more comes, or no room for it
        out.resize(out.size() - stream.avail_out);
    }
    return out;
}

std::string unlz4(std::string_view bytes, std::uint64_t size) {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION))) throw std::bad_alloc();
    const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> freed(context,
                                                                             &LZ4F_freeDecompressionContext);
    std::string out;
    for (std::size_t hint = 1; hint != 0;) {
        const std::size_t begin = grow(out, size);
        std::size_t room = out.size() - begin, taken = bytes.size();
        hint = LZ4F_decompress(context, out.data() + begin, &room, bytes.data(), &taken, nullptr);
        if (LZ4F_isError(hint) || (room == 0 && taken == 0 && hint != 0)) damaged("lz4");
        bytes.remove_prefix(taken);
        out.resize(begin + room);
    }
    return out;
}

std::string unzstd(std::string_view bytes, std::uint64_t size) {
    const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                               &ZSTD_freeDStream);
    if (!stream) throw std::bad_alloc();
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    std::string out;
    for (std::size_t hint = 1; hint != 0;) {
        const std::size_t begin = grow(out, size), at = in.pos;
        ZSTD_outBuffer room{out.data() + begin, out.size() - begin, 0};
        hint = ZSTD_decompressStream(stream.get(), &room, &in);
        if (ZSTD_isError(hint) || (room.pos == 0 && in.pos == at && hint != 0)) damaged("zstd");
        out.resize(begin + room.pos);
    }
    return out;
}

}  // namespace

std::string decompressed(const std::string& method, std::string_view bytes, std::uint64_t size) {
    if (size > kLargest) throw std::runtime_error("a piece of " + std::to_string(size) + " bytes");
    std::string out;
    if (method == "bz2")
        out = bunzip(bytes, size);
    else if (method == "lz4")
        out = unlz4(bytes, size);
    else if (method == "zstd")
        out = unzstd(bytes, size);
    else
        throw std::runtime_error("compressed by '" + excerpt(method) + "' (known: bz2, lz4, zstd)");
    if (out.size() != size) damaged(method);
    return out;
}

}  // namespace roevo
