// The data of a file in memory, read and verified block by block as they are first used.
#pragma once

#include "tree/zeroed_array.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace obb {

// Memory of the data's size is set aside, which costs nothing until it is used, and a block is
// copied there when somebody needs it. A mapping would copy nothing, but what it shows can change
// after it was verified, and a file that is cut short ends the process with a signal; here, what
// was verified stays, and a short read is an error like any other. For any number of threads.
class FileBlocks {
  public:
    // An open file of which it is the owner.
    class Descriptor {
      public:
        explicit Descriptor(int number) : number_(number) {}
        Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
        Descriptor& operator=(Descriptor&&) = delete;
        ~Descriptor();
        [[nodiscard]] int number() const { return number_; }

      private:
        int number_;
    };

    static constexpr std::size_t kBlockBytes = 4096;

    // Of `size` bytes from `start` on, with a checksum for each block; without any, blocks are read
    // and not verified.
    FileBlocks(Descriptor file, std::uint64_t start, std::size_t size,
               std::vector<std::uint32_t> checksums);

    [[nodiscard]] const std::byte* data() const { return bytes_.data(); }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }

    // Makes the bytes from `begin` to `end` ready to be read. Throws TreeError where the file does
    // not hold them, or not as they were written.
    void load(std::size_t begin, std::size_t end) {
        for (std::size_t block = begin / kBlockBytes; block * kBlockBytes < end; ++block) {
            if (!is_loaded(block)) {
                load_blocks(block, (end - 1) / kBlockBytes + 1);
                return;
            }
        }
    }

    // How many of the bytes from `begin` to `end` are ready.
    [[nodiscard]] std::size_t loaded_bytes(std::size_t begin, std::size_t end) const;

  private:
    // Blocks of one group wait for each other, and neighbours among them are read at once.
    static constexpr std::size_t kGroupBlocks = 16;
    static constexpr std::size_t kLockCount = 64;

    [[nodiscard]] bool is_loaded(std::size_t block) const {
        return __atomic_load_n(&loaded_[block], __ATOMIC_ACQUIRE) != 0;
    }
    void load_blocks(std::size_t first, std::size_t last);
    void load_run(std::size_t first, std::size_t last);
    void read(std::size_t begin, std::size_t end) const;
    void verify(std::size_t block) const;

    Descriptor file_;
    std::uint64_t start_;
    std::vector<std::uint32_t> checksums_;
    ZeroedArray<std::byte> bytes_;
    ZeroedArray<std::uint8_t> loaded_; // a flag a block
    std::array<std::mutex, kLockCount> locks_;
};

} // namespace obb
