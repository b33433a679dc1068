// The border for pairs of boxes and triangles: packed rows in, columns out.
#include "primitives/primitives.hpp"
#include "bindings/module.hpp"

#include <cstddef>

using namespace nb::literals;

namespace {

using Shapes = Rows<double, -1>;
using Verdicts = nb::ndarray<std::uint8_t, nb::numpy, nb::shape<-1>, nb::c_contig, nb::device::cpu>;

// One row for all pairs, or one for each of `count`.
template <typename Record, typename Array>
obb::Repeated<Record> repeated(const Array& array, std::size_t count) {
    if (array.shape(0) != 1 && array.shape(0) != count) {
        throw std::invalid_argument("arrays of pairs have different lengths");
    }
    if (reinterpret_cast<std::uintptr_t>(array.data()) % alignof(Record) != 0) {
        throw std::invalid_argument("array is not aligned");
    }
    return obb::Repeated<Record>({reinterpret_cast<const Record*>(array.data()), array.shape(0)});
}

obb::RepeatedMotion motion_of(const Rows<double, 3>& velocity_a, const Rows<double, 3>& velocity_b,
                              const Column<double>& duration, std::size_t count) {
    return {repeated<obb::Vec3>(velocity_a, count), repeated<obb::Vec3>(velocity_b, count),
            repeated<double>(duration, count)};
}

// Calls `ask` with the shapes as what they are: a triangle's row has 9 numbers, a box's 15.
template <typename Ask>
auto with_shapes(const Shapes& a, const Shapes& b, std::size_t count, const Ask& ask) {
    constexpr std::size_t kTriangle = sizeof(obb::Triangle) / sizeof(double);
    constexpr std::size_t kObb = sizeof(obb::Obb) / sizeof(double);
    static_assert(kTriangle == 9 && kObb == 15);
    const auto is_row = [](const Shapes& s) {
        return s.shape(1) == kTriangle || s.shape(1) == kObb;
    };
    if (!is_row(a) || !is_row(b)) {
        throw std::invalid_argument("a shape's row has 9 or 15 numbers");
    }
    const auto with_b = [&](const auto& first) {
        return b.shape(1) == kObb ? ask(first, repeated<obb::Obb>(b, count))
                                  : ask(first, repeated<obb::Triangle>(b, count));
    };
    return a.shape(1) == kObb ? with_b(repeated<obb::Obb>(a, count))
                              : with_b(repeated<obb::Triangle>(a, count));
}

void intersects(const Shapes& a, const Shapes& b, const Rows<double, 3>& velocity_a,
                const Rows<double, 3>& velocity_b, const Column<double>& duration, unsigned threads,
                const Verdicts& verdicts) {
    const std::size_t count = verdicts.shape(0);
    const obb::RepeatedMotion motion = motion_of(velocity_a, velocity_b, duration, count);
    with_shapes(a, b, count, [&](const auto& first, const auto& second) {
        nb::gil_scoped_release release;
        obb::test_pairs(first, second, motion, {threads, SignalWatch{}}, {verdicts.data(), count});
    });
}

// One column of the result: what `get` says of each contact.
template <typename Get>
nb::object column(const std::vector<obb::PairContact>& contacts, const Get& get) {
    using Value = decltype(get(contacts[0]));
    std::vector<Value> values;
    values.reserve(contacts.size());
    for (const obb::PairContact& contact : contacts) {
        if constexpr (std::is_same_v<Value, obb::Vec3>) {
            values.push_back(get(contact) + obb::Vec3{0, 0, 0}); // no negative zeros
        } else {
            values.push_back(get(contact));
        }
    }
    if constexpr (std::is_same_v<Value, double>) {
        return nb::cast(owned<Owned<double, -1>>(std::move(values), {contacts.size()}));
    } else {
        return nb::cast(owned<Owned<double, -1, 3>>(std::move(values), {contacts.size(), 3}));
    }
}

// Kind, indices and side of the axis, the features that meet, whether contact ends.
nb::object codes(const std::vector<obb::PairContact>& contacts) {
    using Codes = std::array<std::int8_t, 6>;
    const auto code = [](auto value) { return static_cast<std::int8_t>(value); };
    std::vector<Codes> values;
    for (const obb::PairContact& contact : contacts) {
        const obb::Touch& t = contact.touch;
        const obb::FeatureCode feature =
            t.axis.kind == obb::AxisKind::kNone
                ? obb::kNoFeature
                : obb::feature_code(t.feature_a.dimension, t.feature_b.dimension);
        values.push_back({code(t.axis.kind), code(t.axis.a), code(t.axis.b), t.side, code(feature),
                          code(contact.ends)});
    }
    return nb::cast(owned<Owned<std::int8_t, -1, 6>>(std::move(values), {contacts.size(), 6}));
}

nb::dict first_contacts(const Shapes& a, const Shapes& b, const Rows<double, 3>& velocity_a,
                        const Rows<double, 3>& velocity_b, const Column<double>& duration,
                        std::size_t count, unsigned threads) {
    using obb::PairContact;
    const obb::RepeatedMotion motion = motion_of(velocity_a, velocity_b, duration, count);
    obb::PairContacts found = with_shapes(a, b, count, [&](const auto& first, const auto& second) {
        nb::gil_scoped_release release;
        return obb::first_contacts(first, second, motion, count, {threads, SignalWatch{}});
    });
    const std::vector<PairContact>& all = found.contacts;
    nb::dict columns;
    columns["time"] = column(all, [](const PairContact& c) { return c.time; });
    columns["time_below"] = column(all, [](const PairContact& c) { return c.time_below; });
    columns["last_time"] = column(all, [](const PairContact& c) { return c.last_time; });
    columns["normal"] = column(all, [](const PairContact& c) { return c.touch.normal; });
    columns["point"] = column(all, [](const PairContact& c) { return c.point; });
    columns["normal_a"] = column(all, [](const PairContact& c) { return c.normal_a; });
    columns["normal_b"] = column(all, [](const PairContact& c) { return c.normal_b; });
    columns["smooth_normal_a"] =
        column(all, [](const PairContact& c) { return c.smooth_normal_a; });
    columns["smooth_normal_b"] =
        column(all, [](const PairContact& c) { return c.smooth_normal_b; });
    columns["codes"] = codes(all);
    columns["rows"] = owned<Owned<std::int64_t, -1>>(std::move(found.rows), {all.size()});
    return columns;
}

} // namespace

void bind_primitives(nb::module_& m) {
    m.def("primitive_intersects", &intersects, "a"_a, "b"_a, "velocity_a"_a, "velocity_b"_a,
          "duration"_a, "threads"_a, "verdicts"_a);
    m.def("primitive_first_contacts", &first_contacts, "a"_a, "b"_a, "velocity_a"_a, "velocity_b"_a,
          "duration"_a, "count"_a, "threads"_a);
}
