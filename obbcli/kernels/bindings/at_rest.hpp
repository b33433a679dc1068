// The question about two bodies at rest as Python holds it.
#pragma once

#include "bindings/module.hpp"

#include "at_rest/static_query.hpp"

#include <cstdint>

// A query, and what keeps its trees alive.
struct AtRest {
    nb::object a, b;
    std::uint64_t brief;
    obb::StaticQuery query;
};
