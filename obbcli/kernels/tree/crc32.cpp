#include "tree/crc32.hpp"

#include <array>
#include <cstring>

#if defined(__x86_64__) && !defined(OBB_NARROW)
#include <immintrin.h>
#endif

namespace obb {

namespace {

constexpr std::uint32_t kPolynomial = 0xedb88320; // bits reversed, as in everything here
constexpr std::size_t kSlices = 16;

using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

// Of each byte: what it leaves behind when 0, 1, 2... zero bytes follow it.
constexpr Tables make_tables() {
    Tables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t rest = byte;
        for (int bit = 0; bit < 8; ++bit) {
            rest = (rest >> 1) ^ ((rest & 1) != 0 ? kPolynomial : 0);
        }
        tables[0][byte] = rest;
    }
    for (std::size_t slice = 1; slice < kSlices; ++slice) {
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t before = tables[slice - 1][byte];
            tables[slice][byte] = (before >> 8) ^ tables[0][before & 255];
        }
    }
    return tables;
}

constexpr Tables kTables = make_tables();

// Sixteen bytes a step, looked up independently (Kounavis and Berry 2005, slicing).
std::uint32_t advance_by_tables(std::uint32_t rest, std::span<const std::byte> bytes) {
    for (; bytes.size() >= kSlices; bytes = bytes.subspan(kSlices)) {
        std::array<std::uint8_t, kSlices> step;
        std::memcpy(step.data(), bytes.data(), kSlices);
        for (std::size_t i = 0; i < 4; ++i) {
            step[i] ^= static_cast<std::uint8_t>(rest >> (8 * i));
        }
        rest = 0;
        for (std::size_t i = 0; i < kSlices; ++i) {
            rest ^= kTables[kSlices - 1 - i][step[i]];
        }
    }
    for (const std::byte byte : bytes) {
        rest = (rest >> 8) ^ kTables[0][(rest ^ std::to_integer<std::uint32_t>(byte)) & 255];
    }
    return rest;
}

#if defined(__x86_64__) && !defined(OBB_NARROW)

// Powers of x modulo the polynomial, as Gopal et al. 2009 (Fast CRC computation for generic
// polynomials using PCLMULQDQ) have them: what moves 128 bits past 512, and past 128, bits; what
// brings 96 bits down to 64; and the two of Barrett's reduction.
alignas(16) constexpr std::array<std::uint64_t, 2> kPast512{0x154442bd4, 0x1c6e41596};
alignas(16) constexpr std::array<std::uint64_t, 2> kPast128{0x1751997d0, 0x0ccaa009e};
alignas(16) constexpr std::array<std::uint64_t, 2> kTo64{0x163cd6124, 0};
alignas(16) constexpr std::array<std::uint64_t, 2> kBarrett{0x1db710641, 0x1f7011641};

#define OBB_FOLDS [[gnu::target("pclmul,sse4.1")]]

OBB_FOLDS inline __m128i load(const void* at) {
    return _mm_loadu_si128(static_cast<const __m128i*>(at));
}

OBB_FOLDS inline __m128i folded(__m128i value, __m128i past, __m128i next) {
    const __m128i low = _mm_clmulepi64_si128(value, past, 0x00);
    const __m128i high = _mm_clmulepi64_si128(value, past, 0x11);
    return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

// Of a multiple of 64 bytes, at least 64.
OBB_FOLDS std::uint32_t advance_by_folding(std::uint32_t rest, std::span<const std::byte> bytes) {
    const std::byte* at = bytes.data();
    __m128i parts[4]; // a template would ignore how these are aligned
    for (std::size_t i = 0; i < 4; ++i) {
        parts[i] = load(at + 16 * i);
    }
    parts[0] = _mm_xor_si128(parts[0], _mm_cvtsi32_si128(static_cast<int>(rest)));
    const __m128i past_512 = load(kPast512.data());
    for (at += 64; at != bytes.data() + bytes.size(); at += 64) {
        for (std::size_t i = 0; i < 4; ++i) {
            parts[i] = folded(parts[i], past_512, load(at + 16 * i));
        }
    }
    const __m128i past_128 = load(kPast128.data());
    __m128i value = parts[0];
    for (std::size_t i = 1; i < 4; ++i) {
        value = folded(value, past_128, parts[i]);
    }
    const __m128i low_words = _mm_setr_epi32(-1, 0, -1, 0);
    value = _mm_xor_si128(_mm_clmulepi64_si128(value, past_128, 0x10), _mm_srli_si128(value, 8));
    value = _mm_xor_si128(
        _mm_clmulepi64_si128(_mm_and_si128(value, low_words), load(kTo64.data()), 0x00),
        _mm_srli_si128(value, 4));
    const __m128i barrett = load(kBarrett.data());
    __m128i quotient = _mm_clmulepi64_si128(_mm_and_si128(value, low_words), barrett, 0x10);
    quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low_words), barrett, 0x00);
    return static_cast<std::uint32_t>(_mm_extract_epi32(_mm_xor_si128(value, quotient), 1));
}

#endif

} // namespace

std::uint32_t crc32_by_tables(std::span<const std::byte> bytes) {
    return ~advance_by_tables(~std::uint32_t{0}, bytes);
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
    std::uint32_t rest = ~std::uint32_t{0};
#if defined(__x86_64__) && !defined(OBB_NARROW)
    const std::size_t whole = bytes.size() / 64 * 64;
    static const bool can_fold =
        __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("sse4.1") != 0;
    if (whole > 0 && can_fold) {
        rest = advance_by_folding(rest, bytes.first(whole));
        bytes = bytes.subspan(whole);
    }
#endif
    return ~advance_by_tables(rest, bytes);
}

} // namespace obb
