// The checksum of zlib, PNG and Ethernet (IEEE 802.3), as fast as memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace obb {

[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes);

// The same on machines that cannot multiply polynomials.
[[nodiscard]] std::uint32_t crc32_by_tables(std::span<const std::byte> bytes);

} // namespace obb
