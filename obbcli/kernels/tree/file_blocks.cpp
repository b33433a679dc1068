#include "tree/file_blocks.hpp"

#include "tree/crc32.hpp"
#include "tree/tree.hpp"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <unistd.h>

namespace obb {

FileBlocks::Descriptor::~Descriptor() {
    if (number_ >= 0) {
        ::close(number_);
    }
}

FileBlocks::FileBlocks(Descriptor file, std::uint64_t start, std::size_t size,
                       std::vector<std::uint32_t> checksums)
    : file_(std::move(file)), start_(start), checksums_(std::move(checksums)), bytes_(size),
      loaded_((size + kBlockBytes - 1) / kBlockBytes) {
    if (!checksums_.empty() && checksums_.size() != loaded_.size()) {
        throw std::invalid_argument("there must be one checksum a block");
    }
}

std::size_t FileBlocks::loaded_bytes(std::size_t begin, std::size_t end) const {
    std::size_t bytes = 0;
    for (std::size_t block = begin / kBlockBytes; block * kBlockBytes < end; ++block) {
        const std::size_t first = block * kBlockBytes, last = first + kBlockBytes;
        bytes += is_loaded(block) ? std::min(last, end) - std::max(first, begin) : 0;
    }
    return bytes;
}

void FileBlocks::load_blocks(std::size_t first, std::size_t last) {
    while (first < last) {
        const std::size_t group = first / kGroupBlocks;
        const std::size_t stop = std::min(last, (group + 1) * kGroupBlocks);
        const std::lock_guard lock(locks_[group % kLockCount]);
        while (first < stop) {
            std::size_t end = first;
            while (end < stop && !is_loaded(end)) {
                ++end;
            }
            if (end > first) {
                load_run(first, end);
            }
            first = end + 1; // this block is loaded, or of the next group
        }
        first = stop;
    }
}

// A thread that finds the flag set sees the bytes; no thread reads them before.
void FileBlocks::load_run(std::size_t first, std::size_t last) {
    read(first * kBlockBytes, std::min(last * kBlockBytes, size()));
    for (std::size_t block = first; block < last; ++block) {
        if (!checksums_.empty()) {
            verify(block);
        }
        __atomic_store_n(&loaded_[block], std::uint8_t{1}, __ATOMIC_RELEASE);
    }
}

void FileBlocks::read(std::size_t begin, std::size_t end) const {
    while (begin < end) {
        const ::ssize_t count = ::pread(file_.number(), bytes_.data() + begin, end - begin,
                                        static_cast<::off_t>(start_ + begin));
        if (count < 0) {
            throw TreeError("cannot be read from byte " + std::to_string(start_ + begin) +
                            " on: " + std::generic_category().message(errno));
        }
        if (count == 0) {
            throw TreeError("ends before byte " + std::to_string(start_ + end) +
                            ": it was cut short while it was in use");
        }
        begin += static_cast<std::size_t>(count);
    }
}

void FileBlocks::verify(std::size_t block) const {
    const std::size_t begin = block * kBlockBytes;
    const std::size_t end = std::min(begin + kBlockBytes, size());
    if (crc32({bytes_.data() + begin, end - begin}) != checksums_[block]) {
        throw TreeError("is damaged between bytes " + std::to_string(start_ + begin) + " and " +
                        std::to_string(start_ + end));
    }
}

} // namespace obb
