// Work on a range in chunks, by one thread or several. Chunks are the same for any number of
// threads, so that sums over them are the same too.
#pragma once

#include "work/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace obb {

inline constexpr std::uint32_t kChunk = 4096;

[[nodiscard]] inline std::uint32_t chunk_count(std::uint32_t count) {
    return (count + kChunk - 1) / kChunk;
}

// Calls work(chunk, begin, end) for all chunks of [begin, end), each once.
template <typename Work>
void for_chunks(std::uint32_t begin, std::uint32_t end, unsigned threads, const Work& work) {
    constexpr std::uint32_t kChunksAThread = 8; // fewer are not worth a thread
    const std::uint32_t count = chunk_count(end - begin);
    const auto one = [&](std::uint32_t chunk) {
        const std::uint32_t first = begin + chunk * kChunk;
        work(chunk, first, std::min(end - first, kChunk) + first);
    };
    threads = std::min(threads, count / kChunksAThread);
    if (threads < 2) {
        for (std::uint32_t chunk = 0; chunk < count; ++chunk) {
            one(chunk);
        }
        return;
    }
    const auto part = [&](std::size_t chunk) {
        one(static_cast<std::uint32_t>(chunk));
        return true;
    };
    do_parts(count, threads, part, [] {});
}

} // namespace obb
